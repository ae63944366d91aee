#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the programs that run on the robot, and nothing else: cairn, and cairn-core and cairn-peers beside it
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

tools/packages.sh build
build release --target cairn cairn-core cairn-peers
echo "build/release/bin/cairn"
