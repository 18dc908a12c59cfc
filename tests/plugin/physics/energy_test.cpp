/// The energy balance: the work of the exciter is the energy dissipated in contact and bond plus the change
/// of the elastic, kinetic and potential energy. The dissipated energy is the sum of the core's powers,
/// contact by contact and bond by bond, never the difference of the others.

#include "physics/bodies/bond_law.h"
#include "physics/laws/linear_contact.h"
#include "physics/bodies/excitation.h"
#include "tests/plugin/physics/velocity_verlet.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>

namespace {

using namespace drumlin::physics;
using Pair = std::array<double, 2>; // drum, frame

constexpr double pi = 3.14159265358979323846;
constexpr double m2 = 2000.0, m3 = 1000.0, g = 9.81;
const Bond bond{1e6, 1e4, 0.0};

struct Case {
  Transition transition;
  double k, ratio, w;
};

struct EnergySums {
  double input = 0.0, contact_heat = 0.0, bond_heat = 0.0;
};

class Roller {
public:
  explicit Roller(const Case &row)
      : transition_(row.transition), k_(row.k),
        c_(LinearContact{row.k, row.ratio, Damping::ratio, row.transition}.damping_coefficient(m2)) {
    exciter_.amplitude = 58.8e3;
    exciter_.angular_frequency = row.w;
  }

  [[nodiscard]] Pair equilibrium() const {
    const double drum = -(m2 + m3) * g / k_;
    return {drum, drum - m3 * g / bond.stiffness};
  }

  [[nodiscard]] Pair forces(double t, const Pair &x, const Pair &v) const { // Eq. (1)
    const double pull = bond_force(bond, x[1] - x[0], v[1] - v[0]).force;
    const double contact = LinearLaw(k_, c_, transition_).force(-x[0], -v[0]);
    return {-m2 * g + contact + pull - excitation_force(exciter_, t), -m3 * g - pull};
  }

  /// Powers: what the exciter gives, what contact and bond turn into heat.
  [[nodiscard]] EnergySums powers(double t, const Pair &x, const Pair &v) const {
    return {-excitation_force(exciter_, t) * v[0],
            LinearLaw(k_, c_, transition_).power(-x[0], -v[0]).dissipated,
            bond_force(bond, x[1] - x[0], v[1] - v[0]).dissipated};
  }

  [[nodiscard]] double energy(const Pair &x, const Pair &v) const {
    const double kinetic = 0.5 * m2 * v[0] * v[0] + 0.5 * m3 * v[1] * v[1];
    const double height = m2 * g * x[0] + m3 * g * x[1];
    return kinetic + height + LinearLaw(k_, 0.0, Transition::B).energy(-x[0]) +
           bond_force(bond, x[1] - x[0], v[1] - v[0]).stored;
  }

private:
  Transition transition_;
  double k_, c_;
  Excitation exciter_;
};

struct Result {
  double missing; ///< share of the input that is not accounted for
  EnergySums sums;
};

Result closed(const Roller &roller, const EnergySums &sums, const Pair &x, const Pair &v) {
  const double change = roller.energy(x, v) - roller.energy(roller.equilibrium(), {0.0, 0.0});
  return {(sums.input - sums.contact_heat - sums.bond_heat - change) / sums.input, sums};
}

/// Four and a third cycles with the engines' stepping; the powers by the trapezoidal rule.
Result stock(const Case &row, int steps_per_cycle) {
  const Roller roller(row);
  const double dt = 2.0 * pi / row.w / steps_per_cycle;
  verlet::Balls<2> balls{{m2, m3}, roller.equilibrium(), {0.0, 0.0}};
  EnergySums sums, before = roller.powers(0.0, balls.x, balls.v);
  const int steps = steps_per_cycle * 13 / 3;
  for (int n = 1; n <= steps; ++n) {
    verlet::stock_step(balls, n * dt, dt,
                       [&](double t, const Pair &x, const Pair &v) { return roller.forces(t, x, v); });
    const EnergySums now = roller.powers(n * dt, balls.x, balls.v);
    sums.input += 0.5 * dt * (before.input + now.input);
    sums.contact_heat += 0.5 * dt * (before.contact_heat + now.contact_heat);
    sums.bond_heat += 0.5 * dt * (before.bond_heat + now.bond_heat);
    before = now;
  }
  return closed(roller, sums, balls.x, balls.v);
}

/// The same with the classical Runge-Kutta scheme, the sums among the unknowns: fourth order while the
/// contact is closed.
Result fourth_order(const Case &row, int steps_per_cycle) {
  const Roller roller(row);
  using State = std::array<double, 7>;
  const auto rates = [&](double t, const State &y) {
    const Pair x{y[0], y[1]}, v{y[2], y[3]};
    const Pair force = roller.forces(t, x, v);
    const EnergySums power = roller.powers(t, x, v);
    return State{v[0], v[1], force[0] / m2, force[1] / m3, power.input, power.contact_heat, power.bond_heat};
  };
  const auto moved = [](const State &y, double s, const State &f) {
    State to = y;
    for (std::size_t i = 0; i < to.size(); ++i)
      to[i] += s * f[i];
    return to;
  };
  const double dt = 2.0 * pi / row.w / steps_per_cycle;
  State y{roller.equilibrium()[0], roller.equilibrium()[1]};
  const int steps = steps_per_cycle * 13 / 3;
  for (int n = 0; n < steps; ++n) {
    const double t = n * dt;
    const State f1 = rates(t, y), f2 = rates(t + 0.5 * dt, moved(y, 0.5 * dt, f1)),
                f3 = rates(t + 0.5 * dt, moved(y, 0.5 * dt, f2)), f4 = rates(t + dt, moved(y, dt, f3));
    for (std::size_t i = 0; i < y.size(); ++i)
      y[i] += dt / 6.0 * (f1[i] + 2.0 * f2[i] + 2.0 * f3[i] + f4[i]);
  }
  return closed(roller, {y[4], y[5], y[6]}, {y[0], y[1]}, {y[2], y[3]});
}

void expect_every_sink_used(const EnergySums &sums) {
  EXPECT_GT(sums.input, 0.0);
  EXPECT_GT(sums.contact_heat, 0.05 * sums.input);
  EXPECT_GT(sums.bond_heat, 0.001 * sums.input);
}

TEST(EnergyBalance, ClosesWithFourthOrderWhileInContact) { // case I: A and B alike
  for (const Transition transition : {Transition::A, Transition::B}) {
    const Case one{transition, 5e6, 0.5, 40.0 * pi};
    const Result coarse = fourth_order(one, 60), fine = fourth_order(one, 120);
    expect_every_sink_used(fine.sums);
    EXPECT_NEAR(std::log2(coarse.missing / fine.missing), 4.0, 0.3) << coarse.missing << " " << fine.missing;
    EXPECT_LT(std::fabs(fine.missing), 1e-6);
  }
}

TEST(EnergyBalance, ClosesWithFirstOrderInTheStockStepping) {
  const Case one{Transition::B, 5e6, 0.5, 40.0 * pi};
  const Result coarse = stock(one, 600), fine = stock(one, 1200);
  expect_every_sink_used(fine.sums);
  EXPECT_NEAR(std::log2(coarse.missing / fine.missing), 1.0, 0.05) << coarse.missing << " " << fine.missing;
  EXPECT_LT(std::fabs(fine.missing), 2e-2);
}

class EnergyBalanceWithGaps : public testing::TestWithParam<Case> {};

TEST_P(EnergyBalanceWithGaps, ClosesThroughMakeAndBreak) {
  const Result coarse = stock(GetParam(), 3000), fine = stock(GetParam(), 48000);
  expect_every_sink_used(fine.sums);
  EXPECT_LT(std::fabs(coarse.missing), 3e-2);
  EXPECT_LT(std::fabs(fine.missing), 3e-2 / 16.0); // first order: the makes fall anywhere within a step
}

INSTANTIATE_TEST_SUITE_P(, EnergyBalanceWithGaps,
                         testing::Values(Case{Transition::A, 1e8, 0.5, 40.0 * pi},
                                         Case{Transition::B, 1e8, 0.5, 40.0 * pi},
                                         Case{Transition::A, 1e8, 0.5, 80.0 * pi},
                                         Case{Transition::B, 1e8, 0.5, 80.0 * pi},
                                         Case{Transition::B, 1e8, 2.0, 80.0 * pi}),
                         [](const auto &row) {
                           return std::string(row.param.ratio > 1.0     ? "IV"
                                              : row.param.w > 60.0 * pi ? "III"
                                                                        : "II") +
                                  (row.param.transition == Transition::A ? "A" : "B");
                         });

// One impact: the kinetic energy that is gone, by the restitution that the closed form gives, is the
// contact's heat. Under B part of it appears after the break, while the soil relaxes (D = 0.5:
// restitution_test derives e).
TEST(EnergyBalance, DissipatesTheKineticEnergyLostInAnImpact) {
  const double m = 2000.0, k = 1e8, v = 0.4, dt = 2e-8;
  const double b_over_w = 0.5 / std::sqrt(0.75);
  const double e_a = std::exp(-pi * b_over_w);
  const double e_b = std::exp(-std::atan2(2.0 * 0.5 * std::sqrt(0.75), 2.0 * 0.25 - 1.0) * b_over_w);
  for (const Transition transition : {Transition::A, Transition::B}) {
    const double c = LinearContact{k, 0.5, Damping::ratio, transition}.damping_coefficient(m);
    verlet::Balls<1> ball{{m}, {0.0}, {-v}};
    double heat = 0.0, heat_after_break = 0.0, before = 0.0;
    for (int n = 0; n < 5000000 && ball.x[0] <= 0.0; ++n) {
      verlet::stock_step(ball, 0.0, dt,
                         [&](double, const std::array<double, 1> &x, const std::array<double, 1> &u) {
                           return std::array<double, 1>{LinearLaw(k, c, transition).force(-x[0], -u[0])};
                         });
      const double power = LinearLaw(k, c, transition).power(-ball.x[0], -ball.v[0]).dissipated;
      heat += 0.5 * dt * (before + power);
      if (!LinearLaw(k, c, transition).acts(-ball.x[0], -ball.v[0])) heat_after_break += dt * power;
      before = power;
    }
    ASSERT_GT(ball.x[0], 0.0); // it came off
    const double e = transition == Transition::A ? e_a : e_b;
    const double lost = 0.5 * m * v * v * (1.0 - e * e);
    EXPECT_NEAR(heat, lost, 1e-4 * lost);
    if (transition == Transition::A)
      EXPECT_LT(heat_after_break, 1e-6 * lost);
    else
      EXPECT_GT(heat_after_break, 1e-2 * lost);
  }
}

} // namespace
