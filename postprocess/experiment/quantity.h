// The quantities that an experiment measures in the files of a run.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace drumlin::post {

class RunFiles;

/// What is measured in a run, in SI units.
struct Quantity {
  std::string name;  ///< in plans and tables
  std::string label; ///< words for sentences and axes
  std::string unit;  ///< of its values
  std::string shown_unit;
  double scale = 1.0; ///< from `unit` to the unit that pages show
  /// A change whose whole interval is within it counts as negligible: relative to the mean of what is
  /// compared with, or in `unit` if the quantity is absolute.
  double tolerance = 0.1;
  bool absolute = false; ///< its mean may be about zero, so that changes are given in its unit
  std::function<double(RunFiles &)> value; ///< NaN if the run does not give it
};

/// The quantities that plans name: of a roller on a bed, whose forces and stiffnesses are per metre of the
/// drum's width; and errors of chains and impacts beside their exact solutions.
const std::vector<Quantity> &named_quantities();
/// The one of that name; nullptr if there is none.
const Quantity *named_quantity(const std::string &name);

/// The ways to make one number of a column: last, gain (last less first), mean, largest, smallest, per_row.
std::vector<const char *> column_ways();
/// The unit of a column, which stands at the end of its name, "settlement [m]" or "stress_kPa", or is known
/// of the tables of fix roller/history; empty: not known.
std::string column_unit(const std::string &file, const std::string &column);
/// A quantity of any deck: one number made of a column of a CSV file that the deck writes. Empty cells are
/// left out. `mean`, and `per_row`, the mean change from one row to the next, use the second half of the
/// rows. The file may also be one of the tables of `drumlin passes`; it is made from the run if the deck has
/// not written a file of that name. \param way one of column_ways()
Quantity column_quantity(const std::string &name, const std::string &unit, const std::string &way,
                         const std::string &file, const std::string &column);

/// The values of the quantities, in their order, of the run whose files are in a folder. std::runtime_error
/// for files that cannot be read. \param width of a bed of spheres along the drum's axis [m]; 1 of discs
std::vector<double> measured(const std::vector<Quantity> &quantities, const std::filesystem::path &folder,
                             double width);

} // namespace drumlin::post
