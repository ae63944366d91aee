#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the fault campaign in virtual time and writes docs/faults.md from its rows and what it measured.
#   tools/ci/fault_table.sh [BUILD_FOLDER]      default: builds test_faults in build/dev
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

folder=${1:-build/dev}
if (($# == 0)); then
  tools/packages.sh build test
  build dev --target test_faults
fi
CAIRN_WRITE_FAULT_TABLE=1 "$folder/bin/test_faults" --gtest_filter='FaultTable.TheDocumentIsCurrent' --gtest_brief=1
git diff --stat -- docs/faults.md
