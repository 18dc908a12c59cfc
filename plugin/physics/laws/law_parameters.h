#pragma once
/// The table of a contact law's parameters, from which both engines' adapters read decks, check values, write
/// restart files and name what is missing.

#include "physics/parameter_checks.h"

#include <string>

namespace drumlin::physics {

/// A number that a deck gives for a pair of types.
template <class Contact>
struct LawParameter {
  double Contact::*value;
  const char *name, *unit;
  Range range;
  const char *property;     ///< in LIGGGHTS; nullptr: it follows from what is given for the materials
  const char *word;         ///< in pair_coeff of LAMMPS
  bool of_friction = false; ///< it may be left out; in LAMMPS it stands behind the friction coefficient
};

/// A number that a deck may give for a material instead: for each type in LIGGGHTS, for both balls in LAMMPS.
struct MaterialParameter {
  const char *name, *unit;
  Range range;
  const char *property, *word;
};

/// Name and unit of a parameter, for error texts.
template <class Parameter>
[[nodiscard]] std::string meaning_of(const Parameter &p) {
  return p.unit[0] == '\0' ? p.name : std::string(p.name) + ", " + p.unit;
}

} // namespace drumlin::physics
