#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the benchmarks and writes bench.json, a list of {name, ours_ms, peer, peer_ms, ratio, n, note}. Times are CPU times.
# The ratio is peer_ms / ours_ms of the same run. Benchmarks of inserting also have differing_voxels.
#   tools/bench.sh [FILTER]      only benchmarks whose name matches this regular expression
# A benchmark without the counters ours_ms and n gives Google Benchmark's CPU time per iteration. Its label is "peer" or
# "peer: note". All counters are in build/dev/NAME.json.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

filter=${1:-.}
tools/packages.sh build test bench
build dev --target benchmarks

results=()
for program in build/dev/bin/bench_*; do
  out=build/dev/${program##*/}.json
  rm -f "$out"
  "$program" --benchmark_filter="$filter" --benchmark_out="$out" --benchmark_out_format=json
  [[ ! -s $out ]] || results+=("$out")
done
jq -s '
  {ns: 1e-6, us: 1e-3, ms: 1, s: 1e3} as $ms |
  [.[].benchmarks[] | select(.error_occurred | not) | select(.run_type != "aggregate") |
   (.ours_ms // .cpu_time * $ms[.time_unit]) as $ours | ((.label // "") | split(": ")) as $words |
   {name, ours_ms: $ours, peer: ($words[0] // null), peer_ms, n: (.n // .iterations), note: ($words[1:] | join(": "))} +
   {ratio: (if .peer_ms then .peer_ms / $ours else null end)} +
   (if has("differing_voxels") then {differing_voxels} else {} end)]' "${results[@]}" >bench.json
jq -r '.[] | [.name, .ours_ms, .peer_ms // "", .ratio // ""] | map(if type == "number" then . * 1000 | round / 1000 else . end) | @tsv' bench.json
