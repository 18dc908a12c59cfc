// `drumlin study fidelity`: what each ingredient of a bed changes and costs.
#pragma once

namespace drumlin::post {

struct StudyOptions;

/// Runs the study, or what is missing of it, and writes its page. Throws UsageError for an --out that the engine would split,
/// std::runtime_error if a run fails.
void run_fidelity_study(const StudyOptions &options);

} // namespace drumlin::post
