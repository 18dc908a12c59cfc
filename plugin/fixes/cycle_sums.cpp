#include "fixes/cycle_sums.h"

#include <algorithm>
#include <cmath>

namespace drumlin {

void CycleSums::begin_next(const RollerState &now) {
  const CycleSums last = *this;
  *this = {};
  number = last.number + 1.0;
  work = last.work;
  contact_dissipated = last.contact_dissipated;
  bond_dissipated = last.bond_dissipated;
  tangential_work = last.tangential_work;
  settlement = last.steps > 0.0 ? last.sinking / last.steps : 0.0;
  a_min = a_max = now.drum.a;
  F_min = F_max = now.forces.contact;
}

void CycleSums::add_step(const RollerState &before, const RollerState &now, double dt, int steps_per_cycle) {
  const double half = 0.5 * dt;
  steps += 1.0;
  a_min = std::min(a_min, now.drum.a);
  a_max = std::max(a_max, now.drum.a);
  F_min = std::min(F_min, now.forces.contact);
  F_max = std::max(F_max, now.forces.contact);
  contact_steps += now.forces.in_contact ? 1.0 : 0.0;
  work += half * (before.forces.excitation_power + now.forces.excitation_power);
  contact_dissipated +=
      half * (before.forces.contact_dissipated + now.forces.contact_dissipated) + now.forces.contact_missed;
  bond_dissipated +=
      half * (before.forces.bond_dissipated + now.forces.bond_dissipated) + now.forces.bond_released;
  tangential_work +=
      half * (before.forces.tangential_power + now.forces.tangential_power) + now.forces.tangential_missed;
  sinking -= now.drum.x;

  constexpr double pi = 3.141592653589793;
  const double change = 2.0 / (steps_per_cycle * dt) * (now.drum.v - before.drum.v);
  const double middle = 2.0 * pi * (now.time / dt - 0.5) / steps_per_cycle; // phase in the middle of the step
  constexpr std::array<double, 3> orders{1.0, 2.0, 0.5};
  for (std::size_t n = 0; n < orders.size(); ++n) {
    harmonic[2 * n] += change * std::cos(orders[n] * middle);
    harmonic[2 * n + 1] += change * std::sin(orders[n] * middle);
  }
}

} // namespace drumlin
