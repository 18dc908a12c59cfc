#pragma once
// Coefficients of the contact law for each pair of types, read from the deck's `fix property/global` values.

#include "contact/contact_history.h"
#include "contact/contact_settings.h"
#include "contact/contact_source.h"
#include "fixes/fix_clump.h"
#include "contact_interface.h"
#include "lammps.h"
#include "liggghts/type_property.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace LAMMPS_NS {
class PairGran;
}

namespace drumlin {

/// With a distance factor above 1 the engine calls surfacesClose() for a contact that has just ended.
constexpr double contact_distance_factor = 1.01;

/// The order in which a contact's numbers are stored, which restart files have.
constexpr std::array<Remembered, 6> history_order{Remembered::spring,    Remembered::rolling_spring,
                                                  Remembered::stiffness, Remembered::force,
                                                  Remembered::touches,   Remembered::memory};
/// Name of the normal force in a contact's history.
constexpr const char *force_name = numbers_of(Remembered::force).names[0];

/// Tells the engine that contacts have a history.
inline void announce(LIGGGHTS::IContactHistorySetup &history, Remembered what) {
  const RememberedNumbers &numbers = numbers_of(what);
  for (std::size_t n = 0; n < numbers.count(); ++n)
    history.add_history_value(numbers.names[n], numbers.turns_round ? "1" : "0");
}

/// Effective mass, kg, with the engine's formula: its rounding differs from that of
/// physics::effective_mass().
inline double engine_effective_mass(double mi, double mj) { return mi * mj / (mi + mj); }

/// The pair style gran, or the one part of a hybrid pair style that is gran; nullptr if there is none, or
/// more than one.
LAMMPS_NS::PairGran *gran_pair(LAMMPS_NS::LAMMPS *lmp);

/// Reads the parameters of a law from the properties of a deck.
template <class Contact>
class LawProperties {
public:
  /// Ends the run if a property is missing.
  LawProperties(LAMMPS_NS::LAMMPS *lmp, const std::string &command, int ntypes) {
    for (const auto &p : Contact::parameters()) {
      if (p.property == nullptr) continue;
      of_pairs_.emplace_back(lmp, command, p.property, ntypes);
      if (!p.of_friction) of_pairs_.back().require(meaning_of(p));
    }
    for (const physics::MaterialParameter &p : Contact::material()) {
      of_types_.emplace_back(lmp, command, p.property, ntypes, TypeProperty::Of::type);
      of_types_.back().require(meaning_of(p));
    }
  }

  /// For a pair of types; damping and transition are not set.
  Contact operator()(int i, int j) {
    Contact contact;
    if constexpr (constexpr std::size_t numbers = Contact::material().size(); numbers > 0) {
      const auto of_type = [this](int type) {
        std::array<double, numbers> values{};
        for (std::size_t n = 0; n < numbers; ++n)
          values[n] = of_types_[n](type, Contact::material()[n].range);
        return values;
      };
      contact.set_material(of_type(i), of_type(j));
    }
    for (const bool of_friction : {false, true}) {
      if (of_friction) contact.set_defaults();
      auto property = of_pairs_.begin();
      for (const auto &p : Contact::parameters()) {
        if (p.property == nullptr) continue;
        if (p.of_friction == of_friction && property->given()) contact.*p.value = (*property)(i, j, p.range);
        ++property;
      }
    }
    return contact;
  }

private:
  std::vector<TypeProperty> of_pairs_, of_types_;
};

/// The properties of all laws: damping, tangential damping, friction and suction.
class DampingProperties {
public:
  DampingProperties(LAMMPS_NS::LAMMPS *lmp, const std::string &command, int ntypes,
                    const ContactSettings &settings);

  /// Sets them for a pair of types. Tangential damping is c / 2 where the deck gives none.
  template <class Contact>
  void set(ContactCoefficients<Contact> &p, int i, int j, const ContactSettings &settings) {
    settings.set_damping(p.contact, damping_(i, j, settings.damping_range(p.contact)));
    if (tangential_.given()) p.set_tangential_damping(tangential_(i, j, Range::non_negative));
    if (settings.tangential != FrictionModel::none) p.friction = default_friction;
    if (friction_.given()) p.friction = friction_(i, j, Range::non_negative);
    if (rolling_.given()) p.rolling = rolling_(i, j, Range::non_negative);
    if (suction_.given()) p.suction = suction_(i, j, Range::non_negative);
  }

private:
  static constexpr double default_friction = 0.5;

  TypeProperty damping_, tangential_, friction_, rolling_, suction_;
};

/// Access of walls, FixStepping and fixes to the pair style, which derives from it. It collects the tables in
/// the initialization of each run: the pair style's own first, then those of the walls.
class PairSource : public ContactSource {
public:
  explicit PairSource(LAMMPS_NS::LAMMPS *lmp) : lmp_(lmp) {}

  AnyTable table() const override { return *table_; }
  CoefficientTable<physics::LinearContact> *linear_table() override { return linear_table_; }
  double mass(int i) const override;
  physics::Dashpots wall_dashpots(int i) const override;
  FrictionModel friction_model() const override { return settings_.tangential; }
  const LAMMPS_NS::NeighList *contact_list() const override;
  const double *history(int i, int jj) const override;
  const HistoryPlaces &places() const override { return places_; }

  template <class Contact>
  void take(CoefficientTable<Contact> &table) {
    table_ = &table;
    if constexpr (std::is_same_v<Contact, physics::LinearContact>) linear_table_ = &table;
  }
  void take_wall(const AnyTable &table) { wall_tables_.push_back(table); }
  bool has_table() const { return table_.has_value(); }

protected:
  ~PairSource() = default;
  void begin(LAMMPS_NS::PairGran *pair, const ContactSettings &settings);
  const LAMMPS_NS::Atom &balls() const override;
  physics::Cap cap() const override { return settings_.cap; }

private:
  LAMMPS_NS::LAMMPS *lmp_;
  LAMMPS_NS::PairGran *pair_ = nullptr;
  std::optional<AnyTable> table_;
  CoefficientTable<physics::LinearContact> *linear_table_ = nullptr;
  std::vector<AnyTable> wall_tables_;
  LAMMPS_NS::Clumps clumps_;
  bool meshes_ = false;
  ContactSettings settings_;
  HistoryPlaces places_;
};

/// The PairSource of this engine instance; nullptr if it has another pair style.
PairSource *pair_source(LAMMPS_NS::LAMMPS *lmp);

/// Reads and checks the properties; ends the run with one line that names property, types, value and what is
/// allowed. The pair style knows the table from then on. \param is_wall the table is a wall's, not the pair
/// style's: see PairSource
template <class Contact>
void read_table(CoefficientTable<Contact> &table, LAMMPS_NS::LAMMPS *lmp, int ntypes,
                const ContactSettings &settings, bool is_wall) {
  const std::string command = std::string("model ") + Contact::name;
  LawProperties<Contact> law(lmp, command, ntypes);
  DampingProperties damping(lmp, command, ntypes, settings);
  table.resize(ntypes);
  for (int i = 1; i <= ntypes; ++i)
    for (int j = 1; j <= ntypes; ++j) {
      ContactCoefficients<Contact> &p = table.at(i, j);
      p.contact = law(i, j);
      damping.set(p, i, j, settings);
    }
  if (PairSource *contacts = pair_source(lmp)) is_wall ? contacts->take_wall(&table) : contacts->take(table);
}

} // namespace drumlin
