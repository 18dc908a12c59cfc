#pragma once
// The second-order scheme: what a step of velocity Verlet does with the dashpot of a link, a contact or a
// bond.
//
// The engines' step is  v+ = v + dt/2 a(t),  x(t+dt) = x(t) + dt v+,  forces,  v(t+dt) = v+ + dt/2 a(t+dt).
// Their own force laws put the half-step velocity v+ into the dashpot, which is an error of first order. Here
// the dashpot sees v(t+dt), solved for implicitly. contact_step.h adds what a contact needs when it begins
// and ends.

#include "physics/contact_law.h"

#include <algorithm>
#include <limits>

namespace drumlin::physics {

/// What the force of one link sees in a step.
struct StepMotion {
  double overlap;     ///< d(t+dt), m
  double rate_half;   ///< d' with the half-step velocities v+, m/s
  double rate_before; ///< d' with the velocities at t, along the normal of t+dt, m/s
  double dt;          ///< s

  /// d(t), m, which follows from the motion in one dimension.
  [[nodiscard]] double overlap_before() const { return overlap - dt * rate_half; }
  /// d'(t+dt), m/s, if the forces of t+dt were those of t.
  [[nodiscard]] double rate_predicted() const { return 2.0 * rate_half - rate_before; }
};

/// Force at t+dt of a spring and dashpot that acted through the step, the dashpot at the velocity of t+dt.
///
/// With v_pred = v+ + (v+ - v(t)), the velocity that unchanged forces would give,
///   v(t+dt) = v_pred + dt/2 (F - F_old) / m   hence   F = (E + C d'_pred + s F_old) / (1 + s),   s = C dt /
/// (2 m_eff). For one contact this is the implicit solution, stable for w0 dt < 2 at any damping. The other
/// contacts of the two balls change their velocities too, which it does not see: an error of second order,
/// but heavy damping in a packing needs coupled_force().
/// \param force_before F_old, N: the force that the opening half kick had
/// \param c_over_m C / m_eff, 1/s
template <class Law>
[[nodiscard]] inline double implicit_force(const Law &law, const StepMotion &motion, double force_before,
                                           double c_over_m) {
  const double s = 0.5 * motion.dt * c_over_m;
  const double slowed = 1.0 / (1.0 + s); // apart, so that the division need not wait for the motion
  return slowed * (law.spring_and_dashpot(motion.overlap, motion.rate_predicted()) + s * force_before);
}

/// Whether a link's dashpot must be solved for together with the others of its balls: see CoupledDashpot.
///
/// Each on its own costs less, lags by nothing, and is stable up to 0.7 of the limit of the springs
/// (tests/plugin/physics/time_step_test.cpp) as long as dt sum c/m <= 0.25, or <= 0.75 and dt^2 sum k/m <=
/// 0.5, the springs far from their limit. sum k/m is taken as k/c sum c/m, as where contacts are alike. A
/// contact without a dashpot has nothing to be solved for.
/// \param all_c_over_m sum of c/m over all contacts of both balls, 1/s
[[nodiscard]] inline bool needs_coupling(double dt, double k, double c, double all_c_over_m) {
  const double dashpots = dt * all_c_over_m;
  return dashpots > 0.25 && c > 0.0 && (dashpots > 0.75 || dashpots * dt * k > 0.5 * c);
}

/// Dashpots that may act on a ball at once.
struct Dashpots {
  double sum = 0.0;      ///< of c, N s/m
  double stiffest = 0.0; ///< greatest k/c, 1/s; infinite if there is a spring without dashpot

  void add(double k, double c) {
    sum += c;
    stiffest = std::max(stiffest, k / c);
  }
  void add(const Dashpots &other) {
    sum += other.sum;
    stiffest = std::max(stiffest, other.stiffest);
  }
};

/// Heavily damped links that share a ball are solved for together, in two passes: first every link gives what
/// changes with the positions,  F_old + E - E_old;  then, with v* = v+ + dt/2 a, a of these forces and all
/// others that act, each dashpot takes
///   f = (C d'* + s f_old) / (1 + s),   f_old = F_old - E_old,   s = dt/2 sum of c/m over all links of both
/// balls. The exact solution has the matrix B_ab = dt/2 n_a.n_b / m of all links of a ball in the place of
/// s/C, f = C (d'* - B (f - f_old)). By Cauchy-Schwarz the diagonal s/C is not less than B: the dashpots lag
/// by a step at most, which cannot create energy, and any damping leaves the limit of the springs as it is.
/// For one link both are the same.
struct CoupledDashpot {
  double first;    ///< F_old + E - E_old, N: what the first pass gives
  double at_rest;  ///< E + s f_old / (1 + s), N: force without d'*
  double per_rate; ///< C / (1 + s), N s/m
  double least;    ///< N: 0 under B, which never pulls
};

/// \param all_c_over_m sum of c/m over all links of both balls, 1/s
template <class Law>
[[nodiscard]] inline CoupledDashpot coupled_dashpot(const Law &law, const StepMotion &motion,
                                                    double force_before, double all_c_over_m) {
  const double change = law.spring_change(motion.overlap, motion.rate_half, motion.dt);
  const double elastic = law.spring(motion.overlap);
  const double dashpot_before = force_before - (elastic - change);
  const double s = 0.5 * motion.dt * all_c_over_m;
  const double slowed = 1.0 / (1.0 + s);
  return {force_before + change, elastic + slowed * s * dashpot_before, slowed * law.dashpot(motion.overlap),
          law.limited(-std::numeric_limits<double>::infinity())};
}

/// Force at t+dt, N. \param rate d'* in m/s, with the velocities v*
[[nodiscard]] inline double coupled_force(const CoupledDashpot &p, double rate) {
  const double force = p.at_rest + p.per_rate * rate;
  return force <= p.least ? p.least : force;
}

} // namespace drumlin::physics
