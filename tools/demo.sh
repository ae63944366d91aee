#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Simulates a robot that drives through an office for a minute. Cairn makes a trajectory and a map of its LiDAR packets.
# Both are compared with the truth. Leaves demo/run/report.html.
#   tools/demo.sh [SCENE [SECONDS]]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scene=${1:-office} seconds=${2:-60}
tools/build.sh
cairn=build/release/bin/cairn
rm -rf demo
"$cairn" simulate --scene "$scene" --robots 1 --seconds "$seconds" --seed 1 --out demo/world
"$cairn" run --recording demo/world/robot_1 --out demo/run --speed max
"$cairn" evaluate trajectory demo/run/trajectory.tum --ground-truth demo/world/robot_1/ground_truth.tum
"$cairn" map info demo/run/map.cairn
echo "The report: $PWD/demo/run/report.html"
