#include "fixes/fix_drum_travel.h"

#include "contact/fix_stepping.h"
#include "support/arguments.h"
#include "support/restart_record.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

using namespace LAMMPS_NS;
using drumlin::Range;
namespace engine = drumlin::engine;
namespace physics = drumlin::physics;

namespace {

constexpr const char *command = "fix drum/travel";

using Vector = std::array<double, 3>;

double along(const Vector &axis, const double *v) { return axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2]; }

} // namespace

FixDrumTravel::FixDrumTravel(LAMMPS *lammps, int narg, char **arg) : Fix(lammps, narg, arg) {
  scalar_flag = vector_flag = 1;
  size_vector = 9;
  extscalar = extvector = 0;
  global_freq = 1;
  restart_global = 1;
  time_depend = 1; // the clock counts steps
  parse(narg, arg);
}

void FixDrumTravel::parse(int narg, char **arg) {
  drumlin::Arguments in(error, command, narg - 3, arg + 3);
  std::optional<double> from, to, speed;
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "from") {
      from = in.number("keyword from");
    } else if (keyword == "to") {
      to = in.number("keyword to");
    } else if (keyword == "speed") {
      speed = in.number("keyword speed", Range::positive);
    } else if (keyword == "ramp") {
      travel_.ramp = in.number("keyword ramp", Range::non_negative);
    } else if (keyword == "pause") {
      travel_.pause = in.number("keyword pause", Range::non_negative);
    } else if (keyword == "passes") {
      travel_.passes = static_cast<int>(in.integer("keyword passes", 1));
    } else if (keyword == "direction") {
      travel_.one_way = in.choice("keyword direction", {"both", "one"}) == 1;
    } else if (keyword == "axis") {
      axis_ = in.choice("keyword axis", {"x", "y", "z"});
    } else if (keyword == "rotation") {
      rotation_ = static_cast<Rotation>(in.choice("keyword rotation", {"none", "driven", "towed"}));
    } else if (keyword == "drum") {
      drum_group_ = in.group("keyword drum", group);
    } else if (keyword == "radius") {
      radius_ = in.number("keyword radius", Range::positive);
    } else if (keyword == "inertia") {
      inertia_ = in.number("keyword inertia", Range::positive);
    } else if (keyword == "up") {
      up_ = in.direction("keyword up");
    } else {
      in.fail("keyword", keyword,
              "from, to, speed, ramp, pause, passes, direction, axis, rotation, drum, radius, inertia or up");
    }
  }
  if (!from) in.fail("keyword from is missing; allowed: from S, the place where the roller stands");
  if (!to) in.fail("keyword to is missing; allowed: to S, the place where the first pass ends");
  if (!speed) in.fail("keyword speed is missing; allowed: speed V");
  travel_.from = *from;
  travel_.to = *to;
  travel_.speed = *speed;
  if (const std::string fault = travel_.invalid(); !fault.empty()) in.fail(fault);
  if (radius_ && rotation_ != Rotation::driven)
    in.fail("keyword radius", physics::detail::number_text(*radius_), "with rotation driven only");
  if (inertia_ && rotation_ == Rotation::none)
    in.fail("keyword inertia", physics::detail::number_text(*inertia_), "with rotation driven or towed only");
  if (drum_group_ < 0) drum_group_ = igroup;
  drum_bit_ = engine::group_bit(drum_group_);
}

int FixDrumTravel::setmask() {
  return FixConst::PRE_EXCHANGE | FixConst::INITIAL_INTEGRATE | FixConst::FINAL_INTEGRATE;
}

void FixDrumTravel::init() {
  deck_check_.of_fix(lmp, *this);
  if (group->count(igroup) == 0)
    error->all(FLERR,
               engine::error_text(fmt::format("{}: group is '{}', which is empty; allowed: a group with the "
                                              "balls that drive",
                                              command, group->names[igroup])));
  stepping_ = FixStepping::find(lmp);
  refuse_order();
  find_axle();
  find_drum();
}

/// The fixes that integrate the balls must act before this one, and no two may prescribe the motion of a
/// ball.
void FixDrumTravel::refuse_order() {
  bool later = false;
  for (const Fix *other : engine::fixes(modify)) {
    later = later || other == this;
    const bool travels = other != this && dynamic_cast<const FixDrumTravel *>(other) != nullptr;
    if (!travels && !(later && other->time_integrate != 0)) continue;
    int common = 0;
    for (int i = 0; i < atom->nlocal; ++i)
      common += (atom->mask[i] & groupbit) && (atom->mask[i] & other->groupbit) ? 1 : 0;
    MPI_Allreduce(MPI_IN_PLACE, &common, 1, MPI_INT, MPI_SUM, world);
    if (common > 0)
      error->all(FLERR,
                 engine::error_text(fmt::format(
                     "{}: group is '{}', of which {} balls are moved by fix {} ({}){}; allowed: {}", command,
                     group->names[igroup], common, other->id, other->style, travels ? "" : " behind it",
                     travels ? "one fix drum/travel for a ball"
                             : "fix drum/travel behind all fixes that "
                               "integrate its balls")));
  }
}

/// The axle is horizontal and at right angles to the way.
void FixDrumTravel::find_axle() {
  if (rotation_ == Rotation::none) return;
  Vector up = up_.value_or(engine::gravity(modify));
  if (!up_)
    for (double &component : up)
      component = -component;
  up[static_cast<std::size_t>(axis_)] = 0.0;
  if (domain->dimension == 2) up[2] = 0.0;
  const double size = std::hypot(up[0], up[1], up[2]);
  if (size == 0.0)
    error->all(FLERR, engine::error_text(fmt::format(
                          "{}: keyword rotation is '{}', and {} across the way; allowed: with a direction up",
                          command, rotation_ == Rotation::driven ? "driven" : "towed",
                          up_ ? "keyword up has no part" : "there is neither gravity nor a keyword up")));
  Vector way{};
  way[static_cast<std::size_t>(axis_)] = 1.0;
  for (std::size_t a = 0; a < 3; ++a)
    axle_[a] = (up[(a + 1) % 3] * way[(a + 2) % 3] - up[(a + 2) % 3] * way[(a + 1) % 3]) / size;
}

/// The ball that rolls.
void FixDrumTravel::find_drum() {
  if (rotation_ == Rotation::none) return;
  std::array<double, 4> all{}; // balls, those that drive, mass, radius
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & drum_bit_) {
      const std::array<double, 4> one{1.0, atom->mask[i] & groupbit ? 1.0 : 0.0, atom->rmass[i],
                                      atom->radius[i]};
      for (std::size_t n = 0; n < 4; ++n)
        all[n] += one[n];
    }
  MPI_Allreduce(MPI_IN_PLACE, all.data(), 4, MPI_DOUBLE, MPI_SUM, world);
  if (all[0] != 1.0 || all[1] != 1.0)
    error->all(FLERR,
               engine::error_text(fmt::format(
                   "{}: keyword drum is '{}', a group of {:.0f} balls, of which {:.0f} drive; allowed: "
                   "a group of one ball that drives, or rotation none",
                   command, group->names[drum_group_], all[0], all[1])));
  rolling_radius_ = radius_.value_or(all[3]);
  ball_inertia_ = engine::inertia_share(lmp) * all[2] * all[3] * all[3];
  drum_inertia_ = inertia_.value_or(ball_inertia_);
}

/// Velocities must be right before forces are computed for the set-up of the run.
void FixDrumTravel::setup_pre_exchange() {
  clock_.set_up(update->ntimestep, update->dt);
  now_ = physics::travel_state(travel_, clock_.time(update->ntimestep));
  if (spacing_ == 0.0)
    begin();
  else if (const double place = on_grid(now_.distance); place != moved_)
    error->all(FLERR, engine::error_text(fmt::format(
                          "{}: way driven is '{:.9g} m' after {:.9g} s, and {:.9g} m by these keywords; "
                          "allowed: those of the run before",
                          command, moved_, clock_.time(update->ntimestep), place)));
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) atom->v[i][axis_] = now_.velocity;
  if (rotation_ == Rotation::driven) spin_ = now_.velocity / rolling_radius_;
  rotate(spin_);
}

/// The positions along the axis are multiples of a power of 2, as the way driven is: then no step rounds
/// them, and all balls of the group keep their distances.
void FixDrumTravel::begin() {
  const double infinite = std::numeric_limits<double>::infinity();
  std::array<double, 2> ends{-infinite, -infinite}; // of the balls' negative places, and places
  Vector x{};
  double spin = 0.0;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      domain->unmap(atom->x[i], atom->image[i], x.data());
      const double place = x[static_cast<std::size_t>(axis_)];
      ends = {std::max(ends[0], -place), std::max(ends[1], place)};
      if (atom->mask[i] & drum_bit_) spin = along(axle_, atom->omega[i]);
    }
  MPI_Allreduce(MPI_IN_PLACE, ends.data(), 2, MPI_DOUBLE, MPI_MAX, world);
  const double sign = travel_.to > travel_.from ? 1.0 : -1.0;
  refuse_leaving(-ends[0] + std::min(0.0, sign * travel_.reach()),
                 ends[1] + std::max(0.0, sign * travel_.reach()));
  int exponent = 0;
  std::frexp(std::max({ends[0], ends[1], 0.0}) + travel_.reach(), &exponent);
  spacing_ = std::ldexp(1.0, exponent - std::numeric_limits<double>::digits);
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      double &place = atom->x[i][axis_];
      place = on_grid(place);
    }
  moved_ = 0.0;
  if (rotation_ != Rotation::towed) return;
  MPI_Allreduce(&spin, &spin_, 1, MPI_DOUBLE, MPI_SUM, world); // a towed drum may turn already
}

/// \param least, most coordinates that a ball of the group comes to, m
void FixDrumTravel::refuse_leaving(double least, double most) const {
  constexpr int fixed = 1;
  const int *boundary = domain->boundary[axis_];
  const double low = domain->boxlo[axis_], high = domain->boxhi[axis_];
  if (domain->periodicity[axis_] ||
      !((boundary[0] == fixed && least < low) || (boundary[1] == fixed && most > high)))
    return;
  error->all(FLERR, engine::error_text(fmt::format(
                        "{}: way is '{:.9g} to {:.9g} m' along {} for the centres of the balls; allowed: "
                        "inside of the box, {:.9g} to {:.9g} m",
                        command, least, most, "xyz"[axis_], low, high)));
}

void FixDrumTravel::setup(int) {
  note_places();
  const Sums now = sums(false);
  if (echoed_) return;
  echoed_ = true;
  engine::log_message(
      lmp, fmt::format("fix drum/travel {}: {:.9g} kg along {} from {:.6g} to {:.6g} m at {:.6g} m/s, passes "
                       "{}, {:.9g} s in all\n",
                       id, now.mass, "xyz"[axis_], travel_.from, travel_.to, travel_.speed, travel_.passes,
                       travel_.duration()));
}

/// Force along the way and torque about the axle, of all but what drives. \param opening whether the forces
/// are those of an opening half kick
FixDrumTravel::Sums FixDrumTravel::sums(bool opening) const {
  std::array<double, 3> all{};
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      all[0] += atom->f[i][axis_];
      all[2] += atom->rmass[i];
      if (rotation_ != Rotation::none && (atom->mask[i] & drum_bit_)) all[1] += along(axle_, atom->torque[i]);
    }
  if (opening && stepping_ != nullptr)
    all[0] -= stepping_->position_corrections(groupbit)[static_cast<std::size_t>(axis_)];
  if (comm->nprocs > 1) MPI_Allreduce(MPI_IN_PLACE, all.data(), 3, MPI_DOUBLE, MPI_SUM, world);
  return {all[0], all[1], all[2]};
}

void FixDrumTravel::rotate(double spin) {
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & (rotation_ == Rotation::none ? groupbit : drum_bit_))
      for (std::size_t a = 0; a < 3; ++a)
        atom->omega[i][a] = spin * axle_[a];
}

/// Notes the places of this rank's balls. Until the next step begins their order stays the same; at most one
/// is removed.
void FixDrumTravel::note_places() {
  places_.clear();
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) places_.emplace_back(atom->tag[i], atom->x[i][axis_]);
}

void FixDrumTravel::initial_integrate(int) {
  opening_ = sums(true);
  clock_.follow(update->ntimestep, update->dt);
  const double begin = clock_.time(update->ntimestep - 1), end = clock_.time(update->ntimestep);
  before_ = now_;
  now_ = physics::travel_state(travel_, end);
  half_velocity_ = physics::mean_velocity(travel_, begin, end, before_, now_);
  const double moved = on_grid(now_.distance), way = moved - moved_;
  moved_ = moved;
  auto place = places_.begin();
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      while (place != places_.end() && place->first != atom->tag[i])
        ++place;
      if (place == places_.end()) break;
      atom->x[i][axis_] = place->second + way;
      atom->v[i][axis_] = half_velocity_;
      if (stepping_ != nullptr) stepping_->prescribe(i, axis_, 2.0 * half_velocity_ - now_.velocity);
    }
  half_spin_ =
      rotation_ == Rotation::driven ? half_velocity_ / rolling_radius_ : spin_ + spin_change(opening_.torque);
  rotate(half_spin_);
}

/// Prescribes the velocities at the end of the step. The traction is what the change of momentum needs beyond
/// all other forces.
void FixDrumTravel::final_integrate() {
  const Sums closing = sums(false);
  const double dt = clock_.dt(), impulse = 0.5 * dt * (opening_.force + closing.force);
  const double momentum = closing.mass * (now_.velocity - before_.velocity);
  traction_ = (momentum - impulse) / dt;
  work_ += 0.5 * momentum * (now_.velocity + before_.velocity) - impulse * half_velocity_;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) atom->v[i][axis_] = now_.velocity;
  note_places();

  const double spin_before = spin_;
  if (rotation_ == Rotation::driven)
    spin_ = now_.velocity / rolling_radius_;
  else
    spin_ = half_spin_ + spin_change(closing.torque);
  rotate(spin_);
  if (rotation_ == Rotation::towed) return; // nothing turns it but the soil
  const double twist = 0.5 * dt * (opening_.torque + closing.torque);
  const double spun = drum_inertia_ * (spin_ - spin_before);
  torque_ = (spun - twist) / dt;
  torque_work_ += 0.5 * spun * (spin_ + spin_before) - twist * half_spin_;
}

/// Change of a towed drum's angular velocity in half a step, rad/s.
double FixDrumTravel::spin_change(double torque) const {
  return rotation_ == Rotation::towed ? 0.5 * update->dt * torque / drum_inertia_ : 0.0;
}

void FixDrumTravel::add_work(double work) {
  work_ += work;
  if (const double way = way_of_step(); way != 0.0) traction_ += work / way;
}

double FixDrumTravel::time_in_pass() const {
  return clock_.time(update->ntimestep) - (now_.pass - 1) * (travel_.pass_time() + travel_.pause);
}

double FixDrumTravel::on_grid(double place) const { return spacing_ * std::nearbyint(place / spacing_); }

double FixDrumTravel::further_kinetic() const {
  return 0.5 * (drum_inertia_ - ball_inertia_) * spin_ * spin_;
}

void FixDrumTravel::write_restart(FILE *file) {
  const auto clock = clock_.state();
  std::vector<double> state(clock.begin(), clock.end());
  state.insert(state.end(), {spacing_, moved_, spin_, traction_, torque_, work_, torque_work_});
  drumlin::write_restart_record(file, comm->me, state);
}

void FixDrumTravel::restart(char *buffer) {
  const double *state = reinterpret_cast<const double *>(buffer);
  clock_.restore(state);
  state += clock_.state().size();
  for (double *number : {&spacing_, &moved_, &spin_, &traction_, &torque_, &work_, &torque_work_})
    *number = *state++;
}

double FixDrumTravel::compute_scalar() { return travel_.duration(); }

double FixDrumTravel::compute_vector(int n) {
  const std::array<double, 9> values{
      static_cast<double>(now_.pass), now_.place, now_.velocity, traction_, torque_, work_, torque_work_,
      clock_.time(update->ntimestep), spin_};
  return values[static_cast<std::size_t>(n)];
}

void *FixDrumTravel::extract(const char *name, int &dimensions) {
  dimensions = 0;
  return std::string(name) == "axis" ? &axis_ : nullptr;
}
