// `drumlin study speed`: steps of balls per second from small beds to large ones, on one rank and on two, and memory.
#pragma once

namespace drumlin::post {

struct StudyOptions;

/// Runs the study, or what is missing of it, and writes its page. Throws UsageError for an --out that the engine would split,
/// std::runtime_error if a run fails or runs did not do the same work.
void run_speed_study(const StudyOptions &options);

} // namespace drumlin::post
