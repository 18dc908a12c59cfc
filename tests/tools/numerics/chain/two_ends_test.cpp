// The drum with two ends: against the chain where it cannot tilt, against closed forms and complex algebra in
// unbroken contact, and against CVODE where its ends lose contact.
#include "chain/exact_solution.h"
#include "chain/two_ends.h"
#include "files/roller.h"
#include "tests/support/chain_record.h"
#include "tests/support/two_ends_energy.h"
#include "tests/support/two_ends_oracle.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <random>
#include <string>
#include <tuple>
#include <vector>

namespace {

using namespace drumlin::post;
using drumlin::test::largest, drumlin::test::relative;

constexpr double pi = 3.14159265358979323846;

ExactOptions cycles(double count, int samples = 200) {
  ExactOptions options;
  options.cycles = count;
  options.samples_per_cycle = samples;
  return options;
}

// The drum and frame of a chain, with equal bonds at both ends, on equal contacts.
TwoEnds equal_halves(const ChainParameters &chain, int contacts) {
  TwoEnds machine = two_ends(chain, drumlin::Roller());
  machine.contacts = equal_contacts(contacts, 2.13, chain.k, chain.damping());
  return machine;
}

TwoEnds axas(const ChainParameters &soil) {
  const drumlin::Roller roller = drumlin::read_roller(DRUMLIN_SOURCE_DIR "/inputs/rollers/Axas2020");
  ChainParameters chain = soil;
  set_machine(chain, roller, roller.settings.front());
  return two_ends(chain, roller);
}

class EveryHalf : public testing::TestWithParam<std::tuple<const char *, Transition, int>> {};

TEST_P(EveryHalf, EqualHalvesOnEqualBondsAreTheSingleDrum) {
  const auto [name, transition, contacts] = GetParam();
  const ChainParameters chain = table1_case(name, transition);
  for (const double speed : {0.0, 0.3}) {
    SCOPED_TRACE(speed);
    ExactOptions options = cycles(30.4);
    options.impact_speed = speed;
    const ExactSolution single = solve_chain(chain, options);
    const TwoEndsResult halves = solve_two_ends(equal_halves(chain, contacts), options);
    for (const HistoryColumn &column : history_columns) {
      if (column.group != ColumnGroup::motion && column.group != ColumnGroup::frame) continue;
      EXPECT_LT(relative(halves.history.*column.values, single.history.*column.values), 1e-12) << column.name;
    }
    EXPECT_EQ(largest(halves.history.theta_drum), 0.0);
    EXPECT_LT(relative(halves.history.a_left, single.history.a_drum), 1e-12);
    ASSERT_EQ(halves.events.size(), single.events.size() * static_cast<std::size_t>(contacts));
    for (std::size_t i = 0; i < halves.events.size(); ++i) {
      const ContactEvent &one = halves.events[i];
      const auto part = static_cast<std::size_t>(contacts);
      const ContactEvent &all = single.events[i / part];
      EXPECT_EQ(one.make, all.make);
      EXPECT_EQ(one.id_j, static_cast<long>(2 + i % part));
      EXPECT_NEAR(one.time, all.time, 1e-12 * chain.period());
      EXPECT_NEAR(one.force * contacts, all.force, 1e-11 * largest(single.history.F_contact));
    }
    ASSERT_EQ(halves.cycles.size(), single.cycles.size());
    for (std::size_t i = 0; i < single.cycles.size(); ++i) {
      EXPECT_NEAR(halves.cycles[i].contact_share, single.cycles[i].contact_share, 1e-12);
      EXPECT_NEAR(halves.cycles[i].F_contact_max, single.cycles[i].F_contact_max,
                  1e-12 * largest(single.history.F_contact));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(TwoEnds, EveryHalf,
                         testing::Combine(testing::Values("I", "II", "III", "IV"),
                                          testing::Values(Transition::A, Transition::B),
                                          testing::Values(1, 2, 3, 4, 8, 16, 32)));

// Two springs k/2 at +-b on a drum whose frame is hung so softly that its bond is a constant force: the tilt
// is a cosine with the frequency sqrt(k b^2/I).
TEST(TwoEnds, FreeRockingHasItsFrequency) {
  ChainParameters chain;
  chain.Fw = 0.0;
  chain.D = 0.0;
  chain.k = 3e7;
  chain.k23 = 1e-6;
  chain.c23 = 0.0;
  TwoEnds machine = two_ends(chain, drumlin::Roller());
  const double b = 0.6;
  machine.contacts = {{-b, 0.5 * chain.k, 0.0}, {b, 0.5 * chain.k, 0.0}};
  machine.tilt = 1e-5;
  const double omega = std::sqrt(chain.k * b * b / machine.drum_inertia);
  const ChainHistory h = solve_two_ends(machine, cycles(200)).history;
  for (std::size_t i = 0; i < h.size(); i += 7)
    ASSERT_NEAR(h.theta_drum[i], machine.tilt * std::cos(omega * h.time[i]),
                1e-9 * machine.tilt * std::max(1.0, omega * h.time[i]))
        << i;
  EXPECT_LT(largest(h.v_drum), 1e-9);
}

// ---- steady unbroken motion ----

using Complex = std::complex<double>;

// Amplitudes of drum, frame and their tilts under the force of the exciter, down as Fw sin(omega t).
Eigen::Vector4cd steady(const TwoEnds &machine) {
  const double w = machine.chain.omega;
  Eigen::Matrix4cd dynamic = Eigen::Matrix4cd::Zero();
  dynamic.diagonal() << -w * w * machine.chain.m2, -w * w * machine.chain.m3, -w * w * machine.drum_inertia,
      -w * w * machine.frame_inertia;
  const auto add = [&](const AxleLink &link, const Eigen::Vector4d &way) {
    dynamic += Complex(link.k, w * link.c) * (way * way.transpose()).cast<Complex>();
  };
  for (const AxleLink &link : machine.contacts)
    add(link, {1.0, 0.0, link.y, 0.0});
  for (const AxleLink &link : machine.bonds)
    add(link, {1.0, -1.0, link.y, -link.y});
  const Eigen::Vector4d push(-machine.chain.Fw, 0.0, -machine.exciter * machine.chain.Fw, 0.0);
  return dynamic.partialPivLu().solve(push.cast<Complex>());
}

TEST(TwoEnds, SteadyUnbrokenMotionIsThatOfComplexAlgebra) {
  ChainParameters soil;
  soil.k = 15e6;
  soil.D = 0.2;
  for (const double ratio : {1.0, 1.5})
    for (const double exciter : {0.0, 0.1}) {
      TwoEnds machine = axas(soil);
      machine.chain.transition = Transition::A;
      machine.chain.g = 30.0; // heavy enough that contact is never lost
      machine.exciter = exciter;
      const double c = 0.4 * std::sqrt(machine.chain.m2 * soil.k), b = 2.13 / std::sqrt(12.0);
      const double left = ratio / (1.0 + ratio);
      machine.contacts = {{-b, left * soil.k, left * c}, {b, (1.0 - left) * soil.k, (1.0 - left) * c}};
      const Eigen::Vector4cd amplitude = steady(machine);
      constexpr int samples = 64;
      const TwoEndsResult result = solve_two_ends(machine, cycles(300, samples));
      EXPECT_TRUE(result.events.empty());
      const ChainHistory &h = result.history;
      const auto first = [&](const std::vector<double> &column) { // times sin(omega t)'s phase
        Complex sum = 0.0;
        for (std::size_t i = column.size() - samples; i < column.size(); ++i)
          sum += column[i] * std::exp(Complex(0.0, -2.0 * pi * static_cast<double>(i) / samples));
        return sum * 2.0 / double(samples) * Complex(0.0, 1.0);
      };
      const double size = std::abs(amplitude[0]), w2 = std::pow(machine.chain.omega, 2);
      EXPECT_LT(std::abs(first(h.x_drum) - amplitude[0]), 1e-9 * size);
      EXPECT_LT(std::abs(first(h.x_frame) - amplitude[1]), 1e-9 * size);
      EXPECT_LT(std::abs(first(h.theta_drum) - amplitude[2]), 1e-9 * size);
      EXPECT_LT(std::abs(first(h.theta_frame) - amplitude[3]), 1e-9 * size);
      EXPECT_LT(std::abs(first(h.a_left) + w2 * (amplitude[0] - 1.065 * amplitude[2])), 1e-9 * size * w2);
      EXPECT_LT(std::abs(first(h.a_right) + w2 * (amplitude[0] + 1.065 * amplitude[2])), 1e-9 * size * w2);
      // The multipliers are those of free vibration: less than one.
      EXPECT_EQ(result.orbit.cycles, 1);
      EXPECT_LT(result.orbit.largest, 1.0);
    }
}

// ---- loss of contact, against CVODE ----

TEST(TwoEnds, RandomMachinesAndSoilsFollowCvode) {
  std::mt19937_64 random(44);
  const auto between = [&random](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  int compared = 0, unstable = 0;
  double worst = 0.0;
  for (int trial = 0; compared < 500 && trial < 2000; ++trial) {
    SCOPED_TRACE(trial);
    ChainParameters soil;
    soil.k = std::exp(between(std::log(5e6), std::log(1e8)));
    soil.D = between(0.05, 0.5);
    TwoEnds machine = axas(soil);
    ChainParameters &p = machine.chain;
    p.transition = trial % 2 == 0 ? Transition::A : Transition::B;
    p.omega *= between(0.6, 1.2);
    p.Fw *= between(0.5, 1.3);
    machine.drum_inertia *= between(0.5, 2.0);
    machine.exciter = between(-0.1, 0.1);
    for (AxleLink &bond : machine.bonds) {
      bond.k *= between(0.5, 1.5);
      bond.c *= between(0.5, 1.5);
    }
    const std::array<int, 5> counts = {2, 2, 3, 4, 8};
    machine.contacts =
        equal_contacts(counts[static_cast<std::size_t>(trial) % counts.size()], 2.13, p.k, p.damping());
    const double slope = between(-0.3, 0.3);
    for (AxleLink &contact : machine.contacts) {
      contact.k *= (1.0 + slope * contact.y) * between(0.8, 1.2);
      contact.c *= (1.0 + slope * contact.y) * between(0.8, 1.2);
    }
    const TwoEndsSolver solver(machine);
    const TwoEndsMotion start = solver.start();
    TwoEndsMotion exact = start, near = start;
    const double size = p.Fw / (p.m2 * p.omega * p.omega);
    near.state[0] -= 1e-9 * size; // a neighbour, which shows how much the motion multiplies errors
    drumlin::test::TwoEndsOracle oracle(machine, start.state);
    double apart = 0.0, growth = 0.0;
    for (int cycle = 1; cycle <= 8; ++cycle) {
      solver.finish_cycle(exact);
      solver.finish_cycle(near);
      const auto &cvode = oracle.at(cycle * p.period());
      for (int i = 0; i < 8; ++i) {
        const double scale = size * (i < 4 ? 1.0 : p.omega);
        apart = std::max(apart, std::fabs(exact.state[i] - cvode[static_cast<std::size_t>(i)]) / scale);
        growth = std::max(growth, std::fabs(exact.state[i] - near.state[i]) / (1e-9 * scale));
      }
    }
    if (!oracle.left_lost() || !oracle.right_lost()) continue;
    if (growth > 100.0) { // such a motion multiplies the errors of both solvers
      ++unstable;
      continue;
    }
    ++compared;
    worst = std::max(worst, apart);
    EXPECT_LT(apart, 1e-8) << "growth " << growth << ", breaks " << oracle.breaks();
  }
  RecordProperty("unstable", unstable);
  RecordProperty("largest_difference_1e_12", static_cast<int>(worst * 1e12));
  EXPECT_EQ(compared, 500);
  EXPECT_LT(unstable, 250);
}

// ---- energy ----

TEST(TwoEnds, EnergyIsBalanced) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (const int contacts : {2, 5}) {
      ChainParameters soil;
      soil.k = 4e7;
      soil.D = 0.2;
      TwoEnds machine = axas(soil);
      machine.chain.transition = transition;
      machine.exciter = 0.05;
      machine.contacts = equal_contacts(contacts, 2.13, soil.k, machine.chain.damping());
      machine.contacts.front().k *= 1.7;
      const TwoEndsSolver solver(machine);
      TwoEndsMotion motion = solver.start();
      drumlin::test::TwoEndsEnergy energy(machine);
      const double before = energy.stored(motion.state);
      for (int cycle = 0; cycle < 50; ++cycle)
        solver.finish_cycle(motion, &energy);
      EXPECT_NEAR(energy.stored(motion.state) - before + energy.dissipated, energy.work,
                  1e-9 * energy.turned);
      EXPECT_GT(energy.work, 0.1 * energy.turned);
    }
}

// ---- stability ----

TEST(TwoEnds, TheMonodromyMatrixIsThatOfSmallDifferences) {
  for (const Transition transition : {Transition::A, Transition::B}) {
    ChainParameters soil;
    soil.k = 5e7;
    soil.D = 0.2;
    TwoEnds machine = axas(soil);
    machine.chain.transition = transition;
    machine.contacts = equal_contacts(4, 2.13, soil.k, machine.chain.damping());
    machine.contacts.front().k *= 1.3;
    const TwoEndsSolver solver(machine);
    TwoEndsMotion motion = solver.start();
    for (int cycle = 0; cycle < 20; ++cycle)
      solver.finish_cycle(motion);
    TwoEndsMotion reference = motion;
    const TwoEndsMatrix matrix = solver.monodromy(reference);
    for (int i = 0; i < 8; ++i) {
      const double step = 1e-8 * (i < 4 ? 1e-3 : 0.2);
      std::array<TwoEndsState, 2> ends;
      for (const int side : {0, 1}) {
        TwoEndsMotion moved = motion;
        moved.state[i] += side == 0 ? -step : step;
        solver.finish_cycle(moved);
        ends[static_cast<std::size_t>(side)] = moved.state;
      }
      const TwoEndsState slope = (ends[1] - ends[0]) / (2.0 * step);
      EXPECT_LT((slope - matrix.col(i)).norm(), 1e-4 * (1.0 + matrix.col(i).norm())) << i;
    }
  }
}

// Equal halves on equal bonds in partial uplift, the same in each cycle as long as the drum does not tilt:
// the multiplier of tilting is that by which a small tilt grows in each cycle.
TEST(TwoEnds, TheMultiplierOfTiltingIsTheGrowthOfASmallTilt) {
  ChainParameters soil;
  soil.k = 74e6;
  soil.D = 0.23;
  ChainParameters chain = axas(soil).chain;
  chain.Fw *= std::pow(22.0 / 29.0, 2);
  chain.omega *= 22.0 / 29.0;
  TwoEnds machine = equal_halves(chain, 2);
  machine.drum_inertia = 2900.0;
  const TwoEndsResult steady = solve_two_ends(machine, cycles(400, 4));
  EXPECT_EQ(steady.orbit.cycles, 1);
  EXPECT_GT(steady.orbit.of_tilt, 1.2);
  EXPECT_EQ(largest(steady.history.theta_drum), 0.0);

  const TwoEndsSolver solver(machine);
  TwoEndsMotion motion = solver.start();
  for (int cycle = 0; cycle < 400; ++cycle)
    solver.finish_cycle(motion);
  motion.state[2] = 1e-11;
  double growth = 0.0;
  for (int cycle = 0; cycle < 30; ++cycle) {
    const double before = std::fabs(motion.state[2]);
    solver.finish_cycle(motion);
    growth = std::fabs(motion.state[2]) / before;
  }
  EXPECT_NEAR(growth, steady.orbit.of_tilt, 1e-4);
  // In the end the drum tilts by far more.
  for (int cycle = 0; cycle < 300; ++cycle)
    solver.finish_cycle(motion);
  EXPECT_GT(std::fabs(motion.state[2]), 1e-4);
}

// ---- cost ----

// 200 cycles in 10 ms with two contacts and in 200 ms with sixteen, at less than a microsecond for a piece
// and contact.
TEST(TwoEnds, TwoHundredCyclesTakeFewPieces) {
  for (const auto &[contacts, most] : {std::pair(2, 9000), std::pair(16, 20000)})
    for (const double k : {15e6, 45e6, 1e8}) {
      ChainParameters soil;
      soil.k = k;
      soil.D = 0.2;
      TwoEnds machine = axas(soil);
      machine.contacts = equal_contacts(contacts, 2.13, k, machine.chain.damping());
      EXPECT_LE(solve_two_ends(machine, cycles(200, 10)).pieces, most) << contacts << ", " << k;
    }
}

} // namespace
