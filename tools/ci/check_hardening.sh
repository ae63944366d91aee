#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks that the program of a build has all the protections of docs/security.md: tools/ci/check_hardening.sh BUILD_FOLDER
# Reads them from the binary. Protections that leave no trace there are read from the compile commands. Checks, too, that
# the robot's program needs no library of the simulator.
set -euo pipefail

build=${1:?usage: check_hardening.sh BUILD_FOLDER}
program=$build/bin/cairn core=$build/bin/cairn-core
commands=$build/compile_commands.json
[[ -x $program && -x $core && -f $commands ]] ||
  { echo "check_hardening.sh: no $program, $core or $commands: build first" >&2; exit 2; }

headers=$(readelf --wide --file-header --program-headers --dynamic "$program")
symbols=$(readelf --wide --dyn-syms "$program")
bad=0
has() {  # has NAME PATTERN TEXT
  if grep -Eq -- "$2" <<<"$3"; then echo "  ok    $1"; else echo "  LACKS $1 ($2)"; bad=1; fi
}
has_not() {
  if grep -Eq -- "$2" <<<"$3"; then echo "  HAS   $1 ($2)"; bad=1; else echo "  ok    no $1"; fi
}

echo "$program"
has "position-independent executable" 'Type: +DYN' "$headers"
has "position-independent executable flag" 'FLAGS_1.*PIE' "$headers"
has "read-only relocations" 'GNU_RELRO' "$headers"
has "immediate binding" 'BIND_NOW|FLAGS_1.*NOW' "$headers"
has "a stack segment that is not executable" 'GNU_STACK .* RW ' "$headers"
has_not "writable and executable segment" 'LOAD .* RWE ' "$headers"
has_not "search path for libraries" '\((RPATH|RUNPATH)\)' "$headers"
has_not "relocation in code" '\(TEXTREL\)' "$headers"
has "stack protector" '__stack_chk_fail' "$symbols"
has "fortified libc calls" '__[a-z]+_chk\b' "$symbols"
has "checked standard library" '__glibcxx_assert_fail' "$symbols"

# Each of our own files must have the flag.
count() { grep '"command":' "$commands" | grep -c -- "$1" || true; }
files=$(count '')
for flag in -fstack-protector-strong -fstack-clash-protection -ftrivial-auto-var-init=zero -D_FORTIFY_SOURCE=3 \
  -D_GLIBCXX_ASSERTIONS -fPI[EC] -ffp-contract=off -Werror; do
  have=$(count " $flag\b")
  if ((have == files)); then echo "  ok    $flag in $files files"; else echo "  LACKS $flag in $((files - have)) of $files files"; bad=1; fi
done
case $headers in
  *X86-64*) has "landing pads for indirect branches" 'endbr64' "$(objdump -d "$program" | grep -m 1 endbr64)" ;;
  *AArch64*) has "signed return addresses" '-mbranch-protection=standard' "$(<"$commands")" ;;
esac

echo "$core"
needed=$(readelf --wide --dynamic "$core" | grep NEEDED)
has "a direct dependency on the C library" 'libc\.so' "$needed"
has_not "direct dependency on the simulator's libraries" 'embree|tbb' "$needed"
exit "$bad"
