#include "contact/fix_stepping.h"

#include "contact/contact_settings.h"
#include "support/other_styles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

using namespace LAMMPS_NS;

namespace {

constexpr const char *stepping_id = "drumlin_stepping";
constexpr int most_gathered = 9; // most numbers that a ghost sends to its owner

/// Fixes that give balls another velocity than the forces on them would.
bool moves(const std::string &style) { return style == "move" || style == "nve/noforce"; }

/// Sum of the bits of masses, which changes when a mass does. It takes less time than a comparison with
/// copies.
std::uint64_t sum_of_bits(const double *masses, int count) {
  std::uint64_t sum = 0;
  for (int i = 0; i < count; ++i) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, masses + i, sizeof bits);
    sum += bits;
  }
  return sum;
}

/// Constraints that share forces among the balls of a group, over all ranks, which must all call them.
bool joins(const std::string &style) { return style == "aveforce" || style == "clump"; }

} // namespace

namespace {

/// The fix, whether in use or not; nullptr if there is none. \param modify nullptr while the engine ends
FixStepping *helper_of(Modify *modify) {
  return modify == nullptr ? nullptr
                           : dynamic_cast<FixStepping *>(drumlin::engine::find_fix(modify, stepping_id));
}

} // namespace

FixStepping *FixStepping::find(LAMMPS *lammps) {
  FixStepping *helper = helper_of(lammps->modify);
  return helper != nullptr && helper->in_use_ ? helper : nullptr;
}

FixStepping *FixStepping::provide(LAMMPS *lammps) {
  if (helper_of(lammps->modify) == nullptr) {
    std::string words[] = {stepping_id, "all", "drumlin/stepping"};
    char *arg[] = {words[0].data(), words[1].data(), words[2].data()};
    lammps->modify->add_fix(3, arg);
  }
  FixStepping *helper = helper_of(lammps->modify);
  helper->in_use_ = true;
  return helper;
}

void FixStepping::dismiss(LAMMPS *lammps) {
  if (FixStepping *helper = helper_of(lammps->modify)) helper->in_use_ = false;
}

FixStepping::FixStepping(LAMMPS *lammps, int narg, char **arg) : GhostFix(lammps, narg, arg) {
  nevery = 1;
  comm_forward = shared;
  FixStepping::grow_arrays(atom->nmax);
  atom->add_callback(0);
  for (int i = 0; i < atom->nlocal; ++i)
    FixStepping::set_arrays(i);
}

FixStepping::~FixStepping() {
  atom->delete_callback(id, 0);
  memory->destroy(velocity_);
}

int FixStepping::setmask() {
  return drumlin::engine::opens_step | FixConst::POST_INTEGRATE | FixConst::PRE_EXCHANGE |
         FixConst::PRE_FORCE | drumlin::engine::closes_forces | FixConst::END_OF_STEP;
}

void FixStepping::init() {
  comm_reverse =
      most_gathered; // for which the engine makes room at the start of each run; gather() may ask for less
  observers_.find(*modify);
  between_ = FixBetweenRuns::provide(lmp);
  moved_bits_ = travelling_bits_ = free_bits_ = 0;
  prescribed_bits_ = {};
  varies_ = false;
  for (Fix *fix : drumlin::engine::fixes(modify)) {
    const std::string name = fix->style;
    if (moves(name))
      moved_bits_ |= fix->groupbit;
    else if (name == "drum/travel")
      add_travelling(*fix);
    else if (fix->time_integrate != 0 || name == "freeze" || name.rfind("multisphere", 0) == 0)
      free_bits_ |= fix->groupbit;
    varies_ = varies_ || drumlin::changes_time_step(name) || name == "contact/way";
  }
  constraints_.clear();
  for (Fix *fix : drumlin::engine::fixes(modify))
    for (const char *name : {"setforce", "freeze", "lineforce", "planeforce", "aveforce", "clump"})
      if (std::string(fix->style) == name) {
        int dimensions = 0;
        void *body_force = std::string(name) == "clump" ? fix->extract("force", dimensions) : nullptr;
        constraints_.push_back(
            {fix, drumlin::engine::reaction(fix), joins(name), static_cast<double *>(body_force), {}});
      }
}

/// A fix that prescribes the velocity of its group along an axis.
void FixStepping::add_travelling(Fix &fix) {
  int dimensions = 0;
  const auto *axis = static_cast<const int *>(fix.extract("axis", dimensions));
  prescribed_bits_[static_cast<std::size_t>(*axis)] |= fix.groupbit;
  travelling_bits_ |= fix.groupbit;
}

void FixStepping::setup_pre_force(int) {
  if (!in_use_) return;
  in_setup_ = true;
  told_dt_ = update->dt;
  coupled_.clear();
  begun_.clear();
  coupled_links_.clear();
  later_.clear();
  shifts_.clear();
  relative_ = masses_change_ = false;
  std::fill(damping_.begin(), damping_.end(), 0.0);
  for (int i = 0; i < atom->nlocal; ++i) {
    set_arrays(i);
    std::copy_n(atom->v[i], 3, velocity_[i]);
  }
  look_for_moved();
  expect_contacts();
}

/// Whether any ball, on any rank, is_moved().
void FixStepping::look_for_moved() {
  any_moved_ = true;
  int any = 0;
  for (int i = 0; i < atom->nlocal && any == 0; ++i)
    any = is_moved(i) ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, world);
  any_moved_ = any != 0;
}

/// Velocities and masses at the start of the step. Other fixes may have changed them since the last one.
void FixStepping::open_step() {
  if (!in_use_) return;
  if (in_setup_)
    between_->restore_forces([this](int i, const std::array<double, 3> &shift) {
      for (std::size_t a = 0; a < 3; ++a)
        atom->f[i][a] += shift[a];
      shifts_.push_back({i, {}, shift, {}});
    });
  double **v = atom->v;
  for (int i = 0; i < atom->nlocal; ++i) {
    double *before = row(i);
    before[0] = v[i][0];
    before[1] = v[i][1];
    before[2] = v[i][2];
  }
  const std::uint64_t masses = sum_of_bits(atom->rmass, atom->nlocal);
  mass_differs_ = masses != masses_;
  masses_ = masses;
  if (masses_change_) take_masses();
}

/// The masses of this rank's balls, as their contacts feel them. They stay until the next search for
/// neighbours, after which other balls may be on the rank, unless a ball's mass changes.
void FixStepping::take_masses() {
  masses_ = sum_of_bits(atom->rmass, atom->nlocal);
  for (int i = 0; i < atom->nlocal; ++i)
    inverse_mass_[static_cast<std::size_t>(i)] = 1.0 / source_->mass(i);
}

/// A fix that moves balls may leave them free in some directions, in which they are integrated as other
/// balls. In all others the velocity that it has given is that of the end of the step already: for them v(t)
/// is replaced by this velocity, so that 2 v+ - v(t), too, is the velocity at the end of the step.
void FixStepping::follow_moved() {
  constexpr double rounding = 1e-12;
  for (int i = 0; i < atom->nlocal; ++i) {
    if ((atom->mask[i] & moved_bits_) == 0) continue;
    const double kick = 0.5 * update->dt / atom->rmass[i];
    for (std::size_t a = 0; a < 3; ++a) {
      const double now = atom->v[i][a], by_force = velocity_[i][a] + kick * atom->f[i][a];
      if (std::fabs(now - by_force) > rounding * std::fabs(now)) velocity_[i][a] = now;
    }
  }
}

double FixStepping::moving_mass_of_moved(int i, int j, const std::array<double, 3> &normal) const {
  const auto inverse = [&](int ball) { // along the normal
    double free = 0.0;
    for (std::size_t a = 0; a < 3; ++a)
      if (!is_driven(ball, a)) free += normal[a] * normal[a];
    return free / source_->mass(ball);
  };
  return 1.0 / (inverse(i) + (j < 0 ? 0.0 : inverse(j)));
}

void FixStepping::post_integrate() {
  if (!in_use_) return;
  if (update->dt != told_dt_)
    error->all(FLERR, drumlin::engine::error_text(fmt::format(
                          "stepping second: time step is '{:.9g}' at step {}, changed from {:.9g} s within a "
                          "run without a word to the fixes that integrate; allowed: another time step by fix "
                          "dt/reset, or for a run with its set-up (no keyword pre no)",
                          update->dt, update->ntimestep, told_dt_)));
  if (any_moved_) follow_moved();
  for (const Later &item : shifts_) {
    double *v = atom->v[item.i];
    const bool rests = is_unchanged(item.i); // or is not integrated
    for (std::size_t a = 0; a < 3; ++a)
      if (!rests && !is_driven(item.i, a)) v[a] -= 0.5 * update->dt * item.shift[a] / atom->rmass[item.i];
  }
  shifts_.clear();
  in_setup_ = false;
  dt_ = update->dt;
  counted_ = counting_;
  if (!counted_) return;
  if (force->newton_pair) {
    gather(1);
    std::copy_n(damping_.begin() + atom->nlocal, atom->nghost, gathered_.begin() + atom->nlocal);
    drumlin::engine::reverse_comm(comm, this);
    for (int i = 0; i < atom->nlocal; ++i)
      damping_[static_cast<std::size_t>(i)] += gathered_[static_cast<std::size_t>(i)];
  }
  for (int i = 0; i < atom->nlocal; ++i) {
    const auto n = static_cast<std::size_t>(i);
    row(i)[sum] = damping_[n] * inverse_mass_[n];
    damping_[n] = 0.0;
  }
  for (int i = 0; any_moved_ && i < atom->nlocal; ++i)
    if (is_moved(i) && is_unchanged(i)) row(i)[sum] = 0.0;
  std::fill_n(damping_.begin() + atom->nlocal, atom->nghost, 0.0);
}

void FixStepping::setup_pre_exchange() { expected_.clear(); }
void FixStepping::pre_exchange() {
  expected_.clear();
  if (!in_use_ || !domain->deform_vremap) return;
  // A ball that the engine now puts back into the box through a deforming side gets another velocity.
  for (int i = 0; i < atom->nlocal; ++i)
    for (std::size_t a = 0; a < 3; ++a)
      velocity_[i][a] = atom->v[i][a] - velocity_[i][a];
  relative_ = true;
}

void FixStepping::pre_force(int) {
  if (!in_use_) return;
  coupled_.clear();
  begun_.clear();
  if (relative_)
    for (int i = 0; i < atom->nlocal; ++i)
      for (std::size_t a = 0; a < 3; ++a)
        velocity_[i][a] = atom->v[i][a] - velocity_[i][a];
  relative_ = false;
  if (neighbor->ago == 0 || update->dt != expected_dt_) expect_contacts();
  counting_ = counting_ || masses_change_; // what was expected may no longer hold
  if (comm->nprocs > 1 || atom->nghost > 0) drumlin::engine::forward_comm(comm, this);
}

/// Contacts are counted only if one of them could need coupling if a ball touched all its neighbours and
/// walls at once. needs_coupling() depends monotonically on c, the sum of sqrt(c)/m and k/c: if it is false
/// for these largest values, it is false for all contacts until the next search for neighbours, so that
/// leaving out the count changes no result.
void FixStepping::expect_contacts() {
  source_ = drumlin::contact_source(lmp);
  const drumlin::ContactSource *const source = source_;
  take_masses();
  const NeighList *list = source->contact_list();
  std::vector<drumlin::physics::Dashpots> balls(static_cast<std::size_t>(atom->nlocal + atom->nghost));
  const auto ball = [&](int i) -> drumlin::physics::Dashpots & { return balls[static_cast<std::size_t>(i)]; };
  const auto expect_pairs = [&](const auto *coefficients) {
    for (int ii = 0; ii < list->inum; ++ii) {
      const int i = list->ilist[ii];
      for (int jj = 0; jj < list->numneigh[i]; ++jj) {
        const int j = drumlin::engine::neighbour_index(list->firstneigh[i][jj]);
        const double m_eff = source->effective_mass(i, j);
        if (std::isinf(m_eff)) continue;
        const auto &contact = coefficients->at(atom->type[i], atom->type[j]).contact;
        using Contact = std::decay_t<decltype(contact)>;
        const double ri = atom->radius[i], rj = atom->radius[j];
        drumlin::physics::Dashpots one;
        drumlin::add_dashpot(one, contact, m_eff, drumlin::radius_for<Contact>(ri, rj), ri + rj);
        ball(i).add(one);
        ball(j).add(one);
      }
    }
  };
  std::visit(expect_pairs, source->table());
  drumlin::physics::Dashpots mine; // the greatest, with the sum over the mass
  if (force->newton_pair) {
    gather(1);
    for (int i = atom->nlocal; i < atom->nlocal + atom->nghost; ++i) {
      gathered_[static_cast<std::size_t>(i)] = ball(i).sum;
      mine.take_greatest({0.0, ball(i).strongest, ball(i).stiffest});
    }
    drumlin::engine::reverse_comm(comm, this);
    for (int i = 0; i < atom->nlocal; ++i)
      ball(i).sum += gathered_[static_cast<std::size_t>(i)];
  }
  for (const Expected &link : expected_)
    ball(link.i).add(link.k, link.c);

  for (int i = 0; i < atom->nlocal; ++i) {
    const double inverse_mass = inverse_mass_[static_cast<std::size_t>(i)];
    if (inverse_mass == 0.0) continue;
    ball(i).add(source->wall_dashpots(i));
    mine.take_greatest({ball(i).sum * inverse_mass, ball(i).strongest, ball(i).stiffest});
  }
  drumlin::physics::Dashpots all = mine;
  constexpr int values = sizeof all / sizeof(double);
  if (comm->nprocs > 1) MPI_Allreduce(&mine, &all, values, MPI_DOUBLE, MPI_MAX, world);
  // Where time step or coefficients may grow within the run the sums of a step are needed for any of the
  // next.
  counting_ = varies_ || drumlin::physics::needs_coupling(update->dt, all.stiffest * all.strongest,
                                                          all.strongest, 2.0 * all.sum);
  expected_dt_ = update->dt;
}

/// Provides memory for `numbers` values of each ball, which ghosts send to their owners.
void FixStepping::gather(std::size_t numbers) {
  comm_reverse = static_cast<int>(numbers);
  gathered_.assign(numbers * static_cast<std::size_t>(atom->nlocal + atom->nghost), 0.0);
}

void FixStepping::close_forces() {
  if (!in_use_) return;
  const auto of_a_ghost = [this](const Later &item) { return item.i >= atom->nlocal; };
  const bool sends = force->newton_pair && std::any_of(later_.begin(), later_.end(), of_a_ghost);
  const bool couples = !coupled_.empty() || !coupled_links_.empty();
  std::array<int, 3> any{sends ? 1 : 0, couples ? 1 : 0, mass_differs_ ? 1 : 0};
  if (comm->nprocs > 1) MPI_Allreduce(MPI_IN_PLACE, any.data(), 3, MPI_INT, MPI_MAX, world);
  masses_change_ = any[2] != 0;
  if (any[0] != 0) send_later();
  if (any[1] != 0) solve_coupled();
}

/// Sends the forces on ghosts that act after the closing half kick to the owners.
void FixStepping::send_later() {
  gather(most_gathered);
  const auto gathered = [this](int i) {
    return gathered_.begin() + static_cast<std::ptrdiff_t>(i) * most_gathered;
  };
  std::vector<Later> kept;
  for (const Later &item : later_)
    if (item.i < atom->nlocal)
      kept.push_back(item);
    else
      for (std::size_t a = 0; a < 3; ++a) {
        gathered(item.i)[static_cast<std::ptrdiff_t>(a)] += item.rest[a];
        gathered(item.i)[static_cast<std::ptrdiff_t>(a) + 3] += item.shift[a];
        gathered(item.i)[static_cast<std::ptrdiff_t>(a) + 6] += item.torque[a];
      }
  drumlin::engine::reverse_comm(comm, this);
  later_.swap(kept);
  for (int i = 0; i < atom->nlocal; ++i) {
    Later item{i, {}, {}, {}};
    std::copy_n(gathered(i), 3, item.rest.begin());
    std::copy_n(gathered(i) + 3, 3, item.shift.begin());
    std::copy_n(gathered(i) + 6, 3, item.torque.begin());
    if (std::any_of(gathered(i), gathered(i) + most_gathered, [](double value) { return value != 0.0; }))
      later_.push_back(item);
  }
}

void FixStepping::solve_coupled() {
  hold_body_forces();
  double **f = atom->f;
  const int nlocal = atom->nlocal;
  for (int i = 0; i < nlocal; ++i) {
    const double *v = atom->v[i];
    double *star = velocity_[i]; // overwrites v(t), which this step no longer needs
    const double kick = is_unchanged(i) ? 0.0 : 0.5 * update->dt / atom->rmass[i]; // 0: forces do not move it
    for (std::size_t a = 0; a < 3; ++a)
      star[a] = is_driven(i, a) ? 2.0 * v[a] - star[a] : v[a] + kick * f[i][a];
  }
  if (comm->nprocs > 1 || atom->nghost > 0) drumlin::engine::forward_comm(comm, this);
  if (force->newton_pair) gather(most_gathered);
  for (Coupled &p : coupled_) {
    const auto along = [&](int ball) {
      const double *v = velocity_[ball];
      return v[0] * p.normal[0] + v[1] * p.normal[1] + v[2] * p.normal[2];
    };
    const double rate = (p.j < 0 ? 0.0 : along(p.j)) - along(p.i);
    const double acting = drumlin::physics::coupled_force(p.dashpot, rate);
    limit_friction(p, acting);
    const std::array<double, 3> change =
        drumlin::physics::sum(p.change.force, p.share * (acting - p.dashpot.first), p.normal);
    add_force(p.i, 1.0, change);
    add_torque(p.i, p.change.torque_i);
    if (p.j >= 0 && p.j < nlocal)
      add_force(p.j, -1.0, change);
    else if (takes(p.j))
      for (std::size_t a = 0; a < 3; ++a)
        gathered_[static_cast<std::size_t>(p.j) * most_gathered + a] -= change[a];
    if (takes(p.j)) add_torque(p.j, p.change.torque_j);
    *p.force = acting;
    if (p.report) p.report(change);
  }
  if (force->newton_pair) {
    drumlin::engine::reverse_comm(comm, this);
    for (int i = 0; i < nlocal; ++i) {
      const double *change = gathered_.data() + static_cast<std::ptrdiff_t>(i) * most_gathered;
      if (change[0] != 0.0 || change[1] != 0.0 || change[2] != 0.0)
        add_force(i, 1.0, {change[0], change[1], change[2]});
      add_torque(i, {change[3], change[4], change[5]});
    }
  }
  for (const std::function<void()> &close : coupled_links_)
    close();
  coupled_links_.clear();
  constrain(true);
}

/// Limits friction and rolling resistance of a coupled contact to its final normal force, N, and stores what
/// that changes.
void FixStepping::limit_friction(Coupled &p, double normal_force) {
  using drumlin::physics::sum, drumlin::physics::scaled, drumlin::physics::cross;
  using Vec3 = drumlin::physics::Vec3;
  p.change = {};
  if (p.spring != nullptr) {
    const drumlin::physics::PulledSpring now = drumlin::physics::limited_to(
        p.friction, normal_force, {p.rub, {p.spring[0], p.spring[1], p.spring[2]}}, dt_);
    p.change.force = scaled(p.share, sum(now.force, -1.0, p.rub));
    const Vec3 moment = cross(p.normal, p.change.force);
    p.change.torque_i = scaled(-p.arm_i, moment);
    p.change.torque_j = scaled(-p.arm_j, moment);
    std::copy(now.spring.begin(), now.spring.end(), p.spring);
  }
  if (p.rolling_spring != nullptr) {
    const Vec3 now = drumlin::physics::limited_to(p.rolling, normal_force, p.roll);
    const Vec3 change = sum(now, -1.0, p.roll);
    p.change.torque_i = sum(p.change.torque_i, p.share, change);
    p.change.torque_j = sum(p.change.torque_j, -p.share, change);
    for (std::size_t a = 0; a < 3; ++a)
      p.rolling_spring[a] = -now[a];
  }
}

FixStepping::RubbingForces FixStepping::close_friction(const Begun &p) {
  using drumlin::physics::sum, drumlin::physics::scaled, drumlin::physics::cross;
  using Vec3 = drumlin::physics::Vec3;
  const Vec3 spring = p.spring != nullptr ? Vec3{p.spring[0], p.spring[1], p.spring[2]} : Vec3{};
  RubbingForces closing;
  closing.friction = scaled(p.share, drumlin::physics::closing_friction(p.friction, p.step.force, p.step.kick,
                                                                        p.step.weight, {p.rub, spring}));
  if (p.rolling_spring != nullptr)
    closing.rolling =
        scaled(p.share, drumlin::physics::closing_torque(p.rolling, p.step.force, p.step.kick, p.roll));
  const Vec3 rest = sum(scaled(p.share, p.rub), -1.0, closing.friction);
  const Vec3 rolling = sum(scaled(p.share, p.roll), -1.0, closing.rolling);
  const Vec3 moment = cross(p.normal, rest);
  if (takes(p.i)) add_to_announced(p.announced, p.i, rest, sum(rolling, -p.arm_i, moment));
  if (takes(p.j))
    add_to_announced(p.announced + 1, p.j, scaled(-1.0, rest), sum(scaled(-1.0, rolling), -p.arm_j, moment));
  tell_heat(p.i, p.j, 0.0, 0.5 * dt_ * drumlin::physics::dot(rest, p.slip));
  return closing;
}

/// Adds a torque, N m, to a ball; that of a ghost is sent to its owner.
void FixStepping::add_torque(int i, const std::array<double, 3> &torque) {
  if (torque[0] == 0.0 && torque[1] == 0.0 && torque[2] == 0.0) return;
  double *const to = i < atom->nlocal ? atom->torque[i]
                                      : gathered_.data() + static_cast<std::ptrdiff_t>(i) * most_gathered + 3;
  for (std::size_t a = 0; a < 3; ++a)
    to[a] += torque[a];
}

/// add_after_kick() with the entry at a place if that is of the ball: fewer entries are merged in less time.
void FixStepping::add_to_announced(std::size_t place, int i, const std::array<double, 3> &rest,
                                   const std::array<double, 3> &torque) {
  if (place >= later_.size() || later_[place].i != i) return add_after_kick(i, rest, {}, torque);
  for (std::size_t a = 0; a < 3; ++a) {
    later_[place].rest[a] += rest[a];
    later_[place].torque[a] += torque[a];
  }
}

/// Merges the entries of each ball into one: constraints act on the total force on a ball, and the force that
/// is removed later is the difference that all its shifts together make.
void FixStepping::merge_later() {
  order_.clear(); // sorted instead of the entries, which are large
  for (std::size_t n = 0; n < later_.size(); ++n)
    order_.emplace_back(later_[n].i, n);
  std::sort(order_.begin(), order_.end());
  merged_.clear();
  for (const auto &[ball, n] : order_) {
    const Later &item = later_[n];
    if (merged_.empty() || merged_.back().i != ball) {
      merged_.push_back(item);
      continue;
    }
    Later &all = merged_.back();
    for (std::size_t a = 0; a < 3; ++a) {
      all.rest[a] += item.rest[a];
      all.shift[a] += item.shift[a];
      all.torque[a] += item.torque[a];
    }
  }
  later_.swap(merged_);
}

void FixStepping::end_of_step() {
  if (!in_use_) return;
  // A force on one ball of a rigid body changes the forces on all its balls.
  for (const Constraint &constraint : constraints_)
    if (constraint.joins)
      for (int i = 0; i < atom->nlocal; ++i)
        if (atom->mask[i] & constraint.fix->groupbit) later_.push_back({i, {}, {}, {}});
  merge_later();
  double **f = atom->f;
  hold_body_forces();
  for (const Later &item : later_) {
    add_force(item.i, 1.0, item.rest);
    for (std::size_t a = 0; a < 3; ++a)
      atom->torque[item.i][a] += item.torque[a];
  }
  constrain(!later_.empty());
  hold_body_forces();
  // The part of a shift that passes the constraints is the difference that it makes to the constrained force.
  shifts_.swap(later_);
  later_.clear();
  // Of a clump that rolls it has no torque, which would act on the velocities at the end of the step, too.
  for (Later &item : shifts_)
    for (std::size_t a = 0; a < 3; ++a) {
      item.rest[a] = f[item.i][a];
      item.torque[a] = atom->torque[item.i][a];
      f[item.i][a] += item.shift[a];
    }
  constrain(!shifts_.empty());
  for (Later &item : shifts_)
    for (std::size_t a = 0; a < 3; ++a) {
      item.shift[a] = f[item.i][a] - item.rest[a];
      atom->torque[item.i][a] = item.torque[a];
    }
}

void FixStepping::reset_dt() { told_dt_ = update->dt; }

void FixStepping::add_force(int i, double factor, const std::array<double, 3> &vector) {
  for (std::size_t a = 0; a < 3; ++a)
    atom->f[i][a] += factor * vector[a];
  for (const Constraint &constraint : constraints_)
    if (constraint.reaction != nullptr && (atom->mask[i] & constraint.fix->groupbit))
      for (std::size_t a = 0; a < 3; ++a)
        constraint.reaction[a] += factor * vector[a];
}

/// N, the sum over this rank's balls of the fix's group.
std::array<double, 3> FixStepping::force_on(const Fix &fix) const {
  std::array<double, 3> total{};
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & fix.groupbit)
      for (std::size_t a = 0; a < 3; ++a)
        total[a] += atom->f[i][a];
  return total;
}

/// Before forces are added: the next constrain() finds from it by how much the forces on clumps have changed.
void FixStepping::hold_body_forces() {
  for (Constraint &constraint : constraints_)
    if (constraint.body_force != nullptr) constraint.held = force_on(*constraint.fix);
}

/// Applies the constraints again, to changed forces. They are projections, so that forces that have passed
/// them before do not change. Their reports of the forces taken away are restored, since this call would
/// overwrite them; those of the force on a clump change by what was added to it.
void FixStepping::constrain(bool any) {
  for (const Constraint &constraint : constraints_) {
    if (!any && !constraint.joins) continue;
    std::array<double, 3> report{};
    double *const reported = constraint.body_force != nullptr ? constraint.body_force : constraint.reaction;
    if (reported != nullptr) std::copy_n(reported, 3, report.begin());
    if (constraint.body_force != nullptr) {
      const std::array<double, 3> now = force_on(*constraint.fix);
      for (std::size_t a = 0; a < 3; ++a)
        report[a] += now[a] - constraint.held[a];
    }
    constraint.fix->post_force(0);
    if (reported != nullptr) std::copy_n(report.begin(), 3, reported);
  }
}

void FixStepping::grow_arrays(int nmax) {
  memory->grow(velocity_, nmax, shared, "drumlin/stepping:velocity");
  for (std::vector<double> *values : {&inverse_mass_, &damping_})
    values->resize(static_cast<std::size_t>(nmax));
}

void FixStepping::copy_arrays(int i, int j, int) { std::copy_n(row(i), shared, row(j)); }

void FixStepping::set_arrays(int i) { std::fill_n(row(i), shared, 0.0); }

int FixStepping::pack_exchange(int i, double *buf) {
  std::copy_n(row(i), shared, buf);
  return shared;
}

int FixStepping::unpack_exchange(int i, double *buf) {
  std::copy_n(buf, shared, row(i));
  return shared;
}

void FixStepping::pack_ghosts(int n, const int *list, double *buf) {
  const std::array<double, 3> &of_ghosts = velocity_of_ghosts();
  const bool jumps = of_ghosts[0] != 0.0 || of_ghosts[1] != 0.0 || of_ghosts[2] != 0.0;
  for (int m = 0; m < n; ++m) {
    double *const ghost = buf + static_cast<std::ptrdiff_t>(m) * shared;
    for (int a = 0; a < shared; ++a)
      ghost[a] = row(list[m])[a];
    if (jumps)
      for (std::size_t a = 0; a < 3; ++a)
        ghost[a] += of_ghosts[a];
  }
}

void FixStepping::unpack_ghosts(int n, int begin, double *buf) { std::copy_n(buf, n * shared, row(begin)); }

void FixStepping::pack_gathered(int n, int begin, double *buf) {
  std::copy_n(gathered_.begin() + static_cast<std::ptrdiff_t>(begin) * comm_reverse, n * comm_reverse, buf);
}

void FixStepping::join_gathered(int n, const int *list, const double *buf) {
  for (int m = 0; m < n; ++m) {
    const auto ball = gathered_.begin() + static_cast<std::ptrdiff_t>(list[m]) * comm_reverse;
    std::transform(ball, ball + comm_reverse, buf, ball, std::plus<>());
    buf += comm_reverse;
  }
}

double FixStepping::memory_usage() { return static_cast<double>(atom->nmax) * 6 * sizeof(double); }
