// Makes the runs of an experiment that its folder does not have yet, and writes its page.
#pragma once

#include "experiment/plan.h"

#include <filesystem>

namespace drumlin::post {

/// Every `of`-th run of a plan, beginning with this one, counted from 1: of 1 all runs.
struct Part {
  int number = 1, of = 1;
};

/// How the runs of a plan are made.
struct RunOptions {
  int jobs = 1;           ///< runs at the same time
  bool keep = false;      ///< all files of each run
  bool page_only = false; ///< make no run; print which are missing
};

/// Writes into a folder that a ResumedFolder holds:
///   plan        a copy of the plan
///   beds/       restart files of the beds
///   runs.csv    values of each run, and its processor time
///   NAME.csv    tables of the plan
///   index.html  tables and figures
///   runs/       if `keep`: the files of each run, in a folder for its scene and seed
/// Runs of parts that make_part() has made in its folder `parts` are taken over. A run that fails does not
/// stop the others: the page names it. std::runtime_error is thrown at the end if a run has failed or a known
/// value is not met.
void run_experiment(const Plan &plan, const std::filesystem::path &out, const RunOptions &options);

/// Makes a part of the runs, in a folder of its own that a ResumedFolder holds: beds/, runs.csv and runs/.
/// std::runtime_error at the end if one fails.
void make_part(const Plan &plan, const Part &part, const std::filesystem::path &folder,
               const RunOptions &options);

} // namespace drumlin::post
