#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The book's comparison of map matching (chapters 3 to 5), with our methods and PCL's. Simulates two robots in each of three
# scenes, makes pairs of maps from their recordings, and matches each pair from 125 start poses. Leaves protocol.json and
# protocol.html.
#   tools/protocol.sh [--seed K] [--out DIR] [--octomaps DIR] [--starts N] [--quick]
#     --seed      of the simulated robots' paths and noise (default 1001)
#     --out       default: protocol/
#     --octomaps  folder of .bt maps (such as fr_079, geb079); halves of them are matched, too
#     --starts    how many of the 125 starts the slow methods get (PCL's, OICP, PMM, EM); in a series a fifth of that.
#                 The default method and those on edges always run from all (default 125)
#     --quick     --starts 5 and shorter recordings
# It takes about 45 minutes on two idle cores, with two OctoMaps, after the build; with --starts 25 a quarter of an hour.
# This script and protocol_people.sh alone install and use PCL.
source "$(dirname "${BASH_SOURCE[0]}")/protocol/common.sh"

seed=1001 out=protocol octomaps='' starts='' seconds=60 quick=''
take_options "seed out octomaps starts quick!" "$@"
[[ -z $quick ]] || { seconds=40 && starts=${starts:-5}; }
starts=${starts:-125}

# Two robots in each scene; one with LiDAR and depth camera.
record() {
  local scene
  for scene in hallway lobby office; do
    "$cairn" simulate --scene "$scene" --robots 2 --seconds "$seconds" --seed "$seed" --threads "$(nproc)" \
      --out "$out/recordings/$scene"
  done
  "$cairn" simulate --scene lobby --sensors lidar,depth --seconds 30 --seed "$seed" --threads "$(nproc)" \
    --out "$out/recordings/rgbd"
}

# One line for each program and pair, what takes longest first. PCL takes part where the book has it: in the scenes. The
# series of falling overlap and of the filling map show a trend: a fifth of the starts will do.
jobs() {
  local pair series='/((corridor|lobby|office)_[0-9]+|lidar_rgbd_[a-z]+)/$'
  for pair in "$out"/pairs/*/; do
    [[ $pair =~ $series ]] || printf '%s\0' "$bin/pcl_baselines '$pair' $starts" "$bin/protocol match '$pair' --starts $starts"
  done
  for pair in "$out"/pairs/*/; do
    [[ ! $pair =~ $series ]] || printf '%s\0' "$bin/protocol match '$pair' --starts $(((starts + 4) / 5))"
  done
}

build_programs protocol pcl_baselines
mkdir -p "$out"
rm -rf "$out/recordings" "$out/pairs"
step 1/4 "simulating the recordings"
record
step 2/4 "making the pairs of maps"
"$bin/protocol" pairs --recordings "$out/recordings" ${octomaps:+--octomaps "$octomaps"} --seed "$seed" --out "$out/pairs"
step 3/4 "matching from $starts of 125 starts"
jobs | at_once
step 4/4 "the report"
"$bin/protocol" report --pairs "$out/pairs" --seed "$seed" --out "$out" | tee "$out/protocol.txt"
echo "The report: $out/protocol.html"
