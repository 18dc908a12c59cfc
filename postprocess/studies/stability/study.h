// `drumlin study stability`: how long a step may be, and what happens at the edges of what can be asked.
#pragma once

#include "studies/study.h"

namespace drumlin::post {

/// Measures the stability map and the tables of extremes into options.out: map.csv, extremes.csv, index.html. Throws
/// std::runtime_error naming the rows that fail, after everything is written.
void run_stability_study(const StudyOptions &options);

} // namespace drumlin::post
