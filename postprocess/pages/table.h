// A table of a page, as text: the page and the CSV file beside it print the same cells.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace drumlin::post {

/// What stands in a cell that has no value; the CSV has an empty cell in its place.
constexpr const char *no_value = "–";

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

/// A table as CSV.
std::string table_csv(const ReportTable &table);

} // namespace drumlin::post
