#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# In the virtual machine: plugs the emulated camera in or out, and names its capture device as udev would.
#   camera.sh PROGRAM plug|unplug      PROGRAM: uvc_camera
set -euo pipefail
readonly link=/dev/v4l/by-id/usb-Cairn_UVC_camera-video-index0

capture_device() {  # the node with pictures; the other one holds metadata
  local node
  for node in /sys/class/video4linux/video*; do
    if grep -qs Cairn "$node/name" && [[ $(cat "$node/index" 2>/dev/null) == 0 ]]; then
      echo "/dev/${node##*/}"
      return
    fi
  done
  return 1
}

case $2 in
  plug)
    "$1" plug
    for ((tenths = 0; tenths < 300; ++tenths)); do
      if device=$(capture_device); then
        mkdir -p "${link%/*}"
        ln -sfn "$device" "$link"
        exit
      fi
      sleep 0.1
    done
    exit 1
    ;;
  unplug)
    "$1" unplug
    rm -f "$link"
    ;;
esac
