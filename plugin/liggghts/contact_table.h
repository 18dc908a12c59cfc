#pragma once
// Coefficients of the contact law for each pair of types, read from the deck's `fix property/global` values.

#include "contact/contact_source.h"
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

/// The pair style gran, or the one part of a hybrid pair style that is gran; nullptr if there is none, or more than one.
LAMMPS_NS::PairGran *gran_pair(LAMMPS_NS::LAMMPS *lmp);

/// What a contact of two types needs in the inner loop.
struct ContactCoefficients {
  physics::LinearContact normal;
  double tangential_stiffness;     ///< kt, N/m
  double tangential_damping;       ///< absolute tangential damping coefficient, N s/m, if the deck gives one
  double tangential_damping_share; ///< else the share of the normal coefficient c that is used
};

/// Table over pairs of types. Defaults where the deck gives nothing: kt = 2/7 kn, tangential damping = c / 2.
class ContactTable {
public:
  ContactTable() = default;
  ContactTable(const ContactTable &) = delete;
  ContactTable &operator=(const ContactTable &) = delete;
  ~ContactTable();

  /// Reads and checks the properties; ends the run with one line that names property, types, value and what
  /// is allowed. \param is_wall the pair style's table, not a wall's, is the one that fixes may ask for
  /// (contact_source.h)
  void read(LAMMPS_NS::LAMMPS *lmp, int ntypes, physics::Transition transition, physics::Damping damping,
            bool is_wall);

  const ContactCoefficients &at(int itype, int jtype) const {
    return coefficients_[static_cast<std::size_t>(itype) * stride_ + static_cast<std::size_t>(jtype)];
  }

private:
  std::vector<ContactCoefficients> coefficients_;
  std::size_t stride_ = 0;
};

/// Tells the pair style's table which tangential model acts beside it, and what limits one with a spring.
void set_friction_model(FrictionModel acting, physics::Cap cap);

/// Makes the property coefficientFriction, with 0.5 for all pairs of types, if the deck gives none: the
/// tangential models insist on one. One that is given is checked, which the engine does not do.
void provide_friction_default(LAMMPS_NS::LAMMPS *lmp, int ntypes);

} // namespace drumlin
