// The page of a study: strict XML, and every link leads to a file below its folder.
#include "pages/page.h"

#include "pages/figure_data.h"
#include "support/files.h"
#include "tests/support/page.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

TEST(StudyPage, IsStrictXmlWithFilesBehindItsLinks) {
  const fs::path out = fs::temp_directory_path() / fmt::format("drumlin-page-{}", ::getpid());
  post::StudyPage page(out, "Steps & <errors>");
  page.paragraph("a < b & c");
  page.section("First");
  post::ReportTable table;
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

  EXPECT_EQ(expect_sound_page(out, 1).links.size(), 6u);
  EXPECT_EQ(post::read_text(out / "data/numbers.csv"), "case,error (-)\nI,1e-3\n");
  fs::remove_all(out);
}

} // namespace
} // namespace drumlin::test
