#include "fixes/fix_stepping.h"

#include <algorithm>
#include <string>

using namespace LAMMPS_NS;

namespace {

constexpr const char *helper_id = "drumlin_stepping";
constexpr int columns = 5;
constexpr int shared_columns = 4; // what ghosts need

} // namespace

FixStepping *FixStepping::find(LAMMPS *lammps) {
  return static_cast<FixStepping *>(drumlin::engine::find_fix(lammps->modify, helper_id));
}

FixStepping *FixStepping::provide(LAMMPS *lammps) {
  if (find(lammps) == nullptr) {
    std::string words[] = {helper_id, "all", "drumlin/stepping"};
    char *arg[] = {words[0].data(), words[1].data(), words[2].data()};
    lammps->modify->add_fix(3, arg);
  }
  return find(lammps);
}

FixStepping::FixStepping(LAMMPS *lammps, int narg, char **arg) : Fix(lammps, narg, arg) {
  nevery = 1;
  comm_forward = shared_columns;
  FixStepping::grow_arrays(atom->nmax);
  atom->add_callback(0);
  for (int i = 0; i < atom->nlocal; ++i)
    std::fill_n(state_[i], columns, 0.0);
}

FixStepping::~FixStepping() {
  atom->delete_callback(id, 0);
  memory->destroy(state_);
}

int FixStepping::setmask() { return FixConst::POST_INTEGRATE | FixConst::PRE_FORCE | FixConst::END_OF_STEP; }

void FixStepping::init() {
  constraints_.clear();
  for (int n = 0; n < modify->nfix; ++n)
    for (const char *name : {"setforce", "freeze", "lineforce", "planeforce", "aveforce"})
      if (std::string(modify->fix[n]->style) == name) constraints_.push_back(modify->fix[n]);
}

void FixStepping::setup_pre_force(int) {
  later_.clear();
  shifts_.clear();
  for (int i = 0; i < atom->nlocal; ++i) {
    std::copy_n(atom->v[i], 3, state_[i]);
    state_[i][3] = state_[i][4] = 0.0;
  }
}

void FixStepping::post_integrate() {
  for (const Later &item : shifts_) {
    double *v = atom->v[item.i];
    const double *before = state_[item.i];
    if (v[0] == before[0] && v[1] == before[1] && v[2] == before[2])
      continue; // not integrated: it took no kick
    for (std::size_t a = 0; a < 3; ++a)
      v[a] -= 0.5 * update->dt * item.shift[a] / atom->rmass[item.i];
  }
  shifts_.clear();
  for (int i = 0; i < atom->nlocal; ++i) {
    state_[i][3] = state_[i][4];
    state_[i][4] = 0.0;
  }
}

void FixStepping::pre_force(int) {
  if (comm->nprocs > 1 || atom->nghost > 0) drumlin::engine::forward_comm(comm, this);
}

void FixStepping::end_of_step() {
  for (int i = 0; i < atom->nlocal; ++i)
    std::copy_n(atom->v[i], 3, state_[i]);
  double **f = atom->f;
  for (const Later &item : later_)
    for (std::size_t a = 0; a < 3; ++a)
      f[item.i][a] += item.rest[a];
  constrain(!later_.empty());
  // What the constraints leave of a shift is the difference that it makes to the constrained force.
  shifts_.swap(later_);
  later_.clear();
  for (Later &item : shifts_)
    for (std::size_t a = 0; a < 3; ++a) {
      item.rest[a] = f[item.i][a];
      f[item.i][a] += item.shift[a];
    }
  constrain(!shifts_.empty());
  for (Later &item : shifts_)
    for (std::size_t a = 0; a < 3; ++a)
      item.shift[a] = f[item.i][a] - item.rest[a];
}

/// Constraints are projections: acting again on what has passed them changes nothing else.
void FixStepping::constrain(bool any) const {
  for (Fix *constraint : constraints_) // aveforce sums over the ranks, which must all call it
    if (any || std::string(constraint->style) == "aveforce") constraint->post_force(0);
}

void FixStepping::grow_arrays(int nmax) { memory->grow(state_, nmax, columns, "drumlin/stepping:state"); }

void FixStepping::copy_arrays(int i, int j, int) { std::copy_n(state_[i], columns, state_[j]); }

int FixStepping::pack_exchange(int i, double *buf) {
  std::copy_n(state_[i], columns, buf);
  return columns;
}

int FixStepping::unpack_exchange(int i, double *buf) {
  std::copy_n(buf, columns, state_[i]);
  return columns;
}

int FixStepping::pack_comm(int n, int *list, double *buf, int, int *) {
  for (int m = 0; m < n; ++m)
    buf = std::copy_n(state_[list[m]], shared_columns, buf);
  return comm_forward;
}

void FixStepping::unpack_comm(int n, int first, double *buf) {
  for (int i = first; i < first + n; ++i, buf += shared_columns)
    std::copy_n(buf, shared_columns, state_[i]);
}

double FixStepping::memory_usage() { return static_cast<double>(atom->nmax) * columns * sizeof(double); }
