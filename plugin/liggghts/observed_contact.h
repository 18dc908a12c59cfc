#pragma once
// A combination of the engine's contact models that reports to the contact observers.

#include "contact_models.h"

#include "contact/contact_observer.h"
#include "liggghts/pair_source.h"
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
constexpr bool has_spring = Style::TANGENTIAL == LIGGGHTS::ContactModels::TANGENTIAL_SPRING ||
                            Style::TANGENTIAL == LIGGGHTS::ContactModels::TANGENTIAL_COULOMB;

/// What the engine calls for each contact: its models, then the observers.
/// \tparam Contact parameters of the law of the style's normal model
template <class Style, class Contact>
class ObservedContact : public LIGGGHTS::ContactModels::ContactModel<Style>, public WithNormalModel<Contact> {
  using Base = LIGGGHTS::ContactModels::ContactModel<Style>;

public:
  using Base::Base;

  void connectToProperties(PropertyRegistry &registry) {
    Base::connectToProperties(registry);
    final_force_offset_ = this->get_history_offset(force_name);
    coupled_.find(registry.getLAMMPS(), *this);
    observers_.find(*registry.getLAMMPS()->modify);
  }

  void surfacesIntersect(LIGGGHTS::ContactModels::SurfacesIntersectData &contact,
                         LIGGGHTS::ContactModels::ForceData &i_forces,
                         LIGGGHTS::ContactModels::ForceData &j_forces) {
    Base::surfacesIntersect(contact, i_forces, j_forces);
    if (contact.computeflag && observers_.any()) tell(contact, i_forces, j_forces);
    if (auto *begun = coupled_.begun(contact)) close_friction(*begun, contact, i_forces, j_forces);
  }

private:
  /// Replaces friction and rolling resistance of a contact that begins by those of the closing half kick.
  [[gnu::noinline]] void close_friction(LAMMPS_NS::FixStepping::Begun &begun,
                                        const LIGGGHTS::ContactModels::SurfacesIntersectData &contact,
                                        LIGGGHTS::ContactModels::ForceData &i_forces,
                                        LIGGGHTS::ContactModels::ForceData &j_forces) const {
    const auto closing = coupled_.stepping().close_friction(begun);
    const physics::Vec3 moment = physics::cross(begun.normal, closing.friction);
    const double push = begun.share * begun.step.kick;
    for (std::size_t a = 0; a < 3; ++a) {
      i_forces.delta_F[a] = push * contact.en[a] + closing.friction[a];
      i_forces.delta_torque[a] = closing.rolling[a] - begun.arm_i * moment[a];
      if (contact.is_wall) continue;
      j_forces.delta_F[a] = -i_forces.delta_F[a];
      j_forces.delta_torque[a] = -closing.rolling[a] - begun.arm_j * moment[a];
    }
  }

  static physics::Vec3 tangential_part(const LIGGGHTS::ContactModels::ForceData &forces,
                                       const double *normal) {
    double along = 0.0;
    for (std::size_t a = 0; a < 3; ++a)
      along += forces.delta_F[a] * normal[a];
    physics::Vec3 part{};
    for (std::size_t a = 0; a < 3; ++a)
      part[a] = forces.delta_F[a] - along * normal[a];
    return part;
  }

  [[gnu::noinline]] void tell(const LIGGGHTS::ContactModels::SurfacesIntersectData &contact,
                              const LIGGGHTS::ContactModels::ForceData &i_forces,
                              const LIGGGHTS::ContactModels::ForceData &j_forces) const {
    const bool second_order = final_force_offset_ >= 0;
    ContactRecord record = record_of_law(this->normal_model->law_of(contact), contact.deltan, second_order);
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
    record.tangential_force = tangential_part(i_forces, contact.en);
    for (std::size_t a = 0; a < 3; ++a) {
      record.normal[a] = contact.en[a];
      if (contact.is_wall) record.wall_velocity[a] = contact.v_j[a];
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
