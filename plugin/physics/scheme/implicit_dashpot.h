#pragma once
// The second-order scheme for the dashpot of a link (a contact or a bond) in a step of velocity Verlet.
//
// The engines' step is  v+ = v + dt/2 a(t),  x(t+dt) = x(t) + dt v+,  forces,  v(t+dt) = v+ + dt/2 a(t+dt).
// Their own force laws compute the dashpot force with the half-step velocity v+, which is an error of first
// order. Here it is computed with v(t+dt), for which an implicit equation is solved. advance.h adds the
// steps in which a contact begins or ends.

#include "physics/laws/contact_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drumlin::physics {

/// The motion of one link in a step, from which its force is computed.
struct StepMotion {
  double overlap;     ///< d(t+dt), m
  double rate_half;   ///< d' with the half-step velocities v+, m/s
  double rate_before; ///< d' with the velocities at t, along the normal of t+dt, m/s
  double dt;          ///< s

  /// d(t), m, computed back as if the normal did not turn during the step.
  [[nodiscard]] double overlap_before() const { return overlap - dt * rate_half; }
  /// d'(t+dt), m/s, if the forces of t+dt were those of t.
  [[nodiscard]] double rate_predicted() const { return 2.0 * rate_half - rate_before; }
};

/// Time, s, for which balls that touch now, and did not one step ago, have touched. The springs of friction
/// and of rolling resistance take up the motion of this time; with that of the whole step they would have an
/// error of first order.
/// \param overlap m \param rate of the overlap, m/s \param dt s
[[nodiscard]] inline double time_in_contact(double overlap, double rate, double dt) {
  return overlap < dt * rate ? overlap / rate : dt;
}

/// Force at t+dt, N, of a spring and dashpot that acted through the whole step, with the dashpot force of the
/// velocity at t+dt.
///
/// With v_pred = v+ + (v+ - v(t)), the velocity that unchanged forces would give,
///   v(t+dt) = v_pred + dt/2 (F - F_old) / m   hence   F = (E + C d'_pred + s F_old) / (1 + s)
/// with s = C dt / (2 m_eff). For one contact this is the implicit solution, stable for w0 dt < 2 at any
/// damping. It neglects that the other contacts of the two balls change d'(t+dt) as well, an error of second
/// order; with heavy damping in a packing this would be unstable, and coupled_force() is needed.
/// \param force_before F_old, N: the force in the opening half kick
/// \param c_over_m C / m_eff, 1/s
template <class Law>
[[nodiscard]] inline double implicit_force(const Law &law, const StepMotion &motion, double force_before,
                                           double c_over_m) {
  const double s = 0.5 * motion.dt * c_over_m;
  const double slowed = 1.0 / (1.0 + s); // a factor: it does not have to wait for the motion
  return slowed * (law.spring_and_dashpot(motion.overlap, motion.rate_predicted()) + s * force_before);
}

/// Whether a link's dashpot must be solved for together with the others of its balls: see CoupledDashpot.
///
/// Solving for each link alone costs less and its dashpot force does not lag. It is stable up to 0.7 of the
/// limit of the springs (searched in tests/core/scheme_test.cpp) if dt R <= 0.25, and also if
/// dt R <= 0.75 and dt^2 R k/c <= 0.5, which is far from the limit of the springs. R = sqrt(c) sum sqrt(c)/m
/// is the sum of c/m, and R k/c that of k/m, where all contacts are alike. False for a link without a
/// dashpot. \param all sum of sqrt(c)/m over all contacts of both balls, sqrt(N s/m)/kg
[[nodiscard]] inline bool needs_coupling(double dt, double k, double c, double all) {
  const double squared = dt * dt * c * all * all; // (dt R)^2: a root would take time in each contact
  return squared > 0.0625 && c > 0.0 && (squared > 0.5625 || squared * dt * dt * k * k > 0.25 * c * c);
}

/// The dashpots that may act on a ball at once, as far as needs_coupling() depends on them.
struct Dashpots {
  double sum = 0.0;       ///< of sqrt(c), c in N s/m
  double strongest = 0.0; ///< greatest c, N s/m
  double stiffest = 0.0;  ///< greatest k/c, 1/s; infinite if there is a spring without dashpot

  void add(double k, double c) { add({std::sqrt(c), c, k / c}); }
  void add(const Dashpots &other) {
    const double both = sum + other.sum;
    take_greatest(other);
    sum = both;
  }
  void take_greatest(const Dashpots &other) {
    sum = std::max(sum, other.sum);
    strongest = std::max(strongest, other.strongest);
    stiffest = std::max(stiffest, other.stiffest);
  }
};

/// Heavily damped links that share a ball are solved for together, in two passes. In the first, every link
/// exerts the force of the step before plus the change of its spring force,  F_old + E - E_old.  From these
/// and all other forces follow the acceleration a and the velocity v* = v+ + dt/2 a. In the second, with d'*
/// the rate of the overlap with the velocities v*, each dashpot exerts
///   f = (C d'* + s f_old) / (1 + s),   f_old = F_old - E_old
/// with s = dt/2 sqrt(C) times the sum of sqrt(C)/m over all links of both balls. The exact solution has, in
/// place of s/C, the matrix B_ab = dt/2 n_a.n_b / m of all links of a ball:  f = C (d'* - B (f - f_old)).  By
/// Cauchy-Schwarz, (sum x_a)^2 <= sum w_a sum x_a^2/w_a for any weights w > 0, here sqrt(C), the diagonal
/// matrix of s/C is not less than B: the dashpot forces lag behind, which cannot create energy, and the limit
/// of the springs is that without damping. (With the weights C, a light dashpot beside a heavy one would lag
/// by as many steps as that one has s.) For one link alone both solutions are the same.
struct CoupledDashpot {
  double first;    ///< F_old + E - E_old, N: force in the first pass
  double at_rest;  ///< E + s f_old / (1 + s), N: force at d'* = 0
  double per_rate; ///< C / (1 + s), N s/m: force per d'*
  double least;    ///< lower limit of the force, N: 0 under B, which never pulls; minus infinity under A
};

/// \param all sum of sqrt(C)/m over all links of both balls, sqrt(N s/m)/kg
template <class Law>
[[nodiscard]] inline CoupledDashpot coupled_dashpot(const Law &law, const StepMotion &motion,
                                                    double force_before, double all) {
  const double change = law.spring_change(motion.overlap, motion.rate_half, motion.dt);
  const double elastic = law.spring(motion.overlap);
  const double dashpot_before = force_before - (elastic - change);
  const double s = 0.5 * motion.dt * std::sqrt(law.dashpot(motion.overlap)) * all;
  const double slowed = 1.0 / (1.0 + s);
  return {force_before + change, elastic + slowed * s * dashpot_before, slowed * law.dashpot(motion.overlap),
          law.limited(-std::numeric_limits<double>::infinity())};
}

/// Force of the second pass, at t+dt, N. \param rate d'* in m/s, with the velocities v*
[[nodiscard]] inline double coupled_force(const CoupledDashpot &p, double rate) {
  const double force = p.at_rest + p.per_rate * rate;
  return force <= p.least ? p.least : force;
}

} // namespace drumlin::physics
