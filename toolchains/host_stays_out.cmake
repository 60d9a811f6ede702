# What every toolchain file includes: nothing of the host is found but programs that run here. ACCRETE_SYSROOT has the
# target's libraries (`./dev cross` makes it, toolchains/sysroot.sh). Without one there are none, and Eigen, which is
# headers alone, is the host's.
set(ACCRETE_SYSROOT "" CACHE PATH "Folder with the target's libraries; empty: the core alone")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES ACCRETE_SYSROOT)
if(ACCRETE_SYSROOT)
  if(NOT EXISTS ${ACCRETE_SYSROOT}/.complete)
    message(FATAL_ERROR "ACCRETE_SYSROOT=${ACCRETE_SYSROOT} is no complete sysroot: `./dev cross` makes it")
  endif()
  set(target_root ${ACCRETE_SYSROOT})
else()
  # A folder that has neither usr/include nor usr/lib: Debian's cross compilers for Linux search the host's /usr/include
  # last, unless they are told of another root.
  set(target_root ${CMAKE_CURRENT_LIST_DIR})
  if(EXISTS /usr/share/eigen3/cmake/Eigen3Config.cmake)
    set(Eigen3_DIR /usr/share/eigen3/cmake CACHE PATH "Headers alone: the host's serve")
  endif()
endif()
if(CMAKE_SYSTEM_NAME STREQUAL "Generic")  # its compiler has folders of its own
  set(CMAKE_FIND_ROOT_PATH ${target_root})
else()
  set(CMAKE_SYSROOT ${target_root})
endif()
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
list(APPEND CMAKE_FIND_ROOT_PATH ${CMAKE_PREFIX_PATH})  # what the caller has installed for the target
set(ENV{PKG_CONFIG_DIR} "")
set(ENV{PKG_CONFIG_PATH} "")
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${target_root})
set(ENV{PKG_CONFIG_LIBDIR} ${target_root}/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/pkgconfig:${target_root}/usr/share/pkgconfig)
