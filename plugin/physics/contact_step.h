#pragma once
/// The forces of one contact in one time step: advance(), for every contact law and both engines.
///
/// The second-order scheme (keyword `stepping second`) distinguishes five situations: the set-up of a run, a
/// contact that continues through the step, one that begins in it (a make), one that ends in it (a break),
/// and heavily damped contacts that share a ball. The engines' own scheme (`stepping stock`) has one formula
/// for all. The transition condition A or B is applied by the law alone, in ContactLaw::limited(). An
/// "opening" half kick is the velocity update before the drift of velocity Verlet, a "closing" one that after
/// the forces.

#include "physics/contact_law.h"
#include "physics/stepping.h"

#include <algorithm>

namespace drumlin::physics {

/// What a contact stores of its normal force from one time step to the next. (friction_step() and
/// rolling_step() take and return the springs of friction and rolling resistance.)
struct ContactState {
  double force = 0.0;      ///< normal force at the end of the step, N
  bool in_contact = false; ///< overlap >= 0 then (> 0 under `stock`); under B the force may still be 0
};

/// Masses and damping of the two balls, which advance() needs in addition to their motion.
struct StepContext {
  double m_eff;                   ///< kg
  double damping_over_mass = 0.0; ///< sum of c/m over all contacts of both balls in the last step, 1/s
  bool in_setup = false;          ///< set-up of a run: velocities belong to the time of the positions
};

/// The forces of a contact in a step.
struct StepResult {
  double force;         ///< N, contact force at t+dt, which acts in the opening half kick of the next step
  double kick;          ///< N, force that acts in the closing half kick of this step instead
  double shift;         ///< N, position correction: the next drift moves a ball by dt^2/(2 m) of it more, and
                        ///< the velocity is unchanged afterwards
  bool coupled = false; ///< the force is coupled_force() of `dashpot`, once all forces of the step are known;
                        ///< `force` is then that of the contact solved for alone, with which friction is
                        ///< computed; see limited_to() in friction_law.h
  CoupledDashpot dashpot{}; ///< if coupled
};

/// Whether the balls did not overlap at the beginning of the step, computed back from their motion in it.
[[nodiscard]] inline bool came_from_apart(const StepMotion &motion) { return motion.overlap_before() <= 0.0; }

namespace detail {

/// The step of a make, of a law whose force begins with a jump: the contact acts for theta dt, theta = d /
/// (dt d'+), between F0 = c d' at d = 0 (Eq. 4) and F. The impulse theta dt (F0 + F) / 2 is given to the
/// closing half kick, which makes v(t+dt) physical:
///   F = k d + c (d'_pred - dt/2 kick / m),   kick = theta (F0 + F).
/// The drift of the step did not contain the contact force, so that the overlap is too large by about
/// theta s d (s = c dt / (2 m)); the correction is d theta s / (1 + theta s), which is less than d at any
/// damping. After a jump of the force, the drift, which uses the acceleration at the beginning of each step,
/// differs from the trapezoidal sum of the velocities by dt^2/4 times the jump of the acceleration (the
/// boundary term of that sum). Both are position corrections. They matter for heavy damping, where d soon
/// stops growing and the rebound is proportional to d.
template <class Law>
[[nodiscard]] inline StepResult made_with_jump(const Law &law, const StepMotion &motion, double theta,
                                               double c_over_m) {
  const double k = law.stiffness(0.0);
  const double c = law.dashpot(0.0);
  const double rate_predicted = motion.rate_predicted();
  const double rate_at_make = motion.rate_before + (1.0 - theta) * (rate_predicted - motion.rate_before);
  const double s_step = 0.5 * motion.dt * c_over_m;
  const double s = theta * s_step;
  // Where the dashpot alone would stop the ball within this half kick (s > 1) or the next opening one
  // (s_step > 1), its force is limited to the momentum of the ball; otherwise it would reverse the motion.
  const double first = c * std::max(0.0, rate_at_make) / std::max(1.0, s);
  const double slowed = 1.0 / (1.0 + s);
  const double force =
      (k * slowed * motion.overlap + c * rate_predicted - s * first) / (std::max(1.0, s_step) + s);
  const double acting = law.limited(force);
  return {acting, theta * (first + acting), slowed * theta * c * motion.overlap / motion.dt - 0.5 * acting};
}

/// The step of a make, of a law whose force begins with 0. The closing half kick gets the first force times
/// Law::first_weight(). There is no position correction: it would be of higher order than the scheme.
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

/// The step in which a contact ends under A, in tension. The tension acts only for the share of the step
/// before d = 0, but the opening half kick and the drift contained it as if it acted through the whole step:
/// kick and shift remove the excess. All are 0 under B, which has no tension, without a dashpot, and if there
/// was no overlap at the beginning of the step.
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

/// Whether a contact neither begins nor needs to be solved for together with others in this step, given that
/// it has not ended. This holds for nearly all contacts in nearly all steps; going_on() then gives the same
/// force as advance() at less cost, for inner loops.
template <class Law>
[[nodiscard]] inline bool goes_on(const Law &law, const StepMotion &motion, const ContactState &state,
                                  const StepContext &context) {
  return state.in_contact && !context.in_setup &&
         !needs_coupling(motion.dt, law.stiffness(motion.overlap), law.dashpot(motion.overlap),
                         context.damping_over_mass);
}

/// Force, N, of a contact that continues (see goes_on()), under its transition condition.
template <class Law>
[[nodiscard]] inline double going_on(const Law &law, const StepMotion &motion, double force_before,
                                     double m_eff) {
  return law.limited(implicit_force(law, motion, force_before, law.dashpot(motion.overlap) / m_eff));
}

/// One step of one contact with the second-order scheme. `state` is that of the step before on entry and that
/// of this step on return. The force of a coupled contact is known only when all forces of the step are; the
/// caller then stores it in ContactState::force.
/// \param motion its overlap may be < 0: then there is no contact, or a contact has ended in this step
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
  // Both conditions are needed. An old contact with a small overlap may fulfil came_from_apart() as well:
  // when one of its balls makes contact with a third, the position correction moves that ball.
  if (!was_in_contact && came_from_apart(motion)) {
    const StepResult result = detail::made(law, motion, law.dashpot(motion.overlap) / context.m_eff);
    state.force = result.force;
    return result;
  }
  // An overlap from before this step but no history: a ball on a mesh has moved to another triangle.
  const double before = was_in_contact ? state.force : law.force(motion.overlap_before(), motion.rate_before);
  state.force = going_on(law, motion, before, context.m_eff);
  if (!needs_coupling(motion.dt, law.stiffness(motion.overlap), law.dashpot(motion.overlap),
                      context.damping_over_mass))
    return {state.force, state.force, 0.0};
  const CoupledDashpot dashpot = coupled_dashpot(law, motion, before, context.damping_over_mass);
  return {state.force, dashpot.first, 0.0, true, dashpot};
}

/// The same with the engines' own scheme, `stock`: the dashpot force is computed with the half-step velocity,
/// and the force acts in the closing and the next opening half kick alike.
template <class Law>
[[nodiscard]] inline StepResult advance_stock(const Law &law, const StepMotion &motion, ContactState &state) {
  state.in_contact = motion.overlap > 0.0;
  state.force = law.force(motion.overlap, motion.rate_half);
  return {state.force, state.force, 0.0};
}

} // namespace drumlin::physics
