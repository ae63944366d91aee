#!/bin/busybox sh
# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=dash
# The virtual machine's first process: loads the modules, lays what run.sh has packed and a tmpfs over the host's root
# filesystem (9p, read-only) and runs guest.sh there. Its exit code goes to the second serial port; without that line the run counts as failed.
/bin/busybox --install -s /bin
export PATH=/bin

finish() {
  echo "exit $1" >/dev/ttyS1
  poweroff -f
}
fail() {
  echo "vm: $*: FAILED"
  finish 1
}

mkdir -p /proc /sys /dev /host /over /new
mount -t proc proc /proc
mount -t sysfs sysfs /sys
mount -t devtmpfs dev /dev
echo "vm: kernel $(uname -r) $(grep -q PREEMPT_RT /proc/version && echo PREEMPT_RT) after $(cut -d ' ' -f 1 /proc/uptime) s"
while read -r module options; do
  # shellcheck disable=SC2086  # options are split on purpose
  insmod "/modules/$module" $options || fail "loading $module"
done </modules/order

mount -t 9p -o ro,trans=virtio,version=9p2000.L,msize=512000,cache=loose host /host || fail "mounting the host's root"
mount -t tmpfs over /over && mkdir /over/upper /over/work
mount -t overlay -o lowerdir=/packed:/host,upperdir=/over/upper,workdir=/over/work root /new || fail "laying the packed files and a tmpfs over it"
for folder in proc sys dev; do mount --move "/$folder" "/new/$folder"; done
mkdir -p /new/dev/pts /new/dev/shm
mount -t devpts pts /new/dev/pts
mount -t tmpfs shm /new/dev/shm
mount -t configfs config /new/sys/kernel/config
ip link set lo up
cp /job /new/dev/shm/
echo "vm: the host's root after $(cut -d ' ' -f 1 /new/proc/uptime) s"

# shellcheck source=/dev/null
. /job
chroot /new /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp LANG=C.UTF-8 \
  /bin/bash "$VM_PROJECT/tests/vm/guest.sh" /dev/shm/job
code=$?
echo "vm: done after $(cut -d ' ' -f 1 /new/proc/uptime) s"
sync
echo "exit $code" >/new/dev/ttyS1
poweroff -f
