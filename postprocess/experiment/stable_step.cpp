#include "experiment/stable_step.h"

#include "bed/dump_readers.h"
#include "runs/parameter_file.h"
#include "support/csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

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

  bool has_grown(bool damped) const {
    for (const std::vector<double> *window : {&half_time, &end})
      for (const double x : *window)
        if (!(std::fabs(x) < growth_limit * first_push)) return true;
    // In both halves of the window: rounding can kick a heavily damped ball once.
    const auto middle = end.begin() + static_cast<std::ptrdiff_t>(end.size() / 2);
    const double fast = std::min(fast_part({end.begin(), middle}), fast_part({middle, end.end()}));
    return damped && fast > fast_noise && fast > fast_growth * fast_part(half_time);
  }
};

/// Which balls are stable. A ball that is lost is not.
std::vector<bool> stable_balls(const fs::path &looks, std::size_t balls, bool damped) {
  const std::vector<TextDump> dumps = read_text_dumps(looks);
  std::vector<std::array<Watched, 2>> watched(balls); // x and z
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
  if (!second_window) csv_fault(looks, 0, "x", "has not two windows");
  std::vector<bool> stable;
  stable.reserve(watched.size());
  for (const auto &[x, z] : watched)
    stable.push_back(x.half_time.size() + x.end.size() == dumps.size() && !x.has_grown(damped) &&
                     !z.has_grown(damped));
  return stable;
}

} // namespace

double stable_step(const fs::path &folder) {
  const std::vector<double> steps = read_table(folder / "steps.csv").numbers("w0_dt");
  const double D = number_from_text(read_parameters(folder / "parameters.csv").at("D"));
  const std::vector<bool> stable = stable_balls(folder / "looks.dump", steps.size(), D > 0.0);
  const auto turn = static_cast<std::size_t>(std::find(stable.begin(), stable.end(), false) - stable.begin());
  if (turn == 0) csv_fault(folder / "steps.csv", 1, "w0_dt", "is unstable");
  return turn == steps.size() ? steps.back() : std::sqrt(steps[turn - 1] * steps[turn]);
}

} // namespace drumlin::post
