// Boundaries of regimes that are computed in closed form and from orbits, against runs of the chain in the
// engine on both sides of them, as near as the error of these runs permits.
#include "map/orbits.h"
#include "tests/support/engine_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

using namespace post;

// A run with the deck's default step, 2000 per cycle.
struct Run {
  ChainHistory history; ///< one sample per cycle
  CycleColumns cycles;
  std::vector<ContactEvent> events;
};

Run run(const ChainParameters &p, int cycles) {
  const Scratch scratch;
  const Outcome outcome = run_deck(chain_deck("in.chain"),
                                   {{"case", "II"},
                                    {"k", number(p.k)},
                                    {"D", number(p.D)},
                                    {"cycles", std::to_string(cycles)},
                                    {"samples_per_cycle", "1"},
                                    {"out", (scratch / "run").string()}},
                                   scratch.path());
  if (!outcome.ok()) throw std::runtime_error("in.chain failed:\n" + outcome.output);
  return {read_chain(scratch / "run/chain.csv"), read_cycle_columns(scratch / "run/cycles.csv"),
          read_events(scratch / "run/events.csv")};
}

ChainParameters chain(double k, double D) {
  ChainParameters p = table1_case("II", Transition::B);
  p.k = k;
  p.D = D;
  return p;
}

TEST(BoundariesOfDecks, ContactIsLostWhereItIsInClosedForm) {
  constexpr int cycles = 80; // until the frame has come to its steady motion
  const ChainFamily family = [](double k) { return chain(k, 0.5); };
  const auto onset = locate_contact_loss(family, 3e6, 20e6);
  ASSERT_TRUE(onset);
  // The error of the engine is that of the least force in the last cycle, as the relative change of k that
  // causes it.
  const double below = 0.99;
  const double exact = contact_margin(family(below * onset->value));
  const double error =
      std::fabs(run(family(below * onset->value), cycles).cycles.at("F_contact_min").back() - exact) /
      (exact / (1.0 - below));
  EXPECT_LT(error, 1e-5);
  for (const double side : {-1.0, 1.0}) {
    const ChainParameters p = family(onset->value * (1.0 + side * std::max(4.0 * error, 1e-6)));
    const std::vector<ContactEvent> events = run(p, cycles).events;
    const auto late = std::count_if(events.begin(), events.end(), [&](const ContactEvent &event) {
      return !event.make && event.time > (cycles - 10) * p.period();
    });
    EXPECT_EQ(late, side > 0.0 ? 10 : 0) << side << ", error " << error;
  }
}

// The ratio of successive changes of v_drum at the start of a cycle is the multiplier of the orbit that they
// die away to; beyond the boundary they persist.
TEST(BoundariesOfDecks, ThePeriodDoublesWhereAMultiplierPassesMinusOne) {
  const ChainFamily family = [](double k) { return chain(k, 0.1); };
  constexpr double from = 15e6;
  const ChainSolver solver(family(from));
  ChainMotion motion = solver.start();
  for (int cycle = 0; cycle < 400; ++cycle)
    solver.finish_cycle(motion);
  const auto start = find_orbit(solver, motion.state, 1);
  ASSERT_TRUE(start);
  const auto doubling = locate_doubling(family, from, 25e6, *start);
  ASSERT_TRUE(doubling);
  constexpr std::size_t cycles = 200;
  const auto changes = [&](double k) {
    const std::vector<double> v = run(family(k), cycles).history.v_drum;
    return std::vector<double>{v[cycles - 2] - v[cycles - 3], v[cycles - 1] - v[cycles - 2],
                               v[cycles] - v[cycles - 1]};
  };
  const double below = 0.95 * doubling->value;
  const std::vector<double> dying = changes(below);
  EXPECT_NEAR(dying[2] / dying[1],
              continue_orbit(family, from, below, 8, *start).back().orbit.multipliers[0].real(),
              3e-4); // 4e-4 of k
  const std::vector<double> lasting = changes(1.02 * doubling->value);
  EXPECT_NEAR(lasting[2] / lasting[1], -1.0, 1e-3);
  EXPECT_GT(std::fabs(lasting[2]), 100.0 * std::fabs(dying[2]));
}

} // namespace
} // namespace drumlin::test
