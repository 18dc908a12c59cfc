// The page of the cost study.
#pragma once

#include <filesystem>

namespace drumlin::post {

/// Writes the figure and index.html from runs.csv in the study's folder.
void write_cost_page(const std::filesystem::path &out);

} // namespace drumlin::post
