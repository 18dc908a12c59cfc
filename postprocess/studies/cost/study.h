// `drumlin study cost`: what a step costs, and what each optional piece adds.
#pragma once

namespace drumlin::post {

struct StudyOptions;

/// Measures what is not measured yet, round by round, and writes into the study's folder
///   bed_2500.data, ...  settled beds that all variants start from
///   runs.csv            time of every run
///   index.html          tables and a figure
/// Throws std::runtime_error if laws that are one did not move the balls alike.
void run_cost_study(const StudyOptions &options);

} // namespace drumlin::post
