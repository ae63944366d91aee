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
  cmake --preset "$preset" -DCAIRN_PRECOMPILE=ON -DCAIRN_UNITY=ON >/dev/null
  # ccache then takes the compiler's own list of headers instead of preprocessing every file, and allows precompiled ones.
  CCACHE_DEPEND=1 CCACHE_SLOPPINESS=pch_defines,time_macros cmake --build --preset "$preset" "$@" "${quiet[@]}"
}
