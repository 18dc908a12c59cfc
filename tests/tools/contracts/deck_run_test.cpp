// Which failures of a run are its scene's, and which may pass.
#include "engine/deck_run.h"

#include "bed/packing.h"
#include "support/files.h"
#include "tests/support/engine_runs.h"

#include <gtest/gtest.h>

#include <csignal>
#include <stdexcept>
#include <string>

#include <sys/resource.h>

namespace drumlin::test {
namespace {

class FaultsOfRuns : public ::testing::Test {
protected:
  FaultsOfRuns() {
    post::PackingOptions packing;
    packing.balls = 60;
    packing.width = 0.4;
    post::write_files(
        {{scratch_ / "balls.data", post::bed_data(packing, 2650.0, post::pack_balls(packing))}});
  }
  /// "scene: WHY" or "may pass: WHY" of in.settle with some other variables.
  std::string fault(Variables variables, double limit = 600.0) const {
    variables.insert(variables.end(), {{"case", "loose"},
                                       {"balls", (scratch_ / "balls.data").string()},
                                       {"bed", (scratch_ / "soil").string()}});
    try {
      const post::DeckRun run("bed/in.settle", variables, 1, limit);
      run.must_succeed();
    } catch (const post::SceneFault &fault) {
      return std::string("scene: ") + fault.what();
    } catch (const std::runtime_error &fault) {
      return std::string("may pass: ") + fault.what();
    }
    return "none";
  }

  Scratch scratch_;
};

TEST_F(FaultsOfRuns, AreTheScenesWhereTheEngineSaysSo) {
  EXPECT_EQ(fault({{"settle_limit", "1000"}})
                .rfind("scene: bed/in.settle: ERROR: drumlin/settle: unbalanced ratio is ", 0),
            0U)
      << fault({{"settle_limit", "1000"}});
}

TEST_F(FaultsOfRuns, MayPassWhereTheMachineIsAtFault) {
  const std::string slow = fault({}, 1e-3), missing = fault({{"balls", "none"}});
  EXPECT_EQ(slow, "may pass: bed/in.settle: was stopped at its time limit");
  EXPECT_EQ(missing.rfind("may pass: bed/in.settle: ERROR: ", 0), 0U) << missing;
  // A limit on the size of files stands for a full disk.
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  for (const rlim_t size : {100U, 2000U, 9000U}) {
    rlimit limit = before;
    limit.rlim_cur = size;
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
    const std::string full = fault({});
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    EXPECT_EQ(full.rfind("may pass: ", 0), 0U) << full;
  }
  ::signal(SIGXFSZ, handler);
}

} // namespace
} // namespace drumlin::test
