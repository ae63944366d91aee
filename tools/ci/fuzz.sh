#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the fuzz targets (clang, libFuzzer, both sanitisers) and runs each, two at a time:
#   tools/ci/fuzz.sh [SECONDS [NAME…]]         those named, or those of all readers; each for so long, 30 s by default
#   tools/ci/fuzz.sh NUMBERruns [NAME…]        each so often: 1000000runs
#   tools/ci/fuzz.sh SECONDS --all             also those that need large libraries
# New inputs stay in build/fuzz/corpus/NAME for the next run. A crash leaves its input in build/fuzz/crash.
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

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

fuzz() {  # fuzz NAME: one line of result, or the fuzzer's last words
  local name=$1 found=build/fuzz/corpus/$1 log=build/fuzz/$1.log dictionary=tests/fuzz/$1.dict options=()
  mkdir -p "$found"
  [[ ! -f $dictionary ]] || options=(-dict="$dictionary")
  if "build/fuzz/bin/fuzz_$name" "$limit" -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="build/fuzz/crash/$name-" "${options[@]}" "$found" "tests/fuzz/corpus/$name" >"$log" 2>&1; then
    awk -v name="$name" '/number_of_executed_units/ {n = $2} /peak_rss_mb/ {rss = $2} / cov: / {sub(/.* cov: /, ""); cov = $1}
      END {printf "  %-24s %10d runs  %6d edges  %5d MB\n", name, n, cov, rss}' "$log"
  else
    echo "  $name FAILED; its log is $log"
    tail -n 40 "$log"
    return 1
  fi
}

bad=0
for ((i = 0; i < ${#names[@]}; i += 2)); do
  pids=()
  for name in "${names[@]:i:2}"; do fuzz "$name" & pids+=($!); done
  for pid in "${pids[@]}"; do wait "$pid" || bad=1; done
done
exit "$bad"
