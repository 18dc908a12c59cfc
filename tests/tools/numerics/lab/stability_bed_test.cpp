// The oracles of the small bed against made-up records.
#include "lab/stability/bed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace drumlin::post {
namespace {

/// A bed of 10 balls and 100 N, whose floor gives `force`.
std::vector<BedState> bed(double force) {
  std::vector<BedState> states;
  for (int n = 0; n <= 10; ++n)
    states.push_back({0.1 * n, 10.0, 100.0, force, (force - 100.0) * 0.1 * n, 1e-9});
  return states;
}

TEST(BedBalance, IsZeroAtRest) { EXPECT_NEAR(balance_error(bed(100.0), 1.0), 0.0, 1e-10); }

TEST(BedBalance, ShowsAFloorThatDoesNotCarryTheWeight) {
  EXPECT_NEAR(balance_error(bed(98.0), 1.0), 0.02, 1e-10);
}

TEST(BedBalance, ShowsAnErrorOfMomentum) {
  std::vector<BedState> states = bed(100.0);
  states.back().momentum = 5.0; // of 100 N s
  EXPECT_NEAR(balance_error(states, 1.0), 0.05, 1e-10);
}

TEST(BedBalance, ShowsAnErrorOfEnergyAtAnyTime) {
  std::vector<BedState> states = bed(100.0);
  states[5].kinetic_energy = 3.0;
  EXPECT_NEAR(balance_error(states, 1.0), 0.03, 1e-10);
  EXPECT_NEAR(balance_error(states, 0.1), 0.3, 1e-10);
}

TEST(BedBalance, IsInfiniteIfABallIsLostOrANumberNotFinite) {
  std::vector<BedState> states = bed(100.0);
  states.back().balls = 9.0;
  EXPECT_TRUE(std::isinf(balance_error(states, 1.0)));
  for (double BedState::*number : {&BedState::floor_force, &BedState::momentum, &BedState::kinetic_energy}) {
    states = bed(100.0);
    states[3].*number = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isinf(balance_error(states, 1.0)));
  }
  EXPECT_THROW(balance_error({}, 1.0), std::runtime_error);
}

TEST(BedPicture, DistanceIsTheFarthestBalls) {
  const BedPicture a = {{1, {0.0, 0.0}}, {2, {1.0, 1.0}}};
  BedPicture b = a;
  EXPECT_EQ(picture_distance(a, b), 0.0);
  b[2] = {1.3, 0.6};
  EXPECT_NEAR(picture_distance(a, b), 0.5, 1e-15);
  b[2][0] = std::nan("");
  EXPECT_TRUE(std::isinf(picture_distance(a, b)));
  b.erase(2);
  b[3] = {1.0, 1.0};
  EXPECT_TRUE(std::isinf(picture_distance(a, b)));
}

} // namespace
} // namespace drumlin::post
