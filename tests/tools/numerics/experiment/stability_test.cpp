// The study of stability: its known values for stock stepping are where a root of the scheme's polynomial
// passes -1 (DRUMLIN_REWRITE=1 writes inputs/study/stability/expected.csv anew); and which step of a run
// counts as the longest stable one.
#include "engine/deck_run.h"
#include "experiment/plan.h"
#include "experiment/stable_step.h"
#include "support/csv.h"
#include "support/files.h"
#include "tests/support/engine_runs.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <string>

namespace drumlin::test {
namespace {

/// The largest magnitude of the roots of (z-1)^2 + 2 n D s (z-1) + n s^2 z, the steps of velocity Verlet with
/// the damping force of the half step before, for w0 dt = s and n contacts of damping ratio D.
double growth(double n, double D, double s) {
  const std::complex<double> half = 0.5 * (2.0 - 2.0 * n * D * s - n * s * s);
  const std::complex<double> root = std::sqrt(half * half - (1.0 - 2.0 * n * D * s));
  return std::max(std::abs(half + root), std::abs(half - root));
}

double longest_stable(double n, double D) {
  double low = 1e-9, high = 4.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (growth(n, D, middle) <= 1.0 + 1e-13 ? low : high) = middle;
  }
  return low;
}

TEST(StabilityValues, AreWhereTheSchemeBeginsToGrow) {
  const post::Plan plan = post::read_plan(post::input_file("study/stability/plan"));
  std::string text = "scene,quantity,value,scale,tolerance,source\n";
  int points = 0;
  for (const post::Scene &scene : plan.scenes) {
    const std::string walls = post::value_of(scene, "scene");
    const double n = walls == "one" ? 1.0 : walls == "four" ? 4.0 : 2.0;
    ASSERT_TRUE(scene.expected.size() == 1 || post::value_of(scene, "stepping") == "stock") << scene.name;
    if (post::value_of(scene, "stepping") != "stock") {
      EXPECT_NEAR(scene.expected[0].value, 2.0 / std::sqrt(n), 1e-5) << scene.name;
      continue;
    }
    ++points;
    const double limit = longest_stable(n, post::number_from_text(post::value_of(scene, "D")));
    text += fmt::format("{},stable_step,{:.9g},{:.9g},0.01,limit of springs and dashpots\n", scene.name,
                        limit, limit);
    if (scene.expected.empty()) {
      ADD_FAILURE() << scene.name << ": no known value";
      continue;
    }
    EXPECT_NEAR(scene.expected[0].value, limit, 1e-6 * limit) << scene.name;
    EXPECT_NEAR(scene.expected[0].scale, limit, 1e-6 * limit) << scene.name;
    for (const auto &[bound, part] : {std::pair{"lowest", 0.8}, {"highest", 1.1}})
      EXPECT_NEAR(post::number_from_text(post::value_of(scene, bound)), part * limit, 0.01 * limit)
          << scene.name;
  }
  EXPECT_EQ(points, 6 * 15);
  if (std::getenv("DRUMLIN_REWRITE") != nullptr)
    post::write_files({{post::input_file("study/stability/expected.csv"), text}});
}

/// The longest stable step of three balls with steps 1, 2 and 4, of which the second moves as given: by the
/// step, in two windows of 20.
double found(const std::function<double(int)> &second, double D, int lost_from = 9999) {
  const Scratch scratch;
  std::string looks;
  for (int n = 0; n < 40; ++n) {
    const int step = n < 20 ? n : 1000 + n;
    const bool lost = step >= lost_from;
    looks +=
        fmt::format("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 "
                    "1\nITEM: ATOMS id x z\n1 1e-7 0\n",
                    step, lost ? 2 : 3);
    if (!lost) looks += fmt::format("2 {:.17g} 0\n", second(step));
    looks += "3 0 1e-3\n"; // too far
  }
  post::write_files({{scratch / "looks.dump", looks},
                     {scratch / "steps.csv", "w0_dt\n1\n2\n4\n"},
                     {scratch / "parameters.csv", fmt::format("name,value\nD,{}\n", D)}});
  return post::stable_step(scratch.path());
}

TEST(StableStep, IsThatOfTheLastBallBeforeTheFirstThatGrows) {
  const auto alternates = [](double growth) {
    return [growth](int step) { return (step % 2 == 0 ? 1e-9 : -1e-9) * std::pow(growth, step); };
  };
  EXPECT_DOUBLE_EQ(found([](int /*step*/) { return 1e-7; }, 0.5), std::sqrt(2.0 * 4.0));
  EXPECT_DOUBLE_EQ(found([](int /*step*/) { return 2e-3; }, 0.5), std::sqrt(1.0 * 2.0));
  EXPECT_DOUBLE_EQ(found([](int /*step*/) { return NAN; }, 0.5), std::sqrt(1.0 * 2.0));
  EXPECT_DOUBLE_EQ(found([](int /*step*/) { return 1e-7; }, 0.5, 1030), std::sqrt(1.0 * 2.0));
  // What changes its sign every step and grows slowly is seen only with damping: without, it would keep its
  // size.
  EXPECT_DOUBLE_EQ(found(alternates(1.0 + 1e-6), 0.5), std::sqrt(1.0 * 2.0));
  EXPECT_DOUBLE_EQ(found(alternates(1.0 + 1e-6), 0.0), std::sqrt(2.0 * 4.0));
  EXPECT_DOUBLE_EQ(found(alternates(1.0), 0.5), std::sqrt(2.0 * 4.0));
  EXPECT_DOUBLE_EQ(found([](int step) { return step < 1025 ? 1e-7 : 1.1e-7; }, 0.5), std::sqrt(2.0 * 4.0));
}

} // namespace
} // namespace drumlin::test
