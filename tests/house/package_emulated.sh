#!/usr/bin/env bash
# package_emulated.sh PACKAGES SOURCE SYSROOT WORK: Debian's packages for arm64, unpacked beside the libraries of SYSROOT
# (in a copy, WORK): the program runs in qemu-aarch64, and so does what is linked with the archives. The emulator is called
# by its name: what the kernel does with foreign programs (binfmt) is left as it is.
set -euo pipefail
packages=$1 source=$(readlink -f "$2") sysroot=$3 work=$4
mkdir -p "$work"
work=$(readlink -f "$work")
rm -rf "${work:?}"/*
cp -al "$sysroot" "$work/root"
for package in "$packages"/*_arm64.deb; do
  dpkg-deb -x "$package" "$work/root"
done
emulated() { qemu-aarch64 -L "$work/root" "$@"; }
emulated "$work/root/usr/bin/accrete" selftest
cp -r "$source/tests/install/find_package" "$work/project"
cp "$source"/tests/install/*.cpp "$work/project"
cmake -S "$work/project" -B "$work/build" -G Ninja --toolchain "$source/toolchains/aarch64-linux-gnu.cmake" \
  -DACCRETE_SYSROOT="$work/root" -DCMAKE_BUILD_TYPE=Release
cmake --build "$work/build"
for program in robot scene; do
  emulated "$work/build/$program" >"$work/said"
  tail -n 1 "$work/said"
done
rm -rf "$work"
