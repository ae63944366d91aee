# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# Sourced by the scripts that prove something on a bare Debian 12. Needs root.

# make_bare PLACE: makes a bare Debian 12 in PLACE/bare. The apt settings of this machine are copied, so packages come from
# the same sources.
make_bare() {
  local place=$1 mirror settings
  ((EUID == 0)) || { echo "$0: making a root needs root" >&2; return 1; }
  tools/packages.sh fresh
  # shellcheck disable=SC2016  # apt-get expands it
  mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Codename: bookworm' | head -n 1)
  echo "A bare Debian 12 in $place …"
  debootstrap --variant=minbase bookworm "$place/bare" "$mirror" >"$place/debootstrap.log" ||
    { tail "$place/debootstrap.log"; return 1; }
  for settings in /etc/apt/sources.list /etc/apt/sources.list.d/*.{list,sources} /etc/apt/apt.conf.d/* /etc/resolv.conf /etc/hosts; do
    [[ -f $settings && $settings != *docker* ]] && install -D -m 644 "$settings" "$place/bare$settings"
  done
  echo "It holds $(chroot "$place/bare" dpkg-query -W | wc -l) packages."
}

# run_in ROOT FOLDER COMMAND: runs it there. Mounts and processes end with it: both are in namespaces of their own.
run_in() {
  # shellcheck disable=SC2016  # expanded by the inner shell
  unshare --mount --pid --fork bash -c '
    mount --rbind /dev "$1/dev" && mount -t proc proc "$1/proc" && cd "$1" &&
    exec chroot "$1" env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root CI=true \
      bash -c "cd $2 && $3"' run "$1" "$2" "$3" </dev/null
}
