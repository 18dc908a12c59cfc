#pragma once
// Numbers that a deck gives for each type, or each pair of types, by `fix property/global`: read and checked.

#include "engine.h"
#include "physics/parameter_checks.h"

#include <string>

namespace LAMMPS_NS {
class FixPropertyGlobal;
}

namespace drumlin {

/// A property over types or pairs of types. The errors that end the run name command, property, types, value
/// and what is allowed.
class TypeProperty : LAMMPS_NS::Pointers {
public:
  enum class Of { type, pair };

  /// \param command for error texts, e.g. "model hooke/transition"
  TypeProperty(LAMMPS *engine, std::string command, const char *name, int ntypes, Of of = Of::pair);

  bool given() const { return fix_ != nullptr; }
  /// Its value for types i and j, 1 to ntypes, or for type i, which has to be in the range.
  double operator()(int i, int j, const physics::Range &range);
  double operator()(int i, const physics::Range &range);
  /// Ends the run if it is not given. \param meaning with unit, for the error text
  void require(const std::string &meaning) const;

private:
  double checked(double value, const std::string &types, const physics::Range &range);

  std::string command_;
  const char *name_;
  int ntypes_;
  Of of_;
  LAMMPS_NS::FixPropertyGlobal *fix_;
};

} // namespace drumlin
