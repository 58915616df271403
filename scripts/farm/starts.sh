#!/bin/bash
# Measures how many tasks of an array a Slurm on this machine starts in a second, for simulate.py: tasks that do nothing, on two virtual nodes
# with room for 32 each. All daemons and tasks share this machine's processors, so a cluster will be faster.
#
#   scripts/farm/starts.sh [TASKS]      default: 300
set -eu

here=$(cd "$(dirname "$0")" && pwd)
tasks=${1:-300}
work=$(mktemp -d)
export SLURM_CONF=$work/cluster/slurm.conf
trap '"$here/cluster.sh" stop "$work/cluster"; rm -rf "$work"' EXIT
NODE_CPUS=32 "$here/cluster.sh" start "$work/cluster"
mkdir "$work/log"
printf '#!/bin/sh\n#SBATCH --output=/dev/null\ndate +%%s.%%N >%s/log/$SLURM_ARRAY_TASK_ID\n' "$work" >"$work/task"
begin=$(date +%s.%N)
sbatch --parsable --array=1-"$tasks" "$work/task" >/dev/null
for _ in $(seq 600); do
    [ -z "$(squeue --noheader)" ] && break
    sleep 1
done
cat "$work"/log/* | sort -n | awk -v begin="$begin" -v tasks="$tasks" '
    NR == 1 { first = $1 }
    { last = $1 }
    END {
        printf "%d of %d tasks started: the first after %.2f s, the last after %.2f s: %.1f a second\n", NR, tasks, first - begin, last - begin, (NR - 1) / (last - first)
        exit NR != tasks
    }'
