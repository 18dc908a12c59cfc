// What the tools find in runs of the decks: meter values, stiffness and damping, boundaries of regimes.
#include "tests/support/chain_record.h"
#include "tests/support/engine_runs.h"

#include "identify/identified_record.h"
#include "map/orbits.h"
#include "meter/values.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

// Meter values of the chain in the engine: from the sums over every step, against those of the exact
// solution.
namespace meter {

TEST(MeterOfDecks, CmvFromEveryStep) {
  struct Known {
    const char *name;
    double cmv; // reference value, from Fourier integrals over each phase of the exact solution
  };
  for (const Known &known : {Known{"II", 155.948}, Known{"III", 105.730}, Known{"IV", 247.175}}) {
    const Scratch scratch;
    const Outcome outcome = run_deck(
        chain_deck("in.chain"),
        {{"case", known.name}, {"cycles", "120"}, {"out", (scratch / "run").string()}}, scratch.path());
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    for (const char *name : {"run", "run/cycles.csv"}) {
      const post::MeterRecord record = post::meter_cycles(post::read_record(scratch / name));
      EXPECT_EQ(record.source, post::HarmonicSource::every_step);
      EXPECT_EQ(record.cycles.size(), 120U);
      const post::MeterWindow window = post::meter_windows(record, {}).back();
      EXPECT_NEAR(*window.cmv / known.cmv, 1.0, 1e-3) << known.name;
      EXPECT_EQ(window.mode, post::OperatingMode::partial_uplift);
      EXPECT_LT(*window.rmv, 0.01);
      EXPECT_GT(*window.energy, 0.0);
    }
    // The samples alone, 200 per cycle, are within their own bound.
    const post::MeterWindow sampled =
        post::meter_windows(post::meter_cycles(post::read_record(scratch / "run/chain.csv")), {}).back();
    EXPECT_LT(std::abs(*sampled.cmv - known.cmv), sampled.cmv_bound) << known.name;
  }
}

} // namespace meter

// Stiffness and damping found from runs of the engine at the decks' default steps.
namespace identify {

TEST(Identify, EightChainRuns) {
  for (const char *name : post::table1_cases)
    for (const post::Transition transition : {post::Transition::A, post::Transition::B}) {
      SCOPED_TRACE(std::string(name) + post::transition_name(transition));
      const post::ChainParameters p = post::table1_case(name, transition);
      const ChainRun run = run_chain(name, transition, 2000, 200, {{"stepping", "second"}});
      const post::Record record = record_of(p, run.history);
      for (const bool accelerations_only : {false, true}) {
        post::RecordSetting setting;
        setting.accelerations_only = accelerations_only;
        const post::LawEstimate law = post::identify_record(record, setting).whole.law;
        EXPECT_NEAR(law.k.mean, p.k, 1e-3 * p.k);
        EXPECT_NEAR(law.c.mean, p.damping(), 3e-3 * p.damping());
        EXPECT_NEAR(law.D.mean, p.D, 3e-3 * p.D);
      }
    }
}

} // namespace identify

// Boundaries of regimes that are computed in closed form and from orbits, against runs of the chain in the
// engine on both sides of them, as near as the error of these runs permits.
namespace boundaries {

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

} // namespace boundaries

} // namespace
} // namespace drumlin::test
