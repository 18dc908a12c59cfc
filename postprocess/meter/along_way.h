// Records of a roller that drives: the part of its way that counts, windows of a length of the way, and over
// which length a window averages the soil. Places are those of the column s of a run.
#pragma once

#include "meter/values.h"

#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// A part of the way in one pass. What is not given: from the beginning, to the end, the last pass.
struct WayRange {
  std::optional<double> from, to; ///< m
  std::optional<int> pass;        ///< counted from 1

  bool given() const { return from || to || pass; }
};

/// The rows of a record in which the roller is on this part of the way in this pass.
struct WayRows {
  std::size_t first = 0, end = 0; ///< to before `end`
  int pass = 1;
};
/// std::runtime_error of one line: a record without places, a pass or a part that it does not have.
WayRows rows_on(const Record &record, const WayRange &range);

/// The cycles that lie wholly in these rows. std::runtime_error of one line if they are less than four.
void keep_cycles(MeterRecord &cycles, const Record &record, const WayRows &rows);
/// The record of these rows alone, without `cycles_file`, which counts cycles from the beginning of the run.
Record part_of(const Record &record, const WayRows &rows);

/// Windows of an even number of cycles, each as short as it can be while the roller drives `length` [m] in it
/// or more, without a turn or a pause; they follow one another from the first cycle on. std::runtime_error of
/// one line if no window is so long, or if four cycles are longer.
std::vector<MeterWindow> windows_of_length(const MeterRecord &cycles, const Record &record, double length,
                                           const MeterOptions &options);

/// Gives windows their places and passes, if the record has places.
void add_places(std::vector<MeterWindow> &windows, const Record &record);

/// The time in which the slowest motion of drum and frame on the soil falls to a hundredth, in unbroken
/// contact with the stiffness k [N/m] and the damping c [N s/m] of the soil [s]. Nothing without masses and
/// bond, or if it does not fall.
std::optional<double> memory_time(const Record &record, double k, double c);

/// Over which length of the way windows of so many seconds average the soil, as a sentence; empty for a
/// record without places, or of a roller that stands. \param soil k [N/m] and c [N s/m], if they are known
std::string averaging_words(const Record &record, double begin, double end,
                            const std::optional<std::pair<double, double>> &soil);

} // namespace drumlin::post
