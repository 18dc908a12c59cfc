#pragma once
// The adapter of ContactLoop to LAMMPS: see contact/contact_loop.h. Included by pair_gran_transition.cpp
// alone.

#include "fix_neigh_history.h"
#include "contact/contact_loop.h"
#include "lammps/pair_gran_transition.h"

namespace LAMMPS_NS {

template <class Parameters, bool stepped, drumlin::FrictionModel tangential, bool rolling>
class PairGranTransition::LoopAdapter {
public:
  LoopAdapter(PairGranTransition &pair, const drumlin::CoefficientTable<Parameters> &table)
      : pair_(pair), table_(table), atom_(*pair.atom), bodies_(!pair.clumps_.empty() || !pair.rigid_.empty()),
        tallies_(pair.evflag != 0), f_(atom_.f[0]), t_(atom_.torque[0]),
        taken_(pair.force->newton_pair ? atom_.nlocal + atom_.nghost : atom_.nlocal) {}

  void compute() {
    drumlin::ContactLoop<LoopAdapter, Parameters, stepped, tangential, rolling>(
        *this, atom_, pair_.loop_memory_, pair_.step_of(table_, pair_.places_))
        .run(*pair_.list, *pair_.neighbor);
  }

  int *flags(int i) const { return pair_.history_->firstflag[i]; }
  double *histories(int i) const { return pair_.history_->firstvalue[i]; }
  int stride() const { return pair_.places_.count(); }
  static bool touched(int flag, const double *) { return flag != 0; }
  static void mark(int &flag, double *, bool touches) { flag = touches; }

  double mass(int i) const {
    const double m = bodies_ ? pair_.mass_unless_frozen(i) : atom_.rmass[i];
    return atom_.mask[i] & pair_.freeze_groupbit_ ? -m : m;
  }
  static double effective_mass(double mi, double mj) { return drumlin::physics::effective_mass(mi, mj); }

  [[gnu::flatten]] void exert(const drumlin::physics::ContactBlock &block,
                              const drumlin::BlockContact *contacts, int count) {
    if (tallies_)
      for (int n = 0; n < count; ++n)
        tally(block, n, contacts[n]);
    int sums_of = sums_of_;
    Vec3 force = force_, torque = torque_; // local copies, which the compiler keeps in registers
    for (int n = 0; n < count; ++n) {
      const int i = contacts[n].i, j = contacts[n].j;
      if (i != sums_of) {
        add_sums(sums_of, force, torque);
        force = torque = {};
        sums_of = i;
      }
      force = sum(force, 1.0, block.total_force[n]);
      if constexpr (rubs) torque = sum(torque, 1.0, block.torque_i[n]);
      if constexpr (rolling) torque = sum(torque, 1.0, block.rolling[n]);
      if (j < taken_) {
        add(f_, j, -1.0, block.total_force[n]);
        if constexpr (rubs) add(t_, j, 1.0, block.torque_j[n]);
        if constexpr (rolling) add(t_, j, -1.0, block.rolling[n]);
      }
    }
    sums_of_ = sums_of;
    force_ = force;
    torque_ = torque;
  }

  void finish() { add_sums(sums_of_, force_, torque_); }

private:
  using Vec3 = drumlin::physics::Vec3;
  static constexpr bool rubs = tangential != drumlin::FrictionModel::none;

  static Vec3 sum(const Vec3 &a, double factor, const Vec3 &b) { return drumlin::physics::sum(a, factor, b); }
  /// Adds to the vector of a ball. Vectors follow one another in memory: this spares a pointer per ball.
  static void add(double *vectors, int i, double factor, const Vec3 &vector) {
    double *const to = vectors + static_cast<std::ptrdiff_t>(i) * 3;
    to[0] += factor * vector[0];
    to[1] += factor * vector[1];
    to[2] += factor * vector[2];
  }

  /// Adds to a ball the force and torque that were summed over its contacts.
  void add_sums(int i, const Vec3 &force, const Vec3 &torque) {
    if (i < 0) return;
    add(f_, i, 1.0, force);
    if constexpr (rubs || rolling) add(t_, i, 1.0, torque);
  }

  [[gnu::noinline]] void tally(const drumlin::physics::ContactBlock &block, int n,
                               const drumlin::BlockContact &contact) const {
    const Vec3 force = block.total_force[n], separation = block.separation[n];
    pair_.ev_tally_xyz(contact.i, contact.j, atom_.nlocal, pair_.force->newton_pair, 0.0, 0.0, force[0],
                       force[1], force[2], separation[0], separation[1], separation[2]);
  }

  PairGranTransition &pair_;
  const drumlin::CoefficientTable<Parameters> &table_;
  const Atom &atom_;
  const bool bodies_; // whether a ball may be part of a larger body
  const bool tallies_;
  double *const f_, *const t_; // forces and torques of the balls
  const int taken_;            // balls below this index take the force of a contact on this rank
  int sums_of_ = -1;           // the ball i whose contacts are being summed; -1: none
  Vec3 force_{}, torque_{};    // N and N m, sums over the contacts of ball sums_of_
};

} // namespace LAMMPS_NS
