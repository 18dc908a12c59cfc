#include "liggghts/contact_table.h"

#include "engine.h"
#include "fix_property_global.h"
#include "fix_rigid.h"
#include "fix_wall_gran.h"
#include "global_properties.h"
#include "pair_gran_proxy.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <vector>

namespace drumlin {
namespace {

using LAMMPS_NS::FixPropertyGlobal;
using LAMMPS_NS::LAMMPS;
using LAMMPS_NS::Pointers;

constexpr const char *model = "model hooke/transition";
constexpr double default_friction = 0.5;
constexpr double infinity = std::numeric_limits<double>::infinity();
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

  double operator()(int i, int j, bool zero_allowed, double most = infinity) {
    const double value = fix_->compute_array(i - 1, j - 1);
    if (!std::isfinite(value) || value < 0.0 || (value == 0.0 && !zero_allowed) || value > most)
      error->all(FLERR, engine::error_text(fmt::format(
                            "{}: property {} of types {} and {} is {}; allowed: a finite number {} 0{}",
                            model, name_, i, j, value, zero_allowed ? ">=" : ">",
                            most < infinity ? fmt::format(" and <= {}", most) : "")));
    return value;
  }

  void require(const char *meaning, int ntypes) const {
    if (given()) return;
    error->all(
        FLERR,
        engine::error_text(fmt::format(
            "{}: property {} ({}) is missing; allowed: 'fix ID all property/global {} peratomtypepair {}' "
            "and {} values",
            model, name_, meaning, name_, ntypes, ntypes * ntypes)));
  }

private:
  const char *name_;
  FixPropertyGlobal *fix_;
};

// The engine's pair style keeps what it does behind a private pointer. An explicit instantiation may name a
// private member; its friend hands it out.
template <auto Member>
struct ProxyAccess {
  friend auto &style_of(LAMMPS_NS::PairGranProxy &proxy) { return proxy.*Member; }
};
auto &style_of(LAMMPS_NS::PairGranProxy &proxy);
template struct ProxyAccess<&LAMMPS_NS::PairGranProxy::impl>;

} // namespace

LAMMPS_NS::PairGran *gran_pair(LAMMPS *lmp) {
  return dynamic_cast<LAMMPS_NS::PairGran *>(lmp->force->pair_match("gran", 1));
}

PairContacts *pair_contacts(LAMMPS *lmp) {
  auto *proxy = dynamic_cast<LAMMPS_NS::PairGranProxy *>(gran_pair(lmp));
  return proxy == nullptr ? nullptr : dynamic_cast<PairContacts *>(style_of(*proxy));
}

const ContactSource *contact_source(LAMMPS *lmp) {
  const PairContacts *contacts = pair_contacts(lmp);
  return contacts != nullptr && contacts->has_table() ? contacts : nullptr;
}

void PairContacts::begin(LAMMPS_NS::PairGran *pair, FrictionModel friction_model, physics::Cap cap) {
  pair_ = pair;
  table_ = nullptr;
  wall_tables_.clear();
  clumps_.find(*lmp_->modify);
  friction_model_ = friction_model;
  cap_ = cap;
  meshes_ = false;
  for (int n = 0; n < lmp_->modify->nfix; ++n)
    if (const auto *wall = dynamic_cast<const LAMMPS_NS::FixWallGran *>(lmp_->modify->fix[n]))
      meshes_ = meshes_ || wall->is_mesh_wall();
}

double PairContacts::mass(int i) const {
  const LAMMPS_NS::Atom &atom = *lmp_->atom;
  if (atom.mask[i] & pair_->freeze_group_bit()) return std::numeric_limits<double>::infinity();
  const double own =
      pair_->fr_pair() != nullptr && pair_->mr_pair()[i] > 0.0 ? pair_->mr_pair()[i] : atom.rmass[i];
  return clumps_.mass_of(atom, i, own);
}

physics::Dashpots PairContacts::wall_dashpots(int i) const {
  const LAMMPS_NS::Atom &atom = *lmp_->atom;
  physics::Dashpots all;
  if (meshes_) all.sum = std::numeric_limits<double>::infinity();
  for (const ContactTable *wall : wall_tables_) {
    physics::Dashpots strongest;
    for (int type = 1; type <= atom.ntypes; ++type) {
      const physics::LinearContact &law = wall->at(atom.type[i], type).normal;
      physics::Dashpots one;
      one.add(law.stiffness, law.damping_coefficient(mass(i)));
      strongest = {std::max(strongest.sum, one.sum), std::max(strongest.stiffest, one.stiffest)};
    }
    all.add(strongest);
  }
  return all;
}

const LAMMPS_NS::NeighList *PairContacts::contact_list() const { return pair_->list; }

// The engine builds the tangential model before any other that asks for history: its spring comes first.
const double *PairContacts::tangential_spring(int i, int jj) const {
  return pair_->listgranhistory->firstdouble[i] + static_cast<std::ptrdiff_t>(pair_->dnum()) * jj;
}

void ContactTable::read(LAMMPS *lmp, int ntypes, const ContactSettings &settings, bool is_wall) {
  TypePairProperty kn(lmp, "kn", ntypes);
  TypePairProperty kt(lmp, "kt", ntypes);
  TypePairProperty ct(lmp, "gammat_abs", ntypes);
  struct Input {
    const char *property, *meaning;
  };
  const Input input =
      settings.damping == DampingInput::coefficient
          ? Input{"gamman_abs", "normal damping coefficient, N s/m, keyword damping coefficient"}
      : settings.damping == DampingInput::ratio
          ? Input{"dampingRatio", "damping ratio D, keyword damping ratio"}
          : Input{"coefficientRestitution", "restitution e, keyword damping restitution"};
  const bool restitution = settings.damping == DampingInput::restitution;
  TypePairProperty c(lmp, input.property, ntypes);
  TypePairProperty mu(lmp, friction_property, ntypes);
  kn.require("normal stiffness, N/m", ntypes);
  c.require(input.meaning, ntypes);

  stride_ = static_cast<std::size_t>(ntypes) + 1;
  coefficients_.assign(stride_ * stride_, {});
  for (int i = 1; i <= ntypes; ++i)
    for (int j = 1; j <= ntypes; ++j) {
      ContactCoefficients &p =
          coefficients_[static_cast<std::size_t>(i) * stride_ + static_cast<std::size_t>(j)];
      p = ContactCoefficients::with_defaults(
          settings.normal(kn(i, j, false), c(i, j, !restitution, restitution ? 1.0 : infinity)));
      if (kt.given()) p.tangential_stiffness = kt(i, j, true);
      if (ct.given()) p.set_tangential_damping(ct(i, j, true));
      if (mu.given()) p.friction = mu(i, j, true);
    }
  if (PairContacts *contacts = pair_contacts(lmp)) is_wall ? contacts->take_wall(this) : contacts->take(this);
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

} // namespace drumlin
