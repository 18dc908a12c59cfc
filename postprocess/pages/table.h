// A table of a page, as text: the page and its CSV file have the same cells.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace drumlin::post {

/// Text of a cell without a value; the CSV file has an empty cell in its place.
constexpr const char *no_value = "–";

/// Whether a row is good. The page shows it by a mark and a shade; `plain` rows are not judged.
enum class RowState { plain, agrees, differs };

/// One table: header, rows and the notes below it.
struct PageTable {
  std::string section; ///< id of the report's section that shows it
  std::string name;    ///< stem of data/NAME.csv
  std::string title;
  std::vector<std::string> header; ///< with units
  std::vector<std::vector<std::string>> rows;
  std::vector<RowState> states; ///< one per row
  std::string verdict;   ///< header of the column that says in words whether a row is good; the page shows
                         ///< it first. If empty, the page makes such a column of judged rows, "yes" and "no"
  std::string criterion; ///< what judged rows must meet, for the line below the title; may be empty
  std::size_t shown_columns = 0;  ///< first columns that the page shows, 0: all; the CSV file has all
  std::size_t text_columns = 1;   ///< first columns that are words (left-aligned)
  std::vector<std::string> notes; ///< sentences below the table

  void add(std::vector<std::string> row, RowState state = RowState::plain);
  /// Number of rows in a state.
  std::size_t count(RowState state) const;
};

/// A table as CSV.
std::string table_csv(const PageTable &table);

} // namespace drumlin::post
