#!/usr/bin/env bash
# sysroot.sh ARCHITECTURE FOLDER PACKAGE...: unpacks Debian's packages for another architecture, and all that they depend
# on, in FOLDER: libraries to link with, and for qemu-user to run with. The machine itself is left alone: nothing is
# installed, no architecture is added (that would upgrade packages: both architectures must have one version), no script
# of a package runs. Done already: does nothing, and works offline. RELEASE in the environment: another release than the
# machine's, from the same mirror.
set -euo pipefail
architecture=$1 folder=$2
shift 2
. /etc/os-release
release=${RELEASE:-$VERSION_CODENAME}
folder=$(readlink -m "$folder")
wanted="$release $architecture $folder $*"
if [ "$(cat "$folder/.complete" 2>/dev/null)" = "$wanted" ]; then exit 0; fi

# An apt of its own: lists, status and cache lie beside the folder, so a download that was cut off goes on.
state=$folder.apt
mkdir -p "$state"/lists/partial "$state"/cache/archives/partial
: >"$state/status" # nothing is installed: dependencies are all fetched
: >"$state/apt.conf"
# Only the release itself. Its security updates have an index of their own for each architecture, which mirrors get later.
site=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' 'Codename: '"$VERSION_CODENAME" | head -n 1)
[ -n "$site" ] || { echo "sysroot.sh: apt has no source of Debian's release $VERSION_CODENAME" >&2 && exit 1; }
echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $site $release main" >"$state/sources.list"
its_apt() {
  apt-get -q -o APT::Architecture="$architecture" -o APT::Architectures="$architecture" \
    -o Dir::State="$state" -o Dir::State::lists="$state/lists" -o Dir::State::status="$state/status" \
    -o Dir::Cache="$state/cache" -o Dir::Etc::sourcelist="$state/sources.list" -o Dir::Etc::sourceparts=/dev/null \
    -o Dir::Etc::preferencesparts=/dev/null -o Debug::NoLocking=1 -o APT::Install-Recommends=0 \
    -o APT::Sandbox::User="$(id -un)" -o DPkg::Post-Invoke= -o APT::Update::Post-Invoke= \
    -o APT::Keep-Downloaded-Packages=true "$@"
}
its_apt update
its_apt -y --download-only install "$@"

rm -rf "$folder"
mkdir -p "$folder"
for package in "$state"/cache/archives/*.deb; do
  dpkg-deb --fsys-tarfile "$package" | tar -x -C "$folder" --keep-directory-symlink \
    --exclude='./usr/share/doc/*' --exclude='./usr/share/man/*' --exclude='./usr/share/locale/*'
done
# A link to /lib/... would lead into the host.
find "$folder" -type l -lname '/*' | while read -r link; do
  ln -sfnr "$folder$(readlink "$link")" "$link"
done
# Some packages say in their files for CMake that they lie in /usr. pkg-config can be told of another root, CMake cannot.
find "$folder"/usr/{lib,share} -path '*/cmake/*' -name '*.cmake' -exec sed -i "s|\"/usr|\"$folder/usr|g" {} +
echo "$wanted" >"$folder/.complete"
