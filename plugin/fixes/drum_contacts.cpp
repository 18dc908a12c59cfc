#include "fixes/drum_contacts.h"

#include "contact/pair_motion.h"

namespace drumlin {

void DrumContacts::list_pairs(const ContactSource &source, int drum, int frame) {
  pairs_.clear();
  const LAMMPS_NS::NeighList *list = source.contact_list();
  const LAMMPS_NS::Atom &atom = *lmp_->atom;
  const int *mask = atom.mask;
  const int roller = drum | frame;
  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii];
    for (int jj = 0; jj < list->numneigh[i]; ++jj) {
      const int j = engine::neighbour_index(list->firstneigh[i][jj]);
      const bool i_drum = mask[i] & drum;
      const bool j_drum = mask[j] & drum;
      if (i_drum == j_drum || ((i_drum ? mask[j] : mask[i]) & roller)) continue;
      // With newton off a pair of balls on two ranks is in the lists of both: it counts where the drum's ball
      // is owned.
      if ((i_drum ? i : j) >= atom.nlocal && !lmp_->force->newton_pair) continue;
      const physics::LinearLaw law =
          source.law(atom.type[i], atom.type[j]).of_mass(source.effective_mass(i, j));
      const FrictionModel model = source.friction_model();
      pairs_.push_back({i, j, i_drum ? 1.0 : -1.0, law,
                        model == FrictionModel::none
                            ? physics::Friction{}
                            : source.friction(atom.type[i], atom.type[j], law.dashpot(0.0)),
                        model == FrictionModel::history ? source.tangential_spring(i, jj) : nullptr});
    }
  }
}

DrumContactSums DrumContacts::sums(const std::array<double, 3> &axis) const {
  const LAMMPS_NS::Atom &atom = *lmp_->atom;
  const auto along = [&axis](const double *v) { return v[0] * axis[0] + v[1] * axis[1] + v[2] * axis[2]; };
  std::array<double, 4> mine{}; // force, dissipated power, stored energy, number of contacts
  for (const Pair &pair : pairs_) {
    const PairMotion m = pair_motion(atom, pair.i, pair.j);
    const double F = pair.law.force(m.overlap, m.rate);
    mine[0] += pair.sign * F * along(m.normal.data());
    if (m.overlap > 0.0 && pair.friction.coefficient > 0.0)
      mine[0] += pair.sign * along(friction_force(atom, pair.i, pair.j, m, pair.friction, F, pair.spring,
                                                  lmp_->update->dt)
                                       .data());
    mine[1] += pair.law.power(m.overlap, m.rate).dissipated;
    mine[2] += pair.law.energy(m.overlap);
    mine[3] += pair.law.acts(m.overlap, m.rate) ? 1.0 : 0.0;
  }
  std::array<double, 4> all = mine;
  if (lmp_->comm->nprocs > 1) MPI_Allreduce(mine.data(), all.data(), 4, MPI_DOUBLE, MPI_SUM, lmp_->world);
  return {all[0], all[1], all[2], all[3] > 0.0};
}

} // namespace drumlin
