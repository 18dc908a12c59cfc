#include "fixes/fix_stepping.h"

#include <algorithm>
#include <string>

using namespace LAMMPS_NS;

namespace {

constexpr const char *helper_id = "drumlin_stepping";
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
    FixStepping::set_arrays(i);
}

FixStepping::~FixStepping() {
  atom->delete_callback(id, 0);
  memory->destroy(state_);
}

int FixStepping::setmask() {
  return FixConst::POST_INTEGRATE | FixConst::PRE_FORCE | FixConst::PRE_FINAL_INTEGRATE |
         FixConst::END_OF_STEP;
}

void FixStepping::init() {
  constraints_.clear();
  for (int n = 0; n < modify->nfix; ++n)
    for (const char *name : {"setforce", "freeze", "lineforce", "planeforce", "aveforce"})
      if (std::string(modify->fix[n]->style) == name)
        constraints_.push_back({modify->fix[n], drumlin::engine::reaction(modify->fix[n])});
}

void FixStepping::setup_pre_force(int) {
  coupled_.clear();
  coupled_links_.clear();
  later_.clear();
  shifts_.clear();
  for (int i = 0; i < atom->nlocal; ++i) {
    set_arrays(i);
    std::copy_n(atom->v[i], 3, state_[i]);
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
    state_[i][3] = state_[i][4] * state_[i][5];
    state_[i][4] = 0.0;
  }
}

void FixStepping::pre_force(int) {
  if (comm->nprocs > 1 || atom->nghost > 0) drumlin::engine::forward_comm(comm, this);
}

void FixStepping::pre_final_integrate() {
  int any = coupled_.empty() && coupled_links_.empty() ? 0 : 1;
  if (comm->nprocs > 1) {
    const int mine = any;
    MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  }
  if (any == 0) return;

  double **f = atom->f;
  const int nlocal = atom->nlocal;
  for (int i = 0; i < nlocal; ++i) {
    const double *v = atom->v[i];
    double *star = state_[i]; // in the place of v(t), which this step needs no more
    const bool rests = v[0] == star[0] && v[1] == star[1] && v[2] == star[2]; // forces do not move it
    const double kick = rests ? 0.0 : 0.5 * update->dt / atom->rmass[i];
    for (std::size_t a = 0; a < 3; ++a)
      star[a] = v[a] + kick * f[i][a];
  }
  if (comm->nprocs > 1 || atom->nghost > 0) drumlin::engine::forward_comm(comm, this);
  for (const Coupled &p : coupled_) {
    const auto along = [&](int ball) {
      const double *v = state_[ball];
      return v[0] * p.normal[0] + v[1] * p.normal[1] + v[2] * p.normal[2];
    };
    const double rate = (p.j < 0 ? 0.0 : along(p.j)) - along(p.i);
    const double acting = drumlin::physics::coupled_force(p.dashpot, rate);
    const double change = p.share * (acting - p.dashpot.first);
    add_force(p.i, change, p.normal);
    if (p.j >= 0 && p.j < nlocal) add_force(p.j, -change, p.normal);
    *p.force = acting;
  }
  coupled_.clear();
  for (const std::function<void()> &close : coupled_links_)
    close();
  coupled_links_.clear();
  constrain(true);
}

/// One entry per ball: constraints act on its forces as a whole, and what is taken back later is the difference that all
/// its shifts together make.
void FixStepping::merge_later() {
  std::stable_sort(later_.begin(), later_.end(), [](const Later &a, const Later &b) { return a.i < b.i; });
  std::size_t kept = 0;
  for (const Later &item : later_)
    if (kept > 0 && later_[kept - 1].i == item.i)
      for (std::size_t a = 0; a < 3; ++a) {
        later_[kept - 1].rest[a] += item.rest[a];
        later_[kept - 1].shift[a] += item.shift[a];
      }
    else
      later_[kept++] = item;
  later_.resize(kept);
}

void FixStepping::end_of_step() {
  merge_later();
  for (int i = 0; i < atom->nlocal; ++i)
    std::copy_n(atom->v[i], 3, state_[i]);
  double **f = atom->f;
  for (const Later &item : later_)
    add_force(item.i, 1.0, item.rest);
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

void FixStepping::add_force(int i, double factor, const std::array<double, 3> &vector) {
  for (std::size_t a = 0; a < 3; ++a)
    atom->f[i][a] += factor * vector[a];
  for (const Constraint &constraint : constraints_)
    if (constraint.reaction != nullptr && (atom->mask[i] & constraint.fix->groupbit))
      for (std::size_t a = 0; a < 3; ++a)
        constraint.reaction[a] += factor * vector[a];
}

/// Constraints are projections: acting again on what has passed them changes nothing else. But they would say that they took
/// what they find now.
void FixStepping::constrain(bool any) const {
  for (const Constraint &constraint : constraints_) {
    // aveforce sums over the ranks, which must all call it
    if (!any && std::string(constraint.fix->style) != "aveforce") continue;
    std::array<double, 3> taken{};
    if (constraint.reaction != nullptr) std::copy_n(constraint.reaction, 3, taken.begin());
    constraint.fix->post_force(0);
    if (constraint.reaction != nullptr) std::copy_n(taken.begin(), 3, constraint.reaction);
  }
}

void FixStepping::grow_arrays(int nmax) { memory->grow(state_, nmax, columns, "drumlin/stepping:state"); }

void FixStepping::copy_arrays(int i, int j, int) { std::copy_n(state_[i], columns, state_[j]); }

/// A ball that is new: its mass is not known yet.
void FixStepping::set_arrays(int i) {
  std::fill_n(state_[i], columns, 0.0);
  state_[i][5] = -1.0;
}

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
  return shared_columns;
}

void FixStepping::unpack_comm(int n, int begin, double *buf) {
  for (int i = begin; i < begin + n; ++i, buf += shared_columns)
    std::copy_n(buf, shared_columns, state_[i]);
}

double FixStepping::memory_usage() { return static_cast<double>(atom->nmax) * columns * sizeof(double); }
