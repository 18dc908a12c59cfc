// The report of runs of the oedometer: what it reads, refuses and shows.
#include "report/soil/oedometer.h"

#include "tests/support/checks.h"
#include "tests/support/element_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace drumlin::post;
using namespace drumlin::test;
namespace test = drumlin::test;

const std::string header = "stress_kPa,settlement_mm,strain,void_ratio,porosity,modulus_MPa,inertial_number,"
                           "coordination,work_J,stored_J,contact_heat_J,drag_heat_J,energy_error\n";

class OedometerReport : public test::ElementReport {
protected:
  /// A run of three loads whose last energy error is given.
  void write_loads(const std::string &folder, const std::string &error = "2e-6") const {
    write_run(folder, "oedometer.csv",
              header +
                  "5,0,0,0.2,0.167,,0,2.5,0,0,0,0,0\n"
                  "25,0.5,0.0005,0.199,0.166,40,1e-4,3,1,0.5,0.3,0.2,1e-6\n"
                  "100,1.5,0.0015,0.198,0.165,75,2e-4,3.5,9,6,2,1,2e-6\n"
                  "25,0.75,0.00075,0.199,0.166,100,2e-4,3,5,1,3,1," +
                  error + "\n",
              "deck,oedometer\nsample,random\nballs,100\nfriction,0.5\nk,1e8\n");
  }
};

TEST_F(OedometerReport, ReadsTheRows) {
  write_loads("one");
  const std::vector<OedometerRow> rows = read_oedometer(root / "one" / "oedometer.csv");
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_TRUE(std::isnan(rows[0].modulus));
  EXPECT_EQ(rows[3].stress, 25);
  EXPECT_EQ(rows[3].settlement, 0.75);
  EXPECT_EQ(rows[3].strain, 0.00075);
  EXPECT_EQ(rows[3].void_ratio, 0.199);
  EXPECT_EQ(rows[3].modulus, 100);
  EXPECT_EQ(rows[3].inertial_number, 2e-4);
  EXPECT_EQ(rows[3].energy_error, 2e-6);
}

TEST_F(OedometerReport, ShowsTheRunsOnAPageOfTheirOwn) {
  write_loads("tests/one");
  write_loads("tests/two, of \"two\"", "2e-2"); // an energy error above the criterion
  const std::string page = sound_page("tests", "oedometer", 1);
  EXPECT_TRUE(contains(page, {"1 of 2 acceptance criteria hold", "largest energy error at most 0.001"}));
  const std::string runs = data("oedometer", "oedometer_runs");
  EXPECT_TRUE(contains(runs, "one,random,100,0.5,1e8,0.2,1.5,0.75,75,100,0.0002,2e-06"));
}

TEST_F(OedometerReport, RefusesWhatItCannotRead) {
  const std::string first = header + "5,0,0,0.2,0.167,,0,2.5,0,0,0,0,0\n";
  expect_refused("oedometer.csv", first, "allowed are 2 or more");
  expect_refused("oedometer.csv", first + "9,1,x,1,1,1,1,1,1,1,1,1,1\n", "column 'strain' is 'x'");
  expect_refused("oedometer.csv", first + "9,1,1,1,1,nan,1,1,1,1,1,1,1\n", "column 'modulus_MPa' is 'nan'");
  expect_refused("oedometer.csv", "stress_kPa\n5\n6\n", "settlement_mm");
}

} // namespace
