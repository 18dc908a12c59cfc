#include "fixes/fix_clump.h"

#include "contact/contact_source.h"
#include "fixes/fix_drum_travel.h"
#include "support/arguments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <string>

using namespace LAMMPS_NS;
namespace physics = drumlin::physics;

FixClump::FixClump(LAMMPS *lammps, int narg, char **arg) : Fix(lammps, narg, arg) {
  vector_flag = 1;
  size_vector = 4;
  extvector = 0;
  global_freq = 1;
  links_.resize(static_cast<std::size_t>(atom->ntypes) + 1);
  drumlin::Arguments in(error, "fix clump", narg - 3, arg + 3);
  parse(in);
  if (igroup == 0) in.fail("group", "all", "a group with the balls of the body, which is not all");
}

void FixClump::parse(drumlin::Arguments &in) {
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "tilt") {
      const std::array<double, 3> axis = in.direction("keyword tilt");
      in.choice("word behind the axis of keyword tilt", {"axle"});
      const std::array<double, 3> axle = in.direction("keyword tilt, axle");
      if (const double along = physics::dot(axis, axle); std::fabs(along) > 1e-12)
        in.fail(fmt::format("keyword tilt, axle is '{:.6g} {:.6g} {:.6g}', not at right angles to the axis "
                            "of the tilt (cosine {:.6g}); allowed: an axle at right angles to the axis",
                            axle[0], axle[1], axle[2], along));
      axes_.emplace(axis, axle);
    } else if (keyword == "links") {
      const auto type = in.integer("keyword links, type", 1, atom->ntypes);
      links_[static_cast<std::size_t>(type)] =
          static_cast<double>(in.integer("keyword links, number of contacts or bonds", 1));
    } else {
      in.fail("argument", keyword, "fix ID group clump, then keywords tilt or links");
    }
  }
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
  if (axes_) {
    refuse_other_shape();
    refuse_torques();
  }
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
    if (axes_ && std::string(other.style) == "drum/travel" && common_balls(other) > 0)
      error->all(FLERR, drumlin::engine::error_text(fmt::format(
                            "fix clump: keyword tilt has the group '{}', which fix {} (drum/travel) drives; "
                            "allowed: a body that does not drive",
                            group->names[igroup], other.id)));
    const bool forces = later && (drumlin::engine::fix_mask(modify, fix) & FixConst::POST_FORCE);
    later = later || fix == this;
    if (!forces) continue;
    const std::string its_style = other.style;
    const int common = common_balls(other);
    const bool keeps_equal = std::find(harmless.begin(), harmless.end(), its_style) != harmless.end() &&
                             (its_style != "drum/excite" || common == static_cast<int>(balls));
    if (!keeps_equal && common > 0)
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
  const physics::AxleSums sums = axes_ ? axle_sums() : physics::AxleSums();
  // Largest velocity of a ball along x, y and z, and largest negative one; the velocity that a ball has
  // because the body tilts does not count.
  std::array<double, 6> most{};
  most.fill(-std::numeric_limits<double>::infinity());
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      std::array<double, 3> v{atom->v[i][0], atom->v[i][1], atom->v[i][2]};
      if (axes_)
        v = physics::sum(v, -sums.rate() * (physics::dot(place_of(i), axes_->axle) - sums.centre()),
                         axes_->rise);
      for (std::size_t a = 0; a < 3; ++a) {
        most[a] = std::max(most[a], v[a]);
        most[a + 3] = std::max(most[a + 3], -v[a]);
      }
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

/// The equations of the tilt are those of balls on one axle, or beside each other along the axis.
void FixClump::refuse_other_shape() const {
  constexpr double flat = 1e-6; // of the radius of gyration
  const physics::AxleSums sums = axle_sums();
  const double gyration = std::sqrt(std::max(0.0, sums.inertia()) / sums.mass());
  double off = 0.0; // m
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      const std::array<double, 3> x = place_of(i);
      const double s = physics::dot(x, axes_->axle) - sums.centre();
      const double height = physics::dot(x, axes_->rise) - sums.height();
      off = std::max(off, std::fabs(height - (gyration > 0.0 ? sums.tilt() * s : 0.0)));
    }
  MPI_Allreduce(MPI_IN_PLACE, &off, 1, MPI_DOUBLE, MPI_MAX, world);
  if (!(gyration > 0.0))
    error->all(FLERR, drumlin::engine::error_text(fmt::format(
                          "fix clump: keyword tilt has the group '{}', whose balls have the inertia '{:.6g} "
                          "kg m2' about the axis; allowed: balls at different places along the axle",
                          group->names[igroup], sums.inertia())));
  if (off > flat * gyration)
    error->all(FLERR, drumlin::engine::error_text(fmt::format(
                          "fix clump: keyword tilt has the group '{}', of which a ball is '{:.6g} m' off the "
                          "plane of axis and axle; allowed: balls on one axle, or beside each other along "
                          "the axis",
                          group->names[igroup], off)));
  refuse_large_tilt(sums);
}

/// Friction acts at the surface of a ball, at a distance from the axle that the equations do not know.
void FixClump::refuse_torques() const {
  const drumlin::ContactSource *source = drumlin::contact_source(lmp);
  if (source != nullptr && source->friction_model() != drumlin::FrictionModel::none)
    error->all(FLERR, "fix clump: keyword tilt is given with a pair style that has friction; allowed: pair "
                      "styles without it");
}

void FixClump::refuse_large_tilt(const physics::AxleSums &sums) const {
  if (!(std::fabs(sums.tilt()) <= physics::largest_tilt))
    drumlin::engine::stop(
        lmp, fmt::format("fix clump: tilt of group {} is '{:.6g} rad' at step {}; allowed: at most {} rad, "
                         "since the equations are those of small angles",
                         group->names[igroup], sums.tilt(), update->ntimestep, physics::largest_tilt));
}

std::array<double, 3> FixClump::place_of(int i) const {
  std::array<double, 3> x{};
  domain->unmap(atom->x[i], atom->image[i], x.data());
  return x;
}

physics::AxleSums FixClump::axle_sums() const {
  const auto vector = [](const double *v) { return physics::Vec3{v[0], v[1], v[2]}; };
  physics::AxleSums sums;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit)
      sums.add(*axes_, atom->rmass[i], place_of(i), vector(atom->v[i]), vector(atom->f[i]));
  if (comm->nprocs > 1)
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), physics::AxleSums::size(), MPI_DOUBLE, MPI_SUM, world);
  return sums;
}

/// Gives each ball its share of force and moment.
void FixClump::distribute(const physics::AxleSums &sums) const {
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      const double s = physics::dot(place_of(i), axes_->axle);
      const physics::Vec3 share = sums.share(*axes_, atom->rmass[i], s, sums.force(), sums.moment());
      std::copy(share.begin(), share.end(), atom->f[i]);
    }
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
  if (axes_) {
    const physics::AxleSums sums = axle_sums();
    refuse_large_tilt(sums);
    return distribute(sums);
  }
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
