// Maps of meter values: means, gains and coverage of maps whose values follow by hand.
#include "passes/meter_map.h"
#include "tests/support/checks.h"
#include "tests/support/lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

using namespace drumlin::post;

constexpr double cell = 0.34;

/// Cells in a row, and their values pass by pass; NaN: none.
MeterMap row_of_cells(const std::vector<std::vector<double>> &passes) {
  MeterMap map;
  map.cell = cell;
  for (std::size_t i = 0; i < passes.front().size(); ++i)
    map.places.push_back({0, cell * (static_cast<double>(i) + 0.5)});
  for (std::size_t pass = 0; pass < passes.size(); ++pass)
    for (std::size_t i = 0; i < passes[pass].size(); ++i)
      if (!std::isnan(passes[pass][i]))
        map.values.push_back({static_cast<int>(pass) + 1, i, passes[pass][i]});
  return map;
}

TEST(MeterMap, CountsCellsAsRulesOfAcceptanceDo) {
  const MeterMap map = row_of_cells({{10, 20, 30, NAN}, {20, 20, 40, 20}, {22, 21, NAN, 17}});
  AcceptanceRule rule;
  rule.target = 20.0;
  const std::vector<PassCells> rows = cells_of_passes(map, rule);
  ASSERT_EQ(rows.size(), 4u); // three passes, and the last value of each cell: 22, 21, 40, 17
  EXPECT_EQ(rows[0].cells, 3u);
  EXPECT_DOUBLE_EQ(rows[0].mean, 20.0);
  EXPECT_DOUBLE_EQ(rows[0].deviation, 10.0);
  EXPECT_DOUBLE_EQ(rows[0].variation(), 0.5);
  EXPECT_FALSE(rows[0].gain);
  EXPECT_NEAR(*rows[0].coverage, 2.0 / 3.0, 1e-15);
  EXPECT_DOUBLE_EQ(rows[1].mean, 25.0);
  EXPECT_NEAR(*rows[1].gain, 80.0 / 60.0 - 1.0, 1e-15); // of the three cells that both passes have
  EXPECT_DOUBLE_EQ(*rows[1].coverage, 1.0);             // a value at the target counts
  EXPECT_NEAR(*rows[2].gain, 60.0 / 60.0 - 1.0, 1e-15);
  EXPECT_DOUBLE_EQ(rows[3].mean, 25.0);
  EXPECT_NEAR(rows[3].deviation, std::sqrt((9.0 + 16.0 + 225.0 + 64.0) / 3.0), 1e-12);
  EXPECT_DOUBLE_EQ(*rows[3].coverage, 0.75);
  EXPECT_EQ(passes_until_gain(rows, rule), 2);
  rule.gain = 0.5;
  EXPECT_EQ(passes_until_gain(rows, rule), 1);
  EXPECT_EQ(passes_until_gain(cells_of_passes(row_of_cells({{10}, {11}}), {}), {}), std::nullopt);
  EXPECT_TRUE(contains(answer_of(map, rows, rule), {"CMV of the last pass is 25 in the mean of 4 cells",
                                                    "75 % of the cells are at or above 20"}));
  EXPECT_FALSE(cells_of_passes(map, {}).front().coverage);
  EXPECT_TRUE(
      contains(answer_of(map, cells_of_passes(map, {}), {}), {"without a target", "nothing is judged"}));
}

// Five cells of 0.34 m in two passes. The middles of the second and third lie on the spot; the fourth
// overlaps it and counts neither as on it nor as beside it. On the spot CMV is lower by 11 in the first bed
// and by 13 in the second, in the mean by 12 with a 95 % interval of +- 12.7.
TEST(MeterMap, TellsCellsOnASpotFromThoseBeside) {
  MeterMap map = row_of_cells({{30, 18, 16, 1, 28}, {32, 20, 22, 1, 30}});
  map.meter = "CMV";
  map.spots = {{0.34, 1.1}};
  EXPECT_EQ(answers_on_spots(map),
            std::vector<std::string>{"On the spot from 0.34 to 1.1 m, over all passes, CMV is 19, beside it "
                                     "30: a difference of -11 (one bed, which is one sample)."});
  const MeterMap other = row_of_cells({{31, 18, 18, 2, 31}, {31, 18, 18, 2, 31}});
  for (const MapPlace &place : other.places)
    map.places.push_back({1, place.along});
  for (const MapValue &one : other.values)
    map.values.push_back({one.pass, one.place + 5, one.value});
  EXPECT_TRUE(contains(answers_on_spots(map).front(),
                       {"CMV is 18.5, beside it 30.5: a difference of -12 ± 13 (95 %, over 2 beds: not "
                        "significant)"}));
  map.spots.push_back({1.4, 1.7}); // the last cell is now on a spot, so that only the first lies beside
  ASSERT_EQ(answers_on_spots(map).size(), 2u);
  EXPECT_TRUE(contains(answers_on_spots(map).back(), {"from 1.4 to 1.7 m", "is 30, beside it 31"}));
  map.spots = {{5.0, 6.0}};
  EXPECT_TRUE(answers_on_spots(map).empty());
}

} // namespace
} // namespace drumlin::test
