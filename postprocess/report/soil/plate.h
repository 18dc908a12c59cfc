// The report's page on plate load tests: settlement over stress, modulus of subgrade reaction, strain moduli,
// bearing capacity.
#pragma once

#include "bed/element_results.h"
#include "report/soil/element_tests.h"

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// Title of the page.
constexpr const char *plate_title = "Plate load tests";

/// Reads the runs in folders, at least one, for their page. Throws std::runtime_error for a file that cannot
/// be read.
PageWriter read_plate_page(const std::vector<std::filesystem::path> &folders);

} // namespace drumlin::post
