// `drumlin identify` as a user meets it: the program itself, its files, its messages, its exit status.
#include "tests/support/changing_roller.h"
#include "tests/support/page.h"
#include "tests/support/tool.h"
#include "chain/exact_solution.h"
#include "runs/parameter_file.h"

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

// A folder as of a run: chain.csv and parameters.csv of case II B.
void write_run(const fs::path &folder, int cycles = 12) {
  const post::ChainParameters p = post::table1_case("II", post::Transition::B);
  fs::create_directories(folder);
  post::write_files({{folder / "chain.csv", post::chain_text(post::solve_chain(p, cycles, 200).history)},
                     {folder / "parameters.csv", post::parameters_text(post::parameter_values(p))}});
}

/// A roller of the project without its tolerances, whose effect takes an identification each, and its chain
/// on the soil of case II by hand.
const std::vector<std::string> roller =
    words_of("--roller {} --setting low --m2-tolerance 0 --m3-tolerance 0",
             (fs::path(DRUMLIN_SOURCE_DIR) / "inputs/rollers/CA3500").string());
post::ChainParameters low_CA3500() {
  post::ChainParameters p = post::table1_case("II", post::Transition::B);
  p.m2 = 3955;
  p.m3 = 3713;
  p.k23 = 3.1e6;
  p.c23 = 3.1e4;
  p.omega = 68.0 * M_PI;
  p.Fw = 3.725 * p.omega * p.omega;
  return p;
}

class IdentifyCommand : public Tool {
protected:
  Outcome identify(const std::vector<std::string> &words) const { return drumlin("identify", words); }
  // One line of error, and no results.
  void expect_refused(const std::vector<std::string> &words, const std::string &message) const {
    const Outcome outcome = identify(words);
    EXPECT_FALSE(outcome.ok());
    expect_one_error(outcome.output, "drumlin identify: ");
    EXPECT_TRUE(printed(outcome, message));
    EXPECT_FALSE(fs::exists(scratch_ / "results"));
  }
};

// Soil of 24 and 16 MN/m below the halves of a drum whose ends lift off: from the folder of the run, and from
// a measured file of three accelerations with a roller.
TEST_F(IdentifyCommand, TellsTheSoilBelowEachHalf) {
  post::write_files(
      {{scratch_ / "soil.csv", "y (m),k (N/m),c (N s/m)\n-0.6148,24e6,6e4\n0.6148,16e6,5e4\n"}});
  const std::string axas = (fs::path(DRUMLIN_SOURCE_DIR) / "inputs/rollers/Axas2020").string();
  well(run_program(
      tool_words("exact --roller {} --contacts soil.csv --cycles 35 --samples-per-cycle 40 --out run", axas),
      {}, scratch_.path(), 100.0));
  const post::Table run = post::read_table(scratch_ / "run/chain.csv");
  std::string measured = "t,L,R,F\n";
  for (std::size_t i = 800; i < run.rows(); ++i) {
    std::vector<std::string> cells;
    for (const char *column : {"time", "a_left", "a_right", "a_frame"})
      cells.push_back(run.text(column)[i]);
    measured += post::csv_line(cells);
  }
  post::write_files({{scratch_ / "two.csv", measured}});
  const std::vector<std::string> sensors = words_of("--column time=t --column a_left=L --column a_right=R");
  const auto with = [](std::vector<std::string> words, const std::vector<std::string> &more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  const std::vector<std::string> roller_said = {"--roller", axas, "--phase", "0"};
  const std::vector<std::string> file = with({"two.csv"}, sensors);
  for (const auto &words : {std::vector<std::string>{"run"}, with(file, roller_said),
                            with(with(file, roller_said), {"--column", "a_frame=F"})}) {
    SCOPED_TRACE(words.size());
    const Outcome outcome = well(identify(with(words, {"--out", "found"})));
    EXPECT_TRUE(printed(outcome, "left half: k = "));
    const post::Table table = post::read_table(scratch_ / "found/identify.csv");
    EXPECT_EQ(table.text("half"), (std::vector<std::string>{"left", "right", "both"}));
    const std::vector<double> k = table.numbers("k [N/m]");
    EXPECT_NEAR(k[0], 24e6, 2e-4 * 24e6);
    EXPECT_NEAR(k[1], 16e6, 2e-4 * 16e6);
    EXPECT_NEAR(k[2], 40e6, 2e-4 * 40e6);
    EXPECT_NEAR(post::number_from_text(table.text("c [N s/m]")[0]), 6e4, 1e-3 * 6e4);
    EXPECT_NEAR(post::number_from_text(table.text("left over right [-]")[2]), 1.5, 3e-4);
  }
  // An exciter that stands 2 cm from where the file has it, which says so: the truth is within that.
  post::write_files({{scratch_ / "aside", read_text(axas).replace(0, 0,
                                                                  "exciter_place 2 cm\n"
                                                                  "exciter_place_tolerance 2 cm\n")}});
  draw();
  well(identify(with(file, words_of("--column a_frame=F --roller aside --phase 0 --out found"))));
  for (const char *made : {"index.html", "data/halves.csv", "figures/halves.png"})
    EXPECT_TRUE(fs::is_regular_file(scratch_ / "found" / made)) << made;
  const post::Table aside = post::read_table(scratch_ / "found/identify.csv");
  for (const auto &[half, k] : {std::pair{std::size_t{0}, 24e6}, std::pair{std::size_t{1}, 16e6}}) {
    const double off = std::fabs(post::number_from_text(aside.text("k [N/m]")[half]) - k);
    const double within = post::number_from_text(aside.text("k_machine [N/m]")[half]);
    const double noise = post::number_from_text(aside.text("k_half_width [N/m]")[half]);
    EXPECT_GT(within, 0.0);
    EXPECT_LT(off, 1.2 * std::hypot(within, noise));
  }
  const std::vector<std::string> out = {"--out", "results"};
  const std::vector<std::string> plain =
      words_of("--frequency 29 --me-re 7.31 --m2 3962.07 --m3 3379 --phase 0 --column a_frame=F");
  expect_refused(with(with(file, plain), out), "two.csv: drum_inertia is ''; allowed: --roller with a file");
  expect_refused(with(with({"two.csv", "--column", "time=t", "--column", "a_left=L"}, roller_said), out),
                 "two.csv: a_right is ''; allowed: sensors at both ends of the drum");
  expect_refused(with(with(file, roller_said), with({"--compare"}, out)),
                 "--compare is ''; allowed: not given for a record of both ends");
  expect_refused(with(with(file, roller_said), with({"--logger-low-pass", "200,4"}, out)),
                 "--logger-low-pass is '200,4'; allowed: not given for a record of both ends");
  // Sensors that are mixed up, or one that is turned: no motion of this machine.
  expect_refused(
      with(with(words_of("two.csv --column time=t --column a_left=L --column a_right=R:-m/s2"), roller_said),
           out),
      "");
}

TEST_F(IdentifyCommand, WritesAnswerTableAndPage) {
  draw();
  write_run(scratch_ / "run");
  const Outcome outcome = well(identify({"run", "--window", "6", "--out", "found"}));
  EXPECT_TRUE(outcome.says("k = 99.99") || outcome.says("k = 100.00")) << outcome.output;
  EXPECT_TRUE(printed(outcome, "does not pull (transition B)"));
  const post::Table table = post::read_table(scratch_ / "found/identify.csv");
  EXPECT_EQ(table.text("window"), (std::vector<std::string>{"all", "1", "7"}));
  for (const double k : table.numbers("k [N/m]"))
    EXPECT_NEAR(k, 1e8, 1e4);
  EXPECT_EQ(table.text("pulls").front(), "no");
  for (const char *file : {"index.html", "data/loop.csv", "figures/loop.png", "figures/residuals.svg",
                           "figures/along.png", "data/windows.csv"})
    EXPECT_TRUE(fs::is_regular_file(scratch_ / "found" / file)) << file;
  // A second call replaces the results.
  well(identify({"run", "--accelerations-only", "--out", "found"}));
  EXPECT_EQ(post::read_table(scratch_ / "found/identify.csv").rows(), 2U);
}

// Of a way over two soils each part tells its own, also on the way back.
TEST_F(IdentifyCommand, TakesAPartOfTheWay) {
  post::write_files(
      {{scratch_ / "way", "s (m),k (N/m),D (-)\n0,2e7,0.25\n6,2e7,0.25\n6,4e7,0.25\n12,4e7,0.25\n"}});
  well(run_program(tool_words("exact --case II --transition B --way way --speed 2 --passes 2 --out driven"),
                   {}, scratch_.path()));
  for (const char *pass : {"1", "2"})
    for (const auto &[from, to, k] : {std::tuple{"1", "5.9", 2e7}, {"6.1", "11", 4e7}}) {
      const Outcome outcome =
          identify(words_of("driven --from-place {} --to-place {} --of-pass {} --window 1m", from, to, pass));
      well(outcome);
      EXPECT_TRUE(printed(outcome, "A window averages the soil over"));
      EXPECT_TRUE(printed(outcome, "falls to a hundredth"));
      const post::Table table = post::read_table(scratch_ / "results/identify/identify.csv");
      EXPECT_NEAR(table.numbers("k [N/m]")[0], k, 1e-3 * k);
      EXPECT_NEAR(table.numbers("D [-]")[0], 0.25, 1e-3);
      const std::vector<double> begin = table.numbers("s_begin [m]"), end = table.numbers("s_end [m]");
      ASSERT_GE(begin.size(), 4U);
      const double tolerance = 2.0 / 40.0; // half a cycle
      EXPECT_NEAR(std::min(begin[0], end[0]), std::stod(from), tolerance);
      EXPECT_NEAR(std::max(begin[0], end[0]), std::stod(to), tolerance);
      for (std::size_t i = 1; i < begin.size(); ++i)
        EXPECT_NEAR(std::abs(end[i] - begin[i]), 1.0, tolerance);
    }
  write_run(scratch_ / "run");
  fs::remove_all(scratch_ / "results");
  expect_refused({"run", "--from-place", "1"}, "has no column s");
  expect_refused({"run", "--window", "1m"},
                 "--window is '1m'; allowed: metres only for a roller that drives");
  expect_refused({"driven", "--window", "0.05m"}, "--window is '0.05m'; allowed: ");
  expect_refused({"driven", "--from-place", "3", "--to-place", "3.2"}, "the number of cycles on the part");
}

// A deck of one's own may have its x_drum = 0 anywhere: the file's name does not tell.
TEST_F(IdentifyCommand, KnowsTheOriginOfItsOwnRunsAlone) {
  write_run(scratch_ / "run");
  const std::map<std::string, std::string> noted = post::read_parameters(scratch_ / "run/parameters.csv");
  post::ChainHistory history = post::read_chain(scratch_ / "run/chain.csv");
  for (double &x : history.x_drum)
    x += 0.75;
  post::write_files({{scratch_ / "run/chain.csv", post::chain_text(history)}});
  fs::remove(scratch_ / "run/parameters.csv");
  const std::vector<std::string> own =
      words_of("run --frequency 20 --m2 {} --m3 {}", noted.at("m2"), noted.at("m3"));
  std::vector<std::string> words = own;
  words.insert(words.end(), {"--origin", "known"});
  expect_refused(words, "; to be checked: ");
  words = own;
  words.insert(words.end(), {"--out", "found"});
  well(identify(words));
  EXPECT_NEAR(post::read_table(scratch_ / "found/identify.csv").numbers("k [N/m]").front(), 1e8, 1e5);
}

// A pass whose exciter changes from 280 to 150 kN: the longer part answers for itself, and the other one when
// asked.
TEST_F(IdentifyCommand, AnswersForOneSettingOfTheExciter) {
  ChangingRoller driven;
  driven.me_re = [](double t) { return t < 5.0 ? 7.38 : 3.95; };
  const SeenMotion seen = seen_motion(driven, 1054.0, 9.0, 0.1, 1);
  std::string text = "time,a_drum,a_frame\n";
  for (std::size_t i = 0; i < seen.time.size(); ++i)
    text += post::csv_line({post::number_text(seen.time[i]), post::number_text(seen.a_drum[i]),
                            post::number_text(seen.a_frame[i])});
  post::write_files({{scratch_ / "pass.csv", text}});
  const auto k_of = [&](const std::vector<std::string> &more, const char *said) {
    std::vector<std::string> words =
        words_of("pass.csv --frequency 31 --m2 3955 --m3 3713 --out found --phase 0");
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_TRUE(printed(well(identify(words)), said));
    EXPECT_TRUE(contains(post::read_text(scratch_ / "found/index.html"), said));
    return post::read_table(scratch_ / "found/identify.csv").numbers("k [N/m]").front();
  };
  EXPECT_NEAR(k_of({"--me-re", "7.38"}, "it is piece 1 of 2"), 40e6, 0.01 * 40e6);
  EXPECT_NEAR(k_of({"--me-re", "3.95", "--piece", "2"}, "it is piece 2 of 2"), 40e6, 0.02 * 40e6);
}

TEST_F(IdentifyCommand, DrawsTheChainOverTheRecord) {
  draw();
  write_run(scratch_ / "run");
  EXPECT_TRUE(printed(well(identify({"run", "--compare", "--out", "found"})),
                      "No difference beyond scatter: the drum's peak acceleration, the peak contact force"));
  for (const char *file :
       {"figures/chain_and_bed.png", "figures/cycle_by_cycle.svg", "data/chain_and_record.csv"})
    EXPECT_TRUE(fs::is_regular_file(scratch_ / "found" / file)) << file;
  expect_sound_page(scratch_ / "found", 5);
  // A measured record does not have the bond.
  std::string parameters = read_text(scratch_ / "run/parameters.csv");
  const std::size_t bond = parameters.find("k23,");
  post::write_files(
      {{scratch_ / "run/parameters.csv", parameters.erase(bond, parameters.find('\n', bond) + 1 - bond)}});
  expect_refused({"run", "--compare"}, "k23 is ''; allowed: a number in parameters.csv");
  // It is refused before the identification, which would refuse a record without m3.
  const std::size_t frame = parameters.find("\nm3,");
  post::write_files(
      {{scratch_ / "run/parameters.csv", parameters.erase(frame, parameters.find('\n', frame + 1) - frame)}});
  expect_refused({"run"}, "m3 is ''");
  expect_refused({"run", "--compare"}, "k23 is ''; allowed: a number in parameters.csv");
}

// What a roller has: accelerations in g with names of their own, no times, a phase.
TEST_F(IdentifyCommand, ReadsAMeasuredRecord) {
  const post::ChainParameters p = post::table1_case("III", post::Transition::A);
  const post::ChainHistory history = post::solve_chain(p, 20, 100).history;
  std::string text = "Acc drum,Acc frame\n";
  constexpr double in_g = 1.0 / 9.80665;
  for (std::size_t i = 0; i < history.size(); ++i)
    text += post::csv_line(
        {post::number_text(-in_g * history.a_drum[i]), post::number_text(in_g * history.a_frame[i])});
  post::write_files({{scratch_ / "measured.csv", text}});
  EXPECT_TRUE(printed(
      well(identify(words_of("measured.csv --column {} --column {} --sampling-rate 4000 --frequency 40 "
                             "--phase 0 --phase-within 1 --Fw 58800 --m2 2000 --m3 1000 --out found",
                             "a_drum=Acc drum:-g", "a_frame=Acc frame:g"))),
      "The contact pulls (transition A)"));
  const post::Table table = post::read_table(scratch_ / "found/identify.csv");
  EXPECT_NEAR(table.numbers("k [N/m]").front(), p.k, 1e-3 * p.k);
  EXPECT_NEAR(table.numbers("c [N s/m]").front(), p.damping(), 3e-3 * p.damping());
  EXPECT_NEAR(table.numbers("D [-]").front(), p.D, 3e-3 * p.D);
}

// The data of a manufacturer's roller by its file; an option of the command line counts more.
// In unbroken contact the mass of the drum moves k by omega^2 times its error, and c not at all, since its
// inertia is in phase with the displacement: 1 % of 4000 kg at 30 Hz are 1.42122 MN/m, computed by hand.
TEST_F(IdentifyCommand, ShowsWhatTolerancesOfTheMachineDo) {
  post::ChainParameters p;
  p.m2 = 4000.0;
  p.m3 = 3500.0;
  p.k23 = 3.1e6;
  p.c23 = 31e3;
  p.omega = 188.49555921538759;
  p.Fw = 100e3;
  p.k = 1.2e7;
  p.D = 0.3;
  const post::ChainHistory history = post::solve_chain(p, 70, 50).history;
  std::string text = "time,a_drum,a_frame\n";
  for (std::size_t i = 40 * 50; i < history.size(); ++i)
    text += post::csv_line({post::number_text(history.time[i]), post::number_text(history.a_drum[i]),
                            post::number_text(history.a_frame[i])});
  const std::string file = "drum_mass 4000 kg\nframe_mass 3500 kg\nbond_stiffness 3.1 MN/m\n"
                           "bond_damping 31 kN s/m\ndrum_mass_tolerance 1 %\nfrequency 30 Hz\nforce 100 kN\n";
  post::write_files({{scratch_ / "measured.csv", text}, {scratch_ / "mine", file}});
  const auto machine = [&](const std::vector<std::string> &more, const char *column) {
    std::vector<std::string> words =
        words_of("measured.csv --roller mine --phase 0 --phase-within 0 --out found");
    words.insert(words.end(), more.begin(), more.end());
    well(identify(words));
    return std::stod(
        post::read_table(scratch_ / "found/identify.csv").text(column).front()); // of all windows
  };
  EXPECT_NEAR(machine({}, "k_machine [N/m]"), 1.42122e6, 8e3);
  EXPECT_NEAR(machine({}, "c_machine [N s/m]"), 0.0, 50.0);
  EXPECT_NEAR(machine({"--m2-tolerance", "2"}, "k_machine [N/m]"), 2.84245e6, 16e3);
  expect_refused(words_of("measured.csv --roller mine --phase 0 --m2-tolerance -1"),
                 "--m2-tolerance is '-1'; allowed: ");
}

// The drum flies in each cycle, so that the record tells the exciter's force over the mass. Oracle: what the
// command itself finds with a mass that is 1 % larger.
TEST_F(IdentifyCommand, ShowsWhatTolerancesDoWhereTheDrumFlies) {
  const post::ChainParameters p = low_CA3500();
  const post::ChainHistory history = post::solve_chain(p, 25, 60).history;
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.3);
  std::string text = "time,a_drum,a_frame\n";
  for (std::size_t i = 5 * 60; i < history.size(); ++i)
    text += post::csv_line({post::number_text(history.time[i]),
                            post::number_text(history.a_drum[i] + noise(random)),
                            post::number_text(history.a_frame[i] + 0.1 * noise(random))});
  post::write_files({{scratch_ / "measured.csv", text}});
  const auto found = [&](double mass) {
    well(identify(
        words_of("measured.csv --frequency {} --phase 0 --Fw {} --m2 {} --m3 {} --m2-tolerance 1 --out found",
                 post::number_text(p.omega / 6.283185307179586), post::number_text(p.Fw),
                 post::number_text(mass), post::number_text(p.m3))));
    return post::read_table(scratch_ / "found/identify.csv");
  };
  const post::Table said = found(p.m2), other = found(1.01 * p.m2);
  for (const char *name : {"k", "c", "D"}) {
    const std::string column = fmt::format("{} [{}]", name,
                                           name[0] == 'k'   ? "N/m"
                                           : name[0] == 'c' ? "N s/m"
                                                            : "-");
    const double change = std::fabs(other.numbers(column).front() - said.numbers(column).front());
    const double told = std::stod(said.text(fmt::format("{}_machine{}", name, column.substr(1))).front());
    EXPECT_NEAR(told, change, 0.15 * change) << name;
  }
}

TEST_F(IdentifyCommand, TakesTheDataOfARoller) {
  const post::ChainParameters p = low_CA3500();
  const post::ChainHistory history = post::solve_chain(p, 20, 40).history;
  std::string text = "time,a_drum,a_frame\n";
  for (std::size_t i = 0; i < history.size(); ++i)
    text += post::csv_line({post::number_text(history.time[i]), post::number_text(history.a_drum[i]),
                            post::number_text(history.a_frame[i])});
  post::write_files({{scratch_ / "measured.csv", text}});
  const auto found = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"measured.csv", "--out", "found"};
    words.insert(words.end(), roller.begin(), roller.end());
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_TRUE(printed(well(identify(words)),
                        {"eccentric moment        3.725 kg m", "Report these values, of the whole record."}));
    return post::read_table(scratch_ / "found/identify.csv").numbers("k [N/m]").front();
  };
  EXPECT_NEAR(found({"--frequency", "33.5"}), p.k, 1e-4 * p.k);
  EXPECT_NEAR(found({}), p.k, 1e-4 * p.k);
  const std::map<std::string, std::string> noted = post::read_parameters(scratch_ / "found/parameters.csv");
  EXPECT_EQ(noted.at("setting"), "low");
  EXPECT_NEAR(post::number_from_text(noted.at("roller_exciter_force")) / p.Fw, 1.0, 1e-4);
  EXPECT_NEAR(post::number_from_text(noted.at("roller_static_load")), (p.m2 + p.m3) * 9.81, 1e-3);
  EXPECT_NE(
      post::read_text(scratch_ / "found/index.html").find("setting low: 34 Hz, eccentric moment 3.725 kg m"),
      std::string::npos);
  fs::remove_all(scratch_ / "found");
  std::vector<std::string> words = {"measured.csv", "--m2", "3000"};
  words.insert(words.end(), roller.begin(), roller.end());
  expect_refused(words, "the exciter's force is '17");
  words = {"measured.csv", "--compare"};
  words.insert(words.end(), roller.begin(), roller.end());
  expect_refused(words, "--compare is 'measured.csv'; allowed: the record of a run");
  words = {"measured.csv", "--case", "II"};
  words.insert(words.end(), roller.begin(), roller.end());
  expect_refused(words, "--case is 'II'; allowed: without --roller");
  expect_refused({"measured.csv", "--case", "CA3500-low"}, "inputs/rollers/CA3500 --setting low");
  post::write_files({{scratch_ / "wrong", "drum_mass 4 kN\n"}});
  expect_refused({"measured.csv", "--roller", "wrong"},
                 "drum_mass in line 1 of 'wrong' is '4 kN'; allowed: ");
  expect_refused({"measured.csv", "--setting", "low"}, "--setting is 'low'; allowed: only with --roller");
  expect_refused({"measured.csv", "--phase", "0", "--case", "CA9"}, "--case is 'CA9'; allowed: I, II");
}

// Unbroken contact, where nothing tells the phase, and one that is 20 degrees off. With 90 degrees the
// exciter would take energy from the drum.
TEST_F(IdentifyCommand, RefusesAResultThatContradictsItself) {
  post::ChainParameters p = low_CA3500();
  p.k = 1e7;
  const post::ChainHistory history = post::solve_chain(p, 20, 50).history;
  std::string text = "time,a_drum,a_frame\n";
  for (std::size_t i = 0; i < history.size(); ++i)
    text += post::csv_line({post::number_text(history.time[i]), post::number_text(history.a_drum[i]),
                            post::number_text(history.a_frame[i])});
  post::write_files({{scratch_ / "soft.csv", text}});
  std::vector<std::string> words = {"soft.csv", "--phase", "90"};
  words.insert(words.end(), roller.begin(), roller.end());
  expect_refused(words, "soft.csv: the sign of a_drum and a_frame is 'as given'; allowed: the other one");
  words = {"soft.csv", "--phase", "20"};
  words.insert(words.end(), roller.begin(), roller.end());
  expect_refused(words, "soft.csv: k is ");
  std::vector<std::string> anyway = words;
  anyway.insert(anyway.end(), {"--anyway", "--out", "found"});
  EXPECT_TRUE(printed(well(identify(anyway)), "The result contradicts itself: k is "));
}

// Without the frame's acceleration it follows through the bond, here the roller's own; the answer has no more
// digits than anyone needs. The same record with a bond that nobody gave is told with what that costs.
TEST_F(IdentifyCommand, NeedsNoSensorOnTheFrame) {
  post::ChainParameters p = low_CA3500();
  p.k = 6e7;
  const post::ChainHistory history = post::solve_chain(p, 60, 60).history;
  std::string text = "time,a_drum\n";
  for (std::size_t i = 20 * 60; i < history.size(); ++i)
    text += post::csv_line({post::number_text(history.time[i]), post::number_text(history.a_drum[i])});
  post::write_files({{scratch_ / "drum.csv", text}});
  std::vector<std::string> words = {"drum.csv", "--phase", "0", "--out", "found"};
  words.insert(words.end(), roller.begin(), roller.end());
  const auto k_of = [&](const std::vector<std::string> &more, const char *says) {
    std::vector<std::string> all = words;
    all.insert(all.end(), more.begin(), more.end());
    const std::string answer = well(identify(all)).output;
    EXPECT_NE(answer.find(says), std::string::npos) << answer;
    const std::size_t line = answer.find("  k = ");
    const std::string of_k = answer.substr(line, answer.find(" +-", line) - line);
    EXPECT_LE(of_k.size() - of_k.find('.'), 5U) << of_k;
    const post::Table table = post::read_table(scratch_ / "found/identify.csv");
    return std::pair(table.numbers("k [N/m]").front(), table.numbers("k_half_width [N/m]").front());
  };
  const auto exact = k_of({"--bond-tolerance", "0"}, "known to 0 %");
  EXPECT_NEAR(exact.first, p.k, 1e-3 * p.k);
  const auto by_hand = k_of({"--k23", std::to_string(p.k23), "--c23", std::to_string(p.c23)}, "known to 0 %");
  EXPECT_NEAR(by_hand.first, p.k, 1e-3 * p.k);
  const auto unknown = k_of({}, "known to 30 %");
  EXPECT_GE(unknown.second, 0.999 * exact.second);
  EXPECT_EQ(k_of({"--bond-tolerance", "30"}, "known to 30 %"), unknown);
  words.insert(words.end(), {"--bond-tolerance", "101"});
  expect_refused(words, "--bond-tolerance is '101'; allowed: ");
}

TEST_F(IdentifyCommand, RefusesDamagedRecordsInOneLine) {
  write_run(scratch_ / "run");
  expect_refused({"nowhere"}, "nowhere");
  const std::string chain = read_text(scratch_ / "run/chain.csv");
  const std::size_t end = chain.find('\n');
  const std::string parameters = read_text(scratch_ / "run/parameters.csv");
  const auto with = [&](const std::string &text) { post::write_files({{scratch_ / "run/chain.csv", text}}); };
  with(chain.substr(0, end + 1));
  expect_refused({"run"}, "run/chain.csv: no line has numbers");
  std::string other = chain;
  with(other.replace(other.find("a_drum"), 6, "b_drum"));
  expect_refused({"run"}, "the column a_drum is ''; allowed: ");
  write_run(scratch_ / "run", 3);
  expect_refused({"run"}, "the number of cycles is '3'; allowed: 4 or more");
  write_run(scratch_ / "run");
  post::write_files({{scratch_ / "run/parameters.csv", "name,value\nomega,125.66370614359172\n"}});
  expect_refused({"run"}, "m2 is ''; allowed: ");
  post::write_files({{scratch_ / "run/parameters.csv", parameters}});
  // A gap in the times.
  const std::size_t row = chain.find('\n', chain.size() / 2) + 1;
  with(chain.substr(0, row) + chain.substr(chain.find('\n', chain.find('\n', row) + 1) + 1));
  expect_refused({"run"}, "times without a gap");
}

} // namespace
} // namespace drumlin::test
