#include "fixes/fix_contact_local.h"

#include "support/arguments.h"
#include "contact/contact_source.h"

using namespace LAMMPS_NS;
namespace engine = drumlin::engine;

namespace {

constexpr const char *local_fix = "fix contact/local";

} // namespace

FixContactLocal::FixContactLocal(LAMMPS *lammps, int narg, char **arg) : Fix(lammps, narg, arg) {
  drumlin::Arguments in(error, local_fix, narg - 3, arg + 3);
  in.choice("keyword", {"every"});
  nevery = static_cast<int>(in.integer("keyword every", 1, std::numeric_limits<int>::max()));
  in.expect_end("every N");
  local_flag = 1;
  // LIGGGHTS's compute reduce and fix ave/histo divide by the other two intervals even if a fix has local
  // data only: they must not be 0.
  local_freq = peratom_freq = global_freq = nevery;
  size_local_cols = numbers;
  size_local_rows = 0;
}

int FixContactLocal::setmask() { return FixConst::PRE_FORCE | FixConst::END_OF_STEP; }

void FixContactLocal::init() {
  if (drumlin::contact_source(lmp) == nullptr)
    error->all(FLERR, engine::error_text(drumlin::other_pair_style(lmp, local_fix)));
}

void FixContactLocal::setup_pre_force(int vflag) { pre_force(vflag); }

void FixContactLocal::setup(int) {
  if (observing()) make_rows();
}

void FixContactLocal::pre_force(int) {
  records_.clear();
  observe(update->ntimestep % nevery == 0);
}

void FixContactLocal::end_of_step() { make_rows(); }

void FixContactLocal::make_rows() {
  rows_.clear();
  for (const drumlin::ContactRecord &record : records_) {
    const bool wall = record.j < 0;
    if (!(atom->mask[record.i] & groupbit) && (wall || !(atom->mask[record.j] & groupbit))) continue;
    if (!wall && !engine::owns_pair(lmp, record.i, record.j)) continue;
    const double normal = record.final_normal_force();
    const auto &n = record.normal;
    const auto t = record.final_tangential_force();
    rows_.push_back({static_cast<double>(atom->tag[record.i]),
                     wall ? 0.0 : static_cast<double>(atom->tag[record.j]), normal * n[0] + t[0],
                     normal * n[1] + t[1], normal * n[2] + t[2], n[0], n[1], n[2], record.overlap});
  }
  records_.clear();
  observe(false);
  row_pointers_.clear();
  for (Row &row : rows_)
    row_pointers_.push_back(row.data());
  array_local = row_pointers_.data();
  size_local_rows = static_cast<int>(rows_.size());
}

double FixContactLocal::memory_usage() {
  return static_cast<double>(rows_.capacity() * sizeof(Row) + row_pointers_.capacity() * sizeof(double *));
}
