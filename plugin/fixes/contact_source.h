#pragma once
// What the fixes may know of the pair style: its law for a pair of types, and the mass that a contact feels.
// Each engine's adapter implements it; a fix that finds no source stops with an error, since the law it would
// report is not ours.

#include "engine.h"
#include "physics/contact_law.h"

namespace drumlin {

/// The normal contact law in force, as the pair style applies it.
class ContactSource {
public:
  virtual ~ContactSource() = default;
  /// Law of a pair of types (1..ntypes).
  virtual const physics::LinearContact &law(int itype, int jtype) const = 0;
  /// Effective mass (kg) of the contact of balls i and j (local or ghost indices): a frozen partner counts as
  /// fixed, a ball of a rigid body with the body's mass.
  virtual double effective_mass(int i, int j) const = 0;
};

/// Source of the pair style of this engine instance, or nullptr if the pair style is not hooke/transition.
/// Valid from the initialization of a run on.
const ContactSource *contact_source(engine::LAMMPS *lmp);

} // namespace drumlin
