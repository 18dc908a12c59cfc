#include "lab/speed/results.h"

#include "experiment/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace drumlin::post {

namespace {

/// Whether two runs differ only in law and number of ranks, which are given for the other.
bool same_but(const SpeedRun &one, const SpeedRun &other, const std::string &law, int ranks) {
  return one.scene == other.scene && one.round == other.round && other.law == law && other.ranks == ranks;
}

Spread spread_or_zero(const std::vector<double> &values) {
  return values.empty() ? Spread{0.0, 0.0, 0.0} : spread(values);
}

} // namespace

const CsvSchema<SpeedRun> &speed_runs() {
  static const CsvSchema<SpeedRun> schema(
      {csv_column("scene", &SpeedRun::scene), csv_column("law", &SpeedRun::law),
       csv_column("ranks", &SpeedRun::ranks), csv_column("round", &SpeedRun::round),
       csv_column("balls", &SpeedRun::balls), csv_column("steps", &SpeedRun::steps),
       csv_column("loop_s", &SpeedRun::loop_s), csv_column("peak_bytes", &SpeedRun::peak_bytes),
       csv_column("place_m", &SpeedRun::place)},
      4);
  return schema;
}

std::vector<SpeedRun> read_speed_runs(const std::filesystem::path &file) {
  std::vector<SpeedRun> runs = read_points(file, speed_runs());
  for (const SpeedRun &run : runs)
    if (!(run.ranks > 0 && run.balls > 0 && run.steps > 0 && run.loop_s > 0.0))
      throw std::runtime_error(fmt::format("{}: a row without ranks, balls, steps or time", file.string()));
  return runs;
}

std::vector<Throughput> throughputs(const std::vector<SpeedRun> &runs, const std::string &base) {
  std::vector<Throughput> all;
  for (const SpeedRun &first : runs) {
    const auto same = [&first](const auto &other) {
      return other.scene == first.scene && other.law == first.law && other.ranks == first.ranks;
    };
    if (std::any_of(all.begin(), all.end(), same)) continue;
    std::vector<double> speed, over, efficiency, peak;
    for (const SpeedRun &run : runs) {
      if (!same(run)) continue;
      speed.push_back(run.million_per_second());
      peak.push_back(run.peak_bytes);
      for (const SpeedRun &other : runs) {
        if (same_but(run, other, base, run.ranks)) over.push_back(run.loop_s / other.loop_s);
        if (same_but(run, other, run.law, 1)) efficiency.push_back(other.loop_s / (run.ranks * run.loop_s));
      }
    }
    all.push_back({first.scene, first.law, first.ranks, first.balls, static_cast<int>(speed.size()),
                   spread(speed), spread_or_zero(over), spread_or_zero(efficiency), median(peak)});
  }
  return all;
}

double bytes_per_ball(const std::vector<Throughput> &all, const std::string &law, const std::string &small,
                      const std::string &large) {
  const auto alone = [&](const std::string &scene) -> const Throughput & {
    for (const Throughput &one : all)
      if (one.scene == scene && one.law == law && one.ranks == 1) return one;
    throw std::invalid_argument(fmt::format("{} has no run of {} on one rank", scene, law));
  };
  const Throughput &few = alone(small);
  const Throughput &many = alone(large);
  if (few.balls == many.balls) throw std::invalid_argument("two scenes of as many balls");
  return (many.peak_bytes - few.peak_bytes) / (many.balls - few.balls);
}

} // namespace drumlin::post
