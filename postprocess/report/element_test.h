// What the pages on element tests of soil have in common.
#pragma once

#include "report/run_folder.h"

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// Inertial number and energy error below which a test is slow enough and exact enough.
constexpr double allowed_inertial_number = 1e-3;
constexpr double allowed_energy_error = 1e-3;

/// The folders as runs of which only folder, name and parameters are read. Throws std::runtime_error for a file
/// that cannot be read.
std::vector<Run> read_named_runs(const std::vector<std::filesystem::path> &folders);

/// Digits of a number; no_value if it is not finite.
std::string number_cell(double value, int digits = 4);

/// A name for a curve, without what gnuplot would split it at.
std::string curve_text(std::string name);

} // namespace drumlin::post
