#pragma once
// Commands that the plugin adds to decks: plugin/doc/drumlin_check.md, drumlin_record.md, drumlin_run.md,
// drumlin_settle.md, drumlin_write_restart.md.

#include "engine.h"

namespace drumlin {

/// drumlin/check NAME VALUE rule ...: judges a deck variable before anything is built.
void check_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/record FILE name value ...: writes what a run was made with, for the report.
void record_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/run STEP every N [limit S restart FILE [name value ...]]: runs to a step in pieces, with progress and a limit of wall time.
void run_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/write_restart FILE [name value ...]: a restart file, whole or not at all, that says what it was made with.
void write_restart_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

/// drumlin/settle [ratio r] [every n] [limit n]: runs until static equilibrium.
void settle_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg);

} // namespace drumlin
