// The page of observations: rows that differ come first, and the findings and their commands are those of the
// data file.
#include "report/observations.h"
#include "report/report.h"

#include "support/csv.h"
#include "support/files.h"
#include "support/text.h"
#include "support/usage_error.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"
#include "tests/support/page.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

namespace {

using namespace drumlin::post;
using namespace drumlin::test;
namespace fs = std::filesystem;

const fs::path studies = fs::path(DRUMLIN_SOURCE_DIR) / "inputs/study";
const fs::path folder = studies / "observations";

PageTable shipped() { return read_observations({folder / observations_file}); }

std::string cell(const PageTable &table, std::size_t row, const std::string &column) {
  const auto found = std::find(table.header.begin(), table.header.end(), column);
  return table.rows.at(row).at(static_cast<std::size_t>(found - table.header.begin()));
}

ReportOutcome report_of(const fs::path &in, const fs::path &out) {
  ReportOptions options;
  options.folders = {in};
  options.out = out;
  return write_report(options);
}

TEST(Observations, DifferFirst) {
  const Scratch scratch;
  const ReportOutcome outcome = report_of(folder, scratch / "report");
  EXPECT_TRUE(contains(read_text(outcome.page), "<a href=\"observations/index.html\">What rollers have been "
                                                "observed to do, and what the model says</a>"));
  expect_sound_page(scratch / "report/observations", 0, "index.html", 0);
  const std::string page = read_text(scratch / "report/observations/index.html");
  const std::size_t answer = page.find("The model differs from "), table = page.find("<tbody>");
  EXPECT_LT(answer, page.find("The model agrees with "));
  EXPECT_LT(answer, table);
  EXPECT_EQ(page.find("<td class=\"word\">✗ differs<", table), page.find("<td", table));
  EXPECT_GT(page.find("<td class=\"word\">✓ agrees<", table), page.rfind("✗ differs in part<"));
  EXPECT_GT(page.find("<td class=\"word\">not modelled<", table), page.rfind("✓ agrees<"));
}

TEST(Observations, AreTwelveAndEightHaveIntervals) {
  const PageTable table = shipped();
  std::size_t intervals = 0;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::string figure = cell(table, row, "figure and interval");
    if (std::regex_search(figure, std::regex(R"( \(-?[0-9.]+ to [+-]?[0-9.]+|\+- [0-9.]+)"))) ++intervals;
    for (const char *column : {"observed", "source", "read"})
      EXPECT_FALSE(cell(table, row, column).empty()) << row << column;
    if (cell(table, row, "verdict") == "not modelled") continue;
    for (const char *column : {"scene", "command", "figure and interval"})
      EXPECT_FALSE(cell(table, row, column).empty()) << row << column;
  }
  EXPECT_GE(table.rows.size(), 12u);
  EXPECT_GE(intervals, 8u);
}

// On a failure the message has the table that findings.md must have.
TEST(Observations, AreTheTableOfTheFindings) {
  const PageTable table = shipped();
  std::string lines =
      "\n| observed | source: what was read of it | figure and interval | verdict |\n|---|---|---|---|\n";
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::string remark = cell(table, row, "remark");
    lines +=
        fmt::format("| {} | {}: {} | {} | {}{} |\n", cell(table, row, "observed"), cell(table, row, "source"),
                    cell(table, row, "read"), cell(table, row, "figure and interval"),
                    cell(table, row, "verdict"), remark.empty() ? "" : ": " + remark);
  }
  EXPECT_TRUE(contains(read_text(folder / "findings.md"), lines + "\n")) << lines;
}

// Commands of `observe` are examples of the findings, which a test of the pages runs with `few`; the others
// are those of the findings of their subject.
TEST(Observations, HaveCommandsOfTheFindings) {
  std::string others;
  for (const char *subject : {"drive", "fidelity"})
    others += read_text(studies / subject / "findings.md");
  const std::string findings = read_text(folder / "findings.md");
  const PageTable table = shipped();
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    if (const std::string command = cell(table, row, "command"); command.rfind("./drumlin ", 0) == 0) {
      EXPECT_TRUE(contains(others, "\n    " + command)) << command;
    } else if (!command.empty()) {
      EXPECT_TRUE(
          contains(findings, "```sh run\ndrumlin=build/release/bin/drumlin-tools " + command + " few\n"))
          << command;
    }
}

// One line with file, line and what is allowed, and no report.
TEST(Observations, OfAnotherKindAreRefused) {
  const std::string head = "observed,figure and interval,verdict,remark,source,read,scene,command\n";
  for (const auto &[text, words] :
       {std::pair<std::string, std::string>{head + "a,b,maybe,c,d,e,f,g\n",
                                            "line 2, column 'verdict' is 'maybe'; allowed: differs"},
        {head, "no observation; allowed are 1 or more rows"},
        {"observed,source\na,b\n", "figure and interval"}}) {
    const Scratch scratch;
    fs::create_directories(scratch / "in");
    write_files({{scratch / "in/observations.csv", text}});
    EXPECT_TRUE(contains(error_of<UsageError>([&] { report_of(scratch / "in", scratch / "report"); }),
                         {"observations.csv", words}));
    EXPECT_FALSE(fs::exists(scratch / "report"));
  }
}

} // namespace
