#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the fault campaign in virtual time and writes what it measured into docs/faults.md.
#   tools/ci/fault_table.sh [BUILD_FOLDER]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
build=${1:-build/dev}

mkdir -p docs
CAIRN_WRITE_FAULT_TABLE=1 "$build/bin/test_faults" --gtest_filter='FaultTable.TheDocumentIsCurrent' --gtest_brief=1
git diff --stat -- docs/faults.md
