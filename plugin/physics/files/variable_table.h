#pragma once
// The variables of a deck as a table: a line for each, with its name, default, unit, rule, group and meaning,
// as inputs/chain/variables has them.

#include "roller.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

namespace drumlin {

/// What one line of a table, or one command drumlin/variable, declares.
struct VariableLine {
  std::string name, standard, unit, rule, group, meaning;
  std::size_t line = 0; ///< of the table, from 1
};

namespace variable_table {

constexpr const char *columns = "a name, default, unit, rule, group and meaning";

/// The next word of a line: up to a blank, or what stands in double quotes.
inline std::string word(std::istringstream &in) {
  std::string text;
  if ((in >> std::ws).peek() != '"') return in >> text, text;
  in.get();
  return std::getline(in, text, '"'), text;
}

/// The error text for a line that cannot be read.
inline std::string line_fault(std::size_t number, const std::string &file, const std::string &line,
                              const std::string &allowed) {
  return "line " + std::to_string(number) + " of '" + file + "' is '" + roller_file::shown(line) +
         "'; allowed: " + allowed;
}

/// The error text for a group that no line has.
inline std::string group_fault(const std::string &group, const std::string &file) {
  return "group is '" + group + "'; allowed: one of '" + file + "'";
}

} // namespace variable_table

/// The text of a table. Throws std::invalid_argument if it cannot be read.
inline std::string variable_table_text(const std::string &file) {
  std::error_code code;
  std::ifstream in;
  if (std::filesystem::is_regular_file(file, code)) in.open(file); // a pipe could block for ever
  if (!in.is_open())
    throw std::invalid_argument("table is '" + roller_file::shown(file) +
                                "'; allowed: a file that can be read, with lines of " +
                                variable_table::columns);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The lines of a table; one that begins with # is a comment. Throws std::invalid_argument with "line N of
/// 'FILE' is 'TEXT'; allowed: ...".
/// \param groups whose variables are returned; empty: those of all
inline std::vector<VariableLine> read_variable_table(const std::string &text, const std::string &file,
                                                     const std::vector<std::string> &groups = {}) {
  std::vector<VariableLine> all;
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const auto fail = [&](const std::string &allowed) {
      throw std::invalid_argument(variable_table::line_fault(number, file, line, allowed));
    };
    line.erase(line.find_last_not_of(" \t\r") + 1);
    if (line.empty() || line[0] == '#') continue;
    std::istringstream in(line);
    std::string rest;
    std::array<std::string, 5> words;
    for (std::string &word : words)
      word = variable_table::word(in);
    std::getline(in >> std::ws, rest);
    const bool is_name = std::all_of(words[0].begin(), words[0].end(),
                                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
    if (!is_name || words[3].empty() || words[4].empty() || rest.empty()) fail(variable_table::columns);
    if (std::any_of(all.begin(), all.end(), [&](const VariableLine &other) {
          return other.name == words[0] && other.group == words[4];
        }))
      fail("each variable once in a group");
    all.push_back({words[0], words[1], words[2], words[3], words[4], rest, number});
  }
  for (const std::string &group : groups)
    if (std::none_of(all.begin(), all.end(), [&](const VariableLine &one) { return one.group == group; }))
      throw std::invalid_argument(variable_table::group_fault(group, file));
  std::vector<VariableLine> wanted;
  for (const VariableLine &one : all)
    if (groups.empty() || std::find(groups.begin(), groups.end(), one.group) != groups.end())
      wanted.push_back(one);
  return wanted;
}

} // namespace drumlin
