#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the tests and runs them:
#   tools/test.sh [--asan | --tsan | --clang | --fuzz | --cross] [ctest arguments, such as -R mapping]
#     (none)   g++, every test
#     --asan   with AddressSanitizer and UndefinedBehaviorSanitizer
#     --tsan   with ThreadSanitizer, the rooms that use threads
#     --clang  with clang++
#     --fuzz   with clang++ and both of --asan, built as the fuzz targets are: CI's way, for it saves a build
#     --cross  for aarch64, run under qemu-user (makes the sysroot at first)
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

preset=dev groups=(build test) targets=() select=()
case ${1:-} in
  --asan) preset=asan && shift ;;
  --tsan)
    preset=tsan targets=(--target test_hal test_odometry test_mapping test_scheduler test_app)
    select=(-R '^(hal|odometry|mapping|scheduler|app)/')
    shift
    ;;
  --clang | --fuzz) preset=${1#--} groups+=(ci) && shift ;;
  --cross)
    # qemu-user knows neither the kernel's receive stamps nor its drop counts, without which no UDP port is opened.
    preset=aarch64 groups=(build cross) select=(-E '/(UdpSourceTest|RecordCommand)\.')
    shift
    ;;
  -h | --help) sed -n '3,10s/^# //p' "$0" && exit ;;
esac

tools/packages.sh "${groups[@]}"
[[ $preset != aarch64 ]] || toolchains/make_sysroot.sh
build "$preset" "${targets[@]}"
# A sanitiser's report must end the test, whichever way the machine's defaults are set.
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_stack_use_after_return=1:strict_string_checks=1}
export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1:halt_on_error=1}
export TSAN_OPTIONS=${TSAN_OPTIONS:-halt_on_error=1:second_deadlock_stack=1}
ctest --preset "$preset" --parallel "$(nproc)" --no-tests=error "${select[@]}" "$@"
