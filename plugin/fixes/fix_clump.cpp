#include "fixes/fix_clump.h"

#include "fixes/fix_drum_travel.h"
#include "support/arguments.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <limits>
#include <string>

using namespace LAMMPS_NS;

FixClump::FixClump(LAMMPS *lammps, int narg, char **arg) : Fix(lammps, narg, arg) {
  vector_flag = 1;
  size_vector = 4;
  extvector = 0;
  global_freq = 1;
  drumlin::Arguments in(error, "fix clump", narg - 3, arg + 3);
  in.expect_end("fix ID group clump");
  if (igroup == 0) in.fail("group", "all", "a group with the balls of the body, which is not all");
}

int FixClump::setmask() { return FixConst::POST_FORCE; }

void FixClump::init() {
  deck_check_.of_fix(lmp, *this);
  const double balls = static_cast<double>(group->count(igroup));
  if (balls == 0.0)
    error->all(FLERR,
               drumlin::engine::error_text(fmt::format(
                   "fix clump: group is '{}', which is empty; allowed: a group with the balls of the body",
                   group->names[igroup])));
  mass_ = group->mass(igroup);
  roller_ = nullptr;
  for (const Fix *fix : drumlin::engine::fixes(modify))
    if (const auto *travel = dynamic_cast<const FixDrumTravel *>(fix);
        travel != nullptr && balls > 1.0 && travel->rolls_clump(igroup))
      roller_ = travel;
  // 0: not a run, but a command that needs the engine's lists. A body that rolls is checked by fix
  // drum/travel.
  if (update->whichflag != 0 && (roller_ == nullptr || !roller_->begun())) refuse_unequal_velocities();
  Clumps clumps;
  clumps.find(*modify);
  for (const FixClump *other : clumps.all())
    if (const int common = common_balls(*other); other != this && common > 0)
      error->all(FLERR, drumlin::engine::error_text(
                            fmt::format("fix clump: group is '{}', of which {} balls are in the clump '{}'; "
                                        "allowed: each ball in one clump only",
                                        group->names[igroup], common, group->names[other->igroup])));
  // A force that a later fix exerts would act on single balls of the body. These styles keep the balls'
  // accelerations equal.
  constexpr std::array<const char *, 6> harmless = {"lineforce", "planeforce",  "setforce",
                                                    "freeze",    "drum/excite", "clump"};
  bool later = false;
  for (Fix *fix : drumlin::engine::fixes(modify)) {
    const Fix &other = *fix;
    const bool forces = later && (drumlin::engine::fix_mask(modify, fix) & FixConst::POST_FORCE);
    later = later || fix == this;
    if (forces && std::find(harmless.begin(), harmless.end(), std::string(other.style)) == harmless.end() &&
        common_balls(other) > 0)
      error->all(FLERR, drumlin::engine::error_text(fmt::format(
                            "fix clump: group is '{}', on which the later fix {} ({}) exerts forces; "
                            "allowed: fix clump after all fixes that exert forces on its balls",
                            group->names[igroup], other.id, other.style)));
  }
  if (!echoed_)
    drumlin::engine::log_message(lmp,
                                 fmt::format("fix clump {}: {:.0f} balls, {:.9g} kg\n", id, balls, mass_));
  echoed_ = true;
}

/// Number of balls of the body that are also in the group of another fix. Collective.
int FixClump::common_balls(const Fix &other) const {
  int mine = 0;
  for (int i = 0; i < atom->nlocal; ++i)
    mine += (atom->mask[i] & groupbit) && (atom->mask[i] & other.groupbit) ? 1 : 0;
  int all = 0;
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_SUM, world);
  return all;
}

/// Balls that do not move together from the start would never do so: their forces give them one acceleration.
/// The body's mass in their contacts would then make energy. Differences by rounding are allowed.
void FixClump::refuse_unequal_velocities() const {
  constexpr double relative = 1e-6, absolute = 1e-9; // of the speed; m/s
  std::array<double, 6> most{};                      // of the velocity along x to z, and of its negative
  most.fill(-std::numeric_limits<double>::infinity());
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit)
      for (std::size_t a = 0; a < 3; ++a) {
        most[a] = std::max(most[a], atom->v[i][a]);
        most[a + 3] = std::max(most[a + 3], -atom->v[i][a]);
      }
  MPI_Allreduce(MPI_IN_PLACE, most.data(), static_cast<int>(most.size()), MPI_DOUBLE, MPI_MAX, world);
  const double speed = *std::max_element(most.begin(), most.end());
  for (std::size_t a = 0; a < 3; ++a)
    if (most[a] + most[a + 3] > relative * speed + absolute)
      error->all(
          FLERR,
          drumlin::engine::error_text(fmt::format(
              "fix clump: velocity of the balls of group {} along {} is '{:.9g} to {:.9g} m/s'; allowed: one "
              "velocity for all balls of a body, from the start (command velocity GROUP set)",
              group->names[igroup], "xyz"[a], -most[a + 3], most[a])));
}

void FixClump::setup(int vflag) { post_force(vflag); }

void FixClump::post_force(int) {
  double **f = atom->f;
  force_ = {};
  double mass = 0.0;   // of this rank's balls, which may have changed
  double torque = 0.0; // about the axle of a body that rolls
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      mass += atom->rmass[i];
      for (std::size_t a = 0; a < 3; ++a)
        force_[a] += f[i][a];
      if (roller_ != nullptr) torque += roller_->torque_about_axle(i, f[i]);
    }
  const std::array<double, 5> mine{force_[0], force_[1], force_[2], mass, torque};
  std::array<double, 5> all{};
  MPI_Allreduce(mine.data(), all.data(), roller_ != nullptr ? 5 : 4, MPI_DOUBLE, MPI_SUM, world);
  drumlin::engine::follow_mass(mass_, all[3]);
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      const double share = atom->rmass[i] / mass_;
      for (std::size_t a = 0; a < 3; ++a)
        f[i][a] = all[a] * share;
      for (std::size_t a = 0; roller_ != nullptr && a < 3; ++a)
        atom->torque[i][a] += all[4] * share * roller_->axle()[a];
    }
}

double FixClump::compute_vector(int n) {
  if (n == 0) return mass_;
  double all = 0.0;
  MPI_Allreduce(&force_[static_cast<std::size_t>(n - 1)], &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

void *FixClump::extract(const char *name, int &dimensions) {
  dimensions = 1;
  return std::string(name) == "force" ? force_.data() : nullptr;
}
