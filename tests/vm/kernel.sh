#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes a Debian kernel ready for the virtual machine without installing anything, and prints the folder that holds it:
# vmlinuz, busybox, modules/*.ko and modules/order (one "FILE [OPTION…]" a line, dependencies first).
#   tests/vm/kernel.sh FLAVOUR CACHE [--update]      FLAVOUR: amd64 or rt-amd64
# What CACHE holds is used as it is; --update asks apt for the newest version. gpio-sim is not in Debian's kernels: it is
# built from the kernel's own source package, which stays in CACHE.
# Exit code 77: such a kernel cannot be had from here.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

flavour=${1:?usage: kernel.sh FLAVOUR CACHE [--update]}
mkdir -p "$2/download"
cache=$(cd "$2" && pwd)
update=${3:-}
readonly meta=linux-image-6.12-$flavour

# The modules that the tests need, each with its options; what they depend on is found.
readonly wanted='9p
9pnet_virtio
virtio_pci
overlay
configfs
can-raw
vcan
kvaser_pci
sch_netem
vhci-hcd
uvcvideo
vivid n_devs=1 node_types=0x1 num_inputs=1 input_types=0'

say() { echo "kernel.sh: $*" >&2; }

newest() {  # the version that apt knows, such as 6.12.1+deb12-amd64; its lists may be old or empty
  local as_root=() found
  ((EUID == 0)) || as_root=(sudo -n)
  "${as_root[@]}" apt-get -qq update >&2 || say "apt-get update failed; going on with what apt knows"
  found=$(apt-cache depends "$meta" 2>/dev/null | sed -n 's/.*Depends: linux-image-//p' | head -n 1) || true
  [[ -n $found ]] || { say "apt knows no $meta"; exit 77; }
  echo "$found"
}

# package NAME: the newest downloaded file of this package; nothing if there is none.
package() { find "$cache/download" -name "$1_*.deb" | sort -V | tail -n 1; }

fetch() {  # fetch NAME…: downloads those packages that are not there
  local name absent=()
  for name in "$@"; do [[ -n $(package "$name") ]] || absent+=("$name"); done
  ((${#absent[@]} > 0)) || return 0
  say "downloading ${absent[*]}"
  (cd "$cache/download" && apt-get -qq download "${absent[@]}" >&2) && return
  say "cannot download; remedy: --update, if the kernel's version is no longer offered"
  exit 77
}

# gpio_sim_source: prints the folder with the two files of gpio-sim, from the source package's archive. It is unpacked once,
# and only as far as these two.
gpio_sim_source() {
  local tree=linux-source-6.12 deb kept new
  deb=$(package "$tree")
  kept=$cache/$(basename "$deb" .deb)
  if [[ ! -d $kept ]]; then
    new=$(mktemp -d "$cache/unpacked.XXXXXX")
    { dpkg-deb --fsys-tarfile "$deb" | tar -xO "./usr/src/$tree.tar.xz" | xz -dc -T0 |
      tar -x -C "$new" --transform 's#.*/##' --occurrence=1 "$tree/drivers/gpio/gpio-sim.c" "$tree/kernel/irq/irq_sim.c"; } 2>/dev/null || true
    [[ -s $new/gpio-sim.c && -s $new/irq_sim.c ]] || { say "no gpio-sim in $deb"; return 1; }
    mv "$new" "$kept"
  fi
  echo "$kept"
}

build_gpio_sim() {  # build_gpio_sim UNPACKED VERSION OUT.ko
  local headers=$1/usr/src/linux-headers-$2 build=$1/gpio-sim source
  source=$(gpio_sim_source)
  mkdir "$build"
  cp "$source"/*.c "$build/"
  # irq_to_desc is not exported to modules; generic_handle_irq does the same with the number.
  sed -i 's/handle_simple_irq(irq_to_desc(irqnum))/generic_handle_irq(irqnum)/' "$build/irq_sim.c"
  printf 'obj-m := cairn-gpio-sim.o\ncairn-gpio-sim-y := gpio-sim.o irq_sim.o\n' >"$build/Kbuild"
  sed -i "s#^include /usr/src#include $1/usr/src#" "$headers/Makefile"
  make -s -C "$headers" "M=$build" CONFIG_DEBUG_INFO_BTF_MODULES= modules >&2
  cp "$build/cairn-gpio-sim.ko" "$3"
}

# add_modules TREE OUT: copies what `wanted` names and its dependencies, decompressed, and writes their order.
add_modules() {
  local tree=$1 out=$2 file name options
  declare -A path=() added=()
  while read -r file; do
    name=${file##*/}
    name=${name%%.ko*}
    path[${name//-/_}]=$file
  done < <(find "$tree" -name '*.ko*' -type f)
  add() {  # add NAME [OPTIONS]
    local key=${1//-/_} dependency
    [[ -z ${added[$key]:-} ]] || return 0
    added[$key]=yes
    if [[ -z ${path[$key]:-} ]]; then
      grep -Eq "/${key//_/[-_]}\.ko$" "$tree/modules.builtin" || { say "this kernel has no module $1"; return 1; }
      return 0
    fi
    while read -r dependency; do
      [[ -z $dependency ]] || add "$dependency"
    done < <(modinfo -F depends "${path[$key]}" | tr , '\n')
    case ${path[$key]} in
      *.xz) xz -dc "${path[$key]}" ;;
      *.zst) zstd -qdc "${path[$key]}" ;;
      *) cat "${path[$key]}" ;;
    esac >"$out/$key.ko"
    echo "$key.ko${2:+ $2}" >>"$out/order"
  }
  while read -r name options; do add "$name" "$options" || return; done <<<"$wanted"
}

prepare() {  # prepare VERSION OUT
  local version=$1 base=${1%-amd64} common=common unpacked tree name
  [[ $base != *-rt ]] || { base=${base%-rt} common=common-rt; }
  local -a packages=("linux-image-$version" "linux-headers-$version" "linux-headers-$base-$common" "linux-kbuild-$base")
  fetch "${packages[@]}" linux-source-6.12 busybox-static
  unpacked=$(mktemp -d "$cache/unpacked.XXXXXX")
  # shellcheck disable=SC2064  # the value it has now
  trap "rm -rf '$unpacked'" EXIT
  say "unpacking $version"
  for name in "${packages[@]}" busybox-static; do dpkg -x "$(package "$name")" "$unpacked"; done
  mkdir -p "$unpacked/ready/modules"
  cp "$unpacked/boot/vmlinuz-$version" "$unpacked/ready/vmlinuz"
  cp "$unpacked/bin/busybox" "$unpacked/ready/busybox"
  tree=$unpacked/lib/modules/$version
  [[ -d $tree ]] || tree=$unpacked/usr/lib/modules/$version
  add_modules "$tree" "$unpacked/ready/modules"
  say "building gpio-sim"
  build_gpio_sim "$unpacked" "$version" "$unpacked/ready/modules/cairn_gpio_sim.ko"
  echo cairn_gpio_sim.ko >>"$unpacked/ready/modules/order"
  rm -rf "$2"
  mv "$unpacked/ready" "$2"
}

stamp=$cache/$flavour.version
if [[ -s $stamp && $update != --update ]]; then
  version=$(<"$stamp")
else
  version=$(newest)
  # The source is the only package whose name does not tell its version.
  [[ $update != --update ]] || rm -f "$cache/download"/linux-source-6.12_*.deb
fi
ready=$cache/$version-$(sha256sum "$here/kernel.sh" | cut -c 1-8)
[[ -s $ready/vmlinuz ]] || prepare "$version" "$ready"
echo "$version" >"$stamp"
echo "$ready"
