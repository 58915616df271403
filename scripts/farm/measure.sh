#!/bin/bash
# Measures what rendering in tiles costs: processor time (user and system) of all tasks against one process, and the longest tile against the
# mean.
#
#   [OPTIONS="--sampling 3x3"] [ONE=no] scripts/farm/measure.sh STRAHL SIZE TILES SCENE ...
#
# The one process (one thread) and the tasks (one thread, one after the other) run at the same time, each on a processor of its own, so
# that whatever else the machine does slows both down. ONE=no leaves the one process out, for the balance alone. OPTIONS are options of
# render. `rays` are those of all tiles against one process, which is exact.
# Writes what simulate.py reads to SCENE-TILES.seconds in the current folder: the processor seconds of each task, and of reading the scene.
set -eu

strahl=$(realpath "$1")
size=$2
tiles=$3
shift 3
read -r -a options <<<"${OPTIONS:-}"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
TIMEFORMAT='%U %S'
# Runs a program on a processor; writes the seconds to a file. In a shell of its own, whose time is that of the program alone.
cpu() (
    file=$1 processor=$2
    shift 2
    pin=()
    [ "$(nproc)" -gt 1 ] && pin=(taskset -c "$processor")
    { time "${pin[@]}" "$@" >/dev/null 2>"$work/said"; } 2>"$work/time" || { cat "$work/said" >&2; exit 1; }
    awk '{ print $1 + $2 }' "$work/time" >"$file"
)
number() { grep -o "\"$1\": [0-9.e-]*" "$2" | head -n 1 | cut -d' ' -f2; }
hash() { grep -o '"sha256": "[0-9a-f]*"' "$1"; }
# Rays of all kinds in a file of statistics.
rays() { grep -E '"(primary|shadow|reflection|refraction)":' "$1" | grep -o '[0-9]*' | awk '{ sum += $1 } END { print sum }'; }

echo "$size, $tiles tiles ${OPTIONS:-}; seconds of processor time"
printf '%-12s %9s %9s %10s %8s %8s %12s %7s %7s\n' scene one tasks efficiency rays reading longest/mean submit merge
for scene in "$@"; do
    name=$(basename "$scene" .pov)
    job=$work/$name.job
    render=("$strahl" render "$scene" --size "$size" "${options[@]}" --threads 1)
    # Reading and building alone, as every task does it.
    "${render[@]}" --no-output --region 0,0,1x1 --sampling center --stats "$work/read.json" >/dev/null 2>&1
    reading=$(echo "$(number load "$work/read.json") $(number compile "$work/read.json")" | awk '{ print $1 + $2 }')
    cpu "$work/submit" 0 "$strahl" submit slurm "$scene" -o "$work/$name.png" --size "$size" "${options[@]}" --tiles "$tiles" --threads 1 --dry-run
    if [ "${ONE:-yes}" = yes ]; then
        (
            mkdir "$work/one"
            work=$work/one
            cpu "$work/seconds" 0 "${render[@]}" -o "$work/one.png" --stats "$work/one.json"
        ) &
    fi
    echo "# reading $reading" >"$name-$tiles.seconds"
    for task in $(seq "$tiles"); do
        cpu "$work/seconds" 1 "$strahl" submit task "$job" --task "$task" --threads 1
        cat "$work/seconds" >>"$name-$tiles.seconds"
    done
    wait
    cpu "$work/merge" 0 "$strahl" submit merge "$job"
    one=0 share=-
    if [ "${ONE:-yes}" = yes ]; then
        one=$(cat "$work/one/seconds")
        [ "$(hash "$work/one/one.json")" = "$(hash "$job/result.json")" ] || echo "$name: the films differ"
        "$strahl" merge "$job"/tiles/*.exr -o "$work/merged.exr" --stats "$work/merged.json" --quiet
        share=$(echo "$(rays "$work/merged.json") $(rays "$work/one/one.json")" | awk '{ printf "%.1f%%", 100 * $1 / $2 }')
    fi
    awk -v name="$name" -v rays="$share" -v one="$one" -v reading="$reading" -v submit="$(cat "$work/submit")" -v merge="$(cat "$work/merge")" '
        /^#/ { next }
        { n++; sum += $1; if ($1 > most) most = $1 }
        END {
            efficiency = one ? sprintf("%.1f%%", 100 * one / sum) : "-"
            printf "%-12s %9.1f %9.1f %10s %8s %8.3f %12.2f %7.2f %7.2f\n", name, one, sum, efficiency, rays, reading, most / (sum / n), submit, merge
        }
    ' "$name-$tiles.seconds"
    rm -rf "$work/one" "$job"
done
