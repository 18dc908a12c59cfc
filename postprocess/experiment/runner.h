// Makes the runs of an experiment that its folder does not have yet, and writes its page.
#pragma once

#include "experiment/plan.h"

#include <filesystem>

namespace drumlin::post {

/// Writes into a folder that a ResumedFolder holds:
///   plan        a copy of the plan
///   beds/       restart files of the beds
///   runs.csv    values of each run, and its processor time
///   index.html  tables and figures
///   runs/       if `keep`: the files of each run, in a folder for its scene and seed
/// A run that fails does not stop the others: the page names it, and std::runtime_error is thrown at the end.
/// \param jobs runs at the same time
void run_experiment(const Plan &plan, const std::filesystem::path &out, int jobs, bool keep);

} // namespace drumlin::post
