// The page of the fidelity study.
#pragma once

#include "studies/fidelity/results.h"

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// index.html with its tables and figure in the study's folder.
/// \param beds of the complete scene, in words
/// \param failures runs that failed, one sentence each
void write_fidelity_page(const std::filesystem::path &out, const std::string &beds,
                         const std::vector<FidelityRun> &runs, const std::vector<Effect> &effects,
                         const std::vector<std::string> &failures);

} // namespace drumlin::post
