#pragma once
// Where LIGGGHTS's contact models find a contact that is solved for together with others, or begins.

#include "contact/fix_stepping.h"
#include "liggghts/pair_source.h"

#include "contact_interface.h"

namespace drumlin {

/// Time, s, for which a spring in the contact history is stretched in a step. It has no length before the
/// first step of a contact. \param spring three numbers \param moves false in the set-up of a run
inline double time_of_spring(const LIGGGHTS::ContactModels::SurfacesIntersectData &data, const double *spring,
                             bool moves, double dt) {
  if (!moves) return 0.0;
  const bool begins = spring[0] == 0.0 && spring[1] == 0.0 && spring[2] == 0.0;
  return begins ? physics::time_in_contact(data.deltan, -data.vn, dt) : dt;
}

/// The coupled contacts of a contact model under `stepping second`. None under `stock` and with normal models
/// of the engine.
class CoupledContacts {
public:
  /// To be called when all models have announced their history. \tparam Model has get_history_offset()
  template <class Model>
  void find(LAMMPS_NS::LAMMPS *lmp, Model &model) {
    offset_ = model.get_history_offset(force_name);
    stepping_ = offset_ < 0 ? nullptr : LAMMPS_NS::FixStepping::find(lmp);
  }

  /// The coupled contact that the normal model has just made of a contact; nullptr if it has not.
  LAMMPS_NS::FixStepping::Coupled *contact(const LIGGGHTS::ContactModels::SurfacesIntersectData &data) const {
    if (stepping_ == nullptr || !data.computeflag) return nullptr;
    return stepping_->coupled_at(data.contact_history + offset_);
  }

  /// The contact, if it begins in this step; else nullptr.
  LAMMPS_NS::FixStepping::Begun *begun(const LIGGGHTS::ContactModels::SurfacesIntersectData &data) const {
    if (stepping_ == nullptr || !data.computeflag) return nullptr;
    return stepping_->begun_at(data.contact_history + offset_);
  }
  /// Where the friction and the rolling resistance of such a contact are described, of either kind; nullptr
  /// for others.
  LAMMPS_NS::FixStepping::Rubbing *rubbing(const LIGGGHTS::ContactModels::SurfacesIntersectData &data) const {
    if (auto *coupled = contact(data)) return coupled;
    return begun(data);
  }
  /// Not for `stock`.
  LAMMPS_NS::FixStepping &stepping() const { return *stepping_; }

private:
  LAMMPS_NS::FixStepping *stepping_ = nullptr;
  int offset_ = -1; // of the normal force in the contact history
};

} // namespace drumlin
