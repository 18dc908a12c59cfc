#pragma once
// The loop over the contacts of balls in a step, for the pair styles of both engines.

#include "contact/contact_settings.h"
#include "contact/stepped_contact.h"
#include "engine.h"
#include "physics/contact_block.h"

#include <algorithm>

namespace drumlin {

/// Where in a contact's history its numbers are.
struct HistoryPlaces {
  int spring;    ///< of friction: three numbers
  int stiffness; ///< tangential stiffness, where that varies and a spring depends on it
  int force;     ///< normal force; second-order scheme only
  int rolling;   ///< torque of rolling resistance: three numbers
  int count;     ///< numbers of the contact law in the history of a contact
  int stride;    ///< from a contact's history to the next, at least `count`
};

/// A contact of a block.
struct BlockContact {
  int i, j;
  int *flag;       ///< of the engine, see ContactLoop
  double *history; ///< see HistoryPlaces
  bool touches;    ///< false in the step in which the contact ends
};

/// What exerts a contact's forces on its balls. The torque on each ball is -arm times moment, plus the torque
/// of rolling resistance, which ball j gets in the other direction, as it does the force.
struct ExertedForces {
  physics::Vec3 force, moment, rolling;
  double arm_i, arm_j;
};

/// Collects contacts from the neighbour list into blocks, computes the forces of each block, and adds them to
/// the balls one after the other in the order of the list: sums are the same whatever the blocks are.
/// `Engine` is the adapter, with these functions:
///   flags(i), histories(i)    of the contacts of ball i: whether they touched, and the numbers stored
///   touched(flag, history)    whether the balls touched in the step before
///   mark(flag, history, touches)  stores that for the next step
///   effective_mass(i, j)      kg
///   exert(block, n, contact, forces)  adds forces to the balls, and reports them to who observes them
///   finish()                  called after the last contact
template <class Engine, class Parameters, bool stepped, FrictionModel tangential, bool rolling>
class ContactLoop {
public:
  /// \param stepping nullptr under `stepping stock`
  ContactLoop(Engine &engine, const LAMMPS_NS::Atom &atom, const CoefficientTable<Parameters> &table,
              const HistoryPlaces &places, physics::Cap cap, LAMMPS_NS::FixStepping *stepping, double dt,
              bool moves)
      : engine_(engine), atom_(atom), table_(table), places_(places), cap_(cap), stepping_(stepping), dt_(dt),
        moves_(moves), light_(stepped && stepping->light()), in_setup_(stepped && stepping->in_setup()) {}

  void run(const LAMMPS_NS::NeighList &list) {
    for (int ii = 0; ii < list.inum; ++ii) {
      const int i = list.ilist[ii];
      collect(i, list.firstneigh[i], list.numneigh[i]);
    }
    exert();
    engine_.finish();
  }

private:
  using Vec3 = physics::Vec3;
  using Cap = physics::Cap;
  static constexpr bool rubs = tangential != FrictionModel::none;
  static constexpr bool springs = tangential == FrictionModel::history;
  static constexpr bool stores_stiffness = Parameters::tangential_varies && (springs || rolling);
  static constexpr bool remembers = stepped || rolling || springs;

  /// The vector of a ball. Vectors follow one another in memory: this spares a pointer per ball.
  static const double *vector_of(double *const *vectors, int i) {
    return vectors[0] + static_cast<std::ptrdiff_t>(i) * 3;
  }

  /// Puts the neighbours that touch ball i, or did a step ago, into blocks. Each neighbour is written to the
  /// next place, which is kept or overwritten: no jump depends on whether the balls touch, which processors
  /// cannot predict.
  void collect(int i, const int *neighbours, int count) {
    const double *const xi = vector_of(atom_.x, i);
    const Vec3 position{xi[0], xi[1], xi[2]};
    const double ri = atom_.radius[i];
    int *const flags = remembers ? engine_.flags(i) : nullptr;
    double *const histories = remembers ? engine_.histories(i) : nullptr;
    for (int jj = 0; jj < count; ++jj) {
      const int j = engine::neighbour_index(neighbours[jj]);
      const double *const xj = vector_of(atom_.x, j);
      const Vec3 separation{position[0] - xj[0], position[1] - xj[1], position[2] - xj[2]};
      const double squared = physics::dot(separation, separation);
      const double rj = atom_.radius[j];
      const bool touches = squared < (ri + rj) * (ri + rj);
      const int n = count_;
      contacts_[n] = {i, j, remembers ? flags + jj : nullptr,
                      remembers ? histories + static_cast<std::ptrdiff_t>(places_.stride) * jj : nullptr,
                      touches};
      block_.separation.set(n, separation);
      block_.squared[n] = squared;
      block_.ri[n] = ri;
      block_.rj[n] = rj;
      count_ += static_cast<int>(touches) | static_cast<int>(remembers && flags[jj] != 0);
      if (count_ == physics::block_size) exert();
    }
  }

  /// Reads what is known of a contact of the block.
  void take(int n) {
    const BlockContact &contact = contacts_[n];
    coefficients_[n] = &table_.at(atom_.type[contact.i], atom_.type[contact.j]);
    take_motion(n, contact.i, contact.j);
    if constexpr (remembers) {
      block_.in_contact[n] = engine_.touched(*contact.flag, contact.history) ? 1.0 : 0.0;
      take_history(n, contact.history);
      engine_.mark(*contact.flag, contact.history, contact.touches);
    }
  }

  void take_motion(int n, int i, int j) {
    const double *const vi = vector_of(atom_.v, i), *const vj = vector_of(atom_.v, j);
    block_.velocity.set(n, {vi[0] - vj[0], vi[1] - vj[1], vi[2] - vj[2]});
    block_.m_eff[n] = engine_.effective_mass(i, j);
    if constexpr (rubs || rolling) {
      const double *const wi = vector_of(atom_.omega, i), *const wj = vector_of(atom_.omega, j);
      block_.wi.set(n, {wi[0], wi[1], wi[2]});
      block_.wj.set(n, {wj[0], wj[1], wj[2]});
    }
    if constexpr (stepped) {
      const double *const before_i = stepping_->velocity_before(i);
      const double *const before_j = stepping_->velocity_before(j);
      block_.velocity_before.set(
          n, {before_i[0] - before_j[0], before_i[1] - before_j[1], before_i[2] - before_j[2]});
      block_.damping_over_mass[n] = stepping_->damping_over_mass(i) + stepping_->damping_over_mass(j);
    }
  }

  void take_history(int n, const double *history) {
    if constexpr (springs) block_.spring.set(n, vector_at(history, places_.spring));
    if constexpr (stores_stiffness) block_.stored_stiffness[n] = history[places_.stiffness];
    if constexpr (stepped) block_.force_before[n] = history[places_.force];
    if constexpr (rolling) block_.rolling_spring.set(n, vector_at(history, places_.rolling));
  }

  static Vec3 vector_at(const double *history, int place) {
    return {history[place], history[place + 1], history[place + 2]};
  }

  /// Computes the forces of the block, adds them to the balls and empties the block.
  void exert() {
    for (int n = 0; n < count_; ++n)
      take(n);
    for (int first = 0, end = 0; first < count_; first = end) { // contacts of the same types
      while (end < count_ && coefficients_[end] == coefficients_[first])
        ++end;
      compute(first, end);
    }
    for (int n = 0; n < count_; ++n)
      exert(n);
    count_ = 0;
  }

  /// Computes the forces of some contacts of the block.
  void compute(int first, int end) {
    const ContactCoefficients<Parameters> &law = *coefficients_[first];
    if constexpr (!rubs)
      physics::compute_normal_forces<stepped, physics::Slip::none>(block_, first, end, law.contact, dt_);
    else if (moves_ && cap_ == Cap::coulomb)
      physics::compute_normal_forces<stepped, physics::Slip::in_middle>(block_, first, end, law.contact, dt_);
    else
      physics::compute_normal_forces<stepped, physics::Slip::at_end>(block_, first, end, law.contact, dt_);
    if constexpr (stepped)
      for (int n = first; n < end; ++n)
        exert_unless_it_goes_on(n, law.contact);
    if constexpr (rubs || rolling) {
      if (moves_)
        physics::compute_tangential_stiffness<springs, rolling, true>(block_, first, end, law.contact, dt_);
      else
        physics::compute_tangential_stiffness<springs, rolling, false>(block_, first, end, law.contact, dt_);
    }
    const double dt = moves_ ? dt_ : 0.0; // a step of no length leaves springs as they are
    if constexpr (springs)
      rub_with_spring(first, end, law, dt);
    else if constexpr (rubs)
      physics::compute_friction<false, Cap::total>(block_, first, end, law, dt);
    if constexpr (rolling) physics::compute_rolling(block_, first, end, law, dt);
  }

  void rub_with_spring(int first, int end, const ContactCoefficients<Parameters> &law, double dt) {
    switch (cap_) {
    case Cap::spring:
      return physics::compute_friction<true, Cap::spring>(block_, first, end, law, dt);
    case Cap::total:
      return physics::compute_friction<true, Cap::total>(block_, first, end, law, dt);
    case Cap::coulomb:
      return physics::compute_friction<true, Cap::coulomb>(block_, first, end, law, dt);
    }
  }

  /// The normal force of a contact that begins or ends in this step, or is solved for together with others.
  void exert_unless_it_goes_on(int n, const Parameters &parameters) {
    const BlockContact &contact = contacts_[n];
    const bool goes_on = contact.touches && !in_setup_ && block_.in_contact[n] != 0.0;
    if (goes_on && light_) return;
    const auto law = parameters.law(block_.m_eff[n], block_.r_eff[n]);
    if (goes_on && block_.coupled[n] == 0.0)
      return drumlin::count(*stepping_, contact.i, contact.j, law.dashpot(block_.overlap[n]));
    const StepContact now{contact.i,         contact.j,           block_.normal[n], nullptr,
                          block_.overlap[n], block_.rate_half[n], block_.m_eff[n],  1.0};
    if (!contact.touches) {
      block_.push[n] =
          block_.in_contact[n] == 0.0 ? 0.0 : end_contact(law, *stepping_, now, block_.force_before[n]);
      return;
    }
    physics::ContactState state{block_.force_before[n], block_.in_contact[n] != 0.0, {}};
    block_.push[n] = exert_rare(law, *stepping_, now, state, contact.history[places_.force]);
    block_.force[n] = state.force;
  }

  /// Adds the forces of a contact to its balls, and stores its history.
  void exert(int n) {
    const BlockContact &contact = contacts_[n];
    ExertedForces forces{{}, {}, {}, block_.arm_i[n], block_.arm_j[n]};
    if (rubs && contact.touches) {
      forces.force = block_.total_force[n];
      forces.moment = block_.moment[n];
      // The force of a contact that has ended is not added, not even as zero times the normal: if a position is not a
      // number (NaN), the normal is not either, and the product would make the other ball's force NaN, too.
    } else if (contact.touches || (stepped && block_.push[n] != 0.0))
      forces.force = physics::scaled(block_.push[n], block_.normal[n]);
    if constexpr (remembers) {
      if (contact.touches)
        keep_history(n, contact.history);
      else
        std::fill_n(contact.history, places_.count, 0.0);
    }
    if constexpr (rolling)
      if (contact.touches) forces.rolling = block_.rolling[n];
    engine_.exert(block_, n, contact, forces);
  }

  void keep_history(int n, double *history) const {
    if constexpr (stepped) history[places_.force] = block_.force[n];
    if (!moves_) return;
    if constexpr (springs) keep_vector(history, places_.spring, block_.spring[n]);
    if constexpr (stores_stiffness) history[places_.stiffness] = block_.stored_stiffness[n];
    if constexpr (rolling) keep_vector(history, places_.rolling, block_.rolling_spring[n]);
  }

  static void keep_vector(double *history, int place, const Vec3 &vector) {
    history[place] = vector[0];
    history[place + 1] = vector[1];
    history[place + 2] = vector[2];
  }

  Engine &engine_;
  const LAMMPS_NS::Atom &atom_;
  const CoefficientTable<Parameters> &table_;
  const HistoryPlaces places_;
  const Cap cap_; // of friction with a spring
  LAMMPS_NS::FixStepping *const stepping_;
  const double dt_;
  const bool moves_; // false in the set-up of a run: springs stay as they are
  const bool light_, in_setup_;

  int count_ = 0; // contacts of the block
  physics::ContactBlock block_;
  BlockContact contacts_[physics::block_size];
  const ContactCoefficients<Parameters> *coefficients_[physics::block_size];
};

} // namespace drumlin
