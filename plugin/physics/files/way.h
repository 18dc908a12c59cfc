#pragma once
// The soil along the way of a roller: a table with the columns s (m), k (N/m) and D (-), as inputs/chain/way
// has it. Between two rows k and D are linear in s; two rows of the same s are a step.

#include "roller.h"

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

namespace drumlin {

/// The contact of drum and soil at a place of the way.
struct WayRow {
  double s = 0.0; ///< place along the way [m]
  double k = 0.0; ///< stiffness of the contact [N/m]
  double D = 0.0; ///< its damping ratio [-]
};

/// The rows of a way: at least two, s never decreases, and no more than two rows have the same s.
using Way = std::vector<WayRow>;

namespace way_file {

constexpr const char *header = "s (m),k (N/m),D (-)";
constexpr std::size_t most_rows = 1'000'000;

[[noreturn]] inline void fail(const std::string &what, std::size_t line, const std::string &file,
                              const std::string &value, const std::string &allowed) {
  throw std::invalid_argument(what + " in line " + std::to_string(line) + " of '" + file + "' is '" +
                              roller_file::shown(value) + "'; allowed: " + allowed);
}

/// A row from its line.
inline WayRow row(const std::string &text, std::size_t line, const std::string &file) {
  struct Column {
    const char *name;
    double WayRow::*value;
    double smallest, largest;
    const char *allowed;
  };
  const std::vector<Column> columns = {{"s", &WayRow::s, -1e6, 1e6, "a number from -1e6 to 1e6 [m]"},
                                       {"k", &WayRow::k, 1e-6, 1e15, "a number from 1e-6 to 1e15 [N/m]"},
                                       {"D", &WayRow::D, 0.0, 1e6, "a number from 0 to 1e6"}};
  WayRow result;
  std::istringstream cells(text);
  for (const Column &column : columns) {
    std::string cell;
    std::getline(cells, cell, ',');
    const std::optional<double> value = roller_file::decimal(cell);
    if (!value || !(*value >= column.smallest && *value <= column.largest))
      fail(column.name, line, file, cell, column.allowed);
    result.*column.value = *value;
  }
  if (std::string more; std::getline(cells, more, ','))
    fail("row", line, file, text, std::string("three numbers, ") + header);
  return result;
}

} // namespace way_file

/// Reads a way. Throws std::invalid_argument with one line, "WHAT in line N of 'FILE' is 'VALUE'; allowed:
/// ...".
inline Way read_way(const std::string &file) {
  std::error_code code;
  std::ifstream in;
  if (std::filesystem::is_regular_file(file, code)) in.open(file); // a pipe could block for ever
  if (!in.is_open())
    throw std::invalid_argument("way is '" + roller_file::shown(file) +
                                "'; allowed: a file that can be read, with the columns " + way_file::header);
  Way way;
  std::size_t line = 0;
  for (std::string text; std::getline(in, text);) {
    ++line;
    if (line == 1 && text.compare(0, 3, "\xEF\xBB\xBF") == 0) text.erase(0, 3); // byte order mark
    if (!text.empty() && text.back() == '\r') text.pop_back();
    if (line == 1) {
      if (text != way_file::header) way_file::fail("header", line, file, text, way_file::header);
      continue;
    }
    if (text.find_first_not_of(" \t") == std::string::npos) continue;
    const WayRow row = way_file::row(text, line, file);
    const std::size_t count = way.size();
    if (count > 0 && row.s < way[count - 1].s)
      way_file::fail("s", line, file, text.substr(0, text.find(',')), "not below the row before");
    if (count > 1 && row.s == way[count - 1].s && row.s == way[count - 2].s)
      way_file::fail("s", line, file, text.substr(0, text.find(',')), "at most two rows of one place");
    if (count == way_file::most_rows) way_file::fail("row", line, file, text, "at most 1000000 rows");
    way.push_back(row);
  }
  if (way.empty() || !(way.back().s > way.front().s))
    throw std::invalid_argument("way of '" + roller_file::shown(file) + "' has " +
                                std::to_string(way.size()) + " rows; allowed: two or more, of different s");
  return way;
}

} // namespace drumlin
