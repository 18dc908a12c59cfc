#include "bed/text_dump.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path &file, const std::string &what) {
  throw std::runtime_error(fmt::format("{}: {}", file.string(), what));
}

bool begins(const std::string &line, const char *words) { return line.rfind(words, 0) == 0; }

std::vector<double> numbers_of(const fs::path &file, const std::string &line) {
  std::istringstream in(line);
  std::vector<double> numbers;
  for (std::string word; in >> word;) {
    std::size_t used = 0;
    try {
      numbers.push_back(std::stod(word, &used));
    } catch (const std::exception &) {
      used = 0;
    }
    if (used != word.size()) fail(file, fmt::format("'{}' is no number", word));
  }
  return numbers;
}

} // namespace

TextDump read_text_dump(const fs::path &file) {
  std::ifstream in(file);
  if (!in) fail(file, "cannot be read");
  TextDump dump;
  std::size_t announced = 0;
  int steps = 0;
  std::string line;
  while (dump.names.empty() && std::getline(in, line)) {
    if (begins(line, "ITEM: TIMESTEP")) {
      ++steps;
    } else if (begins(line, "ITEM: NUMBER OF ")) {
      std::getline(in, line);
      const std::vector<double> number = numbers_of(file, line);
      if (number.size() != 1 || number[0] < 0.0) fail(file, fmt::format("'{}' is no number of rows", line));
      announced = static_cast<std::size_t>(number[0]);
    } else if (begins(line, "ITEM: ATOMS ") || begins(line, "ITEM: ENTRIES ")) {
      std::istringstream words(line);
      std::string word;
      words >> word >> word; // ITEM: ATOMS
      while (words >> word)
        dump.names.push_back(word);
    }
  }
  if (steps <= 1 && dump.names.empty() && (line.empty() || begins(line, "ITEM") || steps == 1))
    throw CutShort(fmt::format("{}: is cut short: it ends before its rows begin", file.string()));
  if (steps != 1 || dump.names.empty())
    fail(file, "is no text dump of LAMMPS; expected one as inputs/bed/dumps.lammps makes it");
  while (std::getline(in, line)) {
    if (in.eof()) break; // without its line end it may lack digits, too
    if (begins(line, "ITEM: ")) fail(file, "holds more than one step");
    dump.rows.push_back(numbers_of(file, line));
    if (dump.rows.back().size() != dump.names.size())
      fail(file, fmt::format("row {} has {} numbers, expected {}", dump.rows.size(), dump.rows.back().size(),
                             dump.names.size()));
  }
  if (dump.rows.size() < announced)
    throw CutShort(fmt::format("{}: is cut short: it has {} rows, expected {}", file.string(),
                               dump.rows.size(), announced));
  if (dump.rows.size() != announced)
    fail(file, fmt::format("has {} rows, expected {}", dump.rows.size(), announced));
  return dump;
}

} // namespace drumlin::post
