#pragma once
// The forces of one contact, shared by the pair styles and fix wall/gran/transition. The laws are those of
// plugin/physics. Law, scheme and friction model are template arguments, so that the inner loop of the pair
// style has no branches for them.

#include "contact/contact_observer.h"
#include "contact/contact_settings.h"
#include "contact/exert_contact.h"
#include "physics/laws/contact_law.h"
#include "physics/laws/friction_law.h"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

namespace drumlin {

/// A contact in one step.
struct WallContact {
  StepContact normal;
  physics::Vec3 slip;          ///< m/s, of ball i's surface relative to j's
  double r_eff;                ///< m, effective radius; 0 for a law that does not depend on it
  double arm_i, arm_j;         ///< m, from the centre of each ball to the point where friction acts
  double *history;             ///< what the contact remembers,
  const HistoryPlaces *places; ///< and where its numbers are
  double memory;               ///< for its law, at the beginning of the step
  bool in_contact;             ///< in the step before

  /// What it remembers, which must be stored.
  double *stored(Remembered what) const { return history + (*places)[what]; }
};

/// The force of a contact on ball i, of which j gets the opposite. The torque on each ball is -arm times
/// moment, plus that of rolling resistance.
struct ContactForces {
  double normal_force; ///< N, at the end of the step, used for friction
  physics::Vec3 force, tangential_force;
  physics::Vec3 moment;        ///< N, normal x tangential force
  physics::Vec3 rolling;       ///< N m, torque of rolling resistance on ball i, of which j gets the opposite
  double tangential_stiffness; ///< N/m; 0 without friction and rolling resistance
  LAMMPS_NS::FixStepping::Coupled *coupled; ///< nullptr: the contact is not coupled
  LAMMPS_NS::FixStepping::Begun *begun;     ///< nullptr: the contact does not begin in this step

  /// Where friction and rolling resistance are described, of a contact that is coupled or begins; nullptr for
  /// others.
  LAMMPS_NS::FixStepping::Rubbing *rubbing() const {
    return coupled != nullptr ? static_cast<LAMMPS_NS::FixStepping::Rubbing *>(coupled) : begun;
  }
};

/// The order in which a contact's numbers are stored, which restart files have.
constexpr std::array<Remembered, 5> history_order{Remembered::spring, Remembered::stiffness,
                                                  Remembered::force, Remembered::rolling_spring,
                                                  Remembered::memory};

/// Tangential stiffness of one contact in a step, N/m. \param moves see exert()
template <class Parameters>
inline double tangential_stiffness(const Parameters &contact, const WallContact &p, double dt, bool moves) {
  const StepContact &n = p.normal;
  if constexpr (!Parameters::tangential_varies) return contact.tangential(n.overlap, p.r_eff);
  const double kt = contact.tangential(physics::overlap_of_spring(n.overlap, n.rate_half, dt), p.r_eff);
  return follow_stiffness(*p.places, p.history, kt, moves);
}

/// Time, s, of a step for which a spring of a contact is stretched: see physics::time_in_contact(). \param
/// moves see exert()
inline double time_of_spring(const WallContact &p, double dt, bool moves) {
  if (!moves) return 0.0;
  return p.in_contact ? dt : physics::time_in_contact(p.normal.overlap, p.normal.rate_half, dt);
}

/// Computes the forces of one contact whose surfaces overlap, and updates its history.
/// \param stepping nullptr under `stepping stock`
/// \param moves whether the tangential spring is advanced by a step: false in the set-up of a run
template <bool stepped, FrictionModel tangential, bool rolling, class Parameters>
inline ContactForces exert(const ContactSettings &settings,
                           const ContactCoefficients<Parameters> &coefficients,
                           LAMMPS_NS::FixStepping *stepping, const WallContact &p, double dt, bool moves) {
  const StepContact &n = p.normal;
  auto law = coefficients.contact.law(n.m_eff, p.r_eff, p.memory);
  ContactForces out{};
  physics::ContactState state;
  double push = 0.0; // along the normal, N
  if constexpr (!stepped) {
    push = physics::advance_stock(law, {n.overlap, n.rate_half, n.rate_half, dt}, state).kick;
  } else {
    double &stored_force = *p.stored(Remembered::force);
    state.force = stored_force;
    state.in_contact = p.in_contact;
    if (hold_contact(law, *stepping, n.i, n.j, n.normal, step_motion(*stepping, n), n.m_eff, n.share, state))
      push = state.force;
    else {
      physics::ContactState rare{state.force, state.in_contact};
      push = exert_contact(law, *stepping, n, rare, stored_force);
      state.force = rare.force;
      out.coupled = stepping->coupled_at(&stored_force);
      out.begun = stepping->begun_at(&stored_force);
    }
    stored_force = state.force;
  }
  out.normal_force = state.force;
  if constexpr (Parameters::remembers) {
    law.remember(n.overlap);
    *p.stored(Remembered::memory) = law.memory();
  }
  constexpr bool rubs = tangential != FrictionModel::none;
  if constexpr (rubs || rolling)
    out.tangential_stiffness = tangential_stiffness(coefficients.contact, p, dt, moves);
  if constexpr (rubs) {
    const physics::Friction friction =
        coefficients.tangential(out.tangential_stiffness, law.dashpot(n.overlap), settings.cap);
    if constexpr (tangential == FrictionModel::history) {
      double *const spring = p.stored(Remembered::spring);
      const physics::FrictionStep step = physics::friction_step(
          friction, out.normal_force, n.normal, p.slip, {spring[0], spring[1], spring[2]},
          settings.cap == physics::Cap::coulomb ? time_of_spring(p, dt, moves)
          : moves                               ? dt
                                                : 0.0);
      if (moves) std::copy_n(step.spring.begin(), 3, spring);
      out.tangential_force = step.force;
    } else
      out.tangential_force =
          physics::friction_step_without_history(friction, out.normal_force, p.slip, 0.0).force;
    if (out.begun != nullptr || (out.coupled != nullptr && settings.cap == physics::Cap::coulomb)) {
      LAMMPS_NS::FixStepping::Rubbing &rubbing = *out.rubbing();
      rubbing.friction = friction;
      rubbing.rub = out.tangential_force;
      rubbing.slip = p.slip;
      rubbing.arm_i = p.arm_i;
      rubbing.arm_j = p.arm_j;
      if (tangential == FrictionModel::history) rubbing.spring = p.stored(Remembered::spring);
    }
    out.moment = physics::cross(n.normal, out.tangential_force);
  }
  out.force = physics::sum(out.tangential_force, push, n.normal);
  return out;
}

/// Calls run(stepped, tangential, rolling) with the scheme, the friction model and the presence of rolling
/// resistance of the settings as compile-time constants (std::integral_constant).
template <class Run>
void with_models(const ContactSettings &settings, Run &&run) {
  const auto with_stepping = [&](auto tangential) {
    const auto with_rolling = [&](auto stepped) {
      settings.rolling ? run(stepped, tangential, std::true_type{})
                       : run(stepped, tangential, std::false_type{});
    };
    settings.stock ? with_rolling(std::false_type{}) : with_rolling(std::true_type{});
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

/// The record of a contact for observers. \param radius of the smaller ball, m \param rolling_radius
/// effective, m
template <class Parameters>
ContactRecord record_of(const ContactSettings &settings, const ContactCoefficients<Parameters> &coefficients,
                        const WallContact &p, const ContactForces &forces, double radius,
                        double rolling_radius) {
  const double memory = Parameters::remembers ? *p.stored(Remembered::memory) : 0.0;
  const auto law = coefficients.contact.law(p.normal.m_eff, p.r_eff, memory);
  ContactRecord record = record_of_law(law, p.normal.overlap, !settings.stock);
  record.i = p.normal.i;
  record.j = p.normal.j;
  record.normal = p.normal.normal;
  record.radius = radius;
  record.share = p.normal.share;
  if (settings.tangential != FrictionModel::none)
    record.tangential_dashpot = coefficients.tangential_dashpot(law.dashpot(p.normal.overlap));
  if (settings.has_spring()) {
    record.tangential_stiffness = forces.tangential_stiffness;
    record.spring = p.stored(Remembered::spring);
  }
  record.normal_force = forces.normal_force;
  if (!settings.stock) record.final_force = p.stored(Remembered::force);
  if (forces.coupled != nullptr) record.change = &forces.coupled->change;
  record.tangential_force = forces.tangential_force;
  record.torque_i = physics::sum(forces.rolling, -p.arm_i, forces.moment);
  record.torque_j = physics::sum(physics::scaled(-1.0, forces.rolling), -p.arm_j, forces.moment);
  if (settings.rolling)
    record.rolling_stiffness =
        coefficients.rolling_resistance(forces.tangential_stiffness, rolling_radius).stiffness;
  return record;
}

/// Base of the fixes that are walls with the law of the pair style.
class Walls {
public:
  /// Type, 1 to ntypes, of the pair_coeff lines that hold for the wall.
  virtual int wall_type() const = 0;
  /// Largest number of contacts that a ball may have with the fix at once.
  virtual int sides() const = 0;

protected:
  ~Walls() = default;
};

} // namespace drumlin
