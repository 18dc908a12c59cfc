#pragma once
// Commands that the plugin adds to decks. Each has a page of its name in plugin/doc.

#include "engine.h"

namespace drumlin {

/// drumlin/variables NAME ...: ends the run if the command line gives a variable that is none of these, or a value that the engine's
/// parser would not take as it is.
void variables_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/check NAME VALUE rule ...: judges a deck variable before anything is built.
void check_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/outputs [folder F] [continue STEP TIME] files NAME ... [numbered FOLDER PREFIX SUFFIX ...]: makes room for the files that a run
/// writes; those of an earlier run come back if the new one fails in its first steps.
void outputs_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/take FILE DECKS ALLOWED fixed NAME ... free NAME ... if_noted NAME ...: sets variables to the values that a bed was made with, and ends
/// the run if one of them was given another value.
void take_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/record FILE name value ...: writes what a run was made with, for the report.
void record_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/run STEP [every N] [limit S] [restart FILE [name value ...]]: runs to a step in pieces, with progress and a limit of wall time.
void run_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/write_restart FILE [name value ...]: a restart file, whole or not at all, that says what it was made with.
void write_restart_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/write_data FILE [name value ...]: the same for a data file.
void write_data_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/settle [ratio r] [every n] [limit n]: runs until static equilibrium.
void settle_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

} // namespace drumlin
