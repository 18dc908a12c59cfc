#pragma once
// The loop over the contacts of balls in a step, for the pair styles of both engines.

#include "contact/contact_forces.h"
#include "contact/pair_list.h"
#include "engine.h"

#include <algorithm>

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
  ContactLoop(Engine &engine, const LAMMPS_NS::Atom &atom, LoopMemory &memory,
              const ContactStep<Parameters> &step)
      : engine_(engine), atom_(atom), rows_(memory.rows), pairs_(memory.pairs), stepping_(step.stepping),
        forces_(atom, step) {}

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
  using Forces = ContactForces<Parameters, stepped, tangential, rolling>;
  static constexpr bool has_history = Forces::has_history;

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
    if constexpr (Forces::rubs || rolling) __builtin_prefetch(atom_.torque[0] + 3 * j, 1);
    if constexpr (!has_history) return {pair.i, pair.j, found, true, nullptr};
    double *const history = history_of(pair.i, pair.place);
    __builtin_prefetch(history, 1);
    return {pair.i, pair.j, found, true, history};
  }

  /// Computes the forces of the first `count` contacts and adds them to the balls.
  void exert(int count) {
    if constexpr (has_history) {
      forces_.take_histories(contacts_, count);
      Forces::for_each(changed_, 0, count, [this](int n) { take_change(contacts_[n]); });
    }
    const bool one_law =
        read_balls<stepped, Engine>(forces_.block, rows_, contacts_, count,
                                    stepped ? stepping_->rows() : nullptr, stepped && stepping_->counted());
    forces_.compute(contacts_, count, changed_, one_law);
    engine_.exert(forces_.block, contacts_, count);
  }

  /// Updates the engine's flag of a contact that begins or ends in this step.
  void take_change(BlockContact &contact) {
    contact.touches = pairs_.touches(contact.pair);
    int &flag = engine_.flags(contact.i)[pairs_.pairs()[static_cast<std::size_t>(contact.pair)].place];
    engine_.mark(flag, contact.history, contact.touches);
  }

  Engine &engine_;
  const LAMMPS_NS::Atom &atom_;
  BallRows &rows_;
  PairList &pairs_;
  LAMMPS_NS::FixStepping *const stepping_;

  static constexpr int at_once = 32; // pairs that one call of find_touching() tests for contact
  static_assert(physics::block_size + at_once <= 64, "changed_ has a bit for each");
  int count_ = 0;                   // contacts found whose forces are not computed yet
  physics::ContactSet changed_ = 0; // those of them that begin or end
  Forces forces_;
  std::int32_t found_[at_once + 4];
  BlockContact contacts_[physics::block_size + at_once];
};

} // namespace drumlin
