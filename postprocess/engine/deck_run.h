// Runs of decks in temporary folders.
#pragma once

#include "support/files.h"
#include "support/process.h"

#include <filesystem>
#include <set>
#include <stdexcept>
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

/// What the scene of a run causes: the same run fails in the same way whenever it is made again. All other
/// faults, such as those of a full disk or of an engine that was killed, may pass.
class SceneFault : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// A run of a deck in a temporary folder, which lives as long as this object.
class DeckRun {
public:
  /// \param deck relative to inputs/, e.g. "chain/in.chain"
  /// \param limit seconds after which the run is stopped
  DeckRun(const std::string &deck, const Variables &variables, int ranks = 1, double limit = 3600.0);

  const Outcome &outcome() const { return outcome_; }
  /// Throws std::runtime_error with the engine's ERROR line, or its exit status, if the run failed:
  /// SceneFault if the engine ended by itself, with a line that names neither files nor signals.
  const DeckRun &must_succeed() const;
  /// A file that the run wrote.
  std::filesystem::path file(const std::string &name) const { return folder_ / name; }
  /// The number that follows the last occurrence of a text in the engine's output. Throws std::runtime_error
  /// if there is none.
  double printed(const std::string &text) const;
  /// Seconds that the last `run` of the deck took, by the engine's own clock.
  double loop_seconds() const { return printed("Loop time of "); }

private:
  std::string deck_;
  TemporaryFolder temporary_;
  std::filesystem::path folder_; ///< in the temporary one, which is held: decks hold their folder, too
  Outcome outcome_;
};

/// inputs/NAME of the project.
std::filesystem::path input_file(const std::string &name);

/// A deck and the files that it, or one of them, includes or reads by names that begin with ${here}. Where
/// the rest of a name is a variable, all files whose names begin so.
std::set<std::filesystem::path> deck_files(const std::filesystem::path &deck);

} // namespace drumlin::post
