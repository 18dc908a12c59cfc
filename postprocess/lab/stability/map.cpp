#include "lab/stability/map.h"

#include "bed/dump_readers.h"
#include "engine/deck_run.h"
#include "lab/stability/boundary.h"
#include "support/csv_schema.h"
#include "support/progress.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace drumlin::post {

namespace {

constexpr double lowest = 1e-6; // w0 dt
constexpr double highest = 4.0;
constexpr double first_push = 1e-6;  // m, of the deck
constexpr double growth_limit = 1e3; // times the first push: a larger motion is unstable
// With heavy damping and second-order stepping an unstable motion grows by as little as a factor of 1 + 1e-7
// per step. That is seen in the part of the motion that changes sign every step, measured at half time and at
// the end of the run.
constexpr double fast_growth = 1.0 + 1e-4;
constexpr double fast_noise = 1e-11; // m: above rounding errors

/// The largest fourth difference over the window: 16 times the part of the motion that changes sign every
/// step, and next to nothing of a slow motion.
double fast_part(const std::vector<double> &x) {
  double most = 0.0;
  for (std::size_t n = 4; n < x.size(); ++n)
    most = std::max(most, std::fabs(x[n] - 4.0 * x[n - 1] + 6.0 * x[n - 2] - 4.0 * x[n - 3] + x[n - 4]));
  return most;
}

/// Positions of a ball along one direction, in the two time windows in which the deck dumps.
struct Watched {
  std::vector<double> half_time, end;
};

bool has_grown(const Watched &ball, bool damped) {
  for (const std::vector<double> *window : {&ball.half_time, &ball.end})
    for (const double x : *window)
      if (!(std::fabs(x) < growth_limit * first_push)) return true;
  const double fast = fast_part(ball.end);
  return damped && fast > fast_noise && fast > fast_growth * fast_part(ball.half_time);
}

/// Which balls of a run of the deck are stable. A ball that is lost is not.
std::vector<bool> stable_balls(const std::filesystem::path &looks, int balls, bool damped) {
  const std::vector<TextDump> dumps = read_text_dumps(looks);
  std::vector<std::array<Watched, 2>> watched(static_cast<std::size_t>(balls)); // x and z
  bool second_window = false;
  for (std::size_t n = 0; n < dumps.size(); ++n) {
    const TextDump &dump = dumps[n];
    second_window = second_window || (n > 0 && dump.step != dumps[n - 1].step + 1);
    const std::size_t id = dump.column("id"), x = dump.column("x"), z = dump.column("z");
    for (const std::vector<double> &row : dump.rows) {
      std::array<Watched, 2> &ball = watched.at(static_cast<std::size_t>(std::lround(row[id])) - 1);
      (second_window ? ball[0].end : ball[0].half_time).push_back(row[x]);
      (second_window ? ball[1].end : ball[1].half_time).push_back(row[z]);
    }
  }
  if (!second_window) throw std::runtime_error(looks.string() + " has not two windows");
  std::vector<bool> stable;
  stable.reserve(watched.size());
  for (const std::array<Watched, 2> &ball : watched)
    stable.push_back(ball[0].half_time.size() + ball[0].end.size() == dumps.size() &&
                     !has_grown(ball[0], damped) && !has_grown(ball[1], damped));
  return stable;
}

std::vector<double> damping_ratios(bool quick) {
  if (quick) return {0.0, 2.0, 1e4};
  std::vector<double> values = {0.0};
  for (int n = 0; n <= 12; ++n) // two to a decade
    values.push_back(std::pow(10.0, -2.0 + n / 2.0));
  values.push_back(2.0); // Table 1, case IV
  std::sort(values.begin(), values.end());
  return values;
}

/// Runs the deck until the boundary is enclosed narrowly enough.
MapRow measure(const HeldScene &scene, const std::string &stepping, double D, bool quick) {
  const auto trials = [&](double low, double high, int count) {
    const DeckRun run("study/in.stability", {{"scene", scene.walls},
                                             {"hertz", scene.hertz ? "1" : "0"},
                                             {"D", number_text(D)},
                                             {"stepping", stepping},
                                             {"balls", std::to_string(count)},
                                             {"lowest", number_text(low)},
                                             {"highest", number_text(high)},
                                             {"half", quick ? "2000" : "4000"}});
    return stable_balls(run.must_succeed().file("looks.dump"), count, D > 0.0);
  };
  constexpr int balls = 160;
  const StabilityBoundary boundary =
      find_stability_boundary(trials, lowest, highest, balls, quick ? 1e-2 : 1e-3);
  const double limit =
      stepping == "stock" ? stock_stability_limit(scene.contacts, D) : spring_stability_limit(scene.contacts);
  return {scene.name, stepping, D, boundary.stable, boundary.unstable, limit, boundary.single ? "yes" : "no"};
}

} // namespace

const std::vector<HeldScene> &held_scenes() {
  static const std::vector<HeldScene> scenes = {
      {"one", "one contact, pressed", "one", 1, false, true},
      {"two", "between two walls", "two", 2, false, true},
      {"cross", "between two pairs of walls at right angles", "cross", 2, false, false},
      {"four", "four contacts on one line", "four", 4, false, false},
      {"hertz_one", "Hertz law: one contact, pressed", "one", 1, true, false},
      {"hertz_two", "Hertz law: between two walls", "two", 2, true, true},
  };
  return scenes;
}

double MapPoint::middle() const { return std::isfinite(unstable) ? std::sqrt(stable * unstable) : stable; }

double MapPoint::miss() const { return middle() / limit - 1.0; }

const CsvSchema<MapRow> &map_rows() {
  static const CsvSchema<MapRow> schema(
      {csv_column("scene", &MapRow::scene), csv_column("stepping", &MapRow::stepping),
       csv_column("D", &MapRow::D), csv_column("w0dt_stable", &MapRow::stable),
       csv_column("w0dt_unstable", &MapRow::unstable), csv_column("w0dt_theory", &MapRow::limit),
       csv_column("single", &MapRow::single)},
      3);
  return schema;
}

std::vector<MapPoint> measure_stability_map(const StudyOptions &options) {
  ResumedTable results(options.out / "map.csv", map_rows());
  const std::vector<MapRow> known = read_points(results.file(), map_rows());
  const std::vector<double> ratios = damping_ratios(options.quick);
  std::vector<const HeldScene *> scenes;
  for (const HeldScene &scene : held_scenes())
    if (!options.quick || scene.quick) scenes.push_back(&scene);
  CountedProgress progress(2 * scenes.size() * ratios.size());
  std::vector<MapPoint> map;
  for (const HeldScene *scene : scenes)
    for (const std::string stepping : {"second", "stock"})
      for (const double D : ratios) {
        MapRow row{scene->name, stepping, D};
        if (results.has(map_rows().key(row))) {
          progress.found();
          row = *find_point(known, map_rows(), row);
        } else {
          row = measure(*scene, stepping, D, options.quick);
          results.add(map_rows().cells(row));
          progress.measured(fmt::format("{}, {} stepping, D = {:.3g}: w0 dt = {:.4g}, theory {:.4g}",
                                        scene->name, stepping, D, std::sqrt(row.stable * row.unstable),
                                        row.limit));
        }
        map.push_back({scene, stepping, D, row.stable, row.unstable, row.limit});
      }
  results.finish();
  return map;
}

std::vector<Acceptance> judge_stability_map(const std::vector<MapPoint> &map) {
  const MapPoint *worst = nullptr;      // stock, farthest from theory
  const MapPoint *lowest_one = nullptr; // second
  const MapPoint *two_at_2 = nullptr;   // the lowest
  const auto miss = [](const MapPoint &p) { return std::fabs(p.miss()); };
  for (const MapPoint &p : map) {
    if (p.stepping == "stock" && (worst == nullptr || miss(p) > miss(*worst))) worst = &p;
    if (p.stepping != "second") continue;
    const auto lower = [&p](const MapPoint *than) { return than == nullptr || p.stable < than->stable; };
    if (p.scene->contacts == 1 && lower(lowest_one)) lowest_one = &p;
    if (p.scene->walls == std::string("two") && p.D == 2.0 && lower(two_at_2)) two_at_2 = &p;
  }
  if (worst == nullptr || lowest_one == nullptr || two_at_2 == nullptr)
    throw std::logic_error("a stability map without the points that it is judged by");
  return {
      {"stock stepping: boundary within 1 % of theory, every scene, law and D",
       fmt::format("worst {:.2g} % at {} and D = {:.3g}", 100.0 * miss(*worst), worst->scene->name, worst->D),
       miss(*worst) < 0.01},
      {"second stepping: one contact stable up to w0 dt = 1.95 at every D, both laws",
       fmt::format("lowest {:.4f} at D = {:.3g}", lowest_one->stable, lowest_one->D),
       lowest_one->stable >= 1.95},
      {"second stepping: between two walls at D = 2 stable up to w0 dt = 1.4, both laws",
       fmt::format("{:.4f}", two_at_2->stable), two_at_2->stable >= 1.4},
  };
}

} // namespace drumlin::post
