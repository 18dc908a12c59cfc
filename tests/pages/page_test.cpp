// Pages, their pictures, and the page of the chain.
#include "tests/support/page.h"
#include "tests/support/run_folders.h"
#include "tests/support/tool.h"
#include "pages/figure.h"
#include "pages/gnuplot.h"
#include "pages/html.h"
#include "pages/page.h"
#include "report/chain/ends_page.h"
#include "report/chain/engine_comparison.h"
#include "report/report.h"
#include "report/run_folder.h"
#include "support/process.h"

#include <unistd.h>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

// What all pages share: strict XML, links that lead somewhere, prose that was read and approved.
namespace page {

// The page of a study: strict XML, and every link leads to a file below its folder.
namespace pages {

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

} // namespace page

// Names of run folders reach gnuplot scripts: they must stay text there.
namespace gnuplot {

using namespace drumlin::post;
using namespace drumlin::test;

TEST(Script, KeepsHostileNamesAsText) {
  Figure figure;
  figure.name = "f";
  figure.title = "t";
  Panel panel;
  panel.x_label = "x (m)";
  panel.y_label = "y (m)";
  panel.x_ticks = {"a\"; system(\"touch /tmp/x\") #", "b\\", "`date`"};
  figure.panels = {panel};
  const std::string script = gnuplot_script(figure);
  EXPECT_TRUE(contains(script, {"\\\"; system(\\\"touch", "\"b\\\\\""}));
  EXPECT_EQ(script.find('`'), std::string::npos); // gnuplot runs what is between backquotes
}

/// What gnuplot draws of names along an axis, as the texts of the SVG.
TEST(Script, DrawsHostileNamesAsTheyAre) {
  const Scratch scratch;
  const fs::path folder = scratch / "100% {}";
  fs::create_directories(folder);
  std::ofstream(folder / "it's.csv") << "curve,x,y\n\"it's\",1,2\n\"it's\",2,3\n";
  Figure figure;
  figure.name = "f";
  figure.title = "100% {t}";
  Panel panel;
  panel.title = "%s {a}_b^c @d";
  panel.x_label = "x (m)";
  panel.y_label = "y (m)";
  panel.x_ticks = {
      "100%", "%s%n", "{}", "a_b^c", "a\"b", "it's", "a\\nb", "x y", "c\x01", "\xff", std::string(300, 'w')};
  panel.curves = {{"it's.csv", of_curve("it's", "$2"), "3", "%d_{}", CurveStyle::plain}};
  figure.panels = {panel, panel};
  render(find_gnuplot(), folder, figure);
  const std::string svg = read_text(folder / "f.svg");
  EXPECT_TRUE(contains(svg, {"100%", "%s%n", "{}", "a_b^c", "a\"b", "it's", "a\\nb", "x y", ">c<",
                             "%s {a}_b^c @d", "%d_{}", "100% {t}"}));
  EXPECT_TRUE(drumlin::test::parse(svg).well_formed);
  EXPECT_FALSE(fs::exists(folder / program_output_file));
}

// On a full disk gnuplot leaves a part of a picture and ends with 0.
TEST(Picture, ThatIsCutShortIsAnError) {
  const Scratch scratch;
  const fs::path &folder = scratch.path();
  std::ofstream(folder / "f.csv") << "x,y\n1,2\n2,3\n";
  Figure figure;
  figure.name = "f";
  figure.panels = {Panel()};
  figure.panels[0].curves = {{"f.csv", "1", "2", "", CurveStyle::plain}};
  for (const char *cut : {"f.svg", "f.png"}) {
    const fs::path half = folder / "half-gnuplot";
    std::ofstream(half) << fmt::format("#!/bin/sh\n'{}' \"$@\" && truncate -s -9 {}\n",
                                       find_gnuplot().string(), cut);
    fs::permissions(half, fs::perms::owner_all);
    EXPECT_NO_THROW(render(find_gnuplot(), folder, figure));
    EXPECT_TRUE(is_whole_picture(folder / cut));
    EXPECT_EQ(error_of([&] { render(half, folder, figure); }),
              (folder / cut).string() + " is cut short; allowed: a disk with room for what gnuplot draws");
    EXPECT_FALSE(is_whole_picture(folder / cut));
  }
}

// Records of zeros or constants have such figures: gnuplot takes a panel without points for an error.
TEST(Pictures, AreDrawnOfConstantsAndWithoutPoints) {
  const fs::path folder = fs::path(::testing::TempDir()) / "constants";
  fs::create_directories(folder);
  write_files({{folder / "f.csv", "x,missing,zero,constant\n1,,0,3\n1,,0,3\n1,,0,3\n"}});
  const auto panel = [](const std::string &x, const std::string &y, bool log) {
    Panel one;
    one.curves = {{"f.csv", x, y, "a curve", CurveStyle::plain}};
    one.log_y = log;
    one.tight_x = true;
    return one;
  };
  Figure figure;
  figure.name = "f";
  figure.columns = 3;
  figure.panels = {panel("1", "2", false), panel("1", "3", true),  panel("2", "1", false),
                   panel("1", "3", false), panel("1", "4", false), panel("1", "4", true)};
  figure.panels[3].y_range = "[0:*]";
  figure.panels[4].x_range = "[0:*]";
  render(find_gnuplot(), folder, figure);
  for (const char *picture : {"f.svg", "f.png"})
    EXPECT_TRUE(is_whole_picture(folder / picture)) << picture;
  const std::string script = read_text(folder / "f.gp"), note = "no values to draw";
  std::size_t notes = 0;
  for (std::size_t at = script.find(note); at != std::string::npos; at = script.find(note, at + 1))
    ++notes;
  EXPECT_EQ(notes, 3U) << script;
  // Other errors of gnuplot stay errors.
  figure.panels[0].curves[0].data = "no such file.csv";
  EXPECT_THROW(render(find_gnuplot(), folder, figure), std::runtime_error);
  fs::remove_all(folder);
}

TEST(Script, HasNoRangeWithoutExtent) {
  EXPECT_EQ(axis_range(-1.0, 2.5), "[-1:2.5]");
  EXPECT_EQ(axis_range(1.0, 1.0), "");
  EXPECT_EQ(axis_range(1.0, 1.0 + 1e-9), "");
  EXPECT_EQ(axis_range(1.0, 0.0), "");
  EXPECT_EQ(axis_range(0.0, std::numeric_limits<double>::infinity()), "");
  EXPECT_EQ(axis_range(std::nan(""), 1.0), "");
}

TEST(Script, DrawsPicturesToScaleAndOnlyAsPixels) {
  Figure figure;
  figure.name = "f";
  figure.only_png = true;
  Panel picture;
  picture.equal_scales = true;
  picture.color_label = "speed (m/s)";
  picture.curves = {{"f.csv", "1", "2:3:4", "", CurveStyle::discs},
                    {"f.csv", "1", "2:5:6", "", CurveStyle::segments}};
  picture.curves.back().width = 2.5;
  figure.panels = {picture, Panel()};
  const std::string script = gnuplot_script(figure);
  EXPECT_TRUE(contains(script, {"[kind in \"png\"]", "with vectors nohead lw 2.5"}));
  // What the picture sets does not reach the next panel.
  const std::size_t set = script.find("set size ratio -1");
  ASSERT_NE(set, std::string::npos);
  EXPECT_LT(set, script.find("set size noratio"));
  EXPECT_LT(script.find("set colorbox"), script.find("unset colorbox"));
  figure.only_png = false;
  EXPECT_TRUE(contains(gnuplot_script(figure), "[kind in \"svg png\"]"));
}

TEST(Size, OfPanelsInRows) {
  Figure figure;
  figure.panels.resize(3);
  figure.columns = 2;
  const int row = 430;
  const int title = 40;
  EXPECT_EQ(figure_height(figure), 2 * row + title);
  // All figures are of one width.
  const int width = figure_width(figure);
  for (const int columns : {1, 3}) {
    figure.columns = columns;
    EXPECT_EQ(figure_width(figure), width);
  }
  EXPECT_EQ(figure_height(figure), row + title);
  figure.panels.resize(1);
  EXPECT_EQ(figure_height(figure), row);
  figure.half = true;
  EXPECT_EQ(2 * figure_width(figure), width);
  figure.panels[0].equal_scales = true;
  EXPECT_EQ(figure_height(figure), row);
  figure.half = false;
  EXPECT_GT(figure_height(figure), row);
}

// Names too long for one line below the axes would be written across the axis label.
TEST(Legend, HasTheRowsThatItsNamesNeed) {
  Figure figure;
  figure.name = "f";
  Panel panel;
  for (const char *name : {"A DEM", "B DEM", "A reference", "B reference"})
    panel.curves.push_back({"f.csv", "1", "2", name, CurveStyle::plain});
  figure.panels = {panel};
  EXPECT_TRUE(contains(gnuplot_script(figure), "set key maxrows 1 "));
  figure.half = true;
  EXPECT_TRUE(contains(gnuplot_script(figure), "set key maxrows 2 "));
  for (Curve &curve : figure.panels[0].curves)
    curve.title.clear();
  EXPECT_TRUE(contains(gnuplot_script(figure), "set key maxrows 1 "));
}

/// Heights, px from the top, at which a text stands in an SVG file of gnuplot's.
std::vector<double> heights_of(const std::string &svg, const std::string &text) {
  std::vector<double> heights;
  for (const char *end : {"</tspan>", "</text>"}) {
    const std::string whole = ">" + text + end;
    for (std::size_t at = svg.find(whole); at != std::string::npos; at = svg.find(whole, at + 1))
      heights.push_back(std::stod(svg.substr(svg.find(',', svg.rfind("translate(", at)) + 1)));
  }
  return heights;
}

// gnuplot thinks that letters are wider in SVG files than they are.
TEST(Legend, IsBelowTheAxisLabelInSvgFiles) {
  const Scratch scratch;
  const fs::path &folder = scratch.path();
  write_files({{folder / "f.csv", "x,y\n0,-1e6\n1,2e6\n"}});
  for (const int columns : {1, 2, 3})
    for (const char *longest : {"A", "dissipated", "work of the exciter", "the energy of the drum alone"}) {
      Figure figure;
      figure.name = "f";
      figure.title = "title";
      figure.columns = columns;
      Panel panel;
      panel.x_label = "below axes";
      for (const char *name : {longest, "dissipated", "potential", "error"})
        panel.curves.push_back({"f.csv", "1", "2", name, CurveStyle::plain});
      figure.panels.assign(static_cast<std::size_t>(columns), panel);
      render(find_gnuplot(), folder, figure);
      const std::string svg = read_text(folder / "f.svg");
      const std::vector<double> labels = heights_of(svg, "below axes");
      ASSERT_EQ(labels.size(), figure.panels.size());
      for (const char *name : {longest, "potential", "error"})
        for (const double height : heights_of(svg, name)) {
          EXPECT_GT(height, labels.front() + 15.0) << columns << " columns, " << longest << ": " << name;
          EXPECT_LT(height, figure_height(figure)) << columns << " columns, " << longest << ": " << name;
        }
      EXPECT_EQ(heights_of(svg, "error").size(), figure.panels.size());
    }
}

} // namespace gnuplot

// The reports of chains: drums with two ends, and two engines compared.
namespace of_page {

using namespace drumlin;
using namespace drumlin::post;
using namespace drumlin::test;

// The report of drums with two ends: its numbers against complex algebra and against the history of a run,
// its pages as strict XML.
namespace ends {

class EndsReport : public WithSketches {
protected:
  void SetUp() override {
    root = fs::temp_directory_path() / fmt::format("drumlin-ends-report-{}", ::getpid());
    fs::remove_all(root);
    fs::create_directories(root / "runs");
  }
  void TearDown() override { fs::remove_all(root); }

  /// A run of the machine of the roller file, D = 0.2, on halves as 3 to 2.
  void run(const std::string &name, double k, int cycles) const {
    const double b = 2.13 / std::sqrt(12.0), c = 0.4 * std::sqrt(3962.07 * k);
    write_files({{root / "soil.csv", fmt::format("y (m),k (N/m),c (N s/m)\n{},{},{}\n{},{},{}\n", -b, 0.6 * k,
                                                 0.6 * c, b, 0.4 * k, 0.4 * c)}});
    const std::string command = fmt::format(
        "'{}' exact --roller '{}/inputs/rollers/Axas2020' --contacts '{}' --cycles {} --out '{}' >/dev/null",
        DRUMLIN_TOOLS, DRUMLIN_SOURCE_DIR, (root / "soil.csv").string(), cycles,
        (root / "runs" / name).string());
    ASSERT_EQ(std::system(command.c_str()), 0);
  }

  fs::path report() const {
    ReportOptions options;
    options.folders = {root / "runs"};
    options.out = root / "report";
    return write_report(options).page.parent_path();
  }

  /// Takes a row out of the parameters of a run.
  void forget(const std::string &name, const std::string &parameter) const {
    const fs::path file = root / "runs" / name / "parameters.csv";
    std::string text = read_text(file);
    const std::size_t begin = text.find("\n" + parameter + ",") + 1;
    ASSERT_GT(begin, 0U);
    text.erase(begin, text.find('\n', begin) + 1 - begin);
    write_files({{file, text}});
  }

  fs::path root;
};

/// A number of the run in row n of a table of the report.
double value(const fs::path &report, const std::string &table, const std::string &column, std::size_t n) {
  return number_from_text(read_table(report / "data" / (table + ".csv")).text(column).at(n));
}

/// Share of the last ten of so many cycles between the breaks and the makes of a contact.
double flight_share(const fs::path &run, long contact, int cycles) {
  const double period = 1.0 / 29.0, end = cycles * period, begin = end - 10.0 * period;
  double sum = 0.0, broken = 0.0;
  for (const ContactEvent &event : read_events(run / "events.csv")) {
    if (event.id_j != 1 + contact) continue;
    if (event.make) sum += std::max(event.time, begin) - std::max(broken, begin);
    broken = event.make ? end : event.time;
  }
  sum += end - broken; // a flight at the end of the run
  return sum / (10.0 * period);
}

// In unbroken contact: amplitudes, tilt and apparent stiffness from complex algebra. With loss of contact:
// double jump with rocking, whose flights are those between the events, and whose meter values are those of
// the meter.
TEST_F(EndsReport, HasThePageOfDrumsWithTwoEnds) {
  draw();
  run("lifting", 45e6, 400);
  run("unbroken", 15e6, 400);
  const fs::path out = report();
  struct Known {
    const char *table, *column;
    double value, digits;
  };
  for (const Known &known : {Known{"ends_motion", "amplitude, left end (mm)", 2.1388, 5e-5},
                             {"ends_motion", "amplitude, middle (mm)", 2.0894, 5e-5},
                             {"ends_motion", "amplitude, right end (mm)", 2.0424, 5e-5},
                             {"ends_motion", "tilt (mrad)", 0.0797, 5e-5},
                             {"ends_motion", "time without contact, left half (-)", 0.0, 0.0},
                             {"ends_motion", "time without contact, right half (-)", 0.0, 0.0},
                             {"ends_motion", "repeats after (cycles)", 1.0, 0.0},
                             {"ends_meters", "k_1, left end (MN/m)", 18.29, 5e-3},
                             {"ends_meters", "k_1, middle (MN/m)", 14.97, 5e-3},
                             {"ends_meters", "k_1, right end (MN/m)", 11.73, 5e-3},
                             {"ends_meters", "error, left end (%)", 22.2, 0.05},
                             {"ends_meters", "error, right end (%)", -21.6, 0.05},
                             {"ends_meters", "k_1, left half (MN/m)", 9.0, 5e-3},
                             {"ends_meters", "k_1, right half (MN/m)", 6.0, 5e-3}})
    EXPECT_NEAR(value(out, known.table, known.column, 1), known.value, known.digits) << known.column;

  const fs::path lifting = root / "runs" / "lifting";
  const ChainHistory h = read_chain(lifting / "chain.csv");
  const auto [least, most] = std::minmax_element(h.theta_drum.end() - 400, h.theta_drum.end());
  EXPECT_GT(*most - *least, 2e-3);
  EXPECT_NEAR(value(out, "ends_motion", "tilt (mrad)", 0), 500.0 * (*most - *least), 1e-4);
  EXPECT_EQ(value(out, "ends_motion", "repeats after (cycles)", 0), 2.0);
  for (const auto &[side, contact] : {std::pair("left", 1L), std::pair("right", 2L)}) {
    const double share = flight_share(lifting, contact, 400);
    EXPECT_GT(share, 0.2);
    EXPECT_NEAR(value(out, "ends_motion", fmt::format("time without contact, {} half (-)", side), 0), share,
                5e-3);
  }
  ASSERT_EQ(std::system(fmt::format("'{}' meter '{}' --out '{}' >/dev/null", DRUMLIN_TOOLS, lifting.string(),
                                    (root / "meter").string())
                            .c_str()),
            0);
  const Table meter = read_table(root / "meter" / "meter.csv");
  for (const auto &[name, column] :
       {std::pair("k_1_left_end [N/m]", "k_1, left end (MN/m)"), std::pair("k_1 [N/m]", "k_1, middle (MN/m)"),
        std::pair("k_1_right_half [N/m]", "k_1, right half (MN/m)")})
    EXPECT_NEAR(value(out, "ends_meters", column, 0), 1e-6 * meter.numbers(name).back(), 5e-3) << name;

  const Parsed index = expect_sound_page(out, 2);
  EXPECT_NE(std::find(index.links.begin(), index.links.end(), "ends.html"), index.links.end());
  EXPECT_EQ(read_text(out / "index.html").find("not judged"), std::string::npos);
  expect_sound_page(out, 5, "ends.html");
  // Over the ratio of both halves: the run's own error at its ratio of 1.5, between two points; the mirror
  // image at the inverse; contact is lost at large ratios only.
  const Table error = read_table(out / "data/ends_error.csv");
  const std::vector<std::string> of = error.text("curve");
  const std::vector<double> ratio = error.numbers("ratio (-)"), percent = error.numbers("error (%)");
  std::map<std::string, std::map<double, double>> curves_of;
  for (std::size_t i = 0; i < of.size(); ++i)
    curves_of[of[i]][ratio[i]] = percent[i];
  ASSERT_EQ(curves_of["left end"].size(), 17U);
  ASSERT_EQ(curves_of["right end"].size(), 17U);
  const auto above = curves_of["left end"].upper_bound(1.5), below = std::prev(above);
  EXPECT_LT(below->second, 22.2);
  EXPECT_GT(above->second, 22.2);
  EXPECT_NEAR(curves_of["left end"].at(2.0), 38.97, 0.1); // as in inputs/study/ends/findings.md
  EXPECT_NEAR(curves_of["right end"].at(2.0), -36.89, 0.1);
  EXPECT_NEAR(curves_of["left end"].at(0.25), -67.5, 0.1);
  EXPECT_EQ(curves_of["contact is lost"].count(1.0), 0U);
  EXPECT_EQ(curves_of["contact is lost"].count(4.0), 1U);
  EXPECT_EQ(curves_of["contact is lost"].count(0.25), 1U);
  EXPECT_TRUE(contains(read_text(out / "ends.html"),
                       {"A meter at the left end of a drum that tilts shows 22 % more stiffness than one in "
                        "the middle, a meter at the right end 22 % less (run unbroken, one of 2).",
                        "Run lifting over the last 6 cycles, since the motion repeats after two",
                        "Run unbroken over the last 3 cycles: "}));
  for (const auto &[figure, cycles] : {std::pair("ends_1", 6.0), std::pair("ends_2", 3.0)}) {
    const Table table = read_table(out / "data" / (std::string(figure) + ".csv"));
    const std::vector<std::string> curves = table.text("curve");
    for (const char *name :
         {"left end", "middle", "right end", "tilt of the drum", "tilt of the frame",
          "force of the left half", "force of the right half", "left sensor", "right sensor"})
      EXPECT_EQ(std::count(curves.begin(), curves.end(), name), 200 * cycles + 1) << name;
    EXPECT_NEAR(table.numbers("time in window (s)").back(), cycles / 29.0, 1e-6);
  }
}

TEST_F(EndsReport, LeavesOutWhatARunDoesNotGive) {
  run("cut", 15e6, 12);
  run("narrow", 15e6, 12);
  run("short", 15e6, 3);
  forget("narrow", "width");
  forget("cut", "ended");
  const fs::path out = report();
  expect_sound_page(out, 5, "ends.html");
  EXPECT_TRUE(
      contains(read_text(out / "ends.html"),
               {"cut: not judged: its parameters.csv does not say whether it has ended",
                "narrow: parameters.csv has no width above 0: the motion of the drum&#39;s ends is left out.",
                "narrow: no stiffness of the halves", "short: no meter values: "}));
  const Table motion = read_table(out / "data" / "ends_motion.csv");
  EXPECT_EQ(motion.text("amplitude, left end (mm)").at(1), "");
  EXPECT_EQ(motion.text("amplitude, middle (mm)").at(1), motion.text("amplitude, middle (mm)").at(0));
  EXPECT_EQ(value(out, "ends_meters", "k_1, left end (MN/m)", 1),
            value(out, "ends_meters", "k_1, left end (MN/m)", 0));
  EXPECT_EQ(read_table(out / "data" / "ends_meters.csv").text("k_1, middle (MN/m)").at(2), "");
  const std::vector<std::string> curves = read_table(out / "data" / "ends_2.csv").text("curve");
  EXPECT_EQ(std::count(curves.begin(), curves.end(), "left end"), 0);
  EXPECT_EQ(std::count(curves.begin(), curves.end(), "middle"), 601);
}

// The reference solution has linear contacts.
TEST_F(EndsReport, ChainsOfOtherLawsAreNotCompared) {
  run("own", 3e7, 2);
  const std::map<std::string, RunKind> laws = {{"hooke/transition", RunKind::ends},
                                               {"hertz/transition", RunKind::unknown}};
  for (const auto &[law, kind] : laws) {
    const fs::path file = root / "runs" / "own" / "parameters.csv";
    std::string text = read_text(file);
    const std::size_t old = text.find("contact_law,");
    if (old != std::string::npos) text.erase(old, text.find('\n', old) + 1 - old);
    write_files({{file, text + "contact_law," + law + "\n"}});
    EXPECT_EQ(drumlin::post::read_run(file.parent_path()).kind, kind) << law;
  }
}

} // namespace ends

// The report's comparison of two engines, from invented runs.
namespace engines {

using post::ReportResults;

post::Run chain(const std::string &name, const std::string &engine, const std::string &k = "1e8") {
  post::Run run;
  run.name = name;
  run.kind = post::RunKind::chain;
  run.parameters = {{"k", k}, {"engine", engine}, {"ranks", engine == "LAMMPS 1" ? "2" : "1"}};
  post::ChainHistory &h = run.history;
  h.time = {0.0, 1.0, 2.0};
  for (auto *column :
       {&h.x_drum, &h.v_drum, &h.a_drum, &h.x_frame, &h.v_frame, &h.a_frame, &h.F_contact, &h.F_bond})
    *column = {1.0, -4.0, 2.0};
  run.events = {{1.0, true, 0.0, 0.0, 0.0}};
  return run;
}

ReportResults results(const std::vector<post::Run> &runs) {
  ReportResults all;
  for (const post::Run &run : runs) {
    all.runs.emplace_back();
    all.runs.back().run = run;
  }
  return all;
}

TEST(EngineTable, PairsRunsOfOneChainInTwoEngines) {
  post::Run direct = chain("direct", "CVODE 5");
  direct.direct = true;
  const ReportResults all = results({chain("here", "LIGGGHTS 3"), chain("softer", "LIGGGHTS 3", "1e6"),
                                     direct, chain("there", "LAMMPS 1"), chain("again", "LIGGGHTS 3")});
  const auto pairs = post::engine_pairs(all);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0], (std::pair<std::size_t, std::size_t>{3, 0}));
  EXPECT_EQ(pairs[1], (std::pair<std::size_t, std::size_t>{3, 4}));
  const post::PageTable table = post::engine_table(all);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.states[0], post::RowState::agrees);
  EXPECT_TRUE(post::engine_table(results({chain("here", "LIGGGHTS 3")})).rows.empty());
}

TEST(EngineTable, HasTheLargestDifferenceOverTheLargestValue) {
  const post::Run here = chain("here", "LIGGGHTS 3");
  post::Run there = chain("there", "LAMMPS 1");
  there.history.F_contact[0] += 4e-8;
  const post::PageTable apart = post::engine_table(results({here, there}));
  ASSERT_EQ(apart.rows.size(), 1u);
  EXPECT_EQ(apart.states[0], post::RowState::differs);
  EXPECT_EQ(apart.header[12], "F_contact (-)");
  EXPECT_EQ(apart.rows[0][12], "1.0e-08");
  EXPECT_EQ(apart.rows[0][6], "0.0e+00");

  for (const bool missing : {true, false}) {
    post::Run other = chain("there", "LAMMPS 1");
    if (missing)
      other.events.clear();
    else
      other.events[0].time += 1e-6;
    EXPECT_EQ(post::engine_table(results({here, other})).states.at(0), post::RowState::differs) << missing;
  }
}

} // namespace engines

} // namespace of_page

} // namespace
} // namespace drumlin::test
