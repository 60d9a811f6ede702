# ARMv7 with VFPv4 (Cortex-A7, A15 and later), Debian's g++-arm-linux-gnueabihf. Not NEON: it flushes subnormals and has
# no vector division, so g++ would not use it for IEEE arithmetic anyway.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR armv7l)
set(CMAKE_CXX_COMPILER arm-linux-gnueabihf-g++)
set(CMAKE_CXX_FLAGS_INIT "-march=armv7-a -mfpu=vfpv4 -mfloat-abi=hard")
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-arm)
