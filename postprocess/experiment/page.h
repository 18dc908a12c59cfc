// The page of an experiment.
#pragma once

#include "experiment/results.h"

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// Writes tables, figures and index.html into the experiment's folder.
/// \param failures runs that failed, one sentence each
void write_experiment_page(const std::filesystem::path &out, Plan plan, const Results &results,
                           const std::vector<std::string> &failures);

} // namespace drumlin::post
