// The longest stable step of the balls of study/in.stability.
#pragma once

#include <filesystem>

namespace drumlin::post {

/// w0 dt of the lowest boundary between balls that are stable and balls that are not, from looks.dump,
/// steps.csv and parameters.csv in the folder of a run: the geometric mean of the last stable step and the
/// first unstable one; the longest step if all are stable. std::runtime_error if the first ball is unstable.
double stable_step(const std::filesystem::path &folder);

} // namespace drumlin::post
