#!/usr/bin/env bash
# The tests that meet dolfinx, on Debian 13 (dolfinx 0.9, Open MPI 5), in a folder that it is installed
# into; 3 GB, as root.
#   tests/with_debian13.sh FOLDER
set -euo pipefail
home=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
root=${1:?"expected a folder for Debian 13, as in tests/with_debian13.sh /tmp/debian13"}
shift
[ -x "$root/usr/bin/apt-get" ] || debootstrap --variant=minbase trixie "$root"
for place in proc sys dev dev/pts; do
  mkdir -p "$root/$place"
  mountpoint -q "$root/$place" || mount --bind "/$place" "$root/$place"
done
trap 'for place in dev/pts dev sys proc; do umount "$root/$place"; done' EXIT
rm -rf "$root/root/galinx"
git clone --quiet "$home" "$root/root/galinx"
chroot "$root" /root/galinx/run.sh test -m fem "$@"
