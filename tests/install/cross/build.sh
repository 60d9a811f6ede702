#!/bin/sh -e
: "${CMAKE_BUILD_TYPE:=Release}"
export CMAKE_BUILD_TYPE
toolchain=$PWD/accrete/toolchains/aarch64-linux-gnu.cmake
cmake -S accrete -B accrete-aarch64 --toolchain "$toolchain" -DACCRETE_HAL=OFF -DACCRETE_TOOLS=OFF -DACCRETE_TESTS=OFF
cmake --build accrete-aarch64
cmake --install accrete-aarch64 --prefix "$PWD/aarch64"
cmake -S . -B build --toolchain "$toolchain" -DCMAKE_PREFIX_PATH="$PWD/aarch64"
cmake --build build
