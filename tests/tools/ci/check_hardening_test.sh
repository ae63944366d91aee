#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A program built with every protection passes; one that lacks any of them is refused. So is a robot's program that needs a
# library of the simulator.
set -euo pipefail
check=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)/tools/ci/check_hardening.sh
build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT
mkdir "$build/bin"
failures=0

cat >"$build/program.cpp" <<'CPP'
#include <cstdio>
#include <cstring>
#include <vector>
int main(int argc, char** argv) {
  char copy[16];
  std::strcpy(copy, argv[0]);
  std::vector<int> v(3);
  v[static_cast<unsigned>(argc)] = 1;
  return std::printf("%s %d\n", copy, v[0]) < 0;
}
CPP

case $(uname -m) in
  x86_64) branches=-fcf-protection=full ;;
  aarch64) branches=-mbranch-protection=standard ;;
esac
readonly compile='-O2 -Werror -fstack-protector-strong -fstack-clash-protection -ftrivial-auto-var-init=zero
  -D_FORTIFY_SOURCE=3 -D_GLIBCXX_ASSERTIONS -fPIE -ffp-contract=off '"$branches"
readonly link='-pie -Wl,-z,relro -Wl,-z,now -Wl,-z,noexecstack'

build_with() {  # build_with FLAG…: the program and its compile commands
  printf '  "command": "c++ %s -c program.cpp",\n' "$*" >"$build/compile_commands.json"
  c++ -Wno-stringop-overflow "$@" "$build/program.cpp" -o "$build/bin/cairn"
  cp "$build/bin/cairn" "$build/bin/cairn-core"
}
# core_with LIBRARY: a robot's program that needs it directly.
core_with() {
  c++ -shared -fPIC -x c++ /dev/null -Wl,-soname,"$1" -o "$build/$1"
  c++ -Wno-stringop-overflow "$build/program.cpp" -Wl,--no-as-needed "$build/$1" -o "$build/bin/cairn-core"
}
complain() { echo "FAILED: $*"; failures=$((failures + 1)); }

# shellcheck disable=SC2086  # flags are split on purpose
{
  build_with $compile $link
  "$check" "$build" >"$build/log" || { cat "$build/log"; complain "a hardened program is refused"; }
  for flag in -fstack-protector-strong -fstack-clash-protection -ftrivial-auto-var-init=zero -D_FORTIFY_SOURCE=3 \
    -D_GLIBCXX_ASSERTIONS -ffp-contract=off -Werror; do
    build_with ${compile//$flag/} $link
    ! "$check" "$build" >/dev/null || complain "passes without $flag"
  done
  for instead in '-no-pie' '-pie -Wl,-z,norelro' '-pie -Wl,-z,relro -Wl,-z,lazy' '-pie -Wl,-z,relro,-z,now -Wl,-z,execstack' \
    "$link -Wl,-rpath,/tmp"; do
    build_with $compile $instead
    ! "$check" "$build" >/dev/null || complain "passes when linked with $instead"
  done
  build_with $compile $link
  for library in libembree3.so.3 libtbb.so.12; do
    core_with "$library"
    ! "$check" "$build" >/dev/null || complain "passes although cairn-core needs $library"
  done
  core_with libother.so
  "$check" "$build" >"$build/log" || { cat "$build/log"; complain "a robot's program with another library is refused"; }
}
((failures == 0)) && echo "every missing protection and every library of the simulator was found"
exit $((failures > 0))
