#!/bin/sh
# Runs in the empty Debian of package_chroot.sh.
set -eu
export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8
install() { apt-get -qq -o Dpkg::Use-Pty=0 install -y --no-install-recommends "$@" >/dev/null; }
fail() { echo "package_in_chroot.sh: $*" >&2 && exit 1; }
runs() { "$@" >/tmp/said && tail -n 1 /tmp/said || fail "$1 does not run"; }
absent() { # PACKAGE...
  for package in "$@"; do
    if dpkg-query -W "$package" >/dev/null 2>&1; then fail "$package came along"; fi
  done
}

echo "== accrete-tools alone"
install /files/packages/accrete-tools_*.deb
[ -z "$(dpkg -V accrete-tools)" ] || fail "files of accrete-tools are not as they were packed"
accrete selftest
absent libaccrete-dev libpng-dev gcc

echo "== libaccrete-dev: the core needs a compiler and nothing else"
install g++ pkg-config
dpkg-query -W -f '${Package}\n' | sort >/tmp/before
install /files/packages/libaccrete-dev_*.deb
dpkg-query -W -f '${Package}\n' | sort | comm -13 /tmp/before - >/tmp/came
[ "$(cat /tmp/came)" = libaccrete-dev ] || fail "with libaccrete-dev came: $(cat /tmp/came)"
cd /files/project
# shellcheck disable=SC2046
g++ -std=c++20 robot.cpp -o robot $(pkg-config --static --cflags --libs accrete)
runs ./robot

echo "== libaccrete-hal-dev, by pkg-config and by CMake"
install /files/packages/libaccrete-hal-dev_*.deb
sh -e ./build.sh
runs ./scene
install cmake make
cmake -S . -B build -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build build >/dev/null
runs build/robot
runs build/scene

echo "== purged"
apt-get -qq purge -y accrete-tools libaccrete-dev libaccrete-hal-dev >/dev/null
left=$(find / -xdev -path /files -prune -o -path /proc -prune -o -name '*accrete*' -print)
[ -z "$left" ] || fail "this is left behind: $left"
