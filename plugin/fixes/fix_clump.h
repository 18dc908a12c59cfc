#pragma once
// fix clump: a group of balls that translates as one rigid body. See plugin/doc/fix_clump.md.

#include "engine.h"

#include <vector>

namespace LAMMPS_NS {

/// Distributes the sum of the forces on the balls over them in proportion to their masses, so that all have
/// one acceleration. The contacts of the balls take the mass of the body.
class FixClump : public Fix {
public:
  FixClump(LAMMPS *, int, char **);
  ~FixClump() override;

  int setmask() override;
  void init() override;
  void setup(int) override;
  /// Distributes the forces. A second call in the same step changes nothing. Collective.
  void post_force(int) override;
  /// 0: mass, kg; 1-3: force on the body, N.
  double compute_vector(int) override;

  /// All fixes clump.
  static const std::vector<FixClump *> &all() { return list(); }
  /// Mass, kg, of ball i (owned or ghost) in its contacts: that of its body if it belongs to a clump, else
  /// `own`. Valid from init() on.
  static double mass_of(const Atom &atom, int i, double own) {
    for (const FixClump *clump : list())
      if (atom.mask[i] & clump->groupbit) return clump->mass_;
    return own;
  }

private:
  int common_balls(const Fix &other) const;
  static std::vector<FixClump *> &list();

  double mass_ = 0.0;
  std::array<double, 3> force_{};
  bool echoed_ = false;
};

} // namespace LAMMPS_NS
