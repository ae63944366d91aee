#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the installed systemd units as systemd would, in a folder of their own: a core that is in a team, its peer process,
# and the program for ROS. Each must take the words of its unit and of its file in /etc/cairn, and end at SIGTERM.
#   tools/ci/check_units.sh PREFIX      where Cairn was installed, such as /usr
set -euo pipefail

prefix=${1:?usage: tools/ci/check_units.sh PREFIX}
units=$prefix/lib/systemd/system
place=$(mktemp -d --tmpdir cairn-units.XXXXXX)
processes=()
end() {
  ((${#processes[@]} == 0)) || kill "${processes[@]}" 2>/dev/null || true
  rm -rf "$place"
}
trap end EXIT
mkdir "$place"/{etc,run,var,units}
domain=$((RANDOM % 90 + 100)) port=$((RANDOM % 12000 + 20000))  # below those that the system hands out

# Paths of the machine become paths of the folder.
for unit in cairn cairn-peers cairn-ros; do
  [[ -f $units/$unit.service ]] || { echo "$units/$unit.service is not installed" >&2; exit 1; }
  sed -e "s#/usr/bin/#$prefix/bin/#g" -e "s#/etc/cairn#$place/etc#g" -e "s#/run/cairn#$place/run#g" \
    -e "s#/var/lib/cairn#$place/var#g" "$units/$unit.service" >"$place/units/$unit.service"
done
if command -v systemd-analyze >/dev/null; then
  systemd-analyze verify --man=no "$place"/units/*.service 2>"$place/said" || true
  if grep -E "$place/units" "$place/said" | grep -Ev 'Failed to (load|open)|not found|unit name'; then exit 1; fi
fi

cat >"$place/etc/robot.yaml" <<YAML
lidar: {bind_address: 127.0.0.1, data_port: $port, position_port: $((port + 1))}
team: {id: 1, socket: $place/run/peers.sock}
YAML
echo 'CORE="--peers"' >"$place/etc/core.env"
echo "PEERS=\"--robot 1 --interface lo --peer 127.0.0.1 --domain $domain\"" >"$place/etc/peers.env"
echo "ROS=\"--namespace husky --interface lo --domain $((domain + 1))\"" >"$place/etc/ros.env"

# start UNIT: its ExecStart with its EnvironmentFile, in the background.
start() {
  local unit=$place/units/$1.service file words
  file=$(sed -n 's/^EnvironmentFile=-\{0,1\}//p' "$unit")
  words=$(sed -n 's/^ExecStart=//p' "$unit")
  (
    # shellcheck disable=SC1090  # one of the three above
    . "$file"
    eval "exec $words"
  ) >"$place/$1.log" 2>&1 &
  processes+=($!)
}
# Waits until the file is there, while the last process runs.
until_there() {
  for ((i = 0; i < 600; ++i)); do
    [[ ! -e $1 ]] || return 0
    kill -0 "${processes[-1]}" 2>/dev/null || break
    sleep 0.1
  done
  echo "$1 did not come" >&2
  cat "$place"/*.log >&2
  exit 1
}

start cairn
until_there "$place/run/robot.sock"
until_there "$place/run/peers.sock"
start cairn-peers
start cairn-ros
for ((i = 0; i < 600; ++i)); do
  ! grep -q 'topics below /husky' "$place/cairn-ros.log" || break
  sleep 0.1
done
((i < 600)) || { echo "cairn-ros named no topics in a minute" >&2; cat "$place"/*.log >&2; exit 1; }
sleep 1
for process in "${processes[@]}"; do
  kill -0 "$process" || { echo "a service ended by itself" >&2; cat "$place"/*.log >&2; exit 1; }
done
for ((i = ${#processes[@]} - 1; i >= 0; --i)); do
  kill "${processes[i]}"
  code=0
  wait "${processes[i]}" || code=$?
  # The core says 1: not one scan came in.
  ((code == 0 || (i == 0 && code == 1))) || { echo "a service ended with $code at SIGTERM" >&2; cat "$place"/*.log >&2; exit 1; }
done
processes=()
grep -q '"merged_with"' "$place/var/report.json" || { echo "the core was in no team: $place/var/report.json" >&2; exit 1; }
echo "units: cairn, cairn-peers and cairn-ros start, take part in a team, and end when they are told to"
