#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the fuzz targets (clang, libFuzzer, both sanitisers) and runs each, two at a time:
#   tools/ci/fuzz.sh [SECONDS [NAME…]]         those named, or those of all readers; each for so long, 30 s by default
#   tools/ci/fuzz.sh NUMBERruns [NAME…]        each so often: 1000000runs
#   tools/ci/fuzz.sh SECONDS --all             also those that need large libraries
# New inputs stay in build/fuzz/corpus/NAME for the next run. A crash leaves its input in build/fuzz/crash.
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

[[ ${1:-30} =~ ^[0-9]+(runs)?$ ]] || { sed -n '3,6s/^# //p' "${BASH_SOURCE[0]#"$PWD/"}" >&2; exit 2; }
limit=-max_total_time=${1:-30}
[[ ${1:-} != *runs ]] || limit=-runs=${1%runs}
shift || true
tools/packages.sh build test ci

set_of=fuzzers
[[ ${1:-} != --all ]] || { set_of=all_fuzzers && shift; }
names=("$@")
if ((${#names[@]} == 0)); then
  build fuzz --target "$set_of"
  mapfile -t names <"build/fuzz/$set_of.txt"
else
  build fuzz --target "${names[@]/#/fuzz_}"
fi
mkdir -p build/fuzz/crash

# shellcheck disable=SC2317  # xargs calls it
fuzz() {  # fuzz LIMIT NAME: one line of result, or the fuzzer's last words
  local name=$2 found=build/fuzz/corpus/$2 log=build/fuzz/$2.log dictionary=tests/fuzz/$2.dict options=()
  mkdir -p "$found"
  [[ ! -f $dictionary ]] || options=(-dict="$dictionary")
  if "build/fuzz/bin/fuzz_$name" "$1" -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="build/fuzz/crash/$name-" "${options[@]}" "$found" "tests/fuzz/corpus/$name" >"$log" 2>&1; then
    awk -v name="$name" '/number_of_executed_units/ {n = $2} /peak_rss_mb/ {rss = $2} / cov: / {sub(/.* cov: /, ""); cov = $1}
      END {printf "  %-24s %10d runs  %6d edges  %5d MB\n", name, n, cov, rss}' "$log"
  else
    echo "  $name FAILED; its log is $log"
    tail -n 40 "$log"
    return 1
  fi
}
export -f fuzz

# shellcheck disable=SC2016  # expanded by the inner shell
printf '%s\n' "${names[@]}" | xargs -d '\n' -n 1 -P 2 bash -c 'fuzz "$0" "$1"' "$limit"
