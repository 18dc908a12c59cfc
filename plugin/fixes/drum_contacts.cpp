#include "fixes/drum_contacts.h"

#include "contact/pair_motion.h"

#include <algorithm>
#include <cmath>
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

/// Place of a ball of the drum along its axle, from its centre of mass, m: of a ghost the nearest image.
double DrumContacts::place_on_axle(int ball, const physics::TiltAxes &axes, double centre) const {
  const double *x = lmp_->atom->x[ball];
  std::array<double, 3> apart =
      physics::scaled(physics::dot({x[0], x[1], x[2]}, axes.axle) - centre, axes.axle);
  engine::minimum_image(lmp_->domain, apart);
  return physics::dot(apart, axes.axle);
}

DrumContactSums DrumContacts::sums(const std::array<double, 3> &axis, const physics::TiltAxes *axes,
                                   double centre, double middle) {
  std::array<double, 5> mine{};
  std::array<double, 3> ends{}; // forces left and right, moment
  mine[4] = std::exchange(missed_heat_, 0.0);
  for (Pair &pair : pairs_) {
    pair.law.follow(*source_, pair.i, pair.j, memory_at(pair.memory));
    const double before = mine[0];
    std::visit([&](const auto &law) { add(mine, pair, law, axis); }, pair.law.law());
    if (axes == nullptr) continue;
    const double force = mine[0] - before;
    const double s = place_on_axle(pair.sign > 0.0 ? pair.i : pair.j, *axes, centre);
    const double on_right = std::fabs(s) <= middle ? 0.5 : s > 0.0 ? 1.0 : 0.0;
    ends = physics::sum(ends, force, {1.0 - on_right, on_right, s});
  }
  std::array<double, 8> all{mine[0], mine[1], mine[2], mine[3], mine[4], ends[0], ends[1], ends[2]};
  if (lmp_->comm->nprocs > 1)
    MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM, lmp_->world);
  return {all[0], all[1], all[4], all[2], all[3] > 0.0, all[5], all[6], all[7]};
}

} // namespace drumlin
