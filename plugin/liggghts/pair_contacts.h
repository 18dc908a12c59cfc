#pragma once
// The adapter of ContactLoop to LIGGGHTS: see contact/contact_loop.h.

#include "atom.h"
#include "contact_models.h"
#include "force.h"
#include "modify.h"
#include "neigh_list.h"
#include "pair_gran.h"
#include "update.h"

#include "contact/contact_loop.h"
#include "liggghts/contact_table.h"

namespace drumlin {

/// Computes the forces of all contacts between balls in a time step, instead of the engine's loop over pairs.
/// Steps in which the engine needs the data of each contact use its own loop: see needs_engine_loop().
/// \tparam flag bits of the engine's contact flags that say that there is a contact
template <class Parameters, bool stepped, FrictionModel tangential, bool rolling, int flag>
class EnginePairContacts {
public:
  EnginePairContacts(LAMMPS_NS::PairGran &pair, const LAMMPS_NS::Atom &atom) : pair_(pair), atom_(atom) {}

  /// \param force_place of the normal force in the contact history, with the second-order scheme
  void compute(const CoefficientTable<Parameters> &table, int force_place, LAMMPS_NS::FixStepping *stepping,
               double dt) {
    in_contact_place_ = force_place + 1;
    // The engine asks the tangential model for its history first, then the rolling and the normal model.
    const int rolling_place = tangential == FrictionModel::history ? 3 : 0;
    const int stiffness_place = rolling_place + (rolling ? 3 : 0);
    const HistoryPlaces places{0,           stiffness_place, force_place, rolling_place, pair_.dnum_pair(),
                               pair_.dnum()};
    ContactLoop<EnginePairContacts, Parameters, stepped, tangential, rolling>(
        *this, atom_, table, places, physics::Cap::coulomb, stepping, dt, true)
        .run(*pair_.list);
  }

  int *flags(int i) const { return pair_.listgranhistory->firstneigh[i]; }
  double *histories(int i) const { return pair_.listgranhistory->firstdouble[i]; }
  bool touched(int flags, const double *history) const {
    return stepped ? history[in_contact_place_] != 0.0 : flags != 0;
  }
  void mark(int &flags, double *history, bool touches) const {
    flags = touches ? flags | flag : flags & ~flag;
    if (stepped && touches) history[in_contact_place_] = 1.0;
  }

  double effective_mass(int i, int j) const {
    const int frozen = pair_.freeze_group_bit();
    if (atom_.mask[j] & frozen) return atom_.rmass[i];
    if (atom_.mask[i] & frozen) return atom_.rmass[j];
    return engine_effective_mass(atom_.rmass[i], atom_.rmass[j]);
  }

  void exert(const physics::ContactBlock &, int, const BlockContact &contact,
             const ExertedForces &forces) const {
    add(contact.i, 1.0, forces.arm_i, forces);
    if (contact.j < atom_.nlocal) add(contact.j, -1.0, forces.arm_j, forces);
  }
  void finish() const {}

private:
  void add(int i, double sign, double arm, const ExertedForces &forces) const {
    const double relax = pair_.relax(i);
    double *const f = atom_.f[0] + static_cast<std::ptrdiff_t>(i) * 3;
    double *const torque = atom_.torque[0] + static_cast<std::ptrdiff_t>(i) * 3;
    for (std::size_t a = 0; a < 3; ++a) {
      f[a] += relax * (sign * forces.force[a]);
      if constexpr (tangential != FrictionModel::none)
        torque[a] +=
            relax * (rolling ? sign * forces.rolling[a] - arm * forces.moment[a] : -arm * forces.moment[a]);
      else if constexpr (rolling)
        torque[a] += relax * (sign * forces.rolling[a]);
    }
  }

  LAMMPS_NS::PairGran &pair_;
  const LAMMPS_NS::Atom &atom_;
  int in_contact_place_ = 0;
};

/// Whether the engine's loop has to compute the contacts of this step: some of its features take values from
/// single contacts, or change them.
inline bool needs_engine_loop(LAMMPS_NS::PairGran &pair, LAMMPS_NS::Modify &modify, bool tallies, bool adds) {
  return tallies || !pair.computeflag() || !pair.shearupdate() || pair.storeSumDelta() ||
         (adds && pair.cpl() != nullptr) || pair.storeContactForces() || pair.storeContactForcesStress() ||
         pair.store_sum_normal_force() || pair.fr_pair() != nullptr ||
         modify.n_fixes_style("insert/stream/predefined") > 0;
}

} // namespace drumlin
