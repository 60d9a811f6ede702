# What Debian's policy asks of a package beyond the files themselves; cpack runs this on what it has gathered, before it
# packs: copyright and both changelogs in a folder of each package, the manual page compressed, program and archives stripped.
set(package_of_core libaccrete-dev)
set(package_of_hal libaccrete-hal-dev)
set(package_of_tools accrete-tools)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # SOURCE_DATE_EPOCH, where that is set
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  set(root ${CPACK_TEMPORARY_DIRECTORY}/${component}/usr)
  if(NOT IS_DIRECTORY ${root})
    message(FATAL_ERROR "cmake/debian/finish.cmake: nothing was gathered for ${component} in ${root}")
  endif()
  set(doc ${root}/share/doc/${package_of_${component}})
  file(REMOVE_RECURSE ${root}/share/doc)  # the licence is what Debian calls copyright
  file(MAKE_DIRECTORY ${doc})
  configure_file(${CPACK_ACCRETE_SOURCE}/LICENSE ${doc}/copyright COPYONLY)
  configure_file(${CPACK_ACCRETE_SOURCE}/CHANGELOG.md ${doc}/changelog COPYONLY)
  file(WRITE ${doc}/changelog.Debian
       "accrete (${CPACK_ACCRETE_VERSION}) unstable; urgency=medium\n\n"
       "  * Packed by CPack from the sources of this version; see changelog.gz.\n\n"
       " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
  file(GLOB compress ${doc}/changelog* ${root}/share/man/man1/*.1)
  run(gzip -9n ${compress})
  file(GLOB_RECURSE archives ${root}/lib/*.a)
  file(GLOB programs ${root}/bin/*)
  set(needless --remove-section=.comment --remove-section=.note)
  if(archives)
    run(${CPACK_ACCRETE_STRIP} --strip-debug ${needless} --enable-deterministic-archives ${archives})
  endif()
  if(programs)
    run(${CPACK_ACCRETE_STRIP} ${needless} ${programs})
  endif()
  file(GLOB_RECURSE files ${root}/*)
  foreach(file IN LISTS files)
    if(NOT file MATCHES "/bin/[^/]*$")
      file(CHMOD ${file} PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
    endif()
  endforeach()
endforeach()
