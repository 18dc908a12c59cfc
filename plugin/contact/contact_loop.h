#pragma once
// The loop over the contacts of balls in a step, for the pair styles of both engines.

#include "contact/contact_history.h"
#include "contact/contact_observer.h"
#include "contact/contact_settings.h"
#include "contact/pair_list.h"
#include "contact/exert_contact.h"
#include "engine.h"
#include "physics/scheme/contact_block.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace drumlin {

/// Memory of a loop, which the pair style keeps: the rows are filled anew in each step, the pairs when the
/// engine has searched for neighbours.
struct LoopMemory {
  BallRows rows;
  PairList pairs;
};

/// Collects contacts from the neighbour list into blocks, computes the forces of each block, and adds them to
/// the balls one after the other in the order of the list: sums are the same whatever the blocks are.
/// `Engine` is the adapter, with these functions:
///   flags(i), histories(i)    of the contacts of ball i: whether they touched, and the numbers stored
///   stride()                  numbers from the history of a contact to that of the next
///   touched(flag, history)    whether the balls touched in the step before
///   mark(flag, history, touches)  stores that for the next step
///   mass(i)                   kg; below 0 if the ball is frozen
///   effective_mass(mi, mj)    kg; static
///   exert(block, contacts, count)  adds forces to the balls
///   finish()                  called after the last contact
template <class Engine, class Parameters, bool stepped, FrictionModel tangential, bool rolling>
class ContactLoop {
public:
  /// \param stepping nullptr under `stepping stock` \param observers receive each contact whose balls touch
  ContactLoop(Engine &engine, const LAMMPS_NS::Atom &atom, LoopMemory &memory,
              const CoefficientTable<Parameters> &table, const HistoryPlaces &places, physics::Cap cap,
              LAMMPS_NS::FixStepping *stepping, const ContactObservers &observers, double dt, bool moves)
      : engine_(engine), atom_(atom), rows_(memory.rows), pairs_(memory.pairs), table_(table),
        places_(places), cap_(cap), stepping_(stepping), observers_(observers), observed_(observers.any()),
        dt_(dt), moves_(moves), moved_(stepped && stepping->any_moved()),
        in_setup_(stepped && stepping->in_setup()) {}

  void run(const LAMMPS_NS::NeighList &list, const LAMMPS_NS::Neighbor &neighbor) {
    rows_.fill(atom_, [this](int i) { return engine_.mass(i); });
    pairs_.follow(list, neighbor, atom_.nlocal + atom_.nghost, [this](int i, int place) {
      return has_history && engine_.touched(engine_.flags(i)[place], history_of(i, place));
    });
    const int pairs = static_cast<int>(pairs_.pairs().size());
    for (int first = 0; first < pairs; first += at_once) {
      const Found found = pairs_.find<has_history>(rows_, first, std::min(pairs, first + at_once), found_);
      changed_ |= found.changed << count_;
      for (int n = 0; n < found.count; ++n)
        contacts_[count_++] = expect(found_[n]);
      if (count_ < physics::block_size) continue;
      exert(physics::block_size);
      count_ -= physics::block_size;
      std::copy_n(contacts_ + physics::block_size, count_, contacts_);
      changed_ >>= physics::block_size;
    }
    exert(count_);
    engine_.finish();
  }

private:
  using Vec3 = physics::Vec3;
  using Cap = physics::Cap;
  using ContactSet = physics::ContactSet;
  static constexpr bool rubs = tangential != FrictionModel::none;
  static constexpr bool springs = tangential == FrictionModel::history;
  static constexpr bool stores_stiffness = Parameters::tangential_varies && (springs || rolling);
  static constexpr bool remembers = Parameters::remembers; // the law
  static constexpr bool has_history = stepped || rolling || springs || remembers;

  double *history_of(int i, int place) const {
    return engine_.histories(i) + static_cast<std::ptrdiff_t>(engine_.stride()) * place;
  }

  /// Describes a pair that is in contact, and prefetches the data that its force will need. These data are
  /// scattered in memory: to wait for each in turn would take longer than to compute the force.
  BlockContact expect(int found) const {
    const Pair &pair = pairs_.pairs()[static_cast<std::size_t>(found)];
    const std::ptrdiff_t j = pair.j;
    __builtin_prefetch(rows_.motions() + j);
    if constexpr (stepped) __builtin_prefetch(stepping_->rows() + 4 * j);
    __builtin_prefetch(atom_.f[0] + 3 * j, 1);
    if constexpr (rubs || rolling) __builtin_prefetch(atom_.torque[0] + 3 * j, 1);
    if constexpr (!has_history) return {pair.i, pair.j, found, true, nullptr};
    double *const history = history_of(pair.i, pair.place);
    __builtin_prefetch(history, 1);
    return {pair.i, pair.j, found, true, history};
  }

  /// Copies velocities, masses and contact history of the first `count` contacts into the block.
  void take(int count) {
    if constexpr (has_history) {
      for (int n = 0; n < count; ++n)
        take_history(n, contacts_[n].history);
      new_ = 0;
      for_each(changed_, 0, count, [this](int n) { take_change(n); });
    }
    one_law_ =
        read_balls<stepped, Engine>(block_, rows_, contacts_, count, stepped ? stepping_->rows() : nullptr,
                                    stepped && stepping_->counted());
  }

  /// Calls `treat` with the numbers of those of `contacts` that are at least `first` and below `end`, in
  /// their order.
  template <class Treat>
  static void for_each(ContactSet contacts, int first, int end, const Treat &treat) {
    for (ContactSet left = contacts & between(first, end); left != 0; left &= left - 1)
      treat(__builtin_ctzll(left));
  }

  static ContactSet between(int first, int end) { return (ContactSet{1} << end) - (ContactSet{1} << first); }

  /// Updates the engine's flag of a contact that begins or ends in this step.
  void take_change(int n) {
    BlockContact &contact = contacts_[n];
    contact.touches = pairs_.touches(contact.pair);
    int &flag = engine_.flags(contact.i)[pairs_.pairs()[static_cast<std::size_t>(contact.pair)].place];
    engine_.mark(flag, contact.history, contact.touches);
    if (contact.touches) new_ |= ContactSet{1} << n;
  }

  void take_history(int n, const double *history) {
    if constexpr (springs) block_.spring.set(n, vector_at(history, places_[Remembered::spring]));
    if constexpr (stores_stiffness) block_.stored_stiffness[n] = history[places_[Remembered::stiffness]];
    if constexpr (stepped) block_.force_before[n] = history[places_[Remembered::force]];
    if constexpr (remembers) block_.memory_before[n] = history[places_[Remembered::memory]];
    if constexpr (rolling)
      block_.rolling_spring.set(n, vector_at(history, places_[Remembered::rolling_spring]));
  }

  static Vec3 vector_at(const double *history, int place) {
    return {history[place], history[place + 1], history[place + 2]};
  }

  /// Computes the forces of the first `count` contacts and adds them to the balls.
  void exert(int count) {
    take(count);
    for (int first = 0, end = 0; first < count; first = end) {
      end = one_law_ ? count : end_of_law(first, count);
      compute(first, end);
    }
    add_forces(count);
  }

  const ContactCoefficients<Parameters> &law_of(int n) const {
    return table_.at(atom_.type[contacts_[n].i], atom_.type[contacts_[n].j]);
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
  void compute(int first, int end) {
    const ContactCoefficients<Parameters> &law = law_of(first);
    ContactSet rare = push(first, end, law.contact);
    if constexpr (stepped) {
      rare |= in_setup_ ? between(first, end) : changed_;
      if (moved_) rare |= with_moved_balls(first, end);
      exert_rare(rare, first, end, law.contact);
    }
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
    if constexpr (!rubs) physics::compute_total_force(block_, first, end);
    if constexpr (rolling) physics::compute_rolling(block_, first, end, law, dt);
    if constexpr (springs || rolling)
      if (moves_) for_each(new_, first, end, [&](int n) { begin_springs(n, law); });
  }

  /// Friction and rolling resistance of a contact that begins, whose springs have been stretched for a part
  /// of the step only. (The engines' friction laws take the whole step.)
  [[gnu::noinline]] void begin_springs(int n, const ContactCoefficients<Parameters> &law) {
    const double time = physics::time_in_contact(block_.overlap[n], block_.rate_half[n], dt_);
    const Vec3 normal = block_.normal[n];
    if (springs && cap_ == Cap::coulomb) {
      const physics::FrictionStep step =
          physics::friction_step(law.tangential(block_.kt[n], block_.dashpot[n], cap_), block_.force[n],
                                 normal, block_.slip[n], {}, time);
      block_.spring.set(n, step.spring);
      block_.tangential_force.set(n, step.force);
      block_.total_force.set(n, physics::sum(step.force, block_.push[n], normal));
      set_torques(n, step.force);
    }
    if constexpr (rolling) {
      const double radius = physics::effective_radius(block_.ri[n], block_.rj[n]);
      const physics::RollingStep step =
          physics::rolling_step(law.rolling_resistance(block_.kt[n], radius), block_.force[n], normal,
                                physics::sum(block_.wi[n], -1.0, block_.wj[n]), {}, time);
      block_.rolling_spring.set(n, step.spring);
      block_.rolling.set(n, step.torque);
    }
  }

  ContactSet push(int first, int end, const Parameters &law) {
    using physics::Slip;
    if constexpr (!rubs)
      return physics::compute_normal_forces<stepped, Slip::none>(block_, first, end, law, dt_);
    if (moves_ && cap_ == Cap::coulomb)
      return physics::compute_normal_forces<stepped, Slip::in_middle>(block_, first, end, law, dt_);
    return physics::compute_normal_forces<stepped, Slip::at_end>(block_, first, end, law, dt_);
  }

  void count_dashpots(int first, int end) {
    double *const sums =
        stepping_->damping(); // read before the loop: the compiler cannot know that it does not change
    for (int n = first; n < end; ++n) {
      sums[contacts_[n].i] += block_.dashpot[n];
      sums[contacts_[n].j] += block_.dashpot[n];
    }
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

  /// Those contacts that have a ball whose motion does not depend on their force.
  [[gnu::noinline]] ContactSet with_moved_balls(int first, int end) const {
    ContactSet all = 0;
    for (int n = first; n < end; ++n) {
      const double m_eff = block_.m_eff[n];
      if (stepping_->moving_mass(contacts_[n].i, contacts_[n].j, block_.normal[n], m_eff) != m_eff)
        all |= ContactSet{1} << n;
    }
    return all;
  }

  /// The law of a contact with what it remembered at the beginning of the step.
  typename Parameters::Law law_before(int n, const Parameters &parameters) const {
    return parameters.law(block_.m_eff[n], block_.r_eff[n], remembers ? block_.memory_before[n] : 0.0);
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

  /// What else is to be done about contacts that went on and were not solved for together with others.
  void went_on(int first, int end, const Parameters &parameters) {
    if (stepping_->counting()) count_dashpots(first, end);
    if constexpr (!Parameters::Law::is_linear)
      if (stepping_->counts_heat()) tell_heat(first, end, parameters);
  }

  [[gnu::noinline]] void tell_heat(int first, int end, const Parameters &parameters) const {
    for (int n = first; n < end; ++n) {
      const physics::StepMotion motion{block_.overlap[n], block_.rate_half[n], block_.rate_half[n], dt_};
      stepping_->tell_heat(contacts_[n].i, contacts_[n].j,
                           physics::heat_of_spring(law_before(n, parameters), motion), 0.0);
    }
  }

  /// The normal force of a contact that begins, ends or loses its force in this step, has a ball whose motion
  /// does not depend on it, or is solved for together with others.
  [[gnu::noinline]] void exert_one(int n, const Parameters &parameters) {
    const BlockContact &contact = contacts_[n];
    const auto law = law_before(n, parameters);
    const StepContact now{contact.i,         contact.j,           block_.normal[n], nullptr,
                          block_.overlap[n], block_.rate_half[n], block_.m_eff[n],  1.0};
    if (!contact.touches) {
      block_.push[n] = drumlin::end_contact(law, *stepping_, now, block_.force_before[n]);
      return;
    }
    physics::ContactState state{block_.force_before[n], (new_ >> n & 1) == 0};
    double &stored_force = contact.history[places_[Remembered::force]];
    block_.push[n] = exert_contact(law, *stepping_, now, state, stored_force);
    block_.force[n] = state.force;
    coupled_[n] = stepping_->coupled_at(&stored_force);
    any_coupled_ |= coupled_[n] != nullptr;
    if constexpr (rubs || rolling)
      if (LAMMPS_NS::FixStepping::Begun *begun = stepping_->begun_at(&stored_force))
        begun_.emplace_back(n, begun);
  }

  /// Passes friction and rolling resistance of the coupled contacts to FixStepping, which limits them when
  /// the normal force is known.
  [[gnu::noinline]] void couple_friction(int count) {
    for (int n = 0; n < count; ++n) {
      LAMMPS_NS::FixStepping::Coupled *const coupled = coupled_[n];
      if (coupled != nullptr) describe(n, *coupled, cap_ == Cap::coulomb);
    }
  }

  /// \param limited whether friction with a spring is described, too
  void describe(int n, LAMMPS_NS::FixStepping::Rubbing &rubbing, bool limited) const {
    double *const history = contacts_[n].history;
    const ContactCoefficients<Parameters> &law = law_of(n);
    if constexpr (rubs) {
      if (limited) {
        rubbing.friction = law.tangential(block_.kt[n], block_.dashpot[n], cap_);
        rubbing.rub = block_.tangential_force[n];
        rubbing.slip = block_.slip[n];
        rubbing.arm_i = block_.arm_i[n];
        rubbing.arm_j = block_.arm_j[n];
        if constexpr (springs) rubbing.spring = history + places_[Remembered::spring];
      }
    }
    if constexpr (rolling) {
      rubbing.rolling =
          law.rolling_resistance(block_.kt[n], physics::effective_radius(block_.ri[n], block_.rj[n]));
      rubbing.roll = block_.rolling[n];
      rubbing.rolling_spring = history + places_[Remembered::rolling_spring];
    }
  }

  /// Friction and rolling resistance of contacts that begin: those of the closing half kick.
  [[gnu::noinline]] void close_friction() {
    for (const auto &[n, begun] : begun_) {
      describe(n, *begun, true);
      const auto closing = stepping_->close_friction(*begun);
      block_.total_force.set(n, physics::sum(closing.friction, block_.push[n], block_.normal[n]));
      if constexpr (rubs) set_torques(n, closing.friction);
      if constexpr (rolling) block_.rolling.set(n, closing.rolling);
    }
    begun_.clear();
  }

  /// Adds the forces of the first `count` contacts to their balls, and stores the contacts' history.
  void add_forces(int count) {
    if constexpr (has_history) {
      for (int n = 0; n < count; ++n)
        keep_history(n, contacts_[n].history);
      for_each(changed_ & ~new_, 0, count, [this](int n) { end_contact(n); });
    }
    if constexpr (stepped)
      if (any_coupled_) couple_friction(count);
    if (observed_)
      for (int n = 0; n < count; ++n)
        if (contacts_[n].touches) report(n);
    if constexpr (stepped)
      if (!begun_.empty()) close_friction();
    engine_.exert(block_, contacts_, count);
    if (any_coupled_) {
      std::fill_n(coupled_, count, nullptr);
      any_coupled_ = false;
    }
  }

  [[gnu::noinline]] void report(int n) const {
    const BlockContact &contact = contacts_[n];
    const ContactCoefficients<Parameters> &coefficients = law_of(n);
    const auto law =
        coefficients.contact.law(block_.m_eff[n], block_.r_eff[n], remembers ? block_.memory[n] : 0.0);
    ContactRecord record = record_of_law(law, block_.overlap[n], stepped);
    record.i = contact.i;
    record.j = contact.j;
    record.normal = block_.normal[n];
    record.radius = std::min(block_.ri[n], block_.rj[n]);
    record.share = 1.0;
    record.normal_force = block_.force[n];
    if constexpr (stepped) {
      record.final_force = contact.history + places_[Remembered::force];
      if (any_coupled_ && coupled_[n] != nullptr) record.change = &coupled_[n]->change;
    }
    if constexpr (rubs) {
      record.tangential_dashpot = coefficients.tangential_dashpot(block_.dashpot[n]);
      record.tangential_force = block_.tangential_force[n];
      record.torque_i = block_.torque_i[n];
      record.torque_j = block_.torque_j[n];
    }
    if constexpr (springs) {
      record.tangential_stiffness = block_.kt[n];
      record.spring = contact.history + places_[Remembered::spring];
    }
    if constexpr (rolling) {
      const double radius = physics::effective_radius(block_.ri[n], block_.rj[n]);
      record.rolling_stiffness = coefficients.rolling_resistance(block_.kt[n], radius).stiffness;
      record.torque_i = physics::sum(record.torque_i, 1.0, block_.rolling[n]);
      record.torque_j = physics::sum(record.torque_j, -1.0, block_.rolling[n]);
    }
    observers_.tell(record);
  }

  /// The forces and the history of a contact that has ended.
  [[gnu::noinline]] void end_contact(int n) {
    // The force is not added, not even as zero times the normal: if a position is not a number (NaN), the
    // normal is not either, and the product would make the other ball's force NaN, too.
    const bool pushes = stepped && block_.push[n] != 0.0;
    block_.total_force.set(n, pushes ? physics::scaled(block_.push[n], block_.normal[n]) : Vec3{});
    if constexpr (rubs) {
      block_.torque_i.set(n, {});
      block_.torque_j.set(n, {});
    }
    if constexpr (rolling) block_.rolling.set(n, {});
    std::fill_n(contacts_[n].history, places_.count(), 0.0);
  }

  void set_torques(int n, const Vec3 &friction) {
    const Vec3 moment = physics::cross(block_.normal[n], friction);
    block_.torque_i.set(n, physics::scaled(-block_.arm_i[n], moment));
    block_.torque_j.set(n, physics::scaled(-block_.arm_j[n], moment));
  }

  void keep_history(int n, double *history) const {
    if constexpr (stepped) history[places_[Remembered::force]] = block_.force[n];
    if constexpr (remembers) history[places_[Remembered::memory]] = block_.memory[n];
    if (!moves_) return;
    if constexpr (springs) keep_vector(history, places_[Remembered::spring], block_.spring[n]);
    if constexpr (stores_stiffness) history[places_[Remembered::stiffness]] = block_.stored_stiffness[n];
    if constexpr (rolling)
      keep_vector(history, places_[Remembered::rolling_spring], block_.rolling_spring[n]);
  }

  static void keep_vector(double *history, int place, const Vec3 &vector) {
    history[place] = vector[0];
    history[place + 1] = vector[1];
    history[place + 2] = vector[2];
  }

  Engine &engine_;
  const LAMMPS_NS::Atom &atom_;
  BallRows &rows_;
  PairList &pairs_;
  const CoefficientTable<Parameters> &table_;
  const HistoryPlaces places_;
  const Cap cap_; // of friction with a spring
  LAMMPS_NS::FixStepping *const stepping_;
  const ContactObservers &observers_;
  const bool observed_; // in this step
  const double dt_;
  const bool moves_; // false in the set-up of a run: springs stay as they are
  const bool moved_; // whether there are balls whose motion does not depend on the forces on them
  const bool in_setup_;

  static constexpr int at_once = 32; // pairs that one call of find_touching() tests for contact
  static_assert(physics::block_size + at_once <= 64, "changed_ has a bit for each");
  int count_ = 0;          // contacts found whose forces are not computed yet
  ContactSet changed_ = 0; // those of them that begin or end
  physics::ContactBlock block_;
  std::int32_t found_[at_once + 4];
  BlockContact contacts_[physics::block_size + at_once];
  ContactSet new_ = 0;   // contacts of the block that begin
  bool one_law_ = false; // whether all have the same coefficients
  LAMMPS_NS::FixStepping::Coupled *coupled_[physics::block_size] =
      {}; // of the contacts of the block; nullptr: not coupled
  bool any_coupled_ = false;
  std::vector<std::pair<int, LAMMPS_NS::FixStepping::Begun *>> begun_; // contacts of the block that begin
};

} // namespace drumlin
