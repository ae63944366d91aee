# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# Sourced by tools/protocol*.sh, in place of tools/common.sh, which it sources: options, steps and programs.
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

# take_options "NAME…" ARGUMENT…: --NAME VALUE sets the variable NAME. After NAME! no value comes: --NAME sets it to 1.
# --help prints the comment at the head of the script.
take_options() {
  local names=" $1 "
  shift
  while (($# > 0)); do
    case $1 in
      -h | --help) awk 'NR > 2 && !/^#/ { exit } NR > 2 { sub(/^# ?/, ""); print }' "$0" && exit ;;
      --*)
        if [[ $names == *" ${1#--}! "* ]]; then
          printf -v "${1#--}" 1 && shift && continue
        fi
        [[ $names == *" ${1#--} "* ]] || { echo "${0##*/}: unknown argument '$1' (see --help)" >&2 && exit 2; }
        (($# > 1)) || { echo "${0##*/}: $1 needs a value (see --help)" >&2 && exit 2; }
        printf -v "${1#--}" %s "$2" && shift 2
        ;;
      *) echo "${0##*/}: unknown argument '$1' (see --help)" >&2 && exit 2 ;;
    esac
  done
}

# step N/ALL TEXT: says what comes now, and how long everything before it took.
step() { printf '%s %s (after %d min %02d s)\n' "$1" "$2" $((SECONDS / 60)) $((SECONDS % 60)) >&2; }

# build_programs PRESET PROGRAM…: builds, and sets bin and cairn. With the preset protocol it installs PCL first.
build_programs() {
  local preset=$1
  shift
  if [[ $preset == protocol ]]; then
    tools/packages.sh build protocol
    source tools/protocol/pcl_headers.sh
  else
    tools/packages.sh build
  fi
  build "$preset" --target cairn protocol "$@"
  # shellcheck disable=SC2034  # for the scripts that source this
  bin=build/$preset/bin cairn=build/$preset/bin/cairn
}

# at_once: runs the commands that come in, ended by NUL, one on each processor. Each has one thread.
at_once() { OMP_NUM_THREADS=1 xargs -0 -n 1 -P "$(nproc)" bash -c; }
