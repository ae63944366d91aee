#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Proves that the commands of the README work on a bare Debian 12. For each command it copies a bare root, clones the project
# into the copy, and runs the command there twice as root. Prints how long each run took.
#   tools/ci/fresh_machine.sh [COMMAND…]      as root; default: ./tools/test.sh ./tools/demo.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source tools/ci/bare_root.sh

commands=("$@")
((${#commands[@]} > 0)) || commands=(./tools/test.sh ./tools/demo.sh)
place=$(mktemp -d --tmpdir cairn-fresh.XXXXXX)
trap 'rm -rf --one-file-system "$place"' EXIT
make_bare "$place"

bad=0
for command in "${commands[@]}"; do
  rm -rf --one-file-system "$place/machine"
  cp -a "$place/bare" "$place/machine"
  git clone --quiet --no-hardlinks . "$place/machine/cairn"
  for time in first again; do
    begin=$SECONDS
    status=ok
    run_in "$place/machine" /cairn "$command" >"$place/log" 2>&1 || { status=FAILED; bad=1; }
    tail -n 12 "$place/log"
    echo "── $command, $time: $status in $((SECONDS - begin)) s"
  done
done
exit "$bad"
