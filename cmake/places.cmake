# Where the parts lie, in the build folder and under the prefix of an installation. The file `places`, beside the program drumlin-tools,
# says it to that program and to the front script; paths in it count from its own folder, so that either tree can be moved.
set(folder_of_parts lib/drumlin)
set(folder_of_shares share/drumlin)
set(folder_of_pages share/doc/drumlin)

function(write_places file inputs libraries)
  set(text "inputs=${inputs}\n")
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
write_places(${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/places ${inputs} ${libraries}/)
