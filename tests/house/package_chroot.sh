#!/usr/bin/env bash
# package_chroot.sh PACKAGES SOURCE WORK: installs Debian's packages in a Debian that has nothing else (mmdebstrap, in
# WORK/root, removed at the end), one after the other: each must bring what it needs, and no more. Mirrors are this
# machine's. Exit status 77: such a Debian cannot be made here.
set -euo pipefail
packages=$(readlink -f "$1") source=$(readlink -f "$2") work=$3
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
. /etc/os-release
# Interrupted, mmdebstrap leaves the machine's own /dev, /proc and /sys mounted in there: nothing of theirs is removed.
clean() {
  local path
  path=$(readlink -m "$work")/
  awk -v path="$path" 'index($2, path) == 1 { print $2 }' /proc/mounts | sort -r | xargs -r -n 1 umount -l || return
  rm -rf --one-file-system "$work"
}
trap clean EXIT
clean
mkdir -p "$work/files/packages" "$work/files/project"
cp "$packages"/*_"$(dpkg --print-architecture)".deb "$work/files/packages"
cp "$source"/tests/install/*.cpp "$source"/tests/install/find_package/CMakeLists.txt \
  "$source"/tests/install/pkg_config/build.sh "$work/files/project"
cp "$here/package_in_chroot.sh" "$work/files"
apt-get indextargets --format 'deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $(SITE) $(CODENAME) main' \
  'Created-By: Packages' "Codename: $VERSION_CODENAME" | sort -u | head -n 1 >"$work/sources.list"
[ -s "$work/sources.list" ] || { echo "package_chroot.sh: apt has no source of Debian's $VERSION_CODENAME" >&2 && exit 1; }
status=0
mmdebstrap --variant=minbase --quiet --customize-hook="touch $work/made" --customize-hook="copy-in $work/files /" \
  --customize-hook='chroot "$1" sh /files/package_in_chroot.sh' "$VERSION_CODENAME" "$work/root" - <"$work/sources.list" ||
  status=$?
[ -e "$work/made" ] || { echo "SKIPPED: no empty Debian can be made here" >&2 && exit 77; }
exit $status
