// bed.csv of a run of a roller on a bed. Its columns that a chain has, too, are read by read_chain().
#pragma once

#include "support/csv.h"

#include <cstddef>
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

/// Reads these columns of the first `rows` rows of a bed.csv, to which a run that goes on adds others. Throws
/// std::runtime_error with file, line and column.
BedHistory read_bed_history(const std::filesystem::path &file, std::size_t rows, CutRows cut);

/// The columns of the bed.csv of a roller that drives which say where it is and what drives it, a value for
/// each row.
struct DriveHistory {
  std::vector<double> time;            ///< s
  std::vector<double> s;               ///< m, place along the way
  std::vector<double> pass;            ///< counted from 1; a pause belongs to the pass that has ended
  std::vector<double> traction;        ///< N, positive towards greater s
  std::vector<double> work_excitation; ///< J, since the start
  std::vector<double> work_traction;   ///< J, since the start
  std::vector<double> work_torque;     ///< J, since the start

  std::size_t size() const { return time.size(); }
};

/// Reads these columns of a bed.csv, row by row, since a drive has millions of cells, without a last row that
/// lacks its line end, and at most so many rows. Throws MissingColumn if the roller did not drive, else
/// std::runtime_error with file, line and column.
DriveHistory read_drive_history(const std::filesystem::path &file, std::size_t most_rows);

} // namespace drumlin::post
