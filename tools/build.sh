#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the three programs into build/release/bin: cairn, cairn-core and cairn-peers.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

tools/packages.sh build
build release --target cairn cairn-core cairn-peers
echo "build/release/bin/cairn"
