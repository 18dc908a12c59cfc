#pragma once
// The command line of this process.

#include <fstream>
#include <string>
#include <vector>

namespace drumlin {

/// The program and its arguments, as Linux keeps them in /proc/self/cmdline; empty if that cannot be read.
inline std::vector<std::string> command_line_arguments() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string argument; std::getline(file, argument, '\0');)
    arguments.push_back(argument);
  return arguments;
}

} // namespace drumlin
