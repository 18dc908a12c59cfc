#pragma once
/// Rolling resistance: a spring of the rolling angle whose torque is limited, without a dashpot. It is the
/// elastic-plastic spring-dashpot model of Iwashita and Oda (1998, J. Eng. Mech. 124, 285-292) in the form
/// that LIGGGHTS calls epsd2: stiffness from the tangential stiffness of the contact, no viscous part.
///
/// Sign convention: the relative angular velocity is w = w_i - w_j, the spring torque T what its part across
/// the contact's normal has built up; the torque on ball i is -T, the one on ball j is T. SI units.

#include "physics/vec3.h"

#include <cmath>

namespace drumlin::physics {

/// Which part of the relative rotation the spring resists. rolling: the part across the normal. all: the
/// whole, torsion about the normal included.
enum class Resisted { rolling, all };

/// Parameters of the rolling resistance of one contact.
struct Rolling {
  double stiffness = 0.0; ///< kr, N m per radian, finite and > 0
  double arm = 0.0;       ///< limit of the torque over the normal force: mu_r R, m, finite and >= 0
  Resisted resisted = Resisted::rolling; ///< which part of the rotation
};

/// The rolling resistance of a contact: kr = kt R^2, as LIGGGHTS has it, and the limit mu_r R |Fn|.
/// \param tangential_stiffness kt, N/m, > 0 \param coefficient mu_r, >= 0 \param radius R, m, > 0
[[nodiscard]] inline Rolling rolling_of(double tangential_stiffness, double coefficient, double radius,
                                        Resisted resisted = Resisted::rolling) {
  return {tangential_stiffness * radius * radius, coefficient * radius, resisted};
}

/// The share of a rolling spring's torque that is kept when its stiffness kr changes between two steps, as it
/// does with a tangential stiffness that depends on the overlap. While the stiffness grows the torque is
/// kept; while it shrinks the angle of the spring is kept, and the torque becomes smaller. Either way the
/// energy in the spring, T^2 / (2 kr), does not grow. The spring of friction does the same, see
/// kept_spring().
/// \param before stiffness of the step before, or one in proportion to it; 0: there was none
[[nodiscard]] inline double kept_torque(double before, double now) {
  return before > now ? now / before : 1.0;
}

/// What one step of rolling resistance gives.
struct RollingStep {
  Vec3 torque;       ///< N m, on ball i, at the end of the step; ball j takes the opposite
  Vec3 spring;       ///< T after the step, N m, to be given to the next step
  double dissipated; ///< energy turned into heat during the step, J, >= 0
  double stored;     ///< energy in the spring after the step, J, |T|^2 / (2 kr)
  bool limited;      ///< the torque is at its limit
};

/// One step of rolling resistance: the spring takes up the rotation of the step, and its torque is limited.
///   before   T0 = P T of the step before;  P projects on the plane across the normal (not for Resisted::all)
///   trial    T* = T0 + kr P w dt
///   T = T*  if |T*| <= L,  else  T = L T*/|T*|,  with the limit L = mu_r R |Fn|
/// The work of the step, T . w dt, is T . (T* - T0)/kr, and with T* - T in the direction of T
///   T . w dt = T . (T* - T)/kr + (|T|^2 - |T0|^2)/(2 kr) + |T - T0|^2/(2 kr)
/// of which the first and the last are >= 0: whatever kr, L, w and dt, a step stores at most the work that is
/// done in it, so that the torque cannot create energy. This needs the projection of T0, not of w alone: a
/// torque that is kept while the normal turns gets a part along the normal, which w does not wind back and
/// which would spin the balls up without end.
/// \param normal_force Fn, N, of either sign: under transition A a contact in tension resists rolling, too
/// \param normal a unit vector of either sense
/// \param spin w_i - w_j, rad/s; against a wall at rest w_i
/// \param spring_before T of the step before, N m; zero for a new contact
/// \param dt s, >= 0; 0 evaluates the torque without moving the spring
/// \returns dissipated: T . (T* - T)/kr, heat of the limit, and what the projection removes from the spring's
/// energy
[[nodiscard]] inline RollingStep rolling_step(const Rolling &rolling, double normal_force, const Vec3 &normal,
                                              const Vec3 &spin, const Vec3 &spring_before, double dt) {
  const double kr = rolling.stiffness;
  const double limit = rolling.arm * std::fabs(normal_force);
  Vec3 trial = sum(spring_before, kr * dt, spin);
  double lost = 0.0;
  if (rolling.resisted == Resisted::rolling) {
    trial = sum(trial, -dot(trial, normal), normal);
    const double along = dot(spring_before, normal);
    lost = 0.5 * along * along / kr;
  }
  const double squared = dot(trial, trial);
  const bool limited = squared > limit * limit;
  const Vec3 spring = limited ? scaled(limit / std::sqrt(squared), trial) : trial;
  const double heat = dot(spring, sum(trial, -1.0, spring)) / kr;
  return {scaled(-1.0, spring), spring, heat + lost, 0.5 * dot(spring, spring) / kr, limited};
}

/// The torque on ball i of rolling_step() with a smaller normal force than it was computed with, N m; its
/// opposite is the spring. For a normal force that is known only when all forces of a step are.
[[nodiscard]] inline Vec3 limited_to(const Rolling &rolling, double normal_force, const Vec3 &torque) {
  const double limit = rolling.arm * std::fabs(normal_force);
  const double squared = dot(torque, torque);
  return squared > limit * limit ? scaled(limit / std::sqrt(squared), torque) : torque;
}

/// The torque on ball i in the closing half kick of the step in which a contact begins, N m, from that of the
/// end of the step: its limit is that of the normal force of this half kick. \param normal_force at the end
/// of the step, N
/// \param kick N, of the closing half kick
[[nodiscard]] inline Vec3 closing_torque(const Rolling &rolling, double normal_force, double kick,
                                         const Vec3 &torque) {
  const double of_step = rolling.arm * std::fabs(normal_force);
  constexpr double rounding = 1e-12;
  if (of_step > 0.0 && dot(torque, torque) >= (1.0 - rounding) * of_step * of_step)
    return scaled(std::fabs(kick / normal_force), torque);
  return limited_to(rolling, kick, torque);
}

} // namespace drumlin::physics
