// The surface models that this plugin combines; the engine's own list is not part of its development package.
#include "surface_model_default.h"
