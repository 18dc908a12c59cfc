// The report's page on the loosest and the densest packing of a soil.
#pragma once

#include "report/soil/element_tests.h"

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// Title of the page.
constexpr const char *density_title = "Loosest and densest packing";

/// Reads the runs in folders, at least one, for their page. Throws std::runtime_error for a file that cannot
/// be read.
PageWriter read_density_page(const std::vector<std::filesystem::path> &folders);

} // namespace drumlin::post
