// What all pages share: strict XML, links that lead somewhere, prose that was read and approved.
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"
#include "tests/support/lines.h"
#include "tests/support/page.h"
#include "tests/support/run_folders.h"

#include "pages/figure_data.h"
#include "pages/html.h"
#include "pages/page.h"
#include "support/files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

// The page of a study: strict XML, and every link leads to a file below its folder.
namespace pages {

namespace fs = std::filesystem;

TEST(Page, IsStrictXmlAndItsLinksLeadToFiles) {
  const Scratch scratch;
  const fs::path &out = scratch.path();
  post::Page page(out, "Steps & <errors>", post::Drawing::chain);
  page.answer("Steps < errors.");
  page.paragraph("a < b & c");
  page.section("First");
  post::PageTable table;
  table.name = "numbers";
  table.title = "Numbers";
  table.header = {"case", "error (-)"};
  table.add({"I", "1e-3"});
  page.table(table);
  page.section("Second");
  post::CurveTable curves("steps per cycle,error (-)");
  for (const double steps : {100.0, 200.0, 400.0})
    curves.row("second B", {steps, 1.0 / (steps * steps)});
  post::Panel panel;
  panel.x_label = "steps per cycle";
  panel.y_label = "error (-)";
  panel.log_x = panel.log_y = true;
  panel.curves = {post::curve("errors", "second B", "$2", "3", post::CurveStyle::series_1)};
  page.figure({"", "Fig. 1", "Errors.", {"errors", "Errors", {panel}}, curves.text()});
  page.write();

  const Parsed parsed = expect_sound_page(out, 1);
  EXPECT_EQ(parsed.links.size(), 6u);
  EXPECT_EQ(parsed.contents, (std::vector<std::string>{"#answer", "#section-1", "#section-2"}));
  EXPECT_EQ(post::read_text(out / "data/numbers.csv"), "case,error (-)\nI,1e-3\n");
}

std::size_t count(const std::string &text, const std::string &part) {
  std::size_t number = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++number;
  return number;
}

// In a black and white print the mark and the word can be seen, but not the colour.
TEST(Table, MarksGoodAndBadRowsInItsFirstColumn) {
  post::PageTable table;
  table.name = "numbers";
  table.title = "Numbers";
  table.criterion = "are small";
  table.header = {"run", "error (-)"};
  table.add({"a", "1"}, post::RowState::agrees);
  table.add({"b", "2"}, post::RowState::differs);
  table.add({"c", "3"});
  const std::string html = post::table_html(table);
  EXPECT_TRUE(contains(html, {"<b>✗ 1 of 2</b> are small",
                              "<tr class=\"agrees\"><td class=\"word\">✓ yes</td><td class=\"word\">a</td>",
                              "<tr class=\"differs\"><td class=\"word\">✗ no</td><td class=\"word\">b</td>",
                              "<tr><td class=\"word\">–</td><td class=\"word\">c</td>"}));
  // A column with words of its own moves to the front; the CSV file keeps its order.
  table.header = {"run", "agrees"};
  table.verdict = "agrees";
  table.rows = {{"a", "to all digits"}, {"b", "no"}, {"c", "not judged"}};
  const std::string worded = post::table_html(table);
  EXPECT_TRUE(contains(worded, {"<td class=\"word\">✓ to all digits</td><td class=\"word\">a</td>",
                                "<td class=\"word\">✗ no</td><td class=\"word\">b</td>",
                                "<td class=\"word\">not judged</td><td class=\"word\">c</td>"}));
  EXPECT_EQ(count(worded, "to all digits"), 1u);
  EXPECT_EQ(post::table_csv(table), "run,agrees\na,to all digits\nb,no\nc,not judged\n");
  table.states.assign(3, post::RowState::agrees);
  EXPECT_TRUE(contains(post::table_html(table), "<p class=\"tally\"><b>✓ 3 of 3</b>"));
}

TEST(Acceptance, IsPartOfTheAnswerAndMarksIt) {
  const Scratch scratch;
  const fs::path &out = scratch.path();
  for (const bool holds : {true, false}) {
    const std::vector<post::Acceptance> criteria = {{"error at most 1", "0.5", true},
                                                    {"order at least 2", "1.5", holds}};
    post::Page page(out, "Steps", post::Drawing::bed);
    page.answer("Many runs.");
    page.answer(criteria);
    page.section("Acceptance criteria");
    page.table(post::acceptance_table(criteria));
    page.write();
    const std::string text = post::read_text(out / "index.html");
    EXPECT_TRUE(contains(
        text, holds ? "<p class=\"verdict good\">✓ Many runs.<br /> <strong>Acceptance.</strong> 2 "
                      "of 2 acceptance criteria hold.</p>"
                    : "<p class=\"verdict bad\">✗ Many runs.<br /> <strong>Acceptance.</strong> 1 of "
                      "2 acceptance criteria hold. Not met: order at least 2 (measured 1.5).</p>"));
    EXPECT_EQ(
        post::read_text(out / "data/acceptance.csv"),
        fmt::format("acceptance criterion,measured,holds\nerror at most 1,0.5,yes\norder at least 2,1.5,{}\n",
                    holds ? "yes" : "no"));
  }
}

TEST(KeyFigures, AreTheTwoOfLargestWeight) {
  std::vector<post::PageFigure> figures(4);
  for (std::size_t i = 0; i < figures.size(); ++i) {
    figures[i].label = fmt::format("Fig. {}", i);
    figures[i].figure.name = fmt::format("f{}", i);
    figures[i].figure.title = fmt::format("Fig. {}  Title {}", i, i);
    figures[i].figure.panels.resize(2);
    figures[i].figure.panels[1].title = "second";
  }
  figures[1].weight = 1.0;
  figures[2].weight = 3.0;
  figures[2].key_panel = 1;
  figures[3].weight = 2.0;
  const std::vector<post::KeyFigure> keys = post::key_figures(figures, "bed.html");
  ASSERT_EQ(keys.size(), 2u);
  EXPECT_EQ(keys[0].figure.name, "f2_key");
  EXPECT_EQ(keys[0].caption, "Title 2");
  EXPECT_EQ(keys[0].href, "bed.html#f2");
  ASSERT_EQ(keys[0].figure.panels.size(), 1u);
  EXPECT_EQ(keys[0].figure.panels[0].title, "second");
  EXPECT_EQ(keys[1].figure.name, "f3_key");
}

} // namespace pages

// The prose of one page of each kind, as it was read and approved: the texts beside this file, with # for
// each number. The numbers are tested by the CSV files beside the pages. DRUMLIN_REWRITE=1 writes the texts
// anew, and git shows what has changed.
namespace prose {

namespace fs = std::filesystem;

/// A page, made by a command in a folder with runs of the chain, of impacts and of beds.
struct Page {
  const char *name, *words, *file;
};

void PrintTo(const Page &page, std::ostream *out) { *out << page.name; }

class Prose : public ::testing::TestWithParam<Page> {};

TEST_P(Prose, IsAsItWasApproved) {
  const auto &[name, words, file] = GetParam();
  const Scratch scratch;
  write_chain_run(scratch / "II-A", "II", post::Transition::A, 12);
  write_chain_run(scratch / "II-B", "II", post::Transition::B, 12);
  write_impact_run(scratch / "impact", post::Transition::B, 0.5);
  write_bed_run(scratch / "bed-A", post::Transition::A);
  write_bed_run(scratch / "bed-B", post::Transition::B);
  write_bed_dumps(scratch / "bed-B");
  std::vector<std::string> all = words_of(words);
  all.insert(all.begin(), DRUMLIN_TOOLS);
  well(run_program(all, {}, scratch.path()));
  std::string page = read_text(scratch / file);
  const std::string here = scratch.path().string();
  for (std::size_t at = page.find(here); at != std::string::npos; at = page.find(here, at))
    page.replace(at, here.size(), "FOLDER");
  const std::string prose = prose_of(page);
  const fs::path approved = fs::path(DRUMLIN_SOURCE_DIR) / "tests/pages" / (std::string(name) + ".txt");
  if (std::getenv("DRUMLIN_REWRITE") != nullptr)
    std::ofstream(approved) << prose;
  else
    EXPECT_EQ(prose, read_text(approved));
}

INSTANTIATE_TEST_SUITE_P(
    , Prose,
    ::testing::Values(Page{"report", "report II-A II-B impact --out out", "out/index.html"},
                      Page{"bed", "report bed-A bed-B --out out", "out/bed.html"},
                      Page{"meter", "meter II-B --out out", "out/index.html"},
                      Page{"identify", "identify II-B --out out", "out/index.html"},
                      Page{"map", "map --x k:5e6:40e6:4 --y D:0.1:0.5:3 --out out", "out/index.html"}),
    [](const ::testing::TestParamInfo<Page> &page) { return std::string(page.param.name); });

} // namespace prose

} // namespace
} // namespace drumlin::test
