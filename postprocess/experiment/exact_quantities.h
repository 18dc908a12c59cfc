// Errors of runs of the chain and of impacts beside their exact solutions.
#pragma once

#include <filesystem>
#include <limits>
#include <vector>

namespace drumlin::post {

/// The value that a run does not give.
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// A function of the folder of a run, which has its CSV files and parameters.csv.
struct ExactQuantity {
  const char *name, *label;
  double (*value)(const std::filesystem::path &folder); ///< without unit
};
const std::vector<ExactQuantity> &exact_quantities();

/// The last cycles of a run of the chain, over which its steady errors count.
constexpr int steady_error_cycles = 5;

/// w0 dt of the lowest boundary between balls that are stable and balls that are not, from looks.dump,
/// steps.csv and parameters.csv in the folder of a run: the geometric mean of the last stable step and the
/// first unstable one; the longest step if all are stable. std::runtime_error if the first ball is unstable.
double stable_step(const std::filesystem::path &folder);

} // namespace drumlin::post
