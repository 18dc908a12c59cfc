#pragma once
// The contact history of pair_style gran/hooke/transition, which stays correct when the command write_restart
// follows a run.

#include "engine.h"

#include "fix_neigh_history.h"

namespace LAMMPS_NS {

/// The engine's contact history with one change. At the end of a run the engine's fix copies the history from
/// the neighbour list to the balls, and again when a restart file is written. During a run (command
/// `restart`) the second copy is needed. The command `write_restart` after a run, however, has exchanged
/// balls and ghosts before: the neighbour list is outdated, and the history of contacts of balls on two ranks
/// would be stored with the IDs of other balls.
class FixNeighHistoryTransition : public FixNeighHistory {
public:
  using FixNeighHistory::FixNeighHistory;

  void write_restart(FILE *file) override {
    if (update->whichflag != 0) pre_exchange();
    const int no_bytes = 0;
    if (comm->me == 0) std::fwrite(&no_bytes, sizeof(int), 1, file);
  }

  static constexpr const char *style_name = "NEIGH_HISTORY/TRANSITION";
};

} // namespace LAMMPS_NS
