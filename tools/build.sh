#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the programs that run on the robot, and nothing else: cairn, and cairn-core, cairn-peers and cairn-ros beside it.
# The Python module is built, too, if tools/packages.sh python has installed what it needs.
#   tools/build.sh [PRESET]      default: release; x86_64-nuc for a processor with AVX2
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

tools/packages.sh build
build "${1:-release}" --target cairn cairn-core cairn-peers cairn-ros python_module
echo "build/${1:-release}/bin/cairn"
