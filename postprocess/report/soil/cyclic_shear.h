// The report's page on cyclic simple shear tests: volumetric strain, modulus and damping ratio over cycles
// and over the amplitude, beside published curves.
#pragma once

#include "report/soil/element_tests.h"

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// Title of the page.
constexpr const char *cyclic_shear_title = "Cyclic simple shear tests of soil";

/// Reads the runs in folders, at least one, for their page. Throws std::runtime_error for a file that cannot
/// be read.
PageWriter read_cyclic_shear_page(const std::vector<std::filesystem::path> &folders);

} // namespace drumlin::post
