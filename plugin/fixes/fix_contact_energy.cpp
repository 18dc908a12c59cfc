#include "fixes/fix_contact_energy.h"

#include "contact/contact_source.h"
#include "contact/pair_motion.h"
#include "support/arguments.h"

using namespace LAMMPS_NS;
namespace engine = drumlin::engine;

namespace {

constexpr const char *energy_fix = "fix contact/energy";
/// BedSums counts heights along an axis; no output of this fix depends on it.
constexpr std::array<double, 3> any_axis{0.0, 1.0, 0.0};

} // namespace

FixContactEnergy::FixContactEnergy(LAMMPS *lammps, int narg, char **arg)
    : GhostFix(lammps, narg, arg), sums_(lmp, groupbit) {
  drumlin::Arguments in(error, energy_fix, narg - 3, arg + 3);
  in.expect_end("fix ID group contact/energy");
  vector_flag = 1;
  size_vector = 7;
  extvector = 0;
  global_freq = nevery = 1;
  time_depend = 1; // heat is a sum over the steps
  comm_forward = 6;
  observe(true);
}

int FixContactEnergy::setmask() { return FixConst::PRE_FORCE | FixConst::END_OF_STEP; }

void FixContactEnergy::init() {
  if (drumlin::contact_source(lmp) == nullptr)
    error->all(FLERR, engine::error_text(drumlin::other_pair_style(lmp, energy_fix)));
}

void FixContactEnergy::setup_pre_force(int step) { pre_force(step); }
void FixContactEnergy::pre_force(int) {
  sums_.clear();
  dt_ = update->dt;
}

void FixContactEnergy::setup(int) {
  evaluate();
  if (!spring_0_) spring_0_ = now_.tangential_stored;
}

void FixContactEnergy::evaluate() {
  if (comm->nprocs > 1 || atom->nghost > 0) engine::forward_comm(comm, this);
  now_ = sums_.contacts(any_axis);
  balls_ = sums_.balls(any_axis, 0.0);
}

/// Integrates the powers over the step by the trapezoidal rule, with what it misses of contacts that begin or
/// end.
void FixContactEnergy::end_of_step() {
  const drumlin::ContactSums before = now_;
  evaluate();
  const double half_step = 0.5 * dt_;
  normal_heat_ += half_step * (before.normal_heat + now_.normal_heat) + now_.missed_heat;
  yield_heat_ += now_.yield_heat;
  tangential_work_ += half_step * (before.tangential_power + now_.tangential_power) + now_.missed_work;
}

void FixContactEnergy::pack_ghosts(int n, const int *list, double *buf) {
  drumlin::pack_motion(*atom, n, list, buf, velocity_of_ghosts());
}

void FixContactEnergy::unpack_ghosts(int n, int first, double *buf) {
  drumlin::unpack_motion(*atom, n, first, buf);
}

double FixContactEnergy::compute_vector(int n) {
  switch (n) {
  case 0:
    return balls_.kinetic;
  case 1:
    return now_.normal_stored;
  case 2:
    return now_.tangential_stored;
  case 3:
    return normal_heat_;
  case 4:
    return tangential_work_ - (now_.tangential_stored - spring_0_.value_or(0.0));
  case 5:
    return balls_.soil_balls > 0.0 ? now_.coordination / balls_.soil_balls : 0.0;
  default:
    return yield_heat_;
  }
}
