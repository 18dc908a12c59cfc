#pragma once
// What the contacts of pair_style gran/hooke/transition remember, over the command write_restart.

#include "engine.h"

#include "fix_neigh_history.h"

namespace LAMMPS_NS {

/// The engine's history of contacts, but for one thing. At the end of a run it hands what contacts remember from the neighbour list to the
/// balls, and when a restart file is written it does so again. In a run (`restart`) this is needed; the command `write_restart` has by
/// then moved balls and ghosts on, so that contacts across ranks would be kept under the IDs of other balls.
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
