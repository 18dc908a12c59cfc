#pragma once
/// The forces of one contact in one time step: advance(), for every contact law and both engines.
///
/// The second-order scheme (keyword `stepping second`) distinguishes five situations: the set-up of a run, a
/// contact that continues through the step, one that begins in it (a make), one that ends in it (a break),
/// and heavily damped contacts that share a ball. The engines' own scheme (`stepping stock`) has one formula
/// for all. The transition condition A or B is applied by the law alone, in ContactLaw::limited(). An
/// "opening" half kick is the velocity update before the drift of velocity Verlet, a "closing" one that after
/// the forces.

#include "physics/laws/contact_law.h"
#include "physics/scheme/event_location.h"
#include "physics/scheme/implicit_dashpot.h"

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
  double damping_over_mass = 0.0; ///< sum of sqrt(c)/m over all contacts of both balls in the last step
  bool in_setup = false;          ///< set-up of a run: velocities belong to the time of the positions
  bool continues = false;         ///< in a set-up: the stored force is that of the step before it
};

/// The forces of a contact in a step.
struct StepResult {
  double force; ///< N, contact force at t+dt, which acts in the opening half kick of the next step
  double kick;  ///< N, force that acts in the closing half kick of this step instead
  double shift; ///< N, position correction: the next drift moves a ball by dt^2/(2 m) of it more, and
                ///< the velocity is unchanged afterwards
  double
      weight; ///< of the force of a tangential dashpot in the closing half kick: 1, but in the step of a make
  bool begins = false;  ///< the contact begins in this step
  bool coupled = false; ///< the force is coupled_force() of `dashpot`, once all forces of the step are known;
                        ///< `force` is then that of the contact solved for alone, with which friction is
                        ///< computed; see limited_to() in friction_law.h
  CoupledDashpot dashpot{}; ///< if coupled
};

/// Whether the balls did not overlap at the beginning of the step, computed back from their motion in it.
[[nodiscard]] inline bool came_from_apart(const StepMotion &motion) { return motion.overlap_before() <= 0.0; }

namespace detail {

/// The step of a make, of a law whose force begins with a jump, the linear law: the contact acts for theta
/// dt, theta = d / (dt d'+), between F0 = c d' at d = 0 (Eq. 4) and F. The impulse theta dt (F0 + F) / 2 is
/// given to the closing half kick, which makes v(t+dt) physical:
///   F = k d + c (d'_pred - dt/2 kick / m),   kick = theta (F0 + F).
/// The drift of the step did not contain the contact force, so that the overlap is too large by about theta s
/// d (s = c dt / (2 m)); the correction is d theta s / (1 + theta s), which is less than d at any damping.
/// After a jump of the force, the drift, which uses the acceleration at the beginning of each step, differs
/// from the trapezoidal sum of the velocities by dt^2/4 times the jump of the acceleration (the boundary term
/// of that sum). Both are position corrections. They matter for heavy damping, where d soon stops growing and
/// the rebound is proportional to d.
template <class Law>
[[nodiscard]] inline StepResult made_with_jump(const Law &law, const StepMotion &motion, double theta,
                                               double c_over_m) {
  const double c = law.dashpot(0.0);
  const double rate_predicted = motion.rate_predicted();
  const double rate_at_make = motion.rate_before + (1.0 - theta) * (rate_predicted - motion.rate_before);
  const double s_step = 0.5 * motion.dt * c_over_m;
  const double s = theta * s_step;
  // Where the dashpot alone would stop the ball within this half kick (s > 1) or the next opening one (s_step
  // > 1), its force is limited to the momentum of the ball; otherwise it would reverse the motion.
  const double first = c * std::max(0.0, rate_at_make) / std::max(1.0, s);
  const double slowed = 1.0 / (1.0 + s);
  const double spring = law.spring(slowed * motion.overlap);
  const double force = law.limited((spring + c * rate_predicted - s * first) / (std::max(1.0, s_step) + s));
  const double jump = force - spring;
  return {force, theta * (first + force), slowed * theta * c * motion.overlap / motion.dt - 0.5 * jump,
          law.first_weight(theta), true};
}

/// The step of a make, of a law whose force begins with 0. The force G = C d' of the dashpot gets the weight
/// Law::first_weight() in the closing half kick. The force E of the spring grows so slowly that it needs
/// none. There is no position correction: it would be of higher order than the scheme.
///   F = E + G,   G = C (d'_pred - dt/2 kick / m),   kick = E + weight G.
template <class Law>
[[nodiscard]] inline StepResult made_from_zero(const Law &law, const StepMotion &motion, double theta,
                                               double c_over_m) {
  const double weight = law.first_weight(theta);
  const double s = 0.5 * motion.dt * c_over_m;
  const double spring = law.spring(motion.overlap);
  const double dashpot =
      (law.dashpot(motion.overlap) * motion.rate_predicted() - s * spring) / (1.0 + s * weight);
  const double force = law.limited(spring + dashpot);
  return {force, spring + weight * (force - spring), 0.0, weight, true};
}

/// The step of a make, of any law: the contact has acted for the share theta of the step. Without a dashpot
/// the forces of all steps are those of the engines' scheme, which loses no energy in an impact: a weight in
/// this step alone would make it gain some.
template <class Law>
[[nodiscard]] inline StepResult made(const Law &law, const StepMotion &motion, double c_over_m) {
  // A ball at rest that just touches has neither overlap nor rate.
  const double theta = motion.overlap > 0.0 ? motion.overlap / (motion.dt * motion.rate_half) : 0.0;
  if (c_over_m == 0.0) {
    const double force = law.spring(motion.overlap);
    return {force, force, 0.0, law.first_weight(theta), true};
  }
  if constexpr (Law::begins_with_jump)
    return made_with_jump(law, motion, theta, c_over_m);
  else
    return made_from_zero(law, motion, theta, c_over_m);
}

/// Overlap, m, and forces of spring and dashpot, N, at the end of the step before; 0 if there was no overlap.
struct LastForces {
  double overlap, spring, dashpot;
  [[nodiscard]] double sum() const { return spring + dashpot; }
};
template <class Law>
[[nodiscard]] inline LastForces last_forces(const Law &law, const StepMotion &motion) {
  const double before = motion.overlap_before();
  if (before <= 0.0) return {0.0, 0.0, 0.0};
  return {before, law.spring(before), law.dashpot(before) * motion.rate_before};
}

/// Closing half kick, N, of the step in which the force of a contact becomes 0 under B, whether the overlap
/// ends in this step or not. The two half kicks together have the impulse of the force until it is 0, and
/// never pull.
///
/// The force of a linear law falls to 0 in the share of the step that follows from the forces at its two
/// ends.
///
/// Of another law the forces of the spring act as in the engines' scheme; what is added is the impulse of the
/// dashpot, as in broken(), which acts until spring and dashpot balance: with |G| and E at an earlier time,
/// its impulse from then on is smaller than that until the end of the overlap by the factor 1 - |G|/(2 E).
/// Where the overlap ends in the next step, the spring's force of this step, which would act in two half
/// kicks, is given to this one. 0 if spring and dashpot balance for a step or longer before the overlap ends:
/// the steps then resolve the kink of the force.
template <class Law>
[[nodiscard]] inline double released(const Law &law, const StepMotion &motion) {
  const LastForces last = last_forces(law, motion);
  const double force = last.sum();
  if (!(last.dashpot < 0.0) || force <= 0.0) return 0.0;
  if constexpr (Law::is_linear) {
    const double now = law.spring_and_dashpot(motion.overlap, motion.rate_predicted());
    return now < 0.0 ? force * now / (force - now) : 0.0;
  }
  const double way = -motion.dt * motion.rate_half; // m, by which the overlap shrinks in a step
  const double share = last.overlap / way; // until the end of the overlap, above 1 if that is in the next
  if (!(motion.overlap < way) || -share * last.dashpot >= last.spring) return 0.0;
  double kick = share * last.dashpot * last.dashpot / (last.spring * (1.0 + Law::dashpot_exponent));
  if (motion.overlap > 0.0)
    kick += 2.0 * law.spring(motion.overlap) + (1.0 + law.first_weight(motion.overlap / way)) *
                                                   law.dashpot(motion.overlap) * motion.rate_predicted();
  else
    kick += (law.first_weight(share) - 1.0) * last.dashpot;
  return std::max(kick, -force);
}

/// The step in which the overlap ends. Under A the dashpot pulls just before, and its force jumps to 0 at d =
/// 0. The contact acts only for the share of the step before, but the opening half kick and the drift
/// contained its force as if it acted through the whole step: kick and shift remove the excess. All are 0
/// without a dashpot, and if there was no overlap at the beginning of the step.
template <class Law>
[[nodiscard]] inline StepResult broken(const Law &law, const StepMotion &motion) {
  if (!law.ends_in_tension()) return {0.0, released(law, motion), 0.0, 1.0};
  const LastForces last = last_forces(law, motion);
  if (!(last.dashpot < 0.0)) return {0.0, 0.0, 0.0, 1.0};
  const double share = last.overlap / (last.overlap - motion.overlap);
  const double kick = (law.first_weight(share) - 1.0) * last.dashpot;
  if constexpr (Law::begins_with_jump)
    return {0.0, kick - (1.0 - share) * last.spring, -(1.0 - share) * (1.0 - share) * last.dashpot, 1.0};
  return {0.0, kick, 0.0, 1.0};
}

} // namespace detail

/// Whether a contact neither begins nor needs to be solved for together with others in this step, given that
/// it has not ended. This holds for nearly all contacts in nearly all steps; going_on() then gives the same
/// force as advance() at less cost, for inner loops.
template <class Law>
[[nodiscard]] inline bool goes_on(const Law &law, const StepMotion &motion, const ContactState &state,
                                  const StepContext &context) {
  return state.in_contact && !context.in_setup &&
         !needs_coupling(motion.dt, law.stiffest(motion.overlap), law.dashpot(motion.overlap),
                         context.damping_over_mass);
}

/// Whether the force, N, of a contact that continues became 0 in this step, as under B at the end of a
/// contact: advance() then has more to do than going_on().
[[nodiscard]] inline bool lost_its_force(double before, double now) { return (now == 0.0) & (before > 0.0); }

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
    return was_in_contact && !context.in_setup ? detail::broken(law, motion) : StepResult{0.0, 0.0, 0.0, 1.0};
  }
  state.in_contact = true;
  if (context.in_setup) {
    if (!was_in_contact || !context.continues) state.force = law.force(motion.overlap, motion.rate_half);
    return {state.force, state.force, 0.0, 1.0};
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
  if (!needs_coupling(motion.dt, law.stiffest(motion.overlap), law.dashpot(motion.overlap),
                      context.damping_over_mass))
    return {state.force, lost_its_force(before, state.force) ? detail::released(law, motion) : state.force,
            0.0, 1.0};
  const CoupledDashpot dashpot = coupled_dashpot(law, motion, before, context.damping_over_mass);
  return {state.force, dashpot.first, 0.0, 1.0, false, true, dashpot};
}

/// One step of a contact whose law jumps within it, as where a roller comes to other soil: spring and dashpot
/// of `before` act until the jump, those of `after` for the share of the step behind it. The closing half
/// kick gives the impulse of both, and the position correction does the same for the drift, so that the step
/// is exact for constant forces:
///   kick = (1 - 2 share) F_before + 2 share F_after,
/// both forces at the end of the step, with the velocity that this half kick gives.
/// \param state of a contact that goes on, at the beginning of the step on entry and at its end on return
template <class Law>
[[nodiscard]] inline StepResult advance_over_jump(const Law &before, const Law &after, double share,
                                                  const StepMotion &motion, ContactState &state,
                                                  double m_eff) {
  const double d = motion.overlap, per_mass = 0.5 * motion.dt / m_eff;
  const double first = 1.0 - 2.0 * share, second = 2.0 * share;
  const double spring = first * before.spring(d) + second * after.spring(d);
  // Below 0 where the dashpot before is much stronger; it would then make the motion faster.
  const double dashpot = std::max(0.0, first * before.dashpot(d) + second * after.dashpot(d));
  const double rate =
      (motion.rate_predicted() - per_mass * (spring - state.force)) / (1.0 + per_mass * dashpot);
  const double force_before = before.force(d, rate);
  state.force = after.force(d, rate);
  return {state.force, first * force_before + second * state.force,
          share * share * (state.force - force_before), 1.0};
}

/// Heat of the dashpots in such a step that the trapezoidal rule misses, J. \param force_before N, stored at
/// its beginning \param kick that advance_over_jump() has returned
template <class Law>
[[nodiscard]] inline double heat_of_jump(const Law &before, const Law &after, double share,
                                         const StepMotion &motion, double force_before, double kick,
                                         double m_eff) {
  const double d = motion.overlap;
  const double rate = motion.rate_predicted() - 0.5 * motion.dt * (kick - force_before) / m_eff;
  const double change = after.force(d, rate) - after.spring(d) - before.force(d, rate) + before.spring(d);
  return motion.dt * (share - 0.5) * change * rate;
}

/// The forces of a contact with suction: a constant attraction F_a that acts while the balls touch, on top of
/// the force of the law, so that
///   Fc = (spring and dashpot under the transition condition) - F_a  for d > 0, else 0.
/// It has the potential -F_a d and so does no work over a closed cycle. ContactState::force stays the force
/// of the law without suction: it limits friction, and the implicit dashpot needs its change.
///
/// The attraction jumps where the overlap begins and where it ends. Both times are located on the parabola of
/// the overlap within the step. It acts for the share of the step in which there was an overlap: the closing
/// half kick gives what the impulse of this share is more than the opening one has given, and the position
/// correction does the same for the drift, so that the step is exact for constant forces.
/// \param step of the law alone, from advance() \param suction F_a, N, >= 0 \param before the state that
/// advance() was called with \param in_setup see StepContext
[[nodiscard]] inline StepResult with_suction(StepResult step, double suction, const StepMotion &motion,
                                             const ContactState &before, bool in_setup) {
  if (suction == 0.0) return step;
  const double start = motion.overlap_before();
  const bool continues = before.in_contact || in_setup || !came_from_apart(motion);
  const bool ends = before.in_contact && !in_setup && start > 0.0 && motion.overlap < 0.0;
  if (motion.overlap < 0.0 && !ends) return step;
  if (!ends) step.force -= suction;
  if (!ends && continues) {
    step.kick -= suction;
    return step;
  }
  const double bend = (motion.rate_half - motion.rate_before) / motion.dt;
  const double before_jump =
      detail::first_crossing(start, motion.rate_before, bend, motion.dt) / motion.dt; // share of the step
  const double after_jump = 1.0 - before_jump;
  step.kick -= (ends ? before_jump - after_jump : 2.0 * after_jump) * suction;
  step.shift += (ends ? 1.0 : -1.0) * after_jump * after_jump * suction;
  return step;
}

/// Heat of a contact's dashpot that the trapezoidal rule misses in a step through which the contact goes on,
/// J. (The rule sums the power (F - E) d' of the dashpot at the end of each step, times dt.) Half kicks and
/// drift make the spring do the work of the mean of its two forces, while its energy, and what has yielded,
/// change by the integral of E. With a dashpot, what is between them counts as heat: it changes sign where
/// the overlap is largest, and is nearly 0 in an undamped impact, but the dashpot makes the loading faster
/// than the unloading. 0 for a linear spring.
template <class Law>
[[nodiscard]] inline double heat_of_spring(const Law &law, const StepMotion &motion) {
  if constexpr (Law::is_linear) return 0.0;
  const double now = motion.overlap, before = motion.overlap_before();
  if (before <= 0.0 || law.dashpot(now) == 0.0) return 0.0;
  return 0.5 * (law.spring(now) + law.spring(before)) * (now - before) -
         (law.energy(now) - law.energy(before)) - (law.yielded(now) - law.yielded(before));
}

/// The same in any step. In that in which the contact begins or ends, the heat is the energy that the contact
/// takes from the balls and does not store, here with the accelerations that the contact causes in the half
/// kicks and those of the other forces, taken as constant. 0 without a dashpot.
/// \param before, step the state that advance() was called with, and what it returned
template <class Law>
[[nodiscard]] inline double heat_of_change(const Law &law, const StepMotion &motion,
                                           const ContactState &before, const StepResult &step, double m_eff) {
  const double dt = motion.dt, per_mass = dt / m_eff;
  const auto closing_work =
      [&](double others) { // J; others: m/s, change of the rate by other forces in half a step
        return 0.5 * dt * step.kick * (motion.rate_half + 0.5 * others - 0.25 * per_mass * step.kick);
      };
  const double slowing = motion.rate_half - motion.rate_before; // m/s, in the opening half kick
  if (step.begins) {
    const double d = motion.overlap;
    if (law.dashpot(d) == 0.0) return 0.0;
    const double spring = law.spring(d), dashpot = step.force - spring;
    const double rate = motion.rate_predicted() - 0.5 * per_mass * step.kick;
    const double corrected = 0.5 * dt * per_mass * step.shift; // m, of the overlap in the next drift
    const double next = d + dt * (rate - 0.5 * per_mass * step.force) - corrected;
    const double drift = 0.5 * (spring + (next > 0.0 ? law.spring(next) : 0.0)) * corrected;
    return closing_work(slowing) - law.energy(d) - law.yielded(d) + drift - 0.5 * dt * dashpot * rate -
           0.125 * dt * per_mass * (dashpot - spring) * step.force;
  }
  const double others = slowing + 0.5 * per_mass * before.force;
  if (motion.overlap > 0.0) // it goes on, or its force has become 0
    return heat_of_spring(law, motion) +
           (step.coupled || step.kick == step.force ? 0.0 : closing_work(others));
  const double d = motion.overlap_before();
  if (!before.in_contact || d <= 0.0 || law.dashpot(d) == 0.0) return 0.0;
  return law.energy(d) + 0.5 * dt * law.spring(d) * motion.rate_half + closing_work(others);
}

namespace detail {

/// The functions of a law that heat_of_change() calls, with the suction subtracted from the spring force.
template <class Law>
struct Attracting {
  static constexpr bool is_linear = Law::is_linear;
  const Law &law;
  double suction; ///< N
  [[nodiscard]] double dashpot(double overlap) const { return law.dashpot(overlap); }
  [[nodiscard]] double spring(double overlap) const { return law.spring(overlap) - suction; }
  [[nodiscard]] double yielded(double overlap) const { return law.yielded(overlap); }
  [[nodiscard]] double energy(double overlap) const {
    return law.energy(overlap) - suction * std::max(0.0, overlap);
  }
};

} // namespace detail

/// The same of a contact with suction, N. \param step of the law alone \param acting with_suction() of it
template <class Law>
[[nodiscard]] inline double heat_of_change(const Law &law, double suction, const StepMotion &motion,
                                           const ContactState &before, const StepResult &step,
                                           const StepResult &acting, double m_eff) {
  if (suction == 0.0 || (motion.overlap >= 0.0 && !step.begins))
    return heat_of_change(law, motion, before, step, m_eff);
  const ContactState acted{before.in_contact ? before.force - suction : 0.0, before.in_contact};
  return heat_of_change(detail::Attracting<Law>{law, suction}, motion, acted, acting, m_eff);
}

/// The same with the engines' own scheme, `stock`: the dashpot force is computed with the half-step velocity,
/// and the force acts in the closing and the next opening half kick alike.
template <class Law>
[[nodiscard]] inline StepResult advance_stock(const Law &law, const StepMotion &motion, ContactState &state) {
  state.in_contact = motion.overlap > 0.0;
  state.force = law.force(motion.overlap, motion.rate_half);
  return {state.force, state.force, 0.0, 1.0};
}

} // namespace drumlin::physics
