// CSV files: one reader and one writer for all.
//
// Readers find columns by the names in the header line and throw std::runtime_error with file, line, column,
// the cell and what is allowed. Numbers are written with 17 digits and come back bit for bit.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace drumlin::post {

/// A small CSV table, all cells as text. Quotes as of RFC 4180 are removed: a quoted cell may hold commas,
/// doubled quotes and line ends.
class Table {
public:
  Table(std::filesystem::path file, std::vector<std::string> header,
        std::vector<std::vector<std::string>> rows, std::vector<std::size_t> lines);

  const std::filesystem::path &file() const { return file_; }
  const std::vector<std::string> &header() const { return header_; }
  std::size_t rows() const { return rows_.size(); }
  const std::vector<std::string> &row(std::size_t row) const { return rows_.at(row); }
  /// Line of the file where a row (counted from 0) starts, counted from 1.
  std::size_t line(std::size_t row) const { return lines_.at(row); }
  /// Whether the header names `column`.
  bool has(std::string_view column) const;
  /// Cells of the column as text.
  std::vector<std::string> text(std::string_view column) const;
  /// Cells of the column as finite numbers.
  std::vector<double> numbers(std::string_view column) const;

private:
  std::size_t index_of(std::string_view column) const;

  std::filesystem::path file_;
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
  std::vector<std::size_t> lines_; // where each row starts in the file
};

/// How to treat a row that an interrupted writer has not completed: a row with fewer cells than names in the
/// header, or a last row without line end, whose last number may lack digits.
enum class CutRows {
  refuse, ///< a row of another length than the header is a fault; the line end of the last one may be missing
  last,   ///< a last row without line end is left out; a row of another length is a fault
  forget  ///< both are left out
};

/// Reads any CSV file with a header line.
Table read_table(const std::filesystem::path &file, CutRows cut = CutRows::refuse);

/// The rows of a CSV file one after the other, for records of millions of cells that need no Table of text.
class CsvRows {
public:
  /// \param cut `refuse` or `last`
  explicit CsvRows(const std::filesystem::path &file, CutRows cut = CutRows::refuse);
  ~CsvRows();
  CsvRows(const CsvRows &) = delete;
  CsvRows &operator=(const CsvRows &) = delete;

  /// Place of a column in every row; nothing if the header does not name it.
  std::optional<std::size_t> find(std::string_view column) const;
  /// Throws the fault that the header does not name a column.
  [[noreturn]] void missing(std::string_view column) const;
  const std::vector<std::string> &header() const;
  /// The next row, as many cells as names in the header; false at the end of the file.
  bool next(std::vector<std::string> &cells);
  /// The same with so many cells fewer, where a name of the header contains a comma.
  bool next(std::vector<std::string> &cells, std::size_t fewer);
  /// Line of the file where the row that next() gave starts, counted from 1.
  std::size_t line() const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The fault that a file or a column of it is missing: that of another kind of file, not of a damaged one.
class MissingColumn : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// The finite number in a cell; a fault that names file, line and column if it holds none.
double csv_number(const std::filesystem::path &file, std::size_t line, std::string_view column,
                  const std::string &cell);

/// Throws std::runtime_error "FILE, line LINE, column 'COLUMN': WHAT"; line 0 and an empty column are left
/// out.
[[noreturn]] void csv_fault(const std::filesystem::path &file, std::size_t line, std::string_view column,
                            std::string_view what);

/// Throws std::runtime_error "FILE, line LINE, column 'COLUMN' is 'CELL'; allowed: ALLOWED".
[[noreturn]] void csv_refusal(const std::filesystem::path &file, std::size_t line, std::string_view column,
                              std::string_view cell, std::string_view allowed);

/// One line of CSV with its line end.
std::string csv_line(const std::vector<std::string> &cells);

/// One cell of CSV: `text` itself, or quoted if it holds a comma, a quote or a line end.
std::string csv_cell(std::string_view text);

/// The finite number that `text` is, without further characters; else std::invalid_argument.
double number_from_text(std::string_view text);

/// The number that `text` is, which may be infinite or NaN; nothing if it is anything else.
std::optional<double> any_number_from_text(std::string_view text);

/// The whole number that `text` is; nothing if it is anything else.
std::optional<long> whole_number_from_text(std::string_view text);

/// The digits with which a number comes back bit for bit.
constexpr int all_digits = 17;

/// The number with so many significant digits, without zeros at its end.
std::string number_text(double value, int digits = all_digits);

} // namespace drumlin::post
