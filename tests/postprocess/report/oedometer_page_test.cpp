// The report of runs of the oedometer: what it reads, refuses and shows.
#include "report/oedometer_page.h"

#include "report/report.h"
#include "support/files.h"
#include "support/usage_error.h"
#include "tests/support/page.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>

namespace {

using namespace drumlin::post;
namespace test = drumlin::test;
namespace fs = std::filesystem;

const std::string header = "stress_kPa,settlement_mm,strain,void_ratio,porosity,modulus_MPa,inertial_number,"
                           "coordination,work_J,stored_J,"
                           "contact_heat_J,drag_heat_J,energy_error\n";

class OedometerReport : public ::testing::Test {
protected:
  OedometerReport() : root(fs::temp_directory_path() / fmt::format("drumlin-oedometer-{}", ::getpid())) {
    fs::remove_all(root);
  }
  ~OedometerReport() override {
    std::error_code ignored;
    fs::remove_all(root, ignored);
  }

  /// A run of three loads whose last energy error is given.
  void write_run(const std::string &name, const std::string &error = "2e-6") const {
    fs::create_directories(root / name);
    const std::string rows = "5,0,0,0.2,0.167,,0,2.5,0,0,0,0,0\n"
                             "25,0.5,0.0005,0.199,0.166,40,1e-4,3,1,0.5,0.3,0.2,1e-6\n"
                             "100,1.5,0.0015,0.198,0.165,75,2e-4,3.5,9,6,2,1,2e-6\n"
                             "25,0.75,0.00075,0.199,0.166,100,2e-4,3,5,1,3,1," +
                             error + "\n";
    write_files({{root / name / "oedometer.csv", header + rows},
                 {root / name / "parameters.csv",
                  "name,value\ndeck,oedometer\nsample,random\nballs,100\nfriction,0.5\nk,1e8\n"}});
  }

  fs::path report(const std::string &name) const {
    ReportOptions options;
    options.folders = {root / name};
    options.out = root / "report";
    return write_report(options).page;
  }

  fs::path root;
};

TEST_F(OedometerReport, ReadsTheRows) {
  write_run("one");
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
  write_run("tests/one");
  write_run("tests/two, of \"two\"", "2e-2"); // an energy error above the criterion
  const std::string first = read_text(report("tests"));
  EXPECT_NE(first.find("oedometer/index.html"), std::string::npos);
  const fs::path page = root / "report" / "oedometer";
  const std::string text = read_text(page / "index.html");
  const test::Parsed shown = test::parse(text);
  EXPECT_TRUE(shown.well_formed) << shown.error;
  EXPECT_NE(text.find("1 of 2 acceptance criteria hold"), std::string::npos);
  EXPECT_NE(text.find("largest energy error at most 0.001"), std::string::npos);
  for (const std::string &link : shown.links)
    EXPECT_TRUE(link.front() == '#' || fs::is_regular_file(page / test::file_of(link))) << link;
  const std::string table = read_text(page / "data" / "oedometer_runs.csv");
  EXPECT_NE(table.find("one,random,100,0.5,1e8,0.2,1.5,0.75,75,100,0.0002,2e-06"), std::string::npos)
      << table;
}

TEST_F(OedometerReport, RefusesWhatItCannotRead) {
  write_run("cut");
  for (const auto &[text, says] :
       {std::pair<std::string, std::string>{header + "5,0,0,0.2,0.167,,0,2.5,0,0,0,0,0\n",
                                            "allowed are 2 or more"},
        {header + "5,0,0,0.2,0.167,,0,2.5,0,0,0,0,0\n9,1,x,1,1,1,1,1,1,1,1,1,1\n", "column 'strain' is 'x'"},
        {header + "5,0,0,0.2,0.167,,0,2.5,0,0,0,0,0\n9,1,1,1,1,nan,1,1,1,1,1,1,1\n",
         "column 'modulus_MPa' is 'nan'"},
        {"stress_kPa\n5\n6\n", "settlement_mm"}}) {
    write_files({{root / "cut" / "oedometer.csv", text}});
    try {
      report("cut");
      ADD_FAILURE() << text;
    } catch (const UsageError &error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("oedometer.csv"), std::string::npos) << error.what();
    }
  }
  EXPECT_FALSE(fs::exists(root / "report"));
}

} // namespace
