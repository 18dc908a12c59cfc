// The normal models that this plugin combines; the engine's own list is not part of its development package.
#include "liggghts/normal_models.h"
