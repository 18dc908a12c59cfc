# Installation, and the file `places`, which tells drumlin-tools and the front script where decks, plugin and
# engines are. It lies next to drumlin-tools, and its paths are relative to its own folder, so that a build
# folder or an installation can be moved.
set(folder_of_parts lib/drumlin)
set(folder_of_shares share/drumlin)
set(folder_of_pages share/doc/drumlin)

function(write_places file inputs libraries installed)
  set(text "inputs=${inputs}\ninstalled=${installed}\n")
  if(DRUMLIN_LIGGGHTS)
    string(APPEND text "liggghts_plugin=${libraries}libdrumlin.so\nliggghts=${LIGGGHTS_PROGRAM}\n")
  endif()
  if(DRUMLIN_LAMMPS)
    string(APPEND text "lammps_plugin=${libraries}drumlinplugin.so\nlammps=${LAMMPS_PROGRAM}\n")
  endif()
  file(CONFIGURE OUTPUT ${file} CONTENT "${text}" @ONLY)
endfunction()

file(RELATIVE_PATH inputs ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${PROJECT_SOURCE_DIR}/inputs)
file(RELATIVE_PATH libraries ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
write_places(${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/places ${inputs} ${libraries}/ no)

# What an installation has: bin/drumlin, parts, decks and pages.
file(RELATIVE_PATH inputs /${folder_of_parts} /${folder_of_shares}/inputs)
write_places(${PROJECT_BINARY_DIR}/places ${inputs} "" yes)
install(PROGRAMS drumlin DESTINATION bin)
install(FILES ${PROJECT_BINARY_DIR}/places DESTINATION ${folder_of_parts})
set(targets "")
foreach(target drumlin drumlin-liggghts drumlin-lammps drumlinplugin drumlin-tools)
  if(TARGET ${target})
    list(APPEND targets ${target})
  endif()
endforeach()
install(TARGETS ${targets} RUNTIME DESTINATION ${folder_of_parts} LIBRARY DESTINATION ${folder_of_parts})
install(DIRECTORY inputs DESTINATION ${folder_of_shares})
install(FILES LICENSE DESTINATION ${folder_of_pages} RENAME copyright)
install(FILES README.md ARCHITECTURE.md CHANGELOG.md CITATION.cff DESTINATION ${folder_of_pages})
# Pages and their pictures, in folders as here, so that links among them hold.
foreach(folder inputs plugin/doc postprocess)
  install(DIRECTORY ${folder}/ DESTINATION ${folder_of_pages}/${folder} FILES_MATCHING
          PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg")
endforeach()
install(DIRECTORY postprocess/ DESTINATION ${folder_of_shares} FILES_MATCHING PATTERN "*.py")

# Installed decks and scripts name the program as it is called there, in comments and in the messages of
# `drumlin/check`. The job scripts speak of both.
install(CODE "
  execute_process(COMMAND find \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${folder_of_shares}\" -type f
                          ! -name *.png ! -name *.svg ! -path */jobs/*
                          -exec sed -i s,[.]/drumlin,drumlin,g {} + COMMAND_ERROR_IS_FATAL ANY)")

# The package of this Debian, by `cpack -G DEB` in the build folder.
set(CPACK_PACKAGE_CONTACT "drumlin developers <drumlin@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON) # libraries of the release that it is built on
set(CPACK_DEBIAN_PACKAGE_DEPENDS "gnuplot-nox | gnuplot, openmpi-bin")
# The plugin does not name the engine's library, so that the list above does not have it.
if(DRUMLIN_LIGGGHTS AND NOT LIGGGHTS_SOURCE_DIR)
  string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", liggghts (>= ${LIGGGHTS_VERSION}), liggghts (<< ${LIGGGHTS_VERSION}.1)")
endif()
include(CPack)
