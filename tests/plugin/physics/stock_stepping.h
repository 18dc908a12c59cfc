#pragma once
/// The engines' stock stepping of balls on a line, as in fix nve/sphere: half kick, drift, forces from the
/// new positions and the half-step velocities, half kick.

#include <array>
#include <cstddef>

namespace stepping {

template <std::size_t N>
struct Balls {
  std::array<double, N> mass; ///< infinite: moves only with the velocity that it has
  std::array<double, N> x;
  std::array<double, N> v;
  std::array<double, N> force{}; ///< of the last step; zero before the first
};

/// One step of dt to time t_end. forces(t_end, x, v) returns the force on every ball.
template <std::size_t N, typename Forces>
void stock_step(Balls<N> &balls, double t_end, double dt, const Forces &forces) {
  for (std::size_t i = 0; i < N; ++i) {
    balls.v[i] += 0.5 * dt * balls.force[i] / balls.mass[i];
    balls.x[i] += dt * balls.v[i];
  }
  balls.force = forces(t_end, balls.x, balls.v);
  for (std::size_t i = 0; i < N; ++i)
    balls.v[i] += 0.5 * dt * balls.force[i] / balls.mass[i];
}

} // namespace stepping
