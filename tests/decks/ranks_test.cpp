// The chain on several ranks must be the chain on one, with the contact's two balls on different ranks.
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include <gtest/gtest.h>

#include <ostream>
#include <string>

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

} // namespace
} // namespace drumlin::test
