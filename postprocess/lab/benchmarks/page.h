// The page of the benchmarks study.
#pragma once

#include <filesystem>

namespace drumlin::post {

/// Writes tables, figures and index.html from runs.csv in the study's folder.
void write_benchmarks_page(const std::filesystem::path &out);

} // namespace drumlin::post
