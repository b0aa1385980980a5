#!/bin/sh
# `blind --slurm` and `fleet --slurm` under a SLURM of one node on this machine, from Debian's packages: controller, node
# and munge by files of a temporary folder, on the loopback interface alone, stopped at the end. Merged results must be
# the single run's byte for byte, with a shard killed half-way and begun again, and with a node that fails.
#
#   tests/slurm_test.sh STIFFSCOPE [CASES [CAMPAIGNS]]
#
# Ends with 77 (skipped) where SLURM or munge is not installed, or the user is not root, as whom slurmd runs.
set -eu
stiffscope=$(realpath "$1")
cases=${2:-8}
campaigns=${3:-6}
source=$(cd "$(dirname "$0")/.." && pwd)
PATH=$PATH:/usr/sbin:/sbin
for needed in slurmctld slurmd sbatch squeue scontrol scancel munged; do
  command -v $needed >/dev/null || { echo "skipped: no $needed (apt-get install slurm-wlm munge)"; exit 77; }
done
[ "$(id -u)" = 0 ] || { echo "skipped: slurmd wants to be root"; exit 77; }

work=$(mktemp -d /tmp/stiffscope-slurm-XXXXXX)
munge_id= controller_id= node_id=
stop() {
  status=$?
  [ -n "$node_id" ] && scancel --quiet --user=root 2>/dev/null
  for id in $node_id $controller_id $munge_id; do kill "$id" 2>/dev/null || true; done
  for id in $node_id $controller_id $munge_id; do wait "$id" 2>/dev/null || true; done
  [ $status = 0 ] && rm -rf "$work" || echo "kept: $work"
  exit $status
}
trap stop EXIT
trap 'exit 1' INT TERM

# --- A SLURM of one node
port=$((20000 + $$ % 20000))
mkdir "$work/state" "$work/spool" "$work/munge"
chmod 700 "$work/munge"
dd if=/dev/urandom of="$work/munge/key" bs=1024 count=1 2>/dev/null
chmod 400 "$work/munge/key"
munged --foreground --force --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
  --log-file="$work/munge/log" --seed-file="$work/munge/seed" 2>"$work/munge/errors" &
munge_id=$!
cat >"$work/slurm.conf" <<EOF
ClusterName=stiffscope
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=root
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$work/munge/socket
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SchedulerParameters=sched_interval=2,batch_sched_delay=1
KillWait=2
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES State=UP MaxTime=INFINITE
EOF
export SLURM_CONF="$work/slurm.conf"
slurmctld -D >"$work/slurmctld.out" 2>&1 &
controller_id=$!
slurmd -D >"$work/slurmd.out" 2>&1 &
node_id=$!
for try in $(seq 60); do
  [ "$(sinfo --noheader --format=%T 2>/dev/null)" = idle ] && break
  [ "$try" = 60 ] && { echo "SLURM does not start"; tail -5 "$work"/slurm*.log "$work"/*.out; exit 1; }
  sleep 1
done
echo "SLURM $(sinfo --version | cut -d' ' -f2), one node of $(nproc) cores, idle"

# --- Helpers
begin=0
clock() { begin=$(date +%s); }
took() { echo "$1: $(($(date +%s) - begin)) s"; }
idle() {
  while [ -n "$(squeue --noheader)" ]; do sleep 1; done
}
# Waits until so many files of a kind are there.
until_there() {
  while [ "$(find "$1" -name "$2" 2>/dev/null | wc -l)" -lt "$3" ]; do
    [ -n "$(squeue --noheader)" ] || { echo "jobs ended early"; exit 1; }
    sleep 0.2
  done
}
same() {
  for file in $3; do cmp "$1/$file" "$2/$file"; done
  echo "the same bytes: $3"
}
cd "$work"

# --- blind in four shards; one is killed half-way, and submitted again
clock
"$stiffscope" blind --cases "$cases" --seed 5 --out single --discard >/dev/null 2>&1
took "blind of $cases on one machine"
clock
"$stiffscope" blind --cases "$cases" --seed 5 --out shared --discard --slurm 4 >submitted
cat submitted
job=$(sed -n 's/.*array.sh: job \([0-9]*\),.*/\1/p' submitted)
until_there shared/parts '*.answer' 1
scancel --signal=KILL --full "${job}_1" || scancel "${job}_1"
echo "killed: shard 1 of 4, with $(find shared/parts -name '*.answer' | wc -l) of $cases cases answered"
idle
if [ -e shared/results.json ]; then echo "shard 1 had ended before it was killed"; else tail -1 shared/slurm/merge.log; fi
done_before=$(find shared/parts -name '*.answer' | wc -l)
"$stiffscope" blind --cases "$cases" --seed 5 --out shared --discard --slurm 4 >submitted
idle
took "blind in four shards, killed and begun again with $done_before of $cases done"
same single shared "labels.csv answers.csv distances.csv seal.txt results.json blind.html"

# --- fleet in four shards; the node fails while it works
for i in $(seq "$campaigns"); do
  machine=$(((i + 4) / 5)) date=$((10 + i % 5))
  sed -e "s/seed=\"20170924\" measurement=\"2\"/seed=\"$machine\" measurement=\"$i\"/" -e "s/count=\"19\"/count=\"10\"/" \
    -e "s/repeats=\"3\"/repeats=\"2\"/" -e "s/count=\"20\"/count=\"8\"/" -e "s/readings=\"1000\"/readings=\"60\"/" \
    -e "s/date=\"2026-11-21\"/date=\"2026-01-$date\"/" -e "s#urdf=\"#urdf=\"$source/samples/#" \
    "$source/samples/active.xml" >day.xml
  mkdir -p "fleet/M$machine"
  "$stiffscope" simulate day.xml --out "fleet/M$machine/2026-01-$date" >/dev/null
done
mkdir -p fleet/M1/broken
echo '<campaign format="1" name="broken"/>' >fleet/M1/broken/campaign.xml
clock
"$stiffscope" fleet fleet --out one --springs-only >/dev/null
took "fleet of $campaigns, and one that is broken, on one machine"
clock
"$stiffscope" fleet fleet --out many --springs-only --slurm 4 >submitted
cat submitted
until_there many/campaigns '*.json' 1
scontrol update nodename="$(hostname -s)" state=down reason=test
echo "node down with $(find many/campaigns -name '*.json' | wc -l) of $((campaigns + 1)) campaigns done: $(squeue --noheader --format=%T | sort | uniq -c | tr -s ' ' | tr '\n' ' ')"
sleep 3
# It may have come back by itself (ReturnToService).
scontrol update nodename="$(hostname -s)" state=resume 2>/dev/null || true
idle
took "fleet in four shards, with a failed node"
same one many "fleet.csv fleet.jsonl changes.csv steps.csv detectable.csv needs.csv fleet.html"
echo "passed"
