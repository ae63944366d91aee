#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The options of the protocols' scripts: what is taken, and what is refused before anything is built.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
failures=0

# expect WHAT WANTED GOT
expect() {
  [[ $3 == *"$2"* ]] && return
  printf '%s: expected "%s", got "%s"\n' "$1" "$2" "$3" >&2
  failures=$((failures + 1))
}

# taken ARGUMENT…: the options of a script that has --seed, --out and --quick.
taken() {
  # shellcheck disable=SC2016  # expanded by the inner shell
  bash -c 'source "$1/tools/protocol/common.sh" && shift && seed=1 out=here quick= &&
    take_options "seed out quick!" "$@" && echo "seed=$seed out=$out quick=$quick"' protocol.sh "$root" "$@" 2>&1 || echo "code $?"
}

expect "no options" "seed=1 out=here quick=" "$(taken)"
expect "values and a flag" "seed=5 out=a b quick=1" "$(taken --seed 5 --quick --out 'a b')"
expect "an unknown option" "unknown argument '--sed' (see --help)" "$(taken --sed 5)"
expect "its exit code" "code 2" "$(taken --sed 5)"
expect "a word" "unknown argument 'word'" "$(taken word)"
expect "no value" "--seed needs a value" "$(taken --seed)"
for script in protocol protocol_people protocol_unlike; do
  help=$("$root/tools/$script.sh" --help)
  expect "$script.sh --help" "tools/$script.sh [--seed K]" "$help"
  expect "$script.sh --nothing" "$script.sh: unknown argument '--nothing'" "$("$root/tools/$script.sh" --nothing x 2>&1 || true)"
done
exit "$((failures > 0))"
