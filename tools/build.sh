#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the program that runs on the robot, and nothing else: build/release/bin/cairn
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

tools/packages.sh build
build release --target cairn
echo "build/release/bin/cairn"
