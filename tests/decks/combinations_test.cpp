// All combinations of tangential and rolling models that the plugin supports, between balls, on primitive
// planes and on a mesh: they run, stay finite, keep the balls in the box, dissipate energy, and agree on 1
// and 2 ranks.
#include "tests/support/balls_run.h"
#include "tests/support/checks.h"

#include "bed/dump_readers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <ostream>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

struct Combination {
  std::string tangential, rolling;
  std::string words() const { return "tangential " + tangential + " rolling_friction " + rolling; }
};

void PrintTo(const Combination &value, std::ostream *out) { *out << value.words(); }

std::vector<Frame> run_box(const Combination &models, const char *transition, const char *stepping,
                           int ranks) {
  const Scratch scratch;
  write_floor(scratch / "floor.stl", 0.3, false);
  const Outcome outcome = well(run_deck(
      test_deck("box.in"), {{"models", models.words()}, {"transition", transition}, {"stepping", stepping}},
      scratch.path(), ranks));
  return outcome.ok() ? read_dump(scratch / "state.dump") : std::vector<Frame>{};
}

constexpr double mass = 0.16, radius = 0.025, g = 9.81;

double energy(const Frame &frame) {
  double sum = 0;
  for (const auto &[id, ball] : frame.balls) {
    sum += mass * g * ball.x[2];
    for (std::size_t a = 0; a < 3; ++a)
      sum += 0.5 * mass * (ball.v[a] * ball.v[a] + 0.4 * radius * radius * ball.omega[a] * ball.omega[a]);
  }
  return sum;
}

class Combinations : public ::testing::TestWithParam<Combination> {};

TEST_P(Combinations, RunAndDissipateEnergy) {
  for (const char *transition : {"A", "B"}) {
    for (const char *stepping : {"second", "stock"}) {
      const std::vector<Frame> frames = run_box(GetParam(), transition, stepping, 1);
      ASSERT_EQ(frames.size(), 5u);
      const Frame &end = frames.back();
      ASSERT_EQ(end.balls.size(), 50u);
      double spin_change = 0;
      for (const auto &[id, ball] : end.balls) {
        for (const auto part : {&Ball::x, &Ball::v, &Ball::f, &Ball::omega, &Ball::torque})
          for (const double value : ball.*part)
            ASSERT_TRUE(std::isfinite(value)) << "ball " << id;
        // Walls at -0.15 and 0.15, floor at 0; an impact at 1 m/s overlaps by a millimetre.
        EXPECT_LT(std::fabs(ball.x[0]), 0.15 - radius + 0.002);
        EXPECT_LT(std::fabs(ball.x[1]), 0.15 - radius + 0.002);
        EXPECT_GT(ball.x[2], radius - 0.002);
        spin_change += std::fabs(ball.omega[0]) + std::fabs(ball.omega[1] - 20) + std::fabs(ball.omega[2]);
      }
      EXPECT_LT(energy(end), 0.7 * energy(frames.front()));
      const bool turns = GetParam().tangential != "off" || GetParam().rolling != "off";
      EXPECT_EQ(spin_change > 1, turns) << spin_change;
    }
  }
}

TEST(MeshFloor, RowsOfContactsExplainTheForceOnEachBall) {
  const Scratch scratch;
  write_floor(scratch / "floor.stl", 0.3, false);
  well(run_deck(test_deck("box.in"),
                {{"models", "tangential history"}, {"stepping", "stock"}, {"every", "20"}}, scratch.path()));
  int on_floor = 0;
  double worst = 0, largest = 0;
  for (const Frame &frame : read_dump(scratch / "state.dump")) {
    std::map<long, std::array<double, 3>> rest;
    for (const auto &[id, ball] : frame.balls)
      rest[id] = {ball.f[0], ball.f[1], ball.f[2] + mass * g};
    const std::string rows = "contacts_" + std::to_string(frame.step) + ".dump";
    for (const std::vector<double> &row : post::read_text_dump(scratch / rows).rows) {
      const std::array<double, 3> force = {row[2], row[3], row[4]};
      const auto i = static_cast<long>(row[0]), j = static_cast<long>(row[1]); // j = 0: a wall
      const Ball &ball = frame.balls.at(i);
      const bool at_a_side = std::max(std::fabs(ball.x[0]), std::fabs(ball.x[1])) > 0.15 - radius;
      if (j == 0 && !at_a_side) ++on_floor;
      for (std::size_t a = 0; a < 3; ++a) {
        rest[i][a] -= force[a];
        if (j > 0) rest[j][a] += force[a];
        largest = std::max(largest, std::fabs(force[a]));
      }
    }
    for (const auto &[id, force] : rest)
      for (const double component : force)
        worst = std::max(worst, std::fabs(component));
  }
  EXPECT_GT(on_floor, 50);
  EXPECT_LT(worst, 1e-12 * largest);
}

/// The engine numbers the balls rank by rank: by where they start, then.
std::map<std::array<double, 3>, Ball> by_start(const std::vector<Frame> &frames) {
  std::map<std::array<double, 3>, Ball> balls;
  for (const auto &[id, ball] : frames.back().balls)
    balls[frames.front().balls.at(id).x] = ball;
  return balls;
}

class CombinationsOnRanks : public ::testing::TestWithParam<Combination> {};

TEST_P(CombinationsOnRanks, AgreeWithOne) {
  for (const char *transition : {"A", "B"}) {
    const std::vector<Frame> one = run_box(GetParam(), transition, "second", 1),
                             two = run_box(GetParam(), transition, "second", 2);
    ASSERT_FALSE(one.empty() || two.empty());
    const auto expected = by_start(one), found = by_start(two);
    ASSERT_EQ(expected.size(), 50u);
    double worst_x = 0, worst_spin = 0;
    for (const auto &[start, ball] : expected)
      for (std::size_t a = 0; a < 3; ++a) {
        worst_x = std::max(worst_x, std::fabs(found.at(start).x[a] - ball.x[a]));
        worst_spin = std::max(worst_spin, std::fabs(found.at(start).omega[a] - ball.omega[a]));
      }
    EXPECT_LT(worst_x, 1e-10 * radius) << transition;
    EXPECT_LT(worst_spin, 1e-8 * 20) << transition;
    RecordProperty(std::string("worst_x_") + transition, number(worst_x));
    RecordProperty(std::string("worst_spin_") + transition, number(worst_spin));
  }
}

const Combination combinations[] = {{"off", "off"},       {"off", "epsd2"},   {"history", "off"},
                                    {"history", "epsd2"}, {"coulomb", "off"}, {"coulomb", "epsd2"}};
std::string name_of(const ::testing::TestParamInfo<Combination> &test) {
  return test.param.tangential + "_" + test.param.rolling;
}
INSTANTIATE_TEST_SUITE_P(Models, Combinations, ::testing::ValuesIn(combinations), name_of);
INSTANTIATE_TEST_SUITE_P(Models, CombinationsOnRanks, ::testing::ValuesIn(combinations), name_of);

} // namespace
} // namespace drumlin::test
