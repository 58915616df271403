#!/bin/bash
# Shows that pictures and films made by a real Slurm cluster and by a real `openjd run` are those of one process, and what happens when
# things break. Takes some minutes.
#
#   scripts/farm/check.sh [STRAHL [SIZE]]       default: target/release/strahl and 1920x1080
#
# Must be run by root. Needs Debian's packages slurm-wlm, munge and bc, and openjd-cli from PyPI (OPENJD=path/to/openjd, or `openjd` in PATH).
# Ends with code 1 if anything is not as it should be.
set -u

here=$(cd "$(dirname "$0")" && pwd)
strahl=$(realpath "${1:-$here/../../target/release/strahl}")
size=${2:-1920x1080}
openjd=${OPENJD:-openjd}
work=$(mktemp -d)
export SLURM_CONF=$work/cluster/slurm.conf
failures=0

"$here/cluster.sh" start "$work/cluster" || exit 1
trap '"$here/cluster.sh" stop "$work/cluster"; rm -rf "$work"' EXIT
cd "$work"

ok() { printf '%-62s ok     %5.1f s\n' "$1" "$(since)"; }
bad() {
    printf '%-62s FAILED %5.1f s\n' "$1" "$(since)"
    failures=$((failures + 1))
}
begin() { started=$(date +%s.%N); }
since() { echo "$(date +%s.%N) - $started" | bc; }
check() { if eval "$2"; then ok "$1"; else bad "$1: $2"; fi; }

# The hash of a film of one process; the hashes of the pictures of a job.
hash_of() { grep -o '"sha256": "[0-9a-f]*"' "$1" | cut -d'"' -f4; }
hashes_of_pngs() {
    for file in "$@"; do tr '\0' ' ' <"$file" | grep -aoE 'sha256 +[0-9a-f]{64}' | grep -oE '[0-9a-f]{64}'; done
}
# Waits until Slurm has no job any more, for a bounded time.
wait_for_queue() {
    for _ in $(seq "${1:-120}"); do
        [ -z "$(squeue --noheader)" ] && return 0
        sleep 1
    done
    squeue
    return 1
}
# Waits until a task of the job runs.
wait_for_task() {
    for _ in $(seq 100); do
        pgrep -f "submit task $work/$1 " >/dev/null && return 0
        sleep 0.1
    done
    return 1
}
submit() { "$strahl" submit slurm "$@" --quiet || bad "submit $*"; }

cat >scene.pov <<'END'
#version 3.7;
global_settings { assumed_gamma 1 }
#include "colors.inc"
#include "parts/ball.inc"
camera { location <0, 2, -6> look_at <0, 0.7, 0> }
light_source { <4, 8, -6> rgb 1 area_light <2, 0, 0>, <0, 0, 2>, 3, 3 adaptive 1 jitter }
sky_sphere { pigment { gradient y color_map { [0 rgb 0.9] [1 rgb <0.2, 0.4, 0.9>] } } }
plane { y, 0 pigment { checker rgb 0.9 rgb 0.2 } finish { reflection 0.2 } }
sphere { <0, R, 0>, R pigment { bozo scale 0.2 color_map { [0 Red] [1 rgb <0, 1, 1, 0.7>] } } finish { phong 1 } interior { ior 1.4 } rotate y * 360 * clock }
torus { 1.6, 0.2 rotate x * 360 * clock translate y pigment { rgb <0.2, 0.4, 1> } }
END
mkdir parts pictures
echo '#declare R = 1;' >parts/ball.inc
# Costly enough that there is time to break something.
sed 's/3, 3 adaptive 1/17, 17/' scene.pov >slow.pov

begin
"$strahl" render scene.pov -o one.png --size "$size" --stats one.json --quiet
"$strahl" render scene.pov -o onef.png --size 160x120 --initial-frame 1 --final-frame 48 --cyclic --quiet
"$strahl" render slow.pov -o slow-one.png --size 320x240 --stats slow.json --quiet
one=$(hash_of one.json)
slow=$(hash_of slow.json)
film=$(hashes_of_pngs onef*.png)
ok "one process: a still of $size, a film of 48 frames"

begin
submit scene.pov -o still.png --size "$size" --tiles 8
wait_for_queue 600
check "Slurm: a still of $size in 8 tiles has the film of one process" '[ "$(hash_of still.job/result.json)" = "$one" ]'
begin
submit scene.pov -o film.png --size 160x120 --initial-frame 1 --final-frame 48 --cyclic --chunk 4 --movie film.mp4
wait_for_queue 600
check "Slurm: a film of 48 frames has the films of one process" '[ "$(hash_of film.job/result.json)" = "$film" ]'

if command -v "$openjd" >/dev/null; then
    begin
    "$strahl" submit openjd scene.pov -o pictures/still.png --size "$size" --tiles 8 --quiet
    "$openjd" check pictures/still.job/template.json >/dev/null || bad "openjd check"
    "$openjd" run pictures/still.job/template.json -p "Strahl=$strahl" -p Pictures="$work/pictures" >openjd.log 2>&1 || tail openjd.log
    check "openjd: a still of $size in 8 tiles has the film of one process" '[ "$(hash_of pictures/still.job/result.json)" = "$one" ]'
    begin
    "$strahl" submit openjd scene.pov -o pictures/film.png --size 160x120 --initial-frame 1 --final-frame 48 --cyclic --quiet
    "$openjd" run pictures/film.job/template.json -p "Strahl=$strahl" -p Pictures="$work/pictures" >openjd.log 2>&1 || tail openjd.log
    check "openjd: a film of 48 frames has the films of one process" '[ "$(hash_of pictures/film.job/result.json)" = "$film" ]'
else
    begin
    bad "openjd is not installed: pip install openjd-cli, OPENJD=path"
fi

slow_job() { submit slow.pov -o "$1.png" --size 320x240 --tiles 4 "${@:2}"; }
complete() { [ "$(hash_of "$1.job/result.json")" = "$slow" ]; }

begin
slow_job a
wait_for_task a.job
sleep 1
kill -9 "$(pgrep -f "submit task $work/a.job " | head -n 1)"
wait_for_queue
check "kill -9 of a render: it is tried again" 'complete a && grep -q "was killed" a.job/log/*.log'

begin
slow_job b
wait_for_task b.job
kill -9 "$(pgrep -f "slurmstepd: \[[0-9]+.batch\]" | head -n 1)"
wait_for_queue 180
check "kill -9 of a slurmstepd: the job ends" 'true'
begin
complete b || { "$strahl" submit resume b.job; wait_for_queue; }
check "... and is complete, after resume at the latest" 'complete b'

begin
slow_job c
wait_for_task c.job
kill -9 "$(cat cluster/slurmd-n2.pid)"
wait_for_queue 180
check "kill -9 of a slurmd: the other node does its work" 'complete c'
rm -f cluster/slurmd-n2.pid
"$here/cluster.sh" node "$work/cluster" n2
sleep 2

begin
# A disk of 40 KiB for the tiles: the second one does not fit any more.
slow_job d --dry-run
mount -t tmpfs -o size=40k none d.job/tiles
sbatch --parsable --array=1-4 d.job/render.sbatch >array
sbatch --parsable --dependency=afterany:"$(cat array)" --kill-on-invalid-dep=yes d.job/merge.sbatch >merge
wait_for_queue
check "a full disk: the tasks say so, and nothing is merged" '[ ! -e d.png ] && grep -qi "no space\|free some space" d.job/log/*.log'
"$strahl" submit status d.job
umount d.job/tiles
begin
"$strahl" submit resume d.job
wait_for_queue
check "... and resume completes it when there is space" 'complete d'

begin
mv a.job old.job
slow_job a --seed 1 --max-depth 3 --dry-run
"$strahl" submit task a.job --task 1 >/dev/null
mv a.job late.job
rm -f a.png
slow_job a --dry-run
for task in 1 2 3 4; do "$strahl" submit task a.job --task $task >/dev/null; done
cp late.job/tiles/t1.exr a.job/tiles/t1.exr
"$strahl" submit merge a.job >late.log 2>&1
check "a node answers late with an old tile: it is not merged" '[ ! -e a.png ] && grep -q "t1.exr: is a tile of another job" late.log'
begin
"$strahl" submit resume a.job
wait_for_queue
check "... and resume renders that tile only" 'complete a && [ "$(ls a.job/log/*_*.log | wc -l)" = 1 ]'

begin
slow_job e
wait_for_task e.job
for task in 1 2 3 4; do "$strahl" submit task e.job --task $task >/dev/null & done
sleep 1
scontrol requeue "$(squeue --noheader --array --states=RUNNING --format=%i | head -n 1)"
wait
wait_for_queue 180
check "tasks that run twice at once, one of them queued again" 'complete e'

begin
cat >pictures.pov <<'END'
camera { location -3 * z look_at 0 }
light_source { -9 * z rgb 1 }
#include concat("part", str(frame_number, 0, 0), ".inc")
END
for frame in 1 2 3 4 5 6; do echo "sphere { 0, $frame / 6 pigment { rgb 1 } }" >part$frame.inc; done
submit pictures.pov -o g.png --size 64x64 --frames 1-6 --dry-run
mv g.job/scene/part4.inc gone.inc
"$strahl" submit resume g.job
wait_for_queue
check "a frame that fails for good: the job ends and says which" '! ls g4.png 2>/dev/null && grep -q "frame 4: it is missing" g.job/log/merge-*.log && [ "$(ls g[1-6].png | wc -l)" = 5 ]'
"$strahl" submit status g.job
mv gone.inc g.job/scene/part4.inc
begin
"$strahl" submit resume g.job
wait_for_queue
check "... and resume completes it" '[ -e g4.png ]'

echo "$failures failures"
[ "$failures" = 0 ]
