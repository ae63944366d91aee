#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Format, shell scripts and clang-tidy: tools/ci/lint.sh [FILE.cpp…]    (clang-tidy only over the files named)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

tools/packages.sh build test ci
mapfile -t sources < <(find hal drivers onboard fusion tools tests \( -name '*.hpp' -o -name '*.cpp' \) -type f 2>/dev/null | sort)
mapfile -t scripts < <(find tools toolchains tests .ci \( -name '*.sh' -o -path .ci/run \) -type f | sort)
bad=0

clang-format-14 --dry-run -Werror "${sources[@]}" || { bad=1; echo "remedy: clang-format-14 -i on these files"; }
shellcheck "${scripts[@]}" || bad=1

# clang-tidy reads the compile commands; nothing needs to be built.
cmake --preset clang --log-level=WARNING >/dev/null
if (($# > 0)); then files=("$@"); else mapfile -t files < <(printf '%s\n' "${sources[@]}" | grep '\.cpp$'); fi
known=$(sed -n 's/^ *"file": "\(.*\)",\?$/\1/p' build/clang/compile_commands.json)
printf '%s\n' "${files[@]}" | while IFS= read -r file; do
  if grep -Fqx "$PWD/$file" <<<"$known"; then echo "$file"; fi
done | xargs -d '\n' -n 1 -P "$(nproc)" clang-tidy-14 -p build/clang --quiet --warnings-as-errors='*' 2>/dev/null || bad=1

((bad == 0)) && echo "lint: ${#sources[@]} sources and ${#scripts[@]} scripts are in order"
exit "$bad"
