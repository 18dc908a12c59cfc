// The engine's main program with the plugin, for an engine that is one program and exports its symbols
// (-rdynamic). Calls within one program do not use the dynamic linker, so that the preloaded library cannot
// replace a function of the engine; it runs this instead of the engine's main().

#include "liggghts/registration.h"
#include "stub.h"

#include "input.h"
#include "lammps.h"
#include "signal_handling.h"

DRUMLIN_SHOWN int drumlin_main(int argc, char **argv) {
  MPI_Init(&argc, &argv);
  auto *engine = new LAMMPS_NS::LAMMPS(argc, argv, MPI_COMM_WORLD);
  drumlin_register(engine->input);
  engine->input->file();
  if (LAMMPS_NS::SignalHandler::request_quit) drumlin::stop("stopped by a signal before the end of the deck");
  delete engine;
  MPI_Finalize();
  return 0;
}
