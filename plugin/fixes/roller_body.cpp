#include "fixes/roller_body.h"

#include <cmath>
#include <fmt/format.h>

namespace drumlin {

void RollerBody::locate(engine::LAMMPS *lmp, const std::array<double, 3> &axis, const char *name,
                        double stretch, BodyMotion &motion) {
  const LAMMPS_NS::Atom &atom = *lmp->atom;
  const auto along = [&axis](const double *v) { return v[0] * axis[0] + v[1] * axis[1] + v[2] * axis[2]; };
  std::array<double, 3> mine{}; // mass-weighted position and velocity along the axis, and mass
  for (int i = 0; i < atom.nlocal; ++i)
    if (atom.mask[i] & groupbit) {
      std::array<double, 3> x{};
      lmp->domain->unmap(atom.x[i], atom.image[i], x.data());
      mine[0] += atom.rmass[i] * along(x.data());
      mine[1] += atom.rmass[i] * along(atom.v[i]);
      if (lmp->domain->deform_vremap) { // the image of the ball outside of the box, whose place x is, has
                                        // another velocity
        const std::array<double, 3> offset{x[0] - atom.x[i][0], x[1] - atom.x[i][1], x[2] - atom.x[i][2]};
        mine[1] += atom.rmass[i] * along(engine::velocity_of_image(*lmp->domain, offset).data());
      }
      mine[2] += atom.rmass[i];
    }
  std::array<double, 3> all = mine;
  if (lmp->comm->nprocs > 1) MPI_Allreduce(mine.data(), all.data(), 3, MPI_DOUBLE, MPI_SUM, lmp->world);
  engine::follow_mass(mass, all[2]);
  const double position = all[0] / mass;
  if (!has_origin) {
    origin = position - stretch;
    has_origin = true;
  }
  motion.x = position - origin;
  motion.v = all[1] / mass;
  if (!std::isfinite(motion.x) || !std::isfinite(motion.v))
    engine::stop(
        lmp, fmt::format(
                 "fix roller/history: {} is '{} m, {} m/s' at step {}; allowed: finite position and velocity",
                 name, motion.x, motion.v, lmp->update->ntimestep));
}

} // namespace drumlin
