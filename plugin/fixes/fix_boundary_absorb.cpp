#include "fixes/fix_boundary_absorb.h"

#include "contact/fix_stepping.h"
#include "support/arguments.h"
#include "support/restart_record.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

using namespace LAMMPS_NS;
using drumlin::Range;
namespace engine = drumlin::engine;
namespace physics = drumlin::physics;

namespace {

constexpr const char *absorb_fix = "fix boundary/absorb";

physics::Vec3 vector_of(const double *v) { return {v[0], v[1], v[2]}; }

} // namespace

FixBoundaryAbsorb::FixBoundaryAbsorb(LAMMPS *lammps, int narg, char **arg) : Fix(lammps, narg, arg) {
  vector_flag = 1;
  size_vector = 7;
  extvector = 0;
  global_freq = nevery = 1;
  restart_global = restart_peratom = 1;
  time_depend = 1; // heat is a sum over the steps
  parse(narg, arg);

  FixBoundaryAbsorb::grow_arrays(atom->nmax);
  atom->add_callback(0); // atoms that move in memory or to another rank
  atom->add_callback(1); // restart files
  for (int i = 0; i < atom->nlocal; ++i)
    FixBoundaryAbsorb::set_arrays(i);
}

FixBoundaryAbsorb::~FixBoundaryAbsorb() {
  atom->delete_callback(id, 0);
  atom->delete_callback(id, 1);
}

void FixBoundaryAbsorb::parse(int narg, char **arg) {
  drumlin::Arguments in(error, absorb_fix, narg - 3, arg + 3);
  bool has_normal = false;
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "normal") {
      ball_.normal = in.direction("keyword normal");
      has_normal = true;
    } else if (keyword == "area") {
      ground_.area = in.number("keyword area", Range::positive);
    } else if (keyword == "density") {
      ground_.density = in.number("keyword density", Range::positive);
    } else if (keyword == "speeds") {
      ground_.p_speed = in.number("keyword speeds, of compression waves", Range::positive);
      ground_.s_speed = in.number("keyword speeds, of shear waves", Range::non_negative);
    } else if (keyword == "depth") {
      ground_.depth = in.number("keyword depth", Range::positive);
    } else if (keyword == "static") {
      keep_static_ = in.choice("keyword static", {"yes", "no"}) == 0;
    } else {
      in.fail("keyword", keyword, "normal, area, density, speeds, depth or static");
    }
  }
  if (!has_normal) in.fail("keyword normal is missing; allowed: normal x y z");
  if (ground_.area == 0.0) in.fail("keyword area is missing; allowed: area A");
  if (ground_.density == 0.0) in.fail("keyword density is missing; allowed: density rho");
  if (ground_.p_speed == 0.0) in.fail("keyword speeds is missing; allowed: speeds cp cs");
  if (const std::string fault = ground_.invalid(); !fault.empty()) in.fail(fault);
}

int FixBoundaryAbsorb::setmask() {
  return FixConst::INITIAL_INTEGRATE | FixConst::PRE_NEIGHBOR | FixConst::POST_FORCE | FixConst::END_OF_STEP;
}

void FixBoundaryAbsorb::init() {
  deck_check_.of_fix(lmp, *this);
  count_ = static_cast<double>(group->count(igroup));
  if (count_ == 0.0)
    error->all(FLERR, engine::error_text(fmt::format(
                          "{}: group is '{}', which is empty; allowed: the group of the boundary's balls",
                          absorb_fix, group->names[igroup])));
  ball_.along = ground_.along_normal(count_);
  ball_.across = ground_.in_plane(count_);
  const std::vector<double> links{ball_.normal[0],       ball_.normal[1],     ball_.normal[2],
                                  ball_.along.stiffness, ball_.along.damping, ball_.across.stiffness,
                                  ball_.across.damping};
  has_acted_ = has_acted_ && links == links_;
  links_ = links;
  stepping_ = FixStepping::find(lmp);
  observers_.find(*modify);
  if (keep_static_) refuse_earlier_integration();
  if (domain->deform_flag)
    error->all(FLERR, engine::error_text(std::string(absorb_fix) +
                                         ": the box is deformed by fix deform; allowed: a box that stays as "
                                         "it is, since the ground outside of it does"));
}

/// The constant forces are taken at the start of the first step, before the balls move.
void FixBoundaryAbsorb::refuse_earlier_integration() const {
  for (const Fix *fix : engine::fixes(modify)) {
    if (fix == this) return;
    const Fix &earlier = *fix;
    if (!earlier.time_integrate) continue;
    int moves = 0;
    for (int i = 0; i < atom->nlocal; ++i)
      if ((atom->mask[i] & groupbit) && (atom->mask[i] & earlier.groupbit)) moves = 1;
    MPI_Allreduce(MPI_IN_PLACE, &moves, 1, MPI_INT, MPI_MAX, world);
    if (moves != 0)
      error->all(FLERR, engine::error_text(fmt::format(
                            "{}: keyword static is 'yes' behind fix {} ({}), which integrates; allowed: "
                            "static yes before all fixes that integrate balls of the boundary",
                            absorb_fix, earlier.id, earlier.style)));
  }
}

void FixBoundaryAbsorb::setup_pre_neighbor() { announce(); }
void FixBoundaryAbsorb::pre_neighbor() { announce(); }

/// Announces the links to the second-order scheme, in the stiffer direction.
void FixBoundaryAbsorb::announce() {
  if (stepping_ == nullptr || ball_.along.damping == 0.0) return;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) stepping_->expect(i, ball_.along.stiffness, ball_.along.damping);
}

physics::Vec3 FixBoundaryAbsorb::displacement(int i) const {
  Vector u = physics::sum(vector_of(atom->x[i]), -1.0, grounded(i).reference);
  engine::minimum_image(domain, u);
  return u;
}

void FixBoundaryAbsorb::setup(int) {
  echo();
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      // In a run that continues it is the force of the step before.
      if (!has_acted_ || stepping_ == nullptr || !stepping_->continues(i, -1))
        grounded(i).force = ball_.force(displacement(i), vector_of(atom->v[i]));
      add(i, physics::sum(grounded(i).force, 1.0, grounded(i).constant));
    }
  tell_observers();
  power_ = heat_rate();
}

/// Constant force on ball i; before the first step the one that would balance its other forces.
physics::Vec3 FixBoundaryAbsorb::constant_force(int i) const {
  if (!keep_static_ || static_known_) return grounded(i).constant;
  return physics::sum(grounded(i).force, -1.0, vector_of(atom->f[i]));
}

/// Takes the constant forces before the first step, when all fixes have added their forces of the set-up.
void FixBoundaryAbsorb::initial_integrate(int) {
  dt_ = update->dt;
  if (!keep_static_ || static_known_) return;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      grounded(i).constant = constant_force(i);
      add(i, grounded(i).constant);
    }
  static_known_ = true;
}

void FixBoundaryAbsorb::post_force(int) {
  has_acted_ = true;
  coupled_.clear();
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      grounded(i).force = force_of_step(i);
      add(i, physics::sum(grounded(i).force, 1.0, grounded(i).constant));
    }
  tell_observers();
  if (!coupled_.empty()) stepping_->couple([this] { close_coupled(); });
}

/// Force of springs and dashpots on ball i; of the first pass if its links are solved for together with its
/// contacts.
physics::Vec3 FixBoundaryAbsorb::force_of_step(int i) {
  const Vector u = displacement(i), v = vector_of(atom->v[i]);
  if (stepping_ == nullptr) return ball_.force(u, v);
  const physics::GroundedStep step{u, v, vector_of(stepping_->velocity_before(i)), grounded(i).force,
                                   update->dt};
  if (stepping_->counting()) stepping_->add_damping(i, ball_.along.damping);
  const double all = stepping_->damping_over_mass(i);
  if (!physics::needs_coupling(step.dt, ball_.along.stiffness, ball_.along.damping, all))
    return physics::implicit_force(ball_, step, atom->rmass[i]);
  coupled_.emplace_back(i, physics::coupled_ground(ball_, step, all));
  return coupled_.back().second.first(ball_.normal);
}

/// The second pass, in which the velocity with all forces of the first is known.
void FixBoundaryAbsorb::close_coupled() {
  for (const auto &[i, coupled] : coupled_) {
    const Vector final_force = coupled.second(ball_.normal, vector_of(stepping_->predicted_velocity(i)));
    stepping_->add_force(i, 1.0, physics::sum(final_force, -1.0, grounded(i).force));
    grounded(i).force = final_force;
  }
}

void FixBoundaryAbsorb::tell_observers() {
  if (!observers_.any()) return;
  constexpr int ground = 0; // the partner of these links is not a ball
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit)
      observers_.tell_bond(i, ground, ball_.modes(atom->rmass[i], stepping_ != nullptr));
}

void FixBoundaryAbsorb::add(int i, const Vector &more) {
  for (std::size_t a = 0; a < 3; ++a)
    atom->f[i][a] += more[a];
}

void FixBoundaryAbsorb::end_of_step() {
  const double before = power_;
  power_ = heat_rate();
  heat_ += 0.5 * dt_ * (before + power_); // trapezoidal rule
}

/// Power, W, that the dashpots dissipate. Summed over the ranks in each step and not at the end, so that a
/// restarted run adds the same numbers in the same order. Collective.
double FixBoundaryAbsorb::heat_rate() const {
  double heat = 0.0;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) heat += ball_.heat(vector_of(atom->v[i]));
  MPI_Allreduce(MPI_IN_PLACE, &heat, 1, MPI_DOUBLE, MPI_SUM, world);
  return heat;
}

FixBoundaryAbsorb::Totals FixBoundaryAbsorb::totals() const {
  std::array<double, 5> sums{};
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      const Vector u = displacement(i), constant = constant_force(i);
      sums[0] += ball_.stored(u);
      sums[1] += physics::dot(constant, u);
      for (std::size_t a = 0; a < 3; ++a)
        sums[2 + a] += grounded(i).force[a] + constant[a];
    }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, world);
  return {sums[0], heat_, sums[1], {sums[2], sums[3], sums[4]}};
}

double FixBoundaryAbsorb::compute_vector(int n) {
  if (n < 6) {
    const Totals now = totals();
    return std::array<double, 6>{
        now.stored, now.heat, now.work, now.force[0], now.force[1], now.force[2]}[static_cast<std::size_t>(
        n)];
  }
  double mine = 0.0;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) mine += physics::dot(ball_.normal, displacement(i)) / count_;
  double all = 0.0;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

void FixBoundaryAbsorb::echo() {
  if (!echoed_)
    engine::log_message(lmp,
                        fmt::format("fix boundary/absorb {}: {:.0f} balls, each with normal k = {:.6g} N/m, "
                                    "c = {:.6g} N s/m; tangential k = {:.6g} N/m, c = {:.6g} N s/m\n",
                                    id, count_, ball_.along.stiffness, ball_.along.damping,
                                    ball_.across.stiffness, ball_.across.damping));
  echoed_ = true;
}

void FixBoundaryAbsorb::grow_arrays(int nmax) { balls_.resize(static_cast<std::size_t>(nmax)); }

void FixBoundaryAbsorb::copy_arrays(int i, int j, int) { grounded(j) = grounded(i); }

void FixBoundaryAbsorb::set_arrays(int i) {
  grounded(i) = {};
  grounded(i).reference = vector_of(atom->x[i]);
}

int FixBoundaryAbsorb::pack_exchange(int i, double *buf) {
  for (const Vector &part : {grounded(i).reference, grounded(i).constant, grounded(i).force})
    buf = std::copy(part.begin(), part.end(), buf);
  return exchanged;
}

int FixBoundaryAbsorb::unpack_exchange(int i, double *buf) {
  for (Vector *part : {&grounded(i).reference, &grounded(i).constant, &grounded(i).force}) {
    std::copy_n(buf, part->size(), part->begin());
    buf += part->size();
  }
  return exchanged;
}

/// The engine expects the number of values first, itself included.
int FixBoundaryAbsorb::pack_restart(int i, double *buf) {
  buf[0] = exchanged + 1;
  return 1 + FixBoundaryAbsorb::pack_exchange(i, buf + 1);
}

/// Reads the values of this fix, which follow those of `nth` other fixes.
void FixBoundaryAbsorb::unpack_restart(int i, int nth) {
  const double *values = atom->extra[i];
  for (int n = 0; n < nth; ++n)
    values += static_cast<int>(*values);
  std::array<double, exchanged> all{};
  std::copy_n(values + 1, static_cast<int>(*values) - 1, all.begin()); // without forces up to version 0.4.0
  FixBoundaryAbsorb::unpack_exchange(i, all.data());
}

int FixBoundaryAbsorb::maxsize_restart() { return exchanged + 1; }
int FixBoundaryAbsorb::size_restart(int) { return exchanged + 1; }

void FixBoundaryAbsorb::write_restart(FILE *file) {
  // Files of versions up to 0.4.0 end behind the second number, which is 0 or 1 there.
  std::vector<double> state{heat_, (static_known_ ? 1.0 : 0.0) + 2.0, has_acted_ ? 1.0 : 0.0};
  links_.resize(7);
  state.insert(state.end(), links_.begin(), links_.end());
  drumlin::write_restart_record(file, comm->me, state);
}

void FixBoundaryAbsorb::restart(char *buffer) {
  const double *state = reinterpret_cast<const double *>(buffer);
  heat_ = state[0];
  static_known_ = state[1] != 0.0 && state[1] != 2.0;
  if (state[1] < 2.0) return;
  has_acted_ = state[2] != 0.0;
  links_.assign(state + 3, state + 10);
}

double FixBoundaryAbsorb::memory_usage() { return static_cast<double>(balls_.capacity() * sizeof(Grounded)); }
