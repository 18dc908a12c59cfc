// The linear contact law as a contact model of LIGGGHTS: `model hooke/transition`.
// (LIGGGHTS includes this file several times; the first branch only announces the model.)
#ifdef NORMAL_MODEL
NORMAL_MODEL(HOOKE_TRANSITION, hooke / transition, 21)
#else
#ifndef DRUMLIN_NORMAL_MODEL_HOOKE_TRANSITION_H
#define DRUMLIN_NORMAL_MODEL_HOOKE_TRANSITION_H

#include "liggghts/transition_model.h"

namespace drumlin {

template <>
constexpr int normal_model_number<physics::LinearContact> = LIGGGHTS::ContactModels::HOOKE_TRANSITION;

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

} // namespace drumlin

namespace LIGGGHTS {
namespace ContactModels {

template <>
class NormalModel<HOOKE_TRANSITION> : public drumlin::TransitionModel<drumlin::physics::LinearContact> {
public:
  using TransitionModel::TransitionModel;
};

} // namespace ContactModels
} // namespace LIGGGHTS

#endif
#endif
