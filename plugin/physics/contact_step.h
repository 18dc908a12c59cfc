#pragma once
/// What a time step does with a contact: advance(), for every law and both engines.
///
/// The second-order scheme treats the five situations of a contact: set-up, a contact that goes on, one that
/// is made in the step, one that ends in it, and heavily damped contacts that share a ball. The stock scheme,
/// the engines' own, has one. The law alone knows its transition condition (ContactLaw::limited()).

#include "physics/contact_law.h"
#include "physics/stepping.h"
#include "physics/vec3.h"

#include <algorithm>

namespace drumlin::physics {

/// What a contact remembers from one step to the next.
struct ContactState {
  double force = 0.0;      ///< normal force at the end of the step, N
  bool in_contact = false; ///< whether the surfaces overlapped then; under B the force may be 0 nevertheless
  Vec3 spring{};           ///< tangential spring, m: see friction_law.h
};

/// What a contact must know of the two balls, apart from their motion.
struct StepContext {
  double m_eff;                   ///< kg
  double damping_over_mass = 0.0; ///< sum of c/m over all contacts of both balls in the last step, 1/s
  bool in_setup = false;          ///< velocities belong to the time of the positions: the set-up of a run
};

/// What a contact does in a step.
struct StepResult {
  double force;         ///< N, physical, at t+dt; the next opening half kick gets it
  double kick;          ///< N, for the closing half kick of this step
  double shift;         ///< N: dt/2 of it moves the balls in the next drift, their velocities stay
  bool coupled = false; ///< the force is coupled_force() of `dashpot`, once all forces of the step are known;
                        ///< `force` is then what the contact would have alone, which friction takes
  CoupledDashpot dashpot{}; ///< if coupled
};

/// Whether the balls were apart at the begin of the step, by their motion in it.
[[nodiscard]] inline bool came_from_apart(const StepMotion &motion) { return motion.overlap_before() <= 0.0; }

namespace detail {

/// The step of a make, of a law whose force begins with a jump: the contact acts for theta dt, theta = d /
/// (dt d'+), between F0 = c d' at d = 0 (Eq. 4) and F. The impulse theta dt (F0 + F) / 2 is given to the
/// closing half kick, which makes v(t+dt) physical:
///   F = k d + c (d'_pred - dt/2 kick / m),   kick = theta (F0 + F).
/// The drift of the step knew nothing of the contact: the overlap is too large by about theta s d (s = c dt /
/// (2 m)), taken as d theta s / (1 + theta s), which stays below d at any damping. And from a jump of force
/// on, the drift with the acceleration at the begin of each step leaves the positions behind the sum of the
/// velocities by dt^2/4 of the jump of the acceleration (the boundary term of the trapezoidal sum). Both are
/// position corrections; they matter for heavy damping, where d soon stops growing and the rebound goes with
/// d.
template <class Law>
[[nodiscard]] inline StepResult made_with_jump(const Law &law, const StepMotion &motion, double theta,
                                               double c_over_m) {
  const double k = law.stiffness(0.0);
  const double c = law.dashpot(0.0);
  const double rate_predicted = motion.rate_predicted();
  const double rate_at_make = motion.rate_before + (1.0 - theta) * (rate_predicted - motion.rate_before);
  const double s_step = 0.5 * motion.dt * c_over_m;
  const double s = theta * s_step;
  // A dashpot so strong that it stops the ball within a half kick, this one or the next opening one, takes no
  // more than the ball has: else it would throw it back.
  const double first = c * std::max(0.0, rate_at_make) / std::max(1.0, s);
  const double slowed = 1.0 / (1.0 + s);
  const double force =
      (k * slowed * motion.overlap + c * rate_predicted - s * first) / (std::max(1.0, s_step) + s);
  const double acting = law.limited(force);
  return {acting, theta * (first + acting), slowed * theta * c * motion.overlap / motion.dt - 0.5 * acting};
}

/// The step of a make, of a law whose force begins with 0. The first force gets the law's weight in the
/// closing half kick, and no position correction, which would be of higher order than the scheme:
///   F = E + C (d'_pred - dt/2 kick / m),   kick = weight F.
template <class Law>
[[nodiscard]] inline StepResult made_from_zero(const Law &law, const StepMotion &motion, double theta,
                                               double c_over_m) {
  const double weight = law.first_weight(theta);
  const double s = 0.5 * motion.dt * c_over_m;
  const double force = law.spring_and_dashpot(motion.overlap, motion.rate_predicted()) / (1.0 + s * weight);
  const double acting = law.limited(force);
  return {acting, weight * acting, 0.0};
}

/// The step of a make, of any law: the contact has acted for the share theta of the step.
template <class Law>
[[nodiscard]] inline StepResult made(const Law &law, const StepMotion &motion, double c_over_m) {
  // A ball at rest that just touches has neither overlap nor rate.
  const double theta = motion.overlap > 0.0 ? motion.overlap / (motion.dt * motion.rate_half) : 0.0;
  if constexpr (Law::begins_with_jump)
    return made_with_jump(law, motion, theta, c_over_m);
  else
    return made_from_zero(law, motion, theta, c_over_m);
}

/// Tension in the step whose end finds the contact broken: it acted for the share of the step before d = 0,
/// and the opening half kick has given half a step of it already. Nothing under B, which has no tension,
/// without a dashpot, and if there was no contact at the begin of the step.
template <class Law>
[[nodiscard]] inline StepResult broken(const Law &law, const StepMotion &motion) {
  const double before = motion.overlap_before();
  if (!law.ends_in_tension() || before <= 0.0 || law.dashpot(before) == 0.0) return {0.0, 0.0, 0.0};
  const double share = before / (before - motion.overlap);
  const double tensile = law.force(before, motion.rate_before);
  const double kick = (law.first_weight(share) - 1.0) * tensile;
  if constexpr (Law::begins_with_jump) return {0.0, kick, -(1.0 - share) * (1.0 - share) * tensile};
  return {0.0, kick, 0.0};
}

} // namespace detail

/// Whether a contact only goes on in this step, which is what nearly all contacts of nearly all steps do:
/// then going_on() is advance(), for inner loops.
template <class Law>
[[nodiscard]] inline bool goes_on(const Law &law, const StepMotion &motion, const ContactState &state,
                                  const StepContext &context) {
  return state.in_contact && !context.in_setup &&
         !needs_coupling(motion.dt, law.stiffness(motion.overlap), law.dashpot(motion.overlap),
                         context.damping_over_mass);
}

/// Force, N, of a contact that goes on, under its transition condition.
template <class Law>
[[nodiscard]] inline double going_on(const Law &law, const StepMotion &motion, double force_before,
                                     double m_eff) {
  return law.limited(implicit_force(law, motion, force_before, law.dashpot(motion.overlap) / m_eff));
}

/// One contact, one step of the second-order scheme. Takes the state that the step before has left and leaves
/// its own. The force of a coupled contact is known later: it then replaces ContactState::force.
/// \param motion with any overlap: one < 0 is no contact, or the end of one
template <class Law>
[[nodiscard]] inline StepResult advance(const Law &law, const StepMotion &motion, ContactState &state,
                                        const StepContext &context) {
  const bool was_in_contact = state.in_contact;
  if (motion.overlap < 0.0) {
    state = {};
    return was_in_contact && !context.in_setup ? detail::broken(law, motion) : StepResult{0.0, 0.0, 0.0};
  }
  state.in_contact = true;
  if (context.in_setup) {
    state.force = law.force(motion.overlap, motion.rate_half);
    return {state.force, state.force, 0.0};
  }
  // A contact that is not new may seem to come from apart: behind a make its balls get a position correction,
  // and other contacts of theirs that barely overlap get it, too.
  if (!was_in_contact && came_from_apart(motion)) {
    const StepResult result = detail::made(law, motion, law.dashpot(motion.overlap) / context.m_eff);
    state.force = result.force;
    return result;
  }
  // No state although the contact is older than this step: a ball on a mesh went over to another triangle.
  const double before = was_in_contact ? state.force : law.force(motion.overlap_before(), motion.rate_before);
  state.force = going_on(law, motion, before, context.m_eff);
  if (!needs_coupling(motion.dt, law.stiffness(motion.overlap), law.dashpot(motion.overlap),
                      context.damping_over_mass))
    return {state.force, state.force, 0.0};
  const CoupledDashpot dashpot = coupled_dashpot(law, motion, before, context.damping_over_mass);
  return {state.force, dashpot.first, 0.0, true, dashpot};
}

/// The same with the stock scheme, the engines' own: the dashpot sees the half-step velocity, and a force
/// acts on the whole step.
template <class Law>
[[nodiscard]] inline StepResult advance_stock(const Law &law, const StepMotion &motion, ContactState &state) {
  state.in_contact = motion.overlap > 0.0;
  state.force = law.force(motion.overlap, motion.rate_half);
  return {state.force, state.force, 0.0};
}

} // namespace drumlin::physics
