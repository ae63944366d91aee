#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the tests and runs them:
#   tools/test.sh [--asan | --tsan | --clang | --fuzz | --fuzz-all | --cross] [--slow] [ctest arguments]
#     (none)      g++, every test but those with the label slow
#     --asan      with AddressSanitizer and UndefinedBehaviorSanitizer
#     --tsan      with ThreadSanitizer, the rooms that use threads
#     --clang     with clang++
#     --fuzz      with clang++ and both of --asan, the rooms that read foreign bytes; builds their fuzz targets
#     --fuzz-all  the same with every test and every fuzz target
#     --cross     for aarch64, run under qemu-user (makes the sysroot at first); not what takes hours there
#     --slow      the slow tests, too (alone: --slow -L slow)
#   Further arguments go to ctest: -R mapping runs the tests of one room.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

preset=dev groups=(build test python) targets=() select=() without=(-LE '^slow$')

# only ROOM…: builds and runs these test programs alone.
only() {
  targets+=(--target "${@/#/test_}")
  select=(-R "^($(IFS='|' && echo "$*"))/")
}

case ${1:-} in
  --asan) preset=asan && shift ;;
  --tsan)
    preset=tsan && shift
    only hal odometry mapping scheduler app
    ;;
  --clang | --fuzz-all) preset=${1#--} preset=${preset%-all} groups+=(ci) && shift ;;
  --fuzz)
    preset=fuzz groups+=(ci) targets=(--target fuzzers) && shift
    only hal velodyne camera thermal depth recording drive gpio networks cameras peer_link peer_process peers mapping \
      live scheduler people_files
    ;;
  --cross)
    # qemu-user knows neither the kernel's receive stamps nor its drop counts, without which no UDP port is opened. It
    # starts no second program. It emulates each floating-point operation, up to 100 times as slow: whole drives would
    # take hours. same_bits.sh compares what a whole robot computes.
    preset=aarch64 groups=(build cross)
    hours='GrowingMatch|TeamDeployment|CameraFaults|MountTaskTest|MountWatchTest|GarbageTest|KillCampaign|Campaign'
    select=(-E "/(UdpSourceTest|RecordCommand|$hours)\.|/UnixCanLinkTest\.FramesCrossBothWays|^peer_process/")
    shift
    ;;
  -h | --help) sed -n '3,13s/^# //p' "$0" && exit ;;
esac
[[ ${1:-} != --slow ]] || { without=() && shift; }

tools/packages.sh "${groups[@]}"
[[ $preset != aarch64 ]] || toolchains/make_sysroot.sh
build "$preset" "${targets[@]}"
# A sanitiser's report must end the test, whichever way the machine's defaults are set.
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_stack_use_after_return=1:strict_string_checks=1}
export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1:halt_on_error=1}
export TSAN_OPTIONS=${TSAN_OPTIONS:-halt_on_error=1:second_deadlock_stack=1:suppressions=$PWD/tools/ci/tsan.supp}
ctest --preset "$preset" --parallel "$(nproc)" --no-tests=error "${select[@]}" "${without[@]}" "$@"
