#pragma once
// fix clump: a group of balls that moves as one rigid body. See plugin/doc/fix_clump.md.

#include "contact/deck_check.h"
#include "engine.h"
#include "physics/bodies/tilting_body.h"

#include <array>
#include <optional>
#include <vector>

namespace drumlin {
class Arguments;
}

namespace LAMMPS_NS {

/// Distributes the sum of the forces on the balls over them in proportion to their masses, so that all have
/// one acceleration. A body that may tilt also takes the moment of these forces about its centre of mass; of
/// a body that fix drum/travel lets roll their torque about the axle is kept in the torques on the balls.
/// Contacts of its balls use the mass of the body.
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
  /// Mass that a contact of a ball of this type moves: that of the body, or its share by keyword `links`.
  double mass_in_contact(int type) const { return mass_per_link(type, mass_); }
  /// The same of a bond; `own`, the mass of the ball, without this keyword.
  double mass_in_bond(int type, double own) const { return mass_per_link(type, own); }

  /// Directions of a body that may tilt; none: it translates alone.
  const std::optional<drumlin::physics::TiltAxes> &tilts() const { return axes_; }
  /// Sums over the balls of a body that may tilt, at present. Collective.
  drumlin::physics::AxleSums axle_sums() const;
  /// Place of a ball of this rank without the jumps at periodic boundaries, m.
  std::array<double, 3> place_of(int i) const;

private:
  double mass_per_link(int type, double otherwise) const {
    const double links = links_[static_cast<std::size_t>(type)];
    return links > 0.0 ? mass_ / links : otherwise;
  }
  void parse(drumlin::Arguments &in);
  int common_balls(const Fix &other) const;
  void refuse_unequal_velocities() const;
  void refuse_other_shape() const;
  void refuse_torques() const;
  void refuse_large_tilt(const drumlin::physics::AxleSums &sums) const;
  void distribute(const drumlin::physics::AxleSums &sums) const;

  std::optional<drumlin::physics::TiltAxes> axes_;
  std::vector<double> links_; // of each type: in how many contacts or bonds the body is held; 0: not given
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
      if (atom.mask[i] & clump->groupbit) return clump->mass_in_contact(atom.type[i]);
    return own;
  }
  /// The same in a bond.
  double mass_in_bond(const Atom &atom, int i, double own) const {
    for (const FixClump *clump : all_)
      if (atom.mask[i] & clump->groupbit) return clump->mass_in_bond(atom.type[i], own);
    return own;
  }
  /// The clump of a group that may tilt; nullptr: there is none.
  const FixClump *tilting(int groupbit) const {
    for (const FixClump *clump : all_)
      if (clump->groupbit == groupbit && clump->tilts()) return clump;
    return nullptr;
  }

private:
  std::vector<const FixClump *> all_;
};

} // namespace LAMMPS_NS
