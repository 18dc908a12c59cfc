// The report of bed runs: its numbers against those worked out by hand from small records, its pages as
// strict XML.
#include "tests/support/run_folders.h"
#include "tests/support/page.h"
#include "tests/support/tool.h"
#include "report/bed/page.h"
#include "bed/relative_density.h"
#include "chain/exact_solution.h"
#include "report/answer.h"
#include "report/bed/figures.h"
#include "report/bed/measures.h"
#include "report/report.h"
#include "support/usage_error.h"

namespace {

using namespace drumlin::post;
using namespace drumlin::test;
namespace test = drumlin::test;
namespace fs = std::filesystem;

/// Six cycles at 20 Hz, of which the last four are steady.
class BedReport : public WithSketches {
protected:
  BedReport() {
    write_run("A", Transition::A);
    write_run("B", Transition::B);
  }

  void put(const std::string &file, const std::string &text) const {
    fs::create_directories((root / file).parent_path());
    std::ofstream(root / file) << text;
  }

  void write_run(const std::string &name, Transition transition, int cycles = 6,
                 const std::string &friction = "0.5") const {
    test::write_bed_run(root / name, transition, cycles, friction);
  }

  void write_dumps(const std::string &name) const { test::write_bed_dumps(root / name); }

  /// Dumps of eight discs of 1 m one above the other, which carry a drum 4 m wide.
  void write_column(const std::string &name, double force) const {
    std::string places, zeros, ids, types, radii, masses, contacts;
    for (int n = 1; n <= 9; ++n) {
      places += fmt::format("2 {} 0 ", n < 9 ? n - 0.5 : 10.0);
      zeros += "0 0 0 ";
      ids += fmt::format("{} ", n);
      types += n < 9 ? "1 " : "2 ";
      radii += n < 9 ? "0.5 " : "2 ";
      masses += "1 ";
      if (n < 9) contacts += fmt::format("{} {} 0 -{} 0 0 -1 0 1e-9\n", n, n + 1, force);
    }
    const std::vector<test::Array> arrays = {{"id", 1, ids},      {"type", 1, types}, {"radius", 1, radii},
                                             {"mass", 1, masses}, {"v", 3, zeros},    {"omega", 3, zeros},
                                             {"f", 3, zeros}};
    for (const char *step : {"0", "700", "800"}) {
      put(fmt::format("{}/dump/balls_{}.vtp", name, step), test::point_data(9, places, arrays));
      put(fmt::format("{}/dump/contacts_{}.dump", name, step), test::contact_dump(contacts));
    }
  }

  /// A run as B on a bed of another seed.
  void write_another_seed(const std::string &name, const std::string &d50) const {
    write_run(name, Transition::B);
    std::string parameters = read_text(root / name / "parameters.csv");
    parameters.replace(parameters.find("start,"), 6, "start," + name);
    parameters.replace(parameters.find("d50,0.0301"), 10, "d50," + d50);
    put(name + "/parameters.csv", parameters + "out,results/" + name + "\n");
  }

  BedResult result(const std::string &name) const {
    auto run = drumlin::post::read_run(root / name);
    run.name = name;
    return analyse_bed(std::move(run));
  }

  fs::path report(const std::vector<std::string> &names) const {
    ReportOptions options;
    for (const std::string &name : names)
      options.folders.push_back(root / name);
    options.out = root / "report";
    write_report(options);
    return options.out;
  }

  /// Expects that the report is refused with one line that has the words, and that an earlier report stays.
  void expect_refusal(const std::vector<std::string> &names, const std::vector<std::string> &words) const {
    const std::string error = error_of<UsageError>([&] { report(names); });
    EXPECT_TRUE(contains(error, words));
    EXPECT_FALSE(contains(error, "\n"));
  }

  const Scratch scratch_;
  const fs::path root = scratch_.path();
};

TEST_F(BedReport, MeasuresWhatTheRecordsSay) {
  const BedMeasures m = result("A").measures;
  EXPECT_EQ(m.cycles, 6);
  EXPECT_EQ(m.steady_count, 4);
  EXPECT_DOUBLE_EQ(m.extremes.acceleration.max, 16.0); // not the 99 of cycle 1
  EXPECT_DOUBLE_EQ(m.extremes.force.max, 6000.0);      // not those of cycle 2
  EXPECT_DOUBLE_EQ(m.extremes.force.min, -600.0);
  EXPECT_DOUBLE_EQ(m.contact_share, 0.75);
  EXPECT_DOUBLE_EQ(m.settlement, 0.036);
  EXPECT_DOUBLE_EQ(m.settlement_per_cycle, (0.036 - 0.004) / 4.0);
  ASSERT_TRUE(m.amplitudes);
  EXPECT_DOUBLE_EQ(compaction_meter_value(*m.amplitudes), 300.0 * 0.5 / 5.0);
  EXPECT_DOUBLE_EQ(m.imbalance_percent, 9.0); // of 100 J: 7 - 20 + 3 + 120 - 100 = 10 J, 1 J at the start
  EXPECT_DOUBLE_EQ(m.coordination_start, 3.3);
  EXPECT_DOUBLE_EQ(m.coordination_end, 5.0); // 1 to 9
  EXPECT_DOUBLE_EQ(m.void_ratio_start, 0.25);
  EXPECT_NEAR(m.void_ratio_end, 0.2, 1e-15);
}

TEST_F(BedReport, MeasuresAnEvenNumberOfCycles) {
  for (const auto &[cycles, steady] : {std::pair{1, 1}, {2, 2}, {3, 2}, {5, 2}, {7, 4}, {10, 6}, {40, 10}}) {
    write_run("some", Transition::B, cycles);
    EXPECT_EQ(result("some").measures.steady_count, steady) << cycles;
    EXPECT_EQ(result("some").measures.amplitudes.has_value(), cycles > 1) << cycles;
  }
}

// A signal or a limit of time has stopped it: its measures are those of the cycles that it has.
TEST_F(BedReport, MarksAPartialRun) {
  const std::string partial = "a partial run, 6 of 10 cycles: it was stopped, or is not done yet.";
  const auto told = [this, &partial] {
    const std::vector<std::string> missing = result("A").run.missing;
    return std::count(missing.begin(), missing.end(), partial);
  };
  EXPECT_EQ(told(), 0);
  std::ofstream(root / "A/parameters.csv", std::ios::app) << "cycles,10\n";
  EXPECT_EQ(told(), 1);
  EXPECT_TRUE(contains(read_text(report({"A", "B"}) / "bed.html"), "A: " + partial));
}

TEST_F(BedReport, PrintsTheMeasures) {
  const std::vector<PageTable> tables = bed_tables({result("B")});
  const std::vector<std::vector<std::string>> rows = {
      {"B", "B", "0.5", "2", "20", "6", "3 to 6", "16", "6.0", "-0.60", "0.75", "30", "second", "800"},
      {"B", "B", "36", "8.0", "3.3", "5.0", "0.25", "-0.050", "9.0", "3.0"}};
  ASSERT_EQ(tables.size(), rows.size());
  for (std::size_t t = 0; t < rows.size(); ++t) {
    ASSERT_EQ(tables[t].rows.size(), 1u);
    EXPECT_EQ(tables[t].rows[0].size(), tables[t].header.size());
    for (std::size_t i = 0; i < rows[t].size(); ++i)
      EXPECT_EQ(tables[t].rows[0][i], rows[t][i]) << tables[t].header[i];
  }
}

TEST_F(BedReport, OpensWithTheNumbersOfItsTables) {
  write_dumps("A");
  const fs::path out = report({"A", "B"});
  // The energy error of the records is 9 % of the work, which is not good.
  const std::string words =
      "<p class=\"verdict bad\">✗ <strong>Bed.</strong> Settlement and change of density of a bed are not "
      "those of a site; forces, accelerations and stiffness count as means over several beds. A roller on 2 "
      "balls (B and A): drum 2000 kg/m, frame 1000 kg/m, exciter 58.8 kN/m at 20 Hz. After 6 cycles the drum "
      "has settled by 36 mm (mean over the "
      "last cycle); the largest contact force on it in the last 4 cycles is 6.0 kN/m. One bed is one sample: "
      "beds that differ in their seed alone scatter by 18 % in the largest force and acceleration, by 14 % "
      "in the share of contact and by 3.3 mm in the settlement of a cycle (standard deviations over five "
      "beds of case gravel in two dimensions, inputs/study/fidelity/findings.md). The void ratio of the bed, "
      "at first 0.25, changes by -0.050, the number of contacts per ball, at first 3.3, by 1.7. The energy "
      "error, a check of the integration alone, is 9.0 % of the exciter&#39;s work.";
  for (const char *page : {"index.html", "bed.html"})
    EXPECT_TRUE(contains(read_text(out / page), words)) << page << read_text(out / page).substr(6000, 2500);
  const std::string text = read_text(out / "bed.html");
  const std::size_t commands = text.find("id=\"commands\"");
  EXPECT_GT(commands, text.rfind("<figure"));
  EXPECT_GT(commands, text.rfind("<table"));
  EXPECT_LT(text.find("figures/bed1_peak_key.png"), text.find("<h2>"));
  EXPECT_TRUE(contains(text, "<tr class=\"differs\"><td class=\"word\">✗ no</td><td class=\"word\">A</td>"));
}

// The energy error of these runs is too large, and is marked so where the run has ended.
TEST_F(BedReport, DoesNotJudgeARunThatWasCut) {
  write_run("cut", Transition::B);
  std::string parameters = read_text(root / "cut/parameters.csv");
  parameters.replace(parameters.find("ended,yes"), 9, "ended,no");
  put("cut/parameters.csv", parameters);
  const fs::path out = report({"cut"});
  for (const char *page : {"index.html", "bed.html"}) {
    const std::string text = read_text(out / page);
    EXPECT_TRUE(contains(text, "not judged: it was killed, or is still running.")) << page;
    for (const char *verdict : {"verdict good", "verdict bad", "class=\"agrees\"", "class=\"differs\""})
      EXPECT_FALSE(contains(text, verdict)) << page;
  }
}

// Void ratios of 0.2 and 0.08, solid fractions of 0.833 and 0.926, are above those that shaking leaves: of
// case gravel by its stored packings, and 1/(1 + 0.1), which the runs here note.
TEST_F(BedReport, SaysThatSoilDenserThanShakingLeavesCanOnlyLoosen) {
  write_run("dense", Transition::B);
  std::string rows = read_text(root / "dense/bed.csv");
  rows.replace(rows.find(",0.25,"), 6, ",0.20,");
  put("dense/bed.csv", rows);
  EXPECT_FALSE(contains(read_text(report({"dense"}) / "bed.html"), "can only loosen"));
  std::string parameters = read_text(root / "dense/parameters.csv");
  parameters.erase(parameters.find("e_shaken"), std::string("e_shaken,0.1\n").size());
  put("dense/parameters.csv", parameters);
  EXPECT_TRUE(
      contains(read_text(report({"dense"}) / "bed.html"),
               fmt::format("The soil begins at a solid fraction of 0.833; shaking leaves at most {:.3f}",
                           1.0 / (1.0 + packings_of_gravel(2).shaken()))));
  write_run("noted", Transition::B);
  rows.replace(rows.find(",0.20,"), 6, ",0.08,");
  put("noted/bed.csv", rows);
  EXPECT_TRUE(contains(read_text(report({"noted"}) / "bed.html"),
                       "The soil begins at a solid fraction of 0.926; shaking leaves at most 0.909"));
  EXPECT_FALSE(contains(read_text(report({"B"}) / "bed.html"), "can only loosen"));
}

TEST_F(BedReport, SaysThatADrumHasRisen) {
  write_run("up", Transition::B);
  std::string cycles = read_text(root / "up/cycles.csv");
  cycles.replace(cycles.rfind(",0.036"), 6, ",-0.003");
  put("up/cycles.csv", cycles);
  const std::string text = read_text(report({"up"}) / "bed.html");
  EXPECT_TRUE(
      contains(text, "After 6 cycles the drum has risen by 3.0 mm under B (mean over the last cycle)"))
      << text.substr(6000, 2500);
}

TEST_F(BedReport, NamesTheCyclesThatItDraws) {
  for (const auto &[cycles, three, two] : {std::tuple{1, "the last cycle", "the last cycle"},
                                           {2, "the last 2 cycles", "the last 2 cycles"},
                                           {6, "the last 3 cycles", "the last 2 cycles"}}) {
    write_run("some", Transition::B, cycles);
    const std::vector<BedResult> beds = {result("some")};
    for (const PageFigure &figure : plan_bed_figures(group_beds(beds)).figures) {
      if (figure.figure.name == "bed1_motion") {
        EXPECT_TRUE(contains(figure.caption, three)) << cycles;
      }
      if (figure.figure.name == "bed1_motion" || figure.figure.name == "bed1_walls") {
        EXPECT_EQ(figure.figure.panels.at(0).x_label, fmt::format("time in {} (ms)", three));
      }
      if (figure.figure.name == "bed1_loop") {
        EXPECT_TRUE(contains(figure.caption, two)) << cycles;
      }
    }
  }
}

TEST_F(BedReport, PairsAWithBWhereAllElseIsAlike) {
  write_run("rough", Transition::A, 6, "0.9");
  write_run("again", Transition::A);
  const std::vector<BedResult> beds = {result("rough"), result("A"), result("again"), result("B")};
  const std::vector<BedGroup> groups = group_beds(beds);
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[0].runs, std::vector<const BedResult *>{&beds[0]});
  EXPECT_EQ(groups[1].runs, (std::vector<const BedResult *>{&beds[3], &beds[1]}));
  EXPECT_EQ(groups[2].runs, std::vector<const BedResult *>{&beds[2]});
}

/// The figure of this name.
const PageFigure &figure_of(const FigurePlan &plan, const std::string &name) {
  return *std::find_if(plan.figures.begin(), plan.figures.end(),
                       [&name](const PageFigure &figure) { return figure.figure.name == name; });
}

// A bed of good energy has no tick: that energy is balanced does not show that its force is right.
TEST_F(BedReport, HasATickForTheEnergyAlone) {
  write_run("good", Transition::B);
  std::string bed = read_text(root / "good/bed.csv");
  bed.replace(bed.rfind(",120,100,"), 9, ",110.5,100,"); // 0.5 J of 100 J
  put("good/bed.csv", bed);
  const std::string text = read_text(report({"good"}) / "bed.html");
  EXPECT_FALSE(contains(text, "verdict good"));
  EXPECT_TRUE(contains(text, "<p class=\"verdict\"> <strong>Bed.</strong>"));
  EXPECT_TRUE(contains(text, "<th class=\"word\" scope=\"col\">energy balanced</th>"));
  EXPECT_TRUE(contains(text, "<td class=\"word\">✓ yes</td>"));
}

// A slice of a drum has newtons, a bed in two dimensions newtons per metre.
TEST_F(BedReport, NamesUnitsByTheDimension) {
  for (const char *dimension : {"2", "3"}) {
    write_run("some", Transition::B);
    std::ofstream(root / "some/parameters.csv", std::ios::app) << "dimension," << dimension << "\n";
    const bool flat = std::string(dimension) == "2";
    const std::vector<BedResult> beds = {result("some")};
    EXPECT_EQ(bed_tables(beds)[0].header[8],
              flat ? "largest contact force (kN/m)" : "largest contact force (kN)");
    const FigurePlan plan = plan_bed_figures(group_beds(beds));
    EXPECT_EQ(figure_of(plan, "bed1_motion").figure.panels[1].y_label,
              flat ? "contact force on the drum (kN/m)" : "contact force on the drum (kN)");
    EXPECT_TRUE(contains(figure_of(plan, "bed1_energy").csv, flat ? "kinetic (J/m)" : "kinetic (J)"));
  }
}

// Every row of cycles.csv has the acceleration 3 cos + 4 sin, of amplitude 5: a displacement downwards of 5 /
// omega^2 that lags by atan2(4, 3) - 90 degrees behind the sine of the force.
TEST_F(BedReport, DrawsAmplitudeAndPhaseOfTheDrum) {
  const std::vector<BedResult> beds = {result("B")};
  const PageFigure figure = figure_of(plan_bed_figures(group_beds(beds)), "bed1_drum");
  put("drum.csv", figure.csv);
  const Table table = read_table(root / "drum.csv");
  ASSERT_EQ(table.rows(), 6U);
  constexpr double omega = 40.0 * 3.14159265358979323846;
  EXPECT_NEAR(table.numbers("amplitude (m)")[2], 5.0 / (omega * omega), 1e-12);
  EXPECT_NEAR(table.numbers("phase (degrees)")[2], 53.13010235 - 90.0, 1e-6);
}

// a_drum is a sawtooth, 0 to 7 in the eight rows of each cycle. The discrete Fourier sum of 0, 1, ..., 7 is
// 8 / (exp(-2 pi i n / 8) - 1), so that harmonic n has the amplitude 2 / |exp(-2 pi i n / 8) - 1|; between
// the harmonics the spectrum is zero.
TEST_F(BedReport, DrawsTheSpectrum) {
  const std::vector<BedResult> beds = {result("B")};
  const PageFigure figure = figure_of(plan_bed_figures(group_beds(beds)), "bed1_spectrum");
  put("spectrum.csv", figure.csv);
  const Table table = read_table(root / "spectrum.csv");
  const std::vector<double> frequency = table.numbers("frequency (Hz)"),
                            amplitude = table.numbers("amplitude (m/s2)");
  ASSERT_GE(frequency.size(), 12U);
  for (std::size_t i = 0; i < frequency.size(); ++i) {
    const double order = frequency[i] / 20.0;
    const bool harmonic = std::abs(order - std::round(order)) < 1e-9;
    EXPECT_NEAR(amplitude[i],
                harmonic ? 2.0 / std::abs(2.0 * std::sin(3.14159265358979323846 * order / 8.0)) : 0.0, 1e-9)
        << frequency[i];
  }
}

// Two more beds whose balls differ: their forces are 1.1 and 1.3 times those of B.
TEST_F(BedReport, ShowsSeveralSeedsAsMeanAndBand) {
  std::vector<BedResult> beds = {result("B"), result("A")};
  for (const auto &[name, factor, d50] :
       {std::tuple{"second", 1.1, "0.0302"}, std::tuple{"third", 1.3, "0.0303"}}) {
    write_another_seed(name, d50);
    beds.push_back(result(name));
    for (double &force : beds.back().run.history.F_contact)
      force *= factor;
    beds.back().measures.extremes.force.max *= factor;
  }
  const std::vector<BedGroup> groups = group_beds(beds);
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(groups[0].runs, (std::vector<const BedResult *>{&beds[0], &beds[2], &beds[3], &beds[1]}));
  EXPECT_TRUE(groups[0].several());
  const FigurePlan plan = plan_bed_figures(groups);
  put("motion.csv", figure_of(plan, "bed1_motion").csv);
  const Table table = read_table(root / "motion.csv");
  const std::vector<std::string> curves = table.text("curve");
  const std::vector<double> forces = table.numbers("contact force (N/m)");
  std::map<std::string, double> largest;
  for (std::size_t i = 0; i < curves.size(); ++i)
    largest[curves[i]] = std::max(largest[curves[i]], forces[i]);
  EXPECT_NEAR(largest["B"], 7000.0 * 3.4 / 3.0, 1e-6);
  EXPECT_NEAR(largest["B low"], 7000.0, 1e-6);
  EXPECT_NEAR(largest["B high"], 7000.0 * 1.3, 1e-6);
  EXPECT_NEAR(largest["A"], 7000.0, 1e-6);
  EXPECT_EQ(figure_of(plan, "bed1_motion").figure.panels[1].curves.size(), 4U); // B with its band, and A
  std::string words;
  for (const Sentence &sentence : bed_answer(groups).sentences)
    words += sentence.text + " ";
  // Of 1, 1.1 and 1.3: mean 1.1333, standard deviation 0.15275.
  EXPECT_TRUE(contains(words, {"is 6.8 ± 0.92 kN/m under B and 6.0 kN/m under A.",
                               "Means are over 3 beds under B and 1 bed under A, and behind ±"}));
  // The same bed again, or one of the same balls, is not another seed.
  write_run("again", Transition::B);
  EXPECT_EQ(group_beds({result("B"), result("again")}).size(), 2U);
}

TEST_F(BedReport, IsSoundWithBedsOnly) {
  draw();
  write_dumps("A");
  const fs::path out = report({"A", "B"});
  const test::Parsed index = test::expect_sound_page(out, 0);
  EXPECT_EQ(index.ids.count("impact"), 0u);
  EXPECT_NE(std::find(index.links.begin(), index.links.end(), "bed.html"), index.links.end());
  // Motion, loop, settlement, drum, spectrum, state, energies, walls, three pictures, profile, stress,
  // contact.
  const test::Parsed page = test::expect_sound_page(out, 14, "bed.html");
  for (const std::string &image : page.images) {
    const std::string stem = fs::path(image).stem().string();
    const Table data = read_table(out / "data" / (stem.substr(0, stem.rfind("_key")) + ".csv"));
    EXPECT_GT(data.rows(), 1u) << image;
    for (const std::string &name : data.header())
      EXPECT_TRUE(name == "curve" || name.find(" (") != std::string::npos) << image << ": " << name;
  }
  const std::string text = read_text(out / "bed.html");
  EXPECT_TRUE(contains(
      text, {"The picture of B is left out: the run has no dumps; run it with -var dumps_per_cycle 10",
             "<span>&lt;in.bed&gt;</span>"}));
  for (const char *name : {"bed_runs.csv", "bed_states.csv"})
    EXPECT_EQ(read_table(out / "data" / name).rows(), 2u);
  const Table states = read_table(out / "data/bed_states.csv");
  EXPECT_EQ(states.text("grading").front(), "WMM_from_14mm");
  EXPECT_EQ(states.text("smallest and largest ball (mm)").front(), "14 to 53");
  EXPECT_EQ(states.text("d50 (mm)").front(), "30.1");
  EXPECT_EQ(states.text("coefficient of uniformity Cu (-)").front(), "1.75");
  // Void ratios of 0.25 and 0.2, between 0.3 and 0.1.
  EXPECT_EQ(states.text("relative density at the start (-)").front(), "0.25");
  EXPECT_EQ(states.text("relative density at the end (-)").front(), "0.50");
}

TEST_F(BedReport, IsOnOnePageWithChains) {
  const ChainParameters p = table1_case("II", Transition::B);
  ExactOptions options;
  options.cycles = 4;
  const ExactSolution direct = solve_chain(p, options);
  fs::create_directories(root / "chain");
  write_files({{root / "chain" / "chain.csv", chain_text(direct.history)}});
  std::vector<std::pair<std::string, std::string>> values = parameter_values(p);
  values.emplace_back("case", "II");
  const std::vector<std::pair<std::string, std::string>> roller =
      given("roller mine, setting high, roller_frequency 20, roller_static_load 29430");
  values.insert(values.end(), roller.begin(), roller.end());
  for (const auto &[name, value] : roller)
    std::ofstream(root / "A/parameters.csv", std::ios::app) << name << "," << value << "\n";
  write_files({{root / "chain" / "parameters.csv", parameters_text(values)}});
  const fs::path out = report({"A", "chain"});
  const test::Parsed index = test::expect_sound_page(out, 1);
  EXPECT_EQ(index.ids.count("impact"), 1u);
  EXPECT_EQ(index.ids.count("bed"), 1u);
  const std::string words = "The roller is that of mine, setting high: 20 Hz, static load 29.43 kN.";
  const std::string first = read_text(out / "index.html");
  EXPECT_NE(first.find(words), first.rfind(words)) << "of the chain and of the bed";
  EXPECT_TRUE(contains(read_text(out / "bed.html"), words));
  test::expect_sound_page(out, 8, "bed.html");
  const fs::path without = report({"chain"});
  EXPECT_FALSE(fs::exists(without / "bed.html"));
  EXPECT_EQ(test::expect_sound_page(without, 1).ids.count("bed"), 0u);
}

TEST_F(BedReport, ShowsTheBedAtRestAndAtTheExtremesOfTheForce) {
  write_dumps("A");
  const std::vector<BedResult> beds = {result("A")};
  const FigurePlan plan = plan_bed_figures(group_beds(beds));
  std::map<std::string, const PageFigure *> figures;
  for (const PageFigure &figure : plan.figures)
    figures[figure.figure.name] = &figure;
  const auto title = [&](const std::string &name) { return figures.at(name)->figure.panels.at(0).title; };
  EXPECT_EQ(title("bed1_settled"), "A: 0 s, 0.0 kN/m on the drum");
  EXPECT_EQ(title("bed1_peak"), "A: 0.04375 s, 7.0 kN/m on the drum");
  EXPECT_EQ(title("bed1_least"), "A: 0.05 s, 0.0 kN/m on the drum");
  // The drum's 400 N on ball 1, below it, and 100 N along the line from ball 2 to ball 1.
  const std::string &csv = figures.at("bed1_peak")->csv;
  EXPECT_TRUE(contains(csv, {"A contact,1,3.9,,,,0,-2.9,400\n", "A contact,2.8,1,,,,-1.8,0,100\n",
                             "A contact,1,0.05"})); // from the floor
  EXPECT_TRUE(contains(csv, "A roller,1,3.9,2,0,1,,,\n"));
  // One ball touches the drum.
  EXPECT_TRUE(contains(figures.at("bed1_contact")->csv, "A,0.04375,1,0\n"));
  // Two discs of 1 m in a bed of 3.8 m by 2 m: one layer, since two mean diameters are 4 m.
  EXPECT_TRUE(contains(figures.at("bed1_profile")->csv, "A before whole,1,0.826734"));
}

// The drum presses 400 N through a column of eight discs of 1 m: in four layers of two diameters and of the
// width of the drum, 4 m, the stress of the seven contacts between them has the mean 7 * 400 N * 1 m / (4 * 2
// m * 4 m).
TEST_F(BedReport, DrawsTheStressBelowTheDrum) {
  write_column("A", 400.0);
  const std::vector<BedResult> beds = {result("A")};
  put("stress.csv", figure_of(plan_bed_figures(group_beds(beds)), "bed1_stress").csv);
  const Table table = read_table(root / "stress.csv");
  const std::vector<double> stress = table.numbers("vertical stress (Pa)");
  ASSERT_EQ(stress.size(), 4U);
  EXPECT_NEAR(std::accumulate(stress.begin(), stress.end(), 0.0) / 4.0, 7.0 * 400.0 / (4.0 * 2.0 * 4.0),
              1e-3);
  EXPECT_EQ(table.numbers("depth (m)"), (std::vector<double>{1.0, 3.0, 5.0, 7.0}));
}

// Two beds whose columns carry 400 and 600 N: pictures show the first, curves both.
TEST_F(BedReport, DrawsWhatTheDumpsOfSeveralSeedsTellAsMeanAndBand) {
  write_another_seed("second", "0.0302");
  write_column("B", 400.0);
  write_column("second", 600.0);
  const std::vector<BedResult> beds = {result("B"), result("second")};
  const FigurePlan plan = plan_bed_figures(group_beds(beds));
  EXPECT_EQ(figure_of(plan, "bed1_peak").figure.panels.size(), 1U);
  put("stress.csv", figure_of(plan, "bed1_stress").csv);
  const Table table = read_table(root / "stress.csv");
  const std::vector<std::string> curves = table.text("curve");
  const std::vector<double> stress = table.numbers("vertical stress (Pa)");
  std::map<std::string, double> sums;
  for (std::size_t i = 0; i < curves.size(); ++i)
    sums[curves[i]] += stress[i];
  EXPECT_EQ(sums.size(), 3U);
  EXPECT_NEAR(sums["B"], 7.0 * 500.0 / 8.0, 1e-3);
  EXPECT_NEAR(sums["B low"], 7.0 * 400.0 / 8.0, 1e-3);
  EXPECT_NEAR(sums["B high"], 7.0 * 600.0 / 8.0, 1e-3);
  EXPECT_EQ(figure_of(plan, "bed1_stress").figure.panels[0].curves.size(), 3U);
  EXPECT_TRUE(contains(figure_of(plan, "bed1_contact").csv, {"\nB,", "\nB low,", "\nB high,"}));
  EXPECT_TRUE(
      contains(figure_of(plan, "bed1_profile").csv, {"\nB before whole low,", "\nB after below high,"}));
  for (const char *name : {"bed1_stress", "bed1_contact", "bed1_profile"})
    EXPECT_TRUE(contains(figure_of(plan, name).caption, "Means over up to 2 beds of a condition"));
}

// A row of discs of 1 m radius in two of the four zones below and beside a drum that is 4 m wide, and of half
// of that radius, two of them, in the last: they fill pi/4, and pi/8 of the layer of 2 m.
TEST_F(BedReport, DrawsTheSolidFractionBesideTheDrum) {
  std::string zeros;
  for (int n = 0; n < 6; ++n)
    zeros += "0 0 0 ";
  const std::vector<test::Array> arrays = {{"id", 1, "1 2 3 4 5 6"},
                                           {"type", 1, "1 1 1 1 1 2"},
                                           {"radius", 1, "1 1 1 0.5 0.5 2"},
                                           {"mass", 1, "1 1 1 1 1 1"},
                                           {"v", 3, zeros},
                                           {"omega", 3, zeros},
                                           {"f", 3, zeros}};
  for (const char *step : {"0", "800"})
    put(fmt::format("A/dump/balls_{}.vtp", step),
        test::point_data(6, "-1 1 0 1 1 0 3 1 0 4.5 0.5 0 5.5 0.5 0 2 4 0", arrays));
  const std::vector<BedResult> beds = {result("A")};
  const PageFigure figure = figure_of(plan_bed_figures(group_beds(beds)), "bed1_profile");
  ASSERT_EQ(figure.figure.panels.size(), 3U);
  put("profile.csv", figure.csv);
  const Table table = read_table(root / "profile.csv");
  const std::vector<std::string> curves = table.text("curve");
  const std::vector<double> fractions = table.numbers("solid fraction (-)");
  constexpr double quarter = 0.78539816339744831; // of pi
  const std::map<std::string, double> expected = {
      {"A before whole", 0.875 * quarter}, {"A before below", quarter}, {"A before beside", 0.75 * quarter}};
  std::map<std::string, double> found;
  for (std::size_t i = 0; i < curves.size(); ++i)
    found[curves[i]] = fractions[i];
  for (const auto &[name, fraction] : expected)
    EXPECT_NEAR(found.at(name), fraction, 1e-6) << name;
  EXPECT_EQ(curves.size(), 6U);
}

// Balls of type 1 are the lower layer of soil, those of type 4 the upper one, and type 2 is the drum.
TEST_F(BedReport, DrawsEachLayerWithAnEdgeOfItsColour) {
  std::map<std::string, test::Array> arrays = test::ball_arrays();
  arrays["type"].values = "2 4 1";
  for (const char *step : {"0", "700", "800"})
    put(fmt::format("A/dump/balls_{}.vtp", step), test::ball_dump(arrays));
  const std::vector<BedResult> beds = {result("A")};
  const FigurePlan plan = plan_bed_figures(group_beds(beds));
  const auto picture = std::find_if(plan.figures.begin(), plan.figures.end(), [](const PageFigure &figure) {
    return figure.figure.name == "bed1_peak";
  });
  ASSERT_NE(picture, plan.figures.end());
  const std::vector<Curve> &curves = picture->figure.panels.at(0).curves;
  ASSERT_GE(curves.size(), 2u);
  EXPECT_EQ(curves[0].title, "layer 1");
  EXPECT_EQ(curves[0].style, CurveStyle::discs_1);
  EXPECT_EQ(curves[1].title, "layer 2");
  EXPECT_EQ(curves[1].style, CurveStyle::discs_2);
  EXPECT_TRUE(contains(picture->csv, {"A soil 1,1,1,1,", "A soil 2,2.8,1,1,"}));
  EXPECT_TRUE(contains(picture->caption, "have the colours of their layers"));
}

// The bed reaches from z = -1.5 m to 2.5 m, its soil from -1 m to 2.2 m.
TEST_F(BedReport, CutsABedOfThreeDimensionsInTheMiddle) {
  for (const char *step : {"0", "800"})
    put(std::string("A/dump/balls_") + step + ".vtp",
        test::ball_dump(test::ball_arrays(), "1 3.9 0.5 2.8 1 1.2 1 1 0"));
  const std::vector<BedResult> beds = {result("A")};
  const FigurePlan plan = plan_bed_figures(group_beds(beds));
  std::map<std::string, const PageFigure *> figures;
  for (const PageFigure &figure : plan.figures)
    figures[figure.figure.name] = &figure;
  const PageFigure &picture = *figures.at("bed1_peak");
  EXPECT_TRUE(contains(picture.csv, {"A soil,1,1,0.86602", "A soil,2.8,1,0.71414", "A roller,1,3.9,2,"}));
  EXPECT_TRUE(contains(picture.caption, "section z = 0.5 m"));
  // Two balls of radius 1 m in 3.8 m by 2 m by 3.2 m.
  EXPECT_TRUE(contains(figures.at("bed1_profile")->csv, "A before whole,1,0.34447"));
}

TEST_F(BedReport, DrawsOneProfileBelowADrumOfManyBalls) {
  std::map<std::string, test::Array> arrays = test::ball_arrays();
  arrays["type"].values = "2 2 1"; // ball 2 is of the drum
  for (const char *step : {"0", "800"})
    put(std::string("A/dump/balls_") + step + ".vtp", test::ball_dump(arrays));
  const std::vector<BedResult> beds = {result("A")};
  const FigurePlan plan = plan_bed_figures(group_beds(beds));
  for (const PageFigure &figure : plan.figures) {
    if (figure.figure.name != "bed1_profile") continue;
    ASSERT_EQ(figure.figure.panels.size(), 2u);
    EXPECT_EQ(figure.figure.panels[1].curves.size(), 2u); // before and after
    return;
  }
  FAIL() << "no profile";
}

TEST_F(BedReport, IsMadeOfARunThatEndsAtOnce) {
  draw();
  write_run("short", Transition::B, 6);
  std::string bed = read_text(root / "short" / "bed.csv");
  std::size_t end = 0;
  for (int line = 0; line < 5; ++line)
    end = bed.find('\n', end) + 1;
  put("short/bed.csv", bed.substr(0, end));
  put("short/cycles.csv", "cycle,contact_share,settlement\n0,1,0\n");
  const fs::path out = report({"short"});
  test::expect_sound_page(out, 2, "bed.html");
  EXPECT_TRUE(contains(read_text(out / "bed.html"), "short: ends before its first complete cycle"));
}

// In a bed of layers parameters of contacts are lists, the lowest layer first; the drum is on the last.
TEST_F(BedReport, OfLayersHasTheContactsOfTheUppermost) {
  std::map<std::string, std::string> values = drumlin::post::read_run(root / "B").parameters;
  values["k"] = "1e8,1e9";
  values["D"] = "0.1,0.25";
  put("B/parameters.csv", parameters_text({values.begin(), values.end()}));
  EXPECT_EQ(drumlin::post::read_run(root / "B").chain.k, 1e9);
  EXPECT_EQ(drumlin::post::read_run(root / "B").chain.D, 0.25);
  values["k"] = "1e8,soft";
  put("B/parameters.csv", parameters_text({values.begin(), values.end()}));
  expect_refusal({"B"}, {"parameters.csv", "k is 'soft'", "not a number"});
}

// Of a deck of one's own the report knows neither the rest from which it began nor its law.
TEST_F(BedReport, RunsOfOtherDecksAreNotJudged) {
  std::map<std::string, std::string> values = drumlin::post::read_run(root / "B").parameters;
  EXPECT_EQ(drumlin::post::read_run(root / "B").kind, drumlin::post::RunKind::bed);
  values.erase("deck");
  put("B/parameters.csv", parameters_text({values.begin(), values.end()}));
  EXPECT_NE(drumlin::post::read_run(root / "B").kind, drumlin::post::RunKind::bed);
}

TEST_F(BedReport, RefusesFilesThatItCannotRead) {
  const auto damaged = [this](const std::string &file, const std::string &from, const std::string &to) {
    write_run("damaged", Transition::B);
    std::string text = read_text(root / "damaged" / file);
    text.replace(text.find(from), from.size(), to);
    put("damaged/" + file, text);
    return std::vector<std::string>{"damaged"};
  };
  expect_refusal(damaged("bed.csv", ",void_ratio", ",voids"), {"bed.csv", "void_ratio"});
  expect_refusal(damaged("bed.csv", "9e4", "much"), {"bed.csv", "line 2", "F_floor", "much"});
  expect_refusal(damaged("cycles.csv", ",settlement", ",depth"), {"cycles.csv", "settlement"});
  expect_refusal(damaged("parameters.csv", "transition,B", "transition,C"), {"parameters.csv", "'C'"});
  expect_refusal(damaged("parameters.csv", "omega,", "omego,"), {"parameters.csv", "omega"});
  write_run("damaged", Transition::B);
  fs::remove(root / "damaged" / "cycles.csv");
  expect_refusal({"damaged"}, {"cycles.csv", "missing"});
  write_run("damaged", Transition::B);
  fs::remove(root / "damaged" / "parameters.csv");
  expect_refusal({"damaged"}, {"parameters.csv"});
  write_run("damaged", Transition::B);
  put("damaged/dump/balls_0.vtp", "no dump");
  expect_refusal({"damaged"}, {"balls_0.vtp"});
  EXPECT_FALSE(fs::exists(root / "report"));
}

} // namespace
