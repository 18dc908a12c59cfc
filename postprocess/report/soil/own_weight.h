// The report's pages on tests of soil under its own weight: angle of repose, a silo whose floor moves down, a
// wall that moves outward.
#pragma once

#include "bed/element_results.h"
#include "report/soil/element_tests.h"

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// Titles of the pages.
constexpr const char *repose_title = "Angle of repose";
constexpr const char *silo_title = "Soil in a silo";
constexpr const char *wall_title = "Soil behind a wall that moves outward";

/// Read the runs in folders, at least one, for their page. Throw std::runtime_error for a file that cannot be
/// read.
PageWriter read_repose_page(const std::vector<std::filesystem::path> &folders);
PageWriter read_silo_page(const std::vector<std::filesystem::path> &folders);
PageWriter read_wall_page(const std::vector<std::filesystem::path> &folders);

} // namespace drumlin::post
