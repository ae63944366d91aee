#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The only list of Debian 12 packages. Installs the missing packages of the named groups:
#   tools/packages.sh GROUP…          build test ci cross fresh bench vm protocol docs foreign_dds python training
#   tools/packages.sh --list GROUP…   only prints the packages
# If no package is missing, it changes nothing. If one is missing, it needs root or sudo. It never asks.
set -euo pipefail

declare -rA packages=(
  # the onboard program, the command line and the simulator
  [build]="g++ cmake ninja-build pkg-config ccache mold libeigen3-dev liboctomap-dev libpcap-dev libyaml-cpp-dev
           libfmt-dev libcli11-dev nlohmann-json3-dev libexpected-dev libzstd-dev libxxhash-dev libpng-dev libssl-dev
           libgpiod-dev libembree-dev cyclonedds-dev cyclonedds-tools libopencv-core-dev libopencv-imgproc-dev libopencv-imgcodecs-dev
           libopencv-dnn-dev libopencv-calib3d-dev libopencv-video-dev"
  [test]="libgtest-dev libgmock-dev libbenchmark-dev"
  # the proof that another vendor's DDS reads cairn-ros (tests/tools/ros/process/foreign_test.cpp)
  [foreign_dds]="libfastrtps-dev libfastcdr-dev"
  [bench]="libbenchmark-dev jq"
  # tools/protocol.sh and protocol_people.sh alone: PCL's libraries without libpcl-dev, which depends on VTK, Qt and Java; see there for the headers
  [protocol]="libpcl-registration1.13 libpcl-features1.13 libpcl-filters1.13 libpcl-search1.13 libpcl-kdtree1.13
              libpcl-octree1.13 libpcl-sample-consensus1.13 libpcl-common1.13 libflann1.9 libboost-dev"
  [ci]="clang-14 clang-format-14 clang-tidy-14 clangd-14 libclang-rt-14-dev shellcheck git"
  [cross]="g++-aarch64-linux-gnu qemu-user-static mmdebstrap"
  [fresh]="debootstrap git"
  # the virtual machine of tests/vm: QEMU, what packs its first root and builds one kernel module, and `ip` for CAN's bit rates
  [vm]="qemu-system-x86 cpio kmod xz-utils make gcc-12 libelf1 iproute2"
  # tools/ci/api_reference.sh, and smaller pictures for tools/pictures.sh
  [docs]="doxygen pngquant"
  # the Python module (tools/python) for Debian's own Python
  [python]="pybind11-dev python3-dev python3-numpy"
  # tools/training: what trains the networks of config/models
  [training]="python3-torch python3-onnx python3-numpy python3-opencv python3-protobuf"
  # for another architecture, into a sysroot: Debian has no Embree for arm64, so the simulator is left out there
  [sysroot]="libc6-dev libstdc++-12-dev linux-libc-dev libeigen3-dev liboctomap-dev libpcap-dev libyaml-cpp-dev
             libfmt-dev libcli11-dev nlohmann-json3-dev libexpected-dev libzstd-dev libxxhash-dev libpng-dev libssl-dev
             libgpiod-dev cyclonedds-dev libopencv-core-dev libopencv-imgproc-dev libopencv-imgcodecs-dev
             libopencv-dnn-dev libopencv-calib3d-dev libopencv-video-dev libgtest-dev libgmock-dev"
)

list() {
  local group
  for group in "$@"; do
    [[ -n ${packages[$group]:-} ]] || { echo "packages.sh: no group '$group' (${!packages[*]})" >&2; return 2; }
    # shellcheck disable=SC2086  # split into one name a line on purpose
    printf '%s\n' ${packages[$group]}
  done | sort -u
}

missing() {  # of the names on stdin, those that are not installed
  local -a wanted
  mapfile -t wanted
  comm -23 <(printf '%s\n' "${wanted[@]}") \
    <(dpkg-query -W -f '${db:Status-Abbrev}${Package}\n' "${wanted[@]}" 2>/dev/null | sed -n 's/^ii *//p' | sort -u)
}

install() {
  local as_root=() log
  if ((EUID != 0)); then
    command -v sudo >/dev/null || {
      printf 'Neither root nor sudo here. Run this as root, then try again:\n  apt-get install %s\n' "$*" >&2
      return 1
    }
    as_root=(sudo)
  fi
  printf 'Installing %s packages: %s\n' $# "$*" >&2
  log=$(mktemp)
  local -a apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=600)
  if ! { "${apt[@]}" update && "${apt[@]}" install -y --no-install-recommends "$@"; } >"$log" 2>&1 </dev/null; then
    tail -n 40 "$log" >&2
    echo "Installing failed; all of its output is in $log" >&2
    return 1
  fi
  rm -f "$log"
}

if [[ ${1:-} == --list ]]; then
  shift
  list "$@"
  exit
fi
names=$(list "$@")
if ! command -v apt-get >/dev/null; then
  printf 'Not a Debian machine: nothing is installed. These are needed, as Debian names them:\n%s\n' "$names" >&2
  exit 0
fi
mapfile -t absent < <(missing <<<"$names")
((${#absent[@]} == 0)) || install "${absent[@]}"
