// bed.csv of a run of a roller on a bed. Its columns that a chain has, too, are read by read_chain().
#pragma once

#include <filesystem>
#include <vector>

namespace drumlin::post {

/// The columns of bed.csv that a chain does not have: the state of the bed, a value for each row.
struct BedHistory {
  std::vector<double> coordination;    ///< -
  std::vector<double> void_ratio;      ///< -
  std::vector<double> kinetic;         ///< J
  std::vector<double> potential;       ///< J
  std::vector<double> elastic;         ///< J
  std::vector<double> dissipated;      ///< J, since the start
  std::vector<double> work_excitation; ///< J, since the start
  std::vector<double> F_floor;         ///< N, upwards, on all balls
  std::vector<double> F_sides;         ///< N, friction of the side walls, upwards
  std::vector<double> F_thrust;        ///< N, sum of the normal forces of the side walls
};

/// Reads these columns of a bed.csv. Throws std::runtime_error with file, line and column.
BedHistory read_bed_history(const std::filesystem::path &file);

} // namespace drumlin::post
