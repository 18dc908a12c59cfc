#include "chain/run_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>
#include <system_error>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr const char *chain_header =
    "time,x_drum,v_drum,a_drum,x_frame,v_frame,a_frame,F_contact,F_excitation,F_bond";
constexpr const char *events_header = "time,event,overlap,overlap_rate,force,id_i,id_j";
constexpr const char *cycles_header =
    "cycle,time,a_drum_min,a_drum_max,F_contact_min,F_contact_max,contact_share,makes,breaks";
constexpr const char *parameters_header = "name,value";

[[noreturn]] void fail(const fs::path &file, std::size_t line, std::string_view column,
                       std::string_view what) {
  std::string where = file.string();
  if (line > 0) where += fmt::format(", line {}", line);
  if (!column.empty()) where += fmt::format(", column '{}'", column);
  throw std::runtime_error(fmt::format("{}: {}", where, what));
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string read_whole_file(const fs::path &file) {
  std::error_code code;
  if (fs::is_directory(file, code)) fail(file, 0, {}, "cannot be read: it is a folder");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(file, 0, {}, fmt::format("cannot be read: {}", std::strerror(errno)));
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (stream.bad()) fail(file, 0, {}, "reading stopped before the end of the file");
  return text;
}

// Walks through a CSV text row by row. Cells are plain or quoted (RFC 4180); empty lines are passed over.
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
  // Takes one cell and what ends it; true if another cell follows in this row.
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
      fail(file_, reached_line_, {},
           fmt::format("found '{}' after a closing quote, expected a comma or line end", ending));
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
    fail(file_, opened, {}, "a quote opened here is never closed");
  }

  fs::path file_;
  std::string text_;
  std::size_t at_ = 0;
  std::size_t reached_line_ = 1;
  std::size_t line_ = 0;
};

std::vector<std::string> read_header(RowScanner &scanner) {
  std::vector<std::string> header;
  if (!scanner.next(header)) fail(scanner.file(), 1, {}, "the file is empty, expected a header line");
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (header[i].empty())
      fail(scanner.file(), scanner.line(), {}, fmt::format("column {} of the header has no name", i + 1));
    if (std::find(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(i), header[i]) !=
        header.begin() + static_cast<std::ptrdiff_t>(i))
      fail(scanner.file(), scanner.line(), header[i], "the header names this column twice");
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
    fail(scanner.file(), scanner.line(), {},
         fmt::format("found {} cells, expected {} as in the header", cells.size(), header.size()));
}

double cell_number(const fs::path &file, std::size_t line, std::string_view column, const std::string &cell) {
  try {
    return number_from_text(cell);
  } catch (const std::invalid_argument &) {
    fail(file, line, column, fmt::format("found '{}', expected a finite number", cell));
  }
}

[[noreturn]] void missing_column(const fs::path &file, std::string_view column,
                                 const std::vector<std::string> &header) {
  fail(file, 1, column,
       fmt::format("the header does not name this column; found {}", fmt::join(header, ",")));
}

void append_number(fmt::memory_buffer &out, double value) {
  fmt::format_to(std::back_inserter(out), "{:.17g}", value);
}

} // namespace

double number_from_text(std::string_view text) {
  std::string_view digits = trimmed(text);
  if (digits.size() > 1 && digits.front() == '+' && digits[1] != '-') digits.remove_prefix(1);
  double value = 0.0;
  const char *end = digits.data() + digits.size();
  const auto [stop, code] = std::from_chars(digits.data(), end, value);
  if (digits.empty() || code != std::errc() || stop != end || !std::isfinite(value))
    throw std::invalid_argument(fmt::format("'{}' is not a finite number", text));
  return value;
}

std::string number_text(double value) { return fmt::format("{:.17g}", value); }

std::string csv_cell(std::string_view text) {
  // Blanks at the ends are quoted too: readers take them off plain cells.
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
    values.push_back(cell_number(file_, lines_[i], column, rows_[i][index]));
  return values;
}

std::vector<long> Table::integers(std::string_view column) const {
  const std::size_t index = index_of(column);
  std::vector<long> values;
  values.reserve(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const std::string &cell = rows_[i][index];
    long value = 0;
    const char *end = cell.data() + cell.size();
    const auto [stop, code] = std::from_chars(cell.data(), end, value);
    if (cell.empty() || code != std::errc() || stop != end)
      fail(file_, lines_[i], column, fmt::format("found '{}', expected a whole number", cell));
    values.push_back(value);
  }
  return values;
}

Table read_table(const fs::path &file) {
  RowScanner scanner(file, read_whole_file(file));
  std::vector<std::string> header = read_header(scanner);
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> lines;
  std::vector<std::string> cells;
  while (scanner.next(cells)) {
    check_width(scanner, header, cells);
    rows.push_back(cells);
    lines.push_back(scanner.line());
  }
  return {file, std::move(header), std::move(rows), std::move(lines)};
}

ChainHistory read_chain(const fs::path &file) {
  struct Column {
    const char *name;
    std::vector<double> ChainHistory::*values;
    bool frame; // may be missing, but only together with the other columns of the frame
    std::optional<std::size_t> index;
  };
  std::array<Column, 10> columns = {{
      {"time", &ChainHistory::time, false, {}},
      {"x_drum", &ChainHistory::x_drum, false, {}},
      {"v_drum", &ChainHistory::v_drum, false, {}},
      {"a_drum", &ChainHistory::a_drum, false, {}},
      {"F_contact", &ChainHistory::F_contact, false, {}},
      {"F_excitation", &ChainHistory::F_excitation, false, {}},
      {"x_frame", &ChainHistory::x_frame, true, {}},
      {"v_frame", &ChainHistory::v_frame, true, {}},
      {"a_frame", &ChainHistory::a_frame, true, {}},
      {"F_bond", &ChainHistory::F_bond, true, {}},
  }};

  // A long record has millions of cells: they go straight into numbers, not through a Table of text.
  RowScanner scanner(file, read_whole_file(file));
  const std::vector<std::string> header = read_header(scanner);
  bool any_of_frame = false;
  for (Column &column : columns) {
    column.index = find_column(header, column.name);
    any_of_frame = any_of_frame || (column.frame && column.index);
  }
  for (const Column &column : columns) {
    const bool optional = column.frame ? !any_of_frame : column.values == &ChainHistory::F_excitation;
    if (!column.index && !optional) missing_column(file, column.name, header);
  }

  ChainHistory history;
  std::vector<std::string> cells;
  while (scanner.next(cells)) {
    check_width(scanner, header, cells);
    for (const Column &column : columns)
      if (column.index)
        (history.*column.values)
            .push_back(cell_number(file, scanner.line(), column.name, cells[*column.index]));
    const std::size_t rows = history.size();
    if (rows > 1 && !(history.time[rows - 1] > history.time[rows - 2]))
      fail(file, scanner.line(), "time",
           fmt::format("found {}, expected more than {} of the row before", history.time[rows - 1],
                       history.time[rows - 2]));
  }
  if (history.F_excitation.empty()) history.F_excitation.assign(history.size(), 0.0);
  return history;
}

std::vector<ContactEvent> read_events(const fs::path &file) {
  const Table table = read_table(file);
  const std::vector<double> time = table.numbers("time");
  const std::vector<std::string> kind = table.text("event");
  const std::vector<double> overlap = table.numbers("overlap");
  const std::vector<double> overlap_rate = table.numbers("overlap_rate");
  const std::vector<double> force = table.numbers("force");
  const std::vector<long> id_i = table.integers("id_i");
  const std::vector<long> id_j = table.integers("id_j");
  std::vector<ContactEvent> events;
  events.reserve(table.rows());
  for (std::size_t i = 0; i < table.rows(); ++i) {
    if (kind[i] != "make" && kind[i] != "break")
      fail(file, table.line(i), "event", fmt::format("found '{}', expected make or break", kind[i]));
    events.push_back({time[i], kind[i] == "make", overlap[i], overlap_rate[i], force[i], id_i[i], id_j[i]});
  }
  return events;
}

std::vector<CycleSummary> read_cycles(const fs::path &file) {
  const Table table = read_table(file);
  const auto counts = [&table](const char *column) {
    std::vector<long> values =
        table.has(column) ? table.integers(column) : std::vector<long>(table.rows(), 0);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (values[i] < 0 || values[i] > std::numeric_limits<int>::max())
        fail(table.file(), table.line(i), column, fmt::format("found {}, expected a count", values[i]));
    return values;
  };
  const std::vector<long> cycle = counts("cycle");
  const std::vector<long> makes = counts("makes");
  const std::vector<long> breaks = counts("breaks");
  if (!table.has("cycle")) missing_column(file, "cycle", table.header());
  const std::vector<double> time = table.numbers("time");
  const std::vector<double> a_min = table.numbers("a_drum_min");
  const std::vector<double> a_max = table.numbers("a_drum_max");
  const std::vector<double> F_min = table.numbers("F_contact_min");
  const std::vector<double> F_max = table.numbers("F_contact_max");
  const std::vector<double> share = table.numbers("contact_share");
  std::vector<CycleSummary> cycles;
  cycles.reserve(table.rows());
  for (std::size_t i = 0; i < table.rows(); ++i)
    cycles.push_back({static_cast<int>(cycle[i]), time[i], a_min[i], a_max[i], F_min[i], F_max[i], share[i],
                      static_cast<int>(makes[i]), static_cast<int>(breaks[i])});
  return cycles;
}

std::map<std::string, std::string> read_parameters(const fs::path &file) {
  const Table table = read_table(file);
  const std::vector<std::string> names = table.text("name");
  const std::vector<std::string> values = table.text("value");
  std::map<std::string, std::string> parameters;
  for (std::size_t i = 0; i < table.rows(); ++i)
    if (!parameters.emplace(names[i], values[i]).second)
      fail(file, table.line(i), "name", fmt::format("found '{}' a second time", names[i]));
  return parameters;
}

std::string chain_text(const ChainHistory &history) {
  const bool frame = history.has_frame();
  using Values = std::vector<double> ChainHistory::*;
  constexpr std::array<Values, 10> with_frame = {
      &ChainHistory::time,         &ChainHistory::x_drum,  &ChainHistory::v_drum,  &ChainHistory::a_drum,
      &ChainHistory::x_frame,      &ChainHistory::v_frame, &ChainHistory::a_frame, &ChainHistory::F_contact,
      &ChainHistory::F_excitation, &ChainHistory::F_bond};
  constexpr std::array<Values, 6> without_frame = {&ChainHistory::time,      &ChainHistory::x_drum,
                                                   &ChainHistory::v_drum,    &ChainHistory::a_drum,
                                                   &ChainHistory::F_contact, &ChainHistory::F_excitation};
  std::vector<const std::vector<double> *> columns;
  if (frame)
    for (const Values values : with_frame)
      columns.push_back(&(history.*values));
  else
    for (const Values values : without_frame)
      columns.push_back(&(history.*values));
  for (const std::vector<double> *column : columns)
    if (column->size() != history.size())
      throw std::invalid_argument(
          fmt::format("a chain history has columns of {} and of {} rows", history.size(), column->size()));

  fmt::memory_buffer out;
  out.append(std::string_view(frame ? chain_header : "time,x_drum,v_drum,a_drum,F_contact,F_excitation"));
  for (std::size_t row = 0; row < history.size(); ++row) {
    char separator = '\n';
    for (const std::vector<double> *column : columns) {
      out.push_back(separator);
      append_number(out, (*column)[row]);
      separator = ',';
    }
  }
  out.push_back('\n');
  return fmt::to_string(out);
}

std::string events_text(const std::vector<ContactEvent> &events) {
  std::string text = fmt::format("{}\n", events_header);
  for (const ContactEvent &event : events)
    text +=
        fmt::format("{:.17g},{},{:.17g},{:.17g},{:.17g},{},{}\n", event.time, event.make ? "make" : "break",
                    event.overlap, event.overlap_rate, event.force, event.id_i, event.id_j);
  return text;
}

std::string cycles_text(const std::vector<CycleSummary> &cycles) {
  std::string text = fmt::format("{}\n", cycles_header);
  for (const CycleSummary &cycle : cycles)
    text += fmt::format("{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{},{}\n", cycle.cycle, cycle.time,
                        cycle.a_drum_min, cycle.a_drum_max, cycle.F_contact_min, cycle.F_contact_max,
                        cycle.contact_share, cycle.makes, cycle.breaks);
  return text;
}

std::string parameters_text(const std::vector<std::pair<std::string, std::string>> &parameters) {
  std::string text = fmt::format("{}\n", parameters_header);
  for (const auto &[name, value] : parameters)
    text += fmt::format("{},{}\n", csv_cell(name), csv_cell(value));
  return text;
}

std::vector<std::pair<std::string, std::string>> parameter_values(const ChainParameters &p) {
  std::vector<std::pair<std::string, std::string>> values = {{"transition", transition_name(p.transition)}};
  for (const ChainNumber &number : chain_numbers)
    values.emplace_back(number.name, number_text(p.*number.value));
  return values;
}

void write_chain(const fs::path &file, const ChainHistory &history) {
  write_files({{file, chain_text(history)}});
}

void write_events(const fs::path &file, const std::vector<ContactEvent> &events) {
  write_files({{file, events_text(events)}});
}

void write_cycles(const fs::path &file, const std::vector<CycleSummary> &cycles) {
  write_files({{file, cycles_text(cycles)}});
}

void write_parameters(const fs::path &file,
                      const std::vector<std::pair<std::string, std::string>> &parameters) {
  write_files({{file, parameters_text(parameters)}});
}

} // namespace drumlin::post
