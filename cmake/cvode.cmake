# Target drumlin_cvode: CVODE with serial vectors. Extra parts of SUNDIALS come by
# drumlin_link_sundials(TARGET PART...).
#
# SUNDIALS' own package file asks for MPI, PETSc and others, which CVODE with serial vectors does not need;
# the libraries are looked up one by one.
include_guard(GLOBAL)
find_path(SUNDIALS_INCLUDE_DIR cvode/cvode.h REQUIRED)
mark_as_advanced(SUNDIALS_INCLUDE_DIR)

function(drumlin_link_sundials target)
  foreach(part ${ARGN})
    find_library(SUNDIALS_${part}_LIBRARY sundials_${part} REQUIRED)
    mark_as_advanced(SUNDIALS_${part}_LIBRARY)
    target_link_libraries(${target} INTERFACE ${SUNDIALS_${part}_LIBRARY})
  endforeach()
endfunction()

add_library(drumlin_cvode INTERFACE)
target_include_directories(drumlin_cvode SYSTEM INTERFACE ${SUNDIALS_INCLUDE_DIR})
file(STRINGS ${SUNDIALS_INCLUDE_DIR}/sundials/sundials_config.h sundials_major REGEX "define SUNDIALS_VERSION_MAJOR ")
string(REGEX MATCH "[0-9]+" sundials_major "${sundials_major}")
if(sundials_major GREATER_EQUAL 7)
  # Since version 7 the headers include mpi.h, and what all libraries of SUNDIALS share is a library of its
  # own.
  find_package(MPI REQUIRED COMPONENTS CXX)
  target_link_libraries(drumlin_cvode INTERFACE MPI::MPI_CXX)
  target_compile_definitions(drumlin_cvode INTERFACE OMPI_SKIP_MPICXX=1 MPICH_SKIP_MPICXX=1)
  drumlin_link_sundials(drumlin_cvode core)
endif()
drumlin_link_sundials(drumlin_cvode cvode nvecserial sunmatrixdense sunlinsoldense sunnonlinsolnewton)
