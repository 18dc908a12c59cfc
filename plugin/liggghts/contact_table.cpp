#include "liggghts/contact_table.h"

#include "engine.h"
#include "fixes/fix_clump.h"
#include "fix_property_global.h"
#include "fix_rigid.h"
#include "fix_wall_gran.h"
#include "global_properties.h"
#include "pair_gran.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <memory>
#include <vector>

namespace drumlin {
namespace {

using LAMMPS_NS::FixPropertyGlobal;
using LAMMPS_NS::LAMMPS;
using LAMMPS_NS::Pointers;

constexpr const char *model = "model hooke/transition";
constexpr double default_friction = 0.5;
constexpr const char *friction_property =
    "coefficientFriction"; // as the engine's tangential models ask for it

/// A matrix property over pairs of types.
class TypePairProperty : Pointers {
public:
  TypePairProperty(LAMMPS *engine, const char *name, int ntypes)
      : Pointers(engine), name_(name),
        fix_(static_cast<FixPropertyGlobal *>(modify->find_fix_property(
            name, "property/global", "peratomtypepair", ntypes, ntypes, model, false))) {}

  bool given() const { return fix_ != nullptr; }

  double operator()(int i, int j, bool zero_allowed) {
    const double value = fix_->compute_array(i - 1, j - 1);
    if (!std::isfinite(value) || value < 0.0 || (value == 0.0 && !zero_allowed))
      error->all(FLERR, engine::as_is(fmt::format(
                            "{}: property {} of types {} and {} is {}; allowed: a finite number {} 0", model,
                            name_, i, j, value, zero_allowed ? ">=" : ">")));
    return value;
  }

  void require(const char *meaning, int ntypes) const {
    if (given()) return;
    error->all(
        FLERR,
        engine::as_is(fmt::format(
            "{}: property {} ({}) is missing; allowed: 'fix ID all property/global {} peratomtypepair {}' "
            "and {} values",
            model, name_, meaning, name_, ntypes, ntypes * ntypes)));
  }

private:
  const char *name_;
  FixPropertyGlobal *fix_;
};

std::vector<const ContactTable *> wall_tables; // one for each wall

/// The pair style's table as the fixes see it.
class PairSource final : public ContactSource, Pointers {
public:
  PairSource(LAMMPS *engine, const ContactTable *table)
      : Pointers(engine), table_(table), pair_(gran_pair(engine)) {
    for (int n = 0; n < modify->nfix; ++n)
      if (const auto *wall = dynamic_cast<const LAMMPS_NS::FixWallGran *>(modify->fix[n]))
        meshes_ = meshes_ || wall->is_mesh_wall();
  }

  const physics::LinearContact &law(int itype, int jtype) const override {
    return table_->at(itype, jtype).normal;
  }

  double mass(int i) const override {
    if (atom->mask[i] & pair_->freeze_group_bit()) return std::numeric_limits<double>::infinity();
    const double own =
        pair_->fr_pair() != nullptr && pair_->mr_pair()[i] > 0.0 ? pair_->mr_pair()[i] : atom->rmass[i];
    return LAMMPS_NS::FixClump::mass_of(*atom, i, own);
  }

  physics::Dashpots wall_dashpots(int i) const override {
    physics::Dashpots all;
    if (meshes_) all.sum = std::numeric_limits<double>::infinity();
    for (const ContactTable *wall : wall_tables) {
      physics::Dashpots strongest;
      for (int type = 1; type <= atom->ntypes; ++type) {
        const physics::LinearContact &law = wall->at(atom->type[i], type).normal;
        physics::Dashpots one;
        one.add(law.stiffness, law.damping_coefficient(mass(i)));
        strongest = {std::max(strongest.sum, one.sum), std::max(strongest.stiffest, one.stiffest)};
      }
      all.add(strongest);
    }
    return all;
  }

  FrictionModel friction_model() const override { return friction_model_; }
  void set_friction_model(FrictionModel acting, physics::Cap cap) {
    friction_model_ = acting;
    cap_ = cap;
  }

  physics::Friction friction(int itype, int jtype, double c) const override {
    const ContactCoefficients &p = table_->at(itype, jtype);
    TypePairProperty coefficient(lmp, friction_property, atom->ntypes);
    return {p.tangential_stiffness, p.tangential_damping_share * c + p.tangential_damping,
            coefficient(itype, jtype, true), cap_};
  }

  // The engine builds the tangential model before any other that asks for history: its spring comes first.
  const double *tangential_spring(int i, int jj) const override {
    return pair_->listgranhistory->firstdouble[i] + static_cast<std::ptrdiff_t>(pair_->dnum()) * jj;
  }

  const LAMMPS_NS::NeighList *contact_list() const override { return pair_->list; }

  bool serves(const LAMMPS *engine) const { return lmp == engine; }
  bool reads(const ContactTable *table) const { return table_ == table; }

private:
  const ContactTable *table_;
  LAMMPS_NS::PairGran *pair_;
  bool meshes_ = false;
  FrictionModel friction_model_ = FrictionModel::none;
  physics::Cap cap_ = physics::Cap::spring;
};

std::unique_ptr<PairSource> current_source; // one engine instance per process runs a deck

} // namespace

LAMMPS_NS::PairGran *gran_pair(LAMMPS *lmp) {
  return dynamic_cast<LAMMPS_NS::PairGran *>(lmp->force->pair_match("gran", 1));
}

void ContactTable::read(LAMMPS *lmp, int ntypes, physics::Transition transition, physics::Damping damping,
                        bool is_wall) {
  TypePairProperty kn(lmp, "kn", ntypes);
  TypePairProperty kt(lmp, "kt", ntypes);
  TypePairProperty ct(lmp, "gammat_abs", ntypes);
  TypePairProperty c(lmp, damping == physics::Damping::ratio ? "dampingRatio" : "gamman_abs", ntypes);
  kn.require("normal stiffness, N/m", ntypes);
  c.require(damping == physics::Damping::ratio
                ? "damping ratio D, keyword damping ratio"
                : "normal damping coefficient, N s/m, keyword damping coefficient",
            ntypes);

  stride_ = static_cast<std::size_t>(ntypes) + 1;
  coefficients_.assign(stride_ * stride_, {});
  for (int i = 1; i <= ntypes; ++i)
    for (int j = 1; j <= ntypes; ++j) {
      ContactCoefficients &p =
          coefficients_[static_cast<std::size_t>(i) * stride_ + static_cast<std::size_t>(j)];
      p.normal = {kn(i, j, false), c(i, j, true), damping, transition};
      p.tangential_stiffness = kt.given() ? kt(i, j, true) : 2.0 / 7.0 * p.normal.stiffness;
      p.tangential_damping = ct.given() ? ct(i, j, true) : 0.0;
      p.tangential_damping_share = ct.given() ? 0.0 : 0.5;
    }
  if (!is_wall)
    current_source = std::make_unique<PairSource>(lmp, this);
  else if (std::find(wall_tables.begin(), wall_tables.end(), this) == wall_tables.end())
    wall_tables.push_back(this);
}

void set_friction_model(FrictionModel acting, physics::Cap cap) {
  if (current_source) current_source->set_friction_model(acting, cap);
}

void provide_friction_default(LAMMPS *lmp, int ntypes) {
  if (TypePairProperty given(lmp, friction_property, ntypes); given.given()) {
    for (int i = 1; i <= ntypes; ++i)
      for (int j = 1; j <= ntypes; ++j)
        given(i, j, true);
    return;
  }
  std::vector<std::string> words = {"drumlin_friction", "all",
                                    "property/global",  friction_property,
                                    "peratomtypepair",  std::to_string(ntypes)};
  words.insert(words.end(), static_cast<std::size_t>(ntypes) * static_cast<std::size_t>(ntypes),
               fmt::format("{}", default_friction));
  std::vector<char *> arg;
  arg.reserve(words.size());
  for (std::string &word : words)
    arg.push_back(word.data());
  lmp->modify->add_fix(static_cast<int>(arg.size()), arg.data());
}

ContactTable::~ContactTable() {
  wall_tables.erase(std::remove(wall_tables.begin(), wall_tables.end(), this), wall_tables.end());
  if (current_source && current_source->reads(this)) current_source.reset();
}

const ContactSource *contact_source(LAMMPS *lmp) {
  return current_source && current_source->serves(lmp) ? current_source.get() : nullptr;
}

} // namespace drumlin
