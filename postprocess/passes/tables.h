// The tables of what passes leave, units in their headers, an empty cell where a value is not known.
#pragma once

#include "passes/values.h"
#include "support/files.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// The text of a number in a CSV cell; empty if the number is NaN or absent.
std::string cell_of(double value);
std::string cell_of(std::optional<double> value);

/// A number of a pass, as a column of passes.csv.
struct PassColumn {
  std::string header;
  std::function<double(const PassValues &)> value; ///< NaN: not known
};
/// The columns of a bed of so many layers.
std::vector<PassColumn> pass_columns(std::size_t layers);

/// passes.csv of several runs: of each column the mean over the runs and half of its 95 % interval, in the
/// row of each pass that at least one run has, and the number of runs that have it.
/// \pre runs of equal layers
std::string passes_csv(const std::vector<PassesResult> &results);
/// The four tables of a run, as files in `folder`. passes.csv has a row for the state before the first pass
/// and for that after each; way.csv a row for each pass and cell of the way; surface.csv the height along the
/// way, a column for each pass; depth.csv a row for each pass and layer of equal depth.
std::vector<FileText> pass_tables(const std::filesystem::path &folder, const PassesResult &result);

/// The number of passes that the longest of the runs has.
std::size_t most_passes(const std::vector<PassesResult> &results);
/// A value of the runs after a pass, 0: before; those that have it.
std::vector<double> values_after(const std::vector<PassesResult> &results, std::size_t pass,
                                 const std::function<double(const PassValues &)> &value);
/// The mode of most runs in a pass; empty: not known.
std::string mode_in(const std::vector<PassesResult> &results, std::size_t pass);

} // namespace drumlin::post
