# Debian packages by CPack, one for each component of the installation (docs/howto/debian_packages.md): `cpack` in the
# build folder, or `./dev package`, which sets the folders as Debian wants them (CMAKE_INSTALL_PREFIX=/usr).
#   core  -> libaccrete-dev       headers and archive of the core, which needs nothing
#   hal   -> libaccrete-hal-dev   the hardware layer, which needs what its files are linked with
#   tools -> accrete-tools        the program
# There is no package of a shared library: none is built. Accumulator<Limits> is compiled into the user's program together
# with its memory, so that a library exchanged below it would be wrong without anybody noticing.
if(NOT UNIX OR NOT CMAKE_SYSTEM_NAME STREQUAL "Linux")
  return()
endif()

# Debian's name of the architecture is not the one of the machine that packs.
set(debian_of_x86_64 amd64)
set(debian_of_aarch64 arm64)
set(debian_of_armv7l armhf)
set(debian_of_riscv64 riscv64)
if(NOT DEFINED debian_of_${CMAKE_SYSTEM_PROCESSOR})
  return()
endif()
set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE ${debian_of_${CMAKE_SYSTEM_PROCESSOR}})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME accrete)
set(CPACK_PACKAGE_VENDOR "accrete developers")
set(ACCRETE_MAINTAINER "accrete developers <accrete@localhost>" CACHE STRING "Who made the packages: Name <address>")
set(CPACK_PACKAGE_CONTACT ${ACCRETE_MAINTAINER})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS  # whatever the umask is
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # it would stand before the first line of each description below
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 0accrete1)  # older than -1, the first that Debian itself would make
set(CPACK_DEBIAN_PACKAGE_SOURCE accrete)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian/finish.cmake)
set(CPACK_ACCRETE_SOURCE ${PROJECT_SOURCE_DIR})  # these three are read by finish.cmake
set(CPACK_ACCRETE_STRIP ${CMAKE_STRIP})
set(CPACK_ACCRETE_VERSION ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})

set(about "accrete accumulates a 3D model of an object or a scene from stereo images
while it moves: oriented edges with colours, each with its uncertainty, tracked
by a Kalman filter of its own.")

# Two libraries of one version may be installed for two architectures (Multi-Arch: same), a program serves all of them
# (foreign). CPack has no word for this field before CMake 3.31, so it follows on the line of the section.
set(multi_arch_lib "\nMulti-Arch: same")
set(multi_arch_program "\nMulti-Arch: foreign")
if(NOT CMAKE_INSTALL_LIBDIR MATCHES "^lib/.*linux")  # two of them would write the same files
  set(multi_arch_lib "")
endif()

set(CPACK_COMPONENTS_ALL core)
set(CPACK_DEBIAN_CORE_PACKAGE_NAME libaccrete-dev)
set(CPACK_DEBIAN_CORE_PACKAGE_SECTION "libdevel${multi_arch_lib}")
set(CPACK_DEBIAN_CORE_DESCRIPTION "3D models of edges from stereo images - development files
${about}
.
This package has the static library and its headers. It needs nothing but a
compiler of C++20, and allocates no memory after construction.")

if(ACCRETE_HAL)
  # What the archive was linked with. A library of C++ has to stay the one whose headers were compiled, up to its patches.
  set(hal_depends "libaccrete-dev (= ${CPACK_ACCRETE_VERSION})")
  get_property(pairs GLOBAL PROPERTY ACCRETE_DEBIAN_OF_HAL)
  foreach(pair IN LISTS pairs)
    if(pair MATCHES "^(libyaml-cpp-dev|libcamera-dev)=([0-9.]+\\.)([0-9]+)$")
      math(EXPR next "${CMAKE_MATCH_3} + 1")
      string(APPEND hal_depends ", ${CMAKE_MATCH_1} (>= ${CMAKE_MATCH_2}${CMAKE_MATCH_3})"
                                ", ${CMAKE_MATCH_1} (<< ${CMAKE_MATCH_2}${next}~)")
    else()
      string(REGEX REPLACE "=.*" "" package ${pair})
      string(APPEND hal_depends ", ${package}")
    endif()
  endforeach()
  list(APPEND CPACK_COMPONENTS_ALL hal)
  set(CPACK_DEBIAN_HAL_PACKAGE_NAME libaccrete-hal-dev)
  set(CPACK_DEBIAN_HAL_PACKAGE_SECTION "libdevel${multi_arch_lib}")
  set(CPACK_DEBIAN_HAL_PACKAGE_DEPENDS ${hal_depends})
  set(CPACK_DEBIAN_HAL_DESCRIPTION "3D models of edges from stereo images - hardware layer
${about}
.
This package has the static library, and its headers, that feeds it: from
recordings, from live cameras and from a synthetic scene.")
endif()

if(ACCRETE_TOOLS)
  list(APPEND CPACK_COMPONENTS_ALL tools)
  set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME accrete-tools)
  set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION "science${multi_arch_program}")
  set(CPACK_DEBIAN_TOOLS_DESCRIPTION "3D models of edges from stereo images - program
${about}
.
This package has the program, which reads recordings and live cameras, says
what is wrong with a stereo rig, and measures how good a model is.")
  if(CMAKE_CROSSCOMPILING)  # dpkg-shlibdeps asks the packages of this machine, which has those of another architecture
    set(ACCRETE_DEBIAN_DEPENDS "" CACHE STRING "What accrete-tools depends on; ./dev package takes it from the native package")
    set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS ${ACCRETE_DEBIAN_DEPENDS})
  else()
    set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)
  endif()
endif()

include(CPack)
