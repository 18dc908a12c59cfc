#pragma once
// The second-order scheme in an engine's loop over contacts: collects the arguments of physics::advance()
// from FixStepping, and applies its result to the balls. Shared by the adapters of both engines.

#include "contact/contact_history.h"
#include "contact/fix_stepping.h"
#include "physics/scheme/advance.h"

#include <algorithm>
#include <array>
#include <limits>

namespace drumlin {

/// One contact, as the loop of an engine's pair style or wall describes it.
struct StepContact {
  int i, j;                     ///< balls, owned or ghosts; j < 0: a wall
  std::array<double, 3> normal; ///< unit vector from j to i
  const double *wall_velocity;  ///< m/s, of a wall; nullptr: at rest
  double overlap;               ///< m
  double rate_half; ///< of the overlap, m/s, with the half-step velocities v+, which the engine has here
  double m_eff;     ///< kg, of the contact law
  double share;     ///< part of the force that acts: 1, or less where triangles of a mesh share it
};

/// Rate of the overlap with the velocities at the beginning of the step, m/s.
inline double rate_before(const LAMMPS_NS::FixStepping &stepping, int i, const double *v_j,
                          const std::array<double, 3> &normal) {
  const double *v_i = stepping.velocity_before(i);
  return -((v_i[0] - v_j[0]) * normal[0] + (v_i[1] - v_j[1]) * normal[1] + (v_i[2] - v_j[2]) * normal[2]);
}

inline physics::StepMotion step_motion(const LAMMPS_NS::FixStepping &stepping, const StepContact &p) {
  static constexpr double still[3] = {};
  const double *v_j = p.j >= 0                     ? stepping.velocity_before(p.j)
                      : p.wall_velocity != nullptr ? p.wall_velocity
                                                   : still;
  return {p.overlap, p.rate_half, rate_before(stepping, p.i, v_j, p.normal), stepping.dt()};
}

/// \param j below 0: a wall
inline physics::StepContext step_context(const LAMMPS_NS::FixStepping &stepping, int i, int j, double m_eff) {
  return {m_eff, stepping.damping_over_mass(i) + (j < 0 ? 0.0 : stepping.damping_over_mass(j)),
          stepping.in_setup()};
}

/// The tangential stiffness of a contact in a step, N/m, of a law in which it varies: the springs that the
/// contact remembers follow its change. \param kt at the overlap of this step \param moves false in the
/// set-up of a run and for computes: it is that of the step before, if there was one
inline double follow_stiffness(const HistoryPlaces &places, double *history, double kt, bool moves) {
  if (places[Remembered::stiffness] < 0) return kt;
  double &before = history[places[Remembered::stiffness]];
  if (!moves) return before > 0.0 ? before : kt;
  const auto keep = [&](Remembered spring, double share) {
    for (int a = 0; places[spring] >= 0 && a < 3; ++a)
      history[places[spring] + a] *= share;
  };
  keep(Remembered::spring, physics::kept_spring(before, kt));
  keep(Remembered::rolling_spring, physics::kept_torque(before, kt));
  before = kt;
  return kt;
}

/// Adds the damping coefficient c, N s/m, of a contact to the sums of its balls, which the next step uses;
/// does nothing in steps in which FixStepping does not need them.
inline void count(LAMMPS_NS::FixStepping &stepping, int i, int j, double c) {
  if (!stepping.counting()) return;
  stepping.add_damping(i, c);
  if (j >= 0) stepping.add_damping(j, c);
}

/// physics::advance() for a contact that continues (physics::goes_on()), for inner loops.
/// \param j below 0: a wall \param share see StepContact \returns false, and changes nothing, in all other
/// situations: the caller then calls exert_contact()
template <class Law>
inline bool hold_contact(const Law &law, LAMMPS_NS::FixStepping &stepping, int i, int j,
                         const std::array<double, 3> &normal, const physics::StepMotion &motion, double m_eff,
                         double share, physics::ContactState &state) {
  if (!state.in_contact) return false;
  m_eff = stepping.moving_mass(i, j, normal, m_eff);
  if (!stepping.light() && !physics::goes_on(law, motion, state, step_context(stepping, i, j, m_eff)))
    return false;
  const double force = physics::going_on(law, motion, state.force, m_eff);
  if (physics::lost_its_force(state.force, force)) return false;
  state.force = force;
  if constexpr (!Law::is_linear)
    if (stepping.counts_heat()) stepping.tell_heat(i, j, share * physics::heat_of_spring(law, motion), 0.0);
  if (stepping.counting()) count(stepping, i, j, law.dashpot(motion.overlap));
  return true;
}

/// Passes a dashpot to FixStepping, which solves for it when all forces of the step are known.
inline void couple(LAMMPS_NS::FixStepping &stepping, const StepContact &p,
                   const physics::CoupledDashpot &dashpot, double &stored_force) {
  LAMMPS_NS::FixStepping::Coupled &contact = stepping.couple();
  contact.i = p.i;
  contact.j = p.j;
  contact.normal = p.normal;
  contact.dashpot = dashpot;
  if (p.wall_velocity != nullptr)
    contact.dashpot.at_rest +=
        dashpot.per_rate * (p.wall_velocity[0] * p.normal[0] + p.wall_velocity[1] * p.normal[1] +
                            p.wall_velocity[2] * p.normal[2]);
  contact.share = p.share;
  contact.force = &stored_force;
}

/// Passes to FixStepping the forces that act after the closing half kick: the rest of the force up to
/// StepResult::force, for the next opening half kick, and the position correction.
inline void exert_later(LAMMPS_NS::FixStepping &stepping, const StepContact &p,
                        const physics::StepResult &step) {
  if (step.coupled || (step.kick == step.force && step.shift == 0.0)) return;
  const double rest = p.share * step.force - p.share * step.kick;
  const double shift = p.share * step.shift;
  const auto later = [&](int ball, double sign) {
    stepping.add_after_kick(
        ball, {sign * rest * p.normal[0], sign * rest * p.normal[1], sign * rest * p.normal[2]},
        {sign * shift * p.normal[0], sign * shift * p.normal[1], sign * shift * p.normal[2]});
  };
  later(p.i, 1.0);
  if (stepping.takes(p.j)) later(p.j, -1.0);
}

/// Applies the second-order scheme to one contact, in any situation. Not inlined: most contacts are treated
/// by hold_contact() in most steps.
/// \param state of the step before on entry, of this step on return
/// \param stored_force where the contact's history keeps ContactState::force; for a coupled contact the force
/// is written there when all forces of the step are known
/// \returns the force, N, of the closing half kick, StepContact::share included, along the normal on ball i
template <class Law>
[[gnu::noinline]] double exert_contact(const Law &law, LAMMPS_NS::FixStepping &stepping, const StepContact &p,
                                       physics::ContactState &state, double &stored_force) {
  const physics::ContactState before = state;
  const double m_eff = stepping.moving_mass(p.i, p.j, p.normal, p.m_eff);
  const physics::StepMotion motion = step_motion(stepping, p);
  const physics::StepResult step =
      physics::advance(law, motion, state, step_context(stepping, p.i, p.j, m_eff));
  const std::size_t announced = stepping.announced();
  exert_later(stepping, p, step);
  if (step.coupled) couple(stepping, p, step.dashpot, stored_force);
  if (step.begins) {
    LAMMPS_NS::FixStepping::Begun &contact = stepping.begin();
    contact.i = p.i;
    contact.j = p.j;
    contact.normal = p.normal;
    contact.share = p.share;
    contact.force = &stored_force;
    contact.step = step;
    contact.announced = announced;
  }
  if (stepping.counts_heat())
    stepping.tell_heat(p.i, p.j, p.share * physics::heat_of_change(law, motion, before, step, m_eff), 0.0);
  if (state.in_contact) count(stepping, p.i, p.j, law.dashpot(p.overlap));
  return p.share * step.kick;
}

/// The step in which a contact ends. \param contact a copy, whose overlap is made negative even if rounding
/// has left 0 \returns the force of the closing half kick along the normal, N
template <class Law>
[[nodiscard]] double end_contact(const Law &law, LAMMPS_NS::FixStepping &stepping, StepContact contact,
                                 double stored_force) {
  // In this order the result is negative even if the overlap is not a number.
  contact.overlap = std::min(-std::numeric_limits<double>::min(), contact.overlap);
  physics::ContactState state{stored_force, true};
  return exert_contact(law, stepping, contact, state, stored_force);
}

} // namespace drumlin
