#include "contact/fix_between_runs.h"

#include "contact/contact_source.h"
#include "contact/fix_stepping.h"
#include "support/restart_record.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

using namespace LAMMPS_NS;
namespace engine = drumlin::engine;
namespace physics = drumlin::physics;

namespace {

constexpr const char *between_runs_id = "drumlin_between_runs";

/// A number that differs if any of the numbers added differs in a bit (FNV-1a). It is exact as a double.
class Fingerprint {
public:
  void add(double number) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &number, sizeof bits);
    for (int byte = 0; byte < 8; ++byte, bits >>= 8)
      sum_ = (sum_ ^ (bits & 255)) * 1099511628211ULL;
  }
  void add(const double *vector) {
    std::for_each(vector, vector + 3, [this](double a) { add(a); });
  }
  double value() const { return static_cast<double>(sum_ >> 12 | 1); }

private:
  std::uint64_t sum_ = 14695981039346656037ULL;
};

} // namespace

FixBetweenRuns *FixBetweenRuns::find(LAMMPS *lammps) {
  return lammps->modify == nullptr
             ? nullptr
             : dynamic_cast<FixBetweenRuns *>(engine::find_fix(lammps->modify, between_runs_id));
}

FixBetweenRuns *FixBetweenRuns::provide(LAMMPS *lammps) {
  if (FixBetweenRuns *fix = find(lammps)) return fix;
  std::string words[] = {between_runs_id, "all", style_name};
  char *arg[] = {words[0].data(), words[1].data(), words[2].data()};
  lammps->modify->add_fix(3, arg);
  return find(lammps);
}

FixBetweenRuns::FixBetweenRuns(LAMMPS *lammps, int narg, char **arg) : GhostFix(lammps, narg, arg) {
  restart_global = restart_peratom = create_attribute = 1;
  comm_forward = 7;
  FixBetweenRuns::grow_arrays(atom->nmax);
  atom->add_callback(0); // atoms that move in memory or to another rank
  atom->add_callback(1); // restart files
}

FixBetweenRuns::~FixBetweenRuns() {
  atom->delete_callback(id, 0);
  atom->delete_callback(id, 1);
}

int FixBetweenRuns::setmask() { return FixConst::PRE_FORCE | FixConst::POST_RUN; }

int FixBetweenRuns::numbering() {
  int changed = 0;
  for (int i = 0; atom->tag_enable && i < atom->nlocal; ++i) {
    const auto now = static_cast<double>(atom->tag[i]);
    if (ball(i).id != 0.0 && ball(i).id != now) changed = 1;
    ball(i).id = now;
  }
  MPI_Allreduce(MPI_IN_PLACE, &changed, 1, MPI_INT, MPI_MAX, world);
  return numbering_ += changed;
}

void FixBetweenRuns::check_contacts(const std::string &command, bool have_history) {
  const int now = numbering();
  if (have_history && now != numbering_of_contacts_ && (has_run_ || update->ntimestep > 0))
    engine::stop(lmp, command +
                          ": history of contacts is 'of other balls', which have got other IDs since the "
                          "last run; allowed: delete_atoms with compress no");
  numbering_of_contacts_ = now;
}

/// Before a fix changes coefficients for the place of a roller (fix contact/way).
void FixBetweenRuns::init() { law_ = law_in_force(); }

double FixBetweenRuns::law_in_force() const {
  const drumlin::ContactSource *source = drumlin::contact_source(lmp);
  if (source == nullptr || FixStepping::find(lmp) == nullptr) return 0.0;
  Fingerprint all;
  all.add(update->dt);
  for (int place = 0; place < source->places().count(); ++place)
    all.add(source->places().turns_round(place) ? 1.0 : 2.0);
  const auto add_table = [&](const auto *table) {
    for (int i = 1; i <= atom->ntypes; ++i)
      for (int j = 1; j <= atom->ntypes; ++j) {
        const auto &of = table->at(i, j);
        const auto law = of.contact.law(1.0, 1.0, 0.0);
        constexpr double overlap = 0.01; // any: the law's numbers show in its forces
        for (const double number : {law.spring(overlap), law.dashpot(overlap), law.limited(-1.0),
                                    of.contact.tangential(overlap, 1.0), of.friction,
                                    of.tangential_dashpot(1.0), of.rolling, of.suction})
          all.add(number);
      }
  };
  std::visit(add_table, source->table());
  return all.value();
}

/// Of the ball in the box, since the engine puts balls back into a periodic box at a set-up only.
double FixBetweenRuns::state_of(int i) const {
  Vector x{atom->x[i][0], atom->x[i][1], atom->x[i][2]};
  domain->remap(x.data());
  Fingerprint all;
  for (const double *vector : {static_cast<const double *>(x.data()), static_cast<const double *>(atom->v[i]),
                               static_cast<const double *>(atom->omega[i])})
    all.add(vector);
  for (const double number : {atom->radius[i], atom->rmass[i], static_cast<double>(atom->type[i])})
    all.add(number);
  return all.value();
}

void FixBetweenRuns::setup_pre_force(int) {
  refuse_two_contacts();
  int any = 0;
  for (int i = 0; i < atom->nlocal; ++i) {
    Ball &of = ball(i);
    const bool same = law_ != 0.0 && law_ == kept_law_ && of.state != 0.0 && of.state == state_of(i);
    of.continues = same ? 1.0 : 0.0;
    of.load = 0.0;
    if (same) any = 1;
  }
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, world);
  any_continues_ = any != 0;
  if (any_continues_) engine::forward_comm(comm, this);
}

void FixBetweenRuns::pre_force(int) {
  if (neighbor->ago == 0) refuse_two_contacts();
  const bigint step = update->ntimestep;
  if (law_ == 0.0 || (step != update->laststep && !engine::writes_restart(output, step))) return;
  noted_ = step;
  for (int i = 0; i < atom->nlocal; ++i) {
    std::copy_n(atom->v[i], 3, ball(i).velocity.begin());
    std::copy_n(atom->omega[i], 3, ball(i).spin.begin());
  }
}

/// Notes what the next run has to know, at the end of a step.
void FixBetweenRuns::note_end() {
  const bool noted = noted_ == update->ntimestep;
  for (int i = 0; i < atom->nlocal; ++i) {
    Ball &of = ball(i);
    if (atom->tag_enable) of.id = static_cast<double>(atom->tag[i]);
    of.state = noted ? state_of(i) : 0.0;
    of.shift = {};
    if (!noted) continue;
    std::copy_n(atom->f[i], 3, of.force.begin());
    std::copy_n(atom->torque[i], 3, of.torque.begin());
  }
  kept_law_ = law_;
  if (const FixStepping *stepping = noted ? FixStepping::find(lmp) : nullptr)
    stepping->for_each_shift([this](int i, const Vector &shift) { ball(i).shift = shift; });
  for (Fix *fix : engine::fixes(modify))
    if (std::string(fix->style) == "contacthistory") fix->setup_pre_exchange();
}

void FixBetweenRuns::post_run() {
  note_end();
  has_run_ = true;
}

void FixBetweenRuns::write_restart(FILE *file) {
  if (update->whichflag != 0) note_end();
  drumlin::write_restart_record(file, comm->me, {kept_law_});
}

void FixBetweenRuns::restart(char *buffer) { std::memcpy(&kept_law_, buffer, sizeof kept_law_); }

void FixBetweenRuns::take_if_near(const Vector &before, double *now, double scale) {
  constexpr double rounding = 1e-11;
  for (std::size_t a = 0; a < 3; ++a)
    if (!(std::fabs(now[a] - before[a]) <= rounding * scale)) return;
  std::copy_n(before.begin(), 3, now);
}

/// Ends the run where a pair of balls may touch on two sides of a thin periodic box: contacts are known by
/// the IDs of their balls, so that both would have one history. Called when the neighbour list has been
/// built.
void FixBetweenRuns::refuse_two_contacts() const {
  const drumlin::ContactSource *source = drumlin::contact_source(lmp);
  if (source == nullptr || source->places().count() == 0) return;
  const double two_cutoffs = 2.0 * neighbor->cutneighmax;
  const std::array<Vector, 3> sides{
      {{domain->xprd, 0.0, 0.0}, {domain->xy, domain->yprd, 0.0}, {domain->xz, domain->yz, domain->zprd}}};
  std::array<int, 3> reach{}; // 1: along a thin periodic side
  for (std::size_t a = 0; a < static_cast<std::size_t>(domain->dimension); ++a)
    reach[a] = domain->periodicity[a] != 0 && sides[a][a] < two_cutoffs ? 1 : 0;
  if (reach == std::array<int, 3>{}) return;
  // If ball i touches ball j and an image of it, these are less than two sums of radii apart.
  const auto can_touch_twice = [&](int i, int j, const std::array<int, 3> &image) {
    Vector d{}, apart{};
    for (std::size_t a = 0; a < 3; ++a)
      d[a] = atom->x[i][a] - atom->x[j][a];
    for (std::size_t side = 0; side < 3; ++side)
      apart = physics::sum(apart, image[side], sides[side]);
    const double radii = atom->radius[i] + atom->radius[j], reach_of_list = radii + neighbor->skin;
    // The image of a ball itself may be a neighbour: it has one contact at most with it.
    if (atom->tag[i] == atom->tag[j])
      return image == std::array<int, 3>{} && physics::dot(d, d) < radii * radii;
    const Vector other = physics::sum(d, 1.0, apart);
    return image != std::array<int, 3>{} && physics::dot(apart, apart) < 4.0 * radii * radii &&
           physics::dot(other, other) < reach_of_list * reach_of_list;
  };
  std::array<int, 2> found{};
  const NeighList *list = source->contact_list();
  for (int ii = 0; ii < list->inum; ++ii)
    for (int i = list->ilist[ii], jj = 0; jj < list->numneigh[i]; ++jj) {
      const int j = engine::neighbour_index(list->firstneigh[i][jj]);
      for (int x = -reach[0]; x <= reach[0]; ++x)
        for (int y = -reach[1]; y <= reach[1]; ++y)
          for (int z = -reach[2]; z <= reach[2]; ++z)
            if (can_touch_twice(i, j, {x, y, z}))
              found = std::max(found, {static_cast<int>(std::min(atom->tag[i], atom->tag[j])),
                                       static_cast<int>(std::max(atom->tag[i], atom->tag[j]))});
    }
  struct { // for MPI
    int first, rank;
  } mine{found[0], comm->me}, all{};
  MPI_Allreduce(&mine, &all, 1, MPI_2INT, MPI_MAXLOC, world);
  if (all.first == 0) return;
  MPI_Bcast(found.data(), 2, MPI_INT, all.rank, world);
  std::size_t thin = 0;
  while (reach[thin] == 0)
    ++thin;
  engine::stop(
      lmp, fmt::format("pair_style {}: periodic box is '{:.6g} m' along {}, in which balls {} and {} "
                       "can touch on two sides, with one history for both contacts; allowed: at "
                       "least two cutoffs of the neighbour list, {:.6g} m",
                       force->pair_style, sides[thin][thin], "xyz"[thin], found[0], found[1], two_cutoffs));
}

void FixBetweenRuns::grow_arrays(int nmax) { balls_.resize(static_cast<std::size_t>(nmax)); }
void FixBetweenRuns::copy_arrays(int i, int j, int) { ball(j) = ball(i); }
void FixBetweenRuns::set_arrays(int i) { ball(i) = {}; }

int FixBetweenRuns::pack_exchange(int i, double *buf) {
  std::memcpy(buf, &ball(i), sizeof(Ball));
  return numbers;
}

int FixBetweenRuns::unpack_exchange(int i, double *buf) {
  std::memcpy(static_cast<void *>(&ball(i)), buf, sizeof(Ball));
  return numbers;
}

/// The engine expects the number of values first, itself included.
int FixBetweenRuns::pack_restart(int i, double *buf) {
  const int all = size_restart(i);
  buf[0] = all;
  std::memcpy(buf + 1, &ball(i), static_cast<std::size_t>(all - 1) * sizeof(double));
  return all;
}

/// Reads the values of this fix, which follow those of `nth` other fixes.
void FixBetweenRuns::unpack_restart(int i, int nth) {
  double *values = atom->extra[i];
  for (int n = 0; n < nth; ++n)
    values += static_cast<int>(*values);
  ball(i) = {};
  std::memcpy(static_cast<void *>(&ball(i)), values + 1,
              (static_cast<std::size_t>(*values) - 1) * sizeof(double));
}

/// The ID alone where nothing else was noted.
int FixBetweenRuns::size_restart(int i) { return 1 + (ball(i).state != 0.0 ? numbers : 1); }

void FixBetweenRuns::pack_ghosts(int n, const int *list, double *buf) {
  for (int m = 0; m < n; ++m) {
    const Ball &of = ball(list[m]);
    const Vector velocity = physics::sum(of.velocity, 1.0, velocity_of_ghosts());
    buf = std::copy_n(velocity.begin(), 3, buf);
    buf = std::copy_n(of.spin.begin(), 3, buf);
    *buf++ = of.continues;
  }
}

void FixBetweenRuns::unpack_ghosts(int n, int first, double *buf) {
  for (int i = first; i < first + n; ++i, buf += 7) {
    std::copy_n(buf, 3, ball(i).velocity.begin());
    std::copy_n(buf + 3, 3, ball(i).spin.begin());
    ball(i).continues = buf[6];
  }
}

VelocitiesOfStep::VelocitiesOfStep(LAMMPS *lmp, int first, int end)
    : fix_(lmp->update->setupflag != 0 ? FixBetweenRuns::find(lmp) : nullptr), atom_(lmp->atom),
      first_(first), end_(end) {
  exchange();
}

void VelocitiesOfStep::exchange() {
  if (fix_ == nullptr || !fix_->any_continues_) return;
  for (int i = first_; i < end_; ++i)
    if (FixBetweenRuns::Ball &of = fix_->ball(i); of.continues != 0.0) {
      std::swap_ranges(of.velocity.begin(), of.velocity.end(), atom_->v[i]);
      std::swap_ranges(of.spin.begin(), of.spin.end(), atom_->omega[i]);
    }
}
