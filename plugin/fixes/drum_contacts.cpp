#include "fixes/drum_contacts.h"

#include "contact/pair_motion.h"

#include <algorithm>
#include <utility>

namespace drumlin {

void DrumContacts::list_pairs(const ContactSource &source, int drum, int frame) {
  pairs_.clear();
  source_ = &source;
  const LAMMPS_NS::NeighList *list = source.contact_list();
  drum_ = drum;
  roller_ = drum | frame;
  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii];
    for (int jj = 0; jj < list->numneigh[i]; ++jj) {
      const int j = engine::neighbour_index(list->firstneigh[i][jj]);
      const double sign = this->sign(i, j);
      if (sign == 0.0) continue;
      const double *memory = source.law_memory(i, jj);
      pairs_.push_back(
          {i, j, sign, PairLaw(source, i, j, memory_at(memory)), source.tangential_spring(i, jj), memory});
    }
  }
}

/// With newton off a pair of balls on two ranks is in the lists of both: it counts where the drum's ball is
/// owned.
double DrumContacts::sign(int i, int j) const {
  const LAMMPS_NS::Atom &atom = *lmp_->atom;
  const bool i_drum = atom.mask[i] & drum_;
  const bool j_drum = atom.mask[j] & drum_;
  if (i_drum == j_drum || ((i_drum ? atom.mask[j] : atom.mask[i]) & roller_)) return 0.0;
  if ((i_drum ? i : j) >= atom.nlocal && !lmp_->force->newton_pair) return 0.0;
  return i_drum ? 1.0 : -1.0;
}

void DrumContacts::add_heat(int i, int j, double heat) {
  if (j >= 0 && sign(i, j) != 0.0) missed_heat_ += heat;
}

/// Adds the force, dissipated power, stored energy and number of contacts of a pair.
template <class Law>
void DrumContacts::add(std::array<double, 5> &sums, const Pair &pair, const Law &law,
                       const std::array<double, 3> &axis) const {
  const LAMMPS_NS::Atom &atom = *lmp_->atom;
  const auto along = [&axis](const double *v) { return v[0] * axis[0] + v[1] * axis[1] + v[2] * axis[2]; };
  const PairMotion m = pair_motion(atom, pair.i, pair.j);
  const double F = law.force(m.overlap, m.rate);
  const double suction = m.overlap > 0.0 ? source_->suction(pair.i, pair.j) : 0.0;
  sums[0] += pair.sign * (F - suction) * along(m.normal.data());
  if (m.overlap > 0.0 && source_->friction_model() != FrictionModel::none) {
    const physics::Friction friction =
        source_->friction(pair.i, pair.j, pair.law.law(), m.overlap, pair.spring);
    if (friction.coefficient > 0.0)
      sums[0] += pair.sign * along(friction_force(atom, pair.i, pair.j, m, friction, F, pair.spring.length,
                                                  lmp_->update->dt)
                                       .data());
  }
  sums[1] += law.power(m.overlap, m.rate).dissipated;
  sums[2] += law.energy(m.overlap) - suction * std::max(0.0, m.overlap);
  sums[3] += suction > 0.0 || law.acts(m.overlap, m.rate) ? 1.0 : 0.0;
}

DrumContactSums DrumContacts::sums(const std::array<double, 3> &axis) {
  std::array<double, 5> mine{};
  mine[4] = std::exchange(missed_heat_, 0.0);
  for (Pair &pair : pairs_) {
    pair.law.follow(*source_, pair.i, pair.j, memory_at(pair.memory));
    std::visit([&](const auto &law) { add(mine, pair, law, axis); }, pair.law.law());
  }
  std::array<double, 5> all = mine;
  if (lmp_->comm->nprocs > 1) MPI_Allreduce(mine.data(), all.data(), 5, MPI_DOUBLE, MPI_SUM, lmp_->world);
  return {all[0], all[1], all[4], all[2], all[3] > 0.0};
}

} // namespace drumlin
