#include "fixes/fix_roller_history.h"

#include "support/arguments.h"
#include "fixes/fix_bond_spring.h"
#include "fixes/fix_drum_excite.h"
#include "support/restart_record.h"

#include <algorithm>
#include <fmt/format.h>

using namespace LAMMPS_NS;
namespace engine = drumlin::engine;
namespace physics = drumlin::physics;

namespace {

constexpr const char *command = "fix roller/history";
constexpr const char *file_keyword = "fix roller/history: keyword file";
constexpr const char *cycles_keyword = "fix roller/history: keyword cycles";
constexpr double pi = 3.141592653589793;

} // namespace

FixRollerHistory::FixRollerHistory(LAMMPS *lammps, int narg, char **arg) : GhostFix(lammps, narg, arg) {
  vector_flag = 1;
  size_vector = 10;
  extvector = 0;
  global_freq = 1;
  restart_global = 1;
  time_depend = 1;
  comm_forward = 6;
  parse(narg, arg);
}

void FixRollerHistory::parse(int narg, char **arg) {
  drumlin::Arguments in(error, command, narg - 3, arg + 3);
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "file") {
      file_name_ = in.word("keyword file: its name", drumlin::output_name_allowed);
    } else if (keyword == "every") {
      every_ = static_cast<int>(in.integer("keyword every", 1));
    } else if (keyword == "cycles") {
      cycles_name_ = in.word("keyword cycles: its file name", drumlin::output_name_allowed);
      steps_per_cycle_ = static_cast<int>(in.integer("keyword cycles, steps per cycle", 1));
    } else if (keyword == "frame") {
      frame_group_ = in.word("keyword frame: its group", "the name of a group");
      const int index = group->find(frame_group_.c_str());
      if (index < 0) in.fail("keyword frame is '" + frame_group_ + "'; allowed: the name of a group");
      frame_.groupbit = group->bitmask[index];
    } else if (keyword == "soil") {
      const std::string name = in.word("keyword soil: its group", "the name of a group");
      const int index = group->find(name.c_str());
      if (index < 0) in.fail("keyword soil is '" + name + "'; allowed: the name of a group");
      soil_groupbit_ = group->bitmask[index];
    } else if (keyword == "excite") {
      excite_id_ = in.word("keyword excite: its fix", "the ID of a fix drum/excite");
    } else if (keyword == "bond") {
      bond_id_ = in.word("keyword bond: its fix", "the ID of a fix bond/spring");
    } else if (keyword == "axis") {
      for (std::size_t a = 0; a < 3; ++a)
        axis_[a] = in.number(std::string("keyword axis, ") + "xyz"[a]);
      const double length = std::hypot(axis_[0], axis_[1], axis_[2]);
      if (length == 0.0) in.fail("keyword axis is '0 0 0'; allowed: a vector with a length");
      for (double &component : axis_)
        component /= length;
      has_axis_ = true;
    } else if (keyword == "origin") {
      drum_.origin = in.number("keyword origin, of the drum");
      frame_.origin = in.number("keyword origin, of the frame");
      drum_.has_origin = frame_.has_origin = true;
    } else if (keyword == "append") {
      append_ = in.choice("keyword append", {"yes", "no"}) == 0;
    } else {
      in.fail("unknown keyword '" + keyword +
              "'; allowed: file, every, cycles, frame, soil, excite, bond, axis, origin or append");
    }
  }
  if (file_name_.empty()) in.fail("keyword file is missing; allowed: file NAME every N");
  if (every_ == 0) in.fail("keyword every is missing; allowed: file NAME every N");
  if (soil_groupbit_ != 0) {
    if (frame_.groupbit == 0 || steps_per_cycle_ == 0)
      in.fail("keyword soil goes with keywords frame and cycles; allowed: all three, or no soil");
    bed_.emplace(lmp, soil_groupbit_);
    observe(true);
  }
  drum_.groupbit = groupbit;
  nevery = steps_per_cycle_ > 0 ? 1 : every_; // cycle sums need every step
  global_freq = nevery;
}

int FixRollerHistory::setmask() {
  return FixConst::PRE_NEIGHBOR | FixConst::END_OF_STEP | FixConst::POST_RUN |
         (bed_ ? FixConst::PRE_FORCE : 0);
}

void FixRollerHistory::setup_pre_force(int step) { pre_force(step); }
void FixRollerHistory::pre_force(int) {
  if (bed_) bed_->clear();
}

void FixRollerHistory::init() {
  source_ = drumlin::contact_source(lmp);
  if (source_ == nullptr)
    error->all(FLERR, engine::as_is(fmt::format("fix roller/history: the pair style is another; allowed: {}",
                                                engine::pair_style)));
  drumlin::OutputFile::check(file_name_, comm, error, world, file_keyword);
  if (steps_per_cycle_ > 0) drumlin::OutputFile::check(cycles_name_, comm, error, world, cycles_keyword);
  if (group->count(igroup) == 0)
    error->all(FLERR, engine::as_is(fmt::format(
                          "fix roller/history: group {} is empty; allowed: the group of the drum's balls",
                          group->names[igroup])));
  drum_.mass = group->mass(igroup);
  if (!frame_group_.empty()) {
    const int index = group->find(frame_group_.c_str());
    if (index < 0 || group->count(index) == 0)
      error->all(FLERR, engine::as_is(fmt::format(
                            "fix roller/history: keyword frame: group {} is empty; allowed: the group of the "
                            "frame's balls",
                            frame_group_)));
    frame_.mass = group->mass(index);
  }
  excite_ = dynamic_cast<FixDrumExcite *>(engine::find_fix(modify, excite_id_));
  if (!excite_id_.empty() && excite_ == nullptr)
    error->all(FLERR, engine::as_is(fmt::format(
                          "fix roller/history: keyword excite is '{}'; allowed: the ID of a fix drum/excite",
                          excite_id_)));
  bond_ = dynamic_cast<FixBondSpring *>(engine::find_fix(modify, bond_id_));
  if (!bond_id_.empty() && bond_ == nullptr)
    error->all(FLERR, engine::as_is(fmt::format(
                          "fix roller/history: keyword bond is '{}'; allowed: the ID of a fix bond/spring",
                          bond_id_)));

  const std::array<double, 3> g = engine::gravity(modify);
  if (!has_axis_) {
    const double size = std::hypot(g[0], g[1], g[2]);
    if (size == 0.0)
      error->all(
          FLERR,
          "fix roller/history: keyword axis is missing and there is no gravity to take it from; allowed: "
          "axis x y z");
    axis_ = {-g[0] / size, -g[1] / size, -g[2] / size};
  }
  gravity_ = -along(g.data());
}

double FixRollerHistory::along(const double *vector) const {
  return vector[0] * axis_[0] + vector[1] * axis_[1] + vector[2] * axis_[2];
}

void FixRollerHistory::setup(int) {
  const bool first = !clock_.running();
  clock_.set_up(update->ntimestep, update->dt);
  if (!file_) {
    file_.emplace(file_name_, append_);
    file_->open(comm, error, world, file_keyword,
                bed_
                    ? "time,x_drum,v_drum,a_drum,x_frame,v_frame,a_frame,F_contact,F_excitation,F_bond,"
                      "settlement,overlap_ratio,coordination,void_ratio,kinetic,potential,elastic,dissipated,"
                      "work_excitation,F_floor,F_sides,F_thrust"
                : frame_.groupbit != 0
                    ? "time,x_drum,v_drum,a_drum,x_frame,v_frame,a_frame,F_contact,F_excitation,F_bond"
                    : "time,x_drum,v_drum,a_drum,F_contact,F_excitation");
  }
  if (steps_per_cycle_ > 0 && !cycles_file_) {
    cycles_file_.emplace(cycles_name_, append_);
    const std::string columns =
        "cycle,time,a_drum_min,a_drum_max,F_contact_min,F_contact_max,contact_share,a1_cos,a1_sin,a2_cos,"
        "a2_sin,ah_cos,ah_sin,work_excitation,dissipated_contact,dissipated_bond,kinetic,potential,"
        "stored_contact,stored_bond";
    cycles_file_->open(comm, error, world, cycles_keyword,
                       (bed_ ? columns + ",dissipated_friction,settlement" : columns).c_str());
  }
  rebuild();
  evaluate();
  if (first && bed_) {
    const drumlin::BallSums balls = ball_sums();
    if (balls.soil_balls == 0.0)
      error->all(
          FLERR,
          "fix roller/history: keyword soil: its group is empty; allowed: the group of the soil balls");
    reference_ = {balls.height, sums_.tangential_stored, balls.soil_height / balls.soil_mass};
  }
  if (first) {
    cycle_.number = -1.0;
    start_cycle();
    if (steps_per_cycle_ > 0) write_cycle(); // row of cycle 0: the energies at the start
    start_cycle();
  }
  if (last_sample_ != update->ntimestep && update->ntimestep % every_ == 0) write_sample();
}

void FixRollerHistory::pre_neighbor() { stale_ = true; }

void FixRollerHistory::rebuild() {
  candidates_.clear();
  const NeighList *list = source_->contact_list();
  const int *mask = atom->mask;
  const int roller = drum_.groupbit | frame_.groupbit;
  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii];
    for (int jj = 0; jj < list->numneigh[i]; ++jj) {
      const int j = engine::neighbour_index(list->firstneigh[i][jj]);
      const bool i_drum = mask[i] & drum_.groupbit;
      const bool j_drum = mask[j] & drum_.groupbit;
      if (i_drum == j_drum || ((i_drum ? mask[j] : mask[i]) & roller)) continue;
      // With newton off a pair across ranks is listed on both: the drum ball's owner counts it.
      if ((i_drum ? i : j) >= atom->nlocal && !force->newton_pair) continue;
      const physics::LinearLaw law =
          source_->law(atom->type[i], atom->type[j]).of_mass(source_->effective_mass(i, j));
      const drumlin::FrictionModel model = source_->friction_model();
      candidates_.push_back(
          {i, j, i_drum ? 1.0 : -1.0, law,
           model == drumlin::FrictionModel::none
               ? physics::Friction{}
               : source_->friction(atom->type[i], atom->type[j], law.dashpot(0.0)),
           model == drumlin::FrictionModel::history ? source_->tangential_spring(i, jj) : nullptr});
    }
  }
  stale_ = false;
}

/// \param stretch of what holds the body when its origin is taken, m: x is 0 without it
void FixRollerHistory::locate(Body &body, const char *name, double stretch) {
  std::array<double, 2> mine{}; // mass-weighted position and velocity along the axis
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & body.groupbit) {
      std::array<double, 3> x{};
      domain->unmap(atom->x[i], atom->image[i], x.data());
      mine[0] += atom->rmass[i] * along(x.data());
      mine[1] += atom->rmass[i] * along(atom->v[i]);
    }
  std::array<double, 2> all = mine;
  if (comm->nprocs > 1) MPI_Allreduce(mine.data(), all.data(), 2, MPI_DOUBLE, MPI_SUM, world);
  const double position = all[0] / body.mass;
  if (!body.has_origin) {
    body.origin = position - stretch;
    body.has_origin = true;
  }
  body.x = position - body.origin;
  body.v = all[1] / body.mass;
  if (!std::isfinite(body.x) || !std::isfinite(body.v))
    error->all(FLERR,
               engine::as_is(fmt::format(
                   "fix roller/history: the {} is at {} m with {} m/s at step {}; allowed: finite numbers",
                   name, body.x, body.v, update->ntimestep)));
}

void FixRollerHistory::evaluate() {
  if (comm->nprocs > 1 || atom->nghost > 0) engine::forward_comm(comm, this);
  if (stale_) rebuild();
  locate(drum_, "drum");
  if (frame_.groupbit != 0) locate(frame_, "frame", bond_ && !frame_.has_origin ? bond_->stretch() : 0.0);

  std::array<double, 4> mine{}; // contact force, dissipated power, stored energy, pairs in contact
  for (const Candidate &pair : candidates_) {
    const drumlin::PairMotion m = drumlin::pair_motion(*atom, pair.i, pair.j);
    const double F = pair.law.force(m.overlap, m.rate);
    mine[0] += pair.sign * F * along(m.normal.data());
    if (m.overlap > 0.0 && pair.friction.coefficient > 0.0)
      mine[0] += pair.sign * along(drumlin::friction_force(*atom, pair.i, pair.j, m, pair.friction, F,
                                                           pair.spring, update->dt)
                                       .data());
    mine[1] += pair.law.power(m.overlap, m.rate).dissipated;
    mine[2] += pair.law.energy(m.overlap);
    mine[3] += pair.law.acts(m.overlap, m.rate) ? 1.0 : 0.0;
  }
  std::array<double, 4> all = mine;
  if (comm->nprocs > 1) MPI_Allreduce(mine.data(), all.data(), 4, MPI_DOUBLE, MPI_SUM, world);
  forces_ = {};
  forces_.contact = all[0];
  forces_.contact_dissipated = all[1];
  forces_.contact_stored = all[2];
  forces_.in_contact = all[3] > 0.0;

  double drum_force = forces_.contact;
  if (excite_) {
    forces_.excitation = excite_->compute_scalar();
    double push = 0.0; // component along the axis, upwards
    for (int a = 0; a < 3; ++a)
      push += excite_->compute_vector(a) * axis_[static_cast<std::size_t>(a)];
    drum_force += push;
    forces_.excitation_power = push * drum_.v;
  }
  if (bond_) {
    const physics::BondForce bond = bond_->evaluate();
    forces_.bond = bond.force;
    forces_.bond_dissipated = bond.dissipated;
    forces_.bond_stored = bond.stored;
    drum_force += bond.force; // the frame is above the drum: tension lifts the drum
    if (frame_.mass > 0.0) frame_.a = -bond.force / frame_.mass - gravity_;
  }
  drum_.a = drum_force / drum_.mass - gravity_;
  if (bed_) evaluate_bed();
}

void FixRollerHistory::evaluate_bed() {
  sums_ = bed_->contacts(axis_);
  forces_.contact_dissipated = sums_.normal_heat;
  forces_.contact_stored = sums_.normal_stored + sums_.tangential_stored;
  forces_.tangential_power = sums_.tangential_power;
}

void FixRollerHistory::end_of_step() {
  const Forces before = forces_;
  const double v_before = drum_.v;
  evaluate();
  if (steps_per_cycle_ > 0) count_step(before, v_before);
  if (update->ntimestep % every_ == 0) write_sample();
}

void FixRollerHistory::write_sample() {
  last_sample_ = update->ntimestep;
  const drumlin::BallSums balls = bed_ ? ball_sums() : drumlin::BallSums{}; // collective
  FILE *out = file_->get();
  if (out == nullptr) return;
  if (frame_.groupbit != 0) {
    std::fprintf(out, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", time(), drum_.x, drum_.v,
                 drum_.a, frame_.x, frame_.v, frame_.a, forces_.contact, forces_.excitation, forces_.bond);
    if (bed_)
      std::fprintf(
          out, ",%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", cycle_.settlement,
          sums_.contacts > 0.0 ? sums_.overlap / sums_.contacts : 0.0, sums_.coordination / balls.soil_balls,
          bed_->void_ratio(axis_, reference_.window_top, balls.solid), balls.kinetic,
          gravity_ * (balls.height - reference_.height), forces_.contact_stored + forces_.bond_stored,
          cycle_.contact_dissipated + cycle_.bond_dissipated + tangential_heat(), cycle_.work,
          sums_.floor_force, sums_.side_force, sums_.side_thrust);
    std::fputc('\n', out);
  } else
    std::fprintf(out, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", time(), drum_.x, drum_.v, drum_.a,
                 forces_.contact, forces_.excitation);
}

void FixRollerHistory::start_cycle() {
  const Cycle sums = cycle_;
  cycle_ = {};
  cycle_.number = sums.number + 1.0;
  cycle_.work = sums.work;
  cycle_.contact_dissipated = sums.contact_dissipated;
  cycle_.bond_dissipated = sums.bond_dissipated;
  cycle_.tangential_work = sums.tangential_work;
  cycle_.settlement = sums.steps > 0.0 ? sums.sinking / sums.steps : 0.0;
  cycle_.a_min = cycle_.a_max = drum_.a;
  cycle_.F_min = cycle_.F_max = forces_.contact;
}

void FixRollerHistory::count_step(const Forces &before, double v_before) {
  const double half = 0.5 * update->dt; // trapezoid over the step
  cycle_.steps += 1.0;
  cycle_.a_min = std::min(cycle_.a_min, drum_.a);
  cycle_.a_max = std::max(cycle_.a_max, drum_.a);
  cycle_.F_min = std::min(cycle_.F_min, forces_.contact);
  cycle_.F_max = std::max(cycle_.F_max, forces_.contact);
  cycle_.contact_steps += forces_.in_contact ? 1.0 : 0.0;
  cycle_.work += half * (before.excitation_power + forces_.excitation_power);
  cycle_.contact_dissipated += half * (before.contact_dissipated + forces_.contact_dissipated);
  cycle_.bond_dissipated += half * (before.bond_dissipated + forces_.bond_dissipated);
  cycle_.tangential_work += half * (before.tangential_power + forces_.tangential_power);
  cycle_.sinking -= drum_.x;

  // The change of the velocity is the integral of the acceleration, through the jumps of the contact force
  // too.
  const double change = 2.0 / (steps_per_cycle_ * update->dt) * (drum_.v - v_before);
  const double middle = 2.0 * pi * (time() / update->dt - 0.5) / steps_per_cycle_;
  constexpr std::array<double, 3> orders{1.0, 2.0, 0.5};
  for (std::size_t n = 0; n < orders.size(); ++n) {
    cycle_.harmonic[2 * n] += change * std::cos(orders[n] * middle);
    cycle_.harmonic[2 * n + 1] += change * std::sin(orders[n] * middle);
  }
  if (static_cast<int>(cycle_.steps) == steps_per_cycle_) {
    write_cycle();
    start_cycle();
    flush();
  }
}

void FixRollerHistory::write_cycle() {
  const drumlin::BallSums balls = bed_ ? ball_sums() : drumlin::BallSums{}; // collective
  FILE *out = cycles_file_->get();
  if (out == nullptr) return;
  const double share =
      cycle_.steps > 0.0 ? cycle_.contact_steps / cycle_.steps : (forces_.in_contact ? 1.0 : 0.0);
  std::fprintf(out, "%.0f,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", cycle_.number, time(), cycle_.a_min,
               cycle_.a_max, cycle_.F_min, cycle_.F_max, share);
  for (const double value : cycle_.harmonic)
    std::fprintf(out, ",%.17g", value);
  const double kinetic =
      bed_ ? balls.kinetic : 0.5 * (drum_.mass * drum_.v * drum_.v + frame_.mass * frame_.v * frame_.v);
  const double potential =
      gravity_ * (bed_ ? balls.height - reference_.height : drum_.mass * drum_.x + frame_.mass * frame_.x);
  std::fprintf(out, ",%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", cycle_.work, cycle_.contact_dissipated,
               cycle_.bond_dissipated, kinetic, potential, forces_.contact_stored, forces_.bond_stored);
  if (bed_)
    std::fprintf(out, ",%.17g,%.17g", tangential_heat(),
                 cycle_.steps > 0.0 ? cycle_.sinking / cycle_.steps : 0.0);
  std::fputc('\n', out);
}

/// Once a cycle and at the end of a run: a full disk ends the run soon, and a reader sees whole cycles.
void FixRollerHistory::flush() {
  file_->flush(error, world, file_keyword);
  if (cycles_file_) cycles_file_->flush(error, world, cycles_keyword);
}

void FixRollerHistory::post_run() { flush(); }

void FixRollerHistory::pack_ghosts(int n, const int *list, double *buf) {
  drumlin::pack_velocities(*atom, n, list, buf);
  buf += 3 * n;
  for (int a = 0; a < n; ++a)
    buf = std::copy_n(atom->omega[list[a]], 3, buf);
}

void FixRollerHistory::unpack_ghosts(int n, int first, double *buf) {
  drumlin::unpack_velocities(*atom, n, first, buf);
  buf += 3 * n;
  for (int i = first; i < first + n; ++i, buf += 3)
    std::copy_n(buf, 3, atom->omega[i]);
}

void FixRollerHistory::write_restart(FILE *file) {
  const auto clock = clock_.state();
  std::vector<double> state(clock.begin(), clock.end());
  state.push_back(drum_.origin);
  state.push_back(frame_.origin);
  state.push_back(static_cast<double>(last_sample_));
  const auto append = [&state](const auto &doubles) {
    const auto *first = reinterpret_cast<const double *>(&doubles);
    state.insert(state.end(), first, first + sizeof(doubles) / sizeof(double));
  };
  append(cycle_);
  append(reference_);
  drumlin::write_restart_record(file, comm->me, state);
}

void FixRollerHistory::restart(char *buffer) {
  const double *state = reinterpret_cast<const double *>(buffer);
  clock_.restore(state);
  drum_.origin = state[3];
  frame_.origin = state[4];
  drum_.has_origin = frame_.has_origin = true;
  last_sample_ = static_cast<bigint>(state[5]);
  state += 6;
  std::copy_n(state, sizeof(Cycle) / sizeof(double), reinterpret_cast<double *>(&cycle_));
  std::copy_n(state + sizeof(Cycle) / sizeof(double), sizeof(Reference) / sizeof(double),
              reinterpret_cast<double *>(&reference_));
}

double FixRollerHistory::compute_vector(int n) {
  const std::array<double, 10> columns{time(),      drum_.x,         drum_.v,
                                       drum_.a,     frame_.x,        frame_.v,
                                       frame_.a,    forces_.contact, forces_.excitation,
                                       forces_.bond};
  return columns[static_cast<std::size_t>(n)];
}
