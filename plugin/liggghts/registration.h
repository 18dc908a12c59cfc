#pragma once
// How the plugin gets into LIGGGHTS. These functions are called by the preloaded library (preload.cpp), which
// finds them by their names, by the main program for an engine that exports its symbols (main_program.cpp),
// and in an engine that the plugin is linked into (static_program.cpp).

#define DRUMLIN_SHOWN extern "C" __attribute__((visibility("default")))

/// Adds contact models, fixes and commands to the engine.
/// \param input its LAMMPS_NS::Input. If the engine has another version than the plugin is built for, the run
/// ends with one line.
DRUMLIN_SHOWN void drumlin_register(void *input);

/// Adds the fixes again, after the command `clear` has made new lists of styles.
/// \param engine its LAMMPS_NS::LAMMPS
DRUMLIN_SHOWN void drumlin_register_again(void *engine);

namespace drumlin {

/// Adds the contact models to the lists of the process; see contact_models.cpp.
void add_contact_models();

/// Adds those of a law; see law_models.h.
template <class Contact>
void add_law();

} // namespace drumlin
