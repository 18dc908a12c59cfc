#include "fixes/fix_guard.h"

#include "support/arguments.h"

#include <algorithm>
#include <climits>
#include <cstring>
#include <fmt/format.h>
#include <limits>

using namespace LAMMPS_NS;

namespace {

/// Sum of the components, which is finite if and only if all three are: finite numbers of a simulation are
/// too small for their sum to overflow.
double sum(const double *v) { return v[0] + v[1] + v[2]; }

/// Critical step, s, of a ball that has no other link.
double critical_step(const drumlin::physics::LinkModes &modes) {
  drumlin::physics::LoadedBall ball;
  ball.add(modes);
  return ball.critical_step();
}

std::string pair_name(double ball, double partner) {
  const auto [first, second] =
      std::minmax(ball, partner); // the lower ID first, for the same text on any number of ranks
  return partner > 0.0 ? fmt::format("balls {:.0f} and {:.0f}", first, second)
                       : fmt::format("ball {:.0f} and a wall", ball);
}

} // namespace

FixGuard::FixGuard(LAMMPS *lammps, int narg, char **arg) : GhostFix(lammps, narg, arg) {
  nevery = 1;
  comm_reverse = sizeof(Ball) / sizeof(double);
  scalar_flag = vector_flag = 1;
  size_vector = 2;
  global_freq = 1;
  extscalar = extvector = 0;
  critical_.value = std::numeric_limits<double>::infinity();
  drumlin::Arguments in(error, "fix guard", narg - 3, arg + 3);
  if (!in.empty() && (in.peek() == "on" || in.peek() == "off")) on_ = in.word("on or off") == "on";
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "every")
      every_ = in.integer("keyword every", 1);
    else if (keyword == "links")
      links_ = in.integer("keyword links", 1);
    else if (keyword == "step")
      step_ = in.number("keyword step", drumlin::Range::positive);
    else if (keyword == "overlap")
      overlap_ = in.number("keyword overlap", drumlin::Range::positive);
    else
      in.fail("keyword", keyword, "on or off first, every, links, step or overlap");
  }
}

int FixGuard::setmask() {
  if (!on_) return 0;
  return FixConst::INITIAL_INTEGRATE | FixConst::PRE_EXCHANGE | FixConst::PRE_NEIGHBOR | FixConst::PRE_FORCE |
         FixConst::END_OF_STEP;
}

void FixGuard::init() {
  deck_check_.of_fix(lmp, *this);
  frozen_ = 0;
  for (const Fix *fix : drumlin::engine::fixes(modify))
    if (std::string(fix->style) == "freeze") frozen_ |= fix->groupbit;
}

void FixGuard::setup_pre_force(int) {
  links_of_setup_ = true;
  begin_links();
}

void FixGuard::setup(int) {
  if (on_) check_numbers();
}

/// The links of the set-up are checked here, when all fixes have been set up and all bonds have been
/// computed.
void FixGuard::initial_integrate(int) {
  if (!links_of_setup_) return;
  end_links();
  links_of_setup_ = false;
}

void FixGuard::setup_pre_neighbor() { pre_neighbor(); }
void FixGuard::pre_neighbor() {
  listed_.clear();
  for (int i = 0; atom->radius_flag && i < atom->nlocal; ++i)
    listed_.push_back(
        {static_cast<double>(atom->tag[i]), {atom->x[i][0], atom->x[i][1], atom->x[i][2]}, atom->radius[i]});
}

/// Before the list is built again, when the balls have moved the farthest from where it was built.
void FixGuard::pre_exchange() { check_lists(); }

/// Ends the run if balls may touch that the neighbour list does not have. A pair is in the list if its
/// distance was at most radii + skin when the list was built, and at most the cutoff, which the engine takes
/// from the radii at the set-up of a run. The engine builds the list again when balls have moved, but not
/// when they have grown.
void FixGuard::check_lists() const {
  struct Reach { // the two largest values of different balls of a rank, m; numbers only, for MPI
    double grown = 0.0, held = 0.0, way[2] = {}, used[2] = {}, radius[2] = {};
  } mine;
  const auto add = [](double *two, double value) {
    if (value <= two[1]) return;
    two[1] = std::min(value, two[0]);
    two[0] = std::max(value, two[0]);
  };
  const int known = std::min(atom->nlocal, static_cast<int>(listed_.size()));
  for (int i = 0; i < known; ++i) {
    const Listed &then = listed_[static_cast<std::size_t>(i)];
    if (then.tag != static_cast<double>(atom->tag[i]))
      continue; // balls were deleted: the list is built again now
    const double *x = atom->x[i];
    const double way = std::hypot(x[0] - then.x[0], x[1] - then.x[1], x[2] - then.x[2]);
    const double growth = std::max(0.0, atom->radius[i] - then.radius);
    if (growth > 0.0) mine.grown = 1.0;
    add(mine.way, way);
    add(mine.used, way + growth);
    if (atom->mask[i] & frozen_)
      mine.held = std::max(mine.held, atom->radius[i]); // such balls have no contacts with one another
    else
      add(mine.radius, atom->radius[i]);
  }
  constexpr int numbers = sizeof(Reach) / sizeof(double);
  std::vector<Reach> ranks(static_cast<std::size_t>(comm->nprocs));
  MPI_Allgather(&mine, numbers, MPI_DOUBLE, ranks.data(), numbers, MPI_DOUBLE, world);
  Reach all;
  for (const Reach &rank : ranks) {
    all.grown = std::max(all.grown, rank.grown);
    all.held = std::max(all.held, rank.held);
    for (std::size_t n = 0; n < 2; ++n) {
      add(all.way, rank.way[n]);
      add(all.used, rank.used[n]);
      add(all.radius, rank.radius[n]);
    }
  }
  const double skin = neighbor->skin, cutoff = neighbor->cutneighmax;
  const double used = all.used[0] + all.used[1], radii = all.radius[0] + std::max(all.radius[1], all.held);
  if ((all.grown > 0.0 || neighbor->build_once != 0) && used > skin)
    error->all(FLERR, drumlin::engine::error_text(fmt::format(
                          "fix guard: growth and motion of two balls since the neighbour list was built is "
                          "'{:.4g} m' at step {}, so that contacts may be missing; allowed: at most the "
                          "skin, {:.4g} m (a larger one, or neigh_modify delay 0 every 1 check no)",
                          used, update->ntimestep, skin)));
  constexpr double rounding = 1e-9;
  if (radii > (1.0 + rounding) * (cutoff - skin) && radii + all.way[0] + all.way[1] > cutoff)
    error->all(FLERR, drumlin::engine::error_text(fmt::format(
                          "fix guard: radii of two balls are '{:.4g} m' in sum at step {}, so that contacts "
                          "may be missing, since the neighbour list reaches {:.4g} m; allowed: at most this "
                          "(a larger skin, or several runs, at whose set-up it follows the radii)",
                          radii, update->ntimestep, cutoff)));
}

void FixGuard::pre_force(int) {
  if (update->ntimestep % links_ == 0 || update->dt > links_dt_) begin_links();
}

void FixGuard::end_of_step() {
  if (update->ntimestep % every_ == 0) check_numbers();
  if (observing()) end_links();
  if (update->ntimestep % links_ == 0) check_lists();
}

void FixGuard::begin_links() {
  const int balls = atom->nlocal + (force->newton_pair ? atom->nghost : 0);
  balls_.assign(static_cast<std::size_t>(balls), {});
  source_ = drumlin::contact_source(lmp);
  links_dt_ = update->dt;
  observe(true);
}

/// A contact is a link on each of its balls. With newton off, the rank of a ghost's owner receives the
/// contact as well and adds the link of that ball.
void FixGuard::see_contact(const drumlin::ContactRecord &p) {
  const bool wall = p.j < 0;
  const double inverse_i = 1.0 / source_->mass(p.i);
  const double inverse_j = wall ? 0.0 : 1.0 / source_->mass(p.j);
  const double inverse_masses = inverse_i + inverse_j;
  if (inverse_masses == 0.0) return;
  const double ri = atom->radius[p.i];
  const double rj = wall ? ri : atom->radius[p.j];
  const double mass_over_inertia = 1.0 / drumlin::engine::inertia_share(lmp); // m r^2 / I
  const double mt = drumlin::physics::tangential_mass(inverse_i, inverse_j, mass_over_inertia);
  drumlin::physics::LinkModes modes;
  modes.normal = p.normal;
  modes.normal_spring = p.share * p.normal_stiffness * inverse_masses;
  modes.normal_dashpot = p.share * p.normal_dashpot * inverse_masses;
  modes.tangential_spring = p.share * p.tangential_stiffness / mt;
  modes.tangential_dashpot = p.share * p.tangential_dashpot / mt;
  modes.rolling_spring =
      p.share * p.rolling_stiffness * mass_over_inertia * (inverse_i / (ri * ri) + inverse_j / (rj * rj));
  const auto see_side = [&](int ball, int partner, double own, double other, double r_own, double r_other) {
    modes.burden = drumlin::physics::link_burden(own, other);
    modes.rolling_burden = drumlin::physics::link_burden(own / (r_own * r_own), other / (r_other * r_other));
    see(ball, partner, modes, p.overlap / p.radius);
  };
  if (inverse_i > 0.0)
    see_side(p.i, wall ? 0 : static_cast<int>(atom->tag[p.j]), inverse_i, inverse_j, ri, rj);
  if (inverse_j > 0.0 && (p.j < atom->nlocal || force->newton_pair))
    see_side(p.j, static_cast<int>(atom->tag[p.i]), inverse_j, inverse_i, rj, ri);
}

void FixGuard::see(int i, int partner, const drumlin::physics::LinkModes &modes, double overlap) {
  if (!(atom->mask[i] & groupbit)) return;
  Ball link;
  link.loads.add(modes);
  link.fastest = modes.normal_spring;
  link.shortest = critical_step(modes);
  link.overlap = overlap;
  link.fastest_partner = link.shortest_partner = link.overlap_partner = partner;
  balls_[static_cast<std::size_t>(i)].join(link);
}

void FixGuard::Ball::join(const Ball &other) {
  loads.add(other.loads);
  if (other.fastest > fastest) {
    fastest = other.fastest;
    fastest_partner = other.fastest_partner;
  }
  if (other.shortest < shortest) {
    shortest = other.shortest;
    shortest_partner = other.shortest_partner;
  }
  if (other.overlap > overlap) {
    overlap = other.overlap;
    overlap_partner = other.overlap_partner;
  }
}

void FixGuard::pack_gathered(int n, int first, double *buf) {
  std::memcpy(buf, balls_.data() + first, static_cast<std::size_t>(n) * sizeof(Ball));
}

void FixGuard::join_gathered(int n, const int *list, const double *buf) {
  for (int m = 0; m < n; ++m) {
    Ball ball;
    std::memcpy(static_cast<void *>(&ball), buf + static_cast<std::ptrdiff_t>(m) * comm_reverse,
                sizeof(Ball));
    balls_[static_cast<std::size_t>(list[m])].join(ball);
  }
}

void FixGuard::end_links() {
  observe(false);
  if (force->newton_pair) drumlin::engine::reverse_comm(comm, this);
  constexpr int extremes = 3;
  Extreme mine[extremes] = {{std::numeric_limits<double>::infinity(), 0, 0}, {0, 0, 0}, {0, 0, 0}};
  for (int i = 0; i < atom->nlocal; ++i) {
    const Ball &ball = balls_[static_cast<std::size_t>(i)];
    if (ball.fastest == 0.0) continue;
    const double tag = atom->tag[i];
    if (const double critical = ball.loads.critical_step(); critical < mine[0].value)
      mine[0] = {critical, tag, ball.shortest_partner};
    if (ball.fastest > mine[1].value) mine[1] = {ball.fastest, tag, ball.fastest_partner};
    if (ball.overlap > mine[2].value) mine[2] = {ball.overlap, tag, ball.overlap_partner};
  }
  constexpr int numbers = sizeof(Extreme) / sizeof(double) * extremes;
  std::vector<std::array<Extreme, extremes>> all(static_cast<std::size_t>(comm->nprocs));
  MPI_Allgather(mine, numbers, MPI_DOUBLE, all.data(), numbers, MPI_DOUBLE, world);
  critical_ = all[0][0];
  fastest_ = all[0][1];
  deepest_ = all[0][2];
  for (const std::array<Extreme, extremes> &rank : all) {
    if (rank[0].value < critical_.value) critical_ = rank[0];
    if (rank[1].value > fastest_.value) fastest_ = rank[1];
    if (rank[2].value > deepest_.value) deepest_ = rank[2];
  }

  check_limits(update->ntimestep -
               (links_of_setup_ ? 1 : 0)); // the links of the set-up are checked one step later
  if (links_of_setup_) log_at_setup();
}

void FixGuard::check_limits(bigint step) const {
  if (deepest_.value > overlap_)
    drumlin::engine::stop(
        lmp, fmt::format(
                 "fix guard: overlap of {} is '{:.3g}' of the smaller radius at step {}; allowed: at most "
                 "{:.3g} of it (usual causes: contacts too soft for their load, balls created with overlap)",
                 pair_name(deepest_.ball, deepest_.partner), deepest_.value, step, overlap_));
  if (update->dt > step_ * critical_.value)
    drumlin::engine::stop(
        lmp, fmt::format("fix guard: time step is '{:.4g} s' at step {}, where ball {:.0f} has the critical "
                         "step {:.4g} s (mostly because of the link of {}); allowed: at most {:.4g} s",
                         update->dt, step, critical_.ball, critical_.value,
                         pair_name(critical_.ball, critical_.partner), step_ * critical_.value));
}

void FixGuard::log_at_setup() {
  std::string text = fmt::format("fix guard {}: no contact and no bond yet\n", id);
  if (fastest_.value > 0.0)
    text = fmt::format(
        "fix guard {}: critical step {:.4g} s, of ball {:.0f} (mostly because of the link of {}), time step "
        "{:.3g} of it; pi/(w0 dt) = {:.4g} for {}; largest overlap {:.3g} of a radius\n",
        id, critical_.value, critical_.ball, pair_name(critical_.ball, critical_.partner),
        update->dt / critical_.value, steps_per_contact(), pair_name(fastest_.ball, fastest_.partner),
        deepest_.value);
  if (text != logged_) drumlin::engine::log_message(lmp, text);
  logged_ = text;
}

double FixGuard::steps_per_contact() const {
  return drumlin::physics::steps_per_contact(fastest_.value, 1.0, update->dt);
}

double FixGuard::compute_vector(int n) { return n == 0 ? steps_per_contact() : deepest_.value; }

void FixGuard::check_numbers() {
  int bad = INT_MAX; // lowest ID of a ball with a number that is not finite
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
  drumlin::engine::stop(
      lmp, fmt::format("fix guard: ball {} is '{} {} {} m, {} {} {} m/s, {} {} {} N' (position, velocity, "
                       "force) at step {}; allowed: finite numbers (usual cause: too large a time step)",
                       worst, all[0], all[1], all[2], all[3], all[4], all[5], all[6], all[7], all[8],
                       update->ntimestep));
}
