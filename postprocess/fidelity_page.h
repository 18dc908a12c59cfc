// The page of the fidelity study.
#pragma once

#include "fidelity_results.h"

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// index.html with its tables and figure in the study's folder.
void write_fidelity_page(const std::filesystem::path &out, const std::vector<FidelityRun> &runs,
                         const std::vector<Effect> &effects);

} // namespace drumlin::post
