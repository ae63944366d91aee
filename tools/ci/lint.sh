#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Format, shell scripts, lengths of files, and the checks of .clang-tidy (lengths of functions among them):
#   tools/ci/lint.sh [FILE…]      the checks over these files, or over all
#   tools/ci/lint.sh --changed    over the .cpp files that changed in the three hours before HEAD, as CI does for its time
#   tools/ci/lint.sh --format     format and shell scripts alone
#   tools/ci/lint.sh --full       the checks by clang-tidy itself: ten times slower, because it also reads the headers of
#                                 libraries; it adds bugprone-use-after-move, which clangd leaves out
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

tools/packages.sh build test ci
mapfile -t sources < <(find hal drivers onboard fusion tools examples tests \( -name '*.hpp' -o -name '*.cpp' \) -type f 2>/dev/null | sort)
mapfile -t scripts < <(find tools toolchains tests .ci \( -name '*.sh' -o -path .ci/run \) -type f | sort)
bad=0

clang-format-14 --dry-run -Werror "${sources[@]}" || { bad=1; echo "remedy: clang-format-14 -i on these files"; }
shellcheck "${scripts[@]}" || bad=1
awk 'FNR == 301 { print FILENAME ": longer than 300 lines: split it by meaning"; long = 1 } END { exit long }' "${sources[@]}" || bad=1

# Both read the compile commands. Only generated headers are built. A header uses the commands of a neighbouring file.
# Each file has a command of its own only without CAIRN_UNITY, which tools/test.sh --clang leaves in the cache.
cmake --preset clang -DCAIRN_UNITY=OFF >/dev/null
cmake --build --preset clang --target cairn_dds_types cairn_ros_types -- --quiet >/dev/null

mapfile -t files < <(printf '%s\n' "${sources[@]}" | grep '\.cpp$')
known=$(comm -12 <(printf '%s\n' "${files[@]}") \
  <(sed -n "s#.*\"file\": \"$PWD/\(.*\)\".*#\1#p" build/clang/compile_commands.json | sort -u) | wc -l)
if ((2 * known < ${#files[@]})); then
  echo "build/clang/compile_commands.json has $known of ${#files[@]} files: too few could be checked" >&2
  exit 1
fi

# shellcheck disable=SC2317  # xargs calls it
tidy() {  # tidy FILE: clangd runs clang-tidy's checks over the file's own lines
  local out
  # What is not compiled here (libgpiod 2 where there is 1) cannot be checked here.
  [[ $1 != *.cpp ]] || grep -q "\"file\": .*/$1\"" build/clang/compile_commands.json || { echo "not compiled here: $1"; return 0; }
  out=$(clangd-14 --check="$1" --check-lines=1-1 --background-index=false 2>&1) || true
  [[ $out != *"All checks completed, 0 errors"* ]] || return 0
  grep '^E\[' <<<"$out" | sed -E "s#^E\[[^]]*\] \[([^]]*)\] Line ([0-9]+): (.*)#$1:\2: \3 [\1]#" || tail -n 5 <<<"$out"
  return 1
}
export -f tidy

case ${1:-} in
  --format) ;;
  --full) printf '%s\n' "${sources[@]}" | grep '\.cpp$' |
    xargs -d '\n' -n 1 -P "$(nproc)" clang-tidy-14 -p build/clang --quiet 2>/dev/null || bad=1 ;;
  *)
    if [[ ${1:-} == --changed ]]; then
      # Dates are those of the commits, so that the same commit is always checked in the same way.
      hours_before=$(($(git log -1 --format=%ct) - 3 * 3600))
      base=$(git rev-list -1 --before="$hours_before" HEAD)
      mapfile -t changed < <(git diff --name-only --diff-filter=d "${base:-$(git hash-object -t tree /dev/null)}" -- \
        hal drivers onboard fusion tools examples tests | grep '\.cpp$')
      ((${#changed[@]} > 0)) || changed=(hal/clock.cpp)
      set -- "${changed[@]}"
    fi
    (($# > 0)) || set -- "${sources[@]}"
    # shellcheck disable=SC2016  # expanded by the inner shell
    printf '%s\n' "$@" | xargs -d '\n' -n 1 -P "$(nproc)" bash -c 'tidy "$1"' tidy || bad=1
    ;;
esac

((bad == 0)) && echo "lint: ${#sources[@]} sources and ${#scripts[@]} scripts are in order"
exit "$bad"
