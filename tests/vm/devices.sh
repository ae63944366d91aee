# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# Sourced by guest.sh: make_devices sets the virtual machine's devices up and exports their names for the tests.
#   CAIRN_TEST_CAN        vcan0, which also carries CAN FD
#   CAIRN_TEST_CAN_SLOW   vcan1, which carries 60 frames a second and queues 20: emulated controllers send at once
#   CAIRN_TEST_CAN_A, _B  can0 and can1: two SJA1000 on one bus, 500 kbit/s
#   CAIRN_TEST_GPIOCHIP   /dev/gpiochipN of gpio-sim, eight lines
#   CAIRN_TEST_GPIOSIM    its folder in sysfs: sim_gpioL/pull moves an input, sim_gpioL/value shows an output
#   CAIRN_TEST_VIDEO      vivid's capture device
#   CAIRN_TEST_UVC        the emulated camera (uvc_frames.hpp says what it shows), by a name that survives its replugging

complain() {
  echo "vm: $*: FAILED"
  return 1
}

make_can() {
  ip link add vcan0 type vcan && ip link set vcan0 mtu 72 up || return
  local card
  for card in can0 can1; do
    ip link set "$card" type can bitrate 500000 restart-ms 100 && ip link set "$card" up || return
  done
  ip link add vcan1 type vcan && ip link set vcan1 up && tc qdisc add dev vcan1 root netem rate 8kbit limit 20 || return
  export CAIRN_TEST_CAN=vcan0 CAIRN_TEST_CAN_SLOW=vcan1 CAIRN_TEST_CAN_A=can0 CAIRN_TEST_CAN_B=can1
}

make_gpio() {
  local config=/sys/kernel/config/gpio-sim/cairn chip device
  mkdir -p "$config/bank0" && echo 8 >"$config/bank0/num_lines" && echo 1 >"$config/live" || return
  chip=$(<"$config/bank0/chip_name") device=$(<"$config/dev_name")
  export CAIRN_TEST_GPIOCHIP=/dev/$chip CAIRN_TEST_GPIOSIM=/sys/devices/platform/$device/$chip
  [[ -c $CAIRN_TEST_GPIOCHIP && -d $CAIRN_TEST_GPIOSIM ]]
}

make_cameras() {
  local vivid
  vivid=$(grep -l '^vivid.*-vid-cap$' /sys/class/video4linux/*/name | head -n 1) && [[ -n $vivid ]] || return
  vivid=${vivid%/name}
  "$VM_PROJECT/tests/vm/camera.sh" "$VM_PROGRAMS/uvc_camera" plug || return
  export CAIRN_TEST_VIDEO=/dev/${vivid##*/} CAIRN_TEST_UVC=/dev/v4l/by-id/usb-Cairn_UVC_camera-video-index0
  [[ -c $CAIRN_TEST_UVC ]]
}

make_devices() {
  make_can || complain "CAN interfaces" || return
  make_gpio || complain "gpio-sim" || return
  make_cameras || complain "cameras" || return
  echo "vm: devices after $(cut -d ' ' -f 1 /proc/uptime) s: $CAIRN_TEST_CAN $CAIRN_TEST_CAN_A $CAIRN_TEST_CAN_B" \
    "$CAIRN_TEST_GPIOCHIP $CAIRN_TEST_VIDEO $(readlink -f "$CAIRN_TEST_UVC")"
}
