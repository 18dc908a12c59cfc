#include "fixes/fix_roller_history.h"

#include "contact/pair_motion.h"
#include "fixes/fix_bond_spring.h"
#include "fixes/fix_boundary_absorb.h"
#include "fixes/fix_clump.h"
#include "fixes/fix_drum_excite.h"
#include "fixes/fix_drum_travel.h"
#include "support/arguments.h"
#include "support/other_styles.h"
#include "support/restart_record.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

using namespace LAMMPS_NS;
namespace engine = drumlin::engine;
namespace physics = drumlin::physics;

namespace {

constexpr const char *history_fix = "fix roller/history";
constexpr const char *file_keyword = "fix roller/history: keyword file";
constexpr const char *cycles_keyword = "fix roller/history: keyword cycles";
/// Added to the number of a time step in a restart file to say that the heat of yielding follows as the last
/// number. Beds that do not yield have the same file as before.
constexpr double with_yield_heat = 0.5;

} // namespace

FixRollerHistory::FixRollerHistory(LAMMPS *lammps, int narg, char **arg)
    : GhostFix(lammps, narg, arg), contacts_(lammps) {
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
  drumlin::Arguments in(error, history_fix, narg - 3, arg + 3);
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "file") {
      file_name_ = in.word("keyword file", drumlin::output_name_allowed);
    } else if (keyword == "every") {
      every_ = static_cast<int>(in.integer("keyword every", 1));
    } else if (keyword == "cycles") {
      cycles_name_ = in.word("keyword cycles", drumlin::output_name_allowed);
      steps_per_cycle_ = static_cast<int>(in.integer("keyword cycles, steps per cycle", 1));
    } else if (keyword == "frame") {
      const int index = in.group("keyword frame", group);
      frame_group_ = group->names[index];
      frame_.groupbit = engine::group_bit(index);
    } else if (keyword == "soil") {
      soil_groupbit_ = engine::group_bit(in.group("keyword soil", group));
    } else if (keyword == "excite") {
      excite_ids_.push_back(in.word("keyword excite", "the ID of a fix drum/excite"));
    } else if (keyword == "bond") {
      bond_ids_.push_back(in.word("keyword bond", "the ID of a fix bond/spring"));
    } else if (keyword == "ends") {
      sensor_ = in.number("keyword ends", drumlin::Range::non_negative);
    } else if (keyword == "travel") {
      travel_id_ = in.word("keyword travel", "the ID of a fix drum/travel");
    } else if (keyword == "axis") {
      axis_ = in.direction("keyword axis");
      has_axis_ = true;
    } else if (keyword == "origin") {
      drum_.origin = in.number("keyword origin, of the drum");
      frame_.origin = in.number("keyword origin, of the frame");
      drum_.has_origin = frame_.has_origin = true;
    } else if (keyword == "append") {
      append_ = in.choice("keyword append", {"yes", "no"}) == 0;
    } else {
      in.fail("keyword", keyword,
              "file, every, cycles, frame, soil, excite, bond, travel, ends, axis, origin or append");
    }
  }
  if (file_name_.empty()) in.fail("keyword file is missing; allowed: file NAME every N");
  if (every_ == 0) in.fail("keyword every is missing; allowed: file NAME every N");
  if (soil_groupbit_ != 0) {
    if (frame_.groupbit == 0 || steps_per_cycle_ == 0)
      in.fail("keyword frame or cycles is missing with keyword soil; allowed: all three, or no soil");
    bed_.emplace(lmp, soil_groupbit_);
    observe(true);
  }
  if (sensor_ && frame_.groupbit == 0)
    in.fail("keyword frame is missing with keyword ends; allowed: both, or no ends");
  drum_.groupbit = groupbit;
  nevery = steps_per_cycle_ > 0 ? 1 : every_; // sums over a cycle need every step
  global_freq = nevery;
}

int FixRollerHistory::setmask() {
  return FixConst::POST_INTEGRATE | FixConst::PRE_NEIGHBOR | FixConst::END_OF_STEP | FixConst::POST_RUN |
         (bed_ ? FixConst::PRE_FORCE : 0);
}

void FixRollerHistory::post_integrate() {
  refuse_other_step();
  clock_.follow(update->ntimestep, update->dt);
}

/// A cycle of the table is a number of steps: it would have another period, and its harmonics another phase.
void FixRollerHistory::refuse_other_step() const {
  if (steps_per_cycle_ == 0 || update->dt == clock_.dt()) return;
  error->all(FLERR,
             engine::error_text(fmt::format(
                 "{}: keyword cycles is '{}' steps per cycle, and the time step has changed from {:.9g} to "
                 "{:.9g} s; allowed: one time step as long as the fix is defined, or no keyword cycles",
                 history_fix, steps_per_cycle_, clock_.dt(), update->dt)));
}

void FixRollerHistory::setup_pre_force(int step) { pre_force(step); }
void FixRollerHistory::pre_force(int) {
  if (bed_) bed_->clear();
}

void FixRollerHistory::init() {
  source_ = drumlin::contact_source(lmp);
  if (source_ == nullptr) error->all(FLERR, engine::error_text(drumlin::other_pair_style(lmp, history_fix)));
  drumlin::OutputFile::check(file_name_, comm, error, world, file_keyword);
  if (steps_per_cycle_ > 0) drumlin::OutputFile::check(cycles_name_, comm, error, world, cycles_keyword);
  if (group->count(igroup) == 0)
    error->all(
        FLERR,
        engine::error_text(fmt::format(
            "fix roller/history: group is '{}', which is empty; allowed: the group of the drum's balls",
            group->names[igroup])));
  drum_.mass = group->mass(igroup);
  if (!frame_group_.empty()) {
    const int index = group->find(frame_group_.c_str());
    if (index < 0 || group->count(index) == 0)
      error->all(FLERR, engine::error_text(fmt::format("fix roller/history: keyword frame is '{}', which is "
                                                       "empty; allowed: the group of the frame's balls",
                                                       frame_group_)));
    frame_.mass = group->mass(index);
  }
  find_partners();
  for (const Fix *fix : engine::fixes(modify))
    if (steps_per_cycle_ > 0 && drumlin::changes_time_step(fix->style))
      error->all(FLERR,
                 engine::error_text(fmt::format(
                     "{}: keyword cycles is '{}' steps per cycle, and fix {} ({}) changes the time step; "
                     "allowed: one time step as long as the fix is defined, or no keyword cycles",
                     history_fix, steps_per_cycle_, fix->id, fix->style)));

  const std::array<double, 3> g = engine::gravity(modify);
  if (!has_axis_) {
    const double size = std::hypot(g[0], g[1], g[2]);
    if (size == 0.0)
      error->all(FLERR, "fix roller/history: keyword axis is missing and there is no gravity to take it "
                        "from; allowed: axis x y z");
    axis_ = {-g[0] / size, -g[1] / size, -g[2] / size};
  }
  gravity_ = -along(g.data());
  find_bodies();
}

/// The clumps of drum and frame with keyword ends.
void FixRollerHistory::find_bodies() {
  if (!sensor_) return;
  Clumps clumps;
  clumps.find(*modify);
  drum_body_ = clumps.tilting(drum_.groupbit);
  frame_body_ = clumps.tilting(frame_.groupbit);
  for (const FixClump *body : {drum_body_, frame_body_})
    if (body == nullptr || std::fabs(physics::dot(body->tilts()->rise, axis_) - 1.0) > 1e-9)
      error->all(FLERR, engine::error_text(fmt::format(
                            "{}: keyword ends is '{:.6g} m'; allowed: groups of drum and frame that a fix "
                            "clump each tilts, with axis x axle along the keyword axis of this fix",
                            history_fix, *sensor_)));
}

/// The fixes that the keywords excite, bond and travel name, and the absorbing boundaries of a bed.
void FixRollerHistory::find_partners() {
  excites_.clear();
  for (const std::string &excite : excite_ids_) {
    auto *const found = dynamic_cast<FixDrumExcite *>(engine::find_fix(modify, excite));
    if (found == nullptr || std::count(excites_.begin(), excites_.end(), found) > 0)
      error->all(FLERR, engine::error_text(fmt::format(
                            "fix roller/history: keyword excite is '{}'; allowed: the ID of a fix "
                            "drum/excite, once for each",
                            excite)));
    excites_.push_back(found);
  }
  // The acceleration of the drum follows from all forces on it.
  for (Fix *fix : engine::fixes(modify))
    if (auto *const excite = dynamic_cast<FixDrumExcite *>(fix);
        excite != nullptr && excite->igroup == igroup && !excites_.empty() &&
        std::count(excites_.begin(), excites_.end(), excite) == 0)
      error->all(FLERR, engine::error_text(fmt::format(
                            "fix roller/history: keyword excite lacks '{}', which drives the group, too; "
                            "allowed: excite ID once for each fix drum/excite of the group",
                            excite->id)));
  bonds_.clear();
  for (const std::string &bond : bond_ids_) {
    bonds_.push_back(dynamic_cast<FixBondSpring *>(engine::find_fix(modify, bond)));
    if (bonds_.back() == nullptr)
      error->all(FLERR, engine::error_text(fmt::format(
                            "fix roller/history: keyword bond is '{}'; allowed: the ID of a fix bond/spring",
                            bond)));
  }
  travel_ = dynamic_cast<FixDrumTravel *>(engine::find_fix(modify, travel_id_));
  if (!travel_id_.empty() && travel_ == nullptr)
    error->all(FLERR, engine::error_text(fmt::format(
                          "fix roller/history: keyword travel is '{}'; allowed: the ID of a fix drum/travel",
                          travel_id_)));
  ground_.clear();
  if (!bed_) return;
  for (const Fix *fix : engine::fixes(modify))
    if (const auto *boundary = dynamic_cast<const FixBoundaryAbsorb *>(fix)) ground_.push_back(boundary);
}

/// Whether the contacts of a bed have a law that remembers, and may yield.
bool FixRollerHistory::yields() const {
  return bed_ && source_ != nullptr && source_->places()[drumlin::Remembered::memory] >= 0;
}

double FixRollerHistory::along(const double *vector) const {
  return vector[0] * axis_[0] + vector[1] * axis_[1] + vector[2] * axis_[2];
}

void FixRollerHistory::setup(int) {
  const bool first = !clock_.running();
  if (!first) refuse_other_step();
  clock_.set_up(update->ntimestep, update->dt);
  open_files();
  pairs_outdated_ = true;
  evaluate();
  if (first) {
    if (bed_) set_reference();
    cycle_.number = -1.0;
    cycle_.begin_next(state_);
    if (steps_per_cycle_ > 0) write_cycle(); // the row of cycle 0: the energies at the start
    cycle_.begin_next(state_);
  }
  if (last_sample_ != update->ntimestep && update->ntimestep % every_ == 0) write_sample();
}

/// Opens the files at the first set-up, with their header lines.
void FixRollerHistory::open_files() {
  if (!file_) {
    file_.emplace(file_name_, append_.value_or(drumlin::engine::continues(lmp)));
    file_->open(comm, error, world, file_keyword,
                drumlin::history_header(frame_.groupbit != 0, bed_.has_value(), travel_ != nullptr,
                                        sensor_.has_value())
                    .c_str());
  }
  if (steps_per_cycle_ > 0 && !cycles_file_) {
    cycles_file_.emplace(cycles_name_, append_.value_or(drumlin::engine::continues(lmp)));
    cycles_file_->open(
        comm, error, world, cycles_keyword,
        drumlin::cycles_header(bed_.has_value(), !ground_.empty(), yields(), travel_ != nullptr).c_str());
  }
}

void FixRollerHistory::set_reference() {
  const drumlin::BallSums balls = bed_->balls(axis_, reference_.window_top);
  if (balls.soil_balls == 0.0)
    error->all(
        FLERR,
        "fix roller/history: keyword soil is a group that is empty; allowed: the group of the soil balls");
  reference_ = {balls.height, bed_contacts_.tangential_stored, balls.soil_height / balls.soil_mass};
}

void FixRollerHistory::pre_neighbor() { pairs_outdated_ = true; }

void FixRollerHistory::evaluate() {
  if (comm->nprocs > 1 || atom->nghost > 0) engine::forward_comm(comm, this);
  if (pairs_outdated_) contacts_.list_pairs(*source_, drum_.groupbit, frame_.groupbit);
  pairs_outdated_ = false;
  state_.time = clock_.time(update->ntimestep);
  drum_.locate(lmp, axis_, "drum", 0.0, state_.drum);
  if (frame_.groupbit != 0)
    frame_.locate(lmp, axis_, "frame", !bonds_.empty() && !frame_.has_origin ? bonds_[0]->stretch() : 0.0,
                  state_.frame);
  const physics::TiltAxes *axes = nullptr;
  double middle = 0.0;
  if (sensor_) {
    follow_tilt();
    axes = &*drum_body_->tilts();
    middle = 1e-9 * std::sqrt(drum_inertia_ / drum_.mass);
  }
  const drumlin::DrumContactSums contacts = contacts_.sums(axis_, axes, centre_, middle);
  drumlin::RollerForces &forces = state_.forces;
  forces = {};
  forces.contact = contacts.force;
  forces.contact_dissipated = contacts.dissipated;
  forces.contact_missed = contacts.missed_heat;
  forces.contact_stored = contacts.stored;
  forces.in_contact = contacts.in_contact;
  forces.left = contacts.left;
  forces.right = contacts.right;
  add_forces_of_partners(contacts.moment);
  if (!bed_) return;
  bed_contacts_ = bed_->contacts(axis_);
  forces.contact_dissipated = bed_contacts_.normal_heat;
  forces.contact_missed = bed_contacts_.missed_heat;
  forces.tangential_missed = bed_contacts_.missed_work;
  forces.contact_stored = bed_contacts_.normal_stored + bed_contacts_.tangential_stored;
  forces.tangential_power = bed_contacts_.tangential_power;
  add_ground();
}

/// Takes the tilt angles, their rates and the moments of inertia of drum and frame from their clumps.
/// Collective.
void FixRollerHistory::follow_tilt() {
  const physics::AxleSums drum = drum_body_->axle_sums(), frame = frame_body_->axle_sums();
  drum_inertia_ = drum.inertia();
  frame_inertia_ = frame.inertia();
  centre_ = drum.centre();
  state_.drum.tilt = drum.tilt();
  state_.drum.rate = drum.rate();
  state_.frame.tilt = frame.tilt();
  state_.frame.rate = frame.rate();
}

/// Energies and forces of the absorbing boundaries. Collective.
void FixRollerHistory::add_ground() {
  for (const FixBoundaryAbsorb *boundary : ground_) {
    const FixBoundaryAbsorb::Totals now = boundary->totals();
    state_.forces.ground_stored += now.stored - now.work;
    state_.forces.ground_heat += now.heat;
    bed_contacts_.add_wall(axis_, boundary->normal(), now.force);
  }
}

/// Adds the forces of exciter and bonds, and computes the accelerations of drum and frame from all forces.
/// \param moment of the contact forces about the centre of a drum that tilts, N m
void FixRollerHistory::add_forces_of_partners(double moment) {
  drumlin::RollerForces &forces = state_.forces;
  double drum_force = forces.contact;
  for (FixDrumExcite *one : excites_) {
    forces.excitation += one->compute_scalar();
    double upwards = 0.0; // component of the excitation along the axis
    for (int a = 0; a < 3; ++a)
      upwards += one->compute_vector(a) * axis_[static_cast<std::size_t>(a)];
    drum_force += upwards;
    forces.excitation_power += upwards * (state_.drum.v + one->place() * state_.drum.rate);
    moment += upwards * one->place();
  }
  for (FixBondSpring *one : bonds_) {
    const physics::BondForce bond = one->evaluate();
    forces.bond += bond.force;
    forces.bond_dissipated += bond.dissipated;
    forces.bond_released += bond.released;
    forces.bond_stored += bond.stored;
    if (sensor_) moment += (one->place(drum_body_->tilts()->axle) - centre_) * bond.force;
  }
  if (!bonds_.empty()) {
    drum_force += forces.bond; // the frame is above the drum: tension lifts the drum
    if (frame_.mass > 0.0) state_.frame.a = -forces.bond / frame_.mass - gravity_;
  }
  state_.drum.a = drum_force / drum_.mass - gravity_;
  if (sensor_) state_.drum.acceleration = moment / drum_inertia_;
}

void FixRollerHistory::end_of_step() {
  const drumlin::RollerState before = state_;
  evaluate();
  yield_heat_ += bed_contacts_.yield_heat;
  if (steps_per_cycle_ > 0) {
    cycle_.add_step(before, state_, clock_.dt(), steps_per_cycle_);
    if (static_cast<int>(cycle_.steps) == steps_per_cycle_) {
      write_cycle();
      cycle_.begin_next(state_);
      flush();
    }
  }
  if (update->ntimestep % every_ == 0) write_sample();
}

/// The bed at the last evaluated step; nothing if the fix has no bed. Collective.
std::optional<drumlin::BedSample> FixRollerHistory::bed_sample() const {
  if (!bed_) return {};
  drumlin::BedSample sample;
  sample.contacts = bed_contacts_;
  sample.balls = bed_->balls(axis_, reference_.window_top);
  sample.void_ratio = bed_->void_ratio(axis_, reference_.window_top, sample.balls.solid);
  sample.raised = sample.balls.height - reference_.height;
  sample.absorbs = !ground_.empty();
  sample.yields = yields();
  sample.yield_heat = yield_heat_;
  sample.friction_heat =
      cycle_.tangential_work - (bed_contacts_.tangential_stored - reference_.tangential_stored);
  return sample;
}

void FixRollerHistory::write_sample() {
  last_sample_ = update->ntimestep;
  const std::optional<drumlin::BedSample> bed = bed_sample();
  std::vector<double> row =
      drumlin::history_row(state_, cycle_, masses(), frame_.groupbit != 0, bed ? &*bed : nullptr);
  if (travel_ != nullptr) {
    row.insert(row.end(), {travel_->state().place, static_cast<double>(travel_->state().pass)});
    const std::array<double, 4> drive = travel_->drive();
    if (bed) row.insert(row.end(), drive.begin(), drive.end());
  }
  if (sensor_) {
    const std::vector<double> ends = drumlin::tilts_of(state_, *sensor_);
    row.insert(row.end(), ends.begin(), ends.end());
  }
  drumlin::write_row(file_->get(), row);
}

void FixRollerHistory::write_cycle() {
  const std::optional<drumlin::BedSample> bed = bed_sample();
  std::vector<double> row = drumlin::cycles_row(state_, cycle_, masses(), bed ? &*bed : nullptr);
  if (travel_ != nullptr) row.push_back(travel_->work());
  drumlin::write_row(cycles_file_->get(), row);
}

/// Called once a cycle and at the end of a run, so that a full disk ends the run soon and readers of the
/// files see whole cycles.
void FixRollerHistory::flush() {
  file_->flush(error, world, file_keyword);
  if (cycles_file_) cycles_file_->flush(error, world, cycles_keyword);
}

void FixRollerHistory::post_run() { flush(); }

void FixRollerHistory::see_heat(int i, int j, double normal, double tangential) {
  if (bed_)
    bed_->add_heat(i, j, normal, tangential);
  else
    contacts_.add_heat(i, j, normal);
}

void FixRollerHistory::pack_ghosts(int n, const int *list, double *buf) {
  drumlin::pack_motion(*atom, n, list, buf, velocity_of_ghosts());
}

void FixRollerHistory::unpack_ghosts(int n, int first, double *buf) {
  drumlin::unpack_motion(*atom, n, first, buf);
}

void FixRollerHistory::write_restart(FILE *file) {
  const auto clock = clock_.state();
  std::vector<double> state(clock.begin(), clock.end());
  state.push_back(drum_.origin);
  state.push_back(frame_.origin);
  state.push_back(static_cast<double>(last_sample_) + (yields() ? with_yield_heat : 0.0));
  const auto append = [&state](const auto &numbers) {
    const auto *first = reinterpret_cast<const double *>(&numbers);
    state.insert(state.end(), first, first + sizeof(numbers) / sizeof(double));
  };
  append(cycle_);
  append(reference_);
  if (yields()) state.push_back(yield_heat_);
  drumlin::write_restart_record(file, comm->me, state);
}

void FixRollerHistory::restart(char *buffer) {
  const double *state = reinterpret_cast<const double *>(buffer);
  clock_.restore(state);
  drum_.origin = state[3];
  frame_.origin = state[4];
  drum_.has_origin = frame_.has_origin = true;
  last_sample_ = static_cast<bigint>(std::floor(state[5]));
  const bool yielded = state[5] == static_cast<double>(last_sample_) + with_yield_heat;
  state += 6;
  constexpr std::size_t cycle_numbers = sizeof(cycle_) / sizeof(double);
  std::copy_n(state, cycle_numbers, reinterpret_cast<double *>(&cycle_));
  constexpr std::size_t reference_numbers = sizeof(Reference) / sizeof(double);
  std::copy_n(state + cycle_numbers, reference_numbers, reinterpret_cast<double *>(&reference_));
  if (yielded) yield_heat_ = state[cycle_numbers + reference_numbers];
}

double FixRollerHistory::compute_vector(int n) {
  if (n == 0) return clock_.time(update->ntimestep);
  return drumlin::history_row(state_, cycle_, masses(), true, nullptr)[static_cast<std::size_t>(n)];
}
