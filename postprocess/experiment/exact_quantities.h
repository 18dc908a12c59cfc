// Errors of runs of the chain and of impacts beside their exact solutions.
#pragma once

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// A function of the folder of a run, which has its CSV files and parameters.csv.
struct ExactQuantity {
  const char *name, *label;
  double (*value)(const std::filesystem::path &folder); ///< without unit
};
const std::vector<ExactQuantity> &exact_quantities();

/// Errors of the rebound of a run of study/in.impacts over the speed of the impact, over the phases of the
/// make within a step. NaN if it has not as many rebounds as phases.
struct ReboundErrors {
  double worst, rms;
};
ReboundErrors rebound_errors(const std::filesystem::path &folder);

} // namespace drumlin::post
