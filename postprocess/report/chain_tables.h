// The report's tables, as text: the page and the CSV files beside it print the same cells.
#pragma once

#include <string>
#include <vector>

#include "pages/table.h"
#include "report/chain_measures.h"

namespace drumlin::post {

/// All tables that the results fill, in order.
std::vector<ReportTable> make_tables(const ReportResults &results);

/// Number of comparisons and of those that agree.
struct CheckCount {
  std::size_t all = 0; ///< that were judged
  std::size_t agree = 0;
  std::size_t same_digits = 0;
  std::size_t not_judged = 0; ///< of runs shorter than the reference asks for; not among `all`
};
/// Counts over all checks, or over one run's.
CheckCount count_checks(const ReportResults &results);
CheckCount count_checks(const ReportResults &results, std::size_t run);

/// The command that makes a run like this one, of a case of the paper, long enough to be judged by the reference values.
std::string judging_command(const Run &run);

} // namespace drumlin::post
