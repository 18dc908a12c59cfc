#pragma once
// Kinematics of a pair of balls at the end of a step, when position and velocity belong to the same instant.

#include "engine.h"
#include "physics/laws/friction_law.h"

#include <algorithm>
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

/// Tangential contact force, N, on ball i of two balls in contact. The dashpot's part is computed with the
/// velocities at the time of the call: see physics::friction_after_step().
/// \param spring m, three components, with the sign for ball i; nullptr: friction without history
inline std::array<double, 3> friction_force(const LAMMPS_NS::Atom &atom, int i, int j, const PairMotion &m,
                                            const physics::Friction &friction, double normal_force,
                                            const double *spring, double dt) {
  const physics::Vec3 slip = tangential_velocity(atom, i, j, m);
  if (spring == nullptr)
    return physics::friction_step_without_history(friction, normal_force, slip, 0.0).force;
  return physics::friction_after_step(friction, normal_force, m.normal, slip,
                                      {spring[0], spring[1], spring[2]}, dt);
}

/// Packs the velocities of owned balls, and unpacks them into the ghosts, which have the half-step velocity
/// after the forces were computed.
/// \param of_ghosts m/s, of the ghosts relative to the balls: see GhostFix::velocity_of_ghosts()
inline void pack_velocities(const LAMMPS_NS::Atom &atom, int n, const int *list, double *buf,
                            const std::array<double, 3> &of_ghosts) {
  for (int a = 0; a < n; ++a)
    for (std::size_t b = 0; b < 3; ++b)
      *buf++ = atom.v[list[a]][b] + of_ghosts[b];
}

inline void unpack_velocities(const LAMMPS_NS::Atom &atom, int n, int first, const double *buf) {
  int m = 0;
  for (int i = first; i < first + n; ++i)
    for (int b = 0; b < 3; ++b)
      atom.v[i][b] = buf[m++];
}

/// The same with the angular velocities: six numbers per ball.
inline void pack_motion(const LAMMPS_NS::Atom &atom, int n, const int *list, double *buf,
                        const std::array<double, 3> &of_ghosts) {
  pack_velocities(atom, n, list, buf, of_ghosts);
  buf += 3 * n;
  for (int a = 0; a < n; ++a)
    buf = std::copy_n(atom.omega[list[a]], 3, buf);
}

inline void unpack_motion(const LAMMPS_NS::Atom &atom, int n, int first, const double *buf) {
  unpack_velocities(atom, n, first, buf);
  buf += 3 * n;
  for (int i = first; i < first + n; ++i, buf += 3)
    std::copy_n(buf, 3, atom.omega[i]);
}

} // namespace drumlin
