// A report made from direct solutions: its pages are strict XML, and every link leads to a file.
#include "tests/support/page.h"
#include "tests/support/run_folders.h"
#include "tests/support/tool.h"
#include "pages/html.h"
#include "report/report.h"
#include "chain/exact_solution.h"
#include "report/page.h"
#include "report/run_folder.h"
#include "support/text.h"
#include "support/usage_error.h"

#include <unistd.h>

namespace {

using namespace drumlin::post;
using namespace drumlin::test;
namespace fs = std::filesystem;

ReportOutcome report_of(const std::vector<fs::path> &folders, const fs::path &out) {
  ReportOptions options;
  options.folders = folders;
  options.out = out;
  return write_report(options);
}

/// Replaces a text in the parameters of a run.
void change_parameters(const fs::path &run, const std::string &from, const std::string &to) {
  std::string text = read_text(run / "parameters.csv");
  text.replace(text.find(from), from.size(), to);
  write_files({{run / "parameters.csv", text}});
}

void write(const fs::path &file, const std::string &text) { std::ofstream(file, std::ios::binary) << text; }

/// The report of all is drawn, others are sketched.
class Report : public WithSketches {
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
    outcome = report_of({root / "runs"}, root / "report");
    page = parse(read_text(outcome.page));
  }
  static void TearDownTestSuite() { fs::remove_all(root); }

  /// A run folder copied to `name`, to be damaged.
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
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(errors)};
  }

  /// Expects that the command fails with status 2 and one line with `words`, and that the earlier report is
  /// unchanged.
  static void expect_refusal(const std::string &arguments, const std::string &words,
                             const std::string &environment = "") {
    const std::string before = read_text(outcome.page);
    const auto [status, errors] = command(arguments, environment);
    EXPECT_EQ(status, 2) << errors;
    EXPECT_EQ(errors.rfind("ERROR: drumlin report: ", 0), 0u) << errors;
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
    EXPECT_TRUE(contains(errors, words));
    EXPECT_EQ(read_text(outcome.page), before);
    EXPECT_TRUE(fs::is_regular_file(root / "report" / "figures" / "fig5_case_II.png"));
    for (const fs::directory_entry &entry : fs::directory_iterator(root))
      EXPECT_NE(entry.path().filename().string().front(), '.') << "left over: " << entry.path();
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
  for (const std::vector<std::string> *all : {&page.images, &page.links, &page.resources, &page.contents})
    for (const std::string &address : *all) {
      EXPECT_FALSE(contains(address, "//"));
      EXPECT_FALSE(contains(address, "http"));
    }
  const std::string text = read_text(outcome.page);
  EXPECT_FALSE(contains(text, "url("));
  EXPECT_FALSE(contains(text, "@import"));
  for (const std::string &image : page.images) {
    const std::string picture = read_text(root / "report" / image);
    EXPECT_FALSE(contains(picture, "href=\"http")) << image;
    EXPECT_FALSE(contains(picture, "<script")) << image;
  }
}

TEST_F(Report, HasEveryPictureItShows) {
  // Figs. 5 and 8 in small; Figs. 3, 4, 5, 8, restitution, two orbits, roller force. (Exact runs have no
  // error to draw.)
  EXPECT_EQ(page.images.size(), 10u);
  for (const std::string &image : page.images) {
    const fs::path svg = root / "report" / image;
    ASSERT_TRUE(fs::is_regular_file(svg)) << svg;
    EXPECT_EQ(svg.extension(), ".svg");
    const Parsed drawing = parse(read_text(svg));
    EXPECT_TRUE(drawing.well_formed) << svg << drawing.error;
    fs::path png = svg;
    png.replace_extension(".png");
    const std::string bytes = read_text(png);
    EXPECT_GT(bytes.size(), 5000u) << png;
    EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n") << png;
    fs::path script = svg;
    script.replace_extension(".gp");
    EXPECT_TRUE(fs::is_regular_file(script));
  }
}

TEST_F(Report, HasDataWithUnitsForEveryFigure) {
  for (const std::string &image : page.images) {
    const std::string name = fs::path(image).stem().string();
    const fs::path csv = root / "report" / "data" / (name.substr(0, name.rfind("_key")) + ".csv");
    ASSERT_TRUE(fs::is_regular_file(csv)) << csv;
    const Table table = read_table(csv); // refuses ragged rows
    EXPECT_GT(table.rows(), 1u);
    for (const std::string &column : table.header()) {
      const bool words = column == "curve" || column == "case";
      EXPECT_TRUE(words || column.find(" (") != std::string::npos) << csv << ": " << column;
    }
  }
}

TEST_F(Report, HasEveryFileAndEveryPlaceThatItLinksTo) {
  EXPECT_GT(page.links.size(), 40u);
  for (const std::string &link : page.links) {
    const bool found = link.front() == '#'
                           ? page.ids.count(link.substr(1)) != 0
                           : fs::is_regular_file(root / "report" / drumlin::test::file_of(link));
    EXPECT_TRUE(found) << link;
  }
}

/// The opening paragraph of a page.
std::string opening(const std::string &text) {
  const std::size_t begin = text.find("<p class=\"verdict");
  return text.substr(begin, text.find("</p>", begin) - begin);
}

/// The number in `text` that the first group of a regular expression matches.
double number_in(const std::string &text, const std::string &expression) {
  std::smatch parts;
  if (std::regex_search(text, parts, std::regex(expression))) return std::stod(parts[1]);
  ADD_FAILURE() << expression << " is not in: " << text;
  return std::nan("");
}

TEST_F(Report, OpensWithTheAnswer) {
  const std::string text = read_text(outcome.page);
  EXPECT_EQ(text.find("<section"), text.find("<section id=\"answer\""));
  const std::string answer = opening(text);
  EXPECT_EQ(answer.rfind("<p class=\"verdict good\">✓", 0), 0u) << answer;
  EXPECT_TRUE(
      contains(answer, "2 runs of the chain soil – drum – frame (cases I and II) and 2 single impacts"));
  EXPECT_EQ(number_in(answer, "(\\d+) of 17 values agree"), 17.0);
  const Table restitution = read_table(root / "report" / "data" / "restitution.csv");
  for (std::size_t i = 0; i < restitution.rows(); ++i)
    EXPECT_NEAR(number_in(answer, "([0-9.]+) under " + restitution.text("transition")[i]),
                restitution.numbers("measured")[i], 0.51e-4);
  for (const char *key : {"figures/fig5_case_II_key.svg", "figures/fig8_dem_and_direct_key.svg"})
    EXPECT_LT(text.find(key), text.find("<h2>")) << key;
}

TEST_F(Report, OpensWithTheNumbersOfItsTables) {
  for (const Transition transition : {Transition::A, Transition::B})
    write_chain_run(root / "pair" / (transition == Transition::A ? "II-A" : "II-B"), "II", transition, 12);
  change_parameters(root / "pair" / "II-A", "D,0.5", "D,0.5000001"); // an error to show
  const std::string answer = opening(read_text(report_of({root / "pair"}, root / "pair-report").page));
  EXPECT_EQ(answer.rfind("<p class=\"verdict\">", 0), 0u) << "nothing was judged: " << answer;
  const Table checks = read_table(root / "pair-report/data/checks.csv");
  for (std::size_t i = 0; i < checks.rows(); ++i)
    if (checks.text("quantity")[i] == "contact force, max") {
      const std::string transition = checks.text("transition")[i];
      EXPECT_NEAR(number_in(answer, "([0-9.]+) kN under " + transition),
                  std::stod(checks.text("measured")[i]), 0.0051);
    }
  const Table errors = read_table(root / "pair-report/data/error_table.csv");
  const std::vector<double> last = errors.numbers("last 5 cycles (-)");
  EXPECT_EQ(number_in(answer, "by at most ([0-9.e-]+)"), *std::max_element(last.begin(), last.end()));
  EXPECT_TRUE(contains(answer, "II-A"));
}

TEST_F(Report, HasAContentsListThatStaysInView) {
  EXPECT_EQ(page.contents.front(), "#answer");
  const std::string text = read_text(outcome.page);
  std::vector<std::string> sections;
  const std::regex expression("<section id=\"([a-z]+)\"");
  for (std::sregex_iterator found(text.begin(), text.end(), expression), end; found != end; ++found)
    sections.push_back("#" + (*found)[1].str());
  EXPECT_EQ(page.contents, sections);
  EXPECT_TRUE(contains(text, "nav { position: sticky; top: 0;"));
  EXPECT_EQ(page.drawings, 1u) << "the scene";
}

TEST_F(Report, MarksTheRowsOfItsTables) {
  const std::string text = read_text(outcome.page);
  const std::regex row("<tr class=\"agrees[^>]*><td class=\"word\">✓ (to all digits|in tolerance)<");
  const auto rows =
      std::distance(std::sregex_iterator(text.begin(), text.end(), row), std::sregex_iterator());
  std::size_t judged = 0;
  for (const char *table : {"checks.csv", "restitution.csv"})
    judged += read_table(root / "report" / "data" / table).rows();
  EXPECT_EQ(judged, 17u);
  EXPECT_EQ(static_cast<std::size_t>(rows), judged);
  EXPECT_FALSE(contains(text, "✗"));
}

TEST_F(Report, HasItsCommandsAtTheEnd) {
  const std::string text = read_text(outcome.page);
  const std::size_t commands = text.find("id=\"commands\"");
  ASSERT_NE(commands, std::string::npos);
  EXPECT_GT(commands, text.rfind("<figure"));
  EXPECT_GT(commands, text.rfind("<table"));
  EXPECT_GT(text.find("id=\"versions\""), commands);
}

TEST_F(Report, TakesStudiesAlong) {
  const std::string text = read_text(outcome.page);
  for (const auto &[place, title] :
       {std::pair{"studies/study", "runs/more/study"}, {"studies/study-2", "runs/study"}}) {
    EXPECT_TRUE(fs::is_regular_file(root / "report" / place / "figures" / "f.svg")) << place;
    EXPECT_TRUE(
        contains(text, fmt::format("<a href=\"{}/index.html\">Cost of {} &amp; more</a>", place, title)));
  }
}

TEST_F(Report, IsMadeOfAStudyAlone) {
  const std::string text = read_text(report_of({root / "runs" / "study"}, root / "study-report").page);
  EXPECT_TRUE(parse(text).well_formed);
  EXPECT_TRUE(contains(text, "studies/study/index.html"));
}

TEST_F(Report, PrintsCommandsAsTextAndSaysWhatIsLeftOut) {
  const std::string text = read_text(outcome.page);
  EXPECT_TRUE(contains(
      text,
      {"<span>run</span> <span>&lt;in.chain&gt;</span> <span>&amp;</span> <span>&quot;more&quot;</span>",
       "Fig. 6 is left out", "cycles.csv lacks the energies"}));
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

TEST_F(Report, DoesNotJudgeAShortRunAndNamesTheCommandOfALongOne) {
  write_chain_run(root / "it's short", "I", Transition::B, 12);
  const ReportOutcome short_outcome = report_of({root / "it's short"}, root / "short-report");
  EXPECT_EQ(short_outcome.checks.all, 0u);
  EXPECT_EQ(short_outcome.checks.not_judged, 7u);
  const std::string text = read_text(short_outcome.page);
  EXPECT_TRUE(parse(text).well_formed);
  EXPECT_TRUE(contains(text, {"not judged (short run)", "7 values are not judged",
                              "Fig. 4  Drum acceleration, case I",
                              "With fewer than 100 cycles the motion may not be steady yet"}));
  EXPECT_FALSE(contains(text, "class=\"differs"));
  const std::string command = fmt::format(
      "./drumlin run inputs/chain/in.chain -var case I -var transition B -var steps_per_cycle 2000 "
      "-var samples_per_cycle 200 -var cycles 120 -var out {}",
      (fs::canonical(root) / "I-B-120-cycles").string());
  EXPECT_EQ(short_outcome.judging_commands, (std::vector<std::string>{command}));
  EXPECT_TRUE(contains(text, command));
  const std::string json = read_text(root / "short-report" / "report.json");
  EXPECT_TRUE(contains(json, "\"not_judged\": 7"));
  EXPECT_FALSE(contains(json, "\"agrees\": false"));
}

TEST_F(Report, NamesTheCyclesOfARunOfTwo) {
  write_chain_run(root / "two", "II", Transition::B, 2);
  const std::string text = read_text(report_of({root / "two"}, root / "two-report").page);
  EXPECT_TRUE(contains(text, {"Drum acceleration over the last 2 cycles, case II",
                              "Measured over the last 2 cycles", "Contact force over the last 2 cycles",
                              "Drum acceleration over the last 2 cycles under"}));
  for (const char *words : {"the last 3 cycles", "the last 10 cycles", "at steady state"})
    EXPECT_FALSE(contains(text, words));
}

TEST_F(Report, CountsEachKindOfWorkToAnEndThatIsKnown) {
  ReportOptions options;
  options.folders = {root / "runs" / "II-B", root / "runs" / "impact-A"};
  options.out = root / "counted-report";
  std::map<std::string, std::vector<std::pair<int, int>>> counts; // done and all, by kind of work
  options.progress = [&counts](const std::string &line) {
    std::smatch parts;
    ASSERT_TRUE(std::regex_match(line, parts, std::regex(R"((\w+) \[ *(\d+)/(\d+)\] .*)"))) << line;
    counts[parts[1]].emplace_back(std::stoi(parts[2]), std::stoi(parts[3]));
  };
  write_report(options);
  EXPECT_EQ(counts.size(), 2u);
  for (const auto &[kind, steps] : counts)
    for (std::size_t i = 0; i < steps.size(); ++i) {
      EXPECT_EQ(steps[i].first, static_cast<int>(i) + 1) << kind;
      EXPECT_EQ(steps[i].second, static_cast<int>(steps.size())) << kind;
    }
}

// Longer than other tests: it has a line for each name, and for each place where a name is shown.
TEST_F(Report, KeepsHostileNamesAsText) {
  draw();
  const std::vector<std::string> names = {"100%",
                                          "%s%n",
                                          "a\"b",
                                          "it's",
                                          "{}",
                                          "{0:d}",
                                          "b\\n\\",
                                          "x y",
                                          "`id`",
                                          "$(touch pwned)",
                                          "x;touch pwned;",
                                          "-x",
                                          "B[1]",
                                          "run(1)",
                                          "A&B",
                                          "<b>",
                                          "a#b?c",
                                          "bad\xff\xfe\xc3",
                                          "ctl\x01\x1b[1m",
                                          "new\nline",
                                          "^_@~",
                                          "\xef\xbf\xbf",
                                          std::string(200, 'w')};
  const fs::path hostile = root / "hostile";
  const fs::path seed = root / "seed";
  write_chain_run(seed, "II", Transition::B, 6);
  ReportOptions options;
  for (const std::string &name : names) {
    fs::create_directories(hostile / name);
    for (const char *file : {"chain.csv", "events.csv"})
      fs::copy(seed / file, hostile / name / file);
    std::string parameters = read_text(seed / "parameters.csv");
    parameters += csv_cell("note " + name) + "," + csv_cell(name) + "\n";
    parameters.replace(parameters.find("a test"), 6, csv_cell(name + " LAMMPS"));
    parameters.replace(parameters.find("D,0.5"), 5, "D,0.5000001"); // an error to draw
    write(hostile / name / "parameters.csv", parameters);
    options.folders.push_back(hostile / name);
    const fs::path study = hostile / "studies" / name;
    fs::create_directories(study);
    write(study / "study.txt", "drumlin\n");
    write(study / "index.html", "<html><title>Of " + html_escaped(name) + "</title></html>");
    options.folders.push_back(study);
  }
  options.out = hostile / "100% <{\"%s\xff'";
  const fs::path before = fs::current_path();
  fs::current_path(hostile);
  const ReportOutcome hostile_outcome = write_report(options);
  fs::current_path(before);
  const std::string text = read_text(hostile_outcome.page);
  EXPECT_EQ(text, valid_utf8(text));
  const Parsed shown = parse(text);
  EXPECT_TRUE(shown.well_formed) << shown.error;
  EXPECT_TRUE(contains(text, {"<td class=\"word\">100%</td>", "<td class=\"word\">%s%n</td>", "&lt;b&gt;",
                              "a&quot;b", "it&#39;s", "bad\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd"}));
  for (const std::string &link : shown.links)
    EXPECT_TRUE(link.front() == '#' || fs::is_regular_file(options.out / drumlin::test::file_of(link)))
        << link;
  for (const std::string &image : shown.images) {
    const Parsed drawing = parse(read_text(options.out / image));
    EXPECT_TRUE(drawing.well_formed) << image << drawing.error;
  }
  const std::string ticks = read_text(options.out / "figures" / "figR6_velocity_error.svg");
  EXPECT_TRUE(contains(ticks, {">100%<", ">%s%n<", ">{}<", ">x y<"}));
  for (const fs::path &place : {hostile, options.out / "figures", before})
    EXPECT_FALSE(fs::exists(place / "pwned")) << place;
}

TEST_F(Report, PrintsNoNumberThatIsNone) {
  draw();
  for (const auto &[name, parameter] :
       {std::pair{"no-force", &ChainParameters::Fw}, {"no-weight", &ChainParameters::g}}) {
    ChainParameters p = table1_case("II", Transition::B);
    p.*parameter = 0.0;
    ExactOptions solver;
    solver.cycles = 12;
    const ExactSolution result = solve_chain(p, solver);
    const fs::path folder = root / "none" / name;
    fs::create_directories(folder);
    write_files({{folder / "chain.csv", chain_text(result.history)}});
    write_files({{folder / "events.csv", events_text(result.events)}});
    // The energies and harmonics of a roller at rest are all zero.
    write(folder / "cycles.csv",
          "cycle,work_excitation,dissipated_contact,dissipated_bond,kinetic,potential,stored_contact,"
          "stored_bond,a1_cos,a1_sin,a2_cos,a2_sin,ah_cos,ah_sin\n"
          "0,0,0,0,0,0,0,0,0,0,0,0,0,0\n1,0,0,0,1,0,0,0,0,0,0,0,0,0\n2,0,0,0,1,0,0,0,0,0,0,0,0,0\n");
    std::vector<std::pair<std::string, std::string>> values = parameter_values(p);
    values = with(values, given("deck chain, case II, engine a test"));
    write_files({{folder / "parameters.csv", parameters_text(values)}});
  }
  // An impact whose mass turns away before it reaches the ball.
  write_impact_run(root / "none" / "miss", Transition::A, 2.0);
  write(root / "none" / "miss" / "chain.csv", "time,x_drum,v_drum,a_drum,F_contact,F_excitation\n"
                                              "0,1,-1,0,0,0\n0.001,0.999,-1,0,0,0\n0.002,0.998,-1,0,0,0\n");
  write(root / "none" / "miss" / "events.csv", "time,event,overlap,overlap_rate,force,id_i,id_j\n");
  const std::string text = read_text(report_of({root / "none"}, root / "none-report").page);
  EXPECT_TRUE(parse(text).well_formed);
  for (const char *word : {">nan", ">-nan", ">inf", ">-inf", " nan", " inf", "nan "})
    EXPECT_FALSE(contains(text, word));
  for (const fs::directory_entry &data : fs::directory_iterator(root / "none-report" / "data")) {
    const std::string cells = read_text(data.path());
    EXPECT_FALSE(contains(cells, ",nan")) << data.path();
    EXPECT_FALSE(contains(cells, ",-nan")) << data.path();
    EXPECT_FALSE(contains(cells, ",inf")) << data.path();
    EXPECT_FALSE(contains(cells, ",-inf")) << data.path();
  }
  EXPECT_TRUE(contains(text, {"the mass does not reach the ball within the record", "Fig. 3 is left out"}));
}

TEST_F(Report, GivesThePapersTitlesToThePapersParametersOnly) {
  write_chain_run(root / "own", "II", Transition::B, 12);
  change_parameters(root / "own", "m2,2000", "m2,2100");
  const std::string text = read_text(report_of({root / "own"}, root / "own-report").page);
  EXPECT_TRUE(contains(text, {"own parameters after case II", "m2 = 2100, case II has 2000"}));
  EXPECT_FALSE(contains(text, "fig5_case_II"));
  EXPECT_TRUE(contains(text, "own_after_case_II.svg"));
  const std::string page_of_paper = read_text(outcome.page);
  EXPECT_FALSE(contains(page_of_paper, "own parameters"));
}

TEST_F(Report, ClearsAwayWhatAKilledReportLeft) {
  const fs::path place = root / "killed" / "a report";
  const auto in_folder = [&](const std::string &name) { return root / "killed" / name; };
  const fs::path half = in_folder(".a report.new-123.0"), earlier = in_folder(".a report.new-1");
  const fs::path old = in_folder(".a report.old-123");
  const fs::path other = in_folder(".another.new-123.0"), own = in_folder(".a report.new-thesis");
  const fs::path file = in_folder(".a report.new-1230000000");
  for (const fs::path &folder : {half, earlier, old, other, own})
    fs::create_directories(folder / "figures");
  write(file, "of no report");
  write(old / "report.json", "{}");
  write(old / "thesis.txt", "years");
  // Killed between its two renames: the next call restores the earlier report, also if this call fails.
  write(root / "killed" / "gnuplot", "#!/bin/sh\nexit 1\n");
  fs::permissions(root / "killed" / "gnuplot", fs::perms::owner_all);
  const auto [status, errors] =
      command(quote(root / "runs" / "I-A") + " --out " + quote(place), "PATH=" + quote(root / "killed"));
  EXPECT_EQ(status, 1) << errors;
  EXPECT_TRUE(fs::is_regular_file(place / "thesis.txt"));
  report_of({root / "runs" / "I-A"}, place);
  EXPECT_TRUE(fs::is_regular_file(place / "index.html"));
  for (const fs::path &folder : {half, earlier, old})
    EXPECT_FALSE(fs::exists(folder)) << folder;
  for (const fs::path &kept : {other, own, file})
    EXPECT_TRUE(fs::exists(kept)) << kept;
}

TEST_F(Report, DoesWithoutOptionalFiles) {
  const fs::path bare = copy("bare");
  fs::remove(bare / "events.csv");
  fs::remove(bare / "cycles.csv");
  const fs::path nameless = copy("nameless");
  fs::remove(nameless / "parameters.csv");
  const std::string text = read_text(report_of({bare, nameless}, root / "bare-report").page);
  EXPECT_TRUE(parse(text).well_formed);
  EXPECT_TRUE(
      contains(text, {"events.csv is missing", "cycles.csv is missing", "parameters.csv is missing"}));
}

TEST_F(Report, RefusesFoldersThatAreNoRuns) {
  expect_refusal(quote(root / "nowhere") + " " + out(), "nowhere");
  fs::create_directories(root / "empty");
  expect_refusal(quote(root / "empty") + " " + out(), "has neither chain.csv, bed.csv, ");
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
  change_parameters(wrong, "transition,B", "transition,C");
  expect_refusal(quote(wrong) + " " + out(), "'C'");
}

// Beside a run that is whole: one whose table was cut within a row, an earlier report, and what an
// interrupted one left. A run that was killed, or goes on, counts up to its last whole row.
TEST_F(Report, LeavesOutWhatCannotBeRead) {
  const fs::path mixed = root / "mixed";
  fs::remove_all(mixed);
  fs::create_directories(mixed);
  for (const char *name : {"whole", "half", "killed"})
    fs::copy(root / "runs" / "II-B", mixed / name);
  for (const char *name : {"half", "killed"})
    fs::resize_file(mixed / name / "chain.csv", fs::file_size(mixed / name / "chain.csv") - 60);
  fs::resize_file(mixed / "killed/events.csv", fs::file_size(mixed / "killed/events.csv") - 9);
  change_parameters(mixed / "killed", "ended,yes", "ended,no");
  fs::copy(root / "report", mixed / "last week", fs::copy_options::recursive);
  fs::copy(root / "report", mixed / ".half.new-1", fs::copy_options::recursive);
  fs::remove(mixed / ".half.new-1/report.json");
  write(mixed / ".half.new-1/data/oedometer.csv", "stress_kPa\n");
  fs::create_directories(mixed / "no table");
  fs::copy_file(mixed / "killed/parameters.csv", mixed / "no table/parameters.csv");
  const ReportOutcome made = report_of({mixed}, root / "mixed-report");
  EXPECT_GT(made.checks.all, 0u); // those of the run that is whole
  ASSERT_EQ(made.left_out.size(), 3u);
  std::map<std::string, std::string> why;
  for (const LeftOut &folder : made.left_out)
    why[folder.folder.filename().string()] = folder.why;
  EXPECT_EQ(why["last week"], "it is an earlier report");
  EXPECT_TRUE(contains(why["half"], "chain.csv"));
  EXPECT_EQ(why["no table"], "it was killed, or is still running");
  const std::string text = read_text(made.page);
  EXPECT_TRUE(parse(text).well_formed);
  EXPECT_TRUE(
      contains(text, {"3 folders are left out, and not judged", "last week</code>: it is an earlier report",
                      "not judged: it was killed, or is still running."}));
}

TEST_F(Report, DoesNotJudgeARunThatWasCut) {
  for (const auto &[row, says] :
       {std::pair{"ended,no\n", "not judged: it was killed, or is still running."},
        {"ended,\"drumlin/run: stopped at step 5 of 9, here\"\n",
         "not judged: it was cut: drumlin/run: stopped at step 5 of 9, here."},
        {"", "not judged: its parameters.csv does not say whether it has ended, "}}) {
    fs::remove_all(root / "cut");
    fs::create_directories(root / "cut");
    for (const char *name : {"II-B", "I-A", "impact-B"}) {
      fs::copy(root / "runs" / name, root / "cut" / name);
      change_parameters(root / "cut" / name, "ended,yes\n", row);
    }
    const ReportOutcome made = report_of({root / "cut"}, root / "cut-report");
    EXPECT_EQ(made.checks.all, 0u) << row;
    EXPECT_GT(made.checks.not_judged, 10u) << row;
    const std::string text = read_text(made.page);
    EXPECT_TRUE(parse(text).well_formed);
    EXPECT_TRUE(contains(text, {says, " (cut)"}));
    for (const char *verdict :
         {"verdict good", "verdict bad", "<tr class=\"agrees\"", "<tr class=\"differs\""})
      EXPECT_FALSE(contains(text, verdict))
          << row << text.substr(std::min(text.size(), text.find(verdict)), 300);
  }
}

TEST_F(Report, RefusesToReplaceWhatItReads) {
  const fs::path place = root / "earlier";
  fs::remove_all(place);
  fs::copy(root / "report", place, fs::copy_options::recursive);
  const fs::path run = copy("linked");
  fs::rename(run / "chain.csv", place / "data/mine.csv");
  fs::create_symlink(place / "data/mine.csv", run / "chain.csv");
  expect_refusal(quote(run) + " --out " + quote(place), "chain.csv that is to be reported on");
  EXPECT_TRUE(fs::exists(place / "data/mine.csv"));
}

TEST_F(Report, NamesThePackageOfAMissingGnuplot) {
  expect_refusal(quote(root / "runs") + " " + out(), "gnuplot-nox", "PATH=/nonexistent");
}

TEST(Names, AreTheShortestTailsThatDiffer) {
  const Scratch scratch;
  const fs::path &root = scratch.path();
  for (const char *name : {"stock/II-B", "second/II-B"})
    fs::create_directories(root / name);
  std::vector<drumlin::post::Run> runs(2);
  runs[0].folder = root / "stock" / "II-B";
  runs[1].folder = root / "second" / "II-B";
  name_runs(runs);
  EXPECT_EQ(runs[0].name, "stock/II-B");
  EXPECT_EQ(runs[1].name, "second/II-B");
}

TEST(Text, IsMadeUtf8) {
  EXPECT_EQ(valid_utf8("µ\n"), "µ\n");
  EXPECT_EQ(valid_utf8("a\xffz"), "a\xef\xbf\xbdz");
  EXPECT_EQ(valid_utf8("\xef\xbf\xbe"), "\xef\xbf\xbd");
}

TEST(Text, IsShortenedByWholeLetters) {
  EXPECT_EQ(shortened("µµµµµ", 5), "µµµµµ");
  EXPECT_EQ(shortened("µµ1234µµ", 5), "µµ…µµ");
}

TEST(Text, IsOneWordOfAShell) {
  EXPECT_EQ(shell_word("results/B-1"), "results/B-1");
  for (const char *text : {"", "a b", "it's", "$(id)", "`id`", "*", "a\nb", "\\", "~", "!"}) {
    const std::string line = "printf %s " + shell_word(text);
    const std::unique_ptr<std::FILE, int (*)(std::FILE *)> pipe(::popen(line.c_str(), "r"), &::pclose);
    std::string printed;
    for (int c = std::fgetc(pipe.get()); c != EOF; c = std::fgetc(pipe.get()))
      printed += static_cast<char>(c);
    EXPECT_EQ(printed, text);
  }
}

TEST(Text, IsALink) { EXPECT_EQ(link_to("a b/100%#?\xff"), "a%20b/100%25%23%3F%FF"); }

TEST(Html, IsUnescaped) {
  const std::string text = "a<b>&\"c'&lt;&x;";
  EXPECT_EQ(html_unescaped(html_escaped(text)), text);
}

TEST(Html, EscapesWhatXmlForbids) { EXPECT_EQ(html_escaped("a<b>&\"c'\x01"), "a&lt;b&gt;&amp;&quot;c&#39;"); }

} // namespace
