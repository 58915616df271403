#!/bin/bash
# A Slurm cluster of two virtual nodes on this machine, without systemd: munged, slurmctld and two slurmd, all of them in one folder.
# Needs Debian's packages slurm-wlm and munge. Nodes have one processor each, or NODE_CPUS.
#
#   cluster.sh start DIR     starts it; `export SLURM_CONF=DIR/slurm.conf` then makes sbatch, squeue, ... use it
#   cluster.sh node DIR N    starts the slurmd of node N (again)
#   cluster.sh stop DIR      ends it
set -eu

command=$1
dir=$(mkdir -p "$2" && cd "$2" && pwd)
conf=$dir/slurm.conf
user=$(id -un)
PATH=$PATH:/usr/sbin

configure() {
    mkdir -p "$dir/state" "$dir/spool-n1" "$dir/spool-n2" "$dir/munge"
    chmod 700 "$dir/munge"
    head -c 1024 /dev/urandom >"$dir/munge/key"
    chmod 400 "$dir/munge/key"
    cat >"$conf" <<END
ClusterName=strahl
SlurmctldHost=$(hostname)(127.0.0.1)
SlurmctldPort=${SLURM_PORT:-26817}
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$dir/munge/socket
CryptoType=crypto/munge
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool-%n
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd-%n.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MailProg=/bin/true
JobRequeue=1
ReturnToService=2
SlurmdTimeout=15
SlurmctldTimeout=30
MessageTimeout=10
KillWait=3
MinJobAge=3600
SchedulerParameters=sched_interval=2,batch_sched_delay=0,sched_min_interval=0,bf_interval=2
SlurmdParameters=config_overrides
NodeName=n1 NodeHostname=$(hostname) NodeAddr=127.0.0.1 Port=26818 CPUs=${NODE_CPUS:-1} RealMemory=1024
NodeName=n2 NodeHostname=$(hostname) NodeAddr=127.0.0.1 Port=26819 CPUs=${NODE_CPUS:-1} RealMemory=1024
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=60 State=UP
END
}

# Ends a program by the number in its file.
end() {
    if [ -f "$1" ]; then
        kill "${2:--TERM}" "$(cat "$1")" 2>/dev/null || true
    fi
}

case $command in
start)
    configure
    munged --key-file="$dir/munge/key" --socket="$dir/munge/socket" --pid-file="$dir/munge/pid" \
        --log-file="$dir/munge/log" --seed-file="$dir/munge/seed" --force
    slurmctld -f "$conf" -c
    slurmd -N n1 -f "$conf"
    slurmd -N n2 -f "$conf"
    for _ in $(seq 30); do
        idle=$(SLURM_CONF=$conf sinfo --noheader --format=%T%D 2>/dev/null || true)
        if [ "$idle" = idle2 ]; then
            exit 0
        fi
        sleep 1
    done
    echo "the nodes are not ready after 30 s: see $dir/*.log" >&2
    exit 1
    ;;
node)
    slurmd -N "$3" -f "$conf"
    ;;
stop)
    SLURM_CONF=$conf scancel --user="$user" 2>/dev/null || true
    end "$dir/slurmd-n1.pid"
    end "$dir/slurmd-n2.pid"
    end "$dir/slurmctld.pid"
    end "$dir/munge/pid"
    ;;
*)
    echo "usage: cluster.sh start|stop DIR, cluster.sh node DIR N" >&2
    exit 2
    ;;
esac
