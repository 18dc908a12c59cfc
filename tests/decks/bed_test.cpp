// The bed: made, settled, put under a roller. A small one, with all that the large one has.
#include "engine.h"

#include "chain_csv.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

fs::path bed_deck(const std::string &name) { return fs::path(DRUMLIN_SOURCE_DIR) / "inputs/bed" / name; }

/// 150 balls in a box of 0.6 m and a drum of 0.1 m, 100 kg: settled once for all tests.
class Bed : public ::testing::Test {
protected:
  static void SetUpTestSuite() {
    scratch = std::make_unique<Scratch>();
    const Outcome made =
        run_program({DRUMLIN_TOOLS, "bed", "--balls", "150", "--width", "0.6", "--out", "balls.data"}, {},
                    scratch->path());
    ASSERT_TRUE(made.ok()) << made.output;
    const Outcome settled = run_deck(bed_deck("in.settle"),
                                     {{"balls", "balls.data"}, {"bed", "settled.restart"}}, scratch->path());
    ASSERT_TRUE(settled.ok()) << settled.output;
  }
  static void TearDownTestSuite() { scratch.reset(); }

  static Outcome run(const Scratch &folder, const Variables &more, int ranks = 1) {
    Variables variables = more;
    variables.insert(variables.end(), {{"bed", (scratch->path() / "settled.restart").string()},
                                       {"m2", "100"},
                                       {"m3", "50"},
                                       {"r2", "0.1"},
                                       {"r3", "0.05"},
                                       {"k23", "5e4"},
                                       {"c23", "500"},
                                       {"Fw", "2940"},
                                       {"cycles", "2"}});
    return run_deck(bed_deck("in.bed"), variables, folder.path(), ranks);
  }

  static std::unique_ptr<Scratch> scratch;
};
std::unique_ptr<Scratch> Bed::scratch;

TEST_F(Bed, CarriesTheRollerAtRestAndIsShakenUnderBothTransitions) {
  for (const char *transition : {"A", "B"}) {
    const Scratch folder;
    const Outcome outcome = run(folder, {{"transition", transition}});
    ASSERT_TRUE(outcome.ok()) << outcome.output;
    const post::Table table = post::read_table(folder / "bed.csv");
    ASSERT_EQ(table.rows(), 501u);
    const double weight = 150 * 9.81;
    EXPECT_NEAR(table.numbers("F_contact").front(), weight, 1e-3 * weight);
    EXPECT_EQ(table.numbers("x_drum").front(), 0.0);
    for (const double force : table.numbers("F_contact"))
      ASSERT_TRUE(std::isfinite(force));
  }
}

// The same bed, whatever the number of ranks; a border between ranks lies under the drum.
TEST_F(Bed, GoesTheSameWayOnTwoRanks) {
  const Scratch one, two;
  const Variables variables = {{"cycles", "1"}, {"sink", "0"}, {"settle_limit", "400000"}};
  const Outcome serial = run(one, variables), parallel = run(two, variables, 2);
  ASSERT_TRUE(serial.ok()) << serial.output;
  ASSERT_TRUE(parallel.ok()) << parallel.output;
  EXPECT_TRUE(parallel.says("2 by 1 by 1 MPI processor grid")) << parallel.output;
  const std::vector<double> a = post::read_table(one / "bed.csv").numbers("x_drum");
  const std::vector<double> b = post::read_table(two / "bed.csv").numbers("x_drum");
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size() && i <= 100; ++i) // 1000 steps
    EXPECT_NEAR(a[i], b[i], 1e-10) << "row " << i;
}

TEST_F(Bed, GoesTheSameWayTwice) {
  const Scratch first, second;
  ASSERT_TRUE(run(first, {{"cycles", "1"}}).ok());
  ASSERT_TRUE(run(second, {{"cycles", "1"}}).ok());
  EXPECT_EQ(read_text(first / "bed.csv"), read_text(second / "bed.csv"));
}

} // namespace
} // namespace drumlin::test
