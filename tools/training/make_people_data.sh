#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders the pictures that the shipped people detectors learn from, and those that judge them.
#
#   tools/training/make_people_data.sh OUT [DAYS] [NIGHTS]
#
# DAYS and NIGHTS count the training runs, 24 and 24 if they are not given. A run is four robots for 40 s among people,
# with a picture of the thermal camera every 2 s. Runs for validation and test, every second training run by day and
# four more by night also have pictures of the colour camera, one every 10 s. The visible detector learns from make_data.sh's pictures, too.
# OUT gets train/, validation/ and test/: NAME.camera.png (left eye as the detector's input, BGR), NAME.thermal.png
# (stretched to 8 bits), and NAME.KIND.csv with the true boxes in pixels of that picture.
# Seeds: training from 30000, validation from 60000, test from 80000.
# JOBS=N runs N simulations at a time (default 1). CAIRN names the program (default: build/release).
# What is there already is not rendered again, so an interrupted call goes on where it stopped.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
out=${1:?usage: make_people_data.sh OUT [DAYS] [NIGHTS]}
cairn=${CAIRN:-$here/../../build/release/bin/cairn}
scenes=(street office carpark lobby forest street carpark office)
motions=(gentle brisk handheld gentle aggressive)

# One line for each run: folder, scene, seed, further options. The pattern repeats; only the seed differs.
# plan SPLIT FIRST_SEED RUNS SENSORS [OPTION…]
plan() {
  local split=$1 first=$2 runs=$3 sensors=$4 i people carried
  for ((i = 0; i < runs; ++i)); do
    people=$((i % 2 == 0 ? 10 : 8))
    if [[ $split == train ]]; then people=$((i % 2 == 0 ? 20 : 10)); fi
    carried=thermal
    if [[ $sensors == both || ($sensors == some && $((i % 2)) == 1) ]]; then carried="camera,thermal --camera-rate 0.1"; fi
    echo "$out/$split ${scenes[i % 8]} $((first + 13 * i)) --motion ${motions[i % 5]} --people $people" \
      "--sensors $carried" "${@:5}"
  done
}

# Simulates one line of the plan and keeps the pictures as the detectors see them.
render() {
  local folder=$1 scene=$2 seed=$3 scratch
  shift 3
  [[ ! -e $folder/$scene-$seed.done ]] || return 0
  scratch=$(mktemp -d)
  mkdir -p "$folder"
  if "$cairn" simulate --scene "$scene" --seed "$seed" --robots 4 --seconds 40 --thermal-rate 0.5 \
      "$@" --out "$scratch/run" > "$scratch/said" 2>&1; then
    /usr/bin/python3 "$here/pack_people.py" "$scratch/run" "$folder" "$scene-$seed"
    touch "$folder/$scene-$seed.done"
  else
    cat "$scratch/said" >&2
  fi
  rm -rf "$scratch"
}

export -f render
export cairn here
{
  plan validation 60000 5 both
  plan validation 65000 5 both --night
  plan test 80000 5 both
  plan test 90000 5 both --night
  plan train 40000 "${3:-24}" thermal --night
  plan train 45000 4 both --night
  plan train 30000 "${2:-24}" some
} | xargs -P "${JOBS:-1}" -I{} bash -c 'render {}'
