// The report's tables on chains and single impacts, as text: the page and its CSV files have the same cells.
#pragma once

#include <string>
#include <vector>

#include "pages/table.h"
#include "report/chain/measures.h"

namespace drumlin::post {

/// All tables for which the results have rows or notes, in order.
std::vector<PageTable> make_tables(const ReportResults &results);

/// Largest relative error, of velocity, energy or force, that the report marks as good.
constexpr double good_error = 0.01;

/// Number of comparisons with reference values, and how they came out.
struct CheckCount {
  std::size_t all = 0; ///< that were judged
  std::size_t agree = 0;
  std::size_t same_digits = 0;
  std::size_t not_judged = 0; ///< of runs that are too short for the reference values; not counted in `all`
};
/// Counts over all checks, or over those of one run (index into ReportResults::runs).
CheckCount count_checks(const ReportResults &results);
CheckCount count_checks(const ReportResults &results, std::size_t run);

/// The command that repeats a run of a case of the paper with enough cycles to be judged by the reference
/// values.
std::string judging_command(const Run &run);

} // namespace drumlin::post
