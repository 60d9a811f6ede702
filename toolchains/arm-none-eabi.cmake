# A Cortex-M without an operating system: -DACCRETE_CORTEX=m4 (default), m7 or m55. Debian's gcc-arm-none-eabi with
# libnewlib-arm-none-eabi and libstdc++-arm-none-eabi-dev: headers alone of the C++ library, its archive is not linked.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES ACCRETE_CORTEX)
include(${CMAKE_CURRENT_LIST_DIR}/host_stays_out.cmake)
set(ACCRETE_CORTEX m4 CACHE STRING "Which Cortex-M: m4, m7 or m55")
set_property(CACHE ACCRETE_CORTEX PROPERTY STRINGS m4 m7 m55)

# single: the M4F's unit has no double precision. qemu: the board whose memory tests/determinism/bare/<core>.ld describes.
set(cortex_flags_m4 "-mcpu=cortex-m4 -mfpu=fpv4-sp-d16")
set(cortex_flags_m7 "-mcpu=cortex-m7 -mfpu=fpv5-d16")
set(cortex_flags_m55 "-mcpu=cortex-m55+nomve")  # one lane works on one primitive: no vectors
set(cortex_board_m4 mps2-an386)
set(cortex_board_m7 mps2-an500)
set(cortex_board_m55 mps3-an547)
if(NOT DEFINED cortex_flags_${ACCRETE_CORTEX})
  message(FATAL_ERROR "ACCRETE_CORTEX is '${ACCRETE_CORTEX}': there are m4, m7 and m55")
endif()
set(CMAKE_CXX_FLAGS_INIT "-mthumb ${cortex_flags_${ACCRETE_CORTEX}} -mfloat-abi=hard -ffunction-sections \
-fdata-sections -fno-exceptions -fno-rtti -fno-threadsafe-statics -DACCRETE_ISA=cortex_m -DACCRETE_LANE_WIDTH=1")
# By gcc, which does not ask for libstdc++.
set(CMAKE_CXX_LINK_EXECUTABLE
    "arm-none-eabi-gcc <FLAGS> <LINK_FLAGS> <OBJECTS> -o <TARGET> <LINK_LIBRARIES> -lm -lc -lgcc")
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-system-arm -M ${cortex_board_${ACCRETE_CORTEX}} -display none -monitor none
    -serial none -semihosting-config enable=on,target=native -kernel)
