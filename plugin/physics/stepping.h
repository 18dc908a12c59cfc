#pragma once
// Second-order stepping: what a velocity-Verlet step does with the normal contact law.
//
// The engines' stepping is  v+ = v + dt/2 a(t),  x(t+dt) = x(t) + dt v+,  forces,  v(t+dt) = v+ + dt/2 a(t+dt).
// Stock force laws put the half-step velocity v+ into the dashpot, and act on the whole step in which a contact is made:
// both are errors of first order. Here the dashpot sees v(t+dt), solved for implicitly, and the step of a make carries the
// impulse of its part in contact.

#include "physics/contact_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drumlin::physics {

/// What the force of one contact sees in a step.
struct StepMotion {
  double overlap;     ///< d(t+dt), m
  double rate_half;   ///< d' with the half-step velocities v+, m/s
  double rate_before; ///< d' with the velocities at t, along the normal of t+dt, m/s
  double dt;          ///< s
};

/// What a contact does in a step.
struct StepForce {
  double force; ///< N, physical, at t+dt; the next opening half kick gets it
  double kick;  ///< N, for the closing half kick of this step
  double
      shift; ///< N: moves the balls by what dt/2 of it would in the next step's drift, and leaves their velocities
};

/// Whether the balls were apart at the begin of the step, by their motion in it.
[[nodiscard]] inline bool came_from_apart(const StepMotion &motion) {
  return motion.overlap - motion.dt * motion.rate_half <= 0.0;
}

/// Force of a contact under its transition condition: B does not let it pull. The zero of a contact without force is negative, under
/// either condition: see was_contact().
[[nodiscard]] inline double limited(Transition transition, double force) {
  return (transition == Transition::B ? force <= 0.0 : force == 0.0) ? -0.0 : force;
}

/// Whether a force on record, N, is that of a contact; 0 is none.
[[nodiscard]] inline bool was_contact(double force) { return force != 0.0 || std::signbit(force); }

/// Whether contact was made in this step. One that was there before may seem to come from apart: behind a make the balls are moved beside
/// their velocities (StepForce::shift), and other contacts of theirs that barely overlap with them.
/// \param force_before N, on record of the step before
[[nodiscard]] inline bool made_in_step(const StepMotion &motion, double force_before) {
  return !was_contact(force_before) && came_from_apart(motion);
}

/// Force k d + c d' at t+dt of a spring-dashpot that held through the step, the dashpot at the velocity of t+dt.
///
/// With v_pred = v+ + (v+ - v(t)), the velocity that unchanged forces would give,
///   v(t+dt) = v_pred + dt/2 (F - F_old) / m   hence   F = (k d + c d'_pred + s F_old) / (1 + s),   s = c dt / (2 m_eff).
/// For one contact this is the implicit solution, stable for w0 dt < 2 at any damping. The other contacts of the two balls change
/// their velocities too, which it does not see: an error of second order, but heavy damping in a packing needs coupled_force().
/// \param force_before F_old, N: the force that the opening half kick had
/// \param c_over_m c / m_eff, 1/s
[[nodiscard]] inline double second_order_spring_dashpot(double k, double c, const StepMotion &motion,
                                                        double force_before, double c_over_m) {
  const double s = 0.5 * motion.dt * c_over_m;
  const double slowed = 1.0 / (1.0 + s); // apart, so that the division need not wait for the motion
  const double rate_predicted = 2.0 * motion.rate_half - motion.rate_before;
  return slowed * (k * motion.overlap + c * rate_predicted + s * force_before);
}

/// Whether a contact's dashpot must be solved for together with the others of its balls: see CoupledDashpot.
///
/// Each on its own costs less, lags by nothing, and is stable up to 0.7 of the limit of the springs (tests/plugin/physics/time_step_test.cpp)
/// as long as dt sum c/m <= 0.25, or <= 0.75 and dt^2 sum k/m <= 0.5, the springs far from their limit. sum k/m is taken as k/c sum c/m, as
/// where contacts are alike. A contact without a dashpot has nothing to be solved for.
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

/// Force at t+dt of a contact that held through the step, under its transition condition. Arguments as above.
[[nodiscard]] inline double second_order_held(Transition transition, double k, double c,
                                              const StepMotion &motion, double force_before,
                                              double c_over_m) {
  return limited(transition, second_order_spring_dashpot(k, c, motion, force_before, c_over_m));
}

/// Where contacts with heavy damping meet, their dashpots must know of one another. They are solved for in two passes:
/// first every contact gives what changes with the positions,  F_old + k (d - d_old);  then, with v* = v+ + dt/2 a, a of these forces
/// and all others that act, each dashpot takes
///   f = (c d'* + s f_old) / (1 + s),   f_old = F_old - k d_old,   s = dt/2 sum of c/m over all contacts of both balls.
/// The exact solution has the matrix B_ab = dt/2 n_a.n_b / m of all contacts of a ball in the place of s/c, f = c (d'* - B (f - f_old)).
/// By Cauchy-Schwarz the diagonal s/c is not less than B: the dashpots lag by a step at most, which takes no energy from nowhere, and
/// any damping leaves the limit of the springs as it is. For one contact both are the same.
struct CoupledDashpot {
  double first;    ///< F_old + k (d - d_old), N: what the first pass gives
  double at_rest;  ///< k d + s f_old / (1 + s), N: force without d'*
  double per_rate; ///< c / (1 + s), N s/m
  double least;    ///< N: 0 under B, which never pulls
};

/// \param all_c_over_m sum of c/m over all contacts of both balls, 1/s
[[nodiscard]] inline CoupledDashpot coupled_dashpot(Transition transition, double k, double c,
                                                    const StepMotion &motion, double force_before,
                                                    double all_c_over_m) {
  const double change = k * motion.dt * motion.rate_half;
  const double elastic = k * motion.overlap;
  const double dashpot_before = force_before - (elastic - change);
  const double s = 0.5 * motion.dt * all_c_over_m;
  const double slowed = 1.0 / (1.0 + s);
  return {force_before + change, elastic + slowed * s * dashpot_before, slowed * c,
          transition == Transition::B ? -0.0 : -std::numeric_limits<double>::infinity()};
}

/// Force at t+dt, N. \param rate d'* in m/s, with the velocities v*
[[nodiscard]] inline double coupled_force(const CoupledDashpot &p, double rate) {
  const double force = p.at_rest + p.per_rate * rate;
  return force <= p.least ? p.least : force;
}

/// Second-order force of a contact with d(t+dt) > 0.
///
/// In the step of a make the contact acts for theta dt, theta = d / (dt d'+), between F0 = c d' at d = 0 (Eq. 4) and F. The
/// impulse theta dt (F0 + F) / 2 is given to the closing half kick, which makes v(t+dt) physical:
///   F = k d + c (d'_pred - dt/2 kick / m),   kick = theta (F0 + F).
/// The drift of the step knew nothing of the contact: the overlap is too large by about theta s d (s = c dt / (2 m)), taken as
/// d theta s / (1 + theta s), which stays below d at any damping. And from a jump of force on, the drift with the acceleration at
/// the begin of each step leaves the positions behind the sum of the velocities by dt^2/4 of the jump of the acceleration (the
/// boundary term of the trapezoidal sum). Both are shifts of the positions; they matter for heavy damping, where d soon stops
/// growing and the rebound goes with d.
/// \param force_before, c_over_m as in second_order_spring_dashpot(); the force is 0 in the step of a make
[[nodiscard]] inline StepForce second_order_force(Transition transition, double k, double c,
                                                  const StepMotion &motion, double force_before,
                                                  double c_over_m) {
  if (!made_in_step(motion, force_before)) {
    const double force = second_order_held(transition, k, c, motion, force_before, c_over_m);
    return {force, force, 0.0};
  }
  // A ball at rest that just touches has neither overlap nor rate.
  const double theta = motion.overlap > 0.0 ? motion.overlap / (motion.dt * motion.rate_half) : 0.0;
  const double rate_predicted = 2.0 * motion.rate_half - motion.rate_before;
  const double rate_at_make = motion.rate_before + (1.0 - theta) * (rate_predicted - motion.rate_before);
  const double s_step = 0.5 * motion.dt * c_over_m;
  const double s = theta * s_step;
  // A dashpot so strong that it stops the ball within a half kick, this one or the next opening one, takes no more than the
  // ball has: else it would throw it back.
  const double first = c * std::max(0.0, rate_at_make) / std::max(1.0, s);
  const double slowed = 1.0 / (1.0 + s);
  const double force =
      (k * slowed * motion.overlap + c * rate_predicted - s * first) / (std::max(1.0, s_step) + s);
  const double acting = limited(transition, force);
  return {acting, theta * (first + acting), slowed * theta * c * motion.overlap / motion.dt - 0.5 * acting};
}

/// Tensile force under A in the step whose end finds the contact broken: it acted for the share of the step before d = 0,
/// and the opening half kick has given half a step of it already. Nothing where the force does not jump, which is under B and without
/// a dashpot, and if there was no contact at the begin of the step.
/// \param motion with motion.overlap <= 0
[[nodiscard]] inline StepForce second_order_break(Transition transition, double k, double c,
                                                  const StepMotion &motion) {
  if (transition == Transition::B || c == 0.0 || came_from_apart(motion)) return {0.0, 0.0, 0.0};
  const double before = motion.overlap - motion.dt * motion.rate_half;
  const double share = before / (before - motion.overlap);
  const double tensile = normal_force(transition, k, c, before, motion.rate_before);
  return {0.0, (2.0 * share - 1.0) * tensile, -(1.0 - share) * (1.0 - share) * tensile};
}

} // namespace drumlin::physics
