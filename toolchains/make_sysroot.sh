#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Unpacks a Debian 12 arm64 root to compile and link against: toolchains/make_sysroot.sh [FOLDER]
# Packages come from the sources of this machine and are only unpacked, so no arm64 program runs. Does nothing if the folder
# has all packages of the group in tools/packages.sh. The toolchain file finds it at CAIRN_SYSROOT or at sysroot-arm64.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

sysroot=${1:-${CAIRN_SYSROOT:-$PWD/sysroot-arm64}}
wanted=$(tools/packages.sh --list sysroot)
done_list=$sysroot/.cairn-packages
[[ -f $done_list && $(<"$done_list") == "$wanted" ]] && exit 0

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
rm -rf "$sysroot"/usr/share/{doc,man,locale,info} "$sysroot"/var/cache/apt "$sysroot"/var/lib/apt/lists
printf '%s\n' "$wanted" >"$done_list"
echo "$sysroot: $(du -sh "$sysroot" | cut -f1)"
