#include "lab/timing/results.h"

#include "support/resumed.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace drumlin::post {

namespace {

bool is(const TimedRun &run, const std::string &scene, const Measured &what) {
  return run.scene == scene && run.variant == what.variant && run.ranks == what.ranks;
}

/// A value for each round that has runs of both, the second one's run given last.
template <class Of>
std::vector<double> within_rounds(const std::vector<TimedRun> &runs, const std::string &scene,
                                  const Measured &of, const Measured &over, const Of &value) {
  std::vector<double> values;
  for (const TimedRun &run : runs)
    for (const TimedRun &base : runs)
      if (is(run, scene, of) && is(base, scene, over) && run.round == base.round)
        values.push_back(value(run, base));
  return values;
}

} // namespace

const CsvSchema<TimedRun> &timed_runs() {
  static const CsvSchema<TimedRun> schema(
      {csv_column("scene", &TimedRun::scene), csv_column("variant", &TimedRun::variant),
       csv_column("ranks", &TimedRun::ranks), csv_column("round", &TimedRun::round),
       csv_column("balls", &TimedRun::balls), csv_column("steps", &TimedRun::steps),
       csv_column("loop_s", &TimedRun::loop_s), csv_column("pair_s", &TimedRun::pair_s, 9),
       csv_column("peak_bytes", &TimedRun::peak_bytes), csv_column("place_m", &TimedRun::place)},
      4);
  return schema;
}

std::vector<TimedRun> read_timed_runs(const std::filesystem::path &file) {
  std::vector<TimedRun> runs = read_points(file, timed_runs());
  for (const TimedRun &run : runs)
    if (!(run.ranks > 0 && run.balls > 0 && run.steps > 0 && run.loop_s > 0.0))
      throw std::runtime_error(fmt::format("{}: a row without ranks, balls, steps or time", file.string()));
  return runs;
}

std::vector<VariantTime> variant_times(const std::vector<TimedRun> &runs) {
  std::vector<VariantTime> all;
  for (const TimedRun &first : runs) {
    if (std::any_of(all.begin(), all.end(), [&first](const VariantTime &one) {
          return is(first, one.scene, {one.variant, one.ranks});
        }))
      continue;
    std::vector<double> us, speed, pair, peak;
    for (const TimedRun &run : runs) {
      if (!is(run, first.scene, {first.variant, first.ranks})) continue;
      us.push_back(run.us_per_step());
      speed.push_back(run.balls / run.us_per_step());
      pair.push_back(1e6 * run.pair_s / run.steps);
      peak.push_back(run.peak_bytes);
    }
    all.push_back({first.scene, first.variant, first.ranks, first.balls, static_cast<int>(us.size()),
                   spread(us), spread(speed), median(pair), median(peak)});
  }
  return all;
}

const VariantTime &find_time(const std::vector<VariantTime> &all, const std::string &scene,
                             const std::string &variant, int ranks) {
  for (const VariantTime &one : all)
    if (one.scene == scene && one.variant == variant && one.ranks == ranks) return one;
  throw std::invalid_argument(fmt::format("{}: no run of {} on {} ranks", scene, variant, ranks));
}

double bytes_per_ball(const std::vector<VariantTime> &all, const std::string &variant,
                      const std::string &small, const std::string &large) {
  const VariantTime &few = find_time(all, small, variant, 1);
  const VariantTime &many = find_time(all, large, variant, 1);
  if (few.balls == many.balls) throw std::invalid_argument("two scenes of as many balls");
  return (many.peak_bytes - few.peak_bytes) / (many.balls - few.balls);
}

std::vector<double> time_ratios(const std::vector<TimedRun> &runs, const std::string &scene,
                                const Measured &of, const Measured &over) {
  return within_rounds(runs, scene, of, over, [](const TimedRun &run, const TimedRun &base) {
    return run.us_per_step() / base.us_per_step();
  });
}

std::vector<double> efficiencies(const std::vector<TimedRun> &runs, const std::string &scene,
                                 const Measured &of) {
  return within_rounds(runs, scene, of, {of.variant, 1}, [](const TimedRun &run, const TimedRun &alone) {
    return alone.us_per_step() / (run.ranks * run.us_per_step());
  });
}

std::vector<PieceCost> piece_costs(const std::vector<TimedRun> &runs,
                                   const std::vector<PieceComparison> &comparisons) {
  std::vector<std::string> scenes;
  for (const TimedRun &run : runs)
    if (std::find(scenes.begin(), scenes.end(), run.scene) == scenes.end()) scenes.push_back(run.scene);
  std::vector<PieceCost> costs;
  for (const std::string &scene : scenes)
    for (const PieceComparison &comparison : comparisons) {
      const Measured of = {comparison.variant}, over = {comparison.base};
      const std::vector<double> ratios = time_ratios(runs, scene, of, over);
      if (ratios.empty()) continue;
      const std::vector<double> extra =
          within_rounds(runs, scene, of, over, [](const TimedRun &run, const TimedRun &base) {
            return run.us_per_step() - base.us_per_step();
          });
      costs.push_back({scene, comparison, spread(ratios), median(extra)});
    }
  return costs;
}

} // namespace drumlin::post
