#pragma once
// fix clump: a group of balls that moves as one rigid body. See plugin/doc/fix_clump.md.

#include "contact/deck_check.h"
#include "engine.h"

#include <array>
#include <vector>

namespace LAMMPS_NS {

/// Distributes the sum of the forces on the balls over them in proportion to their masses, so that all have
/// one acceleration. Contacts of its balls use the mass of the body. If fix drum/travel lets the body roll,
/// their torque about the axle is kept in the torques on the balls.
class FixClump : public Fix {
public:
  FixClump(LAMMPS *, int, char **);

  int setmask() override;
  void init() override;
  void setup(int) override;
  /// Distributes the forces. A second call in the same step changes nothing. Collective.
  void post_force(int) override;
  /// 0: mass, kg; 1-3: force on the body, N. Collective.
  double compute_vector(int) override;
  /// "force": the force on the body that its balls on this rank contribute, N, three numbers.
  void *extract(const char *name, int &dimensions) override;

  /// Mass of the body, kg, at the last time that forces were distributed; valid from init() on.
  double mass() const { return mass_; }

private:
  int common_balls(const Fix &other) const;
  void refuse_unequal_velocities() const;

  const class FixDrumTravel *roller_ = nullptr; // which rolls the body, since the initialization of the run
  double mass_ = 0.0;
  std::array<double, 3> force_{}; // on the balls of this rank, before it is distributed, N
  drumlin::DeckCheck deck_check_;
  bool echoed_ = false;
};

/// All fixes clump of one engine instance. A contact law or fix asks here for the mass with which a ball
/// moves: that of its clump.
class Clumps {
public:
  /// In the initialization of each run.
  void find(Modify &modify) {
    all_.clear();
    for (const Fix *fix : drumlin::engine::fixes(&modify))
      if (const auto *clump = dynamic_cast<const FixClump *>(fix)) all_.push_back(clump);
  }
  bool empty() const { return all_.empty(); }
  const std::vector<const FixClump *> &all() const { return all_; }
  /// Mass (kg) of ball i (owned or ghost) in its contacts: the mass of its clump if it belongs to one, else
  /// `own`.
  double mass_of(const Atom &atom, int i, double own) const {
    for (const FixClump *clump : all_)
      if (atom.mask[i] & clump->groupbit) return clump->mass();
    return own;
  }

private:
  std::vector<const FixClump *> all_;
};

} // namespace LAMMPS_NS
