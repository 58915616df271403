#!/bin/bash
# Measures what rendering in tiles costs: CPU time of all tasks against one process, and the longest tile against the mean.
#
#   [RUNS=2] scripts/farm/measure.sh STRAHL SIZE TILES SCENE ...
#
# `rays` are those of all tiles against one process: exact, while times depend on what else the machine does. Of several RUNS of a tile the
# fastest counts. One thread and one task at a time. Writes the seconds of each tile to SCENE-TILES.seconds in the current folder, for simulate.py.
set -eu

strahl=$(realpath "$1")
size=$2
tiles=$3
shift 3
runs=${RUNS:-1}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
TIMEFORMAT='%U %S'
once() { { time "$@" >/dev/null 2>&1; } 2>&1 | awk '{ print $1 + $2 }'; }
cpu() { for _ in $(seq "$runs"); do once "$@"; done | sort -n | head -n 1; }
# Rays of all kinds in a file of statistics.
rays() { grep -E '"(primary|shadow|reflection|refraction)":' "$1" | grep -o '[0-9]*' | awk '{ sum += $1 } END { print sum }'; }

printf '%-16s %10s %10s %10s %10s %12s %12s\n' scene 'one [s]' 'tiles [s]' efficiency rays longest/mean 'submit [s]'
for scene in "$@"; do
    name=$(basename "$scene" .pov)
    job=$work/$name.job
    one=$(cpu "$strahl" render "$scene" -o "$work/one.png" --size "$size" --threads 1 --stats "$work/one.json")
    submit=$(once "$strahl" submit slurm "$scene" -o "$work/$name.png" --size "$size" --tiles "$tiles" --threads 1 --dry-run)
    for task in $(seq "$tiles"); do
        for _ in $(seq "$runs"); do
            rm -f "$(printf "%s/tiles/t%0*d.exr" "$job" "${#tiles}" "$task")"
            once "$strahl" submit task "$job" --task "$task" --threads 1
        done | sort -n | head -n 1
    done >"$name-$tiles.seconds"
    "$strahl" submit merge "$job" >/dev/null
    hash() { grep -o '"sha256": "[0-9a-f]*"' "$1"; }
    [ "$(hash "$work/one.json")" = "$(hash "$job/result.json")" ] || echo "$name: the films differ"
    "$strahl" merge "$job"/tiles/*.exr -o "$work/merged.exr" --stats "$work/merged.json" --quiet
    rays=$(echo "$(rays "$work/merged.json") $(rays "$work/one.json")" | awk '{ print 100 * $1 / $2 }')
    awk -v name="$name" -v rays="$rays" -v one="$one" -v submit="$submit" '
        { sum += $1; if ($1 > most) most = $1 }
        END { printf "%-16s %10.1f %10.1f %9.1f%% %9.2f%% %12.2f %12.2f\n", name, one, sum, 100 * one / sum, rays, most / (sum / NR), submit }
    ' "$name-$tiles.seconds"
done
