// Runs the stock engine with the plugin as a user would, as a child process in a folder of its own.
#pragma once

#include "support/process.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// Values for a deck's variables, given by -var.
using Variables = std::vector<std::pair<std::string, std::string>>;

/// Runs a deck with the plugin on a number of ranks, for at most `limit` seconds or until `stop_when`; `out`
/// is set to the folder. A deck whose name ends in .lammps is run by LAMMPS, any other by LIGGGHTS. Throws
/// UsageError, a std::runtime_error, if that engine cannot be started: see engine_fault().
Outcome run_deck(const std::filesystem::path &deck, const Variables &variables,
                 const std::filesystem::path &folder, int ranks = 1, double limit = 600.0,
                 const StopCondition &stop_when = {});

/// Whether the plugin has been built for LAMMPS too.
bool has_lammps();

/// The engine's ERROR line in the output of a run; empty if there is none.
std::string engine_error(const std::string &output);

/// The preloaded library.
std::string plugin_library();

} // namespace drumlin::post
