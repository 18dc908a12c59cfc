// Adapter of the core's Coulomb friction, whose force never exceeds its limit, to LIGGGHTS's contact models:
// `tangential coulomb`. (LIGGGHTS includes this file several times; the first branch only announces the
// model.)
#ifdef TANGENTIAL_MODEL
TANGENTIAL_MODEL(TANGENTIAL_COULOMB, coulomb, 21)
#else
#ifndef DRUMLIN_TANGENTIAL_MODEL_COULOMB_H
#define DRUMLIN_TANGENTIAL_MODEL_COULOMB_H

#include "contact_models.h"
#include "global_properties.h"
#include "tangential_model_base.h"
#include "update.h"

#include <algorithm>

#include "liggghts/coupled_contacts.h"
#include "physics/laws/friction_law.h"

namespace LIGGGHTS {
namespace ContactModels {

/// Spring and dashpot in parallel, in series with a slider: physics::Cap::coulomb. kt, ct and the normal
/// force come from the normal model; the spring is three values of the contact history, as in the engine's
/// `history`.
template <>
class TangentialModel<TANGENTIAL_COULOMB> : public TangentialModelBase {
public:
  TangentialModel(LAMMPS *lmp, IContactHistorySetup *hsetup, ContactModelBase *model)
      : TangentialModelBase(lmp, hsetup, model), model_(model),
        spring_offset_(drumlin::announce(*hsetup, drumlin::Remembered::spring)) {}

  void registerSettings(Settings &) {}
  void postSettings(IContactHistorySetup *, ContactModelBase *) {}

  void connectToProperties(PropertyRegistry &registry) {
    registry.registerProperty("coeffFrict", &MODEL_PARAMS::createCoeffFrict);
    registry.connect("coeffFrict", friction_, "tangential_model coulomb");
    coupled_.find(lmp, *model_);
  }

  inline void surfacesIntersect(const SurfacesIntersectData &sidata, ForceData &i_forces,
                                ForceData &j_forces) {
    namespace physics = drumlin::physics;
    if (sidata.contact_flags) *sidata.contact_flags |= CONTACT_TANGENTIAL_MODEL;
    double *spring = sidata.contact_history + spring_offset_;
    const bool moves = sidata.computeflag && sidata.shearupdate; // not in a set-up, nor for computes
    const physics::Vec3 normal{sidata.en[0], sidata.en[1], sidata.en[2]};
    const physics::Vec3 slip = moves && !sidata.is_wall
                                   ? slip_of_step(sidata, normal)
                                   : physics::Vec3{sidata.vtr1, sidata.vtr2, sidata.vtr3};
    const physics::Friction friction{sidata.kt, sidata.gammat, friction_[sidata.itype][sidata.jtype],
                                     physics::Cap::coulomb};
    const physics::FrictionStep step =
        physics::friction_step(friction, sidata.Fn, normal, slip, {spring[0], spring[1], spring[2]},
                               drumlin::time_of_spring(sidata, spring, moves, update->dt));
    if (moves) std::copy(step.spring.begin(), step.spring.end(), spring);
    if (auto *rubbing = coupled_.rubbing(sidata)) {
      rubbing->friction = friction;
      rubbing->rub = step.force;
      rubbing->slip = slip;
      rubbing->arm_i = sidata.cri;
      rubbing->arm_j = sidata.is_wall ? 0.0 : sidata.crj;
      rubbing->spring = spring;
    }
    const double share = sidata.is_wall ? sidata.area_ratio : 1.0;
    const physics::Vec3 force = physics::scaled(share, step.force);
    const physics::Vec3 moment = physics::cross(normal, force);
    for (std::size_t a = 0; a < 3; ++a) {
      i_forces.delta_F[a] += force[a];
      i_forces.delta_torque[a] -= sidata.cri * moment[a];
      if (sidata.is_wall) continue;
      j_forces.delta_F[a] -= force[a];
      j_forces.delta_torque[a] -= sidata.crj * moment[a];
    }
  }

  void surfacesClose(SurfacesCloseData &scdata, ForceData &, ForceData &) {
    if (scdata.contact_flags) *scdata.contact_flags &= ~CONTACT_TANGENTIAL_MODEL;
    if (scdata.contact_history != nullptr) std::fill_n(scdata.contact_history + spring_offset_, 3, 0.0);
  }

  void beginPass(SurfacesIntersectData &, ForceData &, ForceData &) {}
  void endPass(SurfacesIntersectData &, ForceData &, ForceData &) {}

private:
  drumlin::physics::Vec3 slip_of_step(const SurfacesIntersectData &sidata,
                                      const drumlin::physics::Vec3 &normal) const {
    drumlin::physics::Vec3 relative{}, separation{}, turning{};
    for (std::size_t a = 0; a < 3; ++a) {
      relative[a] = sidata.v_i[a] - sidata.v_j[a];
      separation[a] = sidata.delta[a];
      turning[a] = sidata.cri * sidata.omega_i[a] + sidata.crj * sidata.omega_j[a];
    }
    return drumlin::physics::slip_velocity_of_step(relative, separation, normal, turning, update->dt);
  }

  ContactModelBase *model_;
  drumlin::CoupledContacts coupled_;
  double **friction_ = nullptr; // coefficients by types
  int spring_offset_;           // in the contact history
};

} // namespace ContactModels
} // namespace LIGGGHTS

#endif
#endif
