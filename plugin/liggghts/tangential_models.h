// Adapter of the core's friction with a spring to LIGGGHTS's contact models: `tangential coulomb`, whose
// force never exceeds its limit, and `tangential history`, which limits the spring alone, as the engine's
// model of that name does. (LIGGGHTS includes this file several times; the first branch only announces the
// models.)
#ifdef TANGENTIAL_MODEL
TANGENTIAL_MODEL(TANGENTIAL_COULOMB, coulomb, 21)
TANGENTIAL_MODEL(TANGENTIAL_SPRING, tangential_spring, 22)
#else
#ifndef DRUMLIN_TANGENTIAL_MODELS_H
#define DRUMLIN_TANGENTIAL_MODELS_H

#include "contact_models.h"
#include "global_properties.h"
#include "tangential_model_base.h"
#include "update.h"

#include <algorithm>

#include "liggghts/coupled_contacts.h"
#include "physics/laws/friction_law.h"

namespace LIGGGHTS {
namespace ContactModels {

/// kt, ct and the normal force come from the normal model; the spring is three values of the contact history.
template <drumlin::physics::Cap cap>
class SpringModel : public TangentialModelBase {
  static constexpr bool coulomb = cap == drumlin::physics::Cap::coulomb;

public:
  SpringModel(LAMMPS *lmp, IContactHistorySetup *hsetup, ContactModelBase *model)
      : TangentialModelBase(lmp, hsetup, model), model_(model),
        spring_offset_(drumlin::announce(*hsetup, drumlin::Remembered::spring)) {}

  void registerSettings(Settings &) {}
  void postSettings(IContactHistorySetup *, ContactModelBase *) {}

  void connectToProperties(PropertyRegistry &registry) {
    registry.registerProperty("coeffFrict", &MODEL_PARAMS::createCoeffFrict);
    registry.connect("coeffFrict", friction_,
                     coulomb ? "tangential_model coulomb" : "tangential_model history");
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
    const physics::Friction friction{sidata.kt, sidata.gammat, friction_[sidata.itype][sidata.jtype], cap};
    const double dt = !moves    ? 0.0
                      : coulomb ? drumlin::time_of_spring(sidata, spring, moves, update->dt)
                                : update->dt;
    const physics::FrictionStep step =
        physics::friction_step(friction, sidata.Fn, normal, slip, {spring[0], spring[1], spring[2]}, dt);
    if (moves) std::copy(step.spring.begin(), step.spring.end(), spring);
    LAMMPS_NS::FixStepping::Rubbing *rubbing = coulomb ? coupled_.rubbing(sidata) : coupled_.begun(sidata);
    if (rubbing != nullptr) {
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
  /// As the loop over contacts has it, of balls.
  drumlin::physics::Vec3 slip_of_step(const SurfacesIntersectData &sidata,
                                      const drumlin::physics::Vec3 &normal) const {
    drumlin::physics::Vec3 relative{}, separation{}, turning{};
    for (std::size_t a = 0; a < 3; ++a) {
      relative[a] = sidata.v_i[a] - sidata.v_j[a];
      separation[a] = sidata.delta[a];
      turning[a] = sidata.cri * sidata.omega_i[a] + sidata.crj * sidata.omega_j[a];
    }
    return coulomb
               ? drumlin::physics::slip_velocity_of_step(relative, separation, normal, turning, update->dt)
               : drumlin::physics::slip_velocity(relative, normal, turning);
  }

  ContactModelBase *model_;
  drumlin::CoupledContacts coupled_;
  double **friction_ = nullptr; // coefficients by types
  int spring_offset_;           // in the contact history
};

template <>
class TangentialModel<TANGENTIAL_COULOMB> : public SpringModel<drumlin::physics::Cap::coulomb> {
public:
  using SpringModel::SpringModel;
};

template <>
class TangentialModel<TANGENTIAL_SPRING> : public SpringModel<drumlin::physics::Cap::spring> {
public:
  using SpringModel::SpringModel;
};

} // namespace ContactModels
} // namespace LIGGGHTS

#endif
#endif
