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
#include "liggghts/transition_model.h"

namespace drumlin {

/// Computes the forces of all contacts between balls in a time step, instead of the engine's loop over pairs.
/// In time steps in which the engine asks for the forces of single contacts, for output or a fix of its own,
/// its own loop computes them instead: see needs_engine_loop().
/// \tparam Models see transition_model.h
template <class Models, bool stepped>
class LoopAdapter {
public:
  LoopAdapter(LAMMPS_NS::PairGran &pair, const LAMMPS_NS::Atom &atom, const LAMMPS_NS::Neighbor &neighbor,
              const LAMMPS_NS::Clumps &clumps)
      : pair_(pair), atom_(atom), neighbor_(neighbor), clumps_(clumps), has_clumps_(!clumps.empty()) {}

  void compute(LoopMemory &memory, const ContactStep<typename Models::Contact> &step) {
    in_contact_place_ = step.places[Remembered::touches];
    ContactLoop<LoopAdapter, typename Models::Contact, stepped, Models::friction, Models::rolls>(*this, atom_,
                                                                                                 memory, step)
        .run(*pair_.list, neighbor_);
  }

  int *flags(int i) const { return pair_.listgranhistory->firstneigh[i]; }
  double *histories(int i) const { return pair_.listgranhistory->firstdouble[i]; }
  int stride() const { return pair_.dnum(); }
  bool touched(int flags, const double *history) const {
    return stepped ? history[in_contact_place_] != 0.0 : flags != 0;
  }
  void mark(int &flags, double *history, bool touches) const {
    flags = touches ? flags | Models::flags : flags & ~Models::flags;
    if (stepped && touches) history[in_contact_place_] = 1.0;
  }

  double mass(int i) const {
    const double m = has_clumps_ ? clumps_.mass_of(atom_, i, atom_.rmass[i]) : atom_.rmass[i];
    return atom_.mask[i] & pair_.freeze_group_bit() ? -m : m;
  }
  static double effective_mass(double mi, double mj) { return engine_effective_mass(mi, mj); }

  void exert(const physics::ContactBlock &block, const BlockContact *contacts, int count) const {
    for (int n = 0; n < count; ++n) {
      add(contacts[n].i, 1.0, block, n, block.torque_i);
      if (contacts[n].j < atom_.nlocal) add(contacts[n].j, -1.0, block, n, block.torque_j);
    }
  }
  void finish() const {}

private:
  void add(int i, double sign, const physics::ContactBlock &block, int n,
           const physics::Vectors &friction) const {
    const double relax = pair_.relax(i);
    double *const f = atom_.f[0] + static_cast<std::ptrdiff_t>(i) * 3;
    double *const torque = atom_.torque[0] + static_cast<std::ptrdiff_t>(i) * 3;
    const physics::Vec3 force = block.total_force[n];
    for (std::size_t a = 0; a < 3; ++a) {
      f[a] += relax * (sign * force[a]);
      if constexpr (Models::rubs)
        torque[a] += relax * (Models::rolls ? sign * block.rolling[n][a] + friction[n][a] : friction[n][a]);
      else if constexpr (Models::rolls)
        torque[a] += relax * (sign * block.rolling[n][a]);
    }
  }

  LAMMPS_NS::PairGran &pair_;
  const LAMMPS_NS::Atom &atom_;
  const LAMMPS_NS::Neighbor &neighbor_;
  const LAMMPS_NS::Clumps &clumps_;
  const bool has_clumps_;
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
