#pragma once
// Lines and words of a text, for tests that read what programs have printed or written.

#include <gtest/gtest.h>

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

/// The words of a text, with white space between them.
inline std::vector<std::string> words_of(const std::string &text) {
  std::vector<std::string> words;
  std::istringstream in(text);
  for (std::string word; in >> word;)
    words.push_back(word);
  return words;
}

/// Expects that the last line that a program has printed is an error, "ERROR: " followed by `start` and more,
/// and that no line before it is an error. Lines of progress may stand before it: a program prints them when
/// it has run for two seconds, which it does on a slow machine.
inline void expect_one_error(const std::string &output, const std::string &start) {
  const std::vector<std::string> lines = lines_of(output);
  for (std::size_t n = 0; n < lines.size(); ++n)
    EXPECT_EQ(lines[n].rfind("ERROR: ", 0) == 0, n + 1 == lines.size()) << output;
  if (lines.empty())
    ADD_FAILURE() << "nothing was printed";
  else
    EXPECT_EQ(lines.back().rfind("ERROR: " + start, 0), 0u) << output;
}

} // namespace drumlin::test
