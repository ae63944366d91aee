#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Simulates three robots that drive through an office. Then each robot runs on this machine with processes of its own, over
# an emulated bad radio, and their maps are compared. Leaves demo/team/SCENE/out/team.json and team.png.
#   tools/team_demo.sh [SCENE [SECONDS [ARGUMENT…]]]     further arguments go to cairn team
# Without arguments: office, then carpark, 90 s each. Each takes five minutes, with simulation and a minute to settle.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

scenes=(office carpark) seconds=${2:-90}
(($# == 0)) || scenes=("$1")
shift $(($# < 2 ? $# : 2))
tools/build.sh
cairn=build/release/bin/cairn
for scene in "${scenes[@]}"; do
  demo=demo/team/$scene
  rm -rf "$demo"
  "$cairn" simulate --scene "$scene" --robots 3 --seconds "$seconds" --seed 1 --threads "$(nproc)" --out "$demo/recordings"
  "$cairn" team --recordings "$demo/recordings" --out "$demo/out" "$@"
  echo "The picture: $PWD/$demo/out/team.png"
done
