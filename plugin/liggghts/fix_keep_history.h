#pragma once
// What a contact remembers, over commands that make balls between two runs.

#include "engine.h"

#include <string>

namespace LAMMPS_NS {

/// Hands the histories of contacts from the neighbour list to the balls at the end of each run, as the engine does before it writes a
/// restart file. The engine itself waits until the next run sets up; balls made in between (create_atoms) then have the places of
/// ghosts, and a contact across ranks loses its history on one of them. (LAMMPS does the same at the end of a run.)
class FixKeepHistory : public Fix {
public:
  using Fix::Fix;

  /// Made by the pair style, once.
  static void provide(LAMMPS *lmp) {
    if (drumlin::engine::find_fix(lmp->modify, helper_id) != nullptr) return;
    std::string words[] = {helper_id, "all", style_name};
    char *arg[] = {words[0].data(), words[1].data(), words[2].data()};
    lmp->modify->add_fix(3, arg);
  }

  int setmask() override { return FixConst::POST_RUN; }
  void post_run() override {
    for (int n = 0; n < modify->nfix; ++n)
      if (std::string(modify->fix[n]->style) == "contacthistory") modify->fix[n]->setup_pre_exchange();
  }

  static constexpr const char *style_name = "drumlin/keep_history";

private:
  static constexpr const char *helper_id = "drumlin_keep_history";
};

} // namespace LAMMPS_NS
