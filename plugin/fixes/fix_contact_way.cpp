#include "fixes/fix_contact_way.h"

#include "contact/contact_source.h"
#include "fixes/fix_drum_travel.h"
#include "support/arguments.h"
#include "support/restart_record.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <stdexcept>

using namespace LAMMPS_NS;
namespace engine = drumlin::engine;
namespace physics = drumlin::physics;
using drumlin::WayRow;

namespace {

constexpr const char *way_fix = "fix contact/way";

} // namespace

FixContactWay::FixContactWay(LAMMPS *lammps, int narg, char **arg) : Fix(lammps, narg, arg) {
  vector_flag = 1;
  size_vector = 3;
  extvector = 0;
  global_freq = nevery = 1;
  restart_global = 1;
  time_depend = 1; // work is a sum over the steps
  drumlin::Arguments in(error, way_fix, narg - 3, arg + 3);
  bool between = false;
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "file") {
      file_ = in.word("keyword file", "a file with the columns " + std::string(drumlin::way_file::header));
    } else if (keyword == "travel") {
      travel_id_ = in.word("keyword travel", "the ID of a fix drum/travel");
    } else if (keyword == "between") {
      between = true;
      for (int &number : groups_)
        number = in.group("keyword between", group);
    } else {
      in.fail("keyword", keyword, "file, travel or between");
    }
  }
  if (file_.empty()) in.fail("keyword file is missing; allowed: file NAME travel ID between GROUP GROUP");
  if (travel_id_.empty()) in.fail("keyword travel is missing; allowed: the ID of a fix drum/travel");
  if (!between) in.fail("keyword between is missing; allowed: the groups of soil and drum");
  for (std::size_t n = 0; n < 2; ++n)
    bits_[n] = engine::group_bit(groups_[n]);
  read(file_);
  observe(true);
}

/// Rank 0 reads the file, and the others get its rows: only one rank needs to see it.
void FixContactWay::read(const std::string &file) {
  std::string fault;
  if (comm->me == 0) try {
      way_ = drumlin::read_way(file);
    } catch (const std::invalid_argument &wrong) {
      fault = wrong.what();
    }
  engine::stop_on_fault(lmp, way_fix, fault);
  auto rows = static_cast<int>(way_.size());
  MPI_Bcast(&rows, 1, MPI_INT, 0, world);
  way_.resize(static_cast<std::size_t>(rows));
  constexpr int numbers = sizeof(WayRow) / sizeof(double);
  MPI_Bcast(way_.data(), numbers * rows, MPI_DOUBLE, 0, world);
}

int FixContactWay::setmask() {
  return FixConst::POST_INTEGRATE | FixConst::PRE_FORCE | FixConst::END_OF_STEP | FixConst::POST_RUN;
}

void FixContactWay::init() {
  source_ = drumlin::contact_source(lmp);
  const auto *table = source_ == nullptr ? nullptr : source_->linear_table();
  if (table == nullptr)
    refuse(fmt::format("pair_style is '{}'; allowed: {}{}",
                       force->pair_style != nullptr ? force->pair_style : "none",
                       engine::pair_style_before_law, physics::LinearContact::name));
  for (std::size_t n = 0; n < 2; ++n)
    types_[n] = type_of(groups_[n]);
  // After a run that has not ended well the table may still have what this fix has given.
  if (const Coefficients &present = table->at(types_[0], types_[1]);
      !given_ || present.contact.stiffness != now_.k || present.contact.damping != now_.D)
    of_deck_ = present;
  if (of_deck_.contact.damping_kind != physics::Damping::ratio)
    refuse("damping of the pair style is 'coefficient'; allowed: ratio, which the file has");
  travel_ = dynamic_cast<FixDrumTravel *>(engine::find_fix(modify, travel_id_));
  if (travel_ == nullptr)
    refuse(fmt::format("keyword travel is '{}'; allowed: the ID of a fix drum/travel", travel_id_));
  const auto [least, most] = std::minmax(travel_->travel().from, travel_->travel().to);
  if (least < way_.front().s || most > way_.back().s)
    refuse(fmt::format("way of '{}' is '{:.9g} to {:.9g} m'; allowed: one that has the places {:.9g} to "
                       "{:.9g} m of fix {}",
                       file_, way_.front().s, way_.back().s, least, most, travel_id_));
}

void FixContactWay::refuse(const std::string &fault) const {
  error->all(FLERR, engine::error_text(std::string(way_fix) + ": " + fault));
  std::abort(); // not reached: error->all() ends the process
}

/// The type of the balls of a group, which no other ball may have: coefficients belong to pairs of types.
/// Collective.
int FixContactWay::type_of(int group_number) const {
  const int bit = engine::group_bit(group_number);
  std::array<int, 2> ends{0, -atom->ntypes - 1}; // the highest type, and the negative of the lowest
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & bit) ends = {std::max(ends[0], atom->type[i]), std::max(ends[1], -atom->type[i])};
  MPI_Allreduce(MPI_IN_PLACE, ends.data(), 2, MPI_INT, MPI_MAX, world);
  int others = 0;
  for (int i = 0; i < atom->nlocal; ++i)
    others += !(atom->mask[i] & bit) && atom->type[i] == ends[0] ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &others, 1, MPI_INT, MPI_SUM, world);
  if (ends[0] == 0 || ends[0] != -ends[1] || others > 0)
    refuse(fmt::format("keyword between is '{}', a group {}; allowed: all balls of one type",
                       group->names[group_number],
                       ends[0] == 0          ? "without balls"
                       : ends[0] != -ends[1] ? "of several types"
                                             : "whose type other balls have, too"));
  return ends[0];
}

bool FixContactWay::drives_forth() const {
  const physics::Travel &travel = travel_->travel();
  return (travel.to > travel.from) == (travel.one_way || travel_->state().pass % 2 == 1);
}

/// The soil at a place. At a step it is that ahead. \param forth whether the roller drives to greater places
FixContactWay::Soil FixContactWay::soil_at(double place, bool forth) const {
  const auto behind = [](const WayRow &row, double s) { return row.s < s; };
  const auto ahead = [](double s, const WayRow &row) { return s < row.s; };
  // The first row that is beyond the place, or, on the way back, not before it.
  auto right = forth ? std::upper_bound(way_.begin(), way_.end(), place, ahead)
                     : std::lower_bound(way_.begin(), way_.end(), place, behind);
  if (right == way_.begin()) return {right->k, right->D};
  if (right == way_.end()) return {way_.back().k, way_.back().D};
  const WayRow &a = *(right - 1), &b = *right;
  const double share = (place - a.s) / (b.s - a.s);
  return {a.k + share * (b.k - a.k), a.D + share * (b.D - a.D)};
}

/// The steps of the soil that the roller has crossed since the start of the time step. Several ones act like
/// one between them.
FixContactWay::Jump FixContactWay::jump_since(double place_before, int pass_before,
                                              const Soil &before) const {
  const physics::TravelState &state = travel_->state();
  Jump jump;
  if (travel_->travel().one_way && state.pass != pass_before) { // back to the start of the way
    jump = {now_.k - before.k, now_.D - before.D, std::min(1.0, travel_->time_in_pass() / update->dt), true};
    return jump;
  }
  const double place = state.place;
  const auto behind = [](const WayRow &row, double s) { return row.s < s; };
  const auto ahead = [](double s, const WayRow &row) { return s < row.s; };
  const bool forth = place > place_before;
  if (place == place_before) return jump;
  // Rows behind the place before and up to the present one.
  const auto first = forth ? std::upper_bound(way_.begin(), way_.end(), place_before, ahead)
                           : std::lower_bound(way_.begin(), way_.end(), place, behind);
  const auto last = forth ? std::upper_bound(way_.begin(), way_.end(), place, ahead)
                          : std::lower_bound(way_.begin(), way_.end(), place_before, behind);
  double weight = 0.0, weighted = 0.0;
  for (auto row = first; row != last; ++row) {
    const auto next = row + 1;
    if (next == way_.end() || next->s != row->s) continue;
    const double sign = forth ? 1.0 : -1.0, share = (place - row->s) / (place - place_before);
    jump.k += sign * (next->k - row->k);
    jump.D += sign * (next->D - row->D);
    const double size = std::fabs(next->k - row->k) / row->k + std::fabs(next->D - row->D);
    weight += size;
    weighted += size * share;
  }
  jump.any = weight > 0.0;
  if (jump.any) jump.share = weighted / weight;
  return jump;
}

void FixContactWay::give(const Soil &soil, const Jump &jump) {
  auto *table = source_->linear_table();
  Coefficients coefficients = of_deck_;
  coefficients.contact.stiffness = soil.k;
  coefficients.contact.damping = soil.D;
  coefficients.jumps = jump.any;
  coefficients.share_after = jump.share;
  coefficients.contact_before = coefficients.contact;
  coefficients.contact_before.stiffness = soil.k - jump.k;
  coefficients.contact_before.damping = std::max(0.0, soil.D - jump.D);
  table->at(types_[0], types_[1]) = table->at(types_[1], types_[0]) = coefficients;
  source_->note_change();
  given_ = true;
}

void FixContactWay::setup_pre_force(int step) {
  const physics::TravelState &state = travel_->state();
  now_ = soil_at(state.place, drives_forth());
  place_ = state.place;
  pass_ = state.pass;
  jump_ = {};
  give(now_, jump_);
  pre_force(step);
}

void FixContactWay::setup(int) { squares_ = sum_of_squares(); }

void FixContactWay::post_integrate() {
  const physics::TravelState &state = travel_->state();
  before_ = now_;
  now_ = soil_at(state.place, drives_forth());
  jump_ = jump_since(place_, pass_, before_);
  place_ = state.place;
  pass_ = state.pass;
  give(now_, jump_);
}

void FixContactWay::pre_force(int) { seen_ = 0.0; }

void FixContactWay::see_contact(const drumlin::ContactRecord &record) {
  if (record.j < 0) return;
  const int a = atom->mask[record.i], b = atom->mask[record.j];
  if (!((a & bits_[0]) && (b & bits_[1])) && !((a & bits_[1]) && (b & bits_[0]))) return;
  if (engine::owns_pair(lmp, record.i, record.j)) seen_ += record.overlap * record.overlap;
}

/// Collective.
double FixContactWay::sum_of_squares() const {
  double all = seen_;
  if (comm->nprocs > 1) MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

/// The springs of the contacts store k d^2/2: what a change of k at the overlap d adds is work of the drive.
void FixContactWay::end_of_step() {
  const double before = squares_;
  squares_ = sum_of_squares();
  const double smooth = now_.k - before_.k - jump_.k;
  const double at_jump = before + (1.0 - jump_.share) * (squares_ - before);
  const double work = 0.5 * (smooth * 0.5 * (before + squares_) + jump_.k * at_jump);
  work_ += work;
  travel_->add_work(work);
}

/// Between runs the contacts have the deck's coefficients.
void FixContactWay::post_run() {
  if (!given_) return;
  auto *table = source_->linear_table();
  table->at(types_[0], types_[1]) = table->at(types_[1], types_[0]) = of_deck_;
  source_->note_change();
  given_ = false;
}

void FixContactWay::write_restart(FILE *file) { drumlin::write_restart_record(file, comm->me, {work_}); }
void FixContactWay::restart(char *buffer) { work_ = *reinterpret_cast<const double *>(buffer); }

double FixContactWay::compute_vector(int n) {
  const std::array<double, 3> values{now_.k, now_.D, work_};
  return values[static_cast<std::size_t>(n)];
}
