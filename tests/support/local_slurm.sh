#!/bin/bash
# A Slurm of one node on this machine, for a test: local_slurm.sh start|stop FOLDER. All that it
# needs lies in FOLDER, whose slurm.conf is to be SLURM_CONF. Exit code 77, and why, where there is
# none: it takes Debian's slurm-wlm and munge, and root.
set -u
do=$1
folder=$2
name=$(hostname -s)

none() {
  echo "no Slurm here: $1"
  exit 77
}

# end FILE: the process whose id is in it.
end() {
  [ -s "$1" ] || return 0
  local id
  id=$(cat "$1")
  kill "$id" 2> /dev/null
  for _ in $(seq 50); do
    kill -0 "$id" 2> /dev/null || return 0
    sleep 0.1
  done
  kill -9 "$id" 2> /dev/null
}

if [ "$do" = stop ]; then
  end "$folder/slurmd.pid"
  end "$folder/slurmctld.pid"
  end "$folder/munge/munged.pid"
  exit 0
fi

for program in munged slurmctld slurmd sbatch squeue scontrol sinfo; do
  command -v $program > /dev/null || [ -x /usr/sbin/$program ] || none "there is no $program"
done
[ "$(id -u)" = 0 ] || none "slurmd runs as root only"
getent hosts "$name" > /dev/null || none "the name of this machine, $name, has no address"

mkdir -p "$folder/state" "$folder/spool" "$folder/munge"
chmod 755 "$folder"
head -c 1024 /dev/urandom > "$folder/munge/key"
chmod 600 "$folder/munge/key"
chown -R munge: "$folder/munge"
port=$((20000 + RANDOM % 20000))
cat > "$folder/slurm.conf" << TEXT
ClusterName=test
SlurmctldHost=$name(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_min_interval=100000,batch_sched_delay=0
ReturnToService=2
MaxArraySize=5
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
MinJobAge=300
NodeName=$name NodeAddr=127.0.0.1 CPUs=2 Boards=1 SocketsPerBoard=1 CoresPerSocket=2 ThreadsPerCore=1
PartitionName=batch Nodes=$name Default=YES MaxTime=INFINITE State=UP
TEXT
export SLURM_CONF=$folder/slurm.conf PATH=$PATH:/usr/sbin

runuser -u munge -- munged --key-file="$folder/munge/key" --socket="$folder/munge/socket" \
  --pid-file="$folder/munge/munged.pid" --log-file="$folder/munge/log" \
  --seed-file="$folder/munge/seed" > "$folder/munged.out" 2>&1 ||
  none "munged does not start: $(tail -n 1 "$folder/munged.out")"
slurmctld > "$folder/slurmctld.out" 2>&1 || none "slurmctld does not start"
slurmd > "$folder/slurmd.out" 2>&1 || none "slurmd does not start"
for _ in $(seq 200); do
  [ "$(sinfo --noheader --format=%t 2> /dev/null)" = idle ] && exit 0
  sleep 0.1
done
none "the node does not become idle"
