#include "fixes/fix_bond_spring.h"

#include "support/arguments.h"
#include "contact/fix_stepping.h"
#include "support/restart_record.h"

#include "physics/laws/linear_contact.h"
#include "physics/scheme/implicit_dashpot.h"

#include <algorithm>
#include <fmt/format.h>

using namespace LAMMPS_NS;
using drumlin::Range;
namespace physics = drumlin::physics;

namespace {

physics::Vec3 squared(const physics::Vec3 &v) { return {v[0] * v[0], v[1] * v[1], v[2] * v[2]}; }

} // namespace

FixBondSpring::FixBondSpring(LAMMPS *lammps, int narg, char **arg) : GhostFix(lammps, narg, arg) {
  scalar_flag = vector_flag = 1;
  size_vector = 5;
  extscalar = 1;
  extvector = 0;
  global_freq = 1;
  restart_global = 1;
  offer_energy_and_virial();

  drumlin::Arguments in(error, "fix bond/spring", narg - 3, arg + 3);
  tags_[0] = static_cast<int>(in.integer("ball i", 1));
  tags_[1] = static_cast<int>(in.integer("ball j", 1));
  if (tags_[0] == tags_[1])
    in.fail(fmt::format("ball j is '{}', the same as ball i; allowed: another ball", tags_[1]));
  bond_.stiffness = in.number("stiffness k", Range::positive);
  bond_.damping = in.number("damping c", Range::non_negative);
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "length") {
      const std::string allowed = "current or " + drumlin::allowed_text(Range::positive);
      const std::string length = in.word("keyword length", allowed);
      current_length_ = length == "current";
      if (current_length_) continue;
      bond_.length = drumlin::parse_number(length);
      if (!drumlin::in_range(bond_.length, Range::positive)) in.fail("keyword length", length, allowed);
    } else if (keyword == "strength") {
      bond_.strength = in.number("keyword strength", Range::positive);
    } else {
      in.fail("keyword", keyword, "length or strength");
    }
  }
}

void FixBondSpring::added() { numbering_ = FixBetweenRuns::provide(lmp)->numbering(); }

int FixBondSpring::setmask() { return FixConst::PRE_NEIGHBOR | FixConst::POST_FORCE; }

void FixBondSpring::init() {
  deck_check_.of_fix(lmp, *this);
  stepping_ = FixStepping::find(lmp);
  observers_.find(*modify);
  clumps_.find(*modify);
  if (FixBetweenRuns::provide(lmp)->numbering() != numbering_)
    drumlin::engine::stop(lmp,
                          fmt::format("fix bond/spring: balls are '{}' and '{}', IDs that other balls may "
                                      "have now, since balls were renumbered; allowed: delete_atoms with "
                                      "compress no, or the fix behind it",
                                      tags_[0], tags_[1]));
  for (const int tag : tags_) {
    int mine = 0;
    for (int i = 0; i < atom->nlocal; ++i)
      mine += atom->tag[i] == tag ? 1 : 0;
    int all = 0;
    MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_SUM, world);
    if (all != 1)
      error->all(
          FLERR,
          drumlin::engine::error_text(fmt::format(
              "fix bond/spring: ball is '{}', which is not in the box; allowed: the ID of a ball in the box",
              tag)));
  }
}

void FixBondSpring::setup_pre_neighbor() { find_balls(); }
void FixBondSpring::pre_neighbor() { find_balls(); }

void FixBondSpring::find_balls() {
  local_ = {-1, -1};
  for (int i = 0; i < atom->nlocal; ++i)
    for (std::size_t b = 0; b < 2; ++b)
      if (atom->tag[i] == tags_[b]) {
        local_[b] = i;
        if (stepping_) stepping_->expect(i, bond_.stiffness, bond_.damping);
      }
}

FixBondSpring::State FixBondSpring::gather_state() {
  struct Ball { // state of a ball, which all ranks need; numbers only, for MPI
    double x[3], v[3], v_before[3], inverse_mass[3], damping_over_mass, found;
  };
  constexpr int numbers = sizeof(Ball) / sizeof(double);
  Ball mine[2] = {};
  for (std::size_t b = 0; b < 2; ++b)
    if (const int i = local_[b]; i >= 0) {
      std::copy_n(atom->x[i], 3, mine[b].x);
      std::copy_n(atom->v[i], 3, mine[b].v);
      std::fill_n(mine[b].inverse_mass, 3, 1.0 / clumps_.mass_in_bond(*atom, i, atom->rmass[i]));
      if (stepping_) {
        for (std::size_t a = 0; a < 3; ++a)
          if (stepping_->is_driven(i, a)) mine[b].inverse_mass[a] = 0.0;
        std::copy_n(stepping_->velocity_before(i), 3, mine[b].v_before);
        mine[b].damping_over_mass = stepping_->damping_over_mass(i);
      }
      mine[b].found = 1.0;
    }
  Ball all[2] = {mine[0], mine[1]};
  if (comm->nprocs > 1) MPI_Allreduce(mine, all, 2 * numbers, MPI_DOUBLE, MPI_SUM, world);
  if (all[0].found != 1.0 || all[1].found != 1.0)
    error->all(FLERR,
               drumlin::engine::error_text(fmt::format(
                   "fix bond/spring: ball is '{}', which was lost at step {}; allowed: both balls in the box",
                   tags_[all[0].found != 1.0 ? 0 : 1], update->ntimestep)));
  std::array<double, 3> d{all[1].x[0] - all[0].x[0], all[1].x[1] - all[0].x[1], all[1].x[2] - all[0].x[2]};
  const std::array<double, 3> apart = d;
  drumlin::engine::minimum_image(domain, d);
  State s{};
  s.velocity_of_image = drumlin::engine::velocity_of_image(*domain, physics::sum(d, -1.0, apart));
  s.distance = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  s.damping_over_mass = all[0].damping_over_mass + all[1].damping_over_mass;
  for (std::size_t a = 0; a < 3; ++a) {
    s.direction[a] = d[a] / s.distance;
    s.rate += (all[1].v[a] - all[0].v[a] + s.velocity_of_image[a]) * s.direction[a];
    s.rate_before += (all[1].v_before[a] - all[0].v_before[a] + s.velocity_of_image[a]) * s.direction[a];
  }
  for (std::size_t b = 0; b < 2; ++b) {
    const double *of = all[b].inverse_mass;
    const bool same = of[0] == of[1] && of[1] == of[2];
    s.inverse_mass[b] = of[0];
    if (!same) s.inverse_mass[b] = physics::dot({of[0], of[1], of[2]}, squared(s.direction));
  }
  s.inverse_masses = s.inverse_mass[0] + s.inverse_mass[1];
  return s;
}

double FixBondSpring::place(const std::array<double, 3> &direction) const {
  double place = 0.0;
  if (const int i = local_[0]; i >= 0) {
    std::array<double, 3> x{};
    domain->unmap(atom->x[i], atom->image[i], x.data());
    place = physics::dot(x, direction);
  }
  if (comm->nprocs > 1) MPI_Allreduce(MPI_IN_PLACE, &place, 1, MPI_DOUBLE, MPI_SUM, world);
  return place;
}

/// The bond with the rate of its stretch at which spring and dashpot together exert a tension, N.
physics::BondForce FixBondSpring::bond_under(double tension) const {
  const double stretch = state_.distance - bond_.length;
  const double rate =
      bond_.damping > 0.0 ? (tension - bond_.stiffness * stretch) / bond_.damping : state_.rate;
  return physics::bond_force(bond_, state_.distance, rate);
}

/// The bond as a link of one of its balls, from which the ball's critical time step follows.
physics::LinkModes FixBondSpring::modes(std::size_t ball) const {
  physics::LinkModes modes;
  const double own = state_.inverse_mass[ball];
  modes.burden = physics::link_burden(own, state_.inverse_masses - own);
  modes.normal = state_.direction;
  modes.normal_spring = bond_.stiffness * state_.inverse_masses;
  if (stepping_ == nullptr) modes.normal_dashpot = bond_.damping * state_.inverse_masses;
  return modes;
}

physics::BondForce FixBondSpring::evaluate() {
  if (!whole_) return acted_;
  const State s = gather_state();
  return physics::bond_force(bond_, s.distance, s.rate);
}

void FixBondSpring::setup(int vflag) {
  if (current_length_) {
    bond_.length = gather_state().distance;
    current_length_ = false;
  }
  if (const std::string wrong = bond_.invalid(); !wrong.empty())
    error->all(FLERR, drumlin::engine::error_text("fix bond/spring: " + wrong));
  if (!echoed_ && comm->me == 0) {
    const std::string text =
        fmt::format("fix bond/spring {}: balls {} and {}, k = {:.6g} N/m, c = {:.6g} N s/m, length = {:.9g} "
                    "m, strength = {:.6g} N\n",
                    id, tags_[0], tags_[1], bond_.stiffness, bond_.damping, bond_.length, bond_.strength);
    drumlin::engine::log_message(lmp, text);
  }
  echoed_ = true;
  int continuing = 0;
  for (const int i : local_)
    if (i >= 0 && has_acted_ && stepping_ != nullptr && stepping_->continues(i, -1)) ++continuing;
  MPI_Allreduce(MPI_IN_PLACE, &continuing, 1, MPI_INT, MPI_SUM, world);
  continues_ = continuing == 2;
  post_force(vflag);
}

void FixBondSpring::post_force(int vflag) {
  begin_virial(vflag);
  if (!whole_) {
    acted_ = {};
    return;
  }
  state_ = gather_state();
  for (std::size_t b = 0; b < 2; ++b)
    if (const int i = local_[b]; i >= 0) {
      if (stepping_ && stepping_->counting()) stepping_->add_damping(i, bond_.damping);
      if (observers_.any() && state_.inverse_mass[b] > 0.0) observers_.tell_bond(i, tags_[1 - b], modes(b));
    }
  if (!update->setupflag) has_acted_ = true;
  if (stepping_ != nullptr && !update->setupflag) return post_force_second_order();
  if (const double tension = acted_.force; continues_ && update->setupflag) {
    store(bond_under(tension));
    acted_.force = tension; // to the last bit
    for (const int i : local_)
      if (i >= 0) stepping_->load(i, -1, tension);
  } else
    store(physics::bond_force(bond_, state_.distance, state_.rate));
  apply(acted_.force);
}

/// The force under second-order stepping. The formulas are those of a contact, see
/// physics/scheme/implicit_dashpot.h.
void FixBondSpring::post_force_second_order() {
  const physics::StepMotion motion{state_.distance - bond_.length, state_.rate, state_.rate_before,
                                   update->dt};
  // A bond has no make, and its force is not limited to compression: transition A is the law without this
  // limit.
  const physics::LinearLaw law(bond_.stiffness, bond_.damping, physics::Transition::A);
  // A light dashpot is solved for alone: solved for together with a far heavier one its force would lag
  // behind by many steps.
  const double own = std::sqrt(bond_.damping) * state_.inverse_masses;
  if (!physics::needs_coupling(motion.dt, bond_.stiffness, bond_.damping, own)) {
    store(bond_under(
        physics::implicit_force(law, motion, acted_.force, bond_.damping * state_.inverse_masses)));
    apply(acted_.force);
    return;
  }
  // The dashpots of contacts beside it lag by the square root of this ratio: see CoupledDashpot.
  constexpr double most_steps = 1e4;
  if (const double time_constant = 1.0 / (bond_.damping * state_.inverse_masses);
      motion.dt > most_steps * time_constant)
    drumlin::engine::stop(lmp,
                          fmt::format("fix bond/spring: damping c is '{:.6g} N s/m', with the time "
                                      "constant m_eff/c of {:.3g} s; allowed: at least {:.3g} s, 1e-4 of "
                                      "the time step",
                                      bond_.damping, time_constant, motion.dt / most_steps));
  const physics::CoupledDashpot coupled =
      physics::coupled_dashpot(law, motion, acted_.force, state_.damping_over_mass);
  apply(coupled.first);
  stepping_->couple([this, coupled] {
    store(bond_under(physics::coupled_force(coupled, predicted_rate())));
    tally(acted_.force - coupled.first);
    for (std::size_t b = 0; b < 2; ++b)
      if (const int i = local_[b]; i >= 0)
        stepping_->add_force(i, sign_[b] * (acted_.force - coupled.first), state_.direction);
  });
}

/// Rate of the stretch, m/s, with the velocities that FixStepping predicts for the end of the step.
/// Collective.
double FixBondSpring::predicted_rate() const {
  double mine = 0.0;
  for (std::size_t b = 0; b < 2; ++b)
    if (const int i = local_[b]; i >= 0)
      for (std::size_t a = 0; a < 3; ++a)
        mine -= sign_[b] * stepping_->predicted_velocity(i)[a] * state_.direction[a];
  double rate = mine;
  if (comm->nprocs > 1) MPI_Allreduce(&mine, &rate, 1, MPI_DOUBLE, MPI_SUM, world);
  return rate + physics::dot(state_.velocity_of_image, state_.direction);
}

void FixBondSpring::apply(double tension) {
  for (std::size_t b = 0; b < 2; ++b)
    if (const int i = local_[b]; i >= 0)
      for (std::size_t a = 0; a < 3; ++a)
        atom->f[i][a] += sign_[b] * tension * state_.direction[a];
  tally(tension);
}

/// Adds this rank's share of the bond's virial: the sum of x f over both balls, J, with the components xx,
/// yy, zz, xy, xz, yz.
void FixBondSpring::tally(double tension) {
  if (!evflag) return;
  std::array<int, 2> mine{};
  int n = 0;
  for (const int i : local_)
    if (i >= 0) mine.at(static_cast<std::size_t>(n++)) = i;
  const auto &[x, y, z] = state_.direction;
  const double all = -tension * state_.distance;
  std::array<double, 6> both{all * x * x, all * y * y, all * z * z, all * x * y, all * x * z, all * y * z};
  v_tally(n, mine.data(), 2.0, both.data());
}

/// Keeps the force that acts in this step; a bond that breaks exerts none from the next step on.
void FixBondSpring::store(const physics::BondForce &acting) {
  acted_ = acting;
  if (!acted_.breaks) return;
  whole_ = false;
  if (comm->me == 0)
    error->warning(FLERR,
                   drumlin::engine::error_text(fmt::format(
                       "fix bond/spring {}: the bond of balls {} and {} broke at step {} under {:.6g} N", id,
                       tags_[0], tags_[1], update->ntimestep, acted_.force)));
  acted_ = {};
  acted_.released = acting.stored;
}

void FixBondSpring::write_restart(FILE *file) {
  // Files of versions up to 0.4.0 end behind the second number, which is 0 or 1 there.
  drumlin::write_restart_record(file, comm->me,
                                {current_length_ ? -1.0 : bond_.length, (whole_ ? 1.0 : 0.0) + 2.0,
                                 has_acted_ ? acted_.force : NAN, bond_.stiffness, bond_.damping});
}

void FixBondSpring::restart(char *buffer) {
  const double *state = reinterpret_cast<const double *>(buffer);
  if (current_length_ && state[0] >= 0.0) {
    bond_.length = state[0];
    current_length_ = false;
  }
  whole_ = state[1] != 0.0 && state[1] != 2.0;
  if (state[1] < 2.0 || state[3] != bond_.stiffness || state[4] != bond_.damping) return;
  acted_.force = state[2];
  has_acted_ = !std::isnan(acted_.force);
}

double FixBondSpring::compute_vector(int n) {
  switch (n) {
  case 0:
    return whole_ ? state_.distance - bond_.length : 0.0;
  case 1:
    return whole_ ? state_.rate : 0.0;
  case 2:
    return acted_.force;
  case 3:
    return acted_.dissipated;
  default:
    return whole_ ? 1.0 : 0.0;
  }
}
