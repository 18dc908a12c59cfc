// All combinations of tangential and rolling models that the plugin supports, between balls, on primitive
// planes and on a mesh: they run, stay finite, keep the balls in the box and dissipate energy.
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

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

std::vector<Frame> run_box(const Combination &models, const char *transition, const char *stepping) {
  const Scratch scratch;
  well(run_scene("liggghts", "box",
                 {{"models", models.words()}, {"transition", transition}, {"stepping", stepping}},
                 scratch.path()));
  return read_dump(scratch / "balls.txt");
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
      const std::vector<Frame> frames = run_box(GetParam(), transition, stepping);
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
  well(run_scene("liggghts", "box",
                 {{"models", "tangential history"}, {"stepping", "stock"}, {"every", "20"}}, scratch.path()));
  int on_floor = 0;
  double worst = 0, largest = 0;
  for (const Frame &frame : read_dump(scratch / "balls.txt")) {
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

const Combination combinations[] = {{"off", "off"},       {"off", "epsd2"},   {"history", "off"},
                                    {"history", "epsd2"}, {"coulomb", "off"}, {"coulomb", "epsd2"}};
std::string name_of(const ::testing::TestParamInfo<Combination> &test) {
  return test.param.tangential + "_" + test.param.rolling;
}
INSTANTIATE_TEST_SUITE_P(Models, Combinations, ::testing::ValuesIn(combinations), name_of);

} // namespace
} // namespace drumlin::test
