// The surface models of the engine that this plugin uses, for its number alone; see style_normal_model.h.
#include "surface_model_default.h"
