#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The book's comparisons of unlike robots (chapters 5 and 7): a UGV with a LiDAR and a camera, and a UAV with a stereo camera.
# Maps both as their missions go on, matches and fuses the maps, and leaves unlike.json and unlike.html.
#   tools/protocol_unlike.sh [--seed K] [--out DIR] [--seconds S] [--fusions N] [--starts N] [--scenes "NAME…"]
#     --seed      of the drives and their noise; that of the flights is one more (default 72001)
#     --out       default: protocol_unlike/; recordings of the same seed and length are used again
#     --seconds   length of the missions (default 60)
#     --fusions   how often the maps are fused, spread evenly over a mission (default 3)
#     --starts    from how many of the 125 start poses OICP, EM and Cairn's default match (default 5)
#     --scenes    default: "carpark street"; also lobby, office and forest
# It takes about half an hour of CPU time after the build.
source "$(dirname "${BASH_SOURCE[0]}")/protocol/common.sh"

seed=72001 out=protocol_unlike seconds=60 fusions=3 starts=5 scenes="carpark street"
take_options "seed out seconds fusions starts scenes" "$@"

# record SCENE ROBOT SEED OPTION…: five pictures a second are as many as the UGV's network looks at.
record() {
  local scene=$1 robot=$2 dir=$out/recordings/$1/$2_1
  [[ -d $dir ]] && return
  rm -rf "$out/recording"
  "$cairn" simulate --scene "$scene" --name "$robot" --seed "$3" --seconds "$seconds" --threads "$(nproc)" "${@:4}" \
    --out "$out/recording"
  mkdir -p "$out/recordings/$scene"
  mv "$out/recording/${robot}_1" "$dir"
  rm -rf "$out/recording"
}

# profile RECORDING: its own, with the voxels of the book's chapter 7, and without the network that looks for people.
profile() {
  awk '
    /^  [a-z_]+:/ { section = $1 }
    /^  resolution_m:/ { next }
    section == "detection:" && /^    (model|sha256):/ { sub(/: .*/, ": \"\"") }
    { print }
    /^mapping:/ { print "  resolution_m: 0.2" }' "$1/profile.yaml"
}

# map SCENE FUSION: the runs of both robots until then. The network has no say in the geometry: it is asked at the end.
map() {
  local robot networks=off until
  until=$(awk -v s="$seconds" -v n="$2" -v all="$fusions" 'BEGIN { print s * n / all }')
  (($2 < fusions)) || networks=run
  mkdir -p "$out/runs/$1/$2"
  for robot in ugv_1 uav_1; do
    profile "$out/recordings/$1/$robot" >"$out/profiles/$1_$robot.yaml"
    "$cairn" run --recording "$out/recordings/$1/$robot" --config "$out/profiles/$1_$robot.yaml" --networks "$networks" \
      --seconds "$until" --speed max --out "$out/runs/$1/$2/$robot" >/dev/null
  done
}

build_programs release
[[ $(cat "$out/recordings/of" 2>/dev/null) == "seed $seed, $seconds s" ]] || rm -rf "$out/recordings"
mkdir -p "$out/profiles" "$out/recordings"
echo "seed $seed, $seconds s" >"$out/recordings/of"
rm -rf "$out/pairs" "$out/runs"
ln -sfn "$PWD/config/models" "$out/profiles/models"
step 1/4 "simulating the recordings"
for scene in $scenes; do
  record "$scene" ugv "$seed" --sensors lidar,camera --camera-rate 5
  record "$scene" uav "$((seed + 1))" --profile uav
done
step 2/4 "mapping"
for scene in $scenes; do
  for ((fusion = 1; fusion <= fusions; ++fusion)); do map "$scene" "$fusion"; done
done
step 3/4 "matching"
"$bin/protocol" unlike-pairs --recordings "$out/recordings" --runs "$out/runs" --out "$out/pairs"
for pair in "$out"/pairs/*/; do printf '%s\0' "$bin/protocol match '$pair' --starts $starts"; done | at_once
step 4/4 "fusing, and the report"
"$bin/protocol" unlike --pairs "$out/pairs" --seed "$seed" --out "$out" | tee "$out/unlike.txt"
echo "The report: $out/unlike.html"
