#pragma once
// The soil along the way of a roller: a table with the columns s (m), k (N/m) and D (-), as inputs/chain/way
// has it, or with k_left and k_right of the two halves of the drum in place of k. Between two rows they are
// linear in s; two rows of the same s are a step.

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
  double s = 0.0;          ///< place along the way [m]
  double k = 0.0;          ///< stiffness of the contact [N/m]
  double D = 0.0;          ///< its damping ratio [-]
  double k_left = 0.5 * k; ///< part of k below the left half of the drum [N/m]

  double k_right() const { return k - k_left; }
};

/// The rows of a way: at least two, s never decreases, and no more than two rows have the same s.
using Way = std::vector<WayRow>;

namespace way_file {

constexpr const char *header = "s (m),k (N/m),D (-)";
constexpr const char *header_of_halves = "s (m),k_left (N/m),k_right (N/m),D (-)";
constexpr std::size_t most_rows = 1'000'000;

[[noreturn]] inline void fail(const std::string &what, std::size_t line, const std::string &file,
                              const std::string &value, const std::string &allowed) {
  throw std::invalid_argument(what + " in line " + std::to_string(line) + " of '" + file + "' is '" +
                              roller_file::shown(value) + "'; allowed: " + allowed);
}

/// A row from its line. \param halves whether the table has k of each half
inline WayRow row(const std::string &text, std::size_t line, const std::string &file, bool halves) {
  struct Column {
    const char *name;
    double smallest, largest;
    const char *allowed;
  };
  const auto stiffness = [](const char *name) {
    return Column{name, 1e-6, 1e15, "a number from 1e-6 to 1e15 [N/m]"};
  };
  const Column place = {"s", -1e6, 1e6, "a number from -1e6 to 1e6 [m]"},
               damping = {"D", 0.0, 1e6, "a number from 0 to 1e6"};
  const std::vector<Column> columns =
      halves ? std::vector<Column>{place, stiffness("k_left"), stiffness("k_right"), damping}
             : std::vector<Column>{place, stiffness("k"), damping};
  std::vector<double> values;
  std::istringstream cells(text);
  for (const Column &column : columns) {
    std::string cell;
    std::getline(cells, cell, ',');
    const std::optional<double> value = roller_file::decimal(cell);
    if (!value || !(*value >= column.smallest && *value <= column.largest))
      fail(column.name, line, file, cell, column.allowed);
    values.push_back(*value);
  }
  if (std::string more; std::getline(cells, more, ','))
    fail("row", line, file, text,
         halves ? std::string("four numbers, ") + header_of_halves : std::string("three numbers, ") + header);
  if (halves) return {values[0], values[1] + values[2], values[3], values[1]};
  return {values[0], values[1], values[2]};
}

} // namespace way_file

/// Whether the two halves of the drum meet different soil.
inline bool has_sides(const Way &way) {
  for (const WayRow &row : way)
    if (row.k_left != row.k_right()) return true;
  return false;
}

/// Reads a way. Throws std::invalid_argument with one line, "WHAT in line N of 'FILE' is 'VALUE'; allowed:
/// ...". \param tilts whether it is for a drum that tilts; for another one the halves must be equal
inline Way read_way(const std::string &file, bool tilts = false) {
  std::error_code code;
  std::ifstream in;
  if (std::filesystem::is_regular_file(file, code)) in.open(file); // a pipe could block for ever
  if (!in.is_open())
    throw std::invalid_argument("way is '" + roller_file::shown(file) +
                                "'; allowed: a file that can be read, with the columns " + way_file::header);
  Way way;
  bool halves = false;
  std::size_t line = 0;
  for (std::string text; std::getline(in, text);) {
    ++line;
    if (line == 1 && text.compare(0, 3, "\xEF\xBB\xBF") == 0) text.erase(0, 3); // byte order mark
    if (!text.empty() && text.back() == '\r') text.pop_back();
    if (line == 1) {
      halves = text == way_file::header_of_halves;
      if (!halves && text != way_file::header)
        way_file::fail("header", line, file, text,
                       std::string(way_file::header) + " or " + way_file::header_of_halves);
      continue;
    }
    if (text.find_first_not_of(" \t") == std::string::npos) continue;
    const WayRow row = way_file::row(text, line, file, halves);
    if (!tilts && row.k_left != row.k_right())
      way_file::fail("k_left", line, file, roller_file::number_text(row.k_left),
                     "k_right, " + roller_file::number_text(row.k_right()) +
                         ": a drum on one contact has no sides");
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
