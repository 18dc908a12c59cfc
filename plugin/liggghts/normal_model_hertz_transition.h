// The Hertz contact law as a contact model of LIGGGHTS: `model hertz/transition`.
// (LIGGGHTS includes this file several times; the first branch only announces the model.)
#ifdef NORMAL_MODEL
NORMAL_MODEL(HERTZ_TRANSITION, hertz / transition, 22)
#else
#ifndef DRUMLIN_NORMAL_MODEL_HERTZ_TRANSITION_H
#define DRUMLIN_NORMAL_MODEL_HERTZ_TRANSITION_H

#include "liggghts/transition_model.h"

namespace drumlin {

template <>
constexpr int normal_model_number<physics::HertzContact> = LIGGGHTS::ContactModels::HERTZ_TRANSITION;

/// youngsModulus and poissonsRatio of each type, as for the engine's own Hertz models.
template <>
class LawProperties<physics::HertzContact> {
public:
  LawProperties(LAMMPS_NS::LAMMPS *lmp, const std::string &command, int ntypes)
      : E_(lmp, command, "youngsModulus", "Young's modulus, Pa", ntypes),
        nu_(lmp, command, "poissonsRatio", "Poisson's ratio", ntypes) {}

  physics::HertzContact operator()(int i, int j) {
    const auto E = [this](int type) { return E_(type, 0.0, TypePairProperty::infinity); };
    const auto nu = [this](int type) { return nu_(type, -1.0, 0.5); };
    physics::HertzContact contact;
    contact.set_moduli(E(i), nu(i), E(j), nu(j));
    return contact;
  }

private:
  TypeProperty E_, nu_;
};

} // namespace drumlin

namespace LIGGGHTS {
namespace ContactModels {

template <>
class NormalModel<HERTZ_TRANSITION> : public drumlin::TransitionModel<drumlin::physics::HertzContact> {
public:
  using TransitionModel::TransitionModel;
};

} // namespace ContactModels
} // namespace LIGGGHTS

#endif
#endif
