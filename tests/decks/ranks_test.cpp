// The chain on several ranks must be the chain on one, with the contact's two balls on different ranks.
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include "bed/dump_readers.h"
#include "engine/deck_run.h"

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

/// Layer of a height between `bottom` and 4.
int rank_of(double height, double bottom, int ranks) {
  return static_cast<int>((height - bottom) / (4 - bottom) * ranks);
}

struct Layout {
  int ranks;
  double bottom;
};

void expect_agreement(const std::string &name, const std::string &stepping, const std::string &c23,
                      const Layout &layout) {
  // Soil at -0.5, drum at 0.75, frame at 2.
  ASSERT_NE(rank_of(-0.5, layout.bottom, layout.ranks), rank_of(0.75, layout.bottom, layout.ranks));
  const Variables variables = {{"case", name}, {"transition", "B"}, {"stepping", stepping},
                               {"c23", c23},   {"cycles", "10"},    {"steps_per_cycle", "400"}};
  const Scratch one, many;
  well(run_deck(chain_deck("in.chain"), variables, one.path()));
  EXPECT_TRUE(printed(well(run_deck(chain_with_bottom(many.path(), layout.bottom) / "in.chain", variables,
                                    many.path(), layout.ranks)),
                      "1 by 1 by " + std::to_string(layout.ranks) + " MPI processor grid"));
  EXPECT_EQ(post::read_parameters(many / "parameters.csv").at("ranks"), std::to_string(layout.ranks));

  for (const char *file : {"chain.csv", "cycles.csv", "events.csv"}) {
    const post::Table a = post::read_table(many / file), b = post::read_table(one / file);
    ASSERT_EQ(a.header(), b.header());
    ASSERT_EQ(a.rows(), b.rows()) << file;
    EXPECT_GT(a.rows(), 10u) << file;
    for (const std::string &column : b.header()) {
      if (column == "event")
        EXPECT_EQ(a.text(column), b.text(column));
      else
        EXPECT_LE(relative_difference(a.numbers(column), b.numbers(column)), 1e-12) << file << ", " << column;
    }
  }
}

void PrintTo(const Layout &value, std::ostream *out) { *out << value.ranks; }

class Ranks : public ::testing::TestWithParam<Layout> {};

TEST_P(Ranks, AgreeWithOne) {
  for (const char *stepping : {"second", "stock"}) {
    expect_agreement("II", stepping, "1e4", GetParam());
    expect_agreement("IV", stepping, "1e4", GetParam());
  }
  expect_agreement("IV", "second", "1e7", GetParam()); // solved for together with the contact
}

// 2 ranks: cut at 0.25, soil | drum, frame. 3: cuts at 1/3 and 2.17, the same in the deck's own box. 4: cuts
// at -0.125, 1.25, 2.625: each ball on a rank of its own, and a rank without any.
const Layout layouts[] = {{2, -3.5}, {3, -1.5}, {4, -1.5}};
INSTANTIATE_TEST_SUITE_P(Layers, Ranks, ::testing::ValuesIn(layouts),
                         [](const auto &test) { return std::to_string(test.param.ranks); });

// A bed below a drum in the middle of the box, on a border of two ranks, and aside, where a rank has no ball.
// It is one row of balls: the motion of more is chaotic, so that rounding grows to the size of a radius.
TEST(BedOnRanks, HasEveryBallWhereItIsOnOne) {
  constexpr double radius = 0.02; // m, the deck's default
  for (const char *centre : {"0", "0.8"}) {
    std::vector<post::TextDump> one;
    for (const int ranks : {1, 2}) {
      const Scratch scratch;
      well(run_deck(
          post::input_file("study/in.small_bed"),
          {{"rows", "1"}, {"drum_mass", "100"}, {"settling", "6000"}, {"centre", centre}, {"out", "out"}},
          scratch.path(), ranks));
      const post::TextDump last = post::read_text_dumps(scratch / "out/last.dump").back();
      if (ranks == 1) {
        one = {last};
        continue;
      }
      ASSERT_EQ(last.rows.size(), one.front().rows.size());
      for (std::size_t i = 0; i < last.rows.size(); ++i)
        for (const char *column : {"id", "x", "z"})
          EXPECT_NEAR(last.rows[i][last.column(column)], one.front().rows[i][last.column(column)],
                      1e-3 * radius)
              << column;
    }
  }
}

} // namespace
} // namespace drumlin::test
