#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Inside the virtual machine, on the host's root filesystem: makes the devices, then runs the device tests, or the command
# that the job names.   guest.sh JOB
# shellcheck source=/dev/null
set -uo pipefail
source "$1"
source "$VM_PROJECT/tests/vm/devices.sh"
bad=0

# try NAME PROGRAM [VARIABLE=VALUE…]: a GoogleTest program has to pass, and at least one of its tests has to run.
try() {
  local name=$1 program=$VM_PROGRAMS/$2 log=/tmp/$2.log begin=$SECONDS code=0 passed
  shift 2
  [[ -x $program ]] || return 0
  found=yes
  env "$@" timeout -k 5 "$VM_LIMIT" "$program" --gtest_color=no 2>&1 | tee "$log" || code=$?
  passed=$(sed -n 's/^\[  PASSED  \] \([0-9]*\) test.*/\1/p' "$log")
  if ((code != 0)); then
    echo "vm: $name: FAILED (exit code $code)"
    sed -n 's/^\[  FAILED  \] \([^ ]*\.[^ ]*\).*/vm:   \1/p' "$log" | sort -u
    bad=1
  elif ((${passed:-0} == 0)); then
    echo "vm: $name: FAILED (none of its tests ran: the device was not there)"
    bad=1
  else
    echo "vm: $name: ok, $passed tests in $((SECONDS - begin)) s$(sed -n 's/^\[  SKIPPED \] \([0-9]*\) test.*/, \1 skipped/p' "$log")"
  fi
}

make_devices || exit 1
if [[ -n $VM_COMMAND ]]; then
  bash -c "$VM_COMMAND"
  exit
fi
found=''
try "drive on vcan" test_drive_device
try "drive on two SJA1000" test_drive_device CAIRN_TEST_CAN=can0 CAIRN_TEST_CAN_PEER=can1
try "GPIO on gpio-sim" test_gpio_device
try "e-stop to motors" test_estop_device
try "camera on vivid" test_camera_device CAIRN_TEST_VIDEO_EARLY=1
camera="$VM_PROJECT/tests/vm/camera.sh $VM_PROGRAMS/uvc_camera"
try "camera on uvcvideo" test_camera_device CAIRN_TEST_VIDEO="$CAIRN_TEST_UVC" CAIRN_TEST_VIDEO_RAMP=1 \
  CAIRN_TEST_VIDEO_UNPLUG="$camera unplug" CAIRN_TEST_VIDEO_REPLUG="$camera plug" \
  CAIRN_TEST_VIDEO_CYCLES="$VM_CYCLES"
# What a user does with all of them at once. The frames and edges are made once the recording runs, and end it.
record_everything() {
  local log=/tmp/record.log drive_log=/tmp/bring_up.log recorder
  cat >/tmp/robot.yaml <<YAML
name: vm
lidar: {enabled: false}
thermal: {capture: {device: $CAIRN_TEST_UVC, width: 160, height: 120, rate_hz: 9}}
drive: {interface: vcan0}
gpio: {chip: $CAIRN_TEST_GPIOCHIP, estop_line: "0"}
YAML
  "$VM_PROGRAMS/cairn" doctor --config /tmp/robot.yaml --seconds 1 | tee "$log"
  timeout -k 5 "$VM_LIMIT" "$VM_PROGRAMS/cairn" record --config /tmp/robot.yaml --out /tmp/recorded >/tmp/recorder.log 2>&1 &
  recorder=$!
  until compgen -G '/tmp/recorded*/thermal/data/*' >/dev/null; do  # a camera may need a second start
    kill -0 "$recorder" 2>/dev/null || break
    sleep 0.1
  done
  for level in pull-up pull-down pull-up pull-down; do
    echo "$level" >"$CAIRN_TEST_GPIOSIM/sim_gpio0/pull"
    sleep 0.2
  done
  "$VM_PROGRAMS/test_drive_device" --gtest_filter='*BringsACia402DriveUp*' >"$drive_log" 2>&1 || cat "$drive_log"
  kill -TERM "$recorder"
  wait "$recorder"
  tee -a "$log" </tmp/recorder.log
  "$VM_PROGRAMS/cairn" doctor --recording /tmp/recorded | tee -a "$log"
  if (($(grep -Ec '^ok: (thermal|drive|gpio): [1-9][0-9]* packets, none lost' "$log") == 3)); then
    sed -n 's/^ok: \([a-z]*: [0-9]* packets, none lost\)/vm: recorded \1/p' "$log"
    echo "vm: doctor and record: ok"
  else
    echo "vm: doctor and record: FAILED"
    bad=1
  fi
}
[[ ! -x $VM_PROGRAMS/cairn ]] || record_everything
[[ -n $found ]] || echo "vm: no test_*_device program in $VM_PROGRAMS; the devices alone came up"
exit "$bad"
