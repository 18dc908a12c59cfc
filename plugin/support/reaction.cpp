#include "engine.h"

namespace {

// What the engine's constraints have summed is not public. An explicit instantiation may name a private member; its friend hands
// it out.
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
