#pragma once
// A combination of the engine's contact models that reports to the contact observers.

#include "contact_models.h"

#include "contact/contact_observer.h"
#include "liggghts/contact_table.h"
#include "liggghts/coupled_contacts.h"

#include <algorithm>

namespace drumlin {

/// A combination of models that decks and restart files know by another number than that of its own models.
template <class Style, int64_t Number>
struct NamedStyle : Style {
  static const int64_t HASHCODE = Number;
};

/// The tangential model has a spring.
template <class Style>
constexpr bool has_spring = Style::TANGENTIAL == LIGGGHTS::ContactModels::TANGENTIAL_HISTORY ||
                            Style::TANGENTIAL == LIGGGHTS::ContactModels::TANGENTIAL_COULOMB;

/// What the engine calls for each contact: its models, then the observers.
/// \tparam Contact parameters of the law of the style's normal model
template <class Style, class Contact>
class ObservedContact : public LIGGGHTS::ContactModels::ContactModel<Style> {
  using Base = LIGGGHTS::ContactModels::ContactModel<Style>;

public:
  using Base::Base;

  void connectToProperties(PropertyRegistry &registry) {
    Base::connectToProperties(registry);
    final_force_offset_ = this->get_history_offset(final_force_name);
    coupled_.find(registry.getLAMMPS(), *this);
    observers_.find(*registry.getLAMMPS()->modify);
  }

  void surfacesIntersect(LIGGGHTS::ContactModels::SurfacesIntersectData &contact,
                         LIGGGHTS::ContactModels::ForceData &i_forces,
                         LIGGGHTS::ContactModels::ForceData &j_forces) {
    Base::surfacesIntersect(contact, i_forces, j_forces);
    if (contact.computeflag && observers_.any()) tell(contact, i_forces, j_forces);
  }

private:
  [[gnu::noinline]] void tell(const LIGGGHTS::ContactModels::SurfacesIntersectData &contact,
                              const LIGGGHTS::ContactModels::ForceData &i_forces,
                              const LIGGGHTS::ContactModels::ForceData &j_forces) const {
    const typename Contact::Law law = Contact::of_secant(contact.kn, contact.gamman, contact.deltan);
    const bool second_order = final_force_offset_ >= 0;
    ContactRecord record = record_of_law(law, contact.deltan, second_order);
    record.i = contact.i;
    record.j = contact.is_wall ? -1 : contact.j;
    record.radius = contact.is_wall ? contact.radi : std::min(contact.radi, contact.radj);
    record.share = contact.is_wall ? contact.area_ratio : 1.0;
    if (Style::TANGENTIAL != LIGGGHTS::ContactModels::TANGENTIAL_OFF)
      record.tangential_dashpot = contact.gammat;
    if (has_spring<Style>) { // which is first in the history
      record.tangential_stiffness = contact.kt;
      record.spring = contact.contact_history;
    }
    if (Style::ROLLING == LIGGGHTS::ContactModels::ROLLING_SPRING) {
      const double r_eff =
          contact.is_wall ? contact.radi : physics::effective_radius(contact.radi, contact.radj);
      record.rolling_stiffness = contact.kt * r_eff * r_eff;
    }
    record.normal_force = contact.Fn;
    if (second_order) record.final_force = contact.contact_history + final_force_offset_;
    if (const auto *coupled = coupled_.contact(contact)) record.change = &coupled->change;
    double along = 0.0;
    for (std::size_t a = 0; a < 3; ++a)
      along += i_forces.delta_F[a] * contact.en[a];
    for (std::size_t a = 0; a < 3; ++a) {
      record.normal[a] = contact.en[a];
      if (contact.is_wall) record.wall_velocity[a] = contact.v_j[a];
      record.tangential_force[a] = i_forces.delta_F[a] - along * contact.en[a];
      record.torque_i[a] = i_forces.delta_torque[a];
      record.torque_j[a] = j_forces.delta_torque[a];
    }
    observers_.tell(record);
  }

  ContactObservers observers_;
  CoupledContacts coupled_;
  int final_force_offset_ = -1;
};

} // namespace drumlin
