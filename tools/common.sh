# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# Sourced by the scripts: goes to the project's root and says how everything is built.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# build PRESET [ARGUMENT…]: configures, then builds what cmake --build's arguments name. Prints nothing but faults, and on
# a terminal the progress.
build() {
  local preset=$1 quiet=()
  shift
  [[ -t 1 ]] || quiet=(-- --quiet)
  cmake --preset "$preset" -DCAIRN_UNITY=ON >/dev/null
  cmake --build --preset "$preset" "$@" "${quiet[@]}"
}
