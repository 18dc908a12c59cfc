// Adapter of the core's linear contact law to LIGGGHTS's contact models: `model hooke/transition`.
// (LIGGGHTS includes this file several times; the first branch only announces the model.)
#ifdef NORMAL_MODEL
NORMAL_MODEL(HOOKE_TRANSITION, hooke / transition, 21)
#else
#ifndef DRUMLIN_NORMAL_MODEL_HOOKE_TRANSITION_H
#define DRUMLIN_NORMAL_MODEL_HOOKE_TRANSITION_H

#include "contact_models.h"
#include "normal_model_base.h"

#include "liggghts/contact_table.h"
#include "physics/contact_law.h"

namespace LIGGGHTS {
namespace ContactModels {

/// Linear spring-dashpot with transition condition A or B (Eqs. 2 to 9). The engine's own tangential and
/// rolling models take the normal force, stiffnesses and dampings from here.
template <>
class NormalModel<HOOKE_TRANSITION> : public NormalModelBase {
public:
  NormalModel(LAMMPS *lmp, IContactHistorySetup *hsetup, ContactModelBase *model)
      : NormalModelBase(lmp, hsetup, model), is_wall_(model->is_wall()) {}

  // The deck's `transition` and `damping` keywords reach here as the two switches below: see
  // model_settings.h.
  void registerSettings(Settings &settings) {
    settings.registerOnOff("transition_A", transition_a_, false);
    settings.registerOnOff("damping_coefficient", damping_coefficient_, false);
  }

  void postSettings(IContactHistorySetup *, ContactModelBase *) {}

  void connectToProperties(PropertyRegistry &registry) {
    const auto transition = transition_a_ ? drumlin::physics::Transition::A : drumlin::physics::Transition::B;
    const auto damping =
        damping_coefficient_ ? drumlin::physics::Damping::coefficient : drumlin::physics::Damping::ratio;
    table_.read(lmp, registry.max_type(), transition, damping, is_wall_);
  }

  double stressStrainExponent() { return 1.0; }

  inline void surfacesIntersect(SurfacesIntersectData &sidata, ForceData &i_forces, ForceData &j_forces) {
    if (sidata.contact_flags) *sidata.contact_flags |= CONTACT_NORMAL_MODEL;
    const drumlin::ContactCoefficients &p = table_.at(sidata.itype, sidata.jtype);
    const double k = p.normal.stiffness;
    const double c = drumlin::physics::damping_coefficient(p.normal, sidata.meff);
    // The engine's vn is positive when the balls separate: overlap_rate = -vn.
    const auto transition = transition_a_ ? drumlin::physics::Transition::A : drumlin::physics::Transition::B;
    const double Fn = drumlin::physics::normal_force(transition, k, c, sidata.deltan, -sidata.vn);

    sidata.Fn = Fn;
    sidata.kn = k;
    sidata.gamman = c;
    sidata.kt = p.tangential_stiffness;
    sidata.gammat = p.tangential_damping_share * c + p.tangential_damping;

    const double share = sidata.is_wall ? sidata.area_ratio : 1.0;
    for (int a = 0; a < 3; ++a) {
      const double F = share * Fn * sidata.en[a];
      i_forces.delta_F[a] += F;
      if (!sidata.is_wall) j_forces.delta_F[a] -= F;
    }
  }

  void surfacesClose(SurfacesCloseData &scdata, ForceData &, ForceData &) {
    if (scdata.contact_flags) *scdata.contact_flags &= ~CONTACT_NORMAL_MODEL;
  }

  void beginPass(SurfacesIntersectData &, ForceData &, ForceData &) {}
  void endPass(SurfacesIntersectData &, ForceData &, ForceData &) {}

private:
  const bool is_wall_;
  bool transition_a_ = false;
  bool damping_coefficient_ = false;
  drumlin::ContactTable table_;
};

} // namespace ContactModels
} // namespace LIGGGHTS

#endif
#endif
