#pragma once
// Lines of a text, for tests that read what programs have printed or written.

#include <sstream>
#include <string>
#include <vector>

namespace drumlin::test {

/// The lines of a text, without their line ends. An empty text has none.
inline std::vector<std::string> lines_of(const std::string &text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    lines.push_back(line);
  return lines;
}

} // namespace drumlin::test
