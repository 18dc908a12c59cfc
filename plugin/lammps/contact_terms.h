#pragma once
// One contact of two balls, or of a ball and a wall: what pair_style gran/hooke/transition and fix wall/gran/transition have in
// common. The laws are the core's; the choice among them is made at compile time.

#include "contact/contact_ledger.h"
#include "contact/contact_source.h"
#include "contact/stepped_contact.h"
#include "physics/contact_law.h"
#include "physics/friction_law.h"

#include <array>
#include <type_traits>

namespace drumlin {

/// Coefficients of a pair of types.
struct ContactCoefficients {
  physics::LinearContact normal;
  double friction = 0.0;                 ///< mu
  double tangential_stiffness = 0.0;     ///< kt, N/m
  double tangential_damping = 0.0;       ///< ct, N s/m
  double tangential_damping_share = 0.5; ///< or this share of the normal c on top

  physics::Friction tangential(double c, physics::Cap cap) const {
    return {tangential_stiffness, tangential_damping_share * c + tangential_damping, friction, cap};
  }
};

/// What pair style and walls are told by keywords.
struct ContactSettings {
  physics::Transition transition = physics::Transition::B;
  physics::Damping damping = physics::Damping::ratio;
  bool stock = false; ///< stepping
  FrictionModel tangential = FrictionModel::none;
  physics::Cap cap = physics::Cap::total;

  /// Numbers that a contact remembers: the tangential spring, then under second-order stepping the normal force.
  int history() const { return spring() + (stock ? 0 : 1); }
  int spring() const { return tangential == FrictionModel::history ? 3 : 0; }
};

/// A contact in one step.
struct Contact {
  StepContact normal;
  physics::Vec3 slip; ///< m/s, of ball i's surface relative to j's
  double arm_i, arm_j;
  double *history; ///< see ContactSettings::history(); nullptr if there is none
};

/// What a contact exerts: the force on ball i, of which j takes the opposite, and on each ball the torque -arm times moment.
struct ContactForces {
  double normal_force; ///< N, as friction takes it
  physics::Vec3 force, tangential_force;
  physics::Vec3 moment; ///< N, normal x tangential force
};

/// A copy, number by number, for what is out of line: an inner loop whose contact is copied as a whole keeps it in memory.
inline StepContact apart(const StepContact &p) {
  return {p.i,
          p.j,
          {p.normal[0], p.normal[1], p.normal[2]},
          p.wall_velocity,
          p.overlap,
          p.rate_half,
          p.k,
          p.c,
          p.m_eff,
          p.share};
}

/// What makes, breaks and heavy damping need, out of line. \param push takes the force that acts along the normal, N \returns the force that friction takes, N
[[gnu::noinline]] inline double exert_rare(physics::Transition transition, LAMMPS_NS::FixStepping &stepping,
                                           const StepContact &contact, double &record, double &push) {
  return SteppedContact(transition, stepping).exert(contact, record, [&push](double force) {
    push += force;
  });
}

/// Exerts the laws on one contact with an overlap. \param stepping nullptr under stock stepping \param moves whether the springs move on:
/// not in a set-up
template <bool stepped, FrictionModel tangential>
inline ContactForces exert(const ContactSettings &settings, const ContactCoefficients &law,
                           LAMMPS_NS::FixStepping *stepping, const Contact &p, double dt, bool moves) {
  const StepContact &n = p.normal;
  ContactForces out{};
  double push = 0.0; // along the normal, N
  if constexpr (!stepped) {
    out.normal_force = push = physics::normal_force(settings.transition, n.k, n.c, n.overlap, n.rate_half);
  } else {
    constexpr int record_place = tangential == FrictionModel::history ? 3 : 0;
    double &record = p.history[record_place];
    const physics::StepMotion motion = SteppedContact(settings.transition, *stepping).motion(n);
    if (hold(settings.transition, *stepping, n.i, n.j, motion, n.k, n.c, n.m_eff, record))
      out.normal_force = push = record;
    else {
      double acting = 0.0;
      out.normal_force = exert_rare(settings.transition, *stepping, apart(n), record, acting);
      push = acting;
    }
  }
  if constexpr (tangential != FrictionModel::none) {
    const physics::Friction friction = law.tangential(n.c, settings.cap);
    if constexpr (tangential == FrictionModel::history) {
      const physics::FrictionStep step =
          physics::friction_step(friction, out.normal_force, n.normal, p.slip,
                                 {p.history[0], p.history[1], p.history[2]}, moves ? dt : 0.0);
      if (moves) {
        p.history[0] = step.spring[0];
        p.history[1] = step.spring[1];
        p.history[2] = step.spring[2];
      }
      out.tangential_force = step.force;
    } else
      out.tangential_force =
          physics::friction_step_without_history(friction, out.normal_force, p.slip, 0.0).force;
    out.moment = physics::cross(n.normal, out.tangential_force);
  }
  out.force = physics::sum(out.tangential_force, push, n.normal);
  return out;
}

/// Force, N, on ball i of a contact under A that ended in this step.
[[gnu::noinline]] inline physics::Vec3 end_of_a(LAMMPS_NS::FixStepping &stepping,
                                                const StepContact &contact) {
  double push = 0.0;
  SteppedContact(physics::Transition::A, stepping).end(contact, [&push](double force) { push += force; });
  return {push * contact.normal[0], push * contact.normal[1], push * contact.normal[2]};
}

/// Calls run(stepped, tangential) with what the settings choose, as constants by their types.
template <class Run>
void with_models(const ContactSettings &settings, Run &&run) {
  const auto with_stepping = [&](auto tangential) {
    settings.stock ? run(std::false_type{}, tangential) : run(std::true_type{}, tangential);
  };
  switch (settings.tangential) {
  case FrictionModel::none:
    return with_stepping(std::integral_constant<FrictionModel, FrictionModel::none>{});
  case FrictionModel::no_history:
    return with_stepping(std::integral_constant<FrictionModel, FrictionModel::no_history>{});
  case FrictionModel::history:
    return with_stepping(std::integral_constant<FrictionModel, FrictionModel::history>{});
  }
}

/// Enters a contact into the ledgers that are open.
inline void enter(const ContactSettings &settings, const ContactCoefficients &law, const Contact &p,
                  const ContactForces &forces, double smaller_radius) {
  LedgerEntry entry{};
  entry.i = p.normal.i;
  entry.j = p.normal.j;
  entry.normal = p.normal.normal;
  entry.overlap = p.normal.overlap;
  entry.radius = smaller_radius;
  entry.share = p.normal.share;
  entry.normal_stiffness = p.normal.k;
  entry.normal_force = forces.normal_force;
  if (!settings.stock) entry.final_force = p.history + settings.spring();
  if (settings.spring() > 0) {
    entry.tangential_stiffness = law.tangential_stiffness;
    entry.spring = p.history;
  }
  entry.tangential_force = forces.tangential_force;
  entry.torque_i = physics::scaled(-p.arm_i, forces.moment);
  entry.torque_j = physics::scaled(-p.arm_j, forces.moment);
  for (ContactLedger *ledger : ContactLedger::open())
    ledger->enter(entry);
}

/// Tells the watchers of a contact what acts in it. \param shown with kinematics, masses and IDs; takes the stiffnesses
inline void tell(const ContactSettings &settings, const ContactCoefficients &law, const Contact &p,
                 ShownContact shown) {
  shown.normal_spring = p.normal.share * p.normal.k;
  if (settings.stock) shown.normal_dashpot = p.normal.share * p.normal.c;
  if (settings.tangential != FrictionModel::none)
    shown.tangential_dashpot = p.normal.share * law.tangential(p.normal.c, settings.cap).damping;
  if (settings.spring() > 0) shown.tangential_spring = p.normal.share * law.tangential_stiffness;
  for (ContactWatch *watch : ContactWatch::looking())
    show(*watch, shown);
}

} // namespace drumlin
