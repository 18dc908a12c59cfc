#pragma once
// fix guard: stops a run whose numbers have gone bad. See plugin/doc/fix_guard.md.

#include "engine.h"

namespace LAMMPS_NS {

/// Ends the run on all ranks, in one line, when a position, velocity or force of the group is no longer
/// finite.
class FixGuard : public Fix {
public:
  FixGuard(LAMMPS *, int, char **);

  int setmask() override;
  void setup(int) override;
  void end_of_step() override;

private:
  bool watch_ = true; // off: the fix is there and costs nothing
};

} // namespace LAMMPS_NS
