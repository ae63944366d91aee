#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the pictures of README.md and docs/ anew: simulates the robots, runs Cairn, draws the maps.
#   tools/pictures.sh      leaves docs/pictures/demo-map.png and docs/pictures/team-map.png, each below 300 kB
# Takes four minutes after the build: the team runs in real time.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

readonly most_bytes=300000
tools/packages.sh build docs
tools/build.sh
cairn=$PWD/build/release/bin/cairn
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# put NAME: docs/pictures/NAME.png from $work/NAME.png, with 128 colours: a drawn map hardly has more.
put() {
  local out=docs/pictures/$1.png
  pngquant --force --strip --nofs --output "$out" 128 "$work/$1.png"
  (($(stat -c %s "$out") <= most_bytes)) || { echo "pictures.sh: $out is larger than $most_bytes bytes" >&2; exit 1; }
  echo "$out: $(stat -c %s "$out") bytes"
}

mkdir -p docs/pictures
"$cairn" simulate --scene office --robots 1 --seconds 60 --seed 1 --out "$work/world"
"$cairn" run --recording "$work/world/robot_1" --out "$work/run" --speed max
"$cairn" map render "$work/run/map.cairn" --height-max 2.2 --scale 16 --trajectory "$work/run/trajectory.tum" \
  --ground-truth "$work/world/robot_1/ground_truth.tum" --out "$work/demo-map.png"
put demo-map

"$cairn" simulate --scene office --robots 3 --seconds 90 --seed 1 --threads "$(nproc)" --out "$work/recordings"
"$cairn" team --recordings "$work/recordings" --out "$work/team"
cp "$work/team/team.png" "$work/team-map.png"
put team-map
