// The normal models that this plugin combines; the engine's own list is not part of its development package.
#include "liggghts/normal_model_hertz_transition.h"
#include "liggghts/normal_model_hooke_transition.h"
