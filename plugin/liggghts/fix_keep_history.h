#pragma once
// Keeps contact history through commands that create balls between two runs.

#include "engine.h"

#include <string>

namespace LAMMPS_NS {

/// Copies the contact history from the neighbour list to the balls at the end of each run, as the engine does
/// before it writes a restart file. Without this fix the engine does so at the set-up of the next run only.
/// Balls created in between (create_atoms) have taken the indices of ghosts by then, and a contact of balls
/// on two ranks loses its history on one of them. (LAMMPS copies it at the end of a run, too.)
class FixKeepHistory : public Fix {
public:
  using Fix::Fix;

  /// Adds the fix if it does not exist yet; for the pair style.
  static void provide(LAMMPS *lmp) {
    if (drumlin::engine::find_fix(lmp->modify, helper_id) != nullptr) return;
    std::string words[] = {helper_id, "all", style_name};
    char *arg[] = {words[0].data(), words[1].data(), words[2].data()};
    lmp->modify->add_fix(3, arg);
  }

  int setmask() override { return FixConst::POST_RUN; }
  void post_run() override {
    for (Fix *fix : drumlin::engine::fixes(modify))
      if (std::string(fix->style) == "contacthistory") fix->setup_pre_exchange();
  }

  static constexpr const char *style_name = "drumlin/keep_history";

private:
  static constexpr const char *helper_id = "drumlin_keep_history";
};

} // namespace LAMMPS_NS
