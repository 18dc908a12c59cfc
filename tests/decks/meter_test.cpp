// Meter values of the chain in the engine: from the sums over every step, against those of the exact
// solution.
#include "tests/support/engine_runs.h"

#include "meter/values.h"

#include <gtest/gtest.h>

#include <cmath>

namespace drumlin::test {
namespace {

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

} // namespace
} // namespace drumlin::test
