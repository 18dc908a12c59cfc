#pragma once
// What plugin.cpp offers to the three ways into an engine: the preloaded library (preload.cpp), which finds these functions by their names,
// an engine that exports its symbols (main_program.cpp), and one that the plugin is linked into (static_program.cpp).

#define DRUMLIN_SHOWN extern "C" __attribute__((visibility("default")))

/// Adds models, fixes and commands to the engine of this LAMMPS_NS::Input. Another engine than the one that the plugin is built for ends
/// the run with one line.
DRUMLIN_SHOWN void drumlin_register(void *input);

/// Adds fixes again to a LAMMPS_NS::LAMMPS whose lists the command `clear` has made anew.
DRUMLIN_SHOWN void drumlin_register_again(void *engine);
