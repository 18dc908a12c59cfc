// Adapter of the core's rolling resistance to LIGGGHTS's contact models: `rolling_friction epsd2` together
// with `model hooke/transition`. The engine's own model of that name differs: see the style's page. (LIGGGHTS
// includes this file several times; the first branch only announces the model.)
#ifdef ROLLING_MODEL
ROLLING_MODEL(ROLLING_SPRING, rolling_spring, 22)
#else
#ifndef DRUMLIN_ROLLING_MODEL_SPRING_H
#define DRUMLIN_ROLLING_MODEL_SPRING_H

#include "contact_models.h"
#include "global_properties.h"
#include "rolling_model_base.h"
#include "update.h"

#include <algorithm>

#include "liggghts/coupled_contacts.h"
#include "physics/laws/rolling_law.h"

namespace LIGGGHTS {
namespace ContactModels {

/// kt and the normal force come from the normal model; the spring torque is three values of the contact
/// history, named as those of the engine's epsd2.
template <>
class RollingModel<ROLLING_SPRING> : public RollingModelBase {
public:
  RollingModel(LAMMPS *lmp, IContactHistorySetup *hsetup, ContactModelBase *model)
      : RollingModelBase(lmp, hsetup, model), model_(model),
        spring_offset_(drumlin::announce(*hsetup, drumlin::Remembered::rolling_spring)) {}

  void registerSettings(Settings &settings) override {
    settings.registerOnOff("torsionTorque", torsion_, false);
  }
  void postSettings(IContactHistorySetup *, ContactModelBase *) override {}

  void connectToProperties(PropertyRegistry &registry) override {
    registry.registerProperty("coeffRollFrict", &MODEL_PARAMS::createCoeffRollFrict);
    registry.connect("coeffRollFrict", coefficient_, "rolling_model epsd2");
    coupled_.find(lmp, *model_);
  }

  void surfacesIntersect(SurfacesIntersectData &sidata, ForceData &i_forces, ForceData &j_forces) override {
    namespace physics = drumlin::physics;
    if (sidata.contact_flags) *sidata.contact_flags |= CONTACT_ROLLING_MODEL;
    const bool moves = sidata.computeflag && sidata.shearupdate; // not in a set-up, nor for computes
    const double *w = sidata.omega_i;
    const double still[3] = {0.0, 0.0, 0.0};
    const double *wj = sidata.is_wall ? still : sidata.omega_j;
    const double radius = sidata.is_wall ? sidata.radi : physics::effective_radius(sidata.radi, sidata.radj);
    double *spring = sidata.contact_history + spring_offset_;
    const physics::Rolling rolling =
        physics::rolling_of(sidata.kt, coefficient_[sidata.itype][sidata.jtype], radius,
                            torsion_ ? physics::Resisted::all : physics::Resisted::rolling);
    const physics::RollingStep step =
        physics::rolling_step(rolling, sidata.Fn, {sidata.en[0], sidata.en[1], sidata.en[2]},
                              {w[0] - wj[0], w[1] - wj[1], w[2] - wj[2]}, {spring[0], spring[1], spring[2]},
                              drumlin::time_of_spring(sidata, spring, moves, update->dt));
    if (moves) std::copy(step.spring.begin(), step.spring.end(), spring);
    if (auto *rubbing = coupled_.rubbing(sidata)) {
      rubbing->rolling = rolling;
      rubbing->roll = step.torque;
      rubbing->rolling_spring = spring;
    }
    const double share = sidata.is_wall ? sidata.area_ratio : 1.0;
    for (std::size_t a = 0; a < 3; ++a) {
      i_forces.delta_torque[a] += share * step.torque[a];
      if (!sidata.is_wall) j_forces.delta_torque[a] -= step.torque[a];
    }
  }

  void surfacesClose(SurfacesCloseData &scdata, ForceData &, ForceData &) override {
    if (scdata.contact_flags) *scdata.contact_flags &= ~CONTACT_ROLLING_MODEL;
    if (scdata.contact_history != nullptr) std::fill_n(scdata.contact_history + spring_offset_, 3, 0.0);
  }

  void beginPass(SurfacesIntersectData &, ForceData &, ForceData &) override {}
  void endPass(SurfacesIntersectData &, ForceData &, ForceData &) override {}

private:
  ContactModelBase *model_;
  drumlin::CoupledContacts coupled_;
  double **coefficient_ = nullptr; // by types
  int spring_offset_;              // in the contact history
  bool torsion_ = false;
};

} // namespace ContactModels
} // namespace LIGGGHTS

#endif
#endif
