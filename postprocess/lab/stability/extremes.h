// Runs at the limits of the allowed parameters: some must agree with an independent solution, others must end
// with an error that names the limit.
#pragma once

#include "engine/deck_run.h"
#include "experiment/study.h"

#include <functional>
#include <string>
#include <vector>

namespace drumlin::post {

/// One run and its expected result.
struct Extreme {
  std::string group; ///< title of its table
  std::string name;
  std::string deck; ///< relative to inputs/
  Variables variables;
  int ranks = 1;
  double limit = 120.0; ///< s of wall time, after which it counts as hung
  std::string expected; ///< in words, without commas
  double allowed = 0.0; ///< largest error
  /// The difference of the run from the independent solution, in the unit that `expected` states. May throw
  /// std::runtime_error: the row then fails.
  std::function<double(const DeckRun &)> error;
};

/// The command that makes a row's run by hand.
std::string command_of(const Extreme &row);

/// All rows; few and short ones if quick.
std::vector<Extreme> extremes(bool quick);

/// A row's outcome.
struct ExtremeVerdict {
  Extreme row;
  double error;      ///< not finite if the run did not come to its end
  std::string found; ///< the engine's ERROR line; empty if there was none
  bool holds;
};

/// One row of extremes.csv. The first three name it.
struct ExtremeRow {
  std::string table, row, command, expected = {};
  double error = 0.0, allowed = 0.0;
  std::string verdict = {}; ///< holds or fails
  std::string found = {};   ///< as in ExtremeVerdict
};
const CsvSchema<ExtremeRow> &extreme_rows();

/// Makes the runs that options.out/extremes.csv does not have yet.
std::vector<ExtremeVerdict> measure_extremes(const StudyOptions &options);

} // namespace drumlin::post
