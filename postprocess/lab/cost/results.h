// Results of the cost study: the rows of its file runs.csv, and the ratios of times computed from them.
#pragma once

#include "support/csv_schema.h"
#include "support/statistics.h"

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// One row of runs.csv. The first three name the run.
struct CostRun {
  std::string scene;
  std::string variant; ///< what is switched on
  int round;           ///< from 1; runs of one round were interleaved
  int balls;           ///< that move
  int steps;
  double loop_s; ///< by the engine's clock
  double pair_s; ///< of it, in the pair style
  double place;  ///< height of drum or bed at the end, m: tells whether variants did the same work

  double us_per_step() const { return 1e6 * loop_s / steps; }
};

/// The columns of runs.csv.
const CsvSchema<CostRun> &cost_runs();
/// The rows of a file in order. std::runtime_error for one that cannot be understood, or lacks balls, steps
/// or time.
std::vector<CostRun> read_cost_runs(const std::filesystem::path &file);

/// A variant of a scene: the time of a step.
struct VariantCost {
  std::string scene, variant;
  int rounds;
  Spread us_per_step;
  double pair_us_per_step; ///< median
  double ns_per_ball;      ///< and step, median
};
/// In the order in which scenes and variants first appear.
std::vector<VariantCost> variant_costs(const std::vector<CostRun> &runs);

/// The cost of an optional part: the time of a variant with it over that of the variant without it.
struct Comparison {
  const char *piece;
  const char *variant;
  const char *base;
  double most;                 ///< acceptance criterion: largest ratio; 0: there is none
  const char *where = nullptr; ///< scene that the criterion is about; nullptr: all
};

/// The median over the rounds of the ratio within a round: the load of the machine is about the same in runs
/// that follow one another.
struct PieceCost {
  std::string scene;
  Comparison comparison;
  Spread ratio;
  double extra_us_per_step; ///< median of the difference within a round
  /// The acceptance criterion of this scene: the largest ratio allowed; 0: there is none.
  double allowed() const {
    return comparison.where == nullptr || comparison.where == scene ? comparison.most : 0.0;
  }
  bool holds() const { return allowed() == 0.0 || ratio.median <= allowed(); }
};
/// The comparisons that the scenes allow, scene by scene. Rounds that lack one of the two do not count.
std::vector<PieceCost> piece_costs(const std::vector<CostRun> &runs,
                                   const std::vector<Comparison> &comparisons);

} // namespace drumlin::post
