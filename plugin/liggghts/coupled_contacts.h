#pragma once
// Where LIGGGHTS's contact models find a contact that is solved for together with others.

#include "contact/fix_stepping.h"
#include "liggghts/contact_table.h"

#include "contact_interface.h"

namespace drumlin {

/// The coupled contacts of a contact model under `stepping second`. None under `stock` and with normal models of the
/// engine.
class CoupledContacts {
public:
  /// To be called when all models have announced their history. \tparam Model has get_history_offset()
  template <class Model>
  void find(LAMMPS_NS::LAMMPS *lmp, Model &model) {
    offset_ = model.get_history_offset(final_force_name);
    stepping_ = offset_ < 0 ? nullptr : LAMMPS_NS::FixStepping::find(lmp);
  }

  /// The coupled contact that the normal model has just made of a contact; nullptr if it has not.
  LAMMPS_NS::FixStepping::Coupled *contact(const LIGGGHTS::ContactModels::SurfacesIntersectData &data) const {
    if (stepping_ == nullptr || !data.computeflag) return nullptr;
    return stepping_->coupled_at(data.contact_history + offset_);
  }

private:
  LAMMPS_NS::FixStepping *stepping_ = nullptr;
  int offset_ = -1; // of the normal force in the contact history
};

} // namespace drumlin
