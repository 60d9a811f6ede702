# What the toolchain files of Linux share, after they have set `triple` and `emulator`: Debian's g++-<triple>.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_C_COMPILER ${triple}-gcc)
set(CMAKE_CXX_COMPILER ${triple}-g++)
set(CMAKE_LIBRARY_ARCHITECTURE ${triple})
include(${CMAKE_CURRENT_LIST_DIR}/host_stays_out.cmake)
if(ACCRETE_SYSROOT)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${emulator} -L ${ACCRETE_SYSROOT})
else()  # static: the emulator needs no libraries of the target, and the program runs on any Linux
  set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${emulator})
endif()
