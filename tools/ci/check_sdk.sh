#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what build/release holds into a folder of its own, and uses it as others would: the examples are built against
# the installed files alone, in a folder outside, and run on simulated data. Ends with the installed sizes.
#   tools/ci/check_sdk.sh
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

project=$PWD
[[ -f build/release/bin/cairn ]] || { echo "check_sdk.sh: no build/release/bin/cairn: run tools/build.sh first" >&2; exit 2; }
place=$(mktemp -d --tmpdir cairn-sdk.XXXXXX)
trap 'rm -rf "$place"' EXIT
for component in core tools dev python; do
  cmake --install build/release --prefix "$place/usr" --component "$component" >/dev/null
done
cp -r examples "$place/examples"
cd "$place"

echo "── examples"
cmake -S examples -B built -G Ninja -DCMAKE_PREFIX_PATH="$place/usr" -DCMAKE_BUILD_TYPE=RelWithDebInfo >cmake.log ||
  { cat cmake.log; exit 1; }
cmake --build built -- --quiet
for example in examples/*.cpp; do
  (($(wc -l <"$example") <= 100)) || { echo "$example has more than 100 lines" >&2; exit 1; }
done
export PATH=$place/usr/bin:$place/built:$PATH
cairn simulate --scene office --robots 2 --seconds 4 --seed 7 --out sim >/dev/null
pcap_to_scans sim/robot_1/lidar.pcap | tail -n 1
odometry_from_pcap sim/robot_1/lidar.pcap | tail -n 1
map_from_scans sim/robot_1 one.cairn
map_from_scans sim/robot_2 two.cairn
match_two_maps one.cairn one.cairn both.cairn
PYTHONPATH=$place/usr/lib/python3/dist-packages /usr/bin/python3 -B examples/read_team_map.py both.cairn >told
head -n 1 told
own_sensor_driver .
for client in follow_pose drive_square; do
  libraries=$(ldd "built/$client")
  [[ ! $libraries =~ octomap|opencv ]] || { echo "$client should need neither OctoMap nor OpenCV" >&2; exit 1; }
  said=$("$client" "$place/nowhere" 2>&1 || true)
  [[ $said == *"no core serves"* ]] || { echo "$client does not say that no core is there: $said" >&2; exit 1; }
done

echo "── pkg-config"
PKG_CONFIG_PATH=$(dirname "$(find usr -name cairn-client.pc)")
export PKG_CONFIG_PATH
for component in hal client drivers odometry mapping robot fusion mirror; do
  pkg-config --exists --print-errors "cairn-$component"
done
# shellcheck disable=SC2046  # several flags
c++ -std=c++20 -o follow $(pkg-config --cflags cairn-client) examples/follow_pose.cpp \
  $(pkg-config --static --libs cairn-client)

echo "── a component that does not exist"
mkdir wrong && printf 'cmake_minimum_required(VERSION 3.25)\nproject(wrong CXX)\nfind_package(Cairn COMPONENTS flying REQUIRED)\n' >wrong/CMakeLists.txt
cmake -S wrong -B wrong/build -DCMAKE_PREFIX_PATH="$place/usr" >wrong.log 2>&1 && { echo "it was found" >&2; exit 1; }
grep -q 'no component flying' wrong.log || { cat wrong.log; exit 1; }

echo "── services"
"$project/tools/ci/check_units.sh" "$place/usr"

echo "── sizes"
du -sh usr/bin/cairn-core usr/bin/cairn-peers usr/bin/cairn usr/include usr/lib
cd "$project"
