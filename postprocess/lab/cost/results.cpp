#include "lab/cost/results.h"

#include "experiment/study.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

namespace drumlin::post {

namespace {

/// The values without repetition, in order of appearance.
std::vector<std::string> names(const std::vector<CostRun> &runs, std::string CostRun::*name) {
  std::vector<std::string> found;
  for (const CostRun &run : runs)
    if (std::find(found.begin(), found.end(), run.*name) == found.end()) found.push_back(run.*name);
  return found;
}

/// The rounds of a variant.
std::map<int, CostRun> rounds_of(const std::vector<CostRun> &runs, const std::string &scene,
                                 const std::string &variant) {
  std::map<int, CostRun> rounds;
  for (const CostRun &run : runs)
    if (run.scene == scene && run.variant == variant) rounds.emplace(run.round, run);
  return rounds;
}

} // namespace

const CsvSchema<CostRun> &cost_runs() {
  static const CsvSchema<CostRun> schema(
      {csv_column("scene", &CostRun::scene), csv_column("variant", &CostRun::variant),
       csv_column("round", &CostRun::round), csv_column("balls", &CostRun::balls),
       csv_column("steps", &CostRun::steps), csv_column("loop_s", &CostRun::loop_s),
       csv_column("pair_s", &CostRun::pair_s), csv_column("place_m", &CostRun::place)},
      3);
  return schema;
}

std::vector<CostRun> read_cost_runs(const std::filesystem::path &file) {
  std::vector<CostRun> runs = read_points(file, cost_runs());
  for (const CostRun &run : runs)
    if (!(run.balls > 0 && run.steps > 0 && run.loop_s > 0.0))
      throw std::runtime_error(fmt::format("{}: a row without balls, steps or time", file.string()));
  return runs;
}

std::vector<VariantCost> variant_costs(const std::vector<CostRun> &runs) {
  std::vector<VariantCost> costs;
  for (const std::string &scene : names(runs, &CostRun::scene))
    for (const std::string &variant : names(runs, &CostRun::variant)) {
      std::vector<double> total, pair;
      int balls = 0;
      for (const auto &[round, run] : rounds_of(runs, scene, variant)) {
        total.push_back(run.us_per_step());
        pair.push_back(1e6 * run.pair_s / run.steps);
        balls = run.balls;
      }
      if (total.empty()) continue;
      const Spread us = spread(total);
      costs.push_back(
          {scene, variant, static_cast<int>(total.size()), us, median(pair), 1e3 * us.median / balls});
    }
  return costs;
}

std::vector<PieceCost> piece_costs(const std::vector<CostRun> &runs,
                                   const std::vector<Comparison> &comparisons) {
  std::vector<PieceCost> costs;
  for (const std::string &scene : names(runs, &CostRun::scene))
    for (const Comparison &comparison : comparisons) {
      const std::map<int, CostRun> bases = rounds_of(runs, scene, comparison.base);
      std::vector<double> ratios, extras;
      for (const auto &[round, run] : rounds_of(runs, scene, comparison.variant)) {
        const auto base = bases.find(round);
        if (base == bases.end()) continue;
        ratios.push_back(run.us_per_step() / base->second.us_per_step());
        extras.push_back(run.us_per_step() - base->second.us_per_step());
      }
      if (!ratios.empty()) costs.push_back({scene, comparison, spread(ratios), median(extras)});
    }
  return costs;
}

} // namespace drumlin::post
