// Maps of meter values: means, gains, coverage and semivariograms of maps whose values follow by hand, and
// files of a site that are read or refused.
#include "passes/field_file.h"
#include "passes/meter_map.h"
#include "support/csv.h"
#include "support/files.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"
#include "tests/support/lines.h"
#include "tests/support/page.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;
using namespace drumlin::post;

constexpr double cell = 0.34;

/// Cells in a row, and their values pass by pass; NaN: none.
MeterMap row_of_cells(const std::vector<std::vector<double>> &passes) {
  MeterMap map;
  map.cell = cell;
  for (std::size_t i = 0; i < passes.front().size(); ++i)
    map.places.push_back({0, cell * (static_cast<double>(i) + 0.5), 0.0});
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
    map.places.push_back({1, place.along, 0.0});
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

// Of values that grow evenly by b per cell half the mean square of the differences over n cells is (b n)2/2;
// of values that alternate it is 0 or half the square of their difference.
TEST(MeterMap, SemivariogramFollowsItsDefinition) {
  std::vector<double> growing, alternating;
  for (int i = 0; i < 21; ++i) {
    growing.push_back(3.0 * i);
    alternating.push_back(i % 2 == 0 ? 10.0 : 16.0);
  }
  const std::vector<VariogramRow> slope = semivariogram(row_of_cells({growing}));
  const std::vector<VariogramRow> saw = semivariogram(row_of_cells({alternating}));
  ASSERT_EQ(slope.size(), 10u); // up to half the way
  for (std::size_t i = 0; i < slope.size(); ++i) {
    const auto n = static_cast<double>(i + 1);
    EXPECT_NEAR(slope[i].distance, n * cell, 1e-12);
    EXPECT_EQ(slope[i].pairs, 20 - i);
    EXPECT_NEAR(slope[i].semivariance, 4.5 * n * n, 1e-9);
    EXPECT_NEAR(saw[i].semivariance, i % 2 == 0 ? 18.0 : 0.0, 1e-12);
  }
  EXPECT_TRUE(semivariogram(row_of_cells({{1, 2, 3, 4, 5, 6, 7, 8, 9}})).empty());
  // Two lanes, and two areas, are no neighbours.
  MeterMap two = row_of_cells({growing});
  const std::size_t count = two.places.size();
  for (const double across : {2.0, 0.0})
    for (std::size_t i = 0; i < count; ++i) {
      MapPlace place = two.places[i];
      place.across = across;
      place.area = across > 0.0 ? 0 : 1;
      two.places.push_back(place);
      two.values.push_back({1, two.places.size() - 1, 1e3 * (2.0 + across) + 3.0 * static_cast<double>(i)});
    }
  const std::vector<VariogramRow> same = semivariogram(two);
  ASSERT_EQ(same.size(), slope.size());
  for (std::size_t i = 0; i < same.size(); ++i) {
    EXPECT_EQ(same[i].pairs, 3 * slope[i].pairs);
    EXPECT_NEAR(same[i].semivariance, slope[i].semivariance, 1e-6);
  }
}

// -- Files of a site ----------------------------------------------------------------------------------------

class FieldPasses : public ::testing::Test {
protected:
  Outcome passes(std::vector<std::string> words) const {
    words.insert(words.begin(), {DRUMLIN_TOOLS, "passes", "--field"});
    return run_program(words, {}, folder_);
  }
  void write(const std::string &text) const { write_files({{folder_ / "site.csv", text}}); }
  void refused(const std::string &text, const std::string &says, std::vector<std::string> more = {}) const {
    write(text);
    more.insert(more.begin(), "site.csv");
    const Outcome outcome = passes(more);
    EXPECT_NE(outcome.status, 0) << says;
    EXPECT_TRUE(contains(outcome.output, {says}));
    expect_one_error(outcome.output, "drumlin passes: ");
    EXPECT_FALSE(fs::exists(folder_ / "results"));
  }

  const Scratch scratch_;
  const fs::path folder_ = scratch_.path();
};

/// Two lanes of 12 cells that lead to the north-east in steps of three cells north and two east, in two
/// passes, in feet and miles per hour: what the file's programs write in the United States.
std::string in_feet() {
  std::string text =
      "Time,CellN_FT,CellE_FT,Elevation_FT,PassNumber,lastRadioLtncy,DesignName,Machine,Speed_mph,"
      "ValidPos,LastCMV,LastRMV,LastFreq_Hz,LastAmp_mm,VibeState,LastTemp,_f\r\n";
  const double foot = 0.3048;
  for (const int pass : {1, 2})
    for (int i = 0; i < 12; ++i)
      for (const int lane : {0, 1}) {
        const double north = 1e5 + cell * (3 * i - 2 * lane), east = 2e4 + cell * (2 * i + 3 * lane);
        text +=
            fmt::format("2025/Oct/01 09:30:02.800,{:.4f},{:.4f},{:.4f},{},?,Road,M,5,{},{},?,30,{},{},?\r\n",
                        north / foot, east / foot, (10.0 - 0.02 * pass) / foot, pass,
                        i == 11 && lane == 1 && pass == 2 ? "No" : "Yes", 10 * pass + i, "0.9",
                        i == 0 && lane == 0 && pass == 1 ? "Off" : "On");
      }
  return text;
}

TEST_F(FieldPasses, MakesTablesAndPageFromAFileInFeet) {
  write(in_feet());
  const Outcome outcome = passes({"site.csv", "--target", "26", "--coverage", "45"});
  ASSERT_TRUE(outcome.ok()) << outcome.output;
  EXPECT_TRUE(contains(outcome.output, {"24 cells of 0.34 m", "34 degrees from north to east", // atan(2/3)
                                        "Rows without a valid position, left out: 1.",
                                        "with the exciter off, left out: 1."}));
  const fs::path out = folder_ / "results/passes";
  const Table table = read_table(out / "passes.csv"), way = read_table(out / "way.csv"),
              acceptance = read_table(out / "acceptance.csv"), variogram = read_table(out / "variogram.csv");
  ASSERT_EQ(table.rows(), 2u);
  EXPECT_NEAR(table.numbers("settlement [m]")[1], 0.02, 1e-4);
  EXPECT_NEAR(table.numbers("speed [m/s]")[0], 5 * 0.44704, 1e-12);
  EXPECT_NEAR(table.numbers("frequency [Hz]")[0], 30.0, 1e-12);
  EXPECT_NEAR(table.numbers("amplitude [m]")[0], 0.9e-3, 1e-12);
  ASSERT_EQ(way.rows(), 47u);
  const std::vector<double> s = way.numbers("s [m]"), left = way.numbers("left [m]");
  for (std::size_t row = 0; row < 24; ++row) { // in the order of the file
    const std::size_t along = row / 2;         // two lanes
    EXPECT_NEAR(s[row], cell * std::sqrt(13.0) * static_cast<double>(along), 1e-3);
    EXPECT_NEAR(left[row], row % 2 == 0 ? cell * std::sqrt(13.0) : 0.0, 1e-3);
  }
  // Pass 2 has 20 to 31 in one lane and to 30 in the other; the cell without a second pass had 21 in the
  // first.
  EXPECT_EQ(acceptance.text("pass"), (std::vector<std::string>{"1", "2", "last"}));
  EXPECT_NEAR(acceptance.numbers("CMV [-]")[1], (306.0 + 275.0) / 23.0, 1e-9);
  EXPECT_NEAR(acceptance.numbers("coverage [-]")[2], 11.0 / 24.0, 1e-12);
  // Both passes have all cells but those two: 10 more each.
  EXPECT_NEAR(std::stod(acceptance.text("gain [-]")[1]), 220.0 / (2.0 * 186.0 - 10.0 - 21.0), 1e-9);
  EXPECT_NEAR(variogram.numbers("distance [m]")[0], cell * std::sqrt(13.0), 1e-3);
  EXPECT_NEAR(variogram.numbers("semivariance [-]")[0], 0.5 * (21.0 + 81.0) / 22.0, 1e-9);
  const Parsed page = expect_sound_page(out / "passes", 3, "index.html", 0);
  EXPECT_TRUE(contains(read_text(out / "passes/index.html"),
                       {"2 of 3 acceptance criteria hold", "the last pass changes the mean by less than 5 %",
                        "What is not known from such a file", "CMV in plan"}));
}

// What `drumlin meter --export` writes, and the other ways in which such files write places and passes.
TEST_F(FieldPasses, ReadsTheOtherWaysOfWritingSuchFiles) {
  const auto cmv = [&](const std::string &text, const std::vector<std::string> &more = {}) {
    write(text);
    std::vector<std::string> words = {"site.csv"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = passes(words);
    EXPECT_TRUE(outcome.ok()) << outcome.output;
    const Table table = read_table(folder_ / "results/passes/acceptance.csv");
    return table.numbers(table.header()[2]);
  };
  EXPECT_EQ(cmv("Time,CellN_m,CellE_m,PassNumber,LastCMV,LastTemp,_c\r\n?,0.00,0.00,1,12.5,?\r\n"
                "?,0.34,0.00,1,13.5,?\r\n"),
            (std::vector<double>{13.0, 13.0}));
  // Units in cells, PassCount, an own name of the meter, the last row cut.
  EXPECT_EQ(cmv("CellN,CellE,PassCount,Speed,EVIB1\n5,1,1,0.8km/h,40\n6,1,1,3.6km/h,50\n7,1,1,3.",
                {"--meter", "LastEVIB1"}),
            (std::vector<double>{45.0, 45.0}));
  EXPECT_EQ(read_table(folder_ / "results/passes/passes.csv").header().back(), "EVIB1 [?]");
  EXPECT_NEAR(read_table(folder_ / "results/passes/passes.csv").numbers("speed [m/s]")[0],
              0.5 * (0.8 + 3.6) / 3.6, 1e-12);
  // A ten-thousandth of a degree of latitude is 11.1195 m of a sphere of 6371 km, of longitude half at 60.
  cmv("Lat,Long,PassNumber,CMV\n60.0000,10.0,1,30\n60.0001,10.0,1,40\n60.0002,10.0,1,50\n60.0001,10.00002,1,"
      "45\n");
  const Table way = read_table(folder_ / "results/passes/way.csv");
  EXPECT_NEAR(way.numbers("s [m]")[1] - way.numbers("s [m]")[0], 11.1195, 1e-2);
  EXPECT_NEAR(way.numbers("left [m]")[1] - way.numbers("left [m]")[3], 1.11195, 1e-2);
  // A later row of a cell and pass replaces an earlier one.
  EXPECT_EQ(cmv("CellN_m,CellE_m,PassNumber,CMV\n0,0,1,30\n0,0.34,1,20\n0,0,1,40\n"),
            (std::vector<double>{30.0, 30.0}));
}

TEST_F(FieldPasses, RefusesInOneLine) {
  const std::string good = "CellN_m,CellE_m,PassNumber,LastCMV\n0,0,1,30\n0.34,0,1,40\n";
  refused("CellN_m,CellE_m,LastCMV\n0,0,30\n", "allowed: one that names 'PassNumber'");
  refused("North_x,CellE_m,PassNumber,LastCMV\n0,0,1,30\n", "allowed: one that names 'CellN_m'");
  refused(good, "allowed: one that names 'LastMDP'", {"--meter", "LastMDP"});
  refused("", "the file is empty");
  refused("CellN_m,CellE_m,PassNumber,LastCMV\n", "has no row of a cell with a valid position");
  refused("CellN_m,CellE_m,PassNumber,LastCMV\n0,0,1,?\n",
          "has no value; allowed: a meter that the file gives");
  refused("CellN_m,CellE_m,PassNumber,LastCMV\n0,0,1,much\n",
          "line 2, column 'LastCMV' is 'much'; allowed: ");
  refused("CellN_m,CellE_m,PassNumber,LastCMV\n0,?,1,3\n",
          "column 'CellE_m' is '?'; allowed: a number, which");
  refused("CellN_m,CellE_m,PassNumber,LastCMV\n0,0,1.5,3\n",
          "column 'PassNumber' is '1.5'; allowed: a whole");
  refused("CellN_m,CellE_m,PassNumber,LastCMV\n0,0,3\n", "the number of cells is '3'; allowed: 4");
  refused("CellN_m,CellE_m,PassNumber,LastCMV\n0,0,1,3\n0,9e6,1,3\n", "at most 100 km from the first row");
  refused("Lat,Long,PassNumber,LastCMV\n95,0,1,3\n", "latitudes of at most 90");
  refused(good, "--field is 'site.csv'; allowed: without FOLDER", {"run"});
  refused(good, "--spacing is '0.1'; allowed: only for runs", {"--spacing", "0.1"});
  refused(good, "--drum-radius is '0.75'; allowed: only for runs", {"--drum-radius", "0.75"});
  refused(good, "--target is '0'; allowed: ", {"--target", "0"});
  refused(good, "--coverage is '101'; allowed: ", {"--coverage", "101"});
  const Outcome neither = run_program({DRUMLIN_TOOLS, "passes"}, {}, folder_);
  EXPECT_NE(neither.status, 0);
  expect_one_error(neither.output, "drumlin passes: ");
  EXPECT_TRUE(contains(neither.output, {"FOLDER is ''; allowed: the folder of a run"}));
}

} // namespace
} // namespace drumlin::test
