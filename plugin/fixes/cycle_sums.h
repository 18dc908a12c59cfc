#pragma once
// Extremes, harmonics and energies over the steps of a cycle, for cycles.csv of fix roller/history.

#include "fixes/roller_state.h"

#include <array>

namespace drumlin {

/// Sums over the steps of the present cycle; energies and heat are sums since the start of the first cycle.
/// All members are of type double, and a restart file stores them in this order.
struct CycleSums {
  double number = 0.0;              ///< of the cycle
  double steps = 0.0;               ///< steps of the cycle so far
  double a_min = 0.0, a_max = 0.0;  ///< m/s2, of the drum
  double F_min = 0.0, F_max = 0.0;  ///< N, contact force
  double contact_steps = 0.0;       ///< steps in which the drum is in contact
  std::array<double, 6> harmonic{}; ///< m/s2: a1 cos, a1 sin, a2 cos, a2 sin, a(1/2) cos, a(1/2) sin
  double work = 0.0;                ///< J, of the excitation on the drum
  double contact_dissipated = 0.0;  ///< J
  double bond_dissipated = 0.0;     ///< J
  double tangential_work = 0.0;     ///< J, taken from the balls by friction and rolling
  double sinking = 0.0;             ///< m, sum of -x_drum, downward positive, over the steps of the cycle
  double settlement = 0.0;          ///< m, of the drum: mean of -x_drum over the last whole cycle

  /// Begins the next cycle: extremes from the present values, harmonics 0; energies continue.
  void begin_next(const RollerState &now);

  /// Adds a step. Powers are integrated by the trapezoidal rule over the step. The harmonics of the
  /// acceleration are computed from the changes of the drum's velocity from step to step: these are integrals
  /// of the acceleration and include jumps of the contact force within a step.
  /// \param before the state one step earlier \param dt s \param steps_per_cycle >= 1
  void add_step(const RollerState &before, const RollerState &now, double dt, int steps_per_cycle);
};

} // namespace drumlin
