#pragma once
// The words with which this process was started.

#include <fstream>
#include <string>
#include <vector>

namespace drumlin {

/// The program and its arguments, as the system keeps them; empty where it does not tell.
inline std::vector<std::string> command_line_words() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');)
    words.push_back(word);
  return words;
}

} // namespace drumlin
