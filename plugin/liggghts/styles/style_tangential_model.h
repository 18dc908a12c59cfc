// The tangential models that this plugin combines; the engine's own list is not part of its development
// package.
#include "tangential_model_history.h" // for its number alone
#include "liggghts/tangential_models.h"
