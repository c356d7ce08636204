#!/usr/bin/env bash
# slurm_test.sh MOCK_PROGRAM: a sweep on two nodes with a failing case, a requeued task and a node that dies. Exit 77: skipped.
set -euo pipefail
mock=$(realpath "$1")
for program in slurmctld slurmd munged sbatch scontrol squeue; do
    command -v "$program" >/dev/null || { echo "skipped: $program is not installed (scripts/setup --tests installs it)"; exit 77; }
done
getent ahostsv4 "$(hostname -s)" >/dev/null || { echo "skipped: this machine's own name, '$(hostname -s)', is unknown to it: /etc/hosts lacks it"; exit 77; }
# shellcheck source=tests/slurm/cluster.sh
. "$(dirname "$0")/cluster.sh"
D=$(mktemp -d)
chmod 755 "$D"
export SLURM_CONF=$D/slurm.conf
finish() {
    local code=$?
    stop_cluster
    if [ "$code" != 0 ] && [ -n "${KEEP_LOGS:-}" ]; then tail -n 20 "$D"/log/slurm*.log "$D"/out/*.txt 2>/dev/null || true; fi
    rm -rf "$D"
    exit "$code"
}
trap finish EXIT
fail() { echo "FAILED: $*"; exit 1; }
step() { echo "[$SECONDS s] $*"; }

start_cluster
step "two nodes are idle"

cat >"$D/sweep.yaml" <<CONFIG
sweep_of: mock
title: A mock
technique: mock
output: {width: 8, height: 8}
params: {pause_ms: 2500}
sweep:
  zip:
    - {number: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12], behaviour: [ok, ok, ok, ok, throw, ok, ok, ok, ok, ok, ok, ok]}
layout:
  rows: number
  columns:
    n: {metric: number, format: "{median:.0f}"}
CONFIG
cd "$D"
out=$D/out
"$mock" submit "$D/sweep.yaml" --device software --out "$out" --shards 4 --partition main --sbatch=--mem=64
field() { sed -n "s/.*\"$1\": \"\([0-9]*\)\".*/\1/p" "$out/submission.json"; }
array=$(field array_job)
merge=$(field merge_job)

# state TASK, node TASK: as squeue says.
state() { squeue -h -r -t all -j "$1" -o %T 2>/dev/null; }
node() { squeue -h -r -t all -j "$1" -o %N 2>/dev/null; }
has_rows() { grep -qs ',number,1,' "$out/shards/$1/records.csv"; }
is_over() { [[ $(state "$1") =~ ^(COMPLETED|FAILED|CANCELLED|TIMEOUT|NODE_FAIL)$ ]]; }

is_running() { [ "$(state "$1")" = RUNNING ]; }
wait_for 30 is_running "${array}_1"
"$mock" submit --status "$out" >"$D/status.txt" && fail "the status of an unfinished submission is 0"
grep -q 'RUNNING' "$D/status.txt" || fail "no shard is running"

# At one moment, on each node: shards that have measured something and are not over.
both_measure() {
    local k
    requeued=0 killed=""
    for k in 1 2 3 4; do
        has_rows "$k" && is_running "${array}_$k" || continue
        case $(node "${array}_$k") in
        n1) [ "$requeued" != 0 ] || requeued=$k ;;
        n2) killed="$killed $k" ;;
        esac
    done
    [ "$requeued" != 0 ] && [ -n "$killed" ]
}
wait_for 60 both_measure
step "shards on both nodes have measured something"
kill_node n2
step "killed node n2 with the shards$killed"
scontrol requeue "${array}_$requeued"
step "requeued shard $requeued"
slurmd -f "$SLURM_CONF" -N n2

wait_for 60 is_over "$merge"
step "the merge is $(state "$merge")"
cat "$out/merge.txt"
squeue -h -r -t all -j "$array" -o '%F_%K %T %N'

grep -q "merged 4 shards into $out: 11 of 12 measured, 1 failed, 0 missing" "$out/merge.txt" || fail "the merge is not complete"
"$mock" submit --status "$out" >"$D/status.txt" || true
cat "$D/status.txt"
[ "$(grep -c ' complete$' "$D/status.txt")" = 5 ] || fail "the status does not say complete five times"
# What was measured before the task went was not measured again: a case ends once in all logs (and once as a retry).
for k in 1 2 3 4; do
    [ -z "$(grep -h '"event":"case"' "$out/shards/$k/journal.jsonl" | grep '"status":"ok"' | sed 's/.*"case":"\([0-9a-f]*\)".*/\1/' | sort | uniq -d)" ] ||
        fail "shard $k measured a case twice"
done
[ "$(grep -c '"command"' "$out/shards/$requeued/manifest.json")" -ge 2 ] || fail "the requeued shard did not go on"
for k in $killed; do
    [ "$(grep -c '"command"' "$out/shards/$k/manifest.json")" -ge 2 ] || fail "shard $k of the dead node did not go on"
done

"$mock" run "$D/sweep.yaml" --device software --out "$D/one" --set pause_ms=0 --quiet >/dev/null 2>&1 && fail "a failing case is not told"
"$mock" table "$D/one" >/dev/null || true
for file in csv md tex; do
    cmp "$D/one/tables/sweep-mock.$file" "$out/tables/sweep-mock.$file" || fail "the merged table differs from one run's"
done
step "the merged tables are those of one run"

stop_cluster
left=$(processes)
[ -z "$left" ] || fail "left behind: $left"
step "passed; no process is left"
