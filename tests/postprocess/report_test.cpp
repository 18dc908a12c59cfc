// A report made from direct solutions, as a reader meets it: strictly parsed, every file followed.
#include "report.h"

#include "chain_csv.h"
#include "command.h"
#include "direct_solver.h"
#include "report_html.h"
#include "report_runs.h"
#include "page.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>

namespace {

using namespace drumlin::post;
using drumlin::test::parse;
using drumlin::test::Parsed;
namespace fs = std::filesystem;

std::string read(const fs::path &file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void write(const fs::path &file, const std::string &text) { std::ofstream(file, std::ios::binary) << text; }

/// A folder as an engine run of the chain leaves it; what it holds is the direct solution.
void write_chain_run(const fs::path &folder, const std::string &case_name, Transition transition, int cycles,
                     const std::string &command = "drumlin run in.chain") {
  const ChainParameters p = table1_case(case_name, transition);
  DirectOptions options;
  options.cycles = cycles;
  const DirectResult result = solve_direct(p, options);
  fs::create_directories(folder);
  write_chain(folder / "chain.csv", result.history);
  write_events(folder / "events.csv", result.events);
  write_cycles(folder / "cycles.csv", result.cycles);
  std::vector<std::pair<std::string, std::string>> values = parameter_values(p);
  values.insert(values.end(), {{"deck", "chain"},
                               {"case", case_name},
                               {"stepping", "none"},
                               {"steps_per_cycle", "2000"},
                               {"timestep", number_text(p.period() / 2000)},
                               {"engine", "a test"},
                               {"command", command}});
  write_parameters(folder / "parameters.csv", values);
}

/// A folder as the impact deck leaves it, from the closed form.
void write_impact_run(const fs::path &folder, Transition transition, double damping_ratio) {
  ImpactParameters p;
  p.transition = transition;
  p.damping_ratio = damping_ratio;
  const double duration = impact_duration(p);
  const ImpactState last = impact_state(p, duration);
  fs::create_directories(folder);
  std::string text = "time,x_drum,v_drum,a_drum,F_contact,F_excitation\n";
  for (int i = 0; i <= 300; ++i) {
    const double t = 1.5 * duration * i / 300;
    ImpactState s = impact_state(p, t);
    if (t >= duration) s = {last.overlap + last.rate * (t - duration), last.rate, 0.0};
    text += fmt::format("{},{},{},{},{},0\n", t, -s.overlap, -s.rate, s.force / p.mass, s.force);
  }
  write(folder / "chain.csv", text);
  write(folder / "events.csv",
        fmt::format(
            "time,event,overlap,overlap_rate,force,id_i,id_j\n0,make,0,{},{},1,2\n{},break,{},{},{},1,2\n",
            p.speed, impact_state(p, 0).force, duration, last.overlap, last.rate,
            transition == Transition::A ? last.force : 0.0));
  write_parameters(folder / "parameters.csv", {{"deck", "impact"},
                                               {"transition", transition_name(transition)},
                                               {"k", number_text(p.stiffness)},
                                               {"D", number_text(p.damping_ratio)},
                                               {"m2", number_text(p.mass)},
                                               {"speed", number_text(p.speed)},
                                               {"steps_per_contact", "200"}});
}

class Report : public ::testing::Test {
protected:
  static void SetUpTestSuite() {
    root = fs::temp_directory_path() / fmt::format("drumlin-report-{}", ::getpid());
    fs::remove_all(root);
    write_chain_run(root / "runs" / "II-B", "II", Transition::B, 110, "drumlin run <in.chain> & \"more\"");
    write_chain_run(root / "runs" / "I-A", "I", Transition::A, 110);
    write_impact_run(root / "runs" / "impact-A", Transition::A, 0.5);
    write_impact_run(root / "runs" / "impact-B", Transition::B, 0.5);
    // A study has a chain.csv of its own, which is no run.
    for (const char *name : {"runs/study", "runs/more/study"}) {
      fs::create_directories(root / name / "figures");
      write(root / name / "study.txt", "drumlin\n");
      write(root / name / "index.html",
            fmt::format("<html><title>Cost of {} &amp; more</title></html>", name));
      write(root / name / "chain.csv", "case,steps_per_cycle\nI,50\n");
      write(root / name / "figures" / "f.svg", "<svg/>");
    }
    ReportOptions options;
    options.folders = {root / "runs"};
    options.out = root / "report";
    outcome = write_report(options);
    page = parse(read(root / "report" / "index.html"));
  }
  static void TearDownTestSuite() { fs::remove_all(root); }

  /// A run folder copied to `name`, to be spoilt.
  static fs::path copy(const std::string &name) {
    fs::path to = root / name;
    fs::remove_all(to);
    fs::copy(root / "runs" / "II-B", to);
    return to;
  }

  /// `drumlin-tools report ARGUMENTS`: exit status and what came on standard error.
  static std::pair<int, std::string> command(const std::string &arguments,
                                             const std::string &environment = "") {
    const fs::path errors = root / "stderr";
    const std::string line = fmt::format("{} '{}' report {} >/dev/null 2>'{}'", environment, DRUMLIN_TOOLS,
                                         arguments, errors.string());
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(errors)};
  }

  /// The command fails with status 2 and one line holding `words`; the report made before is as it was.
  static void expect_refusal(const std::string &arguments, const std::string &words,
                             const std::string &environment = "") {
    const std::string before = read(root / "report" / "index.html");
    const auto [status, errors] = command(arguments, environment);
    EXPECT_EQ(status, 2) << errors;
    EXPECT_EQ(errors.rfind("ERROR: drumlin report: ", 0), 0u) << errors;
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
    EXPECT_NE(errors.find(words), std::string::npos) << errors;
    EXPECT_EQ(read(root / "report" / "index.html"), before);
    EXPECT_TRUE(fs::is_regular_file(root / "report" / "figures" / "fig5_case_II.png"));
    for (const fs::directory_entry &entry : fs::directory_iterator(root))
      EXPECT_NE(entry.path().filename().string().front(), '.') << "left behind: " << entry.path();
  }

  static std::string out() { return "--out '" + (root / "report").string() + "'"; }
  static std::string quote(const fs::path &path) { return "'" + path.string() + "'"; }

  static fs::path root;
  static ReportOutcome outcome;
  static Parsed page;
};
fs::path Report::root;
ReportOutcome Report::outcome;
Parsed Report::page;

TEST_F(Report, IsWellFormed) {
  EXPECT_TRUE(page.well_formed) << page.error;
  EXPECT_EQ(page.doubled_ids, 0u);
  EXPECT_EQ(page.scripts, 0u);
}

TEST_F(Report, LoadsNothingFromTheNetwork) {
  for (const std::vector<std::string> *all : {&page.images, &page.links, &page.resources})
    for (const std::string &address : *all) {
      EXPECT_EQ(address.find("//"), std::string::npos) << address;
      EXPECT_EQ(address.find("http"), std::string::npos) << address;
    }
  const std::string text = read(root / "report" / "index.html");
  EXPECT_EQ(text.find("url("), std::string::npos);
  EXPECT_EQ(text.find("@import"), std::string::npos);
  for (const std::string &image : page.images) {
    const std::string picture = read(root / "report" / image);
    EXPECT_EQ(picture.find("href=\"http"), std::string::npos) << image;
    EXPECT_EQ(picture.find("<script"), std::string::npos) << image;
  }
}

TEST_F(Report, HasEveryPictureItShows) {
  // Figs. 3, 4, 5, 8, restitution, two orbits, roller force. (Exact runs have no error to draw.)
  EXPECT_EQ(page.images.size(), 8u);
  for (const std::string &image : page.images) {
    const fs::path svg = root / "report" / image;
    ASSERT_TRUE(fs::is_regular_file(svg)) << svg;
    EXPECT_EQ(svg.extension(), ".svg");
    const Parsed drawing = parse(read(svg));
    EXPECT_TRUE(drawing.well_formed) << svg << drawing.error;
    fs::path png = svg;
    png.replace_extension(".png");
    const std::string bytes = read(png);
    EXPECT_GT(bytes.size(), 5000u) << png;
    EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n") << png;
    fs::path script = svg;
    script.replace_extension(".gp");
    EXPECT_TRUE(fs::is_regular_file(script));
  }
}

TEST_F(Report, HasDataWithUnitsBesideEveryFigure) {
  for (const std::string &image : page.images) {
    const fs::path csv = root / "report" / "data" / (fs::path(image).stem().string() + ".csv");
    ASSERT_TRUE(fs::is_regular_file(csv)) << csv;
    const Table table = read_table(csv); // refuses ragged rows
    EXPECT_GT(table.rows(), 1u);
    for (const std::string &name : table.header()) {
      const bool words = name == "curve" || name == "case";
      EXPECT_TRUE(words || name.find(" (") != std::string::npos) << csv << ": " << name;
    }
  }
}

TEST_F(Report, HasEveryFileAndEveryPlaceThatItLinksTo) {
  EXPECT_GT(page.links.size(), 40u);
  for (const std::string &link : page.links) {
    const bool found = link.front() == '#' ? page.ids.count(link.substr(1)) != 0
                                           : fs::is_regular_file(root / "report" / link);
    EXPECT_TRUE(found) << link;
  }
}

TEST_F(Report, TakesStudiesAlong) {
  const std::string text = read(root / "report" / "index.html");
  for (const auto &[place, title] :
       {std::pair{"studies/study", "runs/more/study"}, {"studies/study-2", "runs/study"}}) {
    EXPECT_TRUE(fs::is_regular_file(root / "report" / place / "figures" / "f.svg")) << place;
    EXPECT_NE(text.find(fmt::format("<a href=\"{}/index.html\">Cost of {} &amp; more</a>", place, title)),
              std::string::npos);
  }
}

TEST_F(Report, IsMadeOfAStudyAlone) {
  ReportOptions options;
  options.folders = {root / "runs" / "study"};
  options.out = root / "study-report";
  const std::string text = read(write_report(options).page);
  EXPECT_TRUE(parse(text).well_formed);
  EXPECT_NE(text.find("studies/study/index.html"), std::string::npos);
}

TEST_F(Report, PrintsCommandsAsTextAndSaysWhatIsLeftOut) {
  const std::string text = read(root / "report" / "index.html");
  EXPECT_NE(
      text.find(
          "<span>run</span> <span>&lt;in.chain&gt;</span> <span>&amp;</span> <span>&quot;more&quot;</span>"),
      std::string::npos);
  EXPECT_NE(text.find("Fig. 6 is left out"), std::string::npos);
  EXPECT_NE(text.find("cycles.csv lacks the energies"), std::string::npos);
}

TEST_F(Report, OfTheDirectSolutionAgreesWithEveryReferenceValue) {
  // I A: 7, II B: 8, two impacts.
  EXPECT_EQ(outcome.checks.all, 17u);
  EXPECT_EQ(outcome.checks.agree, 17u);
  const Table checks = read_table(root / "report" / "data" / "checks.csv");
  EXPECT_EQ(checks.rows(), 15u);
  for (const std::string &agrees : checks.text("agrees"))
    EXPECT_NE(agrees, "no");
}

TEST_F(Report, TellsOfAShortRun) {
  write_chain_run(root / "short", "I", Transition::B, 12);
  ReportOptions options;
  options.folders = {root / "short"};
  options.out = root / "short-report";
  const ReportOutcome short_outcome = write_report(options);
  EXPECT_NE(read(short_outcome.page).find("(short run)"), std::string::npos);
  EXPECT_TRUE(parse(read(short_outcome.page)).well_formed);
}

TEST_F(Report, DoesWithoutOptionalFiles) {
  const fs::path bare = copy("bare");
  fs::remove(bare / "events.csv");
  fs::remove(bare / "cycles.csv");
  const fs::path nameless = copy("nameless");
  fs::remove(nameless / "parameters.csv");
  ReportOptions options;
  options.folders = {bare, nameless};
  options.out = root / "bare-report";
  const std::string text = read(write_report(options).page);
  EXPECT_TRUE(parse(text).well_formed);
  EXPECT_NE(text.find("events.csv is missing"), std::string::npos);
  EXPECT_NE(text.find("cycles.csv is missing"), std::string::npos);
  EXPECT_NE(text.find("parameters.csv is missing"), std::string::npos);
}

TEST_F(Report, ReplacesAnEarlierReportAsAWhole) {
  const fs::path place = root / "again";
  ReportOptions options;
  options.folders = {root / "runs" / "I-A"};
  options.out = place;
  write_report(options);
  write(place / "data" / "stale.csv", "x\n");
  write_report(options);
  EXPECT_FALSE(fs::exists(place / "data" / "stale.csv"));
  EXPECT_TRUE(fs::exists(place / "index.html"));
}

TEST_F(Report, RefusesFoldersThatAreNoRuns) {
  expect_refusal(quote(root / "nowhere") + " " + out(), "nowhere");
  fs::create_directories(root / "empty");
  expect_refusal(quote(root / "empty") + " " + out(), "no chain.csv");
  expect_refusal(out(), "dir");
}

TEST_F(Report, RefusesFilesThatItCannotRead) {
  const fs::path broken = copy("broken");
  write(broken / "chain.csv", "time,x_drum\n0,what\n");
  expect_refusal(quote(broken) + " " + out(), "chain.csv");
  const fs::path unequal = copy("broken");
  write(unequal / "cycles.csv", "cycle,a_drum_min\n1\n");
  expect_refusal(quote(unequal) + " " + out(), "cycles.csv");
  const fs::path wrong = copy("broken");
  std::string text = read(wrong / "parameters.csv");
  text.replace(text.find("transition,B"), 12, "transition,C");
  write(wrong / "parameters.csv", text);
  expect_refusal(quote(wrong) + " " + out(), "'C'");
}

TEST_F(Report, RefusesToReplaceWhatIsNoReport) {
  fs::create_directories(root / "mine");
  write(root / "mine" / "thesis.txt", "years\n");
  expect_refusal(quote(root / "runs") + " --out " + quote(root / "mine"), "holds other files");
  EXPECT_EQ(read(root / "mine" / "thesis.txt"), "years\n");
  expect_refusal(quote(root / "runs") + " --out " + quote(root / "mine" / "thesis.txt"), "is not a folder");
}

TEST_F(Report, NamesThePackageOfAMissingGnuplot) {
  expect_refusal(quote(root / "runs") + " " + out(), "gnuplot-nox", "PATH=/nonexistent");
}

TEST(Names, AreTheShortestTailsThatDiffer) {
  const fs::path root = fs::temp_directory_path() / fmt::format("drumlin-names-{}", ::getpid());
  for (const char *name : {"stock/II-B", "second/II-B"})
    fs::create_directories(root / name);
  std::vector<drumlin::post::Run> runs(2);
  runs[0].folder = root / "stock" / "II-B";
  runs[1].folder = root / "second" / "II-B";
  name_runs(runs);
  EXPECT_EQ(runs[0].name, "stock/II-B");
  EXPECT_EQ(runs[1].name, "second/II-B");
  fs::remove_all(root);
}

TEST(Html, EscapesWhatXmlForbids) { EXPECT_EQ(html_escaped("a<b>&\"c'\x01"), "a&lt;b&gt;&amp;&quot;c&#39;"); }

} // namespace
