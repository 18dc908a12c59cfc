// The page of the accuracy study.
#pragma once

#include <filesystem>

namespace drumlin::post {

/// Writes orders.csv, the figures and index.html from chain.csv, impacts.csv and scaling.csv in the study's
/// folder, as far as they are there. \param complete whether all points were measured
void write_accuracy_page(const std::filesystem::path &out, bool complete);

} // namespace drumlin::post
