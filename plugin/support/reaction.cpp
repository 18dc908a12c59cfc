#include "engine.h"

namespace {

// The sums are private members of the engine's fixes. C++ allows an explicit instantiation to name a private
// member as a template argument; the friend function of the instance gives access to it.
template <auto Member>
struct FreezeAccess {
  friend auto &reaction_of(LAMMPS_NS::FixFreeze &fix) { return fix.*Member; }
};
auto &reaction_of(LAMMPS_NS::FixFreeze &fix);
template struct FreezeAccess<&LAMMPS_NS::FixFreeze::foriginal>;

template <auto Member>
struct SetForceAccess {
  friend auto &reaction_of(LAMMPS_NS::FixSetForce &fix) { return fix.*Member; }
};
auto &reaction_of(LAMMPS_NS::FixSetForce &fix);
template struct SetForceAccess<&LAMMPS_NS::FixSetForce::foriginal>;

} // namespace

double *drumlin::engine::reaction(LAMMPS_NS::Fix *fix) {
  const std::string style = fix->style;
  if (style == "freeze") return reaction_of(*static_cast<LAMMPS_NS::FixFreeze *>(fix));
  if (style == "setforce") return reaction_of(*static_cast<LAMMPS_NS::FixSetForce *>(fix));
  return nullptr;
}
