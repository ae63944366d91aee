#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders the pictures that the shipped segmentation network learns from, and those that judge it.
#
#   tools/training/make_data.sh OUT [TRAIN_RUNS] [VALIDATION_RUNS] [TEST_RUNS] [MORE_RUNS]
#
# MORE_RUNS adds training runs of the scenes that are hardest to learn: street and office.
# OUT gets train/, validation/ and test/: pictures of the left eye at 336x192 (BGR) and their truth (trainIds).
# Seeds: training 10000…49999, validation 50000…69999, test from 70000. A run is four robots for 40 s, a picture
# every 5 s. JOBS=N runs N simulations at a time (default 1).
# There are no pictures of the night: without lamps they are black. CAIRN names the program (default: build/release).
# What is there already is not rendered again, so an interrupted call goes on where it stopped.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
out=${1:?usage: make_data.sh OUT [TRAIN_RUNS] [VALIDATION_RUNS] [TEST_RUNS]}
cairn=${CAIRN:-$here/../../build/release/bin/cairn}
scenes=(street carpark forest office street lobby carpark street forest office street corridor carpark forest office
        street)
motions=(gentle brisk handheld gentle aggressive)

hard=(street street office)

# One line for each run: folder, scene, seed, further options. The pattern repeats; only the seed differs.
# plan SPLIT FIRST_SEED RUNS SCENE…
plan() {
  local split=$1 first=$2 runs=$3 i scene options
  local -a shown=("${@:4}")
  for ((i = 0; i < runs; ++i)); do
    options="--motion ${motions[i % 5]}"
    if ((i % 13 == 12)); then options="--profile uav"; fi
    if ((i % 3 == 1)); then options+=" --people 10"; fi
    scene=${shown[i % ${#shown[@]}]}
    echo "$out/$split $scene $((first + 13 * i)) $options"
  done
}

# Simulates one line of the plan and keeps the small pictures alone.
render() {
  local folder=$1 scene=$2 seed=$3 scratch
  shift 3
  [[ ! -e $folder/$scene-$seed.done ]] || return 0
  scratch=$(mktemp -d)
  mkdir -p "$folder"
  if "$cairn" simulate --scene "$scene" --seed "$seed" --robots 4 --seconds 40 --sensors camera --camera-rate 0.2 \
      "$@" --out "$scratch/run" > "$scratch/said" 2>&1; then
    /usr/bin/python3 "$here/pack_pictures.py" "$scratch/run" "$folder" "$scene-$seed"
    touch "$folder/$scene-$seed.done"
  else
    cat "$scratch/said" >&2
  fi
  rm -rf "$scratch"
}

export -f render
export cairn here
{
  plan validation 50000 "${3:-13}" "${scenes[@]}"
  plan train 10000 "${2:-68}" "${scenes[@]}"
  plan train 20000 "${5:-0}" "${hard[@]}"
  plan test 70000 "${4:-26}" "${scenes[@]}"
} | xargs -P "${JOBS:-1}" -I{} bash -c 'render {}'
