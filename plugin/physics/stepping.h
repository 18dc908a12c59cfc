#pragma once
// Second-order stepping: what a velocity-Verlet step does with the normal contact law.
//
// The engines' stepping is  v+ = v + dt/2 a(t),  x(t+dt) = x(t) + dt v+,  forces,  v(t+dt) = v+ + dt/2
// a(t+dt). Stock force laws put the half-step velocity v+ into the dashpot, and act on the whole step in
// which a contact is made: both are errors of first order. Here the dashpot sees v(t+dt), solved for
// implicitly, and the step of a make carries the impulse of its part in contact. All that is needed is known
// without history: the overlap rate at v+ and at v(t).

#include "physics/contact_law.h"

namespace drumlin::physics {

/// What the force of one contact sees in a step.
struct StepMotion {
  double overlap;     ///< d(t+dt), m
  double rate_half;   ///< d' with the half-step velocities v+, m/s
  double rate_before; ///< d' with the velocities at t, along the normal of t+dt, m/s
  double dt;          ///< s
};

/// Force at t+dt, and what of it the closing half kick gets.
struct StepForce {
  double force;       ///< N, physical, at t+dt
  double kick_weight; ///< factor on `force` in the closing half kick; the next opening half kick gets `force`
                      ///< itself
};

/// Second-order force of a contact with d(t+dt) > 0.
///
/// With v_pred = v+ + (v+ - v(t)), the velocity that unchanged forces would give,
///   v(t+dt) = v_pred + dt/2 (F - F_old) / m   hence   F = (k d + c d'_pred + s F_old) / (1 + s),   s = c_sum
///   dt / 2,
/// F_old = F(t) being the law at the overlap d - dt d'+ and the rate at t. For one contact this is the
/// implicit solution; with several, c_sum takes the dashpots of all contacts of both balls as if they pushed
/// together, which keeps heavy damping stable in a packing and changes F by O(dt^2) only.
///
/// A make within the step, theta = d / (dt d'+) of it in contact: F_old = 0, the closing half kick gets 2
/// theta F, so that the step carries the impulse theta dt F and v(t+dt) is physical.
///
/// \param damping_over_mass sum over both balls of (sum of c of the ball's contacts) / (its mass), 1/s; a
/// fixed ball gives 0
[[nodiscard]] inline StepForce second_order_force(Transition transition, double k, double c,
                                                  const StepMotion &motion, double damping_over_mass) {
  const double s = 0.5 * motion.dt * damping_over_mass;
  const double rate_predicted = 2.0 * motion.rate_half - motion.rate_before;
  const double before = motion.overlap - motion.dt * motion.rate_half; // overlap at t
  if (before <= 0.0) {
    const double theta = motion.overlap / (motion.overlap - before);
    const double force = (k * motion.overlap + c * rate_predicted) / (1.0 + 2.0 * theta * s);
    return {transition == Transition::B && force < 0.0 ? 0.0 : force, 2.0 * theta};
  }
  const double old = normal_force(transition, k, c, before, motion.rate_before);
  const double force = (k * motion.overlap + c * rate_predicted + s * old) / (1.0 + s);
  return {transition == Transition::B && force < 0.0 ? 0.0 : force, 1.0};
}

/// Tensile force under A in the step whose end finds the contact broken: it acted for the share of the step
/// before d = 0, and the opening half kick has given half a step of it already. Zero under B, which breaks
/// without a jump, and if there was no contact at the begin of the step. \param motion with motion.overlap <=
/// 0 \return the force at the break and its (usually negative) weight in the closing half kick; the next
/// opening kick gets 0
[[nodiscard]] inline StepForce second_order_break(Transition transition, double k, double c,
                                                  const StepMotion &motion) {
  const double before = motion.overlap - motion.dt * motion.rate_half;
  if (transition == Transition::B || before <= 0.0) return {0.0, 0.0};
  const double share = before / (before - motion.overlap);
  return {normal_force(transition, k, c, before, motion.rate_before), 2.0 * share - 1.0};
}

} // namespace drumlin::physics
