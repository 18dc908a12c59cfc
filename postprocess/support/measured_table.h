// Tables of numbers as loggers and laboratories write them: any separator, decimal point or comma, thousands
// apart, lines above the header, a header of up to four rows (names, units, sensors), comments, blank cells,
// clock times, UTF-8, UTF-16 or Latin-1.
//
// Errors are std::runtime_error of one line that names file, line, column, cell and what is allowed, and
// shows the line and how it was split into cells.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace drumlin::post {

/// How the cells of a file are written; what is not given is found.
struct TableFormat {
  std::optional<char> separator; ///< ',', ';', '\t', '|', or ' ' for any number of blanks
  std::optional<char> decimal;   ///< '.' or ','
  /// A last line without line end is left out even if it has all cells, whose last one may lack digits.
  bool whole_lines = false;
};

/// A column of a measured table.
struct MeasuredColumn {
  std::string header; ///< as the file has it, without blanks at its ends; without a header the number
  std::string name;   ///< the header without a text in brackets at its end
  std::string unit;   ///< this text, or that of the row of units; empty if there is none
  std::vector<std::string> others; ///< its texts in other rows of the header, such as names of sensors
};

/// The days of clock times, of several files one after the other.
struct ClockDays {
  std::optional<long> first; ///< of dates
  double midnights = 0.0;    ///< that times without dates have passed [s]
  double before = 0.0;       ///< the last of these times, from its midnight [s]
};

class MeasuredTable {
public:
  /// Reads a file and finds out how it is written. The rows of numbers begin with the first line that has as
  /// many cells as most lines with numbers, and numbers in the same columns; the header is up to three lines
  /// of texts above them, and a row of units, in any order. Lines of text at the end are left out, and a last
  /// line without line end that lacks cells.
  explicit MeasuredTable(std::filesystem::path file, const TableFormat &format = {});

  MeasuredTable(const MeasuredTable &) = delete; // rows point into its text
  MeasuredTable &operator=(const MeasuredTable &) = delete;

  const std::filesystem::path &file() const { return file_; }
  const std::vector<MeasuredColumn> &columns() const { return columns_; }
  std::size_t rows() const { return rows_.size(); }
  /// Line of the file where a row stands, counted from 1.
  std::size_t line(std::size_t row) const { return lines_.at(row); }

  /// The column whose header or, failing that, whose name this is, in any case if no other has it; failing
  /// both, the column of this number, counted from 1, or that has this text in another row of the header.
  /// Nothing if there is none, or if two columns have this name.
  std::optional<std::size_t> find(std::string_view header) const;
  /// Throws the fault that no column has this name; the message lists those that there are.
  [[noreturn]] void missing(std::string_view header) const;

  /// The cell as it stands in the file.
  std::string cell(std::size_t row, std::size_t column) const;
  /// The finite numbers of a column; NaN for blank cells and for the words of a missing value (NaN, NA, -).
  /// Refused are numbers whose only signs may be decimal signs as well as between thousands.
  /// \param zero a word that stands for 0, in any case
  std::vector<double> numbers(std::size_t column, std::string_view zero = {}) const;
  /// Whether the column has numbers or clock times, and no other text.
  bool is_numeric(std::size_t column) const { return column < numeric_.size() && numeric_[column]; }
  /// Whether the column has clock times, such as 14:03:07.25, with or without a date.
  bool has_clock_times(std::size_t column) const;
  /// Clock times in seconds from the midnight before the first row of all files that share `days`; over
  /// midnight they go on growing. Those that name their zone are turned into UTC.
  std::vector<double> clock_times(std::size_t column, ClockDays &days) const;

  /// Throws the fault that this cell is not allowed.
  [[noreturn]] void refuse(std::size_t row, std::size_t column, std::string_view allowed) const;

  /// How the file was read, in words: "UTF-16, ';' between cells, decimal ',', header in line 4, ...".
  std::string words() const;

private:
  void find_format(const TableFormat &given);
  void find_rows(bool whole_lines);
  bool numbers_sensors(const std::vector<std::string_view> &lines, std::size_t row) const;
  void find_header(const std::vector<std::string_view> &lines, std::size_t first);
  std::vector<std::string> cells_of(std::string_view line) const;
  std::string reading_of(std::string_view line) const;

  std::filesystem::path file_;
  const char *encoding_ = "UTF-8";
  std::string text_; // in UTF-8
  char separator_ = ',';
  char decimal_ = '.';
  bool decimal_given_ = false;
  std::vector<MeasuredColumn> columns_;
  std::size_t width_ = 0;     // cells of a row, those at its end included that are empty in all rows
  std::vector<bool> numeric_; // columns with numbers or clock times
  std::vector<std::string_view> rows_;
  std::vector<std::size_t> lines_;
  std::size_t header_line_ = 0; // 0: none
  std::size_t unit_line_ = 0;
};

} // namespace drumlin::post
