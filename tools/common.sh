# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# Sourced by the other scripts: changes to the root of the project and defines build.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# build PRESET [ARGUMENT…]: configures and builds. The arguments go to cmake --build. Prints errors only, and on a terminal
# also the progress.
build() {
  local preset=$1 quiet=()
  shift
  [[ -t 1 ]] || quiet=(-- --quiet)
  cmake --preset "$preset" -DCAIRN_UNITY=ON >/dev/null
  cmake --build --preset "$preset" "$@" "${quiet[@]}"
}
