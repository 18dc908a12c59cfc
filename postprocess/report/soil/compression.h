// The report's pages on biaxial and triaxial tests: mobilised friction and volume over strain, friction
// angles over side stresses.
#pragma once

#include "bed/element_results.h"
#include "report/soil/element_tests.h"

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// Titles of the pages.
constexpr const char *biaxial_title = "Biaxial tests of soil";
constexpr const char *triaxial_title = "Triaxial tests of soil";

/// Reads the runs in folders, at least one, for their page. Throws std::runtime_error for a file that cannot
/// be read.
PageWriter read_biaxial_page(const std::vector<std::filesystem::path> &folders);
PageWriter read_triaxial_page(const std::vector<std::filesystem::path> &folders);

} // namespace drumlin::post
