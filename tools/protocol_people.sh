#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The book's comparison of mapping among people (chapter 6): two robots in a simulated forest, by day and by night. Maps
# them with everybody in the map, with the colour camera alone, and with both cameras, matches and merges the maps at three
# times, and leaves people.json and people.html.
#   tools/protocol_people.sh [--seed K] [--out DIR] [--seconds S] [--starts N]
#     --seed      of the simulated robots, people and noise (default 71001)
#     --out       default: protocol_people/; recordings that are there already are used again
#     --seconds   length of the mission (default 30)
#     --starts    from how many of the 125 start poses PCL's ICP and Cairn match (default 25)
# It takes about 20 minutes on two idle cores after the build. Most of it is the simulation of the cameras.
source "$(dirname "${BASH_SOURCE[0]}")/protocol/common.sh"

seed=71001 out=protocol_people seconds=30 starts=25
take_options "seed out seconds starts" "$@"

# record LIGHT: two robots among eight people, with five pictures a second, as many as the networks look at.
record() {
  local dark=()
  [[ $1 == day ]] || dark=(--night)
  [[ -d $out/recordings/$1 ]] || "$cairn" simulate --scene forest "${dark[@]}" --robots 2 --people 8 --seconds "$seconds" \
    --seed "$seed" --sensors lidar,camera,thermal --camera-rate 5 --threads "$(nproc)" --out "$out/recordings/$1"
}

# profile RECORDING PIPELINE: the recording's own, without the networks that the pipeline lacks. Only Cairn's follows people
# by scans alone, and clears what came and went.
profile() {
  local without="segmentation"
  [[ $2 == both ]] || without+=" thermal_detection"
  awk -v without=" $without " -v movers="$([[ $2 == both ]] && echo true || echo false)" '
    /^  [a-z_]+:/ { section = $1; sub(":", "", section) }
    index(without, " " section " ") && /^    (model|sha256):/ { sub(/: .*/, ": \"\"") }
    /^    movers:/ { sub(/: .*/, ": " movers) }
    /^  clear_movers:/ { next }
    { print }
    /^mapping:/ { print "  clear_movers: " movers }' "$1/profile.yaml"
}

# map LIGHT PIPELINE PHASE SECONDS: the runs of both robots.
map() {
  local robot dir=$out/runs/$1/$2/$3 networks=run
  [[ $2 != nobody ]] || networks=off
  mkdir -p "$dir"
  for robot in robot_1 robot_2; do
    profile "$out/recordings/$1/$robot" "$2" >"$out/runs/$1_$2_$robot.yaml"
    "$cairn" run --recording "$out/recordings/$1/$robot" --config "$out/runs/$1_$2_$robot.yaml" --networks "$networks" \
      --seconds "$4" --speed max --out "$dir/$robot" >/dev/null
  done
}

# third N: the time of a third of the mission.
third() { awk -v s="$seconds" -v n="$1" 'BEGIN { print s * n / 3 }'; }

# look LIGHT SENSOR TITLE: one picture of the middle of the mission, with the boxes of its network.
look() {
  local overlays=("$out/labelled/$1/overlay/$2"/*.png)
  cp "${overlays[$((${#overlays[@]} / 2))]}" "$out/pictures/$3.png"
}

pictures() {
  local light
  mkdir -p "$out/pictures"
  for light in day night; do
    "$cairn" label "$out/recordings/$light/robot_1" --config "$out/runs/${light}_both_robot_1.yaml" --overlay --overwrite \
      --out "$out/labelled/$light" >/dev/null
    "$cairn" map render "$out/runs/$light/nobody/final/robot_1/map.cairn" --out "$out/pictures/2 $light, everybody in the map.png" >/dev/null
    "$cairn" map render "$out/runs/$light/both/final/robot_1/map.cairn" --out "$out/pictures/3 $light, people left out.png" >/dev/null
  done
  look day camera "1 day, colour camera"
  look night thermal "1 night, thermal camera"
}

build_programs protocol pcl_baselines
mkdir -p "$out/runs"
rm -rf "$out/pairs" "$out/pictures" "$out/runs"/*
ln -sfn "$PWD/config/models" "$out/runs/models"
step 1/5 "simulating the recordings"
for light in day night; do record "$light"; done
step 2/5 "mapping"
for light in day night; do
  for pipeline in nobody visible both; do
    map "$light" "$pipeline" beginning "$(third 1)"
    map "$light" "$pipeline" middle "$(third 2)"
    map "$light" "$pipeline" final "$(third 3)"
  done
done
step 3/5 "matching from $starts of 125 starts"
"$bin/protocol" missions --recordings "$out/recordings" --runs "$out/runs" --out "$out/pairs"
for pair in "$out"/pairs/*/; do
  [[ $pair != *_nobody_* ]] || printf '%s\0' "$bin/pcl_baselines '$pair' $starts"
  printf '%s\0' "$bin/protocol match '$pair' --starts $starts"
done | at_once
step 4/5 "the pictures"
pictures
step 5/5 "the report"
"$bin/protocol" people --pairs "$out/pairs" --pictures "$out/pictures" --seed "$seed" --out "$out" | tee "$out/people.txt"
echo "The report: $out/people.html"
