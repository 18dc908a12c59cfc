#include "fixes/fix_drum_travel.h"

#include "contact/fix_stepping.h"
#include "fixes/fix_clump.h"
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

constexpr const char *travel_fix = "fix drum/travel";

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
  drumlin::Arguments in(error, travel_fix, narg - 3, arg + 3);
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
                                              travel_fix, group->names[igroup])));
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
      error->all(FLERR, engine::error_text(fmt::format(
                            "{}: group is '{}', of which {} balls are moved by fix {} ({}){}; allowed: {}",
                            travel_fix, group->names[igroup], common, other->id, other->style,
                            travels ? "" : " behind it",
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
                          travel_fix, rotation_ == Rotation::driven ? "driven" : "towed",
                          up_ ? "keyword up has no part" : "there is neither gravity nor a keyword up")));
  Vector way{};
  way[static_cast<std::size_t>(axis_)] = 1.0;
  for (std::size_t a = 0; a < 3; ++a)
    upwards_[a] = up[a] / size;
  axle_ = physics::cross(upwards_, way);
}

/// The ball or the clump that rolls.
void FixDrumTravel::find_drum() {
  clump_ = false;
  if (rotation_ == Rotation::none) return body_.clear();
  std::array<double, 3> all{}; // balls, those that drive, radius
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & drum_bit_) {
      const std::array<double, 3> one{1.0, atom->mask[i] & groupbit ? 1.0 : 0.0, atom->radius[i]};
      for (std::size_t n = 0; n < 3; ++n)
        all[n] += one[n];
    }
  MPI_Allreduce(MPI_IN_PLACE, all.data(), 3, MPI_DOUBLE, MPI_SUM, world);
  bool is_clump = false;
  for (const Fix *fix : engine::fixes(modify))
    is_clump = is_clump || (dynamic_cast<const FixClump *>(fix) != nullptr && fix->igroup == drum_group_);
  clump_ = is_clump && all[0] > 1.0;
  if ((all[0] != 1.0 && !clump_) || all[1] != all[0])
    error->all(FLERR,
               engine::error_text(fmt::format(
                   "{}: keyword drum is '{}', a group of {:.0f} balls, of which {:.0f} drive; allowed: "
                   "one ball that drives, the group of a fix clump that drives, or rotation none",
                   travel_fix, group->names[drum_group_], all[0], all[1])));
  if (clump_ && rotation_ == Rotation::driven && !radius_)
    error->all(FLERR,
               engine::error_text(fmt::format("{}: keyword radius is missing, and drum is '{}', a clump; "
                                              "allowed: radius R, at which it rolls",
                                              travel_fix, group->names[drum_group_])));
  rolling_radius_ = radius_.value_or(all[2]);
}

/// Moments of inertia about the axle: that of the drum, and that with which the engine counts its energy.
void FixDrumTravel::find_inertia() {
  if (rotation_ == Rotation::none) return;
  const double share = engine::inertia_share(lmp);
  ball_inertia_ = 0.0;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & drum_bit_)
      ball_inertia_ += share * atom->rmass[i] * atom->radius[i] * atom->radius[i];
  for_each_of_clump([&](int i, const physics::InPlane &place) {
    ball_inertia_ += atom->rmass[i] * (place.along * place.along + place.up * place.up);
  });
  MPI_Allreduce(MPI_IN_PLACE, &ball_inertia_, 1, MPI_DOUBLE, MPI_SUM, world);
  drum_inertia_ = inertia_.value_or(ball_inertia_);
}

template <class Act>
void FixDrumTravel::for_each_of_clump(const Act &act) const {
  if (!clump_) return;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & drum_bit_) act(i, place_in_body(i));
}

const physics::InPlane &FixDrumTravel::place_in_body(int i) const {
  return std::lower_bound(body_.begin(), body_.end(), static_cast<double>(atom->tag[i]),
                          [](const BodyBall &ball, double tag) { return ball.tag < tag; })
      ->place;
}

physics::InPlane FixDrumTravel::in_plane(const double *vector) const {
  return {vector[axis_], along(upwards_, vector)};
}

/// Replaces the parts of a vector in the plane in which the drum rolls.
void FixDrumTravel::set_in_plane(double *vector, const physics::InPlane &parts) const {
  const double before = along(upwards_, vector);
  for (std::size_t a = 0; a < 3; ++a)
    vector[a] = (vector[a] - upwards_[a] * before) + upwards_[a] * parts.up;
  vector[axis_] = parts.along;
}

double FixDrumTravel::torque_about_axle(int i, const double *pull) const {
  Vector x{};
  domain->unmap(atom->x[i], atom->image[i], x.data());
  const physics::InPlane place = in_plane(x.data()), by = in_plane(pull);
  return (place.up - height_) * by.along - (place.along - start_ - moved_) * by.up;
}

/// Velocities must be right before forces are computed for the set-up of the run.
void FixDrumTravel::setup_pre_exchange() {
  clock_.set_up(update->ntimestep, update->dt);
  now_ = physics::travel_state(travel_, clock_.time(update->ntimestep));
  if (!begun())
    begin();
  else if (const double place = on_grid(now_.distance); place != moved_)
    error->all(FLERR, engine::error_text(fmt::format(
                          "{}: way driven is '{:.9g} m' after {:.9g} s, and {:.9g} m by these keywords; "
                          "allowed: those of the run before",
                          travel_fix, moved_, clock_.time(update->ntimestep), place)));
  else if (clump_)
    check_clump();
  find_inertia();
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) atom->v[i][axis_] = now_.velocity;
  if (rotation_ == Rotation::driven) spin_ = now_.velocity / rolling_radius_;
  rotate(spin_);
  end_clump();
}

/// The positions along the axis are multiples of a power of 2, as the way driven is: then no step rounds
/// them, and all balls of the group keep their distances.
void FixDrumTravel::begin() {
  const double infinite = std::numeric_limits<double>::infinity();
  std::array<double, 2> ends{-infinite, -infinite}; // of the balls' negative places, and places
  Vector x{};
  std::array<double, 2> spin{}; // sum over the drum's balls, and their number
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      domain->unmap(atom->x[i], atom->image[i], x.data());
      const double place = x[static_cast<std::size_t>(axis_)];
      ends = {std::max(ends[0], -place), std::max(ends[1], place)};
      if (atom->mask[i] & drum_bit_) spin = {spin[0] + along(axle_, atom->omega[i]), spin[1] + 1.0};
    }
  MPI_Allreduce(MPI_IN_PLACE, ends.data(), 2, MPI_DOUBLE, MPI_MAX, world);
  const auto [low, high] = way_of_centre();
  refuse_leaving(low - ends[0], ends[1] + high);
  int exponent = 0;
  std::frexp(std::max({ends[0], ends[1], 0.0}) + travel_.reach(), &exponent);
  spacing_ = std::ldexp(1.0, exponent - std::numeric_limits<double>::digits);
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      double &place = atom->x[i][axis_];
      place = on_grid(place);
    }
  moved_ = 0.0;
  if (clump_) begin_clump();
  if (rotation_ != Rotation::towed) return;
  MPI_Allreduce(MPI_IN_PLACE, spin.data(), 2, MPI_DOUBLE, MPI_SUM, world);
  spin_ = spin[0] / spin[1]; // a towed drum may turn already
}

/// Notes the places of the clump's balls relative to the axle, which goes through its centre of mass.
void FixDrumTravel::begin_clump() {
  struct Found { // numbers only, for MPI
    double tag, mass, along, up, rise;
  };
  constexpr int numbers = sizeof(Found) / sizeof(double);
  std::vector<Found> mine;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & drum_bit_) {
      Vector x{};
      domain->unmap(atom->x[i], atom->image[i], x.data());
      const physics::InPlane place = in_plane(x.data());
      mine.push_back({static_cast<double>(atom->tag[i]), atom->rmass[i], place.along, place.up,
                      along(upwards_, atom->v[i])});
    }
  const int count = numbers * static_cast<int>(mine.size());
  std::vector<int> counts(static_cast<std::size_t>(comm->nprocs)), begins(counts.size());
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
  for (std::size_t n = 1; n < counts.size(); ++n)
    begins[n] = begins[n - 1] + counts[n - 1];
  std::vector<Found> all(static_cast<std::size_t>((begins.back() + counts.back()) / numbers));
  MPI_Allgatherv(mine.data(), count, MPI_DOUBLE, all.data(), counts.data(), begins.data(), MPI_DOUBLE, world);
  std::sort(all.begin(), all.end(), [](const Found &a, const Found &b) { return a.tag < b.tag; });

  double mass = 0.0;
  for (const Found &ball : all)
    mass += ball.mass;
  const auto mean = [&](const auto &of) {
    double sum = 0.0;
    for (const Found &ball : all)
      sum += ball.mass * of(ball);
    return sum / mass;
  };
  start_ = on_grid(mean([](const Found &ball) { return ball.along; }));
  height_ = mean([](const Found &ball) { return ball.up; });
  rise_ = mean([](const Found &ball) { return ball.rise; });
  angle_ = 0.0;
  // The places in the body have the mean 0 to the rounding of a radius, also far from the origin: the mean
  // velocity of its balls is then that of the axle.
  const physics::InPlane middle{mean([this](const Found &ball) { return ball.along - start_; }),
                                mean([this](const Found &ball) { return ball.up - height_; })};
  double reach = 0.0; // of the body's balls, m, from the axle
  body_.clear();
  for (const Found &ball : all) {
    body_.push_back({ball.tag, {ball.along - start_ - middle.along, ball.up - height_ - middle.up}});
    reach = std::max(reach, std::hypot(body_.back().place.along, body_.back().place.up));
  }
  const auto [low, high] = way_of_centre();
  refuse_leaving(start_ - reach + low, start_ + reach + high);
  refuse_torn(reach);
}

/// Balls on both sides of a periodic boundary are one body only if their images say so.
void FixDrumTravel::refuse_torn(double reach) const {
  for (std::size_t a = 0; a < 3; ++a)
    if (axle_[a] == 0.0 && domain->periodicity[a] && 4.0 * reach > domain->prd[a])
      error->all(FLERR,
                 engine::error_text(fmt::format(
                     "{}: keyword drum is '{}', a clump of which a ball is {:.6g} m away from the "
                     "middle; allowed: at most a quarter of the periodic box along {}, {:.6g} m, and "
                     "images (command set) side by side",
                     travel_fix, group->names[drum_group_], reach, "xyz"[a], 0.25 * domain -> prd[a])));
}

/// How far the group comes from where it stands at first towards smaller and greater places, m.
std::pair<double, double> FixDrumTravel::way_of_centre() const {
  const double sign = travel_.to > travel_.from ? 1.0 : -1.0;
  return {std::min(0.0, sign * travel_.reach()), std::max(0.0, sign * travel_.reach())};
}

/// The clump must still be the body that has rolled before.
void FixDrumTravel::check_clump() const {
  constexpr double rounding = 1e-9;
  std::array<double, 2> counts{}; // balls, and those that have rolled
  std::array<double, 2> worst{};  // distances from place, m, and velocity, m/s, in the body
  const physics::Turn turn(angle_);
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & drum_bit_) {
      counts[0] += 1.0;
      const auto same = [&](const BodyBall &ball) { return ball.tag == static_cast<double>(atom->tag[i]); };
      const auto ball = std::find_if(body_.begin(), body_.end(), same);
      if (ball == body_.end()) continue;
      counts[1] += 1.0;
      Vector x{};
      domain->unmap(atom->x[i], atom->image[i], x.data());
      const physics::InPlane place = in_plane(x.data()), v = in_plane(atom->v[i]), lever = turn(ball->place);
      const physics::InPlane turning = physics::turning_velocity(spin_, lever);
      worst[0] = std::max({worst[0], std::fabs(place.along - start_ - moved_ - lever.along),
                           std::fabs(place.up - height_ - lever.up)});
      worst[1] = std::max({worst[1], std::fabs(v.along - now_.velocity - turning.along),
                           std::fabs(v.up - rise_ - turning.up)});
    }
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), 2, MPI_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(MPI_IN_PLACE, worst.data(), 2, MPI_DOUBLE, MPI_MAX, world);
  const auto rolled = static_cast<double>(body_.size());
  if (counts[0] != rolled || counts[1] != rolled)
    error->all(FLERR, engine::error_text(fmt::format(
                          "{}: keyword drum is '{}', a clump of {:.0f} balls, of which {:.0f} are among the "
                          "{:.0f} that rolled in the run before; allowed: the clump of the run before",
                          travel_fix, group->names[drum_group_], counts[0], counts[1], rolled)));
  const double size = std::fabs(start_) + std::fabs(moved_) + std::fabs(height_) + travel_.reach();
  const double speed = travel_.speed + std::fabs(rise_);
  if (worst[0] > rounding * size || worst[1] > rounding * speed)
    error->all(FLERR,
               engine::error_text(fmt::format(
                   "{}: keyword drum is '{}', a clump with balls that are {:.3g} m and {:.3g} m/s away from "
                   "where it rolls; allowed: places and velocities as the run before has left them",
                   travel_fix, group->names[drum_group_], worst[0], worst[1])));
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
                        travel_fix, least, most, "xyz"[axis_], low, high)));
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
  std::array<double, 5> all{};
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      all[0] += atom->f[i][axis_];
      all[2] += atom->rmass[i];
      if (rotation_ == Rotation::none || !(atom->mask[i] & drum_bit_)) continue;
      all[1] += along(axle_, atom->torque[i]);
      if (!clump_) continue;
      all[3] += atom->rmass[i] * along(upwards_, atom->v[i]);
      all[4] += atom->rmass[i];
    }
  if (opening && stepping_ != nullptr)
    all[0] -= stepping_->position_corrections(groupbit)[static_cast<std::size_t>(axis_)];
  if (comm->nprocs > 1) MPI_Allreduce(MPI_IN_PLACE, all.data(), clump_ ? 5 : 3, MPI_DOUBLE, MPI_SUM, world);
  return {all[0], all[1], all[2], clump_ ? all[3] / all[4] : 0.0};
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
    if ((atom->mask[i] & groupbit) && !(clump_ && (atom->mask[i] & drum_bit_)))
      places_.emplace_back(atom->tag[i], atom->x[i][axis_]);
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
    if ((atom->mask[i] & groupbit) && !(clump_ && (atom->mask[i] & drum_bit_))) {
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
  move_clump();
}

/// Turns the body by the angle of the step, and moves its balls with it. Their velocities in the middle of
/// the step lead from the old places to the new ones.
void FixDrumTravel::move_clump() {
  if (!clump_) return;
  const double dt = clock_.dt(), change = half_spin_ * dt;
  const physics::Turn middle(angle_ + 0.5 * change);
  angle_ = rotation_ == Rotation::driven ? moved_ / rolling_radius_ : angle_ + change;
  const physics::Turn end(angle_);
  height_ += dt * opening_.rise;
  const double mean_spin = physics::spin_of_chord(change, dt);
  const double end_spin = // by the forces of the step before
      rotation_ == Rotation::driven ? now_.velocity / rolling_radius_ : 2.0 * half_spin_ - spin_;
  for_each_of_clump([&](int i, const physics::InPlane &place) {
    const physics::InPlane lever = end(place), mean = physics::turning_velocity(mean_spin, middle(place));
    const physics::InPlane last = physics::turning_velocity(end_spin, lever);
    Vector origin{}, image{}; // of the origin, as far away from it as that of the ball
    domain->unmap(origin.data(), atom->image[i], image.data());
    const physics::InPlane shift = in_plane(image.data());
    set_in_plane(atom->x[i], {start_ + moved_ + lever.along - shift.along, height_ + lever.up - shift.up});
    set_in_plane(atom->v[i], {half_velocity_ + mean.along, opening_.rise + mean.up});
    if (stepping_ == nullptr) return;
    Vector before{};
    std::copy_n(stepping_->velocity_before(i), 3, before.begin());
    set_in_plane(before.data(), {2.0 * (half_velocity_ + mean.along) - now_.velocity - last.along,
                                 rise_ + 2.0 * mean.up - last.up});
    for (int a = 0; a < 3; ++a)
      stepping_->prescribe(i, a, before[static_cast<std::size_t>(a)]);
  });
}

/// Gives the balls of the body their velocities at the end of the step.
void FixDrumTravel::end_clump() {
  if (!clump_) return;
  const physics::Turn turn(angle_);
  for_each_of_clump([&](int i, const physics::InPlane &place) {
    const physics::InPlane turning = physics::turning_velocity(spin_, turn(place));
    set_in_plane(atom->v[i], {now_.velocity + turning.along, rise_ + turning.up});
  });
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
  rise_ = closing.rise;
  end_clump();
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
  // A negative spacing says that a clump follows.
  const double spacing = body_.empty() ? spacing_ : -spacing_;
  state.insert(state.end(), {spacing, moved_, spin_, traction_, torque_, work_, torque_work_});
  if (!body_.empty()) {
    state.insert(state.end(), {static_cast<double>(body_.size()), start_, height_, rise_, angle_});
    for (const BodyBall &ball : body_)
      state.insert(state.end(), {ball.tag, ball.place.along, ball.place.up});
  }
  drumlin::write_restart_record(file, comm->me, state);
}

void FixDrumTravel::restart(char *buffer) {
  const double *state = reinterpret_cast<const double *>(buffer);
  clock_.restore(state);
  state += clock_.state().size();
  for (double *number : {&spacing_, &moved_, &spin_, &traction_, &torque_, &work_, &torque_work_})
    *number = *state++;
  if (spacing_ >= 0.0) return;
  spacing_ = -spacing_;
  body_.resize(static_cast<std::size_t>(*state++));
  for (double *number : {&start_, &height_, &rise_, &angle_})
    *number = *state++;
  for (BodyBall &ball : body_) {
    ball = {state[0], {state[1], state[2]}};
    state += 3;
  }
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
