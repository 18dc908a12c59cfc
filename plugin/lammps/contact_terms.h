#pragma once
// One contact of two balls, or of a ball and a wall: what pair_style gran/hooke/transition and fix wall/gran/transition have in
// common. The laws are the core's; the choice among them is made at compile time.

#include "fixes/contact_ledger.h"
#include "fixes/contact_source.h"
#include "fixes/stepped_contact.h"
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

/// Forces of a contact, on ball i; j takes the opposite force.
struct ContactForces {
  double normal_force; ///< N, as friction takes it
  physics::Vec3 force, tangential_force;
  physics::Vec3 torque_i, torque_j; ///< N m
};

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
    const SteppedContact contact(settings.transition, *stepping);
    const physics::StepMotion motion = contact.motion(n);
    // Nearly all contacts of nearly all steps.
    if (stepping->light() && record != 0.0 && !physics::made_in_step(motion))
      out.normal_force = push = record =
          physics::second_order_held(settings.transition, n.k, n.c, motion, record, n.c / n.m_eff);
    else
      out.normal_force = contact.exert(n, record, [&push](double force) { push += force; });
  }
  if constexpr (tangential != FrictionModel::none) {
    const physics::Friction friction = law.tangential(n.c, settings.cap);
    const physics::Vec3 normal{n.normal[0], n.normal[1], n.normal[2]};
    if constexpr (tangential == FrictionModel::history) {
      const physics::FrictionStep step =
          physics::friction_step(friction, out.normal_force, normal, p.slip,
                                 {p.history[0], p.history[1], p.history[2]}, moves ? dt : 0.0);
      if (moves) std::copy_n(step.spring.begin(), 3, p.history);
      out.tangential_force = step.force;
    } else
      out.tangential_force =
          physics::friction_step_without_history(friction, out.normal_force, p.slip, 0.0).force;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3;
      const std::size_t c = (a + 2) % 3;
      const double moment = normal[b] * out.tangential_force[c] - normal[c] * out.tangential_force[b];
      out.torque_i[a] = -p.arm_i * moment;
      out.torque_j[a] = -p.arm_j * moment;
    }
  }
  for (std::size_t a = 0; a < 3; ++a)
    out.force[a] = push * n.normal[a] + out.tangential_force[a];
  return out;
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
  std::copy_n(p.normal.normal, 3, entry.normal.begin());
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
  entry.torque_i = forces.torque_i;
  entry.torque_j = forces.torque_j;
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
