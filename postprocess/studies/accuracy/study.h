// `drumlin study accuracy`: error against step size and against wall time.
#pragma once

namespace drumlin::post {

struct StudyOptions;

/// Measures what is not measured yet, coarse steps first, and writes into the study's folder
///   chain.csv    cases I to IV under A and B, both steppings, and the engine's own law under B
///   impacts.csv  single impacts over the phase of the onset
///   scaling.csv  chains of other parameters at the steps that advice gives for them
///   orders.csv   fitted orders, and the steps that each stepping needs for an error
///   index.html   tables and figures
void run_accuracy_study(const StudyOptions &options);

} // namespace drumlin::post
