#pragma once
// Coefficients of the contact law for each pair of types, read from the deck's `fix property/global` values.

#include "contact/contact_settings.h"
#include "contact/contact_source.h"
#include "fixes/fix_clump.h"
#include "lammps.h"
#include "physics/contact_law.h"

#include <cstddef>
#include <vector>

namespace LAMMPS_NS {
class PairGran;
}

namespace drumlin {

/// With a distance factor above 1 the engine calls surfacesClose() for a contact that has just ended.
constexpr double contact_distance_factor = 1.01;

/// Name in the contact history of the normal force that acted in the step, N, under second-order stepping.
constexpr const char *final_force_name = "normal_force_before";

/// The pair style gran, or the one part of a hybrid pair style that is gran; nullptr if there is none, or
/// more than one.
LAMMPS_NS::PairGran *gran_pair(LAMMPS_NS::LAMMPS *lmp);

/// Table over pairs of types. Defaults where the deck gives nothing: kt = 2/7 kn, tangential damping = c / 2.
class ContactTable {
public:
  ContactTable() = default;
  ContactTable(const ContactTable &) = delete;
  ContactTable &operator=(const ContactTable &) = delete;

  /// Reads and checks the properties; ends the run with one line that names property, types, value and what
  /// is allowed. \param is_wall the table is a wall's, not the pair style's: see PairContacts
  void read(LAMMPS_NS::LAMMPS *lmp, int ntypes, const ContactSettings &settings, bool is_wall);

  const ContactCoefficients &at(int itype, int jtype) const {
    return coefficients_[static_cast<std::size_t>(itype) * stride_ + static_cast<std::size_t>(jtype)];
  }

private:
  std::vector<ContactCoefficients> coefficients_;
  std::size_t stride_ = 0;
};

/// What the pair style, which derives from it, tells walls, helper and fixes of itself. It collects the
/// tables anew in the initialization of each run: the pair style's own first, then those of the walls.
class PairContacts : public ContactSource {
public:
  explicit PairContacts(LAMMPS_NS::LAMMPS *lmp) : lmp_(lmp) {}

  const physics::LinearContact &law(int itype, int jtype) const override {
    return table_->at(itype, jtype).normal;
  }
  double mass(int i) const override;
  physics::Dashpots wall_dashpots(int i) const override;
  FrictionModel friction_model() const override { return friction_model_; }
  physics::Friction friction(int itype, int jtype, double c) const override {
    return table_->at(itype, jtype).tangential(c, cap_);
  }
  const LAMMPS_NS::NeighList *contact_list() const override;
  const double *tangential_spring(int i, int jj) const override;

  void take(const ContactTable *table) { table_ = table; }
  void take_wall(const ContactTable *table) { wall_tables_.push_back(table); }
  bool has_table() const { return table_ != nullptr; }

protected:
  ~PairContacts() = default;
  /// \param cap what limits friction with a tangential spring
  void begin(LAMMPS_NS::PairGran *pair, FrictionModel friction_model, physics::Cap cap);

private:
  LAMMPS_NS::LAMMPS *lmp_;
  LAMMPS_NS::PairGran *pair_ = nullptr;
  const ContactTable *table_ = nullptr;
  std::vector<const ContactTable *> wall_tables_;
  LAMMPS_NS::Clumps clumps_;
  bool meshes_ = false;
  FrictionModel friction_model_ = FrictionModel::none;
  physics::Cap cap_ = physics::Cap::spring;
};

/// That of this engine instance; nullptr if the pair style is another.
PairContacts *pair_contacts(LAMMPS_NS::LAMMPS *lmp);

/// Makes the property coefficientFriction, with 0.5 for all pairs of types, if the deck gives none: the
/// tangential models insist on one. One that is given is checked, which the engine does not do.
void provide_friction_default(LAMMPS_NS::LAMMPS *lmp, int ntypes);

} // namespace drumlin
