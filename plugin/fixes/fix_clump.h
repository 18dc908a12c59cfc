#pragma once
// fix clump: a group of balls that translates as one rigid body. See plugin/doc/fix_clump.md.

#include "engine.h"

#include <vector>

namespace LAMMPS_NS {

/// Shares the force on the body by mass, so that all its balls get one acceleration, and gives its mass to their contacts.
class FixClump : public Fix {
public:
  FixClump(LAMMPS *, int, char **);
  ~FixClump() override;

  int setmask() override;
  void init() override;
  void setup(int) override;
  /// A projection: what it has shared once it leaves as it is. Collective.
  void post_force(int) override;
  /// 0: mass, kg; 1-3: force on the body, N, before it is shared.
  double compute_vector(int) override;

  /// The clumps of this engine instance.
  static const std::vector<FixClump *> &all() { return list(); }
  /// Mass (kg) that contacts of ball i (owned or ghost) feel: its body's if it belongs to one, else `own`. Valid from init() on.
  static double mass_of(const Atom &atom, int i, double own) {
    for (const FixClump *clump : list())
      if (atom.mask[i] & clump->groupbit) return clump->mass_;
    return own;
  }

private:
  int shared_with(const Fix &other) const;
  static std::vector<FixClump *> &list();

  double mass_ = 0.0;
  std::array<double, 3> force_{};
  bool echoed_ = false;
};

} // namespace LAMMPS_NS
