#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Called in the virtual machine for each of the kernel's events: names the emulated camera's capture device as udev would.
[[ ${SUBSYSTEM:-} == video4linux ]] || exit 0
name=/dev/v4l/by-id/usb-Cairn_UVC_camera-video-index0
case $ACTION in
  add)
    if grep -q 'Cairn' "/sys$DEVPATH/name" && [[ $(<"/sys$DEVPATH/index") == 0 ]]; then ln -sfn "/dev/$DEVNAME" "$name"; fi
    ;;
  remove) [[ $(readlink "$name") != "/dev/$DEVNAME" ]] || rm -f "$name" ;;
esac
