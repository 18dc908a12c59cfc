#include "lammps/pair_gran_transition.h"

#include "fix_dummy.h"
#include "support/arguments.h"
#include "contact/pair_motion.h"
#include "lammps/loop_adapter.h"
#include "lammps/pair_words.h"
#include "lammps/fix_wall_gran_transition.h"
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

// Fixed IDs: LAMMPS finds the data of a fix in a restart file by the fix's ID, so the ID must not depend on
// how many pair styles the input script has created before. An engine has at most one object of this style.
const std::string history_id = "DRUMLIN_HISTORY0";
const std::string placeholder_id = "DRUMLIN_HISTORY_PLACE";

/// The name of the pair style with a law.
template <class Parameters>
std::string style_of_law() {
  return std::string("gran/") + Parameters::name;
}

} // namespace

PairGranTransition::PairGranTransition(LAMMPS *lammps, Tables tables)
    : Pair(lammps), tables_(std::move(tables)) {
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

PairGranTransition::~PairGranTransition() {
  if (copymode) return;
  if (!settings_.stock) FixStepping::dismiss(lmp);
  delete[] svector;
  for (const std::string &id : {placeholder_id, history_id})
    if (engine::find_fix(modify, id) != nullptr) modify->delete_fix(id);
  if (!allocated) return;
  memory->destroy(setflag);
  memory->destroy(cutsq);
}

PairGranTransition *PairGranTransition::find(LAMMPS *lmp) {
  std::vector<PairGranTransition *> all;
  drumlin::for_each_law([&](auto law) {
    const std::string name = style_of_law<typename decltype(law)::type>();
    if (auto *pair = dynamic_cast<PairGranTransition *>(lmp->force->pair_match(name, 1))) all.push_back(pair);
  });
  return all.size() == 1 ? all.front() : nullptr;
}

std::string PairGranTransition::style_name() const {
  return std::visit(
      [](const auto &table) { return style_of_law<std::decay_t<decltype(table.at(0, 0).contact)>>(); },
      tables_);
}

std::string PairGranTransition::law_name() const {
  return std::visit(
      [](const auto &table) -> std::string { return std::decay_t<decltype(table.at(0, 0).contact)>::name; },
      tables_);
}

drumlin::AnyTable PairGranTransition::table() const {
  return std::visit([](const auto &table) -> drumlin::AnyTable { return &table; }, tables_);
}

drumlin::CoefficientTable<drumlin::physics::LinearContact> *PairGranTransition::linear_table() {
  return std::get_if<drumlin::CoefficientTable<drumlin::physics::LinearContact>>(&tables_);
}

std::string drumlin::law_name(engine::LAMMPS *lmp) {
  const PairGranTransition *pair = PairGranTransition::find(lmp);
  return pair == nullptr ? "" : pair->law_name();
}

drumlin::ContactSource *drumlin::contact_source(engine::LAMMPS *lmp) { return PairGranTransition::find(lmp); }

void PairGranTransition::settings(int narg, char **arg) {
  drumlin::Arguments in(error, "pair_style " + style_name(), narg, arg);
  const int numbers_before = places_.count();
  std::visit(
      [&](const auto &table) {
        using Parameters = std::decay_t<decltype(table.at(0, 0).contact)>;
        take_settings(drumlin::read_settings(in, drumlin::LawWords<Parameters>::all()));
      },
      tables_);
  // A second pair_style line: coefficients mean something else under other settings, and contacts may
  // remember other numbers.
  if (allocated)
    for (int i = 1; i <= atom->ntypes; ++i)
      std::fill_n(setflag[i] + 1, atom->ntypes, 0);
  if (history_ != nullptr && places_.count() != numbers_before) {
    modify->replace_fix(history_id, placeholder_id + " all DUMMY", 1);
    history_ = nullptr;
  }
  // While the deck is parsed: a fix added later, in the initialization of a run, would miss that run.
  settings_.stock ? FixStepping::dismiss(lmp) : void(FixStepping::provide(lmp));
}

void PairGranTransition::take_settings(const drumlin::ContactSettings &settings) {
  settings_ = settings;
  std::visit(
      [this](const auto &table) { settings_.take_law<std::decay_t<decltype(table.at(0, 0).contact)>>(); },
      tables_);
  places_ = settings_.places(drumlin::history_order);
}

void PairGranTransition::allocate() {
  allocated = 1;
  const int n = atom->ntypes;
  memory->create(setflag, n + 1, n + 1, "pair:setflag");
  memory->create(cutsq, n + 1, n + 1, "pair:cutsq");
  for (int i = 1; i <= n; ++i)
    for (int j = 1; j <= n; ++j)
      setflag[i][j] = 0;
  std::visit([n](auto &table) { table.resize(n); }, tables_);
}

/// Sets the coefficients of a pair of types, in either order.
template <class Parameters>
void PairGranTransition::set_coefficients(int i, int j,
                                          const drumlin::ContactCoefficients<Parameters> &given) {
  auto &table = std::get<drumlin::CoefficientTable<Parameters>>(tables_);
  table.at(i, j) = table.at(j, i) = given;
}

void PairGranTransition::coeff(int narg, char **arg) {
  drumlin::Arguments in(error, "pair_coeff of " + style_name(), narg, arg);
  const std::string types[2] = {in.word("types I"), in.word("types J")};
  const auto given = std::visit(
      [&](const auto &table) -> drumlin::OneOfLaws<ContactCoefficients> {
        return drumlin::read_coefficients<std::decay_t<decltype(table.at(0, 0).contact)>>(in, settings_);
      },
      tables_);
  if (!allocated) allocate();
  int range[2][2];
  for (int side = 0; side < 2; ++side)
    utils::bounds(FLERR, types[side], 1, atom->ntypes, range[side][0], range[side][1], error);
  int count = 0;
  for (int i = range[0][0]; i <= range[0][1]; ++i)
    for (int j = std::max(range[1][0], i); j <= range[1][1]; ++j) {
      std::visit([&](const auto &coefficients) { set_coefficients(i, j, coefficients); }, given);
      setflag[i][j] = 1;
      ++count;
    }
  if (count == 0)
    in.fail("types are '" + types[0] + "' and '" + types[1] + "'; allowed: types I <= J of the box");
}

void PairGranTransition::check_engine() {
  const auto refuse = [this](const std::string &why) {
    error->all(FLERR, engine::error_text("pair_style " + style_name() + ": " + why));
  };
  if (find(lmp) != this)
    refuse("pair_style hybrid has it more than once, or two laws of this plugin; allowed: one law, once");
  if (!atom->radius_flag || !atom->rmass_flag)
    refuse("the atom style has no radius or no mass of its own; allowed: atom_style sphere");
  if (comm->ghost_velocity == 0) refuse("ghosts have no velocity; allowed: comm_modify vel yes before");
  drumlin::check_deforming_box(lmp, "pair_style " + style_name());
  const std::vector<Fix *> fixes = engine::fixes(modify);
  for (const Fix *fix : fixes)
    if (!settings_.stock && fix->rigid_flag)
      refuse(std::string("fix ") + fix->id + " (" + fix->style +
             ") makes rigid bodies and stepping is 'second'; allowed: stepping stock, or fix clump");
  deck_check_.of_pair(lmp, "pair_style " + style_name(), !settings_.stock);
  if (settings_.stock) return;
  for (const Fix *fix : fixes) {
    if (fix == FixStepping::find(lmp)) break;
    if (fix->time_integrate)
      refuse(std::string("fix ") + fix->id + " (" + fix->style +
             ") stands before it; allowed: pair_style before the fixes that integrate, or stepping stock");
  }
}

void PairGranTransition::init_style() {
  check_engine();
  const bool has_history = places_.count() > 0;
  engine::version::request_list(neighbor, this, instance_me, has_history);
  if (has_history && history_ == nullptr)
    history_ = static_cast<FixNeighHistory *>(modify->replace_fix(
        placeholder_id,
        history_id + " all " + FixNeighHistoryTransition::style_name + " " + std::to_string(places_.count()),
        1));
  if (has_history) history_->pair = this;
  FixBetweenRuns::provide(lmp)->check_contacts("pair_style " + style_name(), has_history);
  stepping_ = settings_.stock ? nullptr : FixStepping::find(lmp);

  observers_.find(*modify);
  clumps_.find(*modify);
  rigid_.clear();
  const std::vector<Fix *> fixes = engine::fixes(modify);
  for (Fix *fix : fixes)
    if (fix->rigid_flag) rigid_.push_back(fix);
  if (rigid_.empty()) rigid_mass_.clear();

  freeze_groupbit_ = 0;
  for (const Fix *fix : fixes)
    if (std::string(fix->style) == "freeze") freeze_groupbit_ = fix->groupbit;

  const auto ntypes = static_cast<std::size_t>(atom->ntypes);
  std::vector<double> mine(2 * (ntypes + 1), 0.0);
  std::vector<double> all = mine;
  for (Fix *fix : fixes) // balls that are still to come
    if (const std::string style = fix->style; style == "pour" || style == "deposit")
      for (int type = 1; type <= atom->ntypes; ++type) {
        int extracted = type;
        if (const auto *radius = static_cast<double *>(fix->extract("radius", extracted)))
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
  for (const Fix *fix : fixes)
    if (const auto *wall = dynamic_cast<const FixWallGranTransition *>(fix)) walls_.push_back(wall);
}

std::string PairGranTransition::missing_coefficients(int itype, int jtype) const {
  const auto [i, j] = std::minmax(itype, jtype);
  const std::string types = std::to_string(i) + " " + std::to_string(j);
  const std::string stiffness = std::visit(
      [](const auto &table) {
        return drumlin::LawWords<std::decay_t<decltype(table.at(0, 0).contact)>>::stiffness();
      },
      tables_);
  return "types " + types + " have no coefficients; allowed: 'pair_coeff " + types + stiffness +
         " damping ...' or 'pair_coeff * * ...' before (coefficients are not mixed)";
}

double PairGranTransition::init_one(int i, int j) {
  if (!has_coefficients(i, j))
    error->all(FLERR, engine::error_text("pair_style " + style_name() + ": " + missing_coefficients(i, j)));
  const auto a = static_cast<std::size_t>(i);
  const auto b = static_cast<std::size_t>(j);
  return std::max({reach_[a] + reach_[b], frozen_reach_[a] + reach_[b], reach_[a] + frozen_reach_[b]});
}

double PairGranTransition::mass(int i) const {
  if (atom->mask[i] & freeze_groupbit_) return std::numeric_limits<double>::infinity();
  return mass_unless_frozen(i);
}

double PairGranTransition::mass_unless_frozen(int i) const {
  const auto n = static_cast<std::size_t>(i);
  const bool of_rigid = n < rigid_mass_.size() && rigid_mass_[n] > 0.0;
  return clumps_.mass_of(*atom, i, of_rigid ? rigid_mass_[n] : atom->rmass[i]);
}

/// Asks the fixes rigid for the masses of their bodies, for owned balls and ghosts. Collective.
void PairGranTransition::share_rigid_masses() {
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
              "pair_style " + style_name() + ": fix " + fix->id + " (" + fix->style +
              ") does not tell the masses of its bodies; allowed: fix rigid, fix rigid/small or fix clump"));
    for (int i = 0; i < atom->nlocal; ++i)
      if (body[i] >= 0) rigid_mass_[static_cast<std::size_t>(i)] = mass[body[i]];
  }
  engine::version::forward_comm(comm, this);
}

int PairGranTransition::pack_forward_comm(int n, int *balls, double *numbers, int, int *) {
  for (int m = 0; m < n; ++m)
    numbers[m] = rigid_mass_[static_cast<std::size_t>(balls[m])];
  return n;
}

void PairGranTransition::unpack_forward_comm(int n, int first, double *numbers) {
  std::copy_n(numbers, n, rigid_mass_.begin() + first);
}

physics::Dashpots PairGranTransition::wall_dashpots(int i) const {
  physics::Dashpots all;
  for (const FixWallGranTransition *wall : walls_) {
    physics::Dashpots one;
    std::visit(
        [&](const auto &table) {
          const auto &contact = table.at(atom->type[i], wall->wall_type()).contact;
          const double r = atom->radius[i];
          drumlin::add_dashpot(one, contact, mass(i), drumlin::radius_for<std::decay_t<decltype(contact)>>(r),
                               2.0 * r);
        },
        tables_);
    for (int side = 0; side < wall->sides(); ++side)
      all.add(one);
  }
  return all;
}

const double *PairGranTransition::history(int i, int jj) const {
  if (places_.count() == 0) return nullptr;
  return history_->firstvalue[i] + static_cast<std::ptrdiff_t>(places_.count()) * jj;
}

void PairGranTransition::compute(int eflag, int vflag) {
  ev_init(eflag, vflag);
  if (neighbor->ago == 0) share_rigid_masses();
  if (list->inum == 0) return; // there may be no arrays
  const VelocitiesOfStep velocities(lmp);
  std::visit(
      [this](const auto &table) {
        drumlin::with_models(settings_, [&](auto stepped, auto tangential, auto rolling) {
          using Parameters = std::decay_t<decltype(table.at(0, 0).contact)>;
          LoopAdapter<Parameters, decltype(stepped)::value, decltype(tangential)::value,
                      decltype(rolling)::value>(*this, table)
              .compute();
        });
      },
      tables_);
}

const double *PairGranTransition::history_of_pair(int i, int j) const {
  for (int jj = 0; jj < list->numneigh[i]; ++jj)
    if (engine::neighbour_index(list->firstneigh[i][jj]) == j) return history(i, jj);
  return nullptr;
}

/// For computes. There is no energy, as in pair gran. Extra values on ball i: tangential force (3), its
/// magnitude, normal (3) and tangential (3) part of the relative velocity, overlap.
double PairGranTransition::single(int i, int j, int itype, int jtype, double, double, double,
                                  double &force_over_distance) {
  force_over_distance = 0.0;
  std::fill_n(svector, single_extra, 0.0);
  const drumlin::PairMotion now = drumlin::pair_motion(*atom, i, j);
  const double *remembered = places_.count() > 0 ? history_of_pair(i, j) : nullptr;
  if (now.overlap <= 0.0 || (places_.count() > 0 && remembered == nullptr)) return 0.0;
  std::visit(
      [&](const auto &table) {
        tell_single(table.at(itype, jtype), now, i, j, remembered, force_over_distance);
      },
      tables_);
  return 0.0;
}

/// single() of two balls that overlap. \param remembered the history of their contact; nullptr if there is
/// none
template <class Parameters>
void PairGranTransition::tell_single(const ContactCoefficients<Parameters> &law,
                                     const drumlin::PairMotion &now, int i, int j, const double *remembered,
                                     double &force_over_distance) {
  const double r_eff = drumlin::radius_for<Parameters>(atom->radius[i], atom->radius[j]);
  const auto stored = [&](drumlin::Remembered what) {
    return places_[what] < 0 ? nullptr : remembered + places_[what];
  };
  using drumlin::Remembered;
  const auto normal =
      law.contact.law(effective_mass(i, j), r_eff, drumlin::memory_at(stored(Remembered::memory)));
  const double normal_force =
      settings_.stock ? normal.force(now.overlap, now.rate) : *stored(Remembered::force);
  force_over_distance = (normal_force - law.suction) / (atom->radius[i] + atom->radius[j] - now.overlap);
  const bool rubs = settings_.tangential != FrictionModel::none;
  const double *stiffness = stored(Remembered::stiffness);
  const double kt =
      stiffness != nullptr && *stiffness > 0.0 ? *stiffness : law.contact.tangential(now.overlap, r_eff);
  const physics::Friction friction =
      rubs ? law.tangential(kt, normal.dashpot(now.overlap), settings_.cap) : physics::Friction{};
  const physics::Vec3 across = drumlin::friction_force(*atom, i, j, now, friction, normal_force,
                                                       stored(Remembered::spring), update->dt);
  const physics::Vec3 slip = drumlin::tangential_velocity(*atom, i, j, now);
  double *value = std::copy_n(across.begin(), 3, svector);
  *value++ = std::sqrt(physics::dot(across, across));
  for (const double n : now.normal)
    *value++ = -now.rate * n;
  value = std::copy_n(slip.begin(), 3, value);
  *value = now.overlap;
}

void PairGranTransition::transfer_history(double *source, double *target DRUMLIN_TRANSFER_TYPES) {
  for (int n = 0; n < places_.count(); ++n)
    target[n] = places_.turns_round(n) ? -source[n] : source[n];
}

/// Pair style hybrid keeps the settings of its parts, and no coefficients. Rolling resistance is the second
/// bit of a word, and suction that of the first number of a pair of types, so that files that were written
/// without them can be read.
void PairGranTransition::write_restart_settings(FILE *file) {
  const int words[5] = {static_cast<int>(settings_.transition), static_cast<int>(settings_.damping),
                        (settings_.stock ? 1 : 0) + (settings_.rolling ? 2 : 0),
                        static_cast<int>(settings_.tangential), static_cast<int>(settings_.cap)};
  std::fwrite(words, sizeof(int), 5, file);
}

void PairGranTransition::read_restart_settings(FILE *file) {
  int words[5] = {};
  if (comm->me == 0) utils::sfread(FLERR, words, sizeof(int), 5, file, nullptr, error);
  MPI_Bcast(words, 5, MPI_INT, 0, world);
  take_settings({static_cast<physics::Transition>(words[0]), static_cast<drumlin::DampingInput>(words[1]),
                 (words[2] & 1) != 0, static_cast<FrictionModel>(words[3]),
                 static_cast<physics::Cap>(words[4]), (words[2] & 2) != 0});
  if (!settings_.stock) FixStepping::provide(lmp);
}

void PairGranTransition::write_restart(FILE *file) {
  write_restart_settings(file);
  const auto write = [&](auto table) { // a copy
    for (int i = 1; i <= atom->ntypes; ++i)
      for (int j = i; j <= atom->ntypes; ++j) {
        const double suction = table.at(i, j).suction;
        std::vector<double> numbers{static_cast<double>(setflag[i][j] + (suction > 0.0 ? 2 : 0))};
        for (const double *number : drumlin::restart_numbers(table.at(i, j)))
          numbers.push_back(*number);
        if (settings_.rolling) numbers.push_back(table.at(i, j).rolling);
        if (suction > 0.0) numbers.push_back(suction);
        std::fwrite(numbers.data(), sizeof(double), numbers.size(), file);
      }
  };
  std::visit(write, tables_);
}

void PairGranTransition::read_restart(FILE *file) {
  read_restart_settings(file);
  allocate();
  const auto read = [&](auto &table) {
    using Parameters = std::decay_t<decltype(table.at(0, 0).contact)>;
    for (int i = 1; i <= atom->ntypes; ++i)
      for (int j = i; j <= atom->ntypes; ++j) {
        ContactCoefficients<Parameters> p;
        const std::vector<double *> places = drumlin::restart_numbers(p);
        std::vector<double> numbers(1 + places.size() + (settings_.rolling ? 1 : 0));
        const int count = static_cast<int>(numbers.size());
        if (comm->me == 0)
          utils::sfread(FLERR, numbers.data(), sizeof(double), numbers.size(), file, nullptr, error);
        MPI_Bcast(numbers.data(), count, MPI_DOUBLE, 0, world);
        const int flags = static_cast<int>(numbers[0]);
        setflag[i][j] = flags & 1;
        if ((flags & 2) != 0) {
          if (comm->me == 0) utils::sfread(FLERR, &p.suction, sizeof(double), 1, file, nullptr, error);
          MPI_Bcast(&p.suction, 1, MPI_DOUBLE, 0, world);
        }
        for (std::size_t n = 0; n < places.size(); ++n)
          *places[n] = numbers[n + 1];
        if (settings_.rolling) p.rolling = numbers.back();
        p.contact.damping_kind = settings_.kind();
        p.contact.transition = settings_.transition;
        set_coefficients(i, j, p);
      }
  };
  std::visit(read, tables_);
}
