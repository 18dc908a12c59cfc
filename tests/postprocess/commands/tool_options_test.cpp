// Options with values that are not allowed: each is refused at once, in one line that names it, and nothing
// is written.
#include "runs/parameter_file.h"
#include "support/files.h"
#include "support/process.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"
#include "tests/support/lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

struct Bad {
  std::string line; ///< words with a blank between them; '' is an empty one, LONG has 5000 letters
  std::string says; ///< after "ERROR: drumlin COMMAND: ", or somewhere behind it if it begins with "... "

  std::vector<std::string> words() const {
    std::istringstream in(line);
    std::vector<std::string> all;
    for (std::string word; std::getline(in, word, ' ');)
      all.push_back(word == "''" ? "" : word == "LONG" ? std::string(5000, 'x') : word);
    return all;
  }
};

class ToolOptions : public ::testing::Test {
protected:
  post::Outcome run(std::vector<std::string> words) const {
    words.insert(words.begin(), DRUMLIN_TOOLS);
    return post::run_program(words, {}, folder_);
  }
  /// Expects that a call ends with status 2 and one line.
  void expect_refused(const Bad &bad) const {
    const post::Outcome outcome = run(bad.words());
    const std::string begin = "ERROR: drumlin " + bad.words()[0] + ": ";
    const bool later = bad.says.rfind("... ", 0) == 0;
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_EQ(outcome.output.rfind(later ? begin : begin + bad.says, 0), 0u) << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    EXPECT_TRUE(printed(outcome, later ? bad.says.substr(4) : bad.says));
  }
  const Scratch scratch_;
  const fs::path folder_ = scratch_.path();
};

// Longer than other tests: it has a line for each mistake.
TEST_F(ToolOptions, AbsurdValuesAreRefusedAtOnce) {
  const std::vector<Bad> table = {
      {"exact --k '' --out o", "--k is ''; allowed: a number from 1e-06 to 1e+15 [N/m]"},
      {"exact --omega 1e-308 --out o", "--omega is '1e-308'; allowed: a number from 1e-06"},
      {"exact --k 1e18 --out o", "--k is '1e18'; allowed: "},
      {"exact --cycles '' --out o", "--cycles is ''; allowed: "},
      {"exact --out LONG", "... (5000 characters)'; allowed: a path of at most "},
      {"exact --out a\nb\x01 --k 1\n2", "--k is '1?2'; allowed: "},
      {"advise --omega 1e-308", "--omega is '1e-308'; allowed: a number from 1e-06"},
      {"advise --omega 1e-6", "--omega is '1e-06'; allowed: at least "},
      {"advise --frequency 1e-6", "--frequency is '1e-06'; allowed: at least 0.00421 rad/s, 0.000671 Hz"},
      {"advise --frequency 20 --omega 125", "--frequency is '20'; allowed: without --omega"},
      {"advise --roller nowhere", "--roller is 'nowhere'; allowed: a file that can be read"},
      {"advise --setting high", "--setting is 'high'; allowed: only with --roller"},
      {"advise --case CA6500-low", "... inputs/rollers/CA6500 --setting low"},
      {"advise --bed --question force --roller r", "--roller is 'r'; allowed: without --bed"},
      {"advise --bed --question force --frequency 20", "--frequency is '20'; allowed: without --bed"},
      {"advise --D 1e18", "--D is '1e18'; allowed: 0, or a number from 1e-12 to 1e+06"},
      {"advise --m2 inf", "--m2 is 'inf'; allowed: "},
      {"advise --error ''", "--error is ''; allowed: "},
      {"advise --error 1e-308", "--error is '1e-308'; allowed: "},
      {"advise --cycles 1e9", "--cycles is '1e9'; allowed: a whole number from 1 to 10000000"},
      {"advise --from ''", "--from is ''; allowed: "},
      {"advise --from LONG", "... (5000 characters)'; allowed: "},
      {"advise --bed", "--question is ''; allowed: force, acceleration, settlement, stiffness"},
      {"advise --bed --question noise",
       "--question is 'noise'; allowed: force, acceleration, settlement, stiffness"},
      {"advise --bed --question force --within -3%", "--within is '-3%'; allowed: a share above 0"},
      {"advise --bed --question force --within 2mm",
       "--within is '2mm'; allowed: a share above 0, as 10% or 0.1, up to 1000%"},
      {"advise --bed --question settlement --within 0mm",
       "--within is '0mm'; allowed: a share above 0, as 10% or 0.1, up to 1000%, or a settlement per cycle, "
       "as 2mm"},
      {"advise --bed --question force --from nowhere",
       "--from is 'nowhere'; allowed: folders of a study of beds, with plan and runs.csv"},
      {"advise --bed --question force --k 1e8", "--k is '1e8'; allowed: without --bed"},
      {"advise --within 5%", "--within is '5%'; allowed: with --bed"},
      {"advise --ends --question tilt", "--ends is 'given'; allowed: none; inputs/study/ends/findings.md"},
      {"study fidelity --balls 5 --out o", "--balls is '5'; allowed: a whole number from 100"},
      {"advise --case LONG", "... (5000 characters)'; allowed: I, II, III, IV"},
      {"bed --width 1e18", "--width is '1e18'; allowed: a number from 1e-06 to 100000 [m]"},
      {"bed --width 1e5 --depth 1e5 --height 1e5", "--width is '100000'; allowed: a box"},
      {"bed --depth 1e-300", "--depth is '1e-300'; allowed: 0, or "},
      {"bed --height nan", "--height is 'nan'; allowed: 0, or "},
      {"bed --radius-min 1e-300", "--radius-min is '1e-300'; allowed: "},
      {"bed --radius-max 1e300", "--radius-max is '1e300'; allowed: "},
      {"bed --radius-min 1e-5", "--radius-max is '0.024'; allowed: "},
      {"bed --balls 1e18", "--balls is '1e18'; allowed: a whole number from 1 to 10000000"},
      {"bed --balls ''", "--balls is ''; allowed: "},
      {"bed --density 1e308", "--density is '1e308'; allowed: a number from 0.001 to 1e+06 [kg/m3]"},
      {"bed --seed -1", "--seed is '-1'; allowed: a whole number from 0 to 18446744073709551615"},
      {"bed --grading ''", "--grading is ''; allowed: uniform, mass"},
      {"bed --sieve ''", "--sieve is ''; allowed: "},
      {"bed --sieve sand", "--sieve is 'sand'; allowed: a CSV file with the columns size (mm) and passing "
                           "(%) or retained (%), or one of M147-B, "},
      {"bed --sieve WMM --radius-max 0.02", "--sieve is 'WMM'; allowed: without --radius-max"},
      {"bed --sieve WMM --grading mass", "--sieve is 'WMM'; allowed: without --grading"},
      {"bed --layer 0", "--layer is '0'; allowed: a number from 1e-06 to 100000 [m]"},
      {"bed --layer -0.1", "--layer is '-0.1'; allowed: a number from 1e-06 to 100000 [m]"},
      {"bed --layer 0.2:", "--layer is ''; allowed: "},
      {"bed --layer 0.2 --layer 0.01", "--layer is '0.01'; allowed: a number from 0.048 to 100000 [m]: at "
                                       "least as thick as its largest ball"},
      {"bed --layer 0.05:WMM:20", "--layer is '0.05'; allowed: a number from 0.053"},
      {"bed --layer 0.2:sand", "--layer is 'sand'; allowed: a CSV file with the columns"},
      {"bed --layer 0.2:48-32", "--layer is '48-32'; allowed: a CSV file with the columns"},
      {"bed --layer 0.2:WMM:60", "--layer is '60'; allowed: a number from 0.075 and below 53 [mm]"},
      {"bed --layer 0.2:WMM:20:1", "--layer is '0.2:WMM:20:1'; allowed: THICKNESS[:SIEVE[:CUT]]"},
      {"bed --layer 0.2 --height 1", "--layer is '0.2'; allowed: without --height"},
      {"bed --layer 0.2 --sieve WMM", "--layer is '0.2'; allowed: without --sieve"},
      {"bed --layer 1e4", "--layer is '1e4'; allowed: layers of at most 10000000 balls in all"},
      {"bed --layer 0.2:WMM --balls 5", "--balls is '5'; allowed: at least "},
      {"bed --layer 0.2 --balls 500", "--balls is '500'; allowed: only with a layer THICKNESS:SIEVE"},
      {"bed --layer 0.2:WMM:20 --balls 500", "--balls is '500'; allowed: only with a layer THICKNESS:SIEVE"},
      {"bed --layer 0.2:WMM:20 --radius-min 0.01", "--layer is '0.2:WMM:20'; allowed: without --radius-min"},
      {"bed --layer 0.2 --relative-density 1.2",
       "--relative-density is '1.2'; allowed: a number from 0 to 1"},
      {"bed --layer 0.2 --relative-density -0.1",
       "--relative-density is '-0.1'; allowed: a number from 0 to 1"},
      {"bed --layer 0.2 --relative-density x", "--relative-density is 'x'; allowed: a number from 0 to 1"},
      {"bed --relative-density 0.5", "--relative-density is '0.5'; allowed: only with --layer"},
      {"bed --packings a.csv", "--packings is 'a.csv'; allowed: only with --layer"},
      {"bed --layer 0.2 --packings a.csv", "--packings is 'a.csv'; allowed: only with --relative-density"},
      {"bed --layer 0.2 --relative-density 1 --packings none.csv",
       "--packings is 'none.csv'; allowed: the density.csv of a run of inputs/soil/in.density"},
      {"bed --layer 0.2 --relative-density 1 --relative-density 0",
       "--relative-density is '0'; allowed: once, or once for each of the 1 layers"},
      {"bed --layer 0.2:WMM:20 --relative-density 1",
       "--relative-density is '1'; allowed: of layers without a sieve curve"},
      {"bed --layer 0.2 --relative-density 1 --radius-max 0.03",
       "--relative-density is '1'; allowed: with --packings"},
      {"bed --cut 8", "--cut is '8'; allowed: only with --sieve"},
      {"bed --sieve WMM --cut 53", "--cut is '53'; allowed: a number from 0.075 and below 53 [mm]"},
      {"bed --sieve WMM --cut 0.01", "--cut is '0.01'; allowed: a number from 0.075"},
      {"bed --sieve WMM --cut x", "--cut is 'x'; allowed: "},
      {"bed --sieve WMM --width 0.05", "--width is '0.05'; allowed: a number from 0.053 "},
      {"bed --sieve WMM --width 0.05 --cut 9", "--width is '0.05'; allowed: "},
      {"bed --sieve WMM --balls 100", "--balls is '100'; allowed: at least "},
      {"bed --out ''", "--out is ''; allowed: "},
      {"meter ''", "RECORD is ''; allowed: "},
      {"meter r --window 5", "--window is '5'; allowed: an even whole number of cycles from 4"},
      {"meter r --window 2", "--window is '2'; allowed: an even"},
      {"meter r --window nans", "--window is 'nan'; allowed: a number from "},
      {"meter r --rmv-constant 0", "--rmv-constant is '0'; allowed: "},
      {"meter r --drum-radius 0.7", "--drum-width is ''; allowed: "},
      {"meter r --drum-radius 0.7 --drum-width 2 --poisson 0.6",
       "--poisson is '0.6'; allowed: a number from 0 to 0.5"},
      {"meter r --poisson 0.3", "--poisson is '0.3'; allowed: only with --drum-radius"},
      {"meter r --roller nowhere", "--roller is 'nowhere'; allowed: a file that can be read"},
      {"meter r --roller LONG", "... (5000 characters)'; allowed: a path"},
      {"meter r --setting high", "--setting is 'high'; allowed: only with --roller"},
      {"meter r --case BW120-63Hz", "... inputs/rollers/BW120 --setting 63Hz"},
      {"identify r --roller ''", "--roller is ''; allowed: "},
      {"identify r --case Axas2020-29Hz", "... inputs/rollers/Axas2020 --setting 29Hz"},
      {"meter r --export=all.csv --speed 3", "--export is 'given'; allowed: none; meter.csv in --out"},
      {"passes --field site.csv", "--field is 'given'; allowed: none, but folders of runs: FOLDER..."},
      {"passes", "... FOLDER is required"},
      {"map --x k:1e6:1e8:5 --k 3e6", "--k is '3e6'; allowed: not together with the axis k of --x"},
      {"map --x k:1e6:1e8:5 --identify -1", "--identify is '-1'; allowed: a whole number from 0 to 1000000"},
      {"map --x k:1e6:1e8:5 --y D:0.1:0.5:3 --identify 2",
       "--identify is '2'; allowed: only with --x and without --y"},
      {"map --drum-width 2", "--drum-width is '2'; allowed: only with --x and without --y"},
      {"map --sweep k:1e6:1e8:5 --poisson 0.3", "--poisson is '0.3'; allowed: only with --x and without --y"},
      {"map --x k:1e6:1e8:5 --drum-width 2", "--drum-radius is ''; allowed: a number [m], for E_vib"},
      {"map --x k:1e6:1e8:1", "--x is 'k:1e6:1e8:1'; allowed: a whole number for COUNT from 2"},
      {"map --x k:1e6:1e8:5 --sweep k:1e6:1e8:5", "--sweep is 'k:1e6:1e8:5'; allowed: without --x and --y"},
      {"map --D 0.3", "--D is '0.3'; allowed: not together with the axis D of --y"},
      {"map --sweep Fw:1e4:1e5:5 --Fw 2e4",
       "--Fw is '2e4'; allowed: not together with the axis Fw of --sweep"},
      {"map --x frequency:20:40:5 --omega 100",
       "--omega is '100'; allowed: not together with the axis frequency of --x"},
      {"map --x frequency:20:40:5 --frequency 30",
       "--frequency is '30'; allowed: not together with the axis frequency of --x"},
      {"map --sweep omega:20:40:5 --frequency 30",
       "--frequency is '30'; allowed: not together with the axis omega of --sweep"},
      {"map --x frequency:20:40:5 --y omega:100:200:5",
       "--y is 'omega:100:200:5'; allowed: another NAME than that of --x"},
      {"map --x frequency:0:40:5", "--x is 'frequency:0:40:5'; allowed: FROM and TO for frequency: a number "
                                   "from 1e-06 to 1e+08 [Hz]"},
      {"map --x Omega:1:2:3", "--x is 'Omega:1:2:3'; allowed: a NAME of k, D, omega, frequency, Fw"},
      {"map --roller nowhere", "--roller is 'nowhere'; allowed: a file that can be read"},
      {"map --roller .", "--roller is '.'; allowed: a file that can be read"},
      {"map --sweep k:1e6:1e8:5 --threads 2", "--threads is '2'; allowed: without --sweep"},
      {"meter r --column a_drum", "--column is 'a_drum'; allowed: NAME=HEADER"},
      {"meter r --column a_drum=Z:kN", "... the unit is 'kN'; allowed: m/s2, cm/s2"},
      {"meter r --frequency -29", "--frequency is '-29'; allowed: "},
      {"meter r --Fw 1 --me-re 1", "--me-re is '1'; allowed: not together with --Fw"},
      {"meter r --out LONG", "... (5000 characters)'; allowed: "},
      {"report LONG", "DIR is 'x"},
      {"report '' --out o", "DIR is ''; allowed: "},
      {"report . --out ''", "--out is ''; allowed: "},
      {"report . --out LONG", "... (5000 characters)'; allowed: "},
      {"bed --out LONG", "... (5000 characters)'; allowed: "},
      {"study fidelity --jobs 1e9", "--jobs is '1e9'; allowed: a whole number from 1 to 1000"},
      {"study fidelity --jobs ''", "--jobs is ''; allowed: "},
      {"study fidelity --out ''", "--out is ''; allowed: "},
      {"study meter --out LONG", "... (5000 characters)'; allowed: "},
      {"study meter --keep", "--keep is given; allowed: with a study that is a plan"},
      {"study LONG", "... (5000 characters)'; allowed: "},
      {"demo --cycles 0", "--cycles is '0'; allowed: a whole number from 1 to 10000000"},
      {"demo --cycles ''", "--cycles is ''; allowed: "},
      {"demo --balls 1e18", "--balls is '1e18'; allowed: a whole number from 300 to 10000000"},
      {"demo --balls 299", "--balls is '299'; allowed: "},
      {"demo more", ""},
      {"run", "the deck is missing; allowed: "},
      {"run -np", "-np is ''; allowed: a whole number from 1 to 1000000"},
      {"run -np 0 chain/in.chain", "-np is '0'; allowed: "},
      {"run -np 1 -np 1.5 chain/in.chain", "-np is '1.5'; allowed: "},
      {"run ''", "deck '' cannot be read; allowed: a deck such as "},
      {"run report", "deck 'report' cannot be read; allowed: "},
      {"run --engine lammps chain/in.chain", "deck '--engine' cannot be read; allowed: "},
      {"run a\nb", "deck 'a b' cannot be read; allowed: "},
      {"vtk ''", "DIR is ''; allowed: "},
      {"vtk LONG", "... (5000 characters)'; allowed: "},
      {"vtk . --out LONG", "... (5000 characters)'; allowed: "},
      {"vtk . --cell 1e-308", "--cell is '1e-308'; allowed: a number from 1e-09"},
  };
  for (const Bad &bad : table) {
    SCOPED_TRACE(bad.line);
    const auto begin = std::chrono::steady_clock::now();
    expect_refused(bad);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
    fs::remove(folder_ / "screen.txt");
    EXPECT_TRUE(fs::is_empty(folder_));
  }
}

TEST_F(ToolOptions, SieveFilesThatAreNoCurveAreRefused) {
  const fs::path file = folder_ / "s.csv";
  const std::string header = "size (mm),passing (%)\n";
  const std::vector<std::pair<std::string, std::string>> table = {
      {"", "s.csv: the file is empty; allowed: a table of numbers"},
      {header, "s.csv: no line has numbers; allowed: a table of numbers"},
      {"size (mm),finer (%)\n1,100\n", "passing (%)"},
      {header + "4,10\n8,5\n16,100\n", "s.csv, line 3, column 'passing (%)' is '5'; allowed: at least 10, "
                                       "which passes the finer sieve before"},
      {header + "4,0\n4,50\n16,100\n",
       "s.csv, line 3, column 'size (mm)' is '4'; allowed: more than 4, the size before"},
      {header + "4,0\n16,100\n8,50\n", "s.csv, line 4, column 'size (mm)' is '8'; allowed: more than 16"},
      {"size (g),passing (%)\n4,0\n8,100\n", "column 'size (g)': its unit is 'g'; allowed: m, cm, mm, um"},
      {"size (mm),retained (%)\n4,70\n8,40\n16,0\n", "column 'retained (%)': the sum is '110'; allowed: "},
      {"size (mm),retained (g)\n4,70\n8,-4\n16,0\n", "line 3, column 'retained (g)' is '-4'; allowed: "},
      {header + "4,0\n8,100.5\n",
       "s.csv, line 3, column 'passing (%)' is '100.5'; allowed: a number from 0 to 100 [%]"},
      {header + "4,-1\n8,100\n", "s.csv, line 2, column 'passing (%)' is '-1'; allowed: "},
      {header + "4,half\n8,100\n", "s.csv, line 2, column 'passing (%)' is 'half'; allowed: "},
      {header + "4,nan\n8,100\n", "s.csv, line 2, column 'passing (%)' is 'nan'; allowed: "},
      {header + "0,5\n8,100\n",
       "s.csv, line 2, column 'size (mm)' is '0'; allowed: a number from 1e-06 to 1e+06 [mm]"},
      {header + "4,0\n8,90\n", "s.csv, line 3, column 'passing (%)' is '90'; allowed: 100 in the last row"},
      {header + "8,100\n",
       "s.csv, line 2, column 'passing (%)' is '100'; allowed: less than 100 in the first row"},
      {header + "4\n8,100\n", "the column is 'size'; allowed: "},
      {header + "4,0\n8\n16,100\n", "s.csv, line 3: the number of cells is '1'; allowed: 2 as in line 2"},
  };
  for (const auto &[text, says] : table) {
    SCOPED_TRACE(says);
    std::ofstream(file) << text;
    expect_refused({"bed --sieve s.csv --out out/balls.data", "... " + says});
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  }
  expect_refused({"bed --sieve .", "... it is a folder"});
}

// A curve of three sieves whose numbers are exact by hand: half of the mass between 10 and 20, half between
// 20 and 40 mm, nothing is cut.
TEST_F(ToolOptions, SieveFileMakesABedAndItsGrading) {
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
  const std::vector<Bad> table = {
      {"bed --sieve bed.csv --out bed.csv",
       "--out is 'bed.csv'; allowed: another file than --sieve 'bed.csv'"},
      {"bed --sieve bed.csv --out hard.data",
       "--out is 'hard.data'; allowed: another file than --sieve 'bed.csv'"},
      {"bed --sieve bed_grading.csv --out bed.data",
       "--out is 'bed_grading.csv'; allowed: another file than --sieve 'bed_grading.csv', which is read"},
      {"bed --layer 0.1:bed.csv:20 --out bed.csv", "--out is 'bed.csv'; allowed: another file than --layer"},
      {"run mine.in -log ./mine.in",
       "-log is './mine.in'; allowed: another file than DECK 'mine.in', which is read"},
      {"run mine.in -var balls bed.csv -log hard.data",
       "-log is 'hard.data'; allowed: another file than -var 'bed.csv'"}};
  for (const Bad &bad : table) {
    expect_refused(bad);
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
    if (words[0] == "study") words.emplace_back("stability");
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
    std::vector<std::string> words = {"map", "--sweep", "k:5e6:100e6:40", "--D",
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
            "60", "--out", "run"}));
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
  for (const auto &[words, message] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--spot", "0:0.5"}, "--spot is '0:0.5'; allowed: only with --layer"},
           {{"--layer", "0.3", "--spot", "0.5"}, "--spot is '0.5'; allowed: FROM:TO, "},
           {{"--layer", "0.3", "--spot", "0:x"}, "--spot is '0:x'; allowed: FROM:TO, "},
           {{"--layer", "0.3", "--spot", "0.5:0"}, "--spot is '0.5:0'; allowed: FROM:TO, "},
           {{"--layer", "0.3", "--spot", "0:0.01"}, "at least 0.048 m long"},
           {{"--layer", "0.3", "--spot", "0:9"}, "--spot is '0:9'; allowed: FROM:TO, "},
           {{"--layer", "0.3", "--spot", "0:0.3", "--spot", "0.2:0.5"}, "--spot is '0.2:0.5'; allowed: "}}) {
    std::vector<std::string> all = {"bed", "--width", "2", "--out", "none.data"};
    all.insert(all.end(), words.begin(), words.end());
    const post::Outcome outcome = run(all);
    EXPECT_EQ(outcome.status, 2);
    expect_one_error(outcome.output, "drumlin bed: ");
    EXPECT_TRUE(printed(outcome, message));
    EXPECT_FALSE(fs::exists(folder_ / "none.data"));
  }
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
      {"--k", "1e-6"},  {"--k", "1e15"},   {"--D", "1e-12"},   {"--D", "1e6"},    {"--omega", "1e9"},
      {"--Fw", "1e-9"}, {"--Fw", "1e15"},  {"--m2", "1e12"},   {"--m2", "1e-6"},  {"--m3", "1e-6"},
      {"--m3", "1e12"}, {"--k23", "1e-6"}, {"--k23", "1e13"},  {"--c23", "1e-9"}, {"--c23", "1e15"},
      {"--g", "1e-9"},  {"--g", "1e6"},    {"--rtol", "1e-14"}};
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
  program.words = {DRUMLIN_TOOLS, "exact", "--omega", "0.01", "--cycles", "70", "--out", "o"};
  program.folder = folder_;
  program.output = folder_ / post::program_output_file;
  program.limit = 60.0;
  // One line of progress is enough: run_program() stops the program when this function throws.
  program.line = [](const std::string &line) {
    if (line.rfind("solved to cycle ", 0) == 0) throw std::runtime_error(line);
  };
  EXPECT_THROW(run_program(program), std::runtime_error);
}

} // namespace
} // namespace drumlin::test
