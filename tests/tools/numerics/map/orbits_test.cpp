// Monodromy against finite differences, multipliers of unbroken contact against the roots of its matrix,
// onsets against closed forms and against CVODE.
#include "chain/one_contact.h"
#include "map/orbits.h"
#include "tests/support/chain_by_cvode.h"
#include "tests/support/eigenvalues.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <complex>

namespace {

using namespace drumlin::post;

ChainState settled(const ChainSolver &solver, int cycles) {
  ChainMotion motion = solver.start();
  for (int cycle = 0; cycle < cycles; ++cycle)
    solver.finish_cycle(motion);
  return motion.state;
}

Eigen::Matrix4d scaled(const Eigen::Matrix4d &jacobian, const ChainState &scale) {
  return scale.cwiseInverse().asDiagonal() * jacobian * scale.asDiagonal();
}

// A chain whose motion of period 1 doubles between k = 10 and 20 MN/m.
ChainParameters doubling_chain(double k) {
  ChainParameters p = table1_case("II", Transition::B);
  p.D = 0.1;
  p.k = k;
  return p;
}

void expect_jacobian_of_differences(const ChainParameters &p, int period) {
  const ChainSolver solver(p);
  const ChainState scale = state_scale(p);
  const auto orbit = find_orbit(solver, settled(solver, 200), period);
  ASSERT_TRUE(orbit);
  EXPECT_LT(orbit->residual, 1e-11);
  Eigen::Matrix4d differences;
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double h = 1e-6 * scale[i];
    ChainState up = orbit->state;
    ChainState down = orbit->state;
    up[i] += h;
    down[i] -= h;
    differences.col(i) = (pass(solver, up, period).end - pass(solver, down, period).end) / (2.0 * h);
  }
  EXPECT_LT((scaled(differences - orbit->passage.jacobian, scale)).norm(),
            1e-7 * scaled(differences, scale).norm());
}

TEST(Orbits, MonodromyAgreesWithFiniteDifferences) {
  for (const char *name : {"I", "II", "III", "IV"})
    for (const Transition transition : {Transition::A, Transition::B}) {
      SCOPED_TRACE(std::string(name) + transition_name(transition));
      expect_jacobian_of_differences(table1_case(name, transition), 1);
    }
  SCOPED_TRACE("period 2");
  expect_jacobian_of_differences(doubling_chain(40e6), 2);
}

TEST(Orbits, MonodromyOfStiffDampingAgreesWithFiniteDifferences) {
  for (const double D : {10.0, 1e3}) {
    SCOPED_TRACE(D);
    ChainParameters p = table1_case("II", Transition::B);
    p.D = D;
    expect_jacobian_of_differences(p, 1);
  }
}

TEST(Orbits, MultipliersOfUnbrokenContactAreExponentialsOfItsRoots) {
  for (const char *name : {"I", "IV"}) {
    const ChainParameters p = table1_case(name, Transition::A);
    const ChainSolver solver(p);
    const auto orbit = find_orbit(solver, settled(solver, 100), 1);
    ASSERT_TRUE(orbit);
    ASSERT_TRUE(orbit->always_contact());
    EXPECT_LT((orbit->state - steady_contact_state(p)).norm(), 1e-13);
    Eigen::Matrix4d a;
    a << 0, 1, 0, 0, -(p.k + p.k23) / p.m2, -(p.damping() + p.c23) / p.m2, p.k23 / p.m2, p.c23 / p.m2, 0, 0,
        0, 1, p.k23 / p.m3, p.c23 / p.m3, -p.k23 / p.m3, -p.c23 / p.m3;
    const Eigen::VectorXcd roots = oracle::eigenvalues_of(a);
    for (const std::complex<double> multiplier : orbit->multipliers) {
      double nearest = 1.0;
      for (Eigen::Index i = 0; i < 4; ++i)
        nearest = std::min(nearest, std::abs(multiplier - std::exp(roots[i] * p.period())));
      EXPECT_LT(nearest, 1e-12) << name << multiplier;
    }
  }
}

// Least contact force of the steady state with unbroken contact, by the amplitude of the frequency response;
// no code of the project.
double least_force(const ChainParameters &p) {
  const std::complex<double> i(0.0, 1.0);
  Eigen::Matrix2cd dynamic;
  const std::complex<double> bond = p.k23 + i * p.omega * p.c23;
  dynamic << p.k + i * p.omega * p.damping() + bond - p.m2 * p.omega * p.omega, -bond, -bond,
      bond - p.m3 * p.omega * p.omega;
  const Eigen::Vector2cd x = dynamic.inverse() * Eigen::Vector2cd(p.Fw, 0.0);
  const std::complex<double> contact =
      p.transition == Transition::B ? p.k + i * p.omega * p.damping() : std::complex<double>(p.k);
  return (p.m2 + p.m3) * p.g - std::abs(contact * x[0]);
}

TEST(Orbits, OnsetOfLossOfContactIsWhereTheLeastForceIsZero) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (double ChainParameters::*number : {&ChainParameters::k, &ChainParameters::Fw}) {
      const ChainFamily family = [&](double value) {
        ChainParameters p = table1_case("I", transition);
        p.*number = value;
        return p;
      };
      double from = family(0.0).*number == 0.0 ? table1_case("I", transition).*number : 0.0;
      double to = 4.0 * from;
      ASSERT_GT(least_force(family(from)), 0.0);
      ASSERT_LT(least_force(family(to)), 0.0);
      const auto onset = locate_contact_loss(family, from, to);
      ASSERT_TRUE(onset);
      for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (from + to);
        (least_force(family(middle)) > 0.0 ? from : to) = middle;
      }
      EXPECT_NEAR(onset->value, from, 1e-8 * from);
      EXPECT_NEAR(contact_margin(family(onset->value)), 0.0, 1e-4);
    }
  EXPECT_FALSE(locate_contact_loss([](double) { return table1_case("I", Transition::A); }, 1.0, 2.0));
}

TEST(Orbits, PeriodDoublingIsWhereAMultiplierIsMinusOne) {
  const ChainFamily family = doubling_chain;
  const ChainSolver before(family(15e6));
  const auto start = find_orbit(before, settled(before, 400), 1);
  ASSERT_TRUE(start);
  ASSERT_TRUE(start->stable());
  const auto doubling = locate_doubling(family, 15e6, 25e6, *start);
  ASSERT_TRUE(doubling);
  EXPECT_TRUE(doubling->smooth);
  // To 1e-8: within that the multiplier passes -1.
  const std::vector<BranchPoint> branch = continue_orbit(family, 15e6, doubling->value, 8, *start);
  ASSERT_EQ(branch.back().value, doubling->value);
  const auto least = [&](double value) {
    const auto orbit = find_orbit(ChainSolver(family(value)), branch.back().orbit.state, 1);
    EXPECT_TRUE(orbit);
    double real = 0.0;
    for (const auto &multiplier : orbit->multipliers)
      real = std::min(real, multiplier.real());
    return real;
  };
  EXPECT_GT(least(doubling->value * (1.0 - 1e-8)), -1.0);
  EXPECT_LT(least(doubling->value * (1.0 + 1e-8)), -1.0);
  // What CVODE does on both sides.
  for (const double side : {-0.02, 0.02}) {
    ExactOptions options;
    options.cycles = 300;
    options.samples_per_cycle = 1;
    const ChainHistory h =
        drumlin::test::solve_by_cvode(family(doubling->value * (1.0 + side)), options).history;
    const std::size_t last = h.size() - 1;
    const double alternates = std::fabs(h.v_drum[last] - h.v_drum[last - 1]);
    const double repeats = std::fabs(h.v_drum[last] - h.v_drum[last - 2]);
    EXPECT_EQ(alternates > 1e-3, side > 0.0) << side;
    EXPECT_LT(repeats, 1e-4) << side;
  }
}

TEST(Orbits, AnUnstableOrbitIsFollowedBeyondTheDoubling) {
  const ChainSolver before(doubling_chain(15e6));
  const auto start = find_orbit(before, settled(before, 400), 1);
  ASSERT_TRUE(start);
  const std::vector<BranchPoint> branch = continue_orbit(doubling_chain, 15e6, 40e6, 10, *start);
  EXPECT_EQ(branch.back().value, 40e6);
  EXPECT_FALSE(branch.back().orbit.stable());
}

TEST(Orbits, TheExponentOfAStableOrbitIsTheLogarithmOfItsMultiplier) {
  for (const int period : {1, 2}) {
    const ChainSolver solver(period == 1 ? table1_case("II", Transition::A) : doubling_chain(30e6));
    ChainState state = settled(solver, 400);
    const auto orbit = find_orbit(solver, state, period);
    ASSERT_TRUE(orbit);
    ASSERT_TRUE(orbit->stable());
    const Exponent exponent = largest_exponent(solver, state, 100, 2000);
    EXPECT_NEAR(exponent.mean, std::log(std::abs(orbit->multipliers[0])) / period, 2e-3);
    EXPECT_LE(exponent.low, exponent.mean);
    EXPECT_GE(exponent.high, exponent.mean);
  }
}

TEST(Orbits, NeighboursOfAnAperiodicMotionPartAsItsExponentSays) {
  const ChainSolver solver(doubling_chain(100e6));
  ChainState state = settled(solver, 300);
  const ChainState start = state;
  const Exponent exponent = largest_exponent(solver, state, 20, 4000);
  EXPECT_GT(exponent.low, 0.0);
  // Growth of a finite distance, brought back to 1e-8 after every cycle.
  const ChainState scale = state_scale(solver.parameters());
  ChainState near = start + 1e-8 * scale;
  ChainState on = start;
  double sum = 0.0;
  const int cycles = 4000;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    on = pass(solver, on, 1).end;
    const ChainState apart = pass(solver, near, 1).end - on;
    const double growth = apart.cwiseQuotient(scale).norm() / 1e-8;
    sum += std::log(growth / (cycle == 0 ? 2.0 : 1.0));
    near = on + apart / growth;
  }
  EXPECT_NEAR(sum / cycles, exponent.mean, 2.0 * (exponent.high - exponent.low));
}

} // namespace
