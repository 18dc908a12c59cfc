# Ends with an error if LAMMPS_PROGRAM cannot load a plugin that is compiled for LAMMPS_VERSION. Without this,
# an lmp of another version or without the packages would fail only when a deck runs, with an unknown command
# or an undefined symbol. Also a script:
#   cmake -DLAMMPS_PROGRAM=LMP -DLAMMPS_VERSION="29 Sep 2021" -P check_program.cmake
execute_process(COMMAND ${LAMMPS_PROGRAM} -h OUTPUT_VARIABLE lammps_help ERROR_QUIET RESULT_VARIABLE lammps_status)
if(NOT lammps_status EQUAL 0)
  message(FATAL_ERROR "LAMMPS_PROGRAM is '${LAMMPS_PROGRAM}'; "
                      "allowed: an lmp that runs ('lmp -h' has failed: ${lammps_status})")
endif()
string(REGEX MATCH "- (Update [0-9]+ of )?([0-9]+ [A-Z][a-z]+ [0-9]+)" lammps_found "${lammps_help}")
if(NOT CMAKE_MATCH_2 STREQUAL LAMMPS_VERSION)
  message(FATAL_ERROR "LAMMPS_PROGRAM is '${LAMMPS_PROGRAM}', LAMMPS ${CMAKE_MATCH_2}; "
                      "allowed: ${LAMMPS_VERSION}, the version of LAMMPS_SOURCE_DIR")
endif()
string(REGEX MATCH "Installed packages:[^:]*" lammps_packages "${lammps_help}")
set(lammps_missing "")
foreach(package GRANULAR PLUGIN)
  if(NOT lammps_packages MATCHES "[ \n]${package}[ \n]")
    list(APPEND lammps_missing ${package})
  endif()
endforeach()
if(lammps_missing)
  list(TRANSFORM lammps_missing PREPEND "-DPKG_" OUTPUT_VARIABLE lammps_options)
  list(JOIN lammps_missing ", " lammps_missing)
  list(JOIN lammps_options "=ON " lammps_options)
  message(FATAL_ERROR "LAMMPS_PROGRAM is '${LAMMPS_PROGRAM}', without ${lammps_missing}; allowed: an lmp built with "
                      "${lammps_options}=ON -DBUILD_SHARED_LIBS=ON, as ./drumlin setup lammps builds one")
endif()
