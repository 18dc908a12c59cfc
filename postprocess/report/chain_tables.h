// The report's tables, as text: the page and the CSV files beside it print the same cells.
#pragma once

#include <string>
#include <vector>

#include "report/chain_measures.h"

namespace drumlin::post {

/// How a row stands: decides its mark on the page.
enum class RowState { plain, agrees, differs };

/// One table with header, rows and what is said below it.
struct ReportTable {
  std::string section; ///< id of the report's section that shows it
  std::string name;    ///< stem of data/NAME.csv
  std::string title;
  std::vector<std::string> header; ///< with units
  std::vector<std::vector<std::string>> rows;
  std::vector<RowState> states;   ///< one per row
  std::size_t shown_columns = 0;  ///< first columns that the page shows; the CSV has all
  std::size_t text_columns = 1;   ///< first columns that are words (left-aligned)
  std::vector<std::string> notes; ///< sentences below the table

  void add(std::vector<std::string> row, RowState state = RowState::plain);
};

/// All tables that the results fill, in order.
std::vector<ReportTable> make_tables(const ReportResults &results);

/// A table as CSV.
std::string table_csv(const ReportTable &table);

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
