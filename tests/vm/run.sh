#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The drivers' device tests on a real Linux kernel: boots Debian's 6.12 in QEMU with this machine's root filesystem
# (read-only), gives it CAN controllers, cameras and GPIO lines, and runs there the test_*_device programs there are.
#   tests/vm/run.sh [--rt] [--build DIR] [--update] [--run COMMAND…]
#     --rt           the PREEMPT_RT kernel
#     --build DIR    takes the programs from DIR/bin and builds nothing (default: builds them in build/dev)
#     --update       fetches the newest kernel; otherwise what is in build/vm-cache is used, without a network
#     --run COMMAND  this command instead of the tests, with the same devices and variables
# CAIRN_VM_CACHE names another cache, CAIRN_VM_TIMEOUT other seconds for the whole run of the machine (300).
# Console: build/vm/console-FLAVOUR.log. Exit code 77, with the reason: there can be no virtual machine here.
# Virtual time depends on the host's load: nothing in there may be judged by rates or latencies.
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/common.sh"

flavour=amd64 programs='' update='' command=''
while (($# > 0)); do
  case $1 in
    --rt) flavour=rt-amd64 ;;
    --build) programs=$(cd "$2/bin" && pwd) && shift ;;
    --update) update=--update ;;
    --run)
      shift
      command=$(printf '%q ' "$@")
      break
      ;;
    *) sed -n '3,13s/^# //p' "$0" && exit 2 ;;
  esac
  shift
done
readonly limit=${CAIRN_VM_TIMEOUT:-300} console=build/vm/console-$flavour.log

skip() {
  echo "vm: skipped: $*"
  exit 77
}

[[ $(uname -m) == x86_64 ]] || skip "the test programs are for $(uname -m), the kernel would be for x86_64"
command -v apt-get >/dev/null || skip "the kernel comes from Debian 12's packages, and this is not a Debian machine"
tools/packages.sh vm || skip "QEMU and what else the virtual machine needs cannot be installed (see above)"
command -v qemu-system-x86_64 >/dev/null || skip "there is no qemu-system-x86_64"
kernel=$(tests/vm/kernel.sh "$flavour" "${CAIRN_VM_CACHE:-build/vm-cache}" "$update") || {
  (($? != 77)) || skip "apt does not give us linux-image-6.12-$flavour (see above)"
  echo "vm: no kernel: FAILED"
  exit 1
}
if [[ -z $programs ]]; then
  build dev --target vm_tests
  programs=$PWD/build/dev/bin
fi

# The first root filesystem: busybox, the modules, and what is to be done.
mkdir -p build/vm
root=$(mktemp -d build/vm/root.XXXXXX)
trap 'rm -rf "$root" "$root.cpio"' EXIT
mkdir -p "$root/bin" "$root/packed"
cp "$kernel/busybox" "$root/bin/"
cp -r "$kernel/modules" "$root/"
cp tests/vm/init.sh "$root/init"
# VM_LIMIT ends what hangs, and is of virtual time, which runs ahead while the host is busy: of the camera tests, up to 632 s.
printf 'export %s=%q\n' VM_PROJECT "$PWD" VM_PROGRAMS "$programs" VM_COMMAND "$command" VM_LIMIT $((30 * limit)) \
  VM_CYCLES "${CAIRN_TEST_VIDEO_CYCLES:-3}" >"$root/job"
# What runs in there is packed with its libraries, at the places it has here: from memory it starts sooner than over 9p, and
# while the machine waited for this one's disk, its clock would jump ahead.
with_libraries() {  # with_libraries FILE…: those that exist, and what they are linked with
  local file
  for file in "$@"; do
    [[ -f $file ]] || continue
    echo "$file"
    ldd "$file" 2>/dev/null | sed -n 's#^[^/]*\(/[^ ]*\) .*#\1#p' || true  # a script has none
  done
}
with_libraries /bin/{cat,cut,env,grep,ln,mkdir,readlink,rm,sed,sh,bash,sleep,tee,timeout} "$(command -v ip)" "$(command -v tc)" \
  tests/vm/{guest,devices,camera}.sh "$programs"/{cairn,uvc_camera,test_*_device} |
  xargs -d '\n' realpath | sort -u | xargs -d '\n' cp --parents --target-directory="$root/packed"
(cd "$root" && find . | cpio --quiet -o -H newc -R 0:0) >"$root.cpio"

# /dev/kvm alone says little: where the processor cannot virtualise, a stock kernel does not boot under it. Without it the
# machine's clock counts instructions, and jumps ahead when all wait: a busy host makes the run longer, but not different.
# Copying byte by byte with one instruction (erms, fsrm) is fast on a processor and slow when it is emulated.
accelerator=(-accel "tcg,thread=single" -smp 1 -icount "shift=1,sleep=off" -cpu "max,erms=off,fsrm=off")
if grep -qwE 'vmx|svm' /proc/cpuinfo && [[ -w /dev/kvm ]]; then accelerator=(-accel kvm -smp 2 -cpu host); fi
# shellcheck disable=SC2054  # QEMU's options have commas
machine=(
  "${accelerator[@]}" -m 1536 -M q35 -display none -nodefaults -no-reboot
  -kernel "$kernel/vmlinuz" -initrd "$root.cpio" -append "console=ttyS0 quiet loglevel=3 panic=-1 mitigations=off"
  -serial "file:$console" -serial "file:$root/status"
  -fsdev "local,id=host,path=/,security_model=none,readonly=on,multidevs=remap" -device virtio-9p-pci,fsdev=host,mount_tag=host
  -object can-bus,id=bus -device kvaser_pci,canbus=bus -device kvaser_pci,canbus=bus
)
code=0 begin=$SECONDS
: >"$console"
TIMEFORMAT=%U  # of processor time: unlike the whole, it does not depend on what else the host does
processor=$({ time timeout -k 5 "$limit" qemu-system-x86_64 "${machine[@]}" </dev/null >"$root/qemu" 2>&1; } 2>&1) || code=$?
cat "$root/qemu" >>"$console"
sed -i 's/\r$//' "$console"

# A panicking kernel ends QEMU without a fault: only the guest's own word counts.
guest=$(sed -n 's/^exit \([0-9]*\).*/\1/p' "$root/status" 2>/dev/null | head -n 1)
if [[ -n $command || $guest != 0 ]]; then tail -n 200 "$console"; else grep '^vm: ' "$console"; fi
((code != 124 && code != 137)) || echo "vm: not done within $limit s"
[[ -n $guest ]] || { echo "vm: the virtual machine ended without a result (QEMU: $code): FAILED; its console is $console"; exit 1; }
echo "vm: whole run $((SECONDS - begin)) s, processor ${processor##*$'\n'} s"
((guest == 0)) || echo "vm: FAILED; the console is $console"
exit "$guest"
