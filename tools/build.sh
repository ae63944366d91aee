#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the program that runs on the robot, and nothing else: build/release/bin/cairn
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/packages.sh build
[[ -t 1 ]] && quiet=() || quiet=(-- --quiet)
cmake --preset release -DCAIRN_TESTS=OFF -DCAIRN_BENCHMARKS=OFF >/dev/null
cmake --build --preset release --target cairn "${quiet[@]}"
echo "build/release/bin/cairn"
