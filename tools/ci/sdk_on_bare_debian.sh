#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Proves that an installed Cairn is enough to build against: on a bare Debian 12 with the installed files, a compiler, CMake
# and the packages that docs/api.md names for the components, and nothing of this project else.
#   tools/ci/sdk_on_bare_debian.sh      as root, after tools/build.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source tools/ci/bare_root.sh

[[ -f build/release/bin/cairn ]] || { echo "sdk_on_bare_debian.sh: no build/release/bin/cairn: run tools/build.sh first" >&2; exit 2; }
place=$(mktemp -d --tmpdir cairn-bare-sdk.XXXXXX)
trap 'rm -rf --one-file-system "$place"' EXIT
make_bare "$place"
root=$place/bare
cmake --install build/release --prefix "$root/usr" --component dev >/dev/null

# What the page says that a component needs, besides the packages of hal.
packages_of() {
  sed -n "s/^| \`$1\` .*| \([^|]*\) |$/\1/p" docs/api.md | tr -d ',' | sed 's/\bnone\b//'
}
packages=$(for component in hal client odometry; do packages_of "$component"; done | tr '\n' ' ')
[[ $packages == *libeigen3-dev* ]] || { echo "docs/api.md names no packages: $packages" >&2; exit 1; }

mkdir "$root/own"
cp examples/follow_pose.cpp examples/drive_square.cpp "$root/own"
cat >"$root/own/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(own CXX)
find_package(Cairn REQUIRED COMPONENTS client odometry)
foreach(program IN ITEMS follow_pose drive_square own)
  add_executable(${program} ${program}.cpp)
  target_link_libraries(${program} PRIVATE Cairn::client Cairn::odometry)
endforeach()
END
cat >"$root/own/own.cpp" <<'END'
#include <cairn/onboard/odometry/odometry.hpp>
#include <cstdio>

int main() {
  cairn::Workers workers(1);
  const cairn::odometry::OdometryConfig config;
  cairn::odometry::LidarOdometry odometry(config, cairn::SE3(), workers);
  auto budget = cairn::Budget::steps(cairn::odometry::most_steps(config));
  const auto update = odometry.update(cairn::Scan{}, budget);
  std::printf("odometry answers: %s\n", update ? "located" : to_string(update.error()).c_str());
}
END
echo "── packages: cmake g++ make $packages"
run_in "$root" / "apt-get -qq update && apt-get -qq install -y --no-install-recommends cmake g++ make $packages >/dev/null"
run_in "$root" /own "cmake -S . -B built && cmake --build built"
run_in "$root" /own "built/own && { built/follow_pose /nowhere 2>&1 || true; }" | tee "$place/said"
grep -q 'odometry answers' "$place/said" && grep -q 'no core serves' "$place/said"
