#pragma once
// Kinematics of a pair of balls at the end of a step, when position and velocity belong to the same instant.

#include "engine.h"
#include "physics/friction_law.h"

#include <cmath>

namespace drumlin {

/// Overlap, its rate, and the unit normal from ball j to ball i.
struct PairMotion {
  double overlap; ///< m
  double rate;    ///< m/s, positive when the overlap grows
  std::array<double, 3> normal;
};

inline PairMotion pair_motion(const LAMMPS_NS::Atom &atom, int i, int j) {
  const double *xi = atom.x[i];
  const double *xj = atom.x[j];
  const double *vi = atom.v[i];
  const double *vj = atom.v[j];
  PairMotion m{};
  std::array<double, 3> d{xi[0] - xj[0], xi[1] - xj[1], xi[2] - xj[2]};
  const double distance = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  for (std::size_t a = 0; a < 3; ++a) {
    m.normal[a] = d[a] / distance;
    m.rate -= (vi[a] - vj[a]) * m.normal[a];
  }
  m.overlap = atom.radius[i] + atom.radius[j] - distance;
  return m;
}

/// Velocity of ball i's surface relative to ball j's at the contact, its tangential part, m/s.
inline std::array<double, 3> tangential_velocity(const LAMMPS_NS::Atom &atom, int i, int j,
                                                 const PairMotion &m) {
  const double arm_i = atom.radius[i] - 0.5 * m.overlap;
  const double arm_j = atom.radius[j] - 0.5 * m.overlap;
  physics::Vec3 relative{}, turning{};
  for (std::size_t a = 0; a < 3; ++a) {
    relative[a] = atom.v[i][a] - atom.v[j][a];
    turning[a] = arm_i * atom.omega[i][a] + arm_j * atom.omega[j][a];
  }
  return physics::slip_velocity(relative, m.normal, turning);
}

/// Tangential force, N, on ball i of a pair that touches, its dashpot at the velocities of now.
///
/// Behind a step in which the contact slid its spring is as long as friction allows, give or take rounding: whether it slides is
/// asked of the step of dt, s, to come.
/// \param spring m, three components, as ball i feels it; nullptr: friction without history
inline std::array<double, 3> friction_force(const LAMMPS_NS::Atom &atom, int i, int j, const PairMotion &m,
                                            const physics::Friction &friction, double normal_force,
                                            const double *spring, double dt) {
  const physics::Vec3 slip = tangential_velocity(atom, i, j, m);
  if (spring == nullptr)
    return physics::friction_step_without_history(friction, normal_force, slip, 0.0).force;
  const auto after = [&](double time) {
    return physics::friction_step(friction, normal_force, m.normal, slip, {spring[0], spring[1], spring[2]},
                                  time);
  };
  const physics::FrictionStep next = after(dt);
  return next.sliding ? next.force : after(0.0).force;
}

/// Packs owned velocities for the ghosts, and takes them there: the pair style leaves ghosts at the half-step
/// velocity.
inline void pack_velocities(const LAMMPS_NS::Atom &atom, int n, const int *list, double *buf) {
  int m = 0;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < 3; ++b)
      buf[m++] = atom.v[list[a]][b];
}

inline void unpack_velocities(const LAMMPS_NS::Atom &atom, int n, int first, const double *buf) {
  int m = 0;
  for (int i = first; i < first + n; ++i)
    for (int b = 0; b < 3; ++b)
      atom.v[i][b] = buf[m++];
}

} // namespace drumlin
