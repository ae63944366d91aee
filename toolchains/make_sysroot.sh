#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Unpacks a Debian 12 arm64 root to compile and link against: toolchains/make_sysroot.sh [FOLDER]
# Packages come from the sources of this machine and are only unpacked, so no arm64 program runs. Does nothing if the folder
# has all packages of the group in tools/packages.sh. The toolchain file finds it at CAIRN_SYSROOT or at sysroot-arm64.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

sysroot=${1:-${CAIRN_SYSROOT:-$PWD/sysroot-arm64}}
wanted=$(tools/packages.sh --list sysroot)
done_list=$sysroot/.cairn-packages done="$wanted
eigen-as-on-x86-64"  # what is done below
[[ -f $done_list && $(<"$done_list") == "$done" ]] && exit 0

tools/packages.sh cross
if [[ -d $sysroot/usr ]]; then rm -rf "${sysroot:?}"; fi
sources=()
for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources; do
  [[ -s $file ]] && sources+=("$file")
done
# merged-usr: Debian 12's packages assume that /lib is a link to /usr/lib, which maintainer scripts would make.
mmdebstrap --quiet --variant=extract --architectures=arm64 --hook-dir=/usr/share/mmdebstrap/hooks/merged-usr \
  --include="$(paste -sd, <<<"$wanted")" bookworm "$sysroot" "${sources[@]}" >/dev/null

# OpenCV needs both; update-alternatives, a maintainer script, would have made the links.
for library in blas lapack; do
  ln -sfn "$library/lib$library.so.3" "$sysroot/usr/lib/aarch64-linux-gnu/lib$library.so.3"
done
# The linker would follow an absolute link into the root of this machine.
find "$sysroot/usr" "$sysroot/etc" -type l -lname '/*' | while IFS= read -r link; do
  ln -sfn "$(realpath -m --relative-to="$(dirname "$(realpath -s "$link")")" "$sysroot$(readlink "$link")")" "$link"
done
# Replays must match across machines. Eigen sums 128 bits at a time on both, but on arm64 with fused multiply-add, with
# packets of two floats, and with kernels and blocks of its own for products. Without them it computes what it does on
# x86-64, to the bit.
neon=$sysroot/usr/include/eigen3/Eigen/src/Core/arch/NEON
sed -i -e 's/^#ifdef __ARM_FEATURE_FMA/#if 0/' \
  -e '/struct \(un\)\?packet_traits<\(float\|Packet4f\)>/,/enum/s/typedef Packet2f half/typedef Packet4f half/' \
  -e '/^#define EIGEN_HAS_SINGLE_INSTRUCTION_MADD/d' -e 's/\(DEFAULT_NUMBER_OF_REGISTERS\) 32/\1 16/' \
  "$neon/PacketMath.h"
sed -i 's/^#if EIGEN_ARCH_ARM64/#if 0/' "$neon/GeneralBlockPanelKernel.h"
rm -rf "$sysroot"/usr/share/{doc,man,locale,info} "$sysroot"/var/cache/apt "$sysroot"/var/lib/apt/lists
printf '%s\n' "$done" >"$done_list"
echo "$sysroot: $(du -sh "$sysroot" | cut -f1)"
