// inputs/benchmarks/in.penetration: a ball that strikes a small bed and stops in it, under both laws in both
// engines; what its result.csv says follows from the motion that it records.
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include "runs/parameter_file.h"
#include "support/csv.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace drumlin::test {
namespace {

class Penetration : public ::testing::TestWithParam<std::tuple<const char *, const char *>> {};

TEST_P(Penetration, EndsWithWhatItsMotionGives) {
  const auto &[engine, law] = GetParam();
  const bool lammps = std::string(engine) == "lammps";
  if (lammps && !post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  const Scratch scratch;
  const std::string deck = std::string("inputs/benchmarks/in.penetration") + (lammps ? ".lammps" : "");
  well(run_deck(std::filesystem::path(DRUMLIN_SOURCE_DIR) / deck,
                {{"law", law},
                 {"sample", "1e-4"},
                 {"rows", "2000"},
                 {"columns", "5"},
                 {"layers", "8"},
                 {"speed", "1"},
                 {"out", "out"}},
                scratch.path()));
  const post::Table motion = post::read_table(scratch / "out/penetration.csv");
  const std::vector<double> t = motion.numbers("time_s"), y = motion.numbers("y_m"),
                            v = motion.numbers("vy_m_per_s"), depth = motion.numbers("depth_m");
  std::map<std::string, double> p;
  for (const auto &[name, text] : post::read_parameters(scratch / "out/parameters.csv"))
    if (const auto value = post::any_number_from_text(text)) p[name] = *value;

  // Its first sample is one of free flight, and at its last it is at rest.
  EXPECT_EQ(v[0], -p["speed"]);
  EXPECT_NEAR(y[1], y[0] - p["speed"] * t[1] - p["g"] / 2 * t[1] * t[1], 1e-12);
  EXPECT_LT(std::fabs(v.back()), 0.01 * p["speed"]);
  EXPECT_DOUBLE_EQ(depth.back(), p["surface"] + p["ball_radius"] - y.back());
  EXPECT_GT(p["solid_fraction"], 0.5);
  EXPECT_LT(p["solid_fraction"], 0.66);

  const double gap = y[0] - p["ball_radius"] - p["surface"];
  const double way = p["speed"] * p["speed"] / (2 * p["g"]) + gap + depth.back();
  const double ratio = p["ball_density"] / (p["solid_fraction"] * p["density"]);
  const double diameter = 2 * p["ball_radius"];
  const double C = depth.back() / (std::sqrt(ratio) * std::cbrt(diameter * diameter * way));
  const double time = t.back() - gap / p["speed"];
  const post::Table result = post::read_table(scratch / "out/result.csv");
  EXPECT_NEAR(result.numbers("C")[0], C, 1e-9 * C);
  EXPECT_NEAR(result.numbers("stopping_time_over_depth_and_speed")[0], time * p["speed"] / depth.back(),
              1e-9 * time * p["speed"] / depth.back());
  EXPECT_DOUBLE_EQ(result.numbers("depth_m")[0], depth.back());
  // Of this small bed; that of the study, far from its floor, has 0.2 to 0.3.
  EXPECT_GT(C, 0.1);
  EXPECT_LT(C, 0.3);
}

INSTANTIATE_TEST_SUITE_P(Laws, Penetration,
                         ::testing::Combine(::testing::Values("liggghts", "lammps"),
                                            ::testing::Values("transition", "own")),
                         [](const auto &test) {
                           return std::string(std::get<0>(test.param)) + "_" + std::get<1>(test.param);
                         });

} // namespace
} // namespace drumlin::test
