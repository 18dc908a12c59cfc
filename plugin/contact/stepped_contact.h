#pragma once
// What second-order stepping does with one contact of a step, and what a contact tells those who watch: the part of an engine's
// adapter that does not depend on the engine.

#include "contact/contact_watch.h"
#include "contact/fix_stepping.h"
#include "physics/contact_law.h"
#include "physics/stepping.h"

#include <algorithm>
#include <array>

namespace drumlin {

/// One contact as an engine's loop meets it.
struct StepContact {
  int i, j;                     ///< balls, owned or ghosts; j < 0: a wall
  std::array<double, 3> normal; ///< unit vector from j to i
  const double *wall_velocity;  ///< m/s, of a wall; nullptr: at rest
  double overlap;               ///< m
  double rate_half; ///< m/s, of the overlap, with the velocities that the engine has in the middle of a step
  double k, c, m_eff; ///< N/m, N s/m, kg
  double share;       ///< of the force that acts: 1 but for a mesh
};

/// Rate of the overlap with the velocities at the begin of the step, m/s.
inline double rate_before(const LAMMPS_NS::FixStepping &stepping, int i, const double *v_j,
                          const std::array<double, 3> &normal) {
  const double *v_i = stepping.velocity_before(i);
  return -((v_i[0] - v_j[0]) * normal[0] + (v_i[1] - v_j[1]) * normal[1] + (v_i[2] - v_j[2]) * normal[2]);
}

/// Nearly all contacts of nearly all steps: one that goes on, and need not know of the other dashpots of its balls. For inner loops.
/// \param j below 0: a wall \param record the normal force, N, of the step before; takes that of this step, which acts
/// \returns false if it is none of these: then nothing is done, and SteppedContact::exert() does it
inline bool hold(physics::Transition transition, LAMMPS_NS::FixStepping &stepping, int i, int j,
                 const physics::StepMotion &motion, double k, double c, double m_eff, double &record) {
  if (!physics::was_contact(record)) return false;
  if (!stepping.light()) {
    const double all = stepping.damping_over_mass(i) + (j < 0 ? 0.0 : stepping.damping_over_mass(j));
    if (stepping.in_setup() || physics::needs_coupling(motion.dt, k, c, all)) return false;
    if (stepping.counting()) {
      stepping.add_damping(i, c);
      if (j >= 0) stepping.add_damping(j, c);
    }
  }
  record = physics::second_order_held(transition, k, c, motion, record, c / m_eff);
  return true;
}

/// Second-order stepping of contacts under one transition condition.
class SteppedContact {
public:
  SteppedContact(physics::Transition transition, LAMMPS_NS::FixStepping &stepping)
      : transition_(transition), stepping_(stepping) {}

  physics::StepMotion motion(const StepContact &p) const {
    static constexpr double still[3] = {};
    const double *v_j = p.j >= 0                     ? stepping_.velocity_before(p.j)
                        : p.wall_velocity != nullptr ? p.wall_velocity
                                                     : still;
    return {p.overlap, p.rate_half, rate_before(stepping_, p.i, v_j, p.normal), stepping_.dt()};
  }

  /// Any contact with an overlap in any step. \param record the normal force of the step before, 0: none; takes that of this step, at the
  /// latest when all forces are known \param push (N): exerts a force along the normal on both balls, scaled with nothing
  /// \returns the force that friction and rolling take, N: the one that the contact would have alone
  template <class Push>
  double exert(const StepContact &p, double &record, Push &&push) const {
    using namespace physics;
    const StepMotion now = motion(p);
    const double all = damping_over_mass(p);
    if (stepping_.in_setup()) { // velocities belong to the time of the positions
      record = limited(transition_, normal_force(transition_, p.k, p.c, now.overlap, now.rate_half));
      push(p.share * record);
    } else {
      // No record although the contact is older than this step: a mesh contact went over to another triangle.
      const double old =
          was_contact(record)
              ? record
              : normal_force(transition_, p.k, p.c, now.overlap - now.dt * now.rate_half, now.rate_before);
      const StepForce step = second_order_force(transition_, p.k, p.c, now, old, p.c / p.m_eff);
      record = step.force;
      if (needs_coupling(now.dt, p.k, p.c, all) && !made_in_step(now, old)) {
        const CoupledDashpot dashpot = coupled_dashpot(transition_, p.k, p.c, now, old, all);
        push(p.share * dashpot.first);
        couple(p, dashpot, record);
      } else
        apply(p, step, push);
    }
    if (stepping_.counting()) {
      stepping_.add_damping(p.i, p.c);
      if (p.j >= 0) stepping_.add_damping(p.j, p.c);
    }
    return record;
  }

  /// A pair without overlap, which may have ended in this step: under A its tensile force acted for part of it. `push` as above.
  /// \returns whether it did end
  template <class Push>
  bool end(const StepContact &p, Push &&push) const {
    const physics::StepMotion now = motion(p);
    if (physics::came_from_apart(now)) return false; // all along
    apply(p, physics::second_order_break(transition_, p.k, p.c, now), push);
    return true;
  }

private:
  /// Sum of c/m over all contacts of both balls, 1/s.
  double damping_over_mass(const StepContact &p) const {
    return stepping_.damping_over_mass(p.i) + (p.j < 0 ? 0.0 : stepping_.damping_over_mass(p.j));
  }

  /// Leaves a dashpot to be solved for when all forces of the step are known.
  void couple(const StepContact &p, const physics::CoupledDashpot &dashpot, double &record) const {
    LAMMPS_NS::FixStepping::Coupled &contact = stepping_.couple();
    contact.i = p.i;
    contact.j = p.j;
    contact.normal = p.normal;
    contact.dashpot = dashpot;
    if (p.wall_velocity != nullptr)
      contact.dashpot.at_rest +=
          dashpot.per_rate * (p.wall_velocity[0] * p.normal[0] + p.wall_velocity[1] * p.normal[1] +
                              p.wall_velocity[2] * p.normal[2]);
    contact.share = p.share;
    contact.force = &record;
  }

  /// Exerts the force of the closing half kick, and has the rest exerted after it.
  template <class Push>
  void apply(const StepContact &p, const physics::StepForce &step, Push &&push) const {
    const double kick = p.share * step.kick;
    push(kick);
    if (step.kick == step.force && step.shift == 0.0) return;
    const double rest = p.share * step.force - kick;
    const double shift = p.share * step.shift;
    const auto later = [&](int ball, double sign) {
      stepping_.add_after_kick(
          ball, {sign * rest * p.normal[0], sign * rest * p.normal[1], sign * rest * p.normal[2]},
          {sign * shift * p.normal[0], sign * shift * p.normal[1], sign * shift * p.normal[2]});
    };
    later(p.i, 1.0);
    if (stepping_.takes(p.j)) later(p.j, -1.0);
  }

  const physics::Transition transition_;
  LAMMPS_NS::FixStepping &stepping_;
};

/// One contact for those who watch.
struct ShownContact {
  int i, j;                      ///< j < 0: a wall
  int tag_i, tag_j;              ///< 0 for a wall
  bool tells_j;                  ///< of ball j, too: it is no ghost whose owner tells of the contact
  double inverse_mi, inverse_mj; ///< 1/kg, 0 if fixed
  double ri, rj;                 ///< m; of a wall the ball's
  double overlap;                ///< m
  const double *normal;
  double mass_over_inertia; ///< m r^2 / I of the balls
  // What acts in the contact, 0 if nothing does: N/m, N s/m
  double normal_spring, normal_dashpot, tangential_spring, tangential_dashpot;
  double rolling_spring_share; ///< of kt r_eff^2, N m
};

inline void show(ContactWatch &watch, const ShownContact &p) {
  const double inverse_masses = p.inverse_mi + p.inverse_mj;
  if (inverse_masses == 0.0) return;
  const double inverse_mt = 1.0 / physics::tangential_mass(p.inverse_mi, p.inverse_mj, p.mass_over_inertia);
  physics::LinkModes modes;
  std::copy_n(p.normal, 3, modes.normal.begin());
  modes.normal_spring = p.normal_spring * inverse_masses;
  modes.normal_dashpot = p.normal_dashpot * inverse_masses;
  modes.tangential_spring = p.tangential_spring * inverse_mt;
  modes.tangential_dashpot = p.tangential_dashpot * inverse_mt;
  if (p.rolling_spring_share != 0.0) {
    const double r_eff = p.j < 0 ? p.ri : p.ri * p.rj / (p.ri + p.rj);
    modes.rolling_spring = p.rolling_spring_share * r_eff * r_eff * p.mass_over_inertia *
                           (p.inverse_mi / (p.ri * p.ri) + p.inverse_mj / (p.rj * p.rj));
  }
  const double overlap = p.overlap / std::min(p.ri, p.rj);
  const auto see = [&](int ball, int partner, double own, double other, double r_own, double r_other) {
    modes.burden = physics::link_burden(own, other);
    modes.rolling_burden = physics::link_burden(own / (r_own * r_own), other / (r_other * r_other));
    watch.see(ball, partner, modes, overlap);
  };
  if (p.inverse_mi > 0.0) see(p.i, p.tag_j, p.inverse_mi, p.inverse_mj, p.ri, p.rj);
  if (p.inverse_mj > 0.0 && p.tells_j) see(p.j, p.tag_i, p.inverse_mj, p.inverse_mi, p.rj, p.ri);
}

} // namespace drumlin
