// For an engine that the plugin is linked into. With the linker's option --wrap for the two functions below,
// calls of them in the engine come here.

#include "liggghts/registration.h"
#include "stub.h"

#include "signal_handling.h"

#define INPUT_FILE "_ZN9LAMMPS_NS5Input4fileEv"
#define POST_CREATE "_ZN9LAMMPS_NS6LAMMPS11post_createEv"

extern "C" {
void engine_input_file(void *input) __asm__("__real_" INPUT_FILE);
void engine_post_create(void *engine) __asm__("__real_" POST_CREATE);
void drumlin_input_file(void *input) __asm__("__wrap_" INPUT_FILE);
void drumlin_post_create(void *engine) __asm__("__wrap_" POST_CREATE);
}

namespace {
bool is_registered = false;
}

void drumlin_input_file(void *input) {
  drumlin_register(input);
  is_registered = true;
  engine_input_file(input);
  if (LAMMPS_NS::SignalHandler::request_quit) drumlin::stop("stopped by a signal before the end of the deck");
}

void drumlin_post_create(void *engine) {
  if (is_registered) drumlin_register_again(engine);
  engine_post_create(engine);
}
