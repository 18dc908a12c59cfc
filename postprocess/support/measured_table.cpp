#include "support/measured_table.h"

#include "support/csv.h"
#include "support/files.h"
#include "support/units.h"
#include "support/text.h"

#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace {

void append_utf8(std::string &text, std::uint32_t code) {
  const auto put = [&text](std::uint32_t byte) { text += static_cast<char>(byte); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xC0 | (code >> 6));
    put(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    put(0xE0 | (code >> 12));
    put(0x80 | ((code >> 6) & 0x3F));
    put(0x80 | (code & 0x3F));
  } else {
    put(0xF0 | (code >> 18));
    put(0x80 | ((code >> 12) & 0x3F));
    put(0x80 | ((code >> 6) & 0x3F));
    put(0x80 | (code & 0x3F));
  }
}

std::string from_utf16(std::string_view bytes, bool low_first) {
  std::string text;
  const auto unit = [&](std::size_t i) {
    const auto a = static_cast<unsigned char>(bytes[i]), b = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<std::uint32_t>(low_first ? a | (b << 8) : b | (a << 8));
  };
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (code >= 0xD800 && code < 0xDC00 && i + 3 < bytes.size()) { // the first of a pair
      code = 0x10000 + ((code - 0xD800) << 10) + (unit(i + 2) - 0xDC00);
      i += 2;
    }
    append_utf8(text, code);
  }
  return text;
}

std::string from_latin1(std::string_view bytes) {
  std::string text;
  for (const char byte : bytes)
    append_utf8(text, static_cast<unsigned char>(byte));
  return text;
}

/// The text of a file as UTF-8; sets the name of its encoding.
std::string decoded(std::string bytes, const char *&encoding) {
  const auto begins = [&bytes](std::string_view mark) { return bytes.compare(0, mark.size(), mark) == 0; };
  // Without a byte order mark, digits of UTF-16 have a zero in every second byte.
  const auto zero = [&bytes](std::size_t i) { return bytes.size() > i && bytes[i] == '\0'; };
  if (begins("\xFF\xFE") || (zero(1) && zero(3) && !zero(0))) {
    encoding = "UTF-16";
    return from_utf16(std::string_view(bytes).substr(begins("\xFF\xFE") ? 2 : 0), true);
  }
  if (begins("\xFE\xFF") || (zero(0) && zero(2) && !zero(1))) {
    encoding = "UTF-16";
    return from_utf16(std::string_view(bytes).substr(begins("\xFE\xFF") ? 2 : 0), false);
  }
  if (begins("\xEF\xBB\xBF")) bytes.erase(0, 3);
  const bool ascii =
      std::all_of(bytes.begin(), bytes.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
  if (ascii || valid_utf8(bytes) == bytes) return bytes;
  encoding = "Latin-1";
  return from_latin1(bytes);
}

/// The lines of a text, which end with LF, CR LF or CR, without these.
std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    lines.push_back(text.substr(0, end));
    const bool both = end + 1 < text.size() && text[end] == '\r' && text[end + 1] == '\n';
    text.remove_prefix(std::min(text.size(), end + (both ? 2 : 1)));
  }
  return lines;
}

bool is_comment(std::string_view line) {
  const std::string_view text = trimmed(line);
  return !text.empty() && (text[0] == '#' || text[0] == '%' || text.substr(0, 2) == "//");
}

/// Calls `take` for each cell of a line, without its quotes and blanks.
template <class Take>
void for_each_cell(std::string_view line, char separator, const Take &take) {
  if (separator == ' ') line = trimmed(line);
  std::string unquoted;
  while (true) {
    std::string_view cell;
    std::size_t end = 0;
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
    if (begin < line.size() && line[begin] == '"') {
      unquoted.clear();
      for (end = begin + 1; end < line.size(); ++end) {
        if (line[end] == '"' && (end + 1 >= line.size() || line[++end] != '"')) break;
        unquoted += line[end];
      }
      end = std::min(line.find(separator, std::min(end, line.size())), line.size());
      cell = unquoted;
    } else {
      end = std::min(separator == ' ' ? line.find_first_of(" \t") : line.find(separator), line.size());
      cell = trimmed(line.substr(0, end));
    }
    take(cell);
    if (end >= line.size()) return;
    line.remove_prefix(end + 1);
    if (separator == ' ') line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  }
}

bool is_blank(std::string_view cell) {
  constexpr std::array<std::string_view, 8> words = {"", "-", "--", "NaN", "nan", "NA", "n/a", "?"};
  return std::find(words.begin(), words.end(), cell) != words.end();
}

/// Whether a text has digits alone, and at least one.
bool only_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// How a cell is a number.
struct Number {
  double value;
  char between = '\0'; ///< the sign or blank between its thousands, if there is one
};

/// A number whose thousands stand apart, "1,234.5", "1 234,5" or "1'234", or that has the minus sign or the
/// blanks of a text program.
std::optional<Number> written_number(std::string_view cell, char decimal) {
  std::string text(cell);
  constexpr std::array<std::pair<const char *, const char *>, 6> same = {
      {{"\xE2\x88\x92", "-"}, // minus sign
       {"\xC2\xA0", " "},     // blanks that do not break
       {"\xE2\x80\xAF", " "},
       {"\xE2\x80\x89", " "},
       {"\xE2\x80\x99", "'"}, // the apostrophe of a text program
       {"\xCA\xBC", "'"}}};
  for (const auto &[from, to] : same)
    boost::replace_all(text, from, to);
  text = trimmed(text);
  const std::size_t point = std::min(text.find(decimal), text.size());
  std::string whole = text.substr(0, point);
  const std::string rest = point < text.size() ? '.' + text.substr(point + 1) : "";
  const std::size_t begin = !whole.empty() && (whole[0] == '-' || whole[0] == '+') ? 1 : 0;
  const std::size_t first = std::min(whole.find_first_not_of("0123456789", begin), whole.size());
  Number number{};
  if (first < whole.size()) {
    number.between = whole[first];
    const std::size_t digits = first - begin;
    if (std::string_view(",.' ").find(number.between) == std::string_view::npos || digits < 1 || digits > 3 ||
        whole[begin] == '0')
      return std::nullopt;
    for (std::size_t i = first; i < whole.size(); i += 4)
      if (whole[i] != number.between || whole.size() < i + 4 || !only_digits(whole.substr(i + 1, 3)))
        return std::nullopt;
    whole.erase(std::remove(whole.begin(), whole.end(), number.between), whole.end());
  }
  const std::optional<double> value = any_number_from_text(whole + rest);
  if (!value) return std::nullopt;
  number.value = *value;
  return number;
}

std::optional<Number> number_in(std::string_view cell, char decimal) {
  if (decimal == '.') {
    if (const auto value = any_number_from_text(cell)) return Number{*value};
  } else if (cell.find('.') == std::string_view::npos) {
    std::string text(cell);
    std::replace(text.begin(), text.end(), decimal, '.');
    if (const auto value = any_number_from_text(text)) return Number{*value};
  }
  return written_number(cell, decimal);
}

/// What a number says of its decimal sign.
enum class Decimals {
  none,     ///< it has none, and not more than three digits
  some,     ///< it has one, or so many digits that their thousands do not stand apart
  thousands ///< it has one, which could as well stand between thousands: "1.250"
};

Decimals decimals_in(std::string_view cell, char decimal) {
  if (!cell.empty() && (cell[0] == '-' || cell[0] == '+')) cell.remove_prefix(1);
  const std::size_t point = cell.find(decimal);
  if (point == std::string_view::npos) return cell.size() <= 3 ? Decimals::none : Decimals::some;
  return point >= 1 && point <= 3 && cell[0] != '0' && cell.size() == point + 4 &&
                 only_digits(cell.substr(0, point)) && only_digits(cell.substr(point + 1))
             ? Decimals::thousands
             : Decimals::some;
}

/// A clock time: seconds from midnight, and the day, counted from any day, if there is a date.
struct ClockTime {
  double seconds;
  std::optional<long> day;
  bool universal = false; ///< it named its zone, and the seconds are those of UTC
};

/// A date such as 2026-11-26, 2026/Nov/26 or 26.11.2026 as a day.
std::optional<long> day_in(std::string_view date) {
  std::vector<long> parts;
  while (true) {
    const std::size_t end = std::min(date.find_first_of("-/. "), date.size());
    constexpr std::string_view months = "JanFebMarAprMayJunJulAugSepOctNovDec";
    const std::string_view text = date.substr(0, end);
    const std::size_t place = text.size() == 3 ? months.find(text) : months.size();
    const bool named = place < months.size() && place % 3 == 0;
    const std::optional<long> part = named ? static_cast<long>(place / 3 + 1) : whole_number_from_text(text);
    if (!part) return std::nullopt;
    parts.push_back(*part);
    if (end == date.size()) break;
    date.remove_prefix(end + 1);
  }
  if (parts.size() != 3) return std::nullopt;
  if (parts[0] < 100) std::swap(parts[0], parts[2]);                  // the year stands last
  if (parts[1] > 12 && parts[2] <= 12) std::swap(parts[1], parts[2]); // the month first, as in 11/26/2026
  if (parts[0] < 100 || parts[1] < 1 || parts[1] > 12 || parts[2] < 1 || parts[2] > 31) return std::nullopt;
  std::tm day{};
  day.tm_year = static_cast<int>(parts[0] - 1900);
  day.tm_mon = static_cast<int>(parts[1] - 1);
  day.tm_mday = static_cast<int>(parts[2]);
  constexpr long seconds_of_day = 86400;
  return timegm(&day) / seconds_of_day;
}

/// Takes the zone off the end of a time of day, "Z", "UTC", "+01:00", "+0100" or "-05": by how much its
/// clock is ahead of UTC [s].
std::optional<double> take_zone(std::string_view &time) {
  for (const std::string_view name : {"Z", "UTC", "GMT"})
    if (time.size() > name.size() && time.substr(time.size() - name.size()) == name) {
      time = trimmed(time.substr(0, time.size() - name.size()));
      return 0.0;
    }
  const std::size_t sign = time.find_last_of("+-");
  if (sign == std::string_view::npos || sign == 0) return std::nullopt;
  std::string digits(time.substr(sign + 1));
  if (digits.size() == 5 && digits[2] == ':') digits.erase(2, 1);
  if (!only_digits(digits) || (digits.size() != 2 && digits.size() != 4)) return std::nullopt;
  digits.resize(4, '0');
  const long hours = *whole_number_from_text(digits.substr(0, 2));
  const long minutes = *whole_number_from_text(digits.substr(2));
  if (hours > 14 || minutes > 59) return std::nullopt;
  const double ahead = 3600.0 * static_cast<double>(hours) + 60.0 * static_cast<double>(minutes);
  const bool negative = time[sign] == '-';
  time = trimmed(time.substr(0, sign));
  return negative ? -ahead : ahead;
}

std::optional<ClockTime> clock_in(std::string_view cell) {
  ClockTime clock{};
  double afternoon = 0.0;
  bool halves = false; // 12-hour clock
  for (const auto &[mark, hours] : {std::pair{"AM", 0.0}, std::pair{"PM", 12.0}})
    if (cell.size() > 2 && cell.substr(cell.size() - 2) == mark) {
      cell = trimmed(cell.substr(0, cell.size() - 2));
      afternoon = hours;
      halves = true;
    }
  const std::size_t colon = cell.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const std::size_t space = cell.substr(0, colon).find_last_of(" T");
  if (space != std::string_view::npos) {
    clock.day = day_in(trimmed(cell.substr(0, space)));
    if (!clock.day) return std::nullopt;
    cell = trimmed(cell.substr(space + 1));
  }
  const std::optional<double> ahead = take_zone(cell);
  clock.universal = ahead.has_value();
  const std::size_t first = cell.find(':');
  if (first == std::string_view::npos) return std::nullopt;
  const std::size_t second = cell.find(':', first + 1);
  if (second == std::string_view::npos) return std::nullopt;
  const std::optional<long> hours = whole_number_from_text(cell.substr(0, first));
  const std::optional<long> minutes = whole_number_from_text(cell.substr(first + 1, second - first - 1));
  std::string rest(cell.substr(second + 1));
  if (rest.size() == 6 && rest[2] == ':' && only_digits(rest.substr(3))) rest[2] = '.'; // milliseconds
  std::replace(rest.begin(), rest.end(), ',', '.');
  const std::optional<double> seconds = any_number_from_text(rest);
  if (!hours || !minutes || !seconds || *hours < 0 || *hours > 24 || *minutes < 0 || *minutes > 59 ||
      !(*seconds >= 0.0 && *seconds < 61.0))
    return std::nullopt;
  const auto hour = static_cast<double>(halves ? *hours % 12 : *hours) + afternoon;
  clock.seconds = 3600.0 * hour + 60.0 * static_cast<double>(*minutes) + *seconds - ahead.value_or(0.0);
  return clock;
}

bool is_value(std::string_view cell, char decimal) {
  return number_in(cell, decimal).has_value() || clock_in(cell).has_value();
}

/// Text and unit of a header such as "Acc Z (g)" or "time [ms]".
MeasuredColumn column_of(const std::string &header) {
  MeasuredColumn column{header, header, "", {}};
  const std::size_t size = header.size();
  if (size < 3 || (header.back() != ')' && header.back() != ']')) return column;
  const std::size_t open = header.rfind(header.back() == ')' ? '(' : '[');
  if (open == std::string::npos || open == 0) return column;
  const std::string unit(trimmed(std::string_view(header).substr(open + 1, size - open - 2)));
  column.name = trimmed(std::string_view(header).substr(0, open));
  column.unit = unit;
  return column;
}

/// The unit of a cell of a row of units, with or without brackets; nothing for another text.
std::optional<std::string> unit_cell(std::string_view cell) {
  if (cell.size() > 2 && (cell.front() == '[' || cell.front() == '('))
    cell = trimmed(cell.substr(1, cell.size() - 2));
  return unit_from_text(cell) ? std::optional<std::string>(cell) : std::nullopt;
}

std::string separator_words(char separator) {
  if (separator == '\t') return "tabs between cells";
  if (separator == ' ') return "blanks between cells";
  return fmt::format("'{}' between cells", separator);
}

} // namespace

MeasuredTable::MeasuredTable(std::filesystem::path file, const TableFormat &format)
    : file_(std::move(file)), decimal_given_(format.decimal.has_value()) {
  text_ = decoded(read_text(file_), encoding_);
  find_format(format);
  find_rows(format.whole_lines);
}

std::vector<std::string> MeasuredTable::cells_of(std::string_view line) const {
  std::vector<std::string> cells;
  for_each_cell(line, separator_, [&cells](std::string_view cell) { cells.emplace_back(cell); });
  return cells;
}

// The separator and decimal sign by which the most cells of a sample of the lines are numbers, each other
// text counted against it, and numbers whose thousands stand apart a little less than others. A tab or
// semicolon is preferred where both do equally well. A comma is both signs only of cells in quotes.
void MeasuredTable::find_format(const TableFormat &given) {
  const std::vector<std::string_view> lines = lines_of(text_);
  constexpr std::size_t most = 400;
  const std::size_t step = std::max<std::size_t>(1, lines.size() / most);
  const bool quoted = text_.find('"') != std::string::npos;
  if (given.separator && given.separator == given.decimal && !quoted)
    csv_fault(file_, 0, {},
              refusal("the decimal sign", std::string(1, *given.decimal),
                      "another one than that between cells, or cells in quotes"));
  long best = std::numeric_limits<long>::min();
  bool blank_in_cells = false; // between thousands, with tabs between cells
  for (const char separator : {'\t', ';', '|', ',', ' '})
    for (const char decimal : {'.', ','}) {
      if ((separator == decimal && !quoted) || (separator == ' ' && blank_in_cells) ||
          (given.separator && separator != *given.separator) || (given.decimal && decimal != *given.decimal))
        continue;
      struct Column {
        long sum = 0;      // of kinds
        bool used = false; // not empty in all lines
      };
      std::map<std::size_t, std::vector<Column>> found; // by the number of cells
      for (std::size_t i = 0; i < lines.size(); i += step) {
        if (trimmed(lines[i]).empty() || is_comment(lines[i])) continue;
        constexpr long value = 4, apart = 3, other = -4;
        std::vector<long> kinds; // 0 for a blank cell
        std::vector<bool> used;
        for_each_cell(lines[i], separator, [&](std::string_view cell) {
          const std::optional<Number> number = number_in(cell, decimal);
          kinds.push_back(number           ? number->between == '\0' ? value : apart
                          : clock_in(cell) ? value
                          : is_blank(cell) ? 0
                                           : other);
          used.push_back(!cell.empty());
          if (number && number->between == ' ' && separator == '\t') blank_in_cells = true;
        });
        if (*std::max_element(kinds.begin(), kinds.end()) <= 0) continue;
        std::vector<Column> &columns = found[kinds.size()];
        columns.resize(kinds.size());
        for (std::size_t j = 0; j < kinds.size(); ++j) {
          columns[j].sum += kinds[j];
          columns[j].used = columns[j].used || used[j];
        }
      }
      for (auto &[width, columns] : found) {
        long score = 0;
        for (const Column &column : columns)
          score += column.sum;
        if (score <= best) continue;
        best = score;
        separator_ = separator;
        decimal_ = decimal;
        width_ = columns.size();
        while (!columns.back().used) // blank cells behind the last separator
          columns.pop_back();
        numeric_.clear();
        for (const Column &column : columns)
          numeric_.push_back(column.sum > 0);
      }
    }
  if (numeric_.empty())
    csv_fault(file_, 0, {},
              lines.empty() ? "the file is empty; allowed: a table of numbers"
                            : fmt::format("no line has numbers; allowed: a table of numbers, with ',', ';', "
                                          "tabs, '|' or blanks between cells; the first line is '{}'",
                                          shown(lines.front())));
}

void MeasuredTable::find_rows(bool whole_lines) {
  const std::vector<std::string_view> lines = lines_of(text_);
  const bool complete = text_.empty() || text_.back() == '\n' || text_.back() == '\r';
  const std::size_t width = numeric_.size();
  bool begun = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (trimmed(lines[i]).empty() || is_comment(lines[i])) continue;
    if (!begun) {
      std::size_t count = 0, filled = 0;
      bool values = true, any = false;
      for_each_cell(lines[i], separator_, [&](std::string_view cell) {
        if (count < width && numeric_[count]) {
          const bool value = is_value(cell, decimal_);
          any = any || value;
          values = values && (value || is_blank(cell));
        }
        ++count;
        if (!cell.empty()) filled = count;
      });
      begun = count >= width && filled <= width && values && any && !numbers_sensors(lines, i);
      if (!begun) continue;
      find_header(lines, i);
    }
    std::size_t count = 0, filled = 0;
    for_each_cell(lines[i], separator_, [&](std::string_view cell) {
      ++count;
      if (!cell.empty()) filled = count;
    });
    if ((count < width || whole_lines) && i + 1 == lines.size() && !complete) break; // cut
    // Lines of text at the end, "End of file".
    if (count < width &&
        std::none_of(lines.begin() + static_cast<std::ptrdiff_t>(i), lines.end(),
                     [this](std::string_view line) {
                       const std::vector<std::string> cells = cells_of(line);
                       return std::any_of(cells.begin(), cells.end(),
                                          [this](const auto &cell) { return is_value(cell, decimal_); });
                     }))
      break;
    if (count < width || filled > width)
      csv_fault(file_, i + 1, {},
                refusal("the number of cells", fmt::format("{}", count),
                        fmt::format("{} as in line {}; {}", width, lines_.empty() ? i + 1 : lines_.front(),
                                    reading_of(lines[i]))));
    rows_.push_back(lines[i]);
    lines_.push_back(i + 1);
  }
}

// A row of different whole numbers above 0 below a row of texts, when the rows that follow have a decimal
// sign in each of these columns.
bool MeasuredTable::numbers_sensors(const std::vector<std::string_view> &lines, std::size_t row) const {
  const std::vector<std::string> cells = cells_of(lines[row]);
  std::set<std::string> different;
  std::size_t filled = 0;
  for (const std::string &cell : cells) {
    if (cell.empty()) continue;
    if (!only_digits(cell) || cell.find_first_not_of('0') == std::string::npos) return false;
    different.insert(cell);
    ++filled;
  }
  if (row == 0 || different.size() < std::max<std::size_t>(filled, 2)) return false;
  const std::vector<std::string> above = cells_of(lines[row - 1]);
  if (above.size() < numeric_.size() ||
      std::any_of(above.begin(), above.end(), [&](const auto &cell) { return is_value(cell, decimal_); }))
    return false;
  constexpr std::size_t most = 5;
  std::size_t seen = 0;
  for (std::size_t i = row + 1; i < lines.size() && seen < most; ++i, ++seen) {
    const std::vector<std::string> below = cells_of(lines[i]);
    for (std::size_t j = 0; j < std::min(cells.size(), below.size()); ++j)
      if (!cells[j].empty() && below[j].find(decimal_) == std::string::npos) return false;
  }
  return seen > 0;
}

void MeasuredTable::find_header(const std::vector<std::string_view> &lines, std::size_t first) {
  const std::size_t width = numeric_.size();
  struct HeaderRow {
    std::vector<std::string> cells;
    std::size_t line;
    bool with_units = false;   // in brackets, in half of its cells or more
    bool with_numbers = false; // those of sensors, or of a line above the header
  };
  std::vector<HeaderRow> rows; // of texts, from the lowest up
  std::optional<HeaderRow> units;
  std::optional<std::size_t> above_units;
  const auto fits = [&](const std::vector<std::string> &cells) {
    return cells.size() >= width &&
           (cells.size() <= width_ || // over the empty cells at the end of the rows, too
            std::all_of(cells.begin() + static_cast<std::ptrdiff_t>(width), cells.end(),
                        [](const std::string &cell) { return cell.empty(); })) &&
           std::any_of(cells.begin(), cells.end(), [](const std::string &cell) { return !cell.empty(); });
  };
  constexpr std::size_t most_rows = 3;
  for (std::size_t i = first; i-- > 0 && rows.size() < most_rows;) {
    if (trimmed(lines[i]).empty()) {
      if (rows.empty()) continue;
      break;
    }
    std::string_view line = lines[i];
    const bool comment = is_comment(line);
    if (comment) line = trimmed(trimmed(line).substr(trimmed(line).find_first_not_of("#%/ ")));
    HeaderRow row{cells_of(line), i + 1};
    std::vector<std::string> &cells = row.cells;
    // Some programs leave a comma in the name of the last column unquoted.
    if (cells.size() == width + 1 && !cells.back().empty() && cells.back().front() == '_') {
      cells[width - 1] += separator_ + cells.back();
      cells.pop_back();
    }
    if (!fits(cells)) {
      if (comment) continue;
      break;
    }
    cells.resize(width);
    // A row of units may have one that is not known.
    std::size_t known = 0, filled = 0, bracketed = 0;
    for (const std::string &cell : cells) {
      if (cell.empty()) continue;
      ++filled;
      if (unit_cell(cell)) ++known;
      if (unit_from_text(column_of(cell).unit)) ++bracketed;
      row.with_numbers = row.with_numbers || is_value(cell, decimal_);
    }
    if (2 * known > filled && !units) {
      units = std::move(row);
      above_units = rows.size();
      continue;
    }
    row.with_units = 2 * bracketed >= filled && bracketed > 0 && !row.with_numbers;
    rows.push_back(std::move(row));
  }
  if (rows.empty() && units) { // they are the names, too
    rows.push_back(*units);
    above_units = 0;
  }
  // The names: the row above the units, or with units in brackets, or the lowest one of texts.
  std::size_t names = 0;
  const auto choose = [&](const auto &is) {
    const auto found = std::find_if(rows.begin(), rows.end(), is);
    if (found == rows.end()) return false;
    names = static_cast<std::size_t>(found - rows.begin());
    return true;
  };
  if (above_units && *above_units < rows.size())
    names = *above_units;
  else if (!choose([](const HeaderRow &row) { return row.with_units; }))
    choose([](const HeaderRow &row) { return !row.with_numbers; });
  if (!rows.empty()) header_line_ = rows[names].line;
  if (units) unit_line_ = units->line;
  for (std::size_t j = 0; j < width; ++j) {
    const bool named = !rows.empty() && !rows[names].cells[j].empty();
    MeasuredColumn &column =
        columns_.emplace_back(column_of(named ? rows[names].cells[j] : fmt::format("{}", j + 1)));
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (i != names && !rows[i].cells[j].empty()) column.others.push_back(rows[i].cells[j]);
    if (units && !units->cells[j].empty()) column.unit = unit_cell(units->cells[j]).value_or(units->cells[j]);
  }
}

std::optional<std::size_t> MeasuredTable::find(std::string_view header) const {
  for (const bool with_case : {true, false})
    for (const auto part : {&MeasuredColumn::header, &MeasuredColumn::name}) {
      std::optional<std::size_t> place;
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        const std::string &own = columns_[i].*part;
        if (with_case ? own != header : !boost::iequals(own, header)) continue;
        if (place) return std::nullopt;
        place = i;
      }
      if (place) return place;
    }
  const std::optional<long> number = whole_number_from_text(header);
  if (number && *number >= 1 && static_cast<std::size_t>(*number) <= columns_.size())
    return static_cast<std::size_t>(*number - 1);
  std::optional<std::size_t> place;
  for (std::size_t i = 0; i < columns_.size(); ++i)
    for (const std::string &other : columns_[i].others) {
      if (other != header && column_of(other).name != header) continue;
      if (place && *place != i) return std::nullopt;
      place = i;
    }
  return place;
}

void MeasuredTable::missing(std::string_view header) const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    names.push_back(header_line_ > 0 ? fmt::format("{} '{}'", i + 1, columns_[i].header)
                                     : fmt::format("{}", i + 1));
    for (const std::string &other : columns_[i].others)
      names.back() += fmt::format(" or '{}'", other);
  }
  csv_fault(file_, header_line_, {},
            refusal("the column", header,
                    fmt::format("the name, if only one column has it, or the number of one of these: {}; {}",
                                fmt::join(names, ", "), words())));
}

std::string MeasuredTable::cell(std::size_t row, std::size_t column) const {
  return cells_of(rows_.at(row)).at(column);
}

std::vector<double> MeasuredTable::numbers(std::size_t column, std::string_view zero) const {
  std::vector<double> values;
  values.reserve(rows_.size());
  bool clear = decimal_given_, whole = false; // numbers that tell what their signs are, and that have none
  std::optional<std::size_t> unclear;
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    std::size_t place = 0;
    for_each_cell(rows_[row], separator_, [&](std::string_view cell) {
      if (place++ != column) return;
      if (!zero.empty() && boost::iequals(trimmed(cell), zero)) return values.push_back(0.0);
      const std::optional<Number> number = number_in(cell, decimal_);
      const bool blank = is_blank(cell);
      if (!blank && !(number && std::isfinite(number->value)))
        refuse(row, column, fmt::format("a finite number with '{}' as decimal sign, or no text", decimal_));
      values.push_back(blank ? std::nan("") : number->value);
      if (clear || blank) return;
      const Decimals decimals = decimals_in(cell, decimal_);
      clear = number->between != '\0' || decimals == Decimals::some;
      whole = whole || decimals == Decimals::none;
      if (decimals == Decimals::thousands && !unclear) unclear = row;
    });
  }
  // Fixed decimals would stand in all rows.
  if (unclear && whole && !clear)
    refuse(*unclear, column,
           fmt::format("a number that cannot be read as thousands: '{}' may be the decimal sign or stand "
                       "between them, since other rows have none; write no sign between thousands",
                       decimal_));
  return values;
}

bool MeasuredTable::has_clock_times(std::size_t column) const {
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    const std::string text = cell(row, column);
    if (!is_blank(text)) return !number_in(text, decimal_) && clock_in(text).has_value();
  }
  return false;
}

std::vector<double> MeasuredTable::clock_times(std::size_t column, ClockDays &days) const {
  constexpr double day = 86400.0;
  std::vector<double> values;
  values.reserve(rows_.size());
  std::optional<bool> universal;
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    const std::string text = cell(row, column);
    if (is_blank(text)) {
      values.push_back(std::nan(""));
      continue;
    }
    const std::optional<ClockTime> clock = clock_in(text);
    if (!clock) refuse(row, column, "a time such as 14:03:07.25 or 2026-11-26T14:03:07.25+01:00");
    if (universal && *universal != clock->universal)
      refuse(row, column,
             *universal ? "a time with its zone, as the first one has"
                        : "a time without a zone, as the first one has");
    universal = clock->universal;
    if (clock->day && !days.first) days.first = clock->day;
    if (!clock->day && clock->seconds < days.before - 0.5 * day) days.midnights += day;
    days.before = clock->seconds;
    values.push_back(clock->seconds +
                     (clock->day ? day * static_cast<double>(*clock->day - *days.first) : days.midnights));
  }
  return values;
}

void MeasuredTable::refuse(std::size_t row, std::size_t column, std::string_view allowed) const {
  csv_refusal(file_, line(row), columns_.at(column).header, cell(row, column),
              fmt::format("{}; {}", allowed, reading_of(rows_[row])));
}

std::string MeasuredTable::reading_of(std::string_view line) const {
  std::vector<std::string> cells;
  for (const std::string &cell : cells_of(line))
    cells.push_back(fmt::format("'{}'", shown(cell)));
  constexpr std::size_t most = 12;
  const bool more = cells.size() > most;
  if (more) cells.resize(most);
  return fmt::format("with {} the line '{}' has the cells {}{}", separator_words(separator_), shown(line),
                     fmt::join(cells, " "), more ? " ..." : "");
}

std::string MeasuredTable::words() const {
  std::string text = fmt::format("{}, {}, decimal '{}'", encoding_, separator_words(separator_), decimal_);
  text += header_line_ > 0 ? fmt::format(", header in line {}", header_line_) : ", no header";
  if (unit_line_ > 0) text += fmt::format(", units in line {}", unit_line_);
  return text + fmt::format(", {} rows from line {}", rows_.size(), lines_.empty() ? 0 : lines_.front());
}

} // namespace drumlin::post
