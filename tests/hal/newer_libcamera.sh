#!/usr/bin/env bash
# newer_libcamera.sh FOLDER [RELEASE]: compiles the only file that includes libcamera against the headers that a newer release
# of Debian has, unpacked in FOLDER; nothing is installed. Prints the version. Status 3: they cannot be had.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.."
folder=$(readlink -m "$1")
release=${2:-trixie} # Debian 13
architecture=$(dpkg --print-architecture)
root=$folder/$release
RELEASE=$release toolchains/sysroot.sh "$architecture" "$root" libcamera-dev || exit 3

# libcamera is the one package that is looked for by pkg-config: everything else stays the machine's.
export PKG_CONFIG_SYSROOT_DIR=$root
PKG_CONFIG_LIBDIR=$root/usr/lib/$(dpkg-architecture -q DEB_HOST_MULTIARCH 2>/dev/null || gcc -print-multiarch)/pkgconfig
export PKG_CONFIG_LIBDIR
cmake --preset release -B "$folder/build-$release" -DACCRETE_TOOLS=OFF -DACCRETE_TESTS=OFF -DACCRETE_INSTRUCTION_SETS=OFF \
  -DACCRETE_WITH_LIBCAMERA=ON
cmake --build "$folder/build-$release" --target hal/CMakeFiles/accrete_hal.dir/libcamera/cameras.cpp.o
pkg-config --modversion libcamera
