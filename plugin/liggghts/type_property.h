#pragma once
// Numbers that a deck gives for each type, or each pair of types, by `fix property/global`: read and checked.

#include "engine.h"

#include <limits>
#include <string>

namespace LAMMPS_NS {
class FixPropertyGlobal;
}

namespace drumlin {

/// A property over pairs of types. The errors that end the run name command, property, types, value and what
/// is allowed.
class TypePairProperty : LAMMPS_NS::Pointers {
public:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// \param command for error texts, e.g. "model hooke/transition"
  TypePairProperty(LAMMPS *engine, std::string command, const char *name, int ntypes);

  bool given() const { return fix_ != nullptr; }
  /// Its value for types i and j, 1 to ntypes: finite, and >= 0 or > 0.
  double operator()(int i, int j, bool zero_allowed, double most = infinity);
  /// Ends the run if it is not given. \param meaning with unit, for the error text
  void require(const char *meaning) const;

private:
  std::string command_;
  const char *name_;
  int ntypes_;
  LAMMPS_NS::FixPropertyGlobal *fix_;
};

/// A property of each type, which the deck must give.
class TypeProperty : LAMMPS_NS::Pointers {
public:
  TypeProperty(LAMMPS *engine, std::string command, const char *name, const char *meaning, int ntypes);

  /// Its value for type i, 1 to ntypes, which has to be > above and <= most.
  double operator()(int i, double above, double most);

private:
  std::string command_;
  const char *name_;
  LAMMPS_NS::FixPropertyGlobal *fix_;
};

} // namespace drumlin
