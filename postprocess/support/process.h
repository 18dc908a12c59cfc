// Runs a program as a child process in a folder of its own. No shell is involved.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// How a child process ended.
struct Outcome {
  int status = -1;        ///< exit status; 128 + signal if a signal ended it
  bool timed_out = false; ///< it was stopped at its time limit
  double cpu_seconds =
      0.0; ///< processor time of the child and its children, s: its wall time, had it the machine for itself
  double peak_bytes = 0.0; ///< largest memory that one of them held at a time
  std::string output;      ///< standard output and standard error
  bool ok() const { return status == 0 && !timed_out; }
  bool says(const std::string &text) const { return output.find(text) != std::string::npos; }
};

/// The file in its folder that run_program() leaves a program's output in.
constexpr const char *program_output_file = "screen.txt";

/// Runs a program with extra environment entries ("NAME=value") in a folder, for at most `limit` seconds.
Outcome run_program(const std::vector<std::string> &words, const std::vector<std::string> &environment,
                    const std::filesystem::path &folder, double limit = 20.0);

} // namespace drumlin::post
