#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Proves that the commands of the README work on a bare Debian 12. Makes such a root in a folder. For each command it copies
# the root, clones the project into the copy, and runs the command there twice as root. Prints how long each run took.
#   tools/ci/fresh_machine.sh [COMMAND…]      as root; default: ./tools/test.sh ./tools/demo.sh
# The apt settings of this machine are copied, so packages come from the same sources.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

((EUID == 0)) || { echo "fresh_machine.sh: making a root needs root" >&2; exit 1; }
commands=("$@")
((${#commands[@]} > 0)) || commands=(./tools/test.sh ./tools/demo.sh)
tools/packages.sh fresh
place=$(mktemp -d --tmpdir cairn-fresh.XXXXXX)
trap 'rm -rf --one-file-system "$place"' EXIT

# shellcheck disable=SC2016  # apt-get expands it
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Codename: bookworm' | head -n 1)
echo "A bare Debian 12 in $place …"
debootstrap --variant=minbase bookworm "$place/bare" "$mirror" >"$place/debootstrap.log" || { tail "$place/debootstrap.log"; exit 1; }
for settings in /etc/apt/sources.list /etc/apt/sources.list.d/*.{list,sources} /etc/apt/apt.conf.d/* /etc/resolv.conf /etc/hosts; do
  [[ -f $settings && $settings != *docker* ]] && install -D -m 644 "$settings" "$place/bare$settings"
done
echo "It holds $(chroot "$place/bare" dpkg-query -W | wc -l) packages."

# run COMMAND: in the root $place/machine. Its mounts and processes end with it: both are in namespaces of their own.
run() {
  # shellcheck disable=SC2016  # expanded by the inner shell
  unshare --mount --pid --fork bash -c '
    mount --rbind /dev "$1/dev" && mount -t proc proc "$1/proc" && cd "$1" &&
    exec chroot "$1" env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root CI=true \
      bash -c "cd /cairn && $2"' run "$place/machine" "$1" </dev/null
}

bad=0
for command in "${commands[@]}"; do
  rm -rf --one-file-system "$place/machine"
  cp -a "$place/bare" "$place/machine"
  git clone --quiet --no-hardlinks . "$place/machine/cairn"
  for time in first again; do
    begin=$SECONDS
    status=ok
    run "$command" >"$place/log" 2>&1 || { status=FAILED; bad=1; }
    tail -n 12 "$place/log"
    echo "── $command, $time: $status in $((SECONDS - begin)) s"
  done
done
exit "$bad"
