#include "fixes/fix_guard.h"

#include "fixes/arguments.h"

#include <climits>
#include <fmt/format.h>

using namespace LAMMPS_NS;

namespace {

/// Finite if and only if all three are: a sum of finite numbers of a simulation does not overflow.
double sum(const double *v) { return v[0] + v[1] + v[2]; }

} // namespace

FixGuard::FixGuard(LAMMPS *lammps, int narg, char **arg) : Fix(lammps, narg, arg) {
  nevery = 1;
  drumlin::Arguments in(error, "fix guard", narg - 3, arg + 3);
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "every")
      nevery = static_cast<int>(in.integer("keyword every", 1));
    else if (keyword == "watch")
      watch_ = in.choice("keyword watch", {"on", "off"}) == 0;
    else
      in.fail("unknown keyword '" + keyword + "'; allowed: every or watch");
  }
}

int FixGuard::setmask() { return watch_ ? FixConst::END_OF_STEP : 0; }

void FixGuard::setup(int) {
  if (watch_) end_of_step();
}

void FixGuard::end_of_step() {
  int bad = INT_MAX; // lowest tag of a ball with a number that is not finite
  for (int i = 0; i < atom->nlocal; ++i)
    if ((atom->mask[i] & groupbit) && !std::isfinite(sum(atom->x[i]) + sum(atom->v[i]) + sum(atom->f[i])) &&
        atom->tag[i] < bad)
      bad = atom->tag[i];
  int worst = bad;
  if (comm->nprocs > 1) MPI_Allreduce(&bad, &worst, 1, MPI_INT, MPI_MIN, world);
  if (worst == INT_MAX) return;

  std::array<double, 9> mine{};
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->tag[i] == worst)
      for (std::size_t a = 0; a < 3; ++a) {
        mine[a] = atom->x[i][a];
        mine[3 + a] = atom->v[i][a];
        mine[6 + a] = atom->f[i][a];
      }
  std::array<double, 9> all{};
  MPI_Allreduce(mine.data(), all.data(), 9, MPI_DOUBLE, MPI_SUM, world);
  error->all(
      FLERR,
      fmt::format(
          "fix guard: ball {} is not finite at step {}: position {} {} {} m, velocity {} {} {} m/s, force "
          "{} {} {} N; allowed: finite numbers (too large a time step is the usual cause)",
          worst, update->ntimestep, all[0], all[1], all[2], all[3], all[4], all[5], all[6], all[7], all[8])
          .c_str());
}
