#include "liggghts/pair_source.h"

#include "engine.h"
#include "fix_rigid.h"
#include "fix_wall_gran.h"
#include "global_properties.h"
#include "pair_gran_proxy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;

/// Name and meaning of the property that gives the normal damping.
struct DampingProperty {
  const char *name, *meaning;
};
constexpr DampingProperty damping_property(DampingInput input) {
  switch (input) {
  case DampingInput::coefficient:
    return {"gamman_abs", "normal damping coefficient, N s/m, keyword damping coefficient"};
  case DampingInput::ratio:
    return {"dampingRatio", "damping ratio D, keyword damping ratio"};
  case DampingInput::restitution:
    break;
  }
  return {"coefficientRestitution", "restitution e, keyword damping restitution"};
}

// The engine's pair style has its implementation behind a private pointer. C++ allows an explicit
// instantiation to name a private member as a template argument; the friend function of the instance gives
// access to it.
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

PairSource *pair_source(LAMMPS *lmp) {
  auto *proxy = dynamic_cast<LAMMPS_NS::PairGranProxy *>(gran_pair(lmp));
  return proxy == nullptr ? nullptr : dynamic_cast<PairSource *>(style_of(*proxy));
}

ContactSource *contact_source(LAMMPS *lmp) {
  PairSource *contacts = pair_source(lmp);
  return contacts != nullptr && contacts->has_table() ? contacts : nullptr;
}

std::string law_name(LAMMPS *lmp) {
  const PairSource *contacts = pair_source(lmp);
  return contacts == nullptr ? "" : contacts->law_name();
}

void PairSource::begin(LAMMPS_NS::PairGran *pair, const ContactSettings &settings) {
  pair_ = pair;
  table_.reset();
  linear_table_ = nullptr;
  wall_tables_.clear();
  clumps_.find(*lmp_->modify);
  settings_ = settings;
  places_ = settings.places(history_order);
  meshes_ = false;
  for (const LAMMPS_NS::Fix *fix : engine::fixes(lmp_->modify))
    if (const auto *wall = dynamic_cast<const LAMMPS_NS::FixWallGran *>(fix))
      meshes_ = meshes_ || wall->is_mesh_wall();
}

double PairSource::mass(int i) const {
  const LAMMPS_NS::Atom &atom = *lmp_->atom;
  if (atom.mask[i] & pair_->freeze_group_bit()) return std::numeric_limits<double>::infinity();
  const double own =
      pair_->fr_pair() != nullptr && pair_->mr_pair()[i] > 0.0 ? pair_->mr_pair()[i] : atom.rmass[i];
  return clumps_.mass_of(atom, i, own);
}

physics::Dashpots PairSource::wall_dashpots(int i) const {
  const LAMMPS_NS::Atom &atom = *lmp_->atom;
  physics::Dashpots all;
  if (meshes_) all.sum = std::numeric_limits<double>::infinity();
  for (const AnyTable &wall : wall_tables_) {
    physics::Dashpots strongest;
    for (int type = 1; type <= atom.ntypes; ++type) {
      physics::Dashpots one;
      std::visit(
          [&](const auto *table) {
            const auto &contact = table->at(atom.type[i], type).contact;
            const double r = atom.radius[i];
            add_dashpot(one, contact, mass(i), radius_for<std::decay_t<decltype(contact)>>(r), 2.0 * r);
          },
          wall);
      strongest.take_greatest(one);
    }
    all.add(strongest);
  }
  return all;
}

const LAMMPS_NS::NeighList *PairSource::contact_list() const { return pair_->list; }

const double *PairSource::history(int i, int jj) const {
  if (pair_->listgranhistory == nullptr) return nullptr;
  return pair_->listgranhistory->firstdouble[i] + static_cast<std::ptrdiff_t>(pair_->dnum()) * jj;
}

const LAMMPS_NS::Atom &PairSource::balls() const { return *lmp_->atom; }

DampingProperties::DampingProperties(LAMMPS *lmp, const std::string &command, int ntypes,
                                     const ContactSettings &settings)
    : damping_(lmp, command, damping_property(settings.damping).name, ntypes),
      tangential_(lmp, command, "gammat_abs", ntypes), friction_(lmp, command, "coefficientFriction", ntypes),
      rolling_(lmp, command, "coefficientRollingFriction", ntypes),
      suction_(lmp, command, "suction", ntypes) {
  damping_.require(damping_property(settings.damping).meaning);
  if (settings.rolling) rolling_.require("rolling resistance mu_r");
}

} // namespace drumlin
