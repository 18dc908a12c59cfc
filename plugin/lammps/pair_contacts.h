#pragma once
// The adapter of ContactLoop to LAMMPS: see contact/contact_loop.h. Included by pair_gran_transition.cpp alone.

#include "fix_neigh_history.h"
#include "contact/contact_loop.h"
#include "lammps/pair_gran_transition.h"

namespace LAMMPS_NS {

template <class Parameters, bool stepped, drumlin::FrictionModel tangential, bool rolling>
class PairGranTransition::Contacts {
public:
  Contacts(PairGranTransition &pair, const drumlin::CoefficientTable<Parameters> &table)
      : pair_(pair), table_(table), atom_(*pair.atom), bodies_(!pair.clumps_.empty() || !pair.rigid_.empty()),
        observed_(pair.observers_.any()),
        taken_(pair.force->newton_pair ? atom_.nlocal + atom_.nghost : atom_.nlocal) {}

  void compute() {
    const drumlin::ContactSettings &settings = pair_.settings_;
    const drumlin::HistoryPlaces places{0,
                                        settings.stiffness_place(),
                                        settings.force_place(),
                                        settings.rolling_place(),
                                        settings.history(),
                                        settings.history()};
    drumlin::ContactLoop<Contacts, Parameters, stepped, tangential, rolling>(
        *this, atom_, table_, places, settings.cap, pair_.stepping_, pair_.update->dt,
        pair_.update->setupflag == 0)
        .run(*pair_.list);
  }

  int *flags(int i) const { return pair_.history_->firstflag[i]; }
  double *histories(int i) const { return pair_.history_->firstvalue[i]; }
  static bool touched(int flag, const double *) { return flag != 0; }
  static void mark(int &flag, double *, bool touches) { flag = touches; }

  double effective_mass(int i, int j) const {
    const double mi = bodies_ ? pair_.mass_unless_frozen(i) : atom_.rmass[i];
    const double mj = bodies_ ? pair_.mass_unless_frozen(j) : atom_.rmass[j];
    if (atom_.mask[j] & pair_.freeze_groupbit_) return mi;
    return atom_.mask[i] & pair_.freeze_groupbit_ ? mj : drumlin::physics::effective_mass(mi, mj);
  }

  void exert(const drumlin::physics::ContactBlock &block, int n, const drumlin::BlockContact &contact,
             const drumlin::ExertedForces &forces) {
    const int i = contact.i, j = contact.j;
    if (observed_ && contact.touches) report(block, n, contact, forces);
    if (i != i_of_sums_) {
      finish();
      i_of_sums_ = i;
    }
    using drumlin::physics::sum;
    force_i_ = sum(force_i_, 1.0, forces.force);
    if constexpr (rubs) torque_i_ = sum(torque_i_, -forces.arm_i, forces.moment);
    if constexpr (rolling) torque_i_ = sum(torque_i_, 1.0, forces.rolling);
    if (j < taken_) {
      add(atom_.f, j, -1.0, forces.force);
      if constexpr (rubs) add(atom_.torque, j, -forces.arm_j, forces.moment);
      if constexpr (rolling) add(atom_.torque, j, -1.0, forces.rolling);
    }
    if (pair_.evflag)
      pair_.ev_tally_xyz(i, j, atom_.nlocal, pair_.force->newton_pair, 0.0, 0.0, forces.force[0],
                         forces.force[1], forces.force[2], block.separation.x[n], block.separation.y[n],
                         block.separation.z[n]);
  }

  /// Adds to a ball the force and torque that were summed over its contacts.
  void finish() {
    if (i_of_sums_ < 0) return;
    add(atom_.f, i_of_sums_, 1.0, force_i_);
    if constexpr (rubs || rolling) add(atom_.torque, i_of_sums_, 1.0, torque_i_);
    force_i_ = torque_i_ = {};
  }

private:
  using Vec3 = drumlin::physics::Vec3;
  static constexpr bool rubs = tangential != drumlin::FrictionModel::none;

  static void add(double *const *vectors, int i, double factor, const Vec3 &vector) {
    double *const all = vectors[0] + static_cast<std::ptrdiff_t>(i) * 3;
    all[0] += factor * vector[0];
    all[1] += factor * vector[1];
    all[2] += factor * vector[2];
  }

  [[gnu::noinline]] void report(const drumlin::physics::ContactBlock &b, int n,
                                const drumlin::BlockContact &contact,
                                const drumlin::ExertedForces &forces) const {
    const drumlin::Contact now{
        {contact.i, contact.j, b.normal[n], nullptr, b.overlap[n], b.rate_half[n], b.m_eff[n], 1.0},
        rubs ? b.slip[n] : Vec3{},
        b.r_eff[n],
        forces.arm_i,
        forces.arm_j,
        contact.history,
        b.in_contact[n] != 0.0};
    const drumlin::ContactForces exerted{b.force[n],    forces.force,   rubs ? b.tangential_force[n] : Vec3{},
                                         forces.moment, forces.rolling, rubs || rolling ? b.kt[n] : 0.0};
    pair_.observers_.tell(drumlin::record_of(
        pair_.settings_, table_.at(atom_.type[contact.i], atom_.type[contact.j]), now, exerted,
        std::min(b.ri[n], b.rj[n]), drumlin::physics::effective_radius(b.ri[n], b.rj[n])));
  }

  PairGranTransition &pair_;
  const drumlin::CoefficientTable<Parameters> &table_;
  const Atom &atom_;
  const bool bodies_; // whether a ball may be part of a larger body
  const bool observed_;
  const int taken_; // balls below this index take the force of a contact on this rank
  int i_of_sums_ = -1;
  Vec3 force_i_{}, torque_i_{}; // sums over the contacts of ball i_of_sums_
};

} // namespace LAMMPS_NS
