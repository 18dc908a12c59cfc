// The rolling models that this plugin combines; the engine's own list is not part of its development package.
#include "rolling_model_epsd2.h" // for its number alone
#include "liggghts/rolling_model_spring.h"
