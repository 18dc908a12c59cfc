// The contact laws as normal models of LIGGGHTS, `model hooke/transition` and so on, and the properties that each law reads.
// (LIGGGHTS includes this file several times; the first branch only announces the models, each with a number of its own.)
#ifdef NORMAL_MODEL
NORMAL_MODEL(HOOKE_TRANSITION, hooke / transition, 21)
NORMAL_MODEL(HERTZ_TRANSITION, hertz / transition, 22)
#else
#ifndef DRUMLIN_NORMAL_MODELS_H
#define DRUMLIN_NORMAL_MODELS_H

#include "liggghts/transition_model.h"

namespace drumlin {

template <>
constexpr int normal_model_number<physics::LinearContact> = LIGGGHTS::ContactModels::HOOKE_TRANSITION;
template <>
constexpr int normal_model_number<physics::HertzContact> = LIGGGHTS::ContactModels::HERTZ_TRANSITION;

/// kn, and kt where it is given.
template <>
class LawProperties<physics::LinearContact> {
public:
  LawProperties(LAMMPS_NS::LAMMPS *lmp, const std::string &command, int ntypes)
      : normal_(lmp, command, "kn", ntypes), tangential_(lmp, command, "kt", ntypes) {
    normal_.require("normal stiffness, N/m");
  }

  physics::LinearContact operator()(int i, int j) {
    physics::LinearContact contact;
    contact.stiffness = normal_(i, j, false);
    contact.tangential_stiffness =
        tangential_.given() ? tangential_(i, j, true) : default_tangential_stiffness(contact.stiffness);
    return contact;
  }

private:
  TypePairProperty normal_, tangential_;
};

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
class NormalModel<HOOKE_TRANSITION> : public drumlin::TransitionModel<drumlin::physics::LinearContact> {
public:
  using TransitionModel::TransitionModel;
};

template <>
class NormalModel<HERTZ_TRANSITION> : public drumlin::TransitionModel<drumlin::physics::HertzContact> {
public:
  using TransitionModel::TransitionModel;
};

} // namespace ContactModels
} // namespace LIGGGHTS

#endif
#endif
