// The report's page on runs of the oedometer: modulus and settlement over stress.
#pragma once

#include "report/soil/element_tests.h"
#include "runs/element_rows.h"

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// Title of the page.
constexpr const char *oedometer_title = "Oedometer tests of soil";

/// Reads the runs in folders, at least one, for their page. Throws std::runtime_error for a file that cannot
/// be read.
PageWriter read_oedometer_page(const std::vector<std::filesystem::path> &folders);

} // namespace drumlin::post
