# Installation: accrete::accrete needs nothing of others; the component hal brings back what its files were linked with.
#   find_package(accrete 0.1 REQUIRED)                 -> accrete::accrete
#   find_package(accrete 0.1 REQUIRED COMPONENTS hal)  -> accrete::hal as well
#   pkg-config --static accrete, accrete-hal           -> the same without CMake
# The components of the installation are core, hal and tools; cmake/debian.cmake makes a package of each.
# docs/howto/use_it.md shows every way, tests/install/ tries it.
if(ACCRETE_MARCH)
  install(CODE "message(FATAL_ERROR \"This build is for ${ACCRETE_MARCH} alone (ACCRETE_MARCH) and cannot be installed\")")
endif()

include(CMakePackageConfigHelpers)
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/accrete)
install(TARGETS accrete EXPORT accreteTargets COMPONENT core)
install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT core FILES_MATCHING PATTERN "*.h")
install(EXPORT accreteTargets NAMESPACE accrete:: DESTINATION ${config_folder} COMPONENT core)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT core)

# What the hardware layer was linked with, for CMake (hal_dependencies) and for pkg-config (hal_modules, hal_private_libs).
# A package's name is its targets' namespace, or the only target's name; a target PkgConfig::NAME is the module `name`.
set(hal_dependencies "")
set(hal_modules "")
set(hal_private_libs "")
set(module_of_PNG libpng)
set(module_of_libjpeg-turbo libturbojpeg)
set(module_of_yaml-cpp yaml-cpp)
if(ACCRETE_HAL)
  get_target_property(hal_libraries accrete_hal LINK_LIBRARIES)
  list(FILTER hal_libraries EXCLUDE REGEX "^accrete$|^\\$|^-|^::@")  # ::@ says from which folder
  foreach(library IN LISTS hal_libraries)
    string(REGEX REPLACE "::.*" "" package ${library})
    if(package STREQUAL "PkgConfig")
      string(REGEX REPLACE ".*::" "" prefix ${library})
      string(TOLOWER ${prefix} module)
      string(APPEND hal_dependencies "    find_dependency(PkgConfig)\n"
                                     "    pkg_check_modules(${prefix} REQUIRED QUIET IMPORTED_TARGET ${module})\n")
      list(APPEND hal_modules ${module})
    else()
      string(APPEND hal_dependencies "    find_dependency(${package})\n")
      if(package STREQUAL "Threads")
        string(APPEND hal_private_libs " ${CMAKE_THREAD_LIBS_INIT}")
      elseif(DEFINED module_of_${package})
        list(APPEND hal_modules ${module_of_${package}})
      else()
        message(FATAL_ERROR "cmake/install.cmake: which module of pkg-config is ${library}? Add it to the table there")
      endif()
    endif()
  endforeach()
  list(JOIN hal_modules " " hal_modules)
  set_target_properties(accrete_hal PROPERTIES EXPORT_NAME hal)
  target_include_directories(accrete_hal PUBLIC $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  install(TARGETS accrete_hal EXPORT accreteHalTargets COMPONENT hal)
  install(DIRECTORY hal/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT hal FILES_MATCHING PATTERN "*.h")
  install(EXPORT accreteHalTargets NAMESPACE accrete:: DESTINATION ${config_folder} COMPONENT hal)
endif()
configure_file(cmake/accreteConfig.cmake.in accreteConfig.cmake @ONLY)
write_basic_package_version_file(accreteConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/accreteConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/accreteConfigVersion.cmake
        DESTINATION ${config_folder} COMPONENT core)

# For pkg-config. Relative to the file itself, so that the folder can be moved, unless the folders are absolute.
set(pc_folder ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
if(IS_ABSOLUTE ${CMAKE_INSTALL_LIBDIR} OR IS_ABSOLUTE ${CMAKE_INSTALL_INCLUDEDIR})
  set(pc_prefix ${CMAKE_INSTALL_PREFIX})
  set(pc_libdir ${CMAKE_INSTALL_FULL_LIBDIR})
  set(pc_includedir ${CMAKE_INSTALL_FULL_INCLUDEDIR})
else()
  file(RELATIVE_PATH pc_prefix /prefix/${pc_folder} /prefix)
  string(REGEX REPLACE "/$" "" pc_prefix "\${pcfiledir}/${pc_prefix}")
  set(pc_libdir \${prefix}/${CMAKE_INSTALL_LIBDIR})
  set(pc_includedir \${prefix}/${CMAKE_INSTALL_INCLUDEDIR})
endif()
configure_file(cmake/accrete.pc.in accrete.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/accrete.pc DESTINATION ${pc_folder} COMPONENT core)
if(ACCRETE_HAL)
  configure_file(cmake/accrete-hal.pc.in accrete-hal.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/accrete-hal.pc DESTINATION ${pc_folder} COMPONENT hal)
endif()

# The program, with a manual page that is its own --help, and a completion that asks it.
if(ACCRETE_TOOLS)
  install(TARGETS accrete_program COMPONENT tools)
  install(FILES cmake/completion.bash RENAME accrete
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT tools)
  if(CMAKE_CROSSCOMPILING AND NOT CMAKE_CROSSCOMPILING_EMULATOR)
    message(STATUS "accrete: the manual page is OFF (it is made by running the program, and there is no emulator)")
  else()
    add_custom_command(OUTPUT accrete.1
      COMMAND sh ${PROJECT_SOURCE_DIR}/cmake/man_page.sh accrete.1 ${CMAKE_CROSSCOMPILING_EMULATOR}
              $<TARGET_FILE:accrete_program>
      DEPENDS accrete_program cmake/man_page.sh COMMENT "Manual page" VERBATIM)
    add_custom_target(accrete_man_page ALL DEPENDS accrete.1)
    install(FILES ${CMAKE_CURRENT_BINARY_DIR}/accrete.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tools)
  endif()
endif()
