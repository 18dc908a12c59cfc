// The report's page on simple shear tests: mobilised friction and volume over shear strain, friction angles
// over the seeds.
#pragma once

#include "bed/element_results.h"
#include "report/soil/element_tests.h"

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// Title of the page.
constexpr const char *shear_title = "Simple shear tests of soil";

/// Reads the runs in folders, at least one, for their page. Throws std::runtime_error for a file that cannot
/// be read.
PageWriter read_shear_page(const std::vector<std::filesystem::path> &folders);

} // namespace drumlin::post
