// The reports of chains: drums with two ends, and two engines compared.
#include "tests/support/checks.h"
#include "tests/support/page.h"
#include "tests/support/tool.h"

#include "report/chain/ends_page.h"
#include "report/chain/engine_comparison.h"
#include "report/report.h"
#include "report/run_folder.h"
#include "runs/chain_files.h"
#include "support/csv.h"
#include "support/files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <map>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

namespace {

using namespace drumlin;
using namespace drumlin::post;
using namespace drumlin::test;

// The report of drums with two ends: its numbers against complex algebra and against the history of a run,
// its pages as strict XML.
namespace ends {

namespace fs = std::filesystem;

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

} // namespace
