#include "lammps/pair_gran_hooke_transition.h"

#include "fix_dummy.h"
#include "support/arguments.h"
#include "contact/pair_motion.h"
#include "lammps/pair_words.h"
#include "lammps/fix_neigh_history_transition.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace LAMMPS_NS;
using drumlin::ContactCoefficients;
using drumlin::FrictionModel;
namespace engine = drumlin::engine;
namespace physics = drumlin::physics;

namespace {

constexpr const char *style_name = "gran/hooke/transition";

// The same for every object of the style, of which an engine has one: a restart file is read for fixes of
// these IDs, whatever pair styles its deck has made before.
const std::string history_id = "DRUMLIN_HISTORY0";
const std::string placeholder_id = "DRUMLIN_HISTORY_PLACE";

/// A vector per ball. They follow one another in memory: this spares the inner loop a pointer per ball.
template <class Number>
struct Rows {
  Number *first;
  Number *operator[](int i) const { return first + static_cast<std::ptrdiff_t>(i) * 3; }
};

} // namespace

PairGranHookeTransition::PairGranHookeTransition(LAMMPS *lammps) : Pair(lammps) {
  single_extra = 11;
  svector = new double[static_cast<std::size_t>(single_extra)];
  no_virial_fdotr_compute = 1;
  centroidstressflag = CENTROID_NOTAVAIL;
  finitecutflag = 1;
  comm_forward = 1;
  nondefault_history_transfer = 1;
  beyond_contact =
      1; // a contact that ends in the step of a new neighbour list must be known to have been one
  // Holds the place of the history among the fixes, which is the order of their calls.
  modify->add_fix(placeholder_id + " all DUMMY");
}

PairGranHookeTransition::~PairGranHookeTransition() {
  if (copymode) return;
  if (!settings_.stock) FixStepping::dismiss(lmp);
  delete[] svector;
  for (const std::string &id : {placeholder_id, history_id})
    if (modify->find_fix(id) >= 0) modify->delete_fix(id);
  if (!allocated) return;
  memory->destroy(setflag);
  memory->destroy(cutsq);
}

PairGranHookeTransition *PairGranHookeTransition::find(LAMMPS *lmp) {
  return dynamic_cast<PairGranHookeTransition *>(lmp->force->pair_match(style_name, 1));
}

const drumlin::ContactSource *drumlin::contact_source(engine::LAMMPS *lmp) {
  return PairGranHookeTransition::find(lmp);
}

void PairGranHookeTransition::settings(int narg, char **arg) {
  drumlin::Arguments in(error, std::string("pair_style ") + style_name, narg, arg);
  const int history_before = settings_.history();
  settings_ = drumlin::read_settings(in);
  // A second pair_style line: coefficients mean something else under other settings, and contacts may
  // remember other numbers.
  if (allocated)
    for (int i = 1; i <= atom->ntypes; ++i)
      std::fill_n(setflag[i] + 1, atom->ntypes, 0);
  if (history_ != nullptr && settings_.history() != history_before) {
    modify->replace_fix(history_id, placeholder_id + " all DUMMY", 1);
    history_ = nullptr;
  }
  // While the deck is parsed: a fix added later, in the initialization of a run, would miss that run.
  settings_.stock ? FixStepping::dismiss(lmp) : void(FixStepping::provide(lmp));
}

void PairGranHookeTransition::allocate() {
  allocated = 1;
  const int n = atom->ntypes;
  memory->create(setflag, n + 1, n + 1, "pair:setflag");
  memory->create(cutsq, n + 1, n + 1, "pair:cutsq");
  for (int i = 1; i <= n; ++i)
    for (int j = 1; j <= n; ++j)
      setflag[i][j] = 0;
  stride_ = static_cast<std::size_t>(n) + 1;
  coefficients_.assign(stride_ * stride_, {});
}

void PairGranHookeTransition::coeff(int narg, char **arg) {
  drumlin::Arguments in(error, std::string("pair_coeff of ") + style_name, narg, arg);
  const std::string types[2] = {in.word("types I"), in.word("types J")};
  ContactCoefficients given = drumlin::read_coefficients(in, settings_);
  if (!allocated) allocate();
  int range[2][2];
  for (int side = 0; side < 2; ++side)
    utils::bounds(FLERR, types[side], 1, atom->ntypes, range[side][0], range[side][1], error);
  int count = 0;
  for (int i = range[0][0]; i <= range[0][1]; ++i)
    for (int j = std::max(range[1][0], i); j <= range[1][1]; ++j) {
      for (const std::size_t place : {static_cast<std::size_t>(i) * stride_ + static_cast<std::size_t>(j),
                                      static_cast<std::size_t>(j) * stride_ + static_cast<std::size_t>(i)})
        coefficients_[place] = given;
      setflag[i][j] = 1;
      ++count;
    }
  if (count == 0)
    in.fail("types are '" + types[0] + "' and '" + types[1] + "'; allowed: types I <= J of the box");
}

void PairGranHookeTransition::check_engine() const {
  const auto refuse = [this](const std::string &why) {
    error->all(FLERR, engine::error_text(std::string("pair_style ") + style_name + ": " + why));
  };
  if (find(lmp) != this) refuse("pair_style hybrid has it more than once; allowed: once");
  if (!atom->radius_flag || !atom->rmass_flag)
    refuse("the atom style has no radius or no mass of its own; allowed: atom_style sphere");
  if (comm->ghost_velocity == 0) refuse("ghosts have no velocity; allowed: comm_modify vel yes before");
  if (settings_.stock) return;
  for (int n = 0; n < modify->nfix; ++n)
    if (modify->fix[n]->rigid_flag)
      refuse(std::string("fix ") + modify->fix[n]->id + " (" + modify->fix[n]->style +
             ") makes rigid bodies and stepping is 'second'; allowed: stepping stock, or fix clump");
  for (int n = 0; n < modify->nfix && modify->fix[n] != FixStepping::find(lmp); ++n)
    if (modify->fix[n]->time_integrate)
      refuse(std::string("fix ") + modify->fix[n]->id + " (" + modify->fix[n]->style +
             ") stands before it; allowed: pair_style before the fixes that integrate, or stepping stock");
}

void PairGranHookeTransition::init_style() {
  check_engine();
  const bool remembers = settings_.history() > 0;
  engine::version::request_list(neighbor, this, instance_me, remembers);
  if (remembers && history_ == nullptr)
    history_ = static_cast<FixNeighHistory *>(
        modify->replace_fix(placeholder_id,
                            history_id + " all " + FixNeighHistoryTransition::style_name + " " +
                                std::to_string(settings_.history()),
                            1));
  if (remembers) history_->pair = this;
  stepping_ = settings_.stock ? nullptr : FixStepping::find(lmp);

  observers_.find(*modify);
  clumps_.find(*modify);
  rigid_.clear();
  for (int n = 0; n < modify->nfix; ++n)
    if (modify->fix[n]->rigid_flag) rigid_.push_back(modify->fix[n]);
  if (rigid_.empty()) rigid_mass_.clear();

  freeze_groupbit_ = 0;
  for (int n = 0; n < modify->nfix; ++n)
    if (std::string(modify->fix[n]->style) == "freeze") freeze_groupbit_ = modify->fix[n]->groupbit;

  const auto ntypes = static_cast<std::size_t>(atom->ntypes);
  std::vector<double> mine(2 * (ntypes + 1), 0.0);
  std::vector<double> all = mine;
  for (int n = 0; n < modify->nfix; ++n) // balls that are still to come
    if (const std::string style = modify->fix[n]->style; style == "pour" || style == "deposit")
      for (int type = 1; type <= atom->ntypes; ++type) {
        int extracted = type;
        if (const auto *radius = static_cast<double *>(modify->fix[n]->extract("radius", extracted)))
          mine[static_cast<std::size_t>(type)] = std::max(mine[static_cast<std::size_t>(type)], *radius);
      }
  for (int i = 0; i < atom->nlocal; ++i) {
    const bool frozen = atom->mask[i] & freeze_groupbit_;
    double &reach = mine[static_cast<std::size_t>(atom->type[i]) + (frozen ? ntypes + 1 : 0)];
    reach = std::max(reach, atom->radius[i]);
  }
  MPI_Allreduce(mine.data(), all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_MAX, world);
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(ntypes) + 1;
  reach_.assign(all.begin(), middle);
  frozen_reach_.assign(middle, all.end());

  walls_.clear();
  for (int n = 0; n < modify->nfix; ++n)
    if (const auto *wall = dynamic_cast<const drumlin::Walls *>(modify->fix[n])) walls_.push_back(wall);
}

std::string PairGranHookeTransition::missing_coefficients(int itype, int jtype) {
  const auto [i, j] = std::minmax(itype, jtype);
  const std::string types = std::to_string(i) + " " + std::to_string(j);
  return "types " + types + " have no coefficients; allowed: 'pair_coeff " + types +
         " k damping ...' or 'pair_coeff * * ...' before (coefficients are not mixed)";
}

double PairGranHookeTransition::init_one(int i, int j) {
  if (!has_coefficients(i, j))
    error->all(FLERR, engine::error_text(std::string("pair_style ") + style_name + ": " +
                                         missing_coefficients(i, j)));
  const auto a = static_cast<std::size_t>(i);
  const auto b = static_cast<std::size_t>(j);
  return std::max({reach_[a] + reach_[b], frozen_reach_[a] + reach_[b], reach_[a] + frozen_reach_[b]});
}

double PairGranHookeTransition::mass(int i) const {
  if (atom->mask[i] & freeze_groupbit_) return std::numeric_limits<double>::infinity();
  return mass_unless_frozen(i);
}

double PairGranHookeTransition::mass_unless_frozen(int i) const {
  const auto n = static_cast<std::size_t>(i);
  const bool of_rigid = n < rigid_mass_.size() && rigid_mass_[n] > 0.0;
  return clumps_.mass_of(*atom, i, of_rigid ? rigid_mass_[n] : atom->rmass[i]);
}

/// Asks the fixes rigid for the masses of their bodies, for owned balls and ghosts. Collective.
void PairGranHookeTransition::share_rigid_masses() {
  if (rigid_.empty()) return;
  const int balls = atom->nlocal + atom->nghost;
  rigid_mass_.assign(static_cast<std::size_t>(balls), 0.0);
  for (Fix *fix : rigid_) {
    int dimension = 0;
    const auto *body = static_cast<const int *>(fix->extract("body", dimension));
    const auto *mass = static_cast<const double *>(fix->extract("masstotal", dimension));
    if (body == nullptr || mass == nullptr)
      error->all(
          FLERR,
          engine::error_text(
              std::string("pair_style ") + style_name + ": fix " + fix->id + " (" + fix->style +
              ") does not tell the masses of its bodies; allowed: fix rigid, fix rigid/small or fix clump"));
    for (int i = 0; i < atom->nlocal; ++i)
      if (body[i] >= 0) rigid_mass_[static_cast<std::size_t>(i)] = mass[body[i]];
  }
  engine::version::forward_comm(comm, this);
}

int PairGranHookeTransition::pack_forward_comm(int n, int *balls, double *numbers, int, int *) {
  for (int m = 0; m < n; ++m)
    numbers[m] = rigid_mass_[static_cast<std::size_t>(balls[m])];
  return n;
}

void PairGranHookeTransition::unpack_forward_comm(int n, int first, double *numbers) {
  std::copy_n(numbers, n, rigid_mass_.begin() + first);
}

physics::Dashpots PairGranHookeTransition::wall_dashpots(int i) const {
  physics::Dashpots all;
  for (const drumlin::Walls *wall : walls_) {
    const physics::LinearContact &law = at(atom->type[i], wall->wall_type()).normal;
    for (int side = 0; side < wall->sides(); ++side)
      all.add(law.stiffness, law.damping_coefficient(mass(i)));
  }
  return all;
}

const double *PairGranHookeTransition::tangential_spring(int i, int jj) const {
  return history_->firstvalue[i] + static_cast<std::ptrdiff_t>(settings_.history()) * jj;
}

void PairGranHookeTransition::compute(int eflag, int vflag) {
  ev_init(eflag, vflag);
  if (neighbor->ago == 0) share_rigid_masses();
  drumlin::with_models(settings_, [this](auto stepped, auto tangential) {
    compute_contacts<decltype(stepped)::value, decltype(tangential)::value>();
  });
}

template <bool stepped, FrictionModel tangential>
void PairGranHookeTransition::compute_contacts() {
  constexpr bool remembers = stepped || tangential == FrictionModel::history;
  constexpr bool rubs = tangential != FrictionModel::none;
  const drumlin::ContactSettings settings = settings_;
  const int history_size = settings.history();
  const bool moves = update->setupflag == 0;
  const int force_place = settings.spring(); // in the history
  const double dt = update->dt;
  const int nlocal = atom->nlocal;
  if (list->inum == 0) return; // there may be no arrays
  const int newton = force->newton_pair;
  const int taken = newton ? nlocal + atom->nghost : nlocal; // balls that take the force here
  const int freeze_bit = freeze_groupbit_;
  const Rows<const double> x{atom->x[0]};
  const Rows<const double> v{atom->v[0]};
  const Rows<const double> omega{atom->omega[0]};
  const double *radius = atom->radius;
  const double *rmass = atom->rmass;
  const int *type = atom->type;
  const int *mask = atom->mask;
  const Rows<double> f{atom->f[0]};
  const Rows<double> torque{atom->torque[0]};
  const bool bodies = !clumps_.empty() || !rigid_.empty();
  const bool observed = observers_.any();

  for (int ii = 0; ii < list->inum; ++ii) {
    const int i = list->ilist[ii];
    const int *neighbours = list->firstneigh[i];
    const int count = list->numneigh[i];
    int *touch = remembers ? history_->firstflag[i] : nullptr;
    double *memory_of_i = remembers ? history_->firstvalue[i] : nullptr;
    const physics::Vec3 xi{x[i][0], x[i][1], x[i][2]};
    const double ri = radius[i];
    const bool i_frozen = mask[i] & freeze_bit;
    const double mi = bodies ? mass_unless_frozen(i) : rmass[i];
    physics::Vec3 force_i{};
    physics::Vec3 torque_i{};
    for (int jj = 0; jj < count; ++jj) {
      const int j = neighbours[jj] & NEIGHMASK;
      const physics::Vec3 d{xi[0] - x[j][0], xi[1] - x[j][1], xi[2] - x[j][2]};
      const double squared = physics::dot(d, d);
      const double reach = ri + radius[j];
      const bool touches = squared < reach * reach;
      if (!touches && (!remembers || touch[jj] == 0)) continue;

      const double distance = std::sqrt(squared);
      const double inverse = 1.0 / distance;
      const physics::Vec3 relative{v[i][0] - v[j][0], v[i][1] - v[j][1], v[i][2] - v[j][2]};
      const ContactCoefficients &law = at(type[i], type[j]);
      const double mj = bodies ? mass_unless_frozen(j) : rmass[j];
      const double m_eff = mask[j] & freeze_bit ? mi : i_frozen ? mj : physics::effective_mass(mi, mj);

      const physics::Vec3 normal = physics::scaled(inverse, d);
      const double overlap = reach - distance;
      const double arm_i = ri - 0.5 * overlap;
      const double arm_j = radius[j] - 0.5 * overlap;
      physics::Vec3 slip{};
      if constexpr (rubs)
        slip = physics::slip_velocity(relative, normal,
                                      {arm_i * omega[i][0] + arm_j * omega[j][0],
                                       arm_i * omega[i][1] + arm_j * omega[j][1],
                                       arm_i * omega[i][2] + arm_j * omega[j][2]});
      double *const history =
          remembers ? memory_of_i + static_cast<std::ptrdiff_t>(history_size) * jj : nullptr;
      const drumlin::Contact p{{i, j, normal, nullptr, overlap, -physics::dot(relative, normal), m_eff, 1.0},
                               slip,
                               arm_i,
                               arm_j,
                               history,
                               remembers && touch[jj] != 0};

      drumlin::ContactForces forces;
      if (touches) {
        if constexpr (remembers) touch[jj] = 1;
        forces = drumlin::exert<stepped, tangential>(settings, law, stepping_, p, dt, moves);
        if (observed)
          report({drumlin::apart(p.normal), p.slip, p.arm_i, p.arm_j, p.history, p.in_contact},
                 {forces.normal_force, forces.force, forces.tangential_force, forces.moment});
      } else { // it did, a step ago
        forces = {};
        touch[jj] = 0;
        if constexpr (stepped)
          forces.force =
              drumlin::end_contact(law, *stepping_, drumlin::apart(p.normal), history[force_place]);
        std::fill_n(history, history_size, 0.0);
      }
      force_i = physics::sum(force_i, 1.0, forces.force);
      if constexpr (rubs) torque_i = physics::sum(torque_i, -arm_i, forces.moment);
      if (j < taken) {
        f[j][0] -= forces.force[0];
        f[j][1] -= forces.force[1];
        f[j][2] -= forces.force[2];
        if constexpr (rubs) {
          torque[j][0] -= arm_j * forces.moment[0];
          torque[j][1] -= arm_j * forces.moment[1];
          torque[j][2] -= arm_j * forces.moment[2];
        }
      }
      if (evflag)
        ev_tally_xyz(i, j, nlocal, newton, 0.0, 0.0, forces.force[0], forces.force[1], forces.force[2], d[0],
                     d[1], d[2]);
    }
    for (std::size_t a = 0; a < 3; ++a) {
      f[i][a] += force_i[a];
      if constexpr (rubs) torque[i][a] += torque_i[a];
    }
  }
}

void PairGranHookeTransition::report(const drumlin::Contact &p, const drumlin::ContactForces &forces) const {
  const int i = p.normal.i;
  const int j = p.normal.j;
  observers_.tell(drumlin::record_of(settings_, at(atom->type[i], atom->type[j]), p, forces,
                                     std::min(atom->radius[i], atom->radius[j])));
}

const double *PairGranHookeTransition::history(int i, int j) const {
  for (int jj = 0; jj < list->numneigh[i]; ++jj)
    if (engine::neighbour_index(list->firstneigh[i][jj]) == j)
      return history_->firstvalue[i] + static_cast<std::ptrdiff_t>(settings_.history()) * jj;
  return nullptr;
}

/// For computes. There is no energy, as in pair gran. Extra values on ball i: tangential force (3), its
/// magnitude, normal (3) and tangential (3) part of the relative velocity, overlap.
double PairGranHookeTransition::single(int i, int j, int itype, int jtype, double, double, double,
                                       double &force_over_distance) {
  force_over_distance = 0.0;
  std::fill_n(svector, single_extra, 0.0);
  const drumlin::PairMotion now = drumlin::pair_motion(*atom, i, j);
  const double *remembered = settings_.history() > 0 ? history(i, j) : nullptr;
  if (now.overlap <= 0.0 || (settings_.history() > 0 && remembered == nullptr)) return 0.0;
  const ContactCoefficients &law = at(itype, jtype);
  const physics::LinearLaw normal = law.normal.of_mass(effective_mass(i, j));
  const double normal_force =
      settings_.stock ? normal.force(now.overlap, now.rate) : remembered[settings_.spring()];
  force_over_distance = normal_force / (atom->radius[i] + atom->radius[j] - now.overlap);
  const physics::Friction friction = settings_.tangential == FrictionModel::none
                                         ? physics::Friction{}
                                         : law.tangential(normal.dashpot(now.overlap), settings_.cap);
  const physics::Vec3 across = drumlin::friction_force(
      *atom, i, j, now, friction, normal_force, settings_.spring() > 0 ? remembered : nullptr, update->dt);
  const physics::Vec3 slip = drumlin::tangential_velocity(*atom, i, j, now);
  double *value = std::copy_n(across.begin(), 3, svector);
  *value++ = std::sqrt(physics::dot(across, across));
  for (const double n : now.normal)
    *value++ = -now.rate * n;
  value = std::copy_n(slip.begin(), 3, value);
  *value = now.overlap;
  return 0.0;
}

/// The spring turns round when the balls change places, the force does not.
void PairGranHookeTransition::transfer_history(double *source, double *target DRUMLIN_TRANSFER_TYPES) {
  for (int n = 0; n < settings_.history(); ++n)
    target[n] = n < settings_.spring() ? -source[n] : source[n];
}

/// Pair style hybrid keeps the settings of its parts, and no coefficients.
void PairGranHookeTransition::write_restart_settings(FILE *file) {
  const int words[5] = {static_cast<int>(settings_.transition), static_cast<int>(settings_.damping),
                        settings_.stock ? 1 : 0, static_cast<int>(settings_.tangential),
                        static_cast<int>(settings_.cap)};
  std::fwrite(words, sizeof(int), 5, file);
}

void PairGranHookeTransition::read_restart_settings(FILE *file) {
  int words[5] = {};
  if (comm->me == 0) utils::sfread(FLERR, words, sizeof(int), 5, file, nullptr, error);
  MPI_Bcast(words, 5, MPI_INT, 0, world);
  settings_ = {static_cast<physics::Transition>(words[0]), static_cast<drumlin::DampingInput>(words[1]),
               words[2] != 0, static_cast<FrictionModel>(words[3]), static_cast<physics::Cap>(words[4])};
  if (!settings_.stock) FixStepping::provide(lmp);
}

void PairGranHookeTransition::write_restart(FILE *file) {
  write_restart_settings(file);
  for (int i = 1; i <= atom->ntypes; ++i)
    for (int j = i; j <= atom->ntypes; ++j) {
      const ContactCoefficients &p = at(i, j);
      const double numbers[7] = {static_cast<double>(setflag[i][j]),
                                 p.normal.stiffness,
                                 p.normal.damping,
                                 p.friction,
                                 p.tangential_stiffness,
                                 p.tangential_damping,
                                 p.tangential_damping_share};
      std::fwrite(numbers, sizeof(double), 7, file);
    }
}

void PairGranHookeTransition::read_restart(FILE *file) {
  read_restart_settings(file);
  allocate();
  for (int i = 1; i <= atom->ntypes; ++i)
    for (int j = i; j <= atom->ntypes; ++j) {
      double numbers[7] = {};
      if (comm->me == 0) utils::sfread(FLERR, numbers, sizeof(double), 7, file, nullptr, error);
      MPI_Bcast(numbers, 7, MPI_DOUBLE, 0, world);
      setflag[i][j] = static_cast<int>(numbers[0]);
      ContactCoefficients p;
      p.normal = {numbers[1], numbers[2], settings_.kind(), settings_.transition};
      p.friction = numbers[3];
      p.tangential_stiffness = numbers[4];
      p.tangential_damping = numbers[5];
      p.tangential_damping_share = numbers[6];
      for (const std::size_t place : {static_cast<std::size_t>(i) * stride_ + static_cast<std::size_t>(j),
                                      static_cast<std::size_t>(j) * stride_ + static_cast<std::size_t>(i)})
        coefficients_[place] = p;
    }
}
