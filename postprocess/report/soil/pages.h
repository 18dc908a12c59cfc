// The report's pages on element tests of soil.
#pragma once

#include "report/soil/element_tests.h"

#include <filesystem>
#include <vector>

namespace drumlin::post {

using TestFolders = const std::vector<std::filesystem::path> &;

// Each function reads the runs in folders, at least one, for the page of that title. It throws
// std::runtime_error for a file that cannot be read.

// Mobilised friction and volume over strain, friction angles over side stresses.
constexpr const char *biaxial_title = "Biaxial tests of soil";
PageWriter read_biaxial_page(TestFolders folders);
constexpr const char *triaxial_title = "Triaxial tests of soil";
PageWriter read_triaxial_page(TestFolders folders);

// Mobilised friction and volume over shear strain.
constexpr const char *shear_title = "Simple shear tests of soil";
PageWriter read_shear_page(TestFolders folders);

// Volumetric strain, modulus and damping ratio over cycles and over the amplitude, beside published curves.
constexpr const char *cyclic_shear_title = "Cyclic simple shear tests of soil";
PageWriter read_cyclic_shear_page(TestFolders folders);

// Modulus and settlement over stress.
constexpr const char *oedometer_title = "Oedometer tests of soil";
PageWriter read_oedometer_page(TestFolders folders);

// Settlement over stress, modulus of subgrade reaction, strain moduli, bearing capacity.
constexpr const char *plate_title = "Plate load tests";
PageWriter read_plate_page(TestFolders folders);

constexpr const char *density_title = "Loosest and densest packing";
PageWriter read_density_page(TestFolders folders);

// Soil under its own weight: angle of repose, a silo whose floor moves down, a wall that moves outward.
constexpr const char *repose_title = "Angle of repose";
PageWriter read_repose_page(TestFolders folders);
constexpr const char *silo_title = "Soil in a silo";
PageWriter read_silo_page(TestFolders folders);
constexpr const char *wall_title = "Soil behind a wall that moves outward";
PageWriter read_wall_page(TestFolders folders);

} // namespace drumlin::post
