// Runs the stock engine with the plugin as a user would, as a child process in a folder of its own. No shell is involved.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
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

/// Values for a deck's variables, given by -var.
using Variables = std::vector<std::pair<std::string, std::string>>;

/// Runs a deck with the plugin on a number of ranks; `out` is set to the folder. A deck whose name ends in .lammps is run by LAMMPS,
/// any other by LIGGGHTS. std::runtime_error without LAMMPS: see has_lammps().
Outcome run_deck(const std::filesystem::path &deck, const Variables &variables,
                 const std::filesystem::path &folder, int ranks = 1, double limit = 100.0);

/// Whether the plugin has been built for LAMMPS too.
bool has_lammps();

/// The engine's ERROR line in what a run printed; empty if there is none.
std::string engine_error(const std::string &output);

/// The preloaded library.
std::string plugin_library();

/// A whole file as text.
std::string read_text(const std::filesystem::path &file);

} // namespace drumlin::post
