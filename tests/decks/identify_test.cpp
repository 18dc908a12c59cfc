// Stiffness and damping found from runs of the engine at the decks' default steps.
#include "identify/identified_record.h"
#include "tests/support/chain_record.h"
#include "tests/support/engine_runs.h"

#include <gtest/gtest.h>

namespace drumlin::test {
namespace {

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

} // namespace
} // namespace drumlin::test
