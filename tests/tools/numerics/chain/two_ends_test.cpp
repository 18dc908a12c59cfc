// The exact solution with two ends, standing and driving.
#include "tests/support/chain_by_cvode.h"
#include "tests/support/chain_record.h"
#include "tests/support/two_ends_energy.h"
#include "tests/support/two_ends_oracle.h"
#include "chain/driven_way.h"
#include "chain/exact_solution.h"
#include "chain/two_ends.h"
#include "files/roller.h"

#include <Eigen/Dense>

namespace drumlin::test {
namespace {

using namespace drumlin::post;

// The drum with two ends: against the chain where it cannot tilt, against closed forms and complex algebra in
// unbroken contact, and against CVODE where its ends lose contact.
namespace standing {

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

} // namespace standing

// A drum with two ends that drives over soil whose halves differ along the way: against the machine that
// stands, the chain that drives, CVODE, and the energy balance with the work of the drive.
namespace driving {

using drumlin::Way, drumlin::WayRow;
using drumlin::test::largest, drumlin::test::relative, drumlin::test::TwoEndsEnergy,
    drumlin::test::TwoEndsOracle;

constexpr double width = 2.13;

// A machine with unequal bonds that tilts, on a number of contacts; their k and c follow from the way.
TwoEnds axas(Transition transition, int contacts) {
  const drumlin::Roller roller = drumlin::read_roller(DRUMLIN_SOURCE_DIR "/inputs/rollers/Axas2020");
  ChainParameters chain;
  chain.transition = transition;
  set_machine(chain, roller, roller.settings.front());
  TwoEnds machine = two_ends(chain, roller);
  machine.contacts = equal_contacts(contacts, width, 1.0, 0.0);
  return machine;
}

ExactOptions driven(const ChainParameters &p, const Way &way, double speed, int passes = 1,
                    WayBack back = WayBack::in_reverse) {
  ExactOptions options;
  options.way = drive(way, speed, passes, back);
  options.cycles = options.way.back().end / p.period();
  return options;
}

TEST(DrivenEnds, TheSidesChangeWhereTheRollerTurnsRound) {
  const Way way = {{2.0, 1e7, 0.1, 4e6}, {3.0, 2e7, 0.1, 4e6}, {3.0, 5e7, 0.3, 3e7}, {6.0, 5e7, 0.3, 3e7}};
  const std::array<double, 6> reverse = {4e6, 3e7, 3e7, 4e6, 4e6, 3e7},
                              turned = {4e6, 3e7, 2e7, 16e6, 4e6, 3e7},
                              reverse_rate = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0},
                              turned_rate = {0.0, 0.0, 0.0, -2e7, 0.0, 0.0};
  for (const WayBack back : {WayBack::in_reverse, WayBack::turned_round}) {
    const bool turns = back == WayBack::turned_round;
    const std::vector<WaySection> sections = drive(way, 2.0, 3, back);
    ASSERT_EQ(sections.size(), 6U);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_DOUBLE_EQ(sections[i].k_left, (turns ? turned : reverse)[i]);
      EXPECT_DOUBLE_EQ(sections[i].k_left_rate, (turns ? turned_rate : reverse_rate)[i]);
    }
  }
}

// Rows of the same soil, with halves as 3 to 2: the machine that stands on contacts with these k and c.
TEST(DrivenEnds, UniformSoilIsThatOfTheMachineThatStands) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (const int contacts : {1, 2, 5}) {
      TwoEnds standing = axas(transition, contacts);
      const double k = 4e7, D = 0.2, c = 2.0 * D * std::sqrt(standing.chain.m2 * k);
      const Way way = {{1e4, k, D, 0.6 * k}, {1e4 + 0.37, k, D, 0.6 * k}, {1e4 + 1.0, k, D, 0.6 * k}};
      const ExactOptions moving = driven(standing.chain, way, 1.0 / (9.7 * standing.chain.period()), 2);
      ExactOptions still = moving;
      still.way.clear();
      const TwoEndsResult a = solve_two_ends(standing, moving);
      for (AxleLink &contact : standing.contacts) {
        const double share = (contact.y == 0.0 ? 1.0 : contact.y < 0.0 ? 1.2 : 0.8) / contacts;
        contact.k = share * k;
        contact.c = share * c;
      }
      const TwoEndsResult b = solve_two_ends(standing, still);
      for (const HistoryColumn &column : history_columns)
        if (column.group != ColumnGroup::way && (contacts > 1 || column.derivative != tilt_column)) {
          EXPECT_LT(relative(a.history.*column.values, b.history.*column.values), 1e-9) << column.name;
        }
      EXPECT_EQ(a.events.size(), b.events.size());
      EXPECT_GT(a.events.size(), 10U);
      ASSERT_EQ(a.cycles.size(), b.cycles.size());
      for (std::size_t i = 0; i < a.cycles.size(); ++i)
        EXPECT_NEAR(a.cycles[i].F_contact_max, b.cycles[i].F_contact_max, 1e-9 * b.cycles[i].F_contact_max);
      EXPECT_EQ(a.history.pass.back(), 2.0);
      EXPECT_NEAR(a.history.s.back(), 1e4, 0.001);
    }
}

// Equal halves on equal bonds: the chain that drives, over steps in closed form, over ramps by CVODE.
TEST(DrivenEnds, EqualHalvesAreTheChainThatDrives) {
  const Way steps = {{0.0, 3e7, 0.4},  {0.31, 3e7, 0.4}, {0.31, 6e7, 0.3}, {0.61, 6e7, 0.3},
                     {0.61, 1e7, 0.2}, {0.83, 1e7, 0.2}, {0.83, 5e7, 0.5}, {1.2, 5e7, 0.5}};
  const Way ramps = {{0.0, 3e7, 0.4}, {0.5, 6e7, 0.3}, {0.5, 4e7, 0.3}, {0.7, 1e7, 0.0}, {1.2, 5e7, 0.5}};
  for (const char *name : {"II", "III"})
    for (const Transition transition : {Transition::A, Transition::B})
      for (const int contacts : {1, 2, 3, 8})
        for (const Way &way : {std::cref(steps), std::cref(ramps)}) {
          const ChainParameters chain = table1_case(name, transition);
          TwoEnds machine = two_ends(chain, drumlin::Roller());
          machine.contacts = equal_contacts(contacts, width, 1.0, 0.0);
          const ExactOptions options = driven(chain, way, 1.93, 2);
          const bool closed = &way == &steps;
          const ExactSolution single =
              closed ? solve_chain(chain, options) : drumlin::test::solve_by_cvode(chain, options);
          const TwoEndsResult halves = solve_two_ends(machine, options);
          for (const HistoryColumn &column : history_columns)
            if (column.group != ColumnGroup::ends) {
              EXPECT_LT(relative(halves.history.*column.values, single.history.*column.values),
                        closed ? 1e-12 : 1e-8)
                  << column.name << contacts << name << transition_name(transition);
            }
          EXPECT_EQ(halves.events.size(), single.events.size() * static_cast<std::size_t>(contacts));
          EXPECT_EQ(largest(halves.history.theta_drum), 0.0);
          ASSERT_EQ(halves.cycles.size(), single.cycles.size());
          for (std::size_t i = 0; i < single.cycles.size(); ++i)
            EXPECT_NEAR(halves.cycles[i].F_contact_max, single.cycles[i].F_contact_max,
                        (closed ? 1e-12 : 1e-7) * largest(single.history.F_contact));
        }
}

// Under B a step can turn the force into a tension, which ends the contact there and then, or an overlap
// without force into a contact that begins with the force of the law: events as of the chain that drives.
TEST(DrivenEnds, AStepCanEndAContactOrBeginOne) {
  ChainParameters p = table1_case("III", Transition::B);
  p.k = 3e7;
  for (const bool ends : {true, false}) {
    p.D = ends ? 0.05 : 0.9;
    const double behind = ends ? 0.9 : 0.05;
    const auto pushes = [&p](double D, double x, double v) {
      return -p.k * x - 2.0 * D * std::sqrt(p.m2 * p.k) * v > 0.0;
    };
    const ChainHistory standing = solve_chain(p, 10, 1000).history;
    std::size_t row = 5000;
    while (!(standing.x_drum.at(row) < 0.0 &&
             pushes(p.D, standing.x_drum[row], standing.v_drum[row]) == ends &&
             pushes(behind, standing.x_drum[row], standing.v_drum[row]) != ends))
      ++row;
    const double place = standing.time[row]; // at 1 m/s
    const ExactOptions options = driven(
        p, {{0.0, p.k, p.D}, {place, p.k, p.D}, {place, p.k, behind}, {place + 0.1, p.k, behind}}, 1.0);
    TwoEnds machine = two_ends(p, drumlin::Roller());
    machine.contacts = equal_contacts(2, width, 1.0, 0.0);
    const ExactSolution single = solve_chain(p, options);
    const TwoEndsResult halves = solve_two_ends(machine, options);
    ASSERT_EQ(halves.events.size(), 2 * single.events.size());
    bool at_step = false;
    for (std::size_t i = 0; i < halves.events.size(); ++i) {
      const ContactEvent &all = single.events[i / 2], &one = halves.events[i];
      EXPECT_EQ(one.make, all.make);
      EXPECT_NEAR(one.time, all.time, 1e-12);
      EXPECT_NEAR(2.0 * one.force, all.force, 1e-9 * largest(single.history.F_contact));
      at_step = at_step || (std::fabs(one.time - place) < 1e-9 && one.make != ends && one.force > 0.0);
    }
    EXPECT_TRUE(at_step);
  }
}

// ---- against CVODE ----

// The soil of a way as the oracle meets it: row by row, each with the halves below the ends of the drum.
struct Met {
  double begin = 0.0, end = 0.0; // s
  WayRow from, to;
  bool swapped = false;

  AxleLink contact(double y, int contacts, double m2, double time) const {
    const double share = std::min(1.0, (time - begin) / (end - begin)); // a last row may lie behind the way
    const auto between = [share](double a, double b) { return a + share * (b - a); };
    double left = between(from.k_left, to.k_left), right = between(from.k_right(), to.k_right());
    const double c = 2.0 * between(from.D, to.D) * std::sqrt(m2 * (left + right)), whole = left + right;
    if (swapped) std::swap(left, right);
    const double k = (y < 0.0 ? 2.0 * left : y > 0.0 ? 2.0 * right : whole) / contacts;
    return {y, k, c * k / whole};
  }
};

std::vector<Met> met(const Way &way, double speed, int passes, bool turns) {
  std::vector<Met> all;
  double time = 0.0;
  for (int pass = 0; pass < passes; ++pass) {
    Way rows = way;
    if (pass % 2 == 1) std::reverse(rows.begin(), rows.end());
    for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
      const double duration = std::fabs(rows[i + 1].s - rows[i].s) / speed;
      if (duration == 0.0) continue;
      all.push_back({time, time + duration, rows[i], rows[i + 1], turns && pass % 2 == 1});
      time += duration;
    }
  }
  return all;
}

TEST(DrivenEnds, StepsAndRampsFollowCvode) {
  std::mt19937_64 random(45);
  const auto between = [&random](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  int compared = 0;
  double worst = 0.0;
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    const std::array<int, 4> counts = {2, 3, 4, 8};
    const int contacts = counts[static_cast<std::size_t>(trial / 2) % counts.size()];
    TwoEnds machine = axas(trial % 2 == 0 ? Transition::A : Transition::B, contacts);
    machine.exciter = between(-0.1, 0.1);
    const bool ramps = trial % 4 < 2, turns = trial % 3 == 0;
    const auto soil = [&](double s) -> WayRow {
      const double k = std::exp(between(std::log(1.5e7), std::log(6e7)));
      return {s, k, between(0.1, 0.5), k * between(0.3, 0.7)};
    };
    Way way = {soil(3.0)};
    while (way.size() < 8) {
      const double s = way.back().s + between(0.02, 0.2);
      if (ramps && way.size() % 3 != 0) {
        way.push_back(soil(s));
      } else {
        way.push_back(way.back());
        way.back().s = s;
        way.push_back(soil(s));
      }
    }
    way.push_back(soil(way.back().s + 0.1));
    const double speed = between(1.0, 3.0);
    const ChainParameters &p = machine.chain;
    const ExactOptions options =
        driven(p, way, speed, 2, turns ? WayBack::turned_round : WayBack::in_reverse);
    const TwoEndsResult exact = solve_two_ends(machine, options);
    ExactOptions near = options;
    for (WaySection &section : near.way)
      section.k *= 1.0 + 1e-9; // a neighbour, which shows how much the motion multiplies errors
    const TwoEndsResult moved = solve_two_ends(machine, near);
    const double growth = relative(moved.history.v_drum, exact.history.v_drum) / 1e-9;
    if (growth > 100.0) continue;
    ++compared;

    const std::vector<Met> soils = met(way, speed, 2, turns);
    const auto at = [&](std::size_t n) {
      return [&, n](std::size_t j, double time) {
        return soils[n].contact(machine.contacts[j].y, contacts, p.m2, time);
      };
    };
    const TwoEndsState start = TwoEndsSolver(over(machine, options.way.front())).start().state;
    TwoEndsOracle oracle(machine, start, at(0));
    std::size_t now = 0;
    std::vector<double> z, theta, rate, force;
    for (const double time : exact.history.time) {
      while (now + 1 < soils.size() && soils[now].end <= time) {
        oracle.at(soils[now].end);
        oracle.meet(at(++now));
      }
      const auto &y = oracle.at(time);
      z.push_back(y[0]);
      theta.push_back(y[2]);
      rate.push_back(y[4]);
      force.push_back(p.m2 * oracle.rates()[4] + p.m3 * oracle.rates()[5] + (p.m2 + p.m3) * p.g +
                      p.Fw * std::sin(p.omega * time));
    }
    const double apart = std::max({relative(exact.history.x_drum, z), relative(exact.history.v_drum, rate),
                                   relative(exact.history.theta_drum, theta)});
    worst = std::max(worst, apart);
    EXPECT_LT(apart, 1e-8) << "growth " << growth;
    EXPECT_LT(relative(exact.history.F_contact, force), 1e-7);
    EXPECT_EQ(std::count_if(exact.events.begin(), exact.events.end(),
                            [](const ContactEvent &event) { return event.make; }),
              oracle.makes());
    EXPECT_TRUE(oracle.left_lost() || oracle.right_lost());
  }
  RecordProperty("compared", compared);
  RecordProperty("largest_difference_1e_12", static_cast<int>(worst * 1e12));
  EXPECT_GE(compared, 20);
}

// Rows that say nothing new divide a ramp into pieces of other lengths.
TEST(DrivenEnds, MoreRowsOfTheSameRampChangeNothing) {
  const Way way = {{0.0, 2e7, 0.5, 1.2e7}, {0.5, 6e7, 0.1, 2e7}, {0.52, 1e7, 0.3, 8e6}, {0.8, 5e7, 0.2, 3e7}};
  Way more;
  for (std::size_t i = 0; i + 1 < way.size(); ++i)
    for (int part = 0; part < 7; ++part) {
      const double share = part / 7.0;
      const auto mix = [share](double a, double b) { return a + share * (b - a); };
      more.push_back({mix(way[i].s, way[i + 1].s), mix(way[i].k, way[i + 1].k), mix(way[i].D, way[i + 1].D),
                      mix(way[i].k_left, way[i + 1].k_left)});
    }
  more.push_back(way.back());
  for (const Transition transition : {Transition::A, Transition::B}) {
    const TwoEnds machine = axas(transition, 4);
    const TwoEndsResult few = solve_two_ends(machine, driven(machine.chain, way, 1.3, 2));
    const TwoEndsResult many = solve_two_ends(machine, driven(machine.chain, more, 1.3, 2));
    for (const HistoryColumn &column : history_columns)
      EXPECT_LT(relative(many.history.*column.values, few.history.*column.values), 1e-11) << column.name;
    EXPECT_EQ(many.events.size(), few.events.size());
  }
}

// ---- energy ----

TEST(DrivenEnds, SoilThatStiffensTakesWorkOfTheDrive) {
  const Way way = {{0.0, 2e7, 0.2, 8e6}, {0.6, 6e7, 0.2, 4e7}, {0.6, 3e7, 0.2, 1e7}, {1.1, 3e7, 0.2, 2.2e7}};
  for (const Transition transition : {Transition::A, Transition::B})
    for (const int contacts : {2, 5}) {
      const TwoEnds machine = axas(transition, contacts);
      const std::vector<WaySection> sections = drive(way, 1.5, 1);
      TwoEndsSolver solver(over(machine, sections.front()));
      TwoEndsMotion motion = solver.start();
      TwoEndsEnergy energy(solver.machine());
      const double before = energy.stored(motion.state);
      const double period = machine.chain.period();
      for (std::size_t n = 0; n < sections.size(); ++n) {
        const double end = sections[n].end;
        while ((static_cast<double>(motion.cycle) + 1.0) * period < end) {
          solver.finish_cycle(motion, &energy);
          energy.start = static_cast<double>(motion.cycle) * period;
        }
        solver.go_to(end - static_cast<double>(motion.cycle) * period, motion, &energy);
        if (n + 1 == sections.size()) break;
        const double left = energy.stored(motion.state, end);
        solver.drive_over(sections[n + 1], motion);
        energy.drive += energy.stored(motion.state, end) - left;
      }
      const double after = energy.stored(motion.state, sections.back().end);
      EXPECT_NEAR(after - before + energy.dissipated, energy.work + energy.drive, 1e-8 * energy.turned);
      EXPECT_GT(std::fabs(energy.drive), 1e-4 * energy.turned);
    }
}

} // namespace driving

} // namespace
} // namespace drumlin::test
