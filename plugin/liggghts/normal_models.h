// The contact laws as normal models of LIGGGHTS, `model hooke/transition` and so on. (LIGGGHTS includes this
// file several times; the first branch only announces the models, each with a number of its own.)
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
