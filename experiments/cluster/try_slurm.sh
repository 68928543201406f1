#!/usr/bin/env bash
# experiments/cluster/try_slurm.sh [--installed-only] [FOLDER]: tries the workflow on a real Slurm,
# on this machine alone. FOLDER has scalefcn-experiment and labeling-solve (build/release/bin).
#
# Starts munged, slurmctld and slurmd with a configuration of their own in a scratch folder, makes a
# small campaign through Snakemake's Slurm executor, and spoils it: the slurmstepd of one run is
# killed with SIGKILL, so that its processes are left behind; then Snakemake itself is killed, and a
# second run cancelled. Snakemake, started again, completes the campaign; what was left behind is
# let go and writes its record too. In the end the campaign must hold what a local one holds.
#
# Installs what is missing (Debian, as root); with --installed-only it does not. Where this cannot be
# tried it says "skipped: ..." and succeeds. Everything is stopped and removed at the end.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
cluster="$root/experiments/cluster"
python="$root/build/experiments-venv/bin/python"
packages=(slurmctld slurmd slurm-client munge)
may_install=yes
if [ "${1:-}" = --installed-only ]; then
    may_install=no
    shift
fi
programs=${1:-$root/build/release/bin}
patience=60 # seconds for anything to happen

say() { printf '== %s\n' "$*"; }
skip() {
    printf 'skipped: %s\n' "$*"
    exit 0
}
fail() {
    printf 'failed: %s\n' "$*" >&2
    exit 1
}

require_programs() {
    [ -x "$programs/scalefcn-experiment" ] || skip "no $programs/scalefcn-experiment (./test builds it)"
    PATH="$PATH:/usr/sbin:/sbin"
    local missing=no name
    for name in slurmctld slurmd sbatch srun squeue scancel munged; do
        command -v "$name" >/dev/null || missing=yes
    done
    if [ "$missing" = yes ]; then
        local words="apt-get install -y --no-install-recommends ${packages[*]}"
        [ "$(id -u)" -eq 0 ] || skip "Slurm is not installed; as root, type: $words"
        [ "$may_install" = yes ] || skip "Slurm is not installed; type: $words"
        command -v apt-get >/dev/null || skip "Slurm is not installed, and this is not Debian"
        say "installing: ${packages[*]}"
        apt-get update -q >/dev/null
        DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends \
            "${packages[@]}" >/dev/null
    fi
    [ "$(id -u)" -eq 0 ] || skip "slurmd wants to be started by root"
    if ! "$python" -c 'import snakemake, snakemake_executor_plugin_slurm' 2>/dev/null; then
        [ "$may_install" = yes ] || skip "no Snakemake; type: scripts/setup_experiments.sh"
        "$root/scripts/setup_experiments.sh"
    fi
}

# --- Daemons -----------------------------------------------------------------------------------

daemons=() # process ids, in the order of their start

start() {
    local name=$1
    shift
    "$@" >"$scratch/log/$name.out" 2>&1 &
    daemons+=($!)
}

# A moment, unless the shell is told to go on.
pause() { read -r -t 0.2 <>"$scratch/pause" || true; }

# wait_until COMMAND...: false when it does not come true in time.
wait_until() {
    local end=$((SECONDS + patience))
    until "$@" >/dev/null 2>&1; do
        [ "$SECONDS" -lt "$end" ] || return 1
        pause
    done
}

stop_process() {
    kill "$1" 2>/dev/null || return 0
    local end=$((SECONDS + 10))
    while kill -0 "$1" 2>/dev/null; do
        if [ "$SECONDS" -ge "$end" ]; then
            kill -KILL "$1" 2>/dev/null || true
            break
        fi
        pause
    done
    wait "$1" 2>/dev/null || true
}

# has_words /proc/ID WORDS: in the process's command?
has_words() {
    local command
    { command=$(tr '\0' ' ' <"$1/cmdline"); } 2>/dev/null || return 1
    [[ $command == *"$2"* ]]
}

# Processes whose command names the scratch folder are of this trial: its jobs, and what is left of
# those that were killed.
leftovers() {
    local entry
    for entry in /proc/[0-9]*; do
        if has_words "$entry" "$scratch" && [ "${entry#/proc/}" != "$$" ]; then
            printf '%s\n' "${entry#/proc/}"
        fi
    done
}

clean_up() {
    local status=$? k
    trap - EXIT
    set +e
    [ -z "${workflow:-}" ] || kill -KILL "$workflow" 2>/dev/null
    if [ "${#daemons[@]}" -eq 3 ]; then scancel --user="$(id -u)" >/dev/null 2>&1; fi
    for ((k = ${#daemons[@]} - 1; k >= 0; --k)); do stop_process "${daemons[k]}"; done
    for k in $(leftovers); do kill -KILL "$k" 2>/dev/null; done
    if [ "$status" -ne 0 ]; then
        for k in "$scratch"/log/*; do
            printf -- '--- %s\n' "$k" >&2
            tail -n 40 "$k" >&2
        done
    fi
    cd / && rm -rf "$scratch"
    exit "$status"
}

free_ports() {
    "$python" -c 'import socket
sockets = [socket.socket() for _ in range(2)]
for s in sockets: s.bind(("127.0.0.1", 0))
print(*(s.getsockname()[1] for s in sockets))'
}

# One node that claims four processors, so that what hangs leaves room for others. No cgroups, no
# accounting: what a container has not got is not needed. A dead job is for Snakemake to make again.
write_configuration() {
    local host ports
    host=$(uname -n)
    host=${host%%.*}
    read -r -a ports <<<"$(free_ports)"
    cat >"$scratch/slurm.conf" <<TEXT
ClusterName=trial
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=${ports[0]}
SlurmdPort=${ports[1]}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$scratch/munge/socket
CredType=cred/munge
StateSaveLocation=$scratch/state
SlurmdSpoolDir=$scratch/spool
SlurmctldPidFile=$scratch/slurmctld.pid
SlurmdPidFile=$scratch/slurmd.pid
SlurmctldLogFile=$scratch/log/slurmctld.log
SlurmdLogFile=$scratch/log/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=2,bf_interval=2
SlurmdParameters=config_overrides
SlurmdTimeout=30
BatchStartTimeout=1
ReturnToService=2
JobRequeue=0
KillWait=2
MinJobAge=3600
NodeName=$host NodeAddr=127.0.0.1 CPUs=4 RealMemory=8000 State=UNKNOWN
PartitionName=trial Nodes=$host Default=YES MaxTime=INFINITE State=UP
TEXT
}

start_slurm() {
    mkdir "$scratch"/{munge,state,spool,log,bin}
    head -c 128 /dev/urandom >"$scratch/munge/key"
    chmod 600 "$scratch/munge/key"
    write_configuration
    export SLURM_CONF="$scratch/slurm.conf"
    # The executor's job step forgets every SLURM_ variable, this one too.
    printf '#!/bin/sh\nSLURM_CONF=%q exec %q "$@"\n' "$SLURM_CONF" "$(command -v srun)" \
        >"$scratch/bin/srun"
    chmod +x "$scratch/bin/srun"
    export PATH="$scratch/bin:$PATH"

    start munged munged --foreground --socket="$scratch/munge/socket" \
        --key-file="$scratch/munge/key" --log-file="$scratch/log/munged.log" \
        --pid-file="$scratch/munge/pid" --seed-file="$scratch/munge/seed"
    wait_until munge --socket="$scratch/munge/socket" --no-input ||
        skip "munged does not start here: $(tail -n 1 "$scratch/log/munged.out")"
    start slurmctld slurmctld -D
    wait_until scontrol ping ||
        skip "slurmctld does not start here: $(tail -n 1 "$scratch/log/slurmctld.out")"
    start slurmd slurmd -D
    wait_until timeout 5 srun --time=1 --mem=10 true ||
        skip "slurmd runs no jobs here: $(tail -n 1 "$scratch/log/slurmd.out")"
}

# --- The campaign ------------------------------------------------------------------------------

# Runs of the solver "patient" say that they have started, and the first time, once they are armed,
# wait for what never comes. So they are killed in the middle for sure, on a machine of any speed.
write_campaign() {
    mkfifo "$scratch/started"
    cat >"$scratch/patient.sh" <<TEXT
#!/bin/sh
if [ -e "$scratch/armed" ]; then
    echo "\$4 \${SLURM_JOB_ID:-0}" >"$scratch/started"
    if mkfifo "$scratch/never.\$4" 2>/dev/null; then read -r _ <"$scratch/never.\$4"; fi
fi
exec "$programs/labeling-solve" "\$1" --solver auto --work 200000 --seed "\$4" -o "\$2" --result "\$3"
TEXT
    chmod +x "$scratch/patient.sh"
    cat >"$scratch/campaign.toml" <<TEXT
name = "trial"
seeds = [1, 2]
[limits]
work = 200000
memory = "500MiB"
[[problems]]
family = "chain"
labels = [30, 60]
[[problems]]
family = "planted"
cliques = 20
[[solvers]]
solver = "greedy"
problems = ["chain*"]
[[solvers]]
solver = "auto"
problems = ["chain*"]
[[solvers]]
name = "patient"
program = "$scratch/patient.sh {problem} {solution} {result} {seed}"
time = 600
problems = ["planted*"]
TEXT
}

start_workflow() {
    "$python" -m snakemake -s "$cluster/Snakefile" --profile "$cluster/profile" \
        --slurm-status-command squeue --slurm-init-seconds-before-status-checks 2 "$@" \
        --config campaign="$scratch/campaign.toml" output="$scratch/slurm" \
        program="$programs/scalefcn-experiment" unlimited_minutes=10 plan_minutes=10 \
        plan_memory_mib=500 memory_overhead_mib=500 >>"$scratch/log/snakemake.out" 2>&1 &
    workflow=$!
}

# wait_for_start: which run has started in which job, "SEED JOB".
wait_for_start() {
    read -r -t "$((2 * patience))" seed job <>"$scratch/started" || fail "no run has started"
}

# The processes that watch over a job: slurmstepd calls itself "slurmstepd: [JOB.STEP]".
step_daemons() {
    local entry
    for entry in /proc/[0-9]*; do
        if has_words "$entry" "slurmstepd: [$1."; then printf '%s\n' "${entry#/proc/}"; fi
    done
}

# Slurm notices by itself in its own time; this has it look at the node now.
is_noticed() {
    scontrol reconfigure
    local k
    for k in 1 2 3 4 5 6 7 8; do pause; done
    [ "$(squeue --noheader --format=%T --states=all --jobs="$1")" != RUNNING ]
}

spoil() {
    local first_seed first_job second_job
    wait_for_start
    first_seed=$seed first_job=$job
    wait_for_start
    second_job=$job
    [ "$seed" != "$first_seed" ] || fail "a run has started twice: seed $seed"

    say "killing every slurmstepd of job $first_job"
    step_daemons "$first_job" | xargs kill -KILL
    wait_until is_noticed "$first_job" || fail "Slurm does not notice that job $first_job is dead"
    wait_for_start
    [ "$seed" = "$first_seed" ] || fail "seed $seed has started, not $first_seed"
    [ "$job" != "$first_job" ] || fail "the killed job runs again"
    say "made again as job $job; killing Snakemake, then cancelling job $second_job"
    kill -KILL "$workflow"
    wait "$workflow" 2>/dev/null || true
    scancel "$second_job"
    spoiled_seed=$first_seed
}

complete() {
    say "starting Snakemake again"
    start_workflow --unlock
    wait "$workflow" || fail "Snakemake's lock stays"
    start_workflow
    # The cancelled run starts for the second time: somebody must read that it does.
    wait_for_start
    wait "$workflow" || fail "the campaign is not completed"
    workflow=""
}

records_sum() { cat "$scratch"/slurm/records/*.json | sha256sum; }

# No run of the campaign is under way.
is_alone() {
    local entry
    for entry in /proc/[0-9]*; do
        if has_words "$entry" "scalefcn-experiment execute $scratch/slurm"; then return 1; fi
    done
}

# What the killed slurmstepd left behind ends its run: too late, so nothing may come of it.
let_go() {
    local before
    before=$(records_sum)
    if is_alone; then
        say "nothing was left behind by the killed job"
        return
    fi
    timeout "$patience" sh -c ": >\"$scratch/never.$spoiled_seed\""
    wait_until is_alone || fail "what was left behind does not end"
    [ "$before" = "$(records_sum)" ] || fail "what was left behind has changed a record"
    [ "$("$programs/scalefcn-experiment" merge "$scratch/slurm")" = "0 new records" ] ||
        fail "what was left behind has left a record"
    say "what the killed job left behind has ended, and changed nothing"
}

require_programs
scratch=$(mktemp -d "${TMPDIR:-/tmp}/scalefcn-slurm.XXXXXX")
chmod 755 "$scratch" # munged wants its socket to be reachable by all
mkfifo "$scratch/pause"
trap clean_up EXIT
trap 'exit 130' INT TERM
cd "$scratch"
start_slurm
write_campaign
say "$(squeue --version) runs; the campaign on this machine"
"$programs/scalefcn-experiment" run campaign.toml -o local --quiet
touch armed
say "the same through Slurm"
start_workflow
spoil
complete
let_go
say "took $SECONDS s"
"$cluster/same_answers.py" local slurm
