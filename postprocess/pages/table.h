// A table of a page, as text: the page and its CSV file have the same cells.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
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

  PageTable() = default;
  /// \param columns the header, " | " between its cells
  PageTable(std::string table_name, std::string table_title, const std::string &columns,
            std::size_t columns_of_words = 1);

  void add(std::vector<std::string> row, RowState state = RowState::plain);
  /// Number of rows in a state.
  std::size_t count(RowState state) const;
};

/// A column of a table: its header, and its cell in the row of a subject.
template <class Subject>
struct TableColumn {
  const char *header;
  std::function<std::string(const Subject &)> cell;
};
template <class Subject>
using TableColumns = std::vector<TableColumn<Subject>>;

/// Gives a table the header of its columns.
template <class Subject>
void set_header(PageTable &table, const TableColumns<Subject> &columns) {
  for (const TableColumn<Subject> &column : columns)
    table.header.emplace_back(column.header);
}

/// Adds the row of a subject.
template <class Subject>
void add_row(PageTable &table, const TableColumns<Subject> &columns, const Subject &subject,
             RowState state = RowState::plain) {
  std::vector<std::string> cells;
  for (const TableColumn<Subject> &column : columns)
    cells.push_back(column.cell(subject));
  table.add(std::move(cells), state);
}

/// A table as CSV.
std::string table_csv(const PageTable &table);

/// An acceptance criterion with its bound, the measured value, and whether the value meets it.
struct Acceptance {
  std::string criterion, measured;
  bool holds;
};

/// The table of all criteria on a study's page, and data/acceptance.csv.
PageTable acceptance_table(const std::vector<Acceptance> &criteria);

/// "7 of 8 acceptance criteria hold.", with the criteria that do not.
std::string acceptance_words(const std::vector<Acceptance> &criteria);

} // namespace drumlin::post
