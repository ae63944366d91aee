# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# Sourced by tools/protocol/common.sh. libpcl-dev depends on VTK, Qt and Java, none of which is used
# here. Where it is not installed, its headers alone are unpacked into the build's folder.
unpack_headers() {
  local into=$PWD/build/protocol/pcl package
  [[ ! -d /usr/include/pcl-1.13 && ! -d $into/usr/include/pcl-1.13 ]] || return 0
  mkdir -p "$into/packages"
  (cd "$into/packages" && apt-get -qq -o APT::Sandbox::User=root download libpcl-dev libflann-dev)
  for package in "$into"/packages/*.deb; do dpkg-deb -x "$package" "$into"; done
}
unpack_headers
