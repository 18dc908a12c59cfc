// Results of the timing study: the rows of its file runs.csv, and times, ratios and memory computed from
// them.
#pragma once

#include "support/csv_schema.h"
#include "support/statistics.h"

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// One row of runs.csv. The first four name the run.
struct TimedRun {
  std::string scene;
  std::string variant; ///< law, and what is switched on
  int ranks;
  int round; ///< from 1; runs of one round were interleaved
  int balls; ///< that move
  int steps;
  double loop_s;     ///< by the engine's clock
  double pair_s;     ///< of it, in the pair style; NaN of LAMMPS
  double peak_bytes; ///< of the rank with the largest memory
  double place;      ///< height of drum or bed at the end, m: tells whether variants did the same work

  double us_per_step() const { return 1e6 * loop_s / steps; }
};

/// The columns of runs.csv.
const CsvSchema<TimedRun> &timed_runs();
/// The rows of a file in order. std::runtime_error for one that cannot be understood, or lacks ranks, balls,
/// steps or time.
std::vector<TimedRun> read_timed_runs(const std::filesystem::path &file);

/// A variant of a scene on a number of ranks, over the rounds.
struct VariantTime {
  std::string scene, variant;
  int ranks, balls, rounds;
  Spread us_per_step;
  Spread million_per_second; ///< steps of balls
  double pair_us_per_step;   ///< median
  double peak_bytes;         ///< median

  double ns_per_ball() const { return 1e3 * us_per_step.median / balls; } ///< and step
};
/// In the order in which they first appear.
std::vector<VariantTime> variant_times(const std::vector<TimedRun> &runs);
/// One of them. std::invalid_argument if it is missing.
const VariantTime &find_time(const std::vector<VariantTime> &all, const std::string &scene,
                             const std::string &variant, int ranks);

/// Bytes that one more ball takes, from two scenes on one rank. std::invalid_argument if one of them is
/// missing or they are equally large.
double bytes_per_ball(const std::vector<VariantTime> &all, const std::string &variant,
                      const std::string &small, const std::string &large);

/// A variant on a number of ranks.
struct Measured {
  std::string variant;
  int ranks = 1;
};
/// The time of a step of one over that of another, a value for each round that has both: the load of the
/// machine is about the same in runs that follow one another.
std::vector<double> time_ratios(const std::vector<TimedRun> &runs, const std::string &scene,
                                const Measured &of, const Measured &over);
/// The throughput on some ranks over so many times that on one rank, in the same way.
std::vector<double> efficiencies(const std::vector<TimedRun> &runs, const std::string &scene,
                                 const Measured &of);

/// The cost of an optional part: the time of a variant with it over that of the variant without it.
struct PieceComparison {
  const char *piece;
  const char *variant;
  const char *base;
  double most;                 ///< acceptance criterion: largest ratio; 0: there is none
  const char *where = nullptr; ///< scene that the criterion is about; nullptr: all
};
struct PieceCost {
  std::string scene;
  PieceComparison comparison;
  Spread ratio;
  double extra_us_per_step; ///< median of the difference within a round
  /// The acceptance criterion of this scene: the largest ratio allowed; 0: there is none.
  double allowed() const {
    return comparison.where == nullptr || comparison.where == scene ? comparison.most : 0.0;
  }
  bool holds() const { return allowed() == 0.0 || ratio.median <= allowed(); }
};
/// The comparisons that the scenes allow on one rank, scene by scene.
std::vector<PieceCost> piece_costs(const std::vector<TimedRun> &runs,
                                   const std::vector<PieceComparison> &comparisons);

} // namespace drumlin::post
