#pragma once
// The forces of contacts in a step, of balls and with walls, for both engines: the block of contacts with the
// second-order scheme's makes, breaks and coupled dashpots, what contacts remember, and their records.

#include "contact/ball_rows.h"
#include "contact/contact_history.h"
#include "contact/contact_observer.h"
#include "contact/contact_settings.h"
#include "contact/fix_stepping.h"
#include "physics/scheme/contact_block.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace drumlin {

/// What all contacts of a pair style or a wall have in common in a step.
template <class Parameters>
struct ContactStep {
  const CoefficientTable<Parameters> &table;
  const HistoryPlaces &places;
  physics::Cap cap;                  ///< of friction with a spring
  physics::Resisted resisted;        ///< by rolling resistance
  LAMMPS_NS::FixStepping *stepping;  ///< nullptr under `stepping stock`
  const ContactObservers &observers; ///< receive each contact whose surfaces touch
  double dt;                         ///< s
  bool moves;                        ///< false in the set-up of a run: springs stay as they are
  /// Whether the velocities are those of the middle of a step, as also in the set-up of a run that continues.
  bool slips_in_middle() const { return moves || (stepping != nullptr && stepping->any_continues()); }
};

/// A wall at a ball.
struct WallSide {
  std::array<double, 3> normal;           ///< from the wall to the ball
  std::array<double, 3> normal_in_middle; ///< where the ball was in the middle of the step
  std::array<double, 3> velocity;         ///< m/s, of the wall
  double overlap;                         ///< m
  double mass;                            ///< kg, of the ball
  int type;                               ///< of the wall
  double share = 1.0; ///< part of the force that acts: less than 1 where triangles of a mesh share it
};

/// Computes the forces of the contacts of a block. The caller describes them in `block`, and gets the results
/// there. \tparam partner what the balls touch: walls have a block for each contact
template <class Parameters, bool stepped, FrictionModel tangential, bool rolling,
          physics::Partner partner = physics::Partner::ball>
class ContactForces {
public:
  using Vec3 = physics::Vec3;
  using ContactSet = physics::ContactSet;
  static constexpr bool rubs = tangential != FrictionModel::none;
  static constexpr bool springs = tangential == FrictionModel::history;
  static constexpr bool stores_stiffness = Parameters::tangential_varies && (springs || rolling);
  static constexpr bool remembers = Parameters::remembers; // the law
  static constexpr bool has_history = stepped || rolling || springs || remembers;

  ContactForces(const LAMMPS_NS::Atom &atom, const ContactStep<Parameters> &step)
      : atom_(atom), table_(step.table), places_(step.places), cap_(step.cap), resisted_(step.resisted),
        stepping_(step.stepping), observers_(step.observers), observed_(step.observers.any()), dt_(step.dt),
        moves_(step.moves), in_middle_(step.slips_in_middle()), moved_(stepped && stepping_->any_moved()),
        in_setup_(stepped && stepping_->in_setup()) {}

  /// The motion of the contacts; see also take_histories() and take_wall().
  physics::ContactBlock block;

  /// Copies what the first `count` contacts remember into the block.
  void take_histories(const BlockContact *contacts, int count) {
    if constexpr (has_history)
      for (int n = 0; n < count; ++n)
        take_history(n, contacts[n].history);
  }

  /// Describes ball i at a wall as the only contact.
  void take_wall(int i, const WallSide &wall) {
    static_assert(partner == physics::Partner::wall);
    wall_velocity_ = wall.velocity;
    share_ = wall.share;
    wall_type_ = wall.type;
    const auto relative = [&](const double *v) {
      return Vec3{v[0] - wall.velocity[0], v[1] - wall.velocity[1], v[2] - wall.velocity[2]};
    };
    block.normal.set(0, wall.normal);
    block.normal_in_middle.set(0, wall.normal_in_middle);
    block.overlap[0] = wall.overlap;
    block.m_eff[0] = wall.mass;
    block.ri[0] = block.rj[0] = atom_.radius[i];
    block.velocity.set(0, relative(atom_.v[i]));
    block.wi.set(0, {atom_.omega[i][0], atom_.omega[i][1], atom_.omega[i][2]});
    if constexpr (stepped) {
      block.velocity_before.set(0, relative(stepping_->velocity_before(i)));
      block.damping_over_mass[0] = stepping_->damping_over_mass(i);
    }
  }

  /// Computes the forces of the first `count` contacts, those of the closing half kick, and stores what the
  /// contacts remember. \param changed those that begin or end in this step \param one_law whether all have
  /// the same coefficients
  void compute(const BlockContact *contacts, int count, ContactSet changed, bool one_law) {
    contacts_ = contacts;
    changed_ = changed;
    new_ = 0;
    for_each(changed, 0, count, [this](int n) {
      if (contacts_[n].touches) new_ |= ContactSet{1} << n;
    });
    for (int first = 0, end = 0; first < count; first = end) {
      end = one_law ? count : end_of_law(first, count);
      compute_law(first, end);
    }
    complete(count);
  }

  /// For output after a step: the forces of contact 0 from the stored normal force, the springs and the
  /// present velocities. Changes nothing.
  void show(const BlockContact *contacts) {
    contacts_ = contacts;
    const ContactCoefficients<Parameters> &law = law_of(0);
    physics::compute_normal_forces<stepped, rubs ? physics::Slip::at_end : physics::Slip::none, partner>(
        block, 0, 1, law.contact, dt_);
    if constexpr (stepped) block.push[0] = block.force[0] = block.force_before[0];
    physics::attract(block, 0, 1, law.suction);
    if constexpr (rubs || rolling)
      physics::compute_tangential_stiffness<springs, rolling, false>(block, 0, 1, law.contact, dt_);
    Vec3 friction{};
    if constexpr (rubs) {
      friction =
          physics::friction_after_step(law.tangential(block.kt[0], block.dashpot[0], cap_), block.force[0],
                                       block.normal[0], block.slip[0], block.spring[0], dt_);
      set_torques(0, friction);
    }
    block.total_force.set(0, physics::sum(friction, block.push[0], block.normal[0]));
    if constexpr (rolling) resist_rolling(0, 1, law, 0.0);
    take_share();
  }

  /// Torques on the balls of a contact, N m.
  Vec3 torque_i(int n) const {
    Vec3 all{};
    if constexpr (rubs) all = block.torque_i[n];
    if constexpr (rolling) all = physics::sum(all, 1.0, block.rolling[n]);
    return all;
  }
  Vec3 torque_j(int n) const {
    Vec3 all{};
    if constexpr (rubs) all = block.torque_j[n];
    if constexpr (rolling) all = physics::sum(all, -1.0, block.rolling[n]);
    return all;
  }

  /// Calls `treat` with the numbers of those of `contacts` that are at least `first` and below `end`, in
  /// their order.
  template <class Treat>
  static void for_each(ContactSet contacts, int first, int end, const Treat &treat) {
    for (ContactSet left = contacts & between(first, end); left != 0; left &= left - 1)
      treat(__builtin_ctzll(left));
  }

private:
  using Cap = physics::Cap;
  static constexpr bool at_walls = partner == physics::Partner::wall;

  /// Part of a contact's force that acts.
  double share() const { return at_walls ? share_ : 1.0; }

  static ContactSet between(int first, int end) { return (ContactSet{1} << end) - (ContactSet{1} << first); }

  void take_history(int n, const double *history) {
    if constexpr (springs) block.spring.set(n, vector_at(history, places_[Remembered::spring]));
    if constexpr (stores_stiffness) block.stored_stiffness[n] = history[places_[Remembered::stiffness]];
    if constexpr (stepped) block.force_before[n] = history[places_[Remembered::force]];
    if constexpr (remembers) block.memory_before[n] = history[places_[Remembered::memory]];
    if constexpr (rolling)
      block.rolling_spring.set(n, vector_at(history, places_[Remembered::rolling_spring]));
  }

  static Vec3 vector_at(const double *history, int place) {
    return {history[place], history[place + 1], history[place + 2]};
  }

  const ContactCoefficients<Parameters> &law_of(int n) const {
    return table_.at(atom_.type[contacts_[n].i], at_walls ? wall_type_ : atom_.type[contacts_[n].j]);
  }

  /// Number of the next contact, after `first`, whose coefficients differ from those of `first`; `count` if
  /// there is none.
  int end_of_law(int first, int count) const {
    int end = first;
    while (end < count && &law_of(end) == &law_of(first))
      ++end;
    return end;
  }

  /// Computes the forces of some contacts of the block.
  void compute_law(int first, int end) {
    const ContactCoefficients<Parameters> &law = law_of(first);
    ContactSet rare = push(first, end, law.contact);
    if (law.suction != 0.0) physics::attract(block, first, end, law.suction);
    if constexpr (stepped) {
      rare |= in_setup_ || law.jumps ? between(first, end) : changed_;
      if (moved_) rare |= with_moved_balls(first, end);
      exert_rare(rare, first, end, law.contact);
    }
    if constexpr (rubs || rolling) {
      if (moves_)
        physics::compute_tangential_stiffness<springs, rolling, true>(block, first, end, law.contact, dt_);
      else
        physics::compute_tangential_stiffness<springs, rolling, false>(block, first, end, law.contact, dt_);
    }
    const double dt = moves_ ? dt_ : 0.0; // a step of no length leaves springs as they are
    if constexpr (springs)
      rub_with_spring(first, end, law, dt);
    else if constexpr (rubs)
      physics::compute_friction<false, Cap::total>(block, first, end, law, dt);
    if constexpr (!rubs) physics::compute_total_force(block, first, end);
    if constexpr (rolling) resist_rolling(first, end, law, dt);
    if constexpr (springs || rolling)
      if (moves_) for_each(new_, first, end, [&](int n) { begin_springs(n, law); });
  }

  /// Friction and rolling resistance of a contact that begins, whose springs have been stretched for a part
  /// of the step only. (The engines' friction laws take the whole step.)
  [[gnu::noinline]] void begin_springs(int n, const ContactCoefficients<Parameters> &law) {
    const double time = physics::time_in_contact(block.overlap[n], block.rate_half[n], dt_);
    const Vec3 normal = block.normal[n];
    if (springs && cap_ == Cap::coulomb) {
      const physics::FrictionStep step =
          physics::friction_step(law.tangential(block.kt[n], block.dashpot[n], cap_), block.force[n], normal,
                                 block.slip[n], {}, time);
      block.spring.set(n, step.spring);
      block.tangential_force.set(n, step.force);
      block.total_force.set(n, physics::sum(step.force, block.push[n], normal));
      set_torques(n, step.force);
    }
    if constexpr (rolling) {
      block.rolling_spring.set(n, {});
      resist_rolling(n, n + 1, law, time);
    }
  }

  void resist_rolling(int first, int end, const ContactCoefficients<Parameters> &law, double dt) {
    using physics::Resisted;
    if (resisted_ == Resisted::rolling)
      physics::compute_rolling<partner, Resisted::rolling>(block, first, end, law, dt);
    else
      physics::compute_rolling<partner, Resisted::all>(block, first, end, law, dt);
  }

  ContactSet push(int first, int end, const Parameters &law) {
    using physics::Slip;
    if constexpr (!rubs)
      return physics::compute_normal_forces<stepped, Slip::none, partner>(block, first, end, law, dt_);
    if (in_middle_ && cap_ == Cap::coulomb)
      return physics::compute_normal_forces<stepped, Slip::in_middle, partner>(block, first, end, law, dt_);
    return physics::compute_normal_forces<stepped, Slip::at_end, partner>(block, first, end, law, dt_);
  }

  void count_dashpots(int first, int end) {
    double *const sums =
        stepping_->damping(); // read before the loop: the compiler cannot know that it does not change
    for (int n = first; n < end; ++n) {
      const double root = std::sqrt(block.dashpot[n]);
      sums[contacts_[n].i] += root;
      if constexpr (!at_walls) sums[contacts_[n].j] += root;
    }
  }

  void rub_with_spring(int first, int end, const ContactCoefficients<Parameters> &law, double dt) {
    switch (cap_) {
    case Cap::spring:
      return physics::compute_friction<true, Cap::spring>(block, first, end, law, dt);
    case Cap::total:
      return physics::compute_friction<true, Cap::total>(block, first, end, law, dt);
    case Cap::coulomb:
      return physics::compute_friction<true, Cap::coulomb>(block, first, end, law, dt);
    }
  }

  /// Those contacts that have a ball whose motion does not depend on their force.
  [[gnu::noinline]] ContactSet with_moved_balls(int first, int end) const {
    ContactSet all = 0;
    for (int n = first; n < end; ++n)
      if (moving_mass(n) != block.m_eff[n]) all |= ContactSet{1} << n;
    return all;
  }

  double moving_mass(int n) const {
    return stepping_->moving_mass(contacts_[n].i, contacts_[n].j, block.normal[n], block.m_eff[n]);
  }

  /// The law of a contact with what it remembered at the beginning of the step.
  typename Parameters::Law law_before(int n, const Parameters &parameters) const {
    return parameters.law(block.m_eff[n], block.r_eff[n], remembers ? block.memory_before[n] : 0.0);
  }

  /// The normal forces of the contacts that need more than going_on().
  void exert_rare(ContactSet rare, int first, int end, const Parameters &parameters) {
    int done = first;
    for_each(rare, first, end, [&](int n) {
      went_on(done, n, parameters);
      done = n + 1;
      exert_one(n, parameters);
    });
    went_on(done, end, parameters);
  }

  /// What else is to be done about contacts that went on and were not solved for together with others. Not
  /// inlined, where GCC 12 warns of places in a block of one contact that the loop does not reach.
  [[gnu::noinline]] void went_on(int first, int end, const Parameters &parameters) {
    if (stepping_->counting()) count_dashpots(first, end);
    if constexpr (!Parameters::Law::is_linear)
      if (stepping_->counts_heat()) tell_heat(first, end, parameters);
  }

  [[gnu::noinline]] void tell_heat(int first, int end, const Parameters &parameters) const {
    for (int n = first; n < end; ++n) {
      const physics::StepMotion motion{block.overlap[n], block.rate_half[n], block.rate_half[n], dt_};
      stepping_->tell_heat(contacts_[n].i, contacts_[n].j,
                           share() * physics::heat_of_spring(law_before(n, parameters), motion), 0.0);
    }
  }

  /// The normal force of a contact that begins, ends or loses its force in this step, has a ball whose motion
  /// does not depend on it, or is solved for together with others.
  [[gnu::noinline]] void exert_one(int n, const Parameters &parameters) {
    const BlockContact &contact = contacts_[n];
    const auto law = law_before(n, parameters);
    // The overlap of a contact that ends is made negative even if rounding has left 0, or if it is not a
    // number.
    const double overlap =
        contact.touches ? block.overlap[n] : std::min(-std::numeric_limits<double>::min(), block.overlap[n]);
    const physics::StepMotion motion{overlap, block.rate_half[n],
                                     -physics::dot(block.velocity_before[n], block.normal[n]),
                                     stepping_->dt()};
    const physics::StepContext context{moving_mass(n), block.damping_over_mass[n], in_setup_,
                                       in_setup_ && stepping_->continues(contact.i, contact.j)};
    const physics::ContactState before{block.force_before[n], (new_ >> n & 1) == 0};
    physics::ContactState state = before;
    const ContactCoefficients<Parameters> &coefficients = law_of(n);
    const bool jumps = coefficients.jumps && before.in_contact && contact.touches && !in_setup_;
    const physics::StepResult step =
        jumps ? over_jump(n, law, motion, state, context) : physics::advance(law, motion, state, context);
    const double suction = coefficients.suction;
    const physics::StepResult acting = physics::with_suction(step, suction, motion, before, in_setup_);
    const std::size_t announced = stepping_->announced();
    exert_later(n, acting);
    double &stored_force = contact.history[places_[Remembered::force]];
    if (step.coupled) couple(n, step.dashpot, stored_force);
    if (step.begins) begin(n, step, announced);
    if (stepping_->counts_heat() && !jumps)
      stepping_->tell_heat(
          contact.i, contact.j,
          share() * physics::heat_of_change(law, suction, motion, before, step, acting, context.m_eff), 0.0);
    block.push[n] = acting.kick;
    block.force[n] = state.force;
    if (in_setup_) stepping_->load(contact.i, contact.j, std::fabs(state.force) + suction);
    if (!state.in_contact || !stepping_->counting()) return;
    stepping_->add_damping(contact.i, law.dashpot(overlap));
    if (!at_walls) stepping_->add_damping(contact.j, law.dashpot(overlap));
  }

  /// The normal force in a step within which stiffness and damping of the contact jump. In such a step, of
  /// which there are few, its dashpot is solved for alone, not together with those of neighbouring contacts.
  physics::StepResult over_jump(int n, const typename Parameters::Law &after,
                                const physics::StepMotion &motion, physics::ContactState &state,
                                const physics::StepContext &context) const {
    const ContactCoefficients<Parameters> &coefficients = law_of(n);
    const double force_before = state.force, after_jump = coefficients.share_after;
    const typename Parameters::Law law = law_before(n, coefficients.contact_before);
    const physics::StepResult step =
        physics::advance_over_jump(law, after, after_jump, motion, state, context.m_eff);
    if (stepping_->counts_heat())
      stepping_->tell_heat(contacts_[n].i, contacts_[n].j,
                           share() * physics::heat_of_jump(law, after, after_jump, motion, force_before,
                                                           step.kick, context.m_eff),
                           0.0);
    return step;
  }

  /// Passes to FixStepping the forces that act after the closing half kick: the rest of the force up to
  /// StepResult::force, for the next opening half kick, and the position correction.
  void exert_later(int n, const physics::StepResult &step) const {
    if (step.coupled || (step.kick == step.force && step.shift == 0.0)) return;
    const double rest = share() * step.force - share() * step.kick, shift = share() * step.shift;
    const Vec3 normal = block.normal[n];
    const auto later = [&](int ball, double sign) {
      stepping_->add_after_kick(ball, physics::scaled(sign * rest, normal),
                                physics::scaled(sign * shift, normal));
    };
    later(contacts_[n].i, 1.0);
    if (stepping_->takes(contacts_[n].j)) later(contacts_[n].j, -1.0);
  }

  /// Passes a dashpot to FixStepping, which solves for it when all forces of the step are known.
  void couple(int n, const physics::CoupledDashpot &dashpot, double &stored_force) {
    LAMMPS_NS::FixStepping::Coupled &coupled = stepping_->couple();
    coupled.i = contacts_[n].i;
    coupled.j = contacts_[n].j;
    coupled.normal = block.normal[n];
    coupled.dashpot = dashpot;
    if (at_walls) coupled.dashpot.at_rest += dashpot.per_rate * physics::dot(wall_velocity_, block.normal[n]);
    coupled.share = share();
    coupled.force = &stored_force;
    coupled_[n] = &coupled;
    any_coupled_ = true;
  }

  void begin(int n, const physics::StepResult &step, std::size_t announced) {
    LAMMPS_NS::FixStepping::Begun &begun = stepping_->begin();
    begun.i = contacts_[n].i;
    begun.j = contacts_[n].j;
    begun.normal = block.normal[n];
    begun.share = share();
    begun.step = step;
    begun.announced = announced;
    if constexpr (rubs || rolling) begun_.emplace_back(n, &begun);
  }

  /// Passes friction and rolling resistance of the coupled contacts to FixStepping, which limits them when
  /// the normal force is known.
  [[gnu::noinline]] void couple_friction(int count) {
    for (int n = 0; n < count; ++n)
      if (coupled_[n] != nullptr) describe(n, *coupled_[n], cap_ == Cap::coulomb);
  }

  /// \param limited whether friction with a spring is described, too
  void describe(int n, LAMMPS_NS::FixStepping::Rubbing &rubbing, bool limited) const {
    double *const history = contacts_[n].history;
    const ContactCoefficients<Parameters> &law = law_of(n);
    if constexpr (rubs) {
      if (limited) {
        rubbing.friction = law.tangential(block.kt[n], block.dashpot[n], cap_);
        rubbing.rub = block.tangential_force[n];
        rubbing.slip = block.slip[n];
        rubbing.arm_i = block.arm_i[n];
        rubbing.arm_j = block.arm_j[n];
        if constexpr (springs) rubbing.spring = history + places_[Remembered::spring];
      }
    }
    if constexpr (rolling) {
      rubbing.rolling = rolling_of(n, law);
      rubbing.roll = block.rolling[n];
      rubbing.rolling_spring = history + places_[Remembered::rolling_spring];
    }
  }

  physics::Rolling rolling_of(int n, const ContactCoefficients<Parameters> &law) const {
    return law.rolling_resistance(block.kt[n], physics::radius_of_contact<partner>(block.ri[n], block.rj[n]),
                                  resisted_);
  }

  /// Friction and rolling resistance of contacts that begin: those of the closing half kick.
  [[gnu::noinline]] void close_friction() {
    for (const auto &[n, begun] : begun_) {
      const auto closing = stepping_->close_friction(*begun);
      block.total_force.set(n, physics::sum(closing.friction, share() * block.push[n], block.normal[n]));
      if constexpr (rubs) set_torques(n, closing.friction);
      if constexpr (rolling) block.rolling.set(n, closing.rolling);
    }
    begun_.clear();
  }

  /// What follows when the forces of the first `count` contacts are known.
  void complete(int count) {
    if constexpr (has_history) {
      for (int n = 0; n < count; ++n)
        keep_history(n, contacts_[n].history);
      for_each(changed_ & ~new_, 0, count, [this](int n) { end_contact(n); });
    }
    if constexpr (stepped) {
      if (any_coupled_) couple_friction(count);
      for (const auto &[n, begun] : begun_)
        describe(n, *begun, true);
    }
    take_share();
    if (observed_)
      for (int n = 0; n < count; ++n)
        if (contacts_[n].touches) report(n);
    if constexpr (stepped)
      if (!begun_.empty()) close_friction();
    if (any_coupled_) {
      std::fill_n(coupled_, count, nullptr);
      any_coupled_ = false;
    }
  }

  /// Reduces the forces at a wall to the share that acts.
  void take_share() {
    if (share() == 1.0) return;
    const auto reduce = [this](physics::Vectors &all) { all.set(0, physics::scaled(share(), all[0])); };
    reduce(block.total_force);
    if constexpr (rubs) {
      reduce(block.tangential_force);
      reduce(block.torque_i);
    }
    if constexpr (rolling) reduce(block.rolling);
  }

  /// The record of a contact for observers.
  [[gnu::noinline]] void report(int n) const {
    const BlockContact &contact = contacts_[n];
    const ContactCoefficients<Parameters> &coefficients = law_of(n);
    const auto law =
        coefficients.contact.law(block.m_eff[n], block.r_eff[n], remembers ? block.memory[n] : 0.0);
    ContactRecord record{};
    record.i = contact.i;
    record.j = contact.j;
    record.normal = block.normal[n];
    record.wall_velocity = wall_velocity_;
    record.overlap = block.overlap[n];
    record.radius = at_walls ? block.ri[n] : std::min(block.ri[n], block.rj[n]);
    record.share = share();
    record.suction = coefficients.suction;
    record.spring_force = law.spring(record.overlap) - record.suction;
    record.spring_energy = law.energy(record.overlap) - record.suction * record.overlap;
    if constexpr (remembers)
      record.yield_heat = law.yielded(0.0) - law_before(n, coefficients.contact).yielded(0.0);
    record.normal_stiffness = law.stiffest(record.overlap);
    if (!stepped) record.normal_dashpot = law.dashpot(record.overlap);
    record.normal_force = block.force[n];
    if constexpr (stepped) {
      record.final_force = contact.history + places_[Remembered::force];
      if (any_coupled_ && coupled_[n] != nullptr) record.change = &coupled_[n]->change;
    }
    if constexpr (rubs) {
      record.tangential_dashpot = coefficients.tangential_dashpot(block.dashpot[n]);
      record.tangential_force = block.tangential_force[n];
    }
    if constexpr (springs) {
      record.tangential_stiffness = block.kt[n];
      record.spring = contact.history + places_[Remembered::spring];
    }
    if constexpr (rolling) record.rolling_stiffness = rolling_of(n, coefficients).stiffness;
    record.torque_i = torque_i(n);
    if (!at_walls) record.torque_j = torque_j(n);
    observers_.tell(record);
  }

  /// The forces and the history of a contact that has ended.
  [[gnu::noinline]] void end_contact(int n) {
    // The force is not added, not even as zero times the normal: if a position is not a number (NaN), the
    // normal is not either, and the product would make the other ball's force NaN, too.
    const bool pushes = stepped && block.push[n] != 0.0;
    block.total_force.set(n, pushes ? physics::scaled(block.push[n], block.normal[n]) : Vec3{});
    if constexpr (rubs) {
      block.torque_i.set(n, {});
      block.torque_j.set(n, {});
    }
    if constexpr (rolling) block.rolling.set(n, {});
    std::fill_n(contacts_[n].history, places_.count(), 0.0);
  }

  void set_torques(int n, const Vec3 &friction) {
    const Vec3 moment = physics::cross(block.normal[n], friction);
    block.torque_i.set(n, physics::scaled(-block.arm_i[n], moment));
    block.torque_j.set(n, physics::scaled(-block.arm_j[n], moment));
  }

  void keep_history(int n, double *history) const {
    if constexpr (stepped) history[places_[Remembered::force]] = block.force[n];
    if constexpr (remembers) history[places_[Remembered::memory]] = block.memory[n];
    if (!moves_) return;
    if constexpr (springs) keep_vector(history, places_[Remembered::spring], block.spring[n]);
    if constexpr (stores_stiffness) history[places_[Remembered::stiffness]] = block.stored_stiffness[n];
    if constexpr (rolling) keep_vector(history, places_[Remembered::rolling_spring], block.rolling_spring[n]);
  }

  static void keep_vector(double *history, int place, const Vec3 &vector) {
    history[place] = vector[0];
    history[place + 1] = vector[1];
    history[place + 2] = vector[2];
  }

  const LAMMPS_NS::Atom &atom_;
  const CoefficientTable<Parameters> &table_;
  const HistoryPlaces places_;
  const Cap cap_;
  const physics::Resisted resisted_;
  LAMMPS_NS::FixStepping *const stepping_;
  const ContactObservers &observers_;
  const bool observed_; // in this step
  const double dt_;
  const bool moves_;
  const bool in_middle_;
  const bool moved_; // whether there are balls whose motion does not depend on the forces on them
  const bool in_setup_;

  const BlockContact *contacts_ = nullptr;
  ContactSet changed_ = 0; // those of them that begin or end
  ContactSet new_ = 0;     // those that begin
  LAMMPS_NS::FixStepping::Coupled *coupled_[physics::block_size] =
      {}; // of the contacts of the block; nullptr: not coupled
  bool any_coupled_ = false;
  std::vector<std::pair<int, LAMMPS_NS::FixStepping::Begun *>> begun_; // contacts of the block that begin
  // Of the wall:
  Vec3 wall_velocity_{};
  double share_ = 1.0;
  int wall_type_ = 0;
};

} // namespace drumlin
