// Results of the box study: the rows of its file runs.csv, and what another box changes.
#pragma once

#include "studies/fidelity/results.h"
#include "studies/study.h"
#include "support/statistics.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

constexpr std::size_t box_quantity_count = 7;

/// A run of a roller on a bed in a box, whose first two members name it. Forces and k are per metre of the drum's
/// width. NaN: the record does not give the value.
struct BoxRun {
  std::string run; ///< without commas
  int seed = 0;
  int width = 1;                                   ///< of the box, in widths of the default box
  int depth = 1;                                   ///< in depths of the default bed
  std::string boundary;                            ///< rigid or absorb, of floor and sides
  double ground_depth = 0.0;                       ///< of the ground below an absorbing floor [m]; 0: rigid
  std::array<double, box_quantity_count> values{}; ///< in the order of box_quantities [SI]
  double cpu_s = 0.0;                              ///< processor time of the engine, excitation only
};

/// A result of a run that the study compares.
struct BoxQuantity {
  const char *name;   ///< words for a sentence of the page
  const char *column; ///< of runs.csv
  const char *unit;   ///< of tables and figures
  double scale;       ///< from SI to this unit
};
extern const std::array<BoxQuantity, box_quantity_count> box_quantities;

/// The columns of runs.csv.
const CsvSchema<BoxRun> &box_runs();

/// The values of a run in a folder: means over the second half of its cycles, k and D as `drumlin identify` finds
/// them in the whole record, the settlement after the last cycle.
std::array<double, box_quantity_count> box_values(const std::filesystem::path &folder);

/// The values of a run over its seeds, without those that are missing [SI].
std::vector<double> finite_values(const std::vector<BoxRun> &runs, const std::string &run,
                                  std::size_t quantity);

/// Change of a quantity from one run to another, over the mean of the second; none without two seeds of both. In boxes
/// of one size the beds of a seed are the same, and changes are taken seed by seed; the beds of different boxes have
/// nothing in common, and the difference of the means has the scatter of both. Of the settlement, which may be zero,
/// the change is in m and not relative.
std::optional<MeanInterval> box_change(const std::vector<BoxRun> &runs, const BedComparison &compared,
                                       std::size_t quantity);
/// Change from rigid walls to floor and sides that absorb, over all pairs of runs on one bed, in boxes of all sizes,
/// with the ground of least depth; otherwise as box_change().
std::optional<MeanInterval> boundary_change(const std::vector<BoxRun> &runs, std::size_t quantity);
/// Whether changes of a quantity are relative.
bool is_relative(std::size_t quantity);

/// Writes figures, tables and index.html into the study's folder.
/// \param beds what they are, in words
/// \param failures runs that failed, one sentence each
void write_box_page(const std::filesystem::path &out, const std::string &beds,
                    const std::vector<BoxRun> &runs, const std::vector<BedComparison> &comparisons,
                    const std::vector<std::string> &failures);

} // namespace drumlin::post
