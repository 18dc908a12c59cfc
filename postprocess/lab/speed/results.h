// Results of the speed study: the rows of its file runs.csv, and throughput, efficiency and memory computed
// from them.
#pragma once

#include "support/csv_schema.h"
#include "support/statistics.h"

#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::post {

/// One row of runs.csv. The first four name the run.
struct SpeedRun {
  std::string scene, law;
  int ranks;
  int round; ///< from 1; runs of one round were interleaved
  int balls; ///< that move
  int steps;
  double loop_s;     ///< by the engine's clock
  double peak_bytes; ///< of the rank with the largest memory
  double place;      ///< height of the bed at the end, m: tells whether runs did the same work

  double million_per_second() const { return 1e-6 * balls * steps / loop_s; } ///< steps of balls
};

/// The columns of runs.csv.
const CsvSchema<SpeedRun> &speed_runs();
/// The rows of a file in order. std::runtime_error for one that cannot be understood, or lacks ranks, balls,
/// steps or time.
std::vector<SpeedRun> read_speed_runs(const std::filesystem::path &file);

/// A law in a scene on a number of ranks, over the rounds; ratios are taken within a round.
struct Throughput {
  std::string scene, law;
  int ranks, balls, rounds;
  Spread million_per_second; ///< steps of balls
  Spread over_engine;        ///< time of a step over that of the law `base` on as many ranks
  Spread efficiency;         ///< over `ranks` times the throughput on one rank
  double peak_bytes;         ///< median
};
/// In the order in which they first appear. Rounds without their counterpart do not count in a ratio; a ratio
/// without any is 0.
std::vector<Throughput> throughputs(const std::vector<SpeedRun> &runs, const std::string &base);

/// Bytes that one more ball takes, from two scenes on one rank. std::invalid_argument if one of them is
/// missing or they are equally large.
double bytes_per_ball(const std::vector<Throughput> &all, const std::string &law, const std::string &small,
                      const std::string &large);

} // namespace drumlin::post
