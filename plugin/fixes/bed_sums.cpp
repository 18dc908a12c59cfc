#include "fixes/bed_sums.h"

#include "fixes/fix_drum_travel.h"

#include <algorithm>
#include <cmath>

namespace drumlin {
namespace {

using Vec3 = std::array<double, 3>;

double dot(const Vec3 &a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

template <class Sums>
Sums over_ranks(Sums sums, MPI_Comm world) {
  constexpr int numbers = sizeof(Sums) / sizeof(double);
  MPI_Allreduce(MPI_IN_PLACE, &sums, numbers, MPI_DOUBLE, MPI_SUM, world);
  return sums;
}

/// Share of a ball's diameter that is below a height, 0 to 1.
double part_below(double height, double centre, double radius) {
  return std::min(1.0, std::max(0.0, (height - centre + radius) / (2.0 * radius)));
}

} // namespace

void ContactSums::add_wall(const Vec3 &axis, const Vec3 &outward, const Vec3 &force) {
  const double up = dot(axis, force.data());
  if (std::fabs(dot(axis, outward.data())) > 0.5) {
    floor_force += up;
    return;
  }
  side_force += up;
  side_thrust -= dot(outward, force.data());
}

/// Index of the component that is the largest in the axis.
std::size_t BedSums::vertical_component(const Vec3 &axis) {
  std::size_t most = 0;
  for (std::size_t a = 1; a < 3; ++a)
    if (std::fabs(axis[a]) > std::fabs(axis[most])) most = a;
  return most;
}

void BedSums::clear() {
  records_.clear();
  missed_heat_ = missed_work_ = 0.0;
}

void BedSums::add_heat(int i, int j, double normal, double tangential) {
  missed_heat_ += weight(i, j) * normal;
  missed_work_ += weight(i, j) * tangential;
}

/// With newton off a contact of balls on two ranks is recorded on both: it counts half on each.
double BedSums::weight(int i, int j) const {
  const int owned = lmp_->atom->nlocal;
  return !lmp_->force->newton_pair && (i >= owned || j >= owned) ? 0.5 : 1.0;
}

ContactSums BedSums::contacts(const Vec3 &axis) const {
  const LAMMPS_NS::Atom &atom = *lmp_->atom;
  ContactSums mine;
  mine.missed_heat = missed_heat_;
  mine.missed_work = missed_work_;
  for (const ContactRecord &e : records_) {
    const bool wall = e.j < 0;
    const double weight = this->weight(e.i, e.j);
    const double force = e.final_normal_force();
    const Vec3 tangential = e.final_tangential_force();
    const double *vi = atom.v[e.i];
    const double *vj = wall ? e.wall_velocity.data() : atom.v[e.j];
    const Vec3 v{vi[0] - vj[0], vi[1] - vj[1], vi[2] - vj[2]};
    const double rate = -dot(e.normal, v.data());
    mine.normal_heat += weight * (force - e.share * e.spring_force) * rate;
    mine.yield_heat += weight * e.share * e.yield_heat;
    mine.normal_stored += weight * e.share * e.spring_energy;
    mine.tangential_power -= weight * (dot(tangential, v.data()) + dot(e.final_torque_i(), atom.omega[e.i]) +
                                       (wall ? 0.0 : dot(e.final_torque_j(), atom.omega[e.j])));
    if (e.spring != nullptr)
      mine.tangential_stored +=
          weight * 0.5 * e.share * e.tangential_stiffness *
          (e.spring[0] * e.spring[0] + e.spring[1] * e.spring[1] + e.spring[2] * e.spring[2]);
    const double ends = (atom.mask[e.i] & soil_ ? 1.0 : 0.0) + (!wall && atom.mask[e.j] & soil_ ? 1.0 : 0.0);
    mine.coordination += weight * ends;
    if (ends > 0.0) {
      mine.contacts += weight;
      mine.overlap += weight * e.overlap / e.radius;
    }
    if (wall) {
      const double across = dot(axis, e.normal.data());
      const double up = force * across + dot(axis, tangential.data());
      if (std::fabs(across) > 0.5)
        mine.floor_force += up;
      else {
        mine.side_force += up;
        mine.side_thrust += force;
      }
    }
  }
  return over_ranks(mine, lmp_->world);
}

BallSums BedSums::balls(const Vec3 &axis, double window_top) const {
  const LAMMPS_NS::Atom &atom = *lmp_->atom;
  const bool flat = lmp_->domain->dimension == 2;
  const double inertia = engine::inertia_share(lmp_);
  constexpr double pi = 3.141592653589793;
  BallSums mine;
  for (int i = 0; i < atom.nlocal; ++i) {
    const double m = atom.rmass[i];
    const double r = atom.radius[i];
    const double *v = atom.v[i];
    const double *w = atom.omega[i];
    mine.kinetic += 0.5 * m *
                    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] +
                     inertia * r * r * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]));
    Vec3 x{};
    lmp_->domain->unmap(atom.x[i], atom.image[i], x.data());
    const double height = dot(axis, x.data());
    mine.height += m * height;
    if (!(atom.mask[i] & soil_)) continue;
    mine.soil_height += m * height;
    mine.soil_mass += m;
    mine.soil_balls += 1.0;
    mine.solid += (flat ? pi * r * r : 4.0 / 3.0 * pi * r * r * r) * part_below(window_top, height, r);
  }
  for (const LAMMPS_NS::Fix *fix : engine::fixes(lmp_->modify))
    if (const auto *travel = dynamic_cast<const LAMMPS_NS::FixDrumTravel *>(fix);
        travel && lmp_->comm->me == 0)
      mine.kinetic += travel->further_kinetic();
  return over_ranks(mine, lmp_->world);
}

double BedSums::void_ratio(const Vec3 &axis, double window_top, double solid) const {
  const LAMMPS_NS::Domain &box = *lmp_->domain;
  const std::size_t up = vertical_component(axis);
  double window = axis[up] > 0.0 ? window_top - box.boxlo[up] : window_top + box.boxhi[up];
  for (std::size_t a = 0; a < 3; ++a)
    if (a != up && (a != 2 || box.dimension == 3)) window *= box.prd[a];
  return solid > 0.0 ? window / solid - 1.0 : 0.0;
}

} // namespace drumlin
