#pragma once
// What the fixes may know of the pair style: its law for a pair of types, and the mass that a contact feels.
// Each engine's adapter implements it; a fix that finds no source stops with an error, since the law it would
// report is not ours.

#include "engine.h"
#include "physics/contact_law.h"
#include "physics/friction_law.h"
#include "physics/stepping.h"

#include <cmath>

namespace drumlin {

/// Which kind of friction acts beside the normal law. history: with a tangential spring; what limits it is Friction's cap.
enum class FrictionModel { none, no_history, history };

/// The contact law in force, as the pair style applies it.
class ContactSource {
public:
  /// Law of a pair of types (1..ntypes).
  virtual const physics::LinearContact &law(int itype, int jtype) const = 0;
  /// Mass (kg) of ball i (local or ghost index) as its contacts feel it: infinite if it is frozen, the body's if it belongs to a
  /// rigid body.
  virtual double mass(int i) const = 0;
  /// Effective mass (kg) of the contact of balls i and j, of which one at most is frozen.
  double effective_mass(int i, int j) const {
    const double mi = mass(i);
    const double mj = mass(j);
    return std::isinf(mi) ? mj : std::isinf(mj) ? mi : physics::effective_mass(mi, mj);
  }
  /// The dashpots of ball i (local) if it touches all walls at once; their sum is infinite if there are meshes, of which it may
  /// touch any number of triangles.
  virtual physics::Dashpots wall_dashpots(int i) const = 0;
  virtual FrictionModel friction_model() const = 0;
  /// Friction of a pair of types whose normal damping coefficient is c (N s/m). Not for FrictionModel::none.
  virtual physics::Friction friction(int itype, int jtype, double c) const = 0;
  /// Neighbour list of the pairs of balls that have this law, each pair once (twice across ranks with newton off).
  virtual const LAMMPS_NS::NeighList *contact_list() const = 0;
  /// Tangential spring (m, three components) of ball i and its jj-th neighbour in that list, as ball i feels it; valid
  /// until the list is built anew. For FrictionModel::history only.
  virtual const double *tangential_spring(int i, int jj) const = 0;

protected:
  ~ContactSource() = default;
};

/// Source of the pair style of this engine instance, or of the part of a hybrid pair style that is hooke/transition; nullptr if there is
/// none, or more than one.
/// Valid from the initialization of a run on.
const ContactSource *contact_source(engine::LAMMPS *lmp);

} // namespace drumlin
