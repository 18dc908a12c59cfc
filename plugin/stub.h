#pragma once
// What the two libraries that an engine loads first have in common. They link neither engine nor MPI, and reach both by name.

#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <string>

namespace drumlin {

/// A function of the process by its name; nullptr if there is none.
template <class Function>
Function find_function(const char *name) {
  return reinterpret_cast<Function>(dlsym(RTLD_DEFAULT, name));
}

/// Ends the run on every rank: each calls this, rank 0 speaks.
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
