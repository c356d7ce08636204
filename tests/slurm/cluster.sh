# Sourced: a private Slurm of two nodes. Needs $D, an existing folder of mode 755; sets SLURM_CONF.
base=$((20000 + $$ % 20000))

start_cluster() {
    mkdir -p "$D"/{munge,run,state,spool,log}
    chmod 755 "$D/run"
    chmod 700 "$D/munge"
    head -c 128 /dev/urandom >"$D/munge/key"
    chmod 600 "$D/munge/key"
    local host address
    host=$(hostname -s)
    # What the name stands for: Slurm 24 listens nowhere else.
    address=$(getent ahostsv4 "$host" | awk 'NR == 1 {print $1}')
    # cred_expire: a requeued task waits until its old credential has expired, 2 minutes by default.
    # config_overrides: two nodes of two CPUs on whatever this machine has.
    cat >"$D/slurm.conf" <<CONF
ClusterName=gfxrepro
SlurmctldHost=$host($address)
SlurmctldPort=$base
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$D/run/munge.sock,cred_expire=5
MpiDefault=none
StateSaveLocation=$D/state
SlurmdSpoolDir=$D/spool/%n
SlurmctldPidFile=$D/run/slurmctld.pid
SlurmdPidFile=$D/run/slurmd.%n.pid
SlurmctldLogFile=$D/log/slurmctld.log
SlurmdLogFile=$D/log/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/builtin
SchedulerParameters=batch_sched_delay=0,sched_interval=1,sched_min_interval=0
SlurmdParameters=config_overrides
SlurmdTimeout=5
ReturnToService=2
MinJobAge=3600
KillWait=2
MailProg=/bin/true
NodeName=n1 NodeHostname=$host NodeAddr=$address Port=$((base + 1)) CPUs=2 RealMemory=2000
NodeName=n2 NodeHostname=$host NodeAddr=$address Port=$((base + 2)) CPUs=2 RealMemory=2000
PartitionName=main Nodes=ALL Default=YES MaxTime=60 State=UP
CONF
    export SLURM_CONF=$D/slurm.conf
    munged --key-file="$D/munge/key" --socket="$D/run/munge.sock" --pid-file="$D/run/munged.pid" \
        --log-file="$D/munge/log" --seed-file="$D/munge/seed"
    slurmctld -f "$SLURM_CONF"
    slurmd -f "$SLURM_CONF" -N n1
    slurmd -f "$SLURM_CONF" -N n2
    wait_for 30 both_idle
}

both_idle() { [ "$(timeout 5 sinfo -hN -o %T 2>/dev/null | grep -c '^idle$')" = 2 ]; }

# wait_for SECONDS COMMAND…: false when it never came true.
wait_for() {
    local end=$((SECONDS + $1))
    shift
    while [ $SECONDS -lt $end ]; do
        "$@" && return 0
        sleep 0.1
    done
    echo "never came true: $*" >&2
    tail -n 5 "$D"/log/slurm*.log >&2
    return 1
}

# Processes of this cluster (of node $1 alone): tasks, their step daemons, and the daemons themselves.
processes() {
    local pid
    for pid in /proc/[0-9]*; do
        pid=${pid#/proc/}
        [ "$pid" != $$ ] && [ "$pid" != "$BASHPID" ] || continue
        grep -qsz -x "SLURM_CONF=$SLURM_CONF" "/proc/$pid/environ" || continue
        [ $# = 0 ] || grep -qsz -x "SLURMD_NODENAME=$1" "/proc/$pid/environ" || continue
        [ "$(parent_of "$pid")" != $$ ] || continue # of this shell
        echo "$pid"
    done
}

parent_of() { cut -d' ' -f4 "/proc/$1/stat" 2>/dev/null || true; }

# As a power cut does it: the daemon, its step daemons and their tasks are gone at once.
kill_node() {
    local tasks steps="" task parent
    tasks=$(processes "$1")
    for task in $tasks; do
        parent=$(parent_of "$task")
        if grep -qs slurmstepd "/proc/$parent/comm"; then steps="$steps $parent"; fi
    done
    # shellcheck disable=SC2086
    kill -KILL "$(cat "$D/run/slurmd.$1.pid")" $steps $tasks 2>/dev/null || true
    scontrol update nodename="$1" state=down reason=killed
}

stop_cluster() {
    [ -e "$D/stopped" ] && return # without a controller scancel would wait for one
    touch "$D/stopped"
    scancel --user="$(id -un)" 2>/dev/null || true
    local file pid
    for file in "$D"/run/slurmctld.pid "$D"/run/slurmd.*.pid; do
        [ -s "$file" ] && kill "$(cat "$file")" 2>/dev/null || true
    done
    # The pid files go with the daemons; without a reaper their processes would stay as zombies.
    for _ in $(seq 50); do
        ls "$D"/run/slurm*.pid >/dev/null 2>&1 || break
        sleep 0.1
    done
    [ -s "$D/run/munged.pid" ] && kill "$(cat "$D/run/munged.pid")" 2>/dev/null || true
    # What a killed node left behind.
    for pid in $(processes); do kill -KILL "$pid" 2>/dev/null || true; done
}
