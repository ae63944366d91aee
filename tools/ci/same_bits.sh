#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A replay with recorded labels gives the same bits on x86-64 and, under qemu-user, on aarch64, for any number of threads:
#   tools/ci/same_bits.sh [CAIRN [CAIRN_CORE_FOR_AARCH64]]
# The programs are those of the presets release and aarch64. Prints each output_sha256.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

cairn=${1:-build/release/bin/cairn} core=${2:-build/aarch64/bin/cairn-core}
sysroot=${CAIRN_SYSROOT:-$PWD/sysroot-arm64}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$cairn" simulate --scene carpark --seconds 2 --seed 3 --sensors lidar,camera --camera-rate 5 --out "$folder/sim" >/dev/null

# replay NAME PROGRAM…: prints the sum of its output
replay() {
  local name=$1 out=$folder/$1
  shift
  "$@" --speed max --recording "$folder/sim/robot_1" --networks recorded --out "$out" >"$folder/log" 2>&1 || {
    tail -n 20 "$folder/log" >&2
    return 1
  }
  printf '%-9s %s\n' "$name" "$(sed -n 's/.*"output_sha256": *"\([0-9a-f]*\)".*/\1/p' "$out/report.json")"
}

sums=$(
  for threads in 1 2 4; do replay "x86-64/$threads" "$cairn" run --threads "$threads"; done
  replay aarch64/2 qemu-aarch64-static -L "$sysroot" "$core" --threads 2
)
echo "$sums"
if (($(awk '{print $2}' <<<"$sums" | sort -u | wc -l) != 1)); then
  echo "same_bits.sh: the outputs differ" >&2
  exit 1
fi
