#include "fixes/fix_drum_excite.h"

#include "support/arguments.h"
#include "contact/fix_stepping.h"
#include "fixes/fix_clump.h"
#include "fixes/fix_drum_travel.h"
#include "support/restart_record.h"

#include <fmt/format.h>

using namespace LAMMPS_NS;
using drumlin::Range;
namespace engine = drumlin::engine;
namespace physics = drumlin::physics;

namespace {

constexpr double two_pi = 6.283185307179586;

std::array<double, 3> cross(const std::array<double, 3> &a, const std::array<double, 3> &b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

} // namespace

FixDrumExcite::FixDrumExcite(LAMMPS *lammps, int narg, char **arg) : Fix(lammps, narg, arg) {
  scalar_flag = vector_flag = 1;
  size_vector = 6;
  extscalar = extvector = 0;
  global_freq = 1;
  restart_global = 1;
  time_depend = 1; // the clock counts steps

  parse(narg, arg);
}

void FixDrumExcite::parse(int narg, char **arg) {
  drumlin::Arguments in(error, "fix drum/excite", narg - 3, arg + 3);
  bool has_amplitude = false;
  bool has_frequency = false;
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "amplitude" || keyword == "eccentric") {
      if (has_amplitude)
        in.fail("keyword is '" + keyword + "', a second amplitude; allowed: amplitude or eccentric, once");
      has_amplitude = true;
    }
    if (keyword == "omega" || keyword == "frequency") {
      if (has_frequency)
        in.fail("keyword is '" + keyword + "', a second frequency; allowed: omega or frequency, once");
      has_frequency = true;
    }
    if (keyword == "direction")
      given_direction_ = in.direction("keyword direction");
    else if (keyword == "axis")
      axis_ = in.direction("keyword axis");
    else if (keyword == "place")
      place_ = in.number("keyword place");
    else if (keyword == "travel")
      travel_id_ = in.word("keyword travel", "the ID of a fix drum/travel");
    else
      parse_excitation(in, keyword);
  }
  if (!has_amplitude) in.fail("keyword amplitude is missing; allowed: amplitude Fw or eccentric me re");
  if (!has_frequency) in.fail("keyword omega is missing; allowed: omega w or frequency f");
  if (excitation_.rotating && !axis_)
    in.fail("keyword axis is missing with mode rotating; allowed: axis x y z");
  if (!excitation_.rotating && axis_)
    in.fail("keyword mode is 'directed', with keyword axis; allowed: axis with mode rotating only");
  if (const std::string fault = excitation_.invalid(); !fault.empty()) in.fail(fault);
}

/// Keywords of the force in time.
void FixDrumExcite::parse_excitation(drumlin::Arguments &in, const std::string &keyword) {
  if (keyword == "amplitude") {
    excitation_.amplitude = in.number("keyword amplitude", Range::non_negative);
  } else if (keyword == "eccentric") {
    excitation_.eccentric = true;
    excitation_.eccentric_mass = in.number("keyword eccentric, mass", Range::positive);
    excitation_.eccentric_radius = in.number("keyword eccentric, radius", Range::positive);
  } else if (keyword == "omega") {
    excitation_.angular_frequency = in.number("keyword omega", Range::positive);
  } else if (keyword == "frequency") {
    excitation_.angular_frequency = in.number("keyword frequency", Range::positive) * two_pi;
  } else if (keyword == "phase") {
    excitation_.phase = in.number("keyword phase");
  } else if (keyword == "start") {
    excitation_.start = in.number("keyword start", Range::non_negative);
  } else if (keyword == "ramp") {
    excitation_.ramp = in.number("keyword ramp", Range::non_negative);
  } else if (keyword == "sweep") {
    excitation_.sweep_frequency = in.number("keyword sweep, end frequency", Range::positive);
    excitation_.sweep_duration = in.number("keyword sweep, duration", Range::positive);
  } else if (keyword == "mode") {
    excitation_.rotating = in.choice("keyword mode", {"directed", "rotating"}) == 1;
  } else {
    in.fail("keyword", keyword,
            "amplitude, eccentric, omega, frequency, phase, start, ramp, sweep, direction, mode, axis, place "
            "or travel");
  }
}

int FixDrumExcite::setmask() { return FixConst::POST_INTEGRATE | FixConst::POST_FORCE; }

void FixDrumExcite::init() {
  deck_check_.of_fix(lmp, *this);
  if (group->count(igroup) == 0)
    error->all(FLERR,
               engine::error_text(fmt::format(
                   "fix drum/excite: group is '{}', which is empty; allowed: a group with at least one ball",
                   group->names[igroup])));
  mass_ = group->mass(igroup);
  travel_ = dynamic_cast<FixDrumTravel *>(engine::find_fix(modify, travel_id_));
  if (!travel_id_.empty() && travel_ == nullptr)
    error->all(FLERR, engine::error_text(fmt::format(
                          "fix drum/excite: keyword travel is '{}'; allowed: the ID of a fix drum/travel",
                          travel_id_)));
  stepping_ = FixStepping::find(lmp);
  find_body();
  if (given_direction_) {
    direction_ = *given_direction_;
  } else {
    const Vector g = engine::gravity(modify);
    const double size = std::hypot(g[0], g[1], g[2]);
    if (size == 0.0)
      error->all(FLERR, "fix drum/excite: keyword direction is missing and there is no gravity to take it "
                        "from; allowed: direction x y z");
    direction_ = {g[0] / size, g[1] / size, g[2] / size};
  }
  if (axis_) {
    const double along =
        (*axis_)[0] * direction_[0] + (*axis_)[1] * direction_[1] + (*axis_)[2] * direction_[2];
    if (std::fabs(along) > 1e-12)
      error->all(FLERR,
                 engine::error_text(fmt::format(
                     "fix drum/excite: keyword axis is '{:.6g} {:.6g} {:.6g}', not at right angles to the "
                     "direction (cosine {:.6g}); allowed: an axis at right angles to the direction",
                     (*axis_)[0], (*axis_)[1], (*axis_)[2], along)));
    normal_ = cross(*axis_, direction_);
  }
}

/// The body that tilts, if the force acts beside its middle.
void FixDrumExcite::find_body() {
  Clumps clumps;
  clumps.find(*modify);
  body_ = place_ != 0.0 ? clumps.tilting(groupbit) : nullptr;
  if (place_ != 0.0 && body_ == nullptr)
    error->all(FLERR, engine::error_text(fmt::format(
                          "fix drum/excite: keyword place is '{:.6g} m'; allowed: 0, or the group of a fix "
                          "clump with keyword tilt",
                          place_)));
}

/// Calls add(i, f) for each ball of this rank with its share f of a force on the group, N. Collective if the
/// body tilts.
template <class Add>
void FixDrumExcite::share(const Vector &whole, const Add &add) const {
  const physics::AxleSums sums = body_ != nullptr ? body_->axle_sums() : physics::AxleSums();
  for (int i = 0; i < atom->nlocal; ++i) {
    if ((atom->mask[i] & groupbit) == 0) continue;
    if (body_ == nullptr) {
      const double part = atom->rmass[i] / mass_;
      add(i, Vector{part * whole[0], part * whole[1], part * whole[2]});
      continue;
    }
    const physics::TiltAxes &axes = *body_->tilts();
    const double s = physics::dot(body_->place_of(i), axes.axle);
    add(i, sums.share(axes, atom->rmass[i], s, whole, place_ * physics::dot(whole, axes.rise)));
  }
}

void FixDrumExcite::setup(int vflag) {
  clock_.set_up(update->ntimestep, update->dt);
  if (!echoed_ && comm->me == 0) {
    const double w = excitation_.angular_frequency;
    const std::string text = fmt::format(
        "fix drum/excite {}: {} Fw = {:.6g} N on {:.6g} kg, omega = {:.6g} rad/s ({:.6g} Hz), {:.6g} steps "
        "per cycle, direction {:.6g} {:.6g} {:.6g}\n",
        id, excitation_.rotating ? "rotating" : "directed",
        excitation_.eccentric ? excitation_.eccentric_mass * excitation_.eccentric_radius * w * w
                              : excitation_.amplitude,
        mass_, w, w / two_pi, two_pi / (w * update->dt), direction_[0], direction_[1], direction_[2]);
    drumlin::engine::log_message(lmp, text);
  }
  echoed_ = true;
  post_force(vflag);
}

// Second-order stepping predicts the velocity at the end of the step from the force of the last step. The
// excitation force at the end of the step is already known, so that its change is part of the prediction.
void FixDrumExcite::post_integrate() {
  clock_.follow(update->ntimestep, update->dt);
  if (stepping_ == nullptr) return;
  const Vector F = force_now();
  share(physics::sum(F, -1.0, acted_),
        [this](int i, const Vector &change) { stepping_->foresee(i, change); });
}

void FixDrumExcite::post_force(int) {
  const Vector F = force_now();
  acted_ = F;
  double mass = 0.0; // of this rank's balls, which may have changed
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) mass += atom->rmass[i];
  if (comm->nprocs > 1) MPI_Allreduce(MPI_IN_PLACE, &mass, 1, MPI_DOUBLE, MPI_SUM, world);
  engine::follow_mass(mass_, mass);
  share(F, [this](int i, const Vector &part) {
    for (std::size_t a = 0; a < 3; ++a)
      atom->f[i][a] += part[a];
  });
}

double FixDrumExcite::now() const { return clock_.time(update->ntimestep); }

/// Present amplitude over that without a roller that drives.
double FixDrumExcite::vibration() const { return travel_ != nullptr ? travel_->vibration() : 1.0; }

FixDrumExcite::Vector FixDrumExcite::force_now() const {
  const std::array<double, 2> part = physics::excitation_components(excitation_, now());
  const double share = vibration();
  Vector F{};
  for (std::size_t a = 0; a < 3; ++a)
    F[a] = share * (part[0] * direction_[a] + part[1] * normal_[a]);
  return F;
}

void FixDrumExcite::write_restart(FILE *file) {
  const auto state = clock_.state();
  drumlin::write_restart_record(file, comm->me, {state.begin(), state.end()});
}

void FixDrumExcite::restart(char *buffer) { clock_.restore(reinterpret_cast<const double *>(buffer)); }

double FixDrumExcite::compute_scalar() { return vibration() * physics::excitation_force(excitation_, now()); }

double FixDrumExcite::compute_vector(int n) {
  if (n < 3) return force_now()[static_cast<std::size_t>(n)];
  if (n == 3) return physics::excitation_phase(excitation_, now());
  return n == 4 ? physics::excitation_frequency(excitation_, now()) : now();
}
