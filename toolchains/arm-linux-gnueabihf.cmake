# ARMv7 with VFPv4 (Cortex-A7, A15 and later), Debian's g++-arm-linux-gnueabihf. Not NEON: it flushes subnormals and has
# no vector division, so g++ would not use it for IEEE arithmetic anyway.
set(CMAKE_SYSTEM_PROCESSOR armv7l)
set(triple arm-linux-gnueabihf)
set(emulator qemu-arm)
set(CMAKE_CXX_FLAGS_INIT "-march=armv7-a -mfpu=vfpv4 -mfloat-abi=hard")
include(${CMAKE_CURRENT_LIST_DIR}/linux.cmake)
