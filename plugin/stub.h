#pragma once
// Functions of the two small libraries that an engine loads first (liggghts/preload.cpp, lammps/load.cpp).
// They are linked neither to the engine nor to MPI, and find the functions of both by name.

#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <string>

namespace drumlin {

/// A function of this process by its name; nullptr if there is none.
template <class Function>
Function find_function(const char *name) {
  return reinterpret_cast<Function>(dlsym(RTLD_DEFAULT, name));
}

/// Ends the process with status 1; rank 0 prints "ERROR: drumlin VERSION: WHY". To be called on all ranks.
[[noreturn]] inline void stop(const std::string &why) {
  int rank = 0;
  int begun = 1;
  if (auto *initialized = find_function<int (*)(int *)>("MPI_Initialized")) initialized(&begun);
  if (auto *init = find_function<int (*)(int *, char ***)>("MPI_Init"); init && begun == 0)
    init(nullptr, nullptr);
  void *world = dlsym(RTLD_DEFAULT, "ompi_mpi_comm_world");
  if (auto *comm_rank = find_function<int (*)(void *, int *)>("MPI_Comm_rank"); comm_rank && world)
    comm_rank(world, &rank);
  if (rank == 0) std::printf("ERROR: drumlin %s: %s\n", DRUMLIN_VERSION, why.c_str());
  std::fflush(stdout);
  if (auto *finalize = find_function<int (*)()>("MPI_Finalize")) finalize();
  std::exit(1);
}

} // namespace drumlin
