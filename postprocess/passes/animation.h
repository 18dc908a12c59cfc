// A pass as an animation, from the dumps of its run.
#pragma once

#include "pages/figure.h"
#include "passes/values.h"

#include <string>

namespace drumlin::post {

/// The soil with the pressure in its balls and the roller, dump by dump: in three dimensions the balls that
/// the middle section across the drum's axis cuts. \pre the run has dumps for it, PassesResult::animated
PageFigure animation_of(const std::string &label, const PassesResult &result);

} // namespace drumlin::post
