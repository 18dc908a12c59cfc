// Options of the commands, and what is refused before anything is run.
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"
#include "tests/support/lines.h"
#include "tests/support/tool.h"

#include "calibration/task.h"
#include "runs/parameter_file.h"
#include "support/files.h"
#include "support/process.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::test {
namespace {

// What options of the tools do together: layers of a bed, a roller's file in every command, files that are
// read and not replaced.
namespace options {

namespace fs = std::filesystem;

class ToolOptions : public Tool {
protected:
  Outcome run(const std::vector<std::string> &words) const { return drumlin(words); }
};

// A curve of three sieves whose numbers are exact by hand: half of the mass between 10 and 20, half between
// 20 and 40 mm, nothing is cut.
TEST_F(ToolOptions, SieveFileMakesABedAndItsGrading) {
  draw();
  std::ofstream(folder_ / "my gravel.csv") << "size (mm),passing (%)\n10,0\n20,50\n40,100\n";
  const post::Outcome outcome =
      well(run({"bed", "--sieve", "my gravel.csv", "--cut", "10", "--balls", "2000", "--out", "balls.data"}));
  EXPECT_TRUE(printed(outcome, {"balls.data: 2000 balls, filled to ",
                                "Grading my_gravel: 0.0 % of the mass are grains finer than 10 mm"}));
  // d10 = 10 mm 2^0.2 and so on
  EXPECT_TRUE(
      printed(outcome, "\nasked for                          11.5   15.2     20     23         2  0.871\n"));
  for (const char *name : {"balls_grading.csv", "balls_grading.gp", "balls_grading.svg", "balls_grading.png"})
    EXPECT_TRUE(fs::is_regular_file(folder_ / name)) << name;
  std::ifstream data(folder_ / "balls.data");
  const std::string text((std::istreambuf_iterator<char>(data)), {});
  for (const char *note :
       {"grading my_gravel_from_10mm\n", "r_min 0.005\n", "r_max 0.02\n", "d50 0.0", "C_u "})
    EXPECT_TRUE(contains(text, std::string("# drumlin note ") + note)) << note;
}

// A curve that is read, under the name that a result would have, or in its place.
TEST_F(ToolOptions, CurvesOfABedAreNotReplaced) {
  const std::string curve = "size (mm),passing (%)\n10,0\n20,50\n40,100\n";
  for (const char *name : {"bed.csv", "bed_grading.csv"})
    std::ofstream(folder_ / name) << curve;
  fs::create_hard_link(folder_ / "bed.csv", folder_ / "hard.data");
  std::ofstream(folder_ / "mine.in") << "units si\n";
  for (const auto &[line, says] :
       {std::pair{"bed --sieve bed.csv --out bed.csv",
                  "--out is 'bed.csv'; allowed: another file than --sieve 'bed.csv'"},
        {"bed --sieve bed.csv --out hard.data",
         "--out is 'hard.data'; allowed: another file than --sieve 'bed.csv'"},
        {"bed --sieve bed_grading.csv --out bed.data",
         "--out is 'bed_grading.csv'; allowed: another file than --sieve 'bed_grading.csv', which is read"},
        {"bed --layer 0.1:bed.csv:20 --out bed.csv",
         "--out is 'bed.csv'; allowed: another file than --layer"},
        {"run mine.in -log ./mine.in",
         "-log is './mine.in'; allowed: another file than DECK 'mine.in', which is read"},
        {"run mine.in -var balls bed.csv -log hard.data",
         "-log is 'hard.data'; allowed: another file than -var 'bed.csv'"}}) {
    const post::Outcome outcome = run(words_of(line));
    EXPECT_EQ(outcome.status, 2);
    expect_one_error(outcome.output, "drumlin " + words_of(line)[0] + ": " + says);
    for (const char *name : {"bed.csv", "bed_grading.csv", "hard.data"})
      EXPECT_EQ(post::read_text(folder_ / name), curve) << name;
    EXPECT_EQ(post::read_text(folder_ / "mine.in"), "units si\n");
    EXPECT_FALSE(fs::exists(folder_ / "bed.data"));
  }
}

// A map appends to its table: another file of the folder that is the same would get its rows.
TEST_F(ToolOptions, FoldersWhoseFilesAreOneAreRefused) {
  for (const char *command : {"map", "study", "calibrate"}) {
    const fs::path out = folder_ / command;
    fs::create_directories(out);
    std::ofstream(out / "a.csv") << "kept\n";
    fs::create_hard_link(out / "a.csv", out / "b.csv");
    std::vector<std::string> words = {command};
    if (words[0] == "study") words.emplace_back("meter");
    if (words[0] == "calibrate") words.insert(words.end(), {"--target", "k=2e7", "--vary", "k=1e8:1e9"});
    words.insert(words.end(), {"--out", command});
    const post::Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_TRUE(printed(outcome, "allowed: a folder in which 'a.csv' and 'b.csv' are not one file"));
    EXPECT_EQ(post::read_text(out / "a.csv"), "kept\n");
  }
}

// The force in the record of a map is the one of its points: it follows from the eccentric moment, or differs
// from point to point.
TEST_F(ToolOptions, AMapRecordsItsForce) {
  const auto force = [this](std::vector<std::string> words) {
    words.insert(words.begin(), {"map", "--cycles", "100", "--fresh", "--out", "m"});
    well(run(words));
    return post::read_parameters(folder_ / "m/parameters.csv").at("Fw");
  };
  EXPECT_EQ(force({"--x", "k:1e7:2e7:2", "--y", "D:0.1:0.2:2"}), "58800");
  EXPECT_EQ(force({"--x", "k:1e7:2e7:2", "--y", "D:0.1:0.2:2", "--me-re", "4", "--omega", "100"}), "40000");
  EXPECT_EQ(force({"--x", "k:1e7:2e7:2", "--y", "omega:100:120:2", "--me-re", "4"}), "");
  EXPECT_EQ(force({"--x", "k:1e7:2e7:2", "--y", "Fw:1e4:2e4:2"}), "");
}

// A drum of 6000 kg under B, with condition and numbers that others have computed.
TEST_F(ToolOptions, AMapTakesARollerFromItsFile) {
  std::ofstream(folder_ / "heavy") << "drum_mass 6 t\nframe_mass 3500 kg\nbond_stiffness 3.1 MN/m\n"
                                      "bond_damping 31 kN s/m\nfrequency 1800 vpm\n"
                                      "eccentric_moment 11.4 kg m\n";
  const post::Outcome outcome =
      well(run({"map", "--sweep", "k:10e6:100e6:60", "--roller", "heavy", "--D", "0.2", "--out", "m"}));
  EXPECT_TRUE(printed(outcome, {"eccentric moment        11.4 kg m\n", "nominal amplitude       1.9 mm\n",
                                "loss of contact     k = 28859", "period doubling     k = 642150"}));
  const post::Table boundaries = post::read_table(folder_ / "m/boundaries.csv");
  EXPECT_EQ(boundaries.text("kind"), (std::vector<std::string>{"loss of contact", "period doubling"}));
  EXPECT_NEAR(boundaries.numbers("k [N/m]").at(0), 28.8593e6, 50.0);
  EXPECT_NEAR(boundaries.numbers("k [N/m]").at(1), 64.2151e6, 50.0);
  const auto noted = post::read_parameters(folder_ / "m/parameters.csv");
  EXPECT_EQ(noted.at("roller"), "heavy");
  EXPECT_EQ(noted.at("me_re"), "11.4");
  EXPECT_NEAR(std::stod(noted.at("roller_exciter_force")), 11.4 * std::pow(60.0 * M_PI, 2), 1e-6);

  // Over k and frequency the force of the same moment follows from the frequency; of one axis only the name
  // and the unit differ from omega.
  const auto points = [this](const std::string &x) {
    well(run({"map", "--x", x, "--y", "k:20e6:80e6:2", "--roller", "heavy", "--cycles", "100", "--out", x}));
    return post::read_table(folder_ / x / "regimes.csv");
  };
  const post::Table hertz = points("frequency:25:30:2"),
                    radians = points("omega:157.0796326794897:188.4955592153876:2");
  EXPECT_EQ(hertz.numbers("frequency [Hz]"), (std::vector<double>{25, 30, 25, 30}));
  EXPECT_EQ(hertz.text("regime"), radians.text("regime"));
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(hertz.numbers("peak_force [N]").at(i) / radians.numbers("peak_force [N]").at(i), 1.0, 1e-6);
}

// Of this roller a data sheet is all that is known. By hand: m_e r_e = 256e3/(60 pi)^2, m2 = m_e r_e/1.8 mm,
// m3 = 7000 kg - m2, k23 = m3 (2 pi 4.82 Hz)^2, c23 = 2 0.151 sqrt(k23 m3).
TEST_F(ToolOptions, ADataSheetIsEnoughForAllCommands) {
  std::ofstream(folder_ / "mine")
      << "operating_mass 12.1 t\ndrum_load 7000 kg\nwidth 2.13 m\nfrequency 30 Hz\n"
         "force 256 kN\namplitude 1.8 mm\n";
  const std::vector<std::string> by_file = {"--roller", "mine"},
                                 by_hand = {"--omega", "188.49555921538757", "--me-re", "7.2050619478995772",
                                            "--m2",    "4002.8121932775",    "--m3",    "2997.1878067225",
                                            "--k23",   "2748955.8845542",    "--c23",   "27412.447104822"};
  const auto boundaries = [this](const std::vector<std::string> &roller) {
    std::vector<std::string> words = {"map", "--sweep", "k:5e6:100e6:15", "--D",
                                      "0.2", "--fresh", "--out",          "m"};
    words.insert(words.end(), roller.begin(), roller.end());
    well(run(words));
    return post::read_table(folder_ / "m/boundaries.csv").numbers("k [N/m]");
  };
  const std::vector<double> expected = boundaries(by_hand), found = boundaries(by_file);
  ASSERT_EQ(found.size(), expected.size());
  ASSERT_FALSE(found.empty());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i] / expected[i], 1.0, 1e-9);

  well(run({"exact", "--roller", "mine", "--frequency", "29.3", "--k", "45e6", "--D", "0.25", "--cycles",
            "30", "--samples-per-cycle", "40", "--out", "run"}));
  fs::rename(folder_ / "run/chain.csv", folder_ / "logged.csv"); // without parameters, and with other columns
  const std::vector<std::string> record = {"logged.csv",      "--column",      "time=time",
                                           "--column",        "a_drum=a_drum", "--column",
                                           "a_frame=a_frame", "--roller",      "mine"};
  std::vector<std::string> words = {"identify", "--out", "found"};
  words.insert(words.end(), record.begin(), record.end());
  EXPECT_TRUE(printed(well(run(words)),
                      {"exciter force per metre 120.19 kN/m", "The bond of drum and frame is assumed",
                       "the record has 29.3", "30 Hz was said"}));
  EXPECT_NEAR(post::read_table(folder_ / "found/identify.csv").numbers("k [N/m]").front(), 45e6, 1e4);
  words = {"meter", "--out", "meter"};
  words.insert(words.end(), record.begin(), record.end());
  EXPECT_TRUE(printed(well(run(words)), {"nominal amplitude       1.8 mm", "k_B "}));
  EXPECT_TRUE(printed(well(run({"advise", "--roller", "mine", "--k", "45e6", "--D", "0.25"})),
                      {"frame frequency         4.82 Hz", " -var roller mine -var k 45e6 -var D 0.25 "}));
}

// What is advised for a roller holds for a run of the deck with the same file.
TEST_F(ToolOptions, AdviceForARollerNamesItsFile) {
  const std::string file = (fs::path(DRUMLIN_SOURCE_DIR) / "inputs/rollers/CA3500").string();
  const post::Outcome outcome =
      well(run({"advise", "--roller", file, "--setting", "low", "--frequency", "33", "--error", "1e-2"}));
  EXPECT_TRUE(
      printed(outcome, {"setting low: drum 3955 kg, frame 3713 kg\n", "frequency               33 Hz\n",
                        "-var case II -var transition B -var roller " + file +
                            " -var setting low -var omega 207.34511513692635 -var stepping"}));
}

// Layers of wanted densities: the file notes how they are poured, and a layer has as many balls as fill its
// thickness at its void ratio. Between two packings friction follows the void ratio linearly.
TEST_F(ToolOptions, LayersArePouredForTheirRelativeDensity) {
  std::ofstream(folder_ / "density.csv")
      << "share,friction,rolling,void_ratio,solid_fraction,relative_density,compaction,coordination,"
         "dimension,spread\n1,0.8,0.4,0.3,0.77,0,0.92,3,2,0.2\n0,0,0,0.2,0.83,1,1,4,2,0.2\n"
         "0.5,0.4,0.2,0.28,0.78,0.2,0.94,3,2,0.2\n";
  const post::Outcome outcome =
      well(run({"bed", "--width", "4", "--layer", "0.3", "--layer", "0.3", "--packings", "density.csv",
                "--relative-density", "0.1", "--relative-density", "1", "--out", "balls.data"}));
  EXPECT_TRUE(printed(outcome,
                      "at a relative density of 0.1: void ratio 0.290 (0.300 loosest, 0.200 densest), "
                      "poured with friction 0.6 and rolling friction 0.3"));
  const std::string text = post::read_text(folder_ / "balls.data");
  for (const char *note :
       {"relative_density 0.1,1\n", "e_loosest 0.3,0.3\n", "e_densest 0.2,0.2\n", "pour_friction 0.6,0\n",
        "pour_rolling 0.3,0\n", "packings_friction 0.8,0.8\n", "packings_rolling 0.4,0.4\n", "seed 1\n"})
    EXPECT_TRUE(contains(text, std::string("# drumlin note ") + note)) << note;
  double area[] = {0.0, 0.0};
  std::istringstream rows(text.substr(text.find("Atoms\n") + 6));
  int id = 0, type = 0;
  for (double size = 0.0, density = 0.0, x = 0.0, y = 0.0, z = 0.0;
       rows >> id >> type >> size >> density >> x >> y >> z;)
    area[type == 1 ? 0 : 1] += 0.25 * 3.141592653589793 * size * size;
  EXPECT_NEAR(area[0], 4.0 * 0.3 / 1.29, 0.02);
  EXPECT_NEAR(area[1], 4.0 * 0.3 / 1.2, 0.02);
  EXPECT_NEAR(area[1] / area[0], 1.29 / 1.2, 0.02);
  EXPECT_EQ(run({"bed", "--layer", "0.3", "--packings", "density.csv", "--relative-density", "1", "--out",
                 "density.csv"})
                .status,
            2);
}

// A table of packings says of which balls it is.
TEST_F(ToolOptions, PackingsOfOtherBallsAreRefused) {
  const std::string columns =
      "share,friction,rolling,void_ratio,solid_fraction,relative_density,compaction,coordination";
  const auto refused = [&](const std::string &mix, const std::vector<std::string> &more,
                           const std::string &says) {
    post::write_files({{folder_ / "density.csv", columns + (mix.empty() ? "" : ",dimension,spread") +
                                                     "\n1,0.8,0.4,0.3,0.77,0,0.9,3" + mix +
                                                     "\n0,0,0,0.2,0.83,1,1,4" + mix + "\n"}});
    std::vector<std::string> words = {"bed",        "--layer",     "0.3",
                                      "--packings", "density.csv", "--relative-density",
                                      "1",          "--out",       "none.data"};
    words.insert(words.end(), more.begin(), more.end());
    const post::Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 2);
    expect_one_error(outcome.output, "drumlin bed: ");
    EXPECT_TRUE(printed(outcome, says));
    EXPECT_FALSE(fs::exists(folder_ / "none.data"));
  };
  const std::string allowed = "--packings is 'density.csv'; allowed: packings of ";
  refused("", {},
          "density.csv, column 'dimension': is missing; allowed: density.csv of this version's in.density");
  refused(",3,0.2", {},
          allowed + "discs with radii from r to 1.5 r, grading uniform; it has those of spheres");
  refused(",2,0.2", {"--depth", "0.2"}, allowed + "spheres with radii from r to 1.5 r");
  refused(",2,0", {}, "it has those of discs with radii from r to 1 r");
  refused(",2,0.2", {"--radius-max", "0.032"}, allowed + "discs with radii from r to 2 r");
  refused(",2,0.2", {"--grading", "mass"}, allowed + "discs with radii from r to 1.5 r, grading mass");
  // A curve of the same name and limits whose stones are finer.
  post::write_files({{folder_ / "density.csv",
                      "share,friction,rolling,void_ratio,dimension,spread,grading,d50_over_smallest\n"
                      "1,0.8,0.4,0.3,2,0.5,20-60_from_20mm,1.6\n0,0,0,0.2,2,0.5,20-60_from_20mm,1.6\n"}});
  const post::Outcome finer = run({"bed", "--layer", "0.3:20-60:20", "--packings", "density.csv",
                                   "--relative-density", "1", "--out", "none.data"});
  EXPECT_EQ(finer.status, 2);
  EXPECT_TRUE(printed(finer,
                      "grading 20-60_from_20mm with d50 1.732 times the smallest size; it has those of "
                      "discs with radii from r to 3 r, grading 20-60_from_20mm with d50 1.6 times"));
}

TEST_F(ToolOptions, SpotsAreOfTheLowestLayer) {
  well(run({"bed", "--width", "2", "--layer", "0.3", "--layer", "0.2", "--spot", "-0.5:-0.25", "--spot",
            "0.1:0.6", "--out", "balls.data"}));
  const std::string text = post::read_text(folder_ / "balls.data");
  EXPECT_TRUE(contains(
      text, {"# drumlin note layers 2\n", "# drumlin note spots -0.5:-0.25,0.1:0.6\n", "\n6 atom types\n"}));
  std::istringstream rows(text.substr(text.find("Atoms\n") + 6));
  int id = 0, type = 0, counted = 0;
  for (double size = 0.0, density = 0.0, x = 0.0, y = 0.0, z = 0.0;
       rows >> id >> type >> size >> density >> x >> y >> z;) {
    const int spot = x >= -0.5 && x <= -0.25 ? 5 : x >= 0.1 && x <= 0.6 ? 6 : 1;
    if (type == 4) continue;
    ++counted;
    EXPECT_EQ(type, spot) << x;
  }
  EXPECT_GT(counted, 100);
}

// The balls of a layer have its type, lie above those of the layer below, and fill the thickness that was
// asked for when they take 82.5 % of the area. Half of the mass of this curve is finer than 20 mm.
TEST_F(ToolOptions, LayersMakeABedWithATypeForEach) {

  std::ofstream(folder_ / "stone.csv") << "size (mm),passing (%)\n10,0\n20,50\n40,100\n";
  const post::Outcome outcome =
      well(run({"bed", "--width", "1.5", "--layer", "0.3", "--layer", "0.2:stone.csv:20", "--layer",
                "0.1:stone.csv", "--balls", "3000", "--out", "balls.data"}));
  EXPECT_TRUE(printed(outcome, {"Layer 2: Grading stone: 50.0 % of the mass are grains finer than 20 mm",
                                "\nLayer 3: Grading stone: "}));
  const std::string curves = post::read_text(folder_ / "balls_grading.csv");
  EXPECT_TRUE(
      contains(curves, {"\nbed 2,", "\nbed 3,", "\nasked for without the fines 2,", "\nasked for 3,"}));
  EXPECT_FALSE(contains(curves, "bed 1")); // no grading was asked for
  const std::string text = post::read_text(folder_ / "balls.data");
  for (const char *note :
       {"grading uniform+stone_from_20mm+stone_from_", "layers 3\n", "layer_thicknesses 0.3,0.2,0.1\n"})
    EXPECT_TRUE(contains(text, std::string("# drumlin note ") + note)) << note;
  EXPECT_TRUE(contains(text, "\n5 atom types\n"));
  // d50 and C_u of each layer. Of discs whose radii are equally frequent from a to b half of the mass has a
  // radius up to ((a^3 + b^3)/2)^(1/3); stone from 20 mm has a d50 of 20 2^0.5 mm, and d60/d10 = 2^0.5.
  const auto list = [&text](const std::string &note) {
    std::vector<double> numbers;
    std::istringstream words(text.substr(text.find("# drumlin note " + note + " ") + 16 + note.size()));
    char comma = ',';
    for (double number = 0.0; comma == ',' && words >> number; words.get(comma))
      numbers.push_back(number);
    return numbers;
  };
  const std::vector<double> medians = list("d50"), uniformities = list("C_u");
  ASSERT_EQ(medians.size(), 3u) << text.substr(0, 500);
  ASSERT_EQ(uniformities.size(), 3u);
  EXPECT_NEAR(medians[0], 2 * std::cbrt(0.5 * (std::pow(0.016, 3) + std::pow(0.024, 3))), 1e-3);
  EXPECT_NEAR(medians[1], 0.02 * std::sqrt(2.0), 3e-4);
  EXPECT_NEAR(uniformities[1], std::sqrt(2.0), 0.02);
  EXPECT_LT(medians[2], 0.025); // half of it is finer than 20 mm
  struct Found {
    double area = 0.0, lowest = 1e9, highest = 0.0;
  };
  std::map<int, Found> layers;
  std::istringstream rows(text.substr(text.find("Atoms\n") + 6));
  int id = 0, type = 0;
  for (double size = 0.0, density = 0.0, x = 0.0, y = 0.0, z = 0.0;
       rows >> id >> type >> size >> density >> x >> y >> z;) {
    Found &layer = layers[type];
    layer.area += 0.25 * 3.141592653589793 * size * size;
    layer.lowest = std::min(layer.lowest, y);
    layer.highest = std::max(layer.highest, y);
  }
  ASSERT_EQ(layers.size(), 3u);
  const std::map<int, double> thickness = {{1, 0.3}, {4, 0.2}, {5, 0.1}};
  double below = 0.0;
  for (const auto &[number, layer] : layers) {
    ASSERT_EQ(thickness.count(number), 1u) << number;
    EXPECT_NEAR(layer.area, 0.825 * 1.5 * thickness.at(number), 0.03 * layer.area) << number;
    EXPECT_GT(layer.lowest, below) << number;
    below = layer.highest;
  }
}

// At the ends of the allowed ranges there is an answer, or one line of error.
TEST_F(ToolOptions, TheEndsOfTheRangesHaveAnAnswer) {
  const std::vector<std::vector<std::string>> table = {
      {"--k", "1e-6"},  {"--k", "1e15"},   {"--D", "1e-12"},  {"--D", "1e6"},    {"--omega", "1e9"},
      {"--Fw", "1e-9"}, {"--Fw", "1e15"},  {"--m2", "1e12"},  {"--m2", "1e-6"},  {"--m3", "1e-6"},
      {"--m3", "1e12"}, {"--k23", "1e-6"}, {"--k23", "1e13"}, {"--c23", "1e-9"}, {"--c23", "1e15"},
      {"--g", "1e-9"},  {"--g", "1e6"}};
  for (std::vector<std::string> words : table) {
    SCOPED_TRACE(words[0] + " " + words[1]);
    words.insert(words.begin(), "exact");
    words.insert(words.end(), {"--cycles", "1", "--out", "o"});
    const post::Outcome outcome = run(words);
    if (outcome.status == 0) {
      EXPECT_FALSE(outcome.says("ERROR")) << outcome.output;
      EXPECT_TRUE(fs::exists(folder_ / "o" / "chain.csv"));
    } else {
      EXPECT_LE(outcome.status, 2);
      expect_one_error(outcome.output, "drumlin exact: ");
    }
    fs::remove_all(folder_ / "o");
  }
}

// A solution that takes seconds prints its progress.
TEST_F(ToolOptions, LongWorkShowsProgress) {
  post::Program program;
  program.words = {DRUMLIN_TOOLS, "exact",      "--omega", "0.01",  "--cycles",
                   "300",         "--contacts", "8",       "--out", "o"};
  program.folder = folder_;
  program.output = folder_ / post::program_output_file;
  program.limit = 600.0;
  // One line of progress is enough: run_program() stops the program when this function throws.
  program.line = [](const std::string &line) {
    if (line.rfind("solved to cycle ", 0) == 0) throw std::runtime_error(line);
  };
  EXPECT_THROW(run_program(program), std::runtime_error);
}

} // namespace options

// `drumlin calibrate` as a user meets it: bad input is refused before any run, and leaves no file.
namespace calibrate {

namespace fs = std::filesystem;

// The settings that a calibration writes before it starts an engine, which this test does not have: masses,
// bond and force are divided by the width of the drum, 2 m. Computed by hand: a force of 250 kN at 30 Hz is
// one of 302.5 kN at 33 Hz; k23 = 1500 kg (2 pi 4.82 Hz)^2.
TEST(CalibrateCommand, GivesABedTheRollerPerMetre) {
  const Scratch scratch;
  post::write_files(
      {{scratch / "mine", "width 2 m\ndiameter 1.5 m\ndrum_mass 4 t\nframe_mass 3 t\n"
                          "frequency 30 Hz\nforce 250 kN\n"},
       {scratch / "places", "inputs=" DRUMLIN_SOURCE_DIR "/inputs\nliggghts_plugin=" DRUMLIN_TOOLS
                            "\nliggghts=/no/engine\n"}}); // the plugin: any file
  const Outcome outcome =
      run_program({DRUMLIN_TOOLS, "calibrate", "--target", "k=20e6", "--vary", "k=1e8:1e10", "--roller",
                   "mine", "--balls", "1500", "--set", "frequency=33", "--set", "c23=7", "--out", "out"},
                  {"DRUMLIN_PLACES=" + (scratch / "places").string()}, scratch.path(), 20.0);
  EXPECT_TRUE(
      printed(outcome, {"exciter force per metre 125 kN/m\n", "the engine '/no/engine' cannot be run"}));
  const std::string settings = post::read_text(scratch / "out/study.txt");
  const auto set = [&settings](const std::string &name) {
    std::smatch match;
    const bool found = std::regex_search(settings, match, std::regex("\nset " + name + ",([^\n]+)\n"));
    return found ? std::stod(match[1]) : std::nan("");
  };
  EXPECT_EQ(set("m2"), 2000.0);
  EXPECT_EQ(set("m3"), 1500.0);
  EXPECT_EQ(set("r2"), 0.75);
  EXPECT_EQ(set("c23"), 7.0);
  EXPECT_NEAR(set("k23"), 1375767.6, 0.1);
  EXPECT_NEAR(set("omega"), 207.3451151, 1e-6);
  EXPECT_NEAR(set("Fw"), 151250.0, 1e-6);
}

TEST(CalibrateCommand, KnowsTheMassesOfTheGravelsRoller) {
  const std::string deck = post::read_text(fs::path(DRUMLIN_SOURCE_DIR) / "inputs/bed/variables");
  for (const auto &[name, mass] : {std::pair{"m2", post::gravel_drum}, std::pair{"m3", post::gravel_frame}}) {
    std::smatch match;
    ASSERT_TRUE(std::regex_search(deck, match, std::regex(fmt::format("\n{} +([0-9.e]+)", name))));
    EXPECT_EQ(std::stod(match[1]), mass) << name;
  }
}

} // namespace calibrate

} // namespace
} // namespace drumlin::test
