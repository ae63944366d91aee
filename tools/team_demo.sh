#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Three robots drive through an office, simulated; then each is run on this machine with its own processes, over an
# emulated bad radio, and what they came to is compared. Leaves demo/team/SCENE/out/team.json and team.png.
#   tools/team_demo.sh [SCENE [SECONDS [ARGUMENT…]]]     further arguments go to cairn team
# Without arguments: office, then carpark, 90 s each; with the simulation and a minute to settle, five minutes each.
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
