#include "support/csv.h"

#include "support/files.h"
#include "support/units.h"
#include "support/text.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

std::string place_in(const fs::path &file, std::size_t line, std::string_view column) {
  std::string place = file.string();
  if (line > 0) place += fmt::format(", line {}", line);
  if (!column.empty()) place += fmt::format(", column '{}'", column);
  return place;
}

} // namespace

void csv_fault(const fs::path &file, std::size_t line, std::string_view column, std::string_view what) {
  throw std::runtime_error(fmt::format("{}: {}", place_in(file, line, column), what));
}

void csv_refusal(const fs::path &file, std::size_t line, std::string_view column, std::string_view cell,
                 std::string_view allowed) {
  throw std::runtime_error(refusal(place_in(file, line, column), cell, allowed));
}

namespace {

std::string read_whole_file(const fs::path &file) {
  std::error_code ignored; // then read_text() tells why
  if (!fs::exists(file, ignored))
    throw MissingColumn(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(ENOENT)));
  return read_text(file);
}

// The file's text, without a last row that lacks its line end if rows may be cut.
std::string text_of(const fs::path &file, CutRows cut) {
  std::string text = read_whole_file(file);
  if (cut != CutRows::refuse) text.erase(text.rfind('\n') + 1); // npos + 1 is 0
  return text;
}

// Walks through a CSV text row by row. Cells are plain or quoted (RFC 4180); empty lines are skipped.
class RowScanner {
public:
  RowScanner(fs::path file, std::string text) : file_(std::move(file)), text_(std::move(text)) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text_.compare(0, byte_order_mark.size(), byte_order_mark) == 0) at_ = byte_order_mark.size();
  }

  // The next row's cells; false at the end of the text. The cells' memory is used again from row to row.
  bool next(std::vector<std::string> &cells) {
    while (at_ < text_.size() && (text_[at_] == '\n' || text_[at_] == '\r')) {
      if (text_[at_] == '\n') ++reached_line_;
      ++at_;
    }
    if (at_ >= text_.size()) return false;
    line_ = reached_line_;
    std::size_t count = 0;
    bool more = true;
    while (more) {
      if (count == cells.size()) cells.emplace_back();
      more = read_cell(cells[count]);
      ++count;
    }
    cells.resize(count);
    return true;
  }

  const fs::path &file() const { return file_; }
  // Where the row that next() gave starts, counted from 1.
  std::size_t line() const { return line_; }

private:
  // Reads one cell and the comma or line end behind it; true if another cell follows in this row.
  bool read_cell(std::string &cell) {
    cell.clear();
    if (at_ < text_.size() && text_[at_] == '"') {
      read_quoted(cell);
    } else {
      const std::size_t end = std::min(text_.find_first_of(",\n", at_), text_.size());
      cell.assign(trimmed(std::string_view(text_).substr(at_, end - at_)));
      at_ = end;
    }
    if (at_ < text_.size() && text_[at_] == '\r') ++at_;
    if (at_ >= text_.size()) return false;
    const char ending = text_[at_++];
    if (ending == ',') return true;
    if (ending != '\n')
      csv_fault(file_, reached_line_, {},
                refusal("what follows a closing quote", std::string(1, ending), "a comma or line end"));
    ++reached_line_;
    return false;
  }

  void read_quoted(std::string &cell) {
    const std::size_t opened = reached_line_;
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '"') {
        ++at_;
        if (at_ >= text_.size() || text_[at_] != '"') return;
      } else if (text_[at_] == '\n') {
        ++reached_line_;
      }
      cell += text_[at_];
    }
    csv_fault(file_, opened, {}, "a quote opened here is never closed");
  }

  fs::path file_;
  std::string text_;
  std::size_t at_ = 0;
  std::size_t reached_line_ = 1;
  std::size_t line_ = 0;
};

std::vector<std::string> read_header(RowScanner &scanner) {
  std::vector<std::string> header;
  if (!scanner.next(header)) csv_fault(scanner.file(), 1, {}, "the file is empty, expected a header line");
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (header[i].empty())
      csv_fault(scanner.file(), scanner.line(), {},
                fmt::format("column {} of the header has no name", i + 1));
    if (std::find(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(i), header[i]) !=
        header.begin() + static_cast<std::ptrdiff_t>(i))
      csv_fault(scanner.file(), scanner.line(), header[i], "the header names this column twice");
  }
  return header;
}

std::optional<std::size_t> find_column(const std::vector<std::string> &header, std::string_view column) {
  const auto found = std::find(header.begin(), header.end(), column);
  if (found == header.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header.begin());
}

void check_width(const RowScanner &scanner, const std::vector<std::string> &header,
                 const std::vector<std::string> &cells) {
  if (cells.size() != header.size())
    csv_fault(scanner.file(), scanner.line(), {},
              refusal("the number of cells", fmt::format("{}", cells.size()),
                      fmt::format("{} as in the header", header.size())));
}

[[noreturn]] void missing_column(const fs::path &file, std::string_view column,
                                 const std::vector<std::string> &header) {
  throw MissingColumn(fmt::format("{}: {}", place_in(file, 1, {}),
                                  refusal("the header", fmt::format("{}", fmt::join(header, ",")),
                                          fmt::format("one that names '{}'", column))));
}

} // namespace

double csv_number(const fs::path &file, std::size_t line, std::string_view column, const std::string &cell) {
  try {
    return number_from_text(cell);
  } catch (const std::invalid_argument &) {
    csv_refusal(file, line, column, cell, "a finite number");
  }
}

std::optional<double> any_number_from_text(std::string_view text) {
  std::string_view digits = trimmed(text);
  if (digits.size() > 1 && digits.front() == '+' && digits[1] != '-') digits.remove_prefix(1);
  double value = 0.0;
  const char *end = digits.data() + digits.size();
  const auto [stop, code] = std::from_chars(digits.data(), end, value);
  if (digits.empty() || code != std::errc() || stop != end) return std::nullopt;
  return value;
}

double number_from_text(std::string_view text) {
  const std::optional<double> value = any_number_from_text(text);
  if (!value || !std::isfinite(*value))
    throw std::invalid_argument(fmt::format("'{}' is not a finite number", text));
  return *value;
}

std::optional<long> whole_number_from_text(std::string_view text) {
  long value = 0;
  const char *end = text.data() + text.size();
  const auto [stop, code] = std::from_chars(text.data(), end, value);
  if (text.empty() || code != std::errc() || stop != end) return std::nullopt;
  return value;
}

std::string number_text(double value, int digits) { return fmt::format("{:.{}g}", value, digits); }

std::string csv_line(const std::vector<std::string> &cells) {
  std::string line;
  for (const std::string &cell : cells)
    line += (&cell == &cells.front() ? "" : ",") + csv_cell(cell);
  return line + '\n';
}

std::string csv_cell(std::string_view text) {
  // Blanks at the ends are quoted too: readers remove them from plain cells.
  if (text.find_first_of(",\"\r\n") == std::string_view::npos && trimmed(text).size() == text.size())
    return std::string(text);
  std::string cell = "\"";
  for (const char letter : text) {
    if (letter == '"') cell += '"';
    cell += letter;
  }
  return cell + '"';
}

Table::Table(fs::path file, std::vector<std::string> header, std::vector<std::vector<std::string>> rows,
             std::vector<std::size_t> lines)
    : file_(std::move(file)), header_(std::move(header)), rows_(std::move(rows)), lines_(std::move(lines)) {}

bool Table::has(std::string_view column) const { return find_column(header_, column).has_value(); }

std::size_t Table::index_of(std::string_view column) const {
  const std::optional<std::size_t> index = find_column(header_, column);
  if (!index) missing_column(file_, column, header_);
  return *index;
}

std::vector<std::string> Table::text(std::string_view column) const {
  const std::size_t index = index_of(column);
  std::vector<std::string> cells;
  cells.reserve(rows_.size());
  for (const std::vector<std::string> &row : rows_)
    cells.push_back(row[index]);
  return cells;
}

std::vector<double> Table::numbers(std::string_view column) const {
  const std::size_t index = index_of(column);
  std::vector<double> values;
  values.reserve(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i)
    values.push_back(csv_number(file_, lines_[i], column, rows_[i][index]));
  return values;
}

struct CsvRows::State {
  RowScanner scanner;
  std::vector<std::string> header;
};

CsvRows::CsvRows(const fs::path &file, CutRows cut)
    : state_(std::make_unique<State>(State{RowScanner(file, text_of(file, cut)), {}})) {
  state_->header = read_header(state_->scanner);
}

CsvRows::~CsvRows() = default;

std::optional<std::size_t> CsvRows::find(std::string_view column) const {
  return find_column(state_->header, column);
}

void CsvRows::missing(std::string_view column) const {
  missing_column(state_->scanner.file(), column, state_->header);
}

const std::vector<std::string> &CsvRows::header() const { return state_->header; }

bool CsvRows::next(std::vector<std::string> &cells) { return next(cells, 0); }

bool CsvRows::next(std::vector<std::string> &cells, std::size_t fewer) {
  if (!state_->scanner.next(cells)) return false;
  if (fewer == 0 || cells.size() + fewer != state_->header.size())
    check_width(state_->scanner, state_->header, cells);
  return true;
}

std::size_t CsvRows::line() const { return state_->scanner.line(); }

Table read_table(const fs::path &file, CutRows cut) {
  RowScanner scanner(file, text_of(file, cut));
  std::vector<std::string> header = read_header(scanner);
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> lines;
  std::vector<std::string> cells;
  while (scanner.next(cells)) {
    if (cut == CutRows::forget && cells.size() != header.size()) continue;
    check_width(scanner, header, cells);
    rows.push_back(cells);
    lines.push_back(scanner.line());
  }
  return {file, std::move(header), std::move(rows), std::move(lines)};
}

} // namespace drumlin::post
