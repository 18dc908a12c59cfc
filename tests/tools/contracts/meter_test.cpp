// `drumlin meter` as a user meets it: records of runs and measured ones, and records that it refuses in one
// line.
#include "tests/support/ode.h"
#include "tests/support/run_folders.h"
#include "tests/support/tool.h"
#include "meter/along_way.h"
#include "runs/parameter_file.h"
#include "support/measured_table.h"
#include "support/process.h"

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;
using namespace drumlin::post;

class MeterCommand : public Tool {
protected:
  Outcome meter(const std::vector<std::string> &words) const { return drumlin("meter", words); }
  /// A measured file of accelerations in g, downwards, at 29 Hz and 1000 samples per second.
  void write_measured(const std::string &name, int samples, int gap_at = -1) const {
    std::string text = "Time,Acc Z\r\n";
    for (int i = 0; i < samples; ++i) {
      const double t = 1e-3 * i;
      const double angle = 2.0 * M_PI * 29.0 * t;
      if (i != gap_at)
        text += number_text(1e3 * t) + "," +
                number_text(-(20.0 * std::sin(angle) + 4.0 * std::sin(2.0 * angle)) / 9.80665) + "\r\n";
    }
    write_files({{folder_ / name, text}});
  }
};

// Width and radius for E_vib, and frequency, force and masses, come from the roller's file.
TEST_F(MeterCommand, TakesTheDrumOfARollerFile) {
  write_files({{folder_ / "mine", "drum_load 7000 kg\nwidth 2.13 m\ndiameter 1.5 m\nfrequency 29 Hz\n"
                                  "force 256 kN\namplitude 1.8 mm\n"}});
  const std::vector<std::string> exact =
      tool_words("exact --roller mine --k 45e6 --D 0.25 --cycles 60 --out run");
  ASSERT_TRUE(run_program(exact, {}, folder_).ok());
  const ChainHistory history = read_chain(folder_ / "run/chain.csv");
  std::string text = "time,x_drum,a_drum,a_frame\n";
  for (std::size_t i = 0; i < history.size(); ++i)
    text += csv_line({number_text(history.time[i]), number_text(history.x_drum[i]),
                      number_text(history.a_drum[i]), number_text(history.a_frame[i])});
  write_files({{folder_ / "field.csv", text}});
  const auto values = [this](const std::vector<std::string> &more) {
    std::vector<std::string> words = {"field.csv"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = meter(words);
    EXPECT_TRUE(outcome.ok()) << outcome.output;
    const Table table = read_table(folder_ / "results/meter/meter.csv");
    return std::pair(table.numbers("E_vib [Pa]").back(), table.numbers("k_B [N/m]").back());
  };
  const double me_re = 256e3 / std::pow(58.0 * M_PI, 2), m2 = me_re / 1.8e-3;
  const auto by_hand =
      values(words_of("--frequency 29 --me-re {} --m2 {} --m3 {} --drum-radius 0.75 --drum-width 2.13",
                      number_text(me_re), number_text(m2), number_text(7000.0 - m2)));
  const auto by_file = values({"--roller", "mine"});
  EXPECT_NEAR(by_file.first / by_hand.first, 1.0, 1e-9);
  EXPECT_NEAR(by_file.second / by_hand.second, 1.0, 1e-9);
  EXPECT_GT(values({"--roller", "mine", "--drum-width", "1"}).first, 1.5 * by_file.first);
  EXPECT_NE(values({"--roller", "mine", "--poisson", "0.2"}).first, by_file.first);
  // What follows from the file stands in a table of the folder and on the page.
  const std::map<std::string, std::string> noted = read_parameters(folder_ / "results/meter/parameters.csv");
  EXPECT_EQ(noted.at("record"), "field.csv");
  EXPECT_EQ(noted.at("roller"), "mine");
  EXPECT_NEAR(number_from_text(noted.at("roller_exciter_force_per_metre")) / (256e3 / 2.13), 1.0, 1e-6);
  EXPECT_NEAR(number_from_text(noted.at("roller_static_load")), 7000.0 * 9.81, 1e-6);
  EXPECT_NEAR(number_from_text(noted.at("m2")) / m2, 1.0, 1e-6);
  EXPECT_NE(read_text(folder_ / "results/meter/index.html")
                .find("The roller is that of mine: 29 Hz, eccentric moment"),
            std::string::npos);
}

// A run has noted its frequency, masses and force, which those of the file do not replace.
// Sensors at the ends of a drum on halves of 9 and 6 MN/m: apparent stiffness from complex algebra.
TEST_F(MeterCommand, AtOneEndOfADrumThatTiltsShowsTheSoilOfThatEnd) {
  const double b = 2.13 / std::sqrt(12.0), c = 0.4 * std::sqrt(3962.07 * 15e6);
  write_files({{folder_ / "soil.csv", "y (m),k (N/m),c (N s/m)\n" +
                                          csv_line({number_text(-b), "9e6", number_text(0.6 * c)}) +
                                          csv_line({number_text(b), "6e6", number_text(0.4 * c)})}});
  const std::string roller = DRUMLIN_SOURCE_DIR "/inputs/rollers/Axas2020";
  well(run_program(tool_words("exact --roller {} --contacts soil.csv --cycles 300 --out run", roller), {},
                   folder_));
  for (const auto &[sensor, stiffness] :
       {std::pair("a_left", 18.29), {"a_drum", 14.97}, {"a_right", 11.73}}) {
    well(meter({"run", "--column", std::string("a_drum=") + sensor, "--column", "a_frame=a_frame"}));
    const Table table = read_table(folder_ / "results/meter/meter.csv");
    EXPECT_NEAR(1e-6 * table.numbers("k_1 [N/m]").back(), stiffness, 5e-3) << sensor;
    EXPECT_EQ(table.text("mode").back(), "continuous contact");
    EXPECT_FALSE(table.has("k_1_left_half [N/m]"));
  }
  // Both together tell the soil below each half.
  const Outcome both = well(meter({"run"}));
  EXPECT_TRUE(printed(both, "left end shows k_1 = 18.29 MN/m, one in the middle 14.97 MN/m, one at the right "
                            "end 11.73 MN/m"));
  EXPECT_TRUE(printed(both, "9 MN/m below the left half, 6 MN/m below the right one, ratio 1.5"));
  const Table table = read_table(folder_ / "results/meter/meter.csv");
  const auto last = [&table](const char *column) { return table.numbers(column).back(); };
  EXPECT_NEAR(last("k_1_left_end [N/m]"), 18.29e6, 5e3);
  EXPECT_NEAR(last("k_1_right_end [N/m]"), 11.73e6, 5e3);
  EXPECT_NEAR(last("k_1_left_half [N/m]"), 9e6, 90.0);
  EXPECT_NEAR(last("k_1_right_half [N/m]"), 6e6, 60.0);
  EXPECT_NEAR(last("c_1_left_half [N s/m]"), 0.6 * c, 1e-5 * c);
  EXPECT_NEAR(last("c_1_right_half [N s/m]"), 0.4 * c, 1e-5 * c);
}

// Forth and back over the same soft side: a roller that turns round shows the stiffness below the other end,
// one that comes back in reverse the same. Values are those of complex algebra in unbroken contact.
TEST_F(MeterCommand, AtOneEndDependsOnHowTheRollerComesBack) {
  write_files(
      {{folder_ / "way.csv", "s (m),k_left (N/m),k_right (N/m),D (-)\n0,9e6,6e6,0.2\n20,9e6,6e6,0.2\n"}});
  for (const bool turns : {false, true}) {
    const std::string roller = DRUMLIN_SOURCE_DIR "/inputs/rollers/Axas2020";
    std::vector<std::string> words =
        tool_words("exact --roller {} --contacts 2 --way way.csv --speed 4 --passes 2 --out run", roller);
    if (turns) words.emplace_back("--turn-round");
    well(run_program(words, {}, folder_));
    for (const int pass : {1, 2}) {
      well(meter({"run", "--of-pass", std::to_string(pass)}));
      const Table table = read_table(folder_ / "results/meter/meter.csv");
      const bool swapped = turns && pass == 2;
      for (const auto &[column, stiffness] : {std::pair("k_1_left_end [N/m]", swapped ? 11.20 : 18.29),
                                              {"k_1_right_end [N/m]", swapped ? 18.96 : 11.73},
                                              {"k_1_left_half [N/m]", swapped ? 6.0 : 9.0}})
        EXPECT_NEAR(1e-6 * table.numbers(column).back(), stiffness, 1e-2) << column << pass;
    }
  }
}

// Under A a contact may pull: on soil so damped that it does in each cycle contact is unbroken all the same,
// and the stiffness of each half is that of the soil. Where an end lifts off it is apparent.
TEST_F(MeterCommand, AContactThatPullsUnderAIsUnbroken) {
  const std::string roller = DRUMLIN_SOURCE_DIR "/inputs/rollers/Axas2020";
  for (const bool lifts : {false, true}) {
    well(run_program(
        tool_words("exact --roller {} --contacts 4 --transition A --k {} --D {} --cycles 300 --out run",
                   roller, lifts ? "45e6" : "20e6", lifts ? "0.2" : "0.5"),
        {}, folder_));
    const ChainHistory h = read_chain(folder_ / "run/chain.csv");
    EXPECT_LT(*std::min_element(h.F_left.end() - 200, h.F_left.end()), lifts ? 0.0 : -1.5e4);
    EXPECT_EQ(std::count(h.F_left.end() - 200, h.F_left.end(), 0.0) > 0, lifts);
    const Outcome both = well(meter({"run"}));
    EXPECT_EQ(static_cast<bool>(printed(both, "apparent")), lifts);
    const Table table = read_table(folder_ / "results/meter/meter.csv");
    EXPECT_EQ(table.text("mode").back() == "continuous contact", !lifts);
    if (!lifts) {
      EXPECT_TRUE(printed(both, "10 MN/m below the left half, 10 MN/m below the right one"));
    }
  }
}

TEST_F(MeterCommand, OfARunTakesTheDrumsSizeAlone) {
  write_chain_run(folder_ / "run", "II", Transition::B, 30);
  write_files({{folder_ / "mine", "drum_load 7000 kg\nwidth 2.13 m\ndiameter 1.5 m\nfrequency 29 Hz\n"
                                  "force 256 kN\namplitude 1.8 mm\n"}});
  const auto values = [this](std::vector<std::string> words) {
    words.insert(words.begin(), "run");
    EXPECT_TRUE(meter(words).ok());
    return read_text(folder_ / "results/meter/meter.csv");
  };
  EXPECT_EQ(values({"--roller", "mine"}), values({"--drum-radius", "0.75", "--drum-width", "2.13"}));
  EXPECT_NE(values({"--roller", "mine", "--m2", "3000"}), values({"--roller", "mine"}));
}

const std::vector<std::string> as_measured =
    words_of("--column time=Time:ms --column {} --frequency 29", "a_drum=Acc Z:-g");

// Whatever the name: no result replaces the record, or another result.
// Far behind a step of the soil a roller that drives shows what one that stands there does; a window of half
// a metre at 1 m/s and 20 Hz has ten cycles.
TEST_F(MeterCommand, TakesWindowsByDistanceAlongTheWay) {
  write_files({{folder_ / "way", "s (m),k (N/m),D (-)\n0,2e7,0.25\n8,2e7,0.25\n8,4e7,0.25\n16,4e7,0.25\n"}});
  const auto exact = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {DRUMLIN_TOOLS, "exact", "--case", "II", "--transition", "B"});
    well(run_program(words, {}, folder_));
  };
  exact(words_of("--way way --speed 1 --passes 2 --out driven"));
  const ChainHistory history = read_chain(folder_ / "driven/chain.csv");
  const double frequency =
      std::stod(read_parameters(folder_ / "driven/parameters.csv").at("omega")) / (2.0 * M_PI);
  struct Part {
    const char *from, *to, *pass, *k;
  };
  for (const Part &part : {Part{"5", "8", "1", "2e7"}, {"13", "16", "1", "4e7"}, {"0", "3", "2", "2e7"}}) {
    exact(words_of("--k {} --D 0.25 --cycles 80 --out stands", part.k));
    well(meter({"stands"}));
    const Table standing = read_table(folder_ / "results/meter/meter.csv");
    EXPECT_EQ(standing.header().back(), "stiffness"); // no places
    const Outcome outcome = meter(words_of("driven --from-place {} --to-place {} --of-pass {} --window 0.5m",
                                           part.from, part.to, part.pass));
    well(outcome);
    const Table driven = read_table(folder_ / "results/meter/meter.csv");
    const std::vector<double> begin = driven.numbers("s_begin [m]"), end = driven.numbers("s_end [m]");
    ASSERT_GE(driven.rows(), 4U);
    const double cycles = 2.0 * std::ceil(0.25 * frequency - 1e-9);
    for (std::size_t i = 0; i < driven.rows(); ++i) {
      EXPECT_EQ(driven.text("pass")[i], part.pass);
      EXPECT_NEAR(std::abs(end[i] - begin[i]), cycles / frequency, 1e-6);
      EXPECT_GE(std::min(begin[i], end[i]), std::stod(part.from) - 1e-6);
      EXPECT_LE(std::max(begin[i], end[i]), std::stod(part.to) + 1e-6);
      if (i > 0) {
        EXPECT_NEAR(begin[i], end[i - 1], 1e-9);
      }
    }
    for (const char *column : {"CMV [-]", "k_1 [N/m]", "contact_share [-]", "peak_force [N]"})
      EXPECT_NEAR(driven.numbers(column).back(), standing.numbers(column).back(),
                  2e-3 * std::abs(standing.numbers(column).back()))
          << column << part.k;
    EXPECT_TRUE(
        printed(outcome, fmt::format("A window averages the soil over {:.3g} m", cycles / frequency)));
  }
  EXPECT_TRUE(printed(meter({"stands"}), "CMV"));
  EXPECT_FALSE(meter({"stands"}).says("averages the soil"));
  const auto refused = [&](std::vector<std::string> words, const char *says) {
    const Outcome outcome = meter(std::move(words));
    EXPECT_FALSE(outcome.ok());
    expect_one_error(outcome.output, "drumlin meter: ");
    EXPECT_TRUE(printed(outcome, says));
  };
  refused({"driven", "--from-place", "17"},
          "the place to begin is '17'; allowed: a part of the way in pass 2");
  refused({"driven", "--to-place", "17"}, "the place to end is '17'; allowed: ");
  refused({"driven", "--from-place", "3", "--to-place", "2"}, "--to-place is '2'; allowed: a place beyond");
  refused({"driven", "--of-pass", "3"}, "the pass is '3'; allowed: a pass of the record, 1 to 2");
  refused({"driven", "--from-place", "3", "--to-place", "3.1"},
          "the number of cycles on the part of the way");
  refused({"driven", "--window", "0.1m"}, "the window is '0.1m'; allowed: ");
  refused({"driven", "--window", "-1m"}, "--window is '-1'; allowed: ");
  refused({"stands", "--window", "1m"}, "has no column s");
  refused({"stands", "--from-place", "1"}, "has no column s");
}

// The slowest free motion, by an independent solution of the equations of motion.
TEST_F(MeterCommand, TellsHowLongTheRollerRemembers) {
  Record record;
  record.m2 = 2000.0;
  record.m3 = 1500.0;
  record.parameters = {{"k23", "1e6"}, {"c23", "1e4"}};
  const double k = 3e7, c = 8e4, k23 = 1e6, c23 = 1e4;
  const double memory = memory_time(record, k, c).value();
  oracle::Ode motion(
      [&](double /*t*/, const oracle::State &y, oracle::State &rates) {
        const double bond = k23 * (y[1] - y[0]) + c23 * (y[3] - y[2]);
        rates = {y[2], y[3], (-k * y[0] - c * y[2] + bond) / *record.m2, -bond / *record.m3};
      },
      0.0, {0.0, 1.0, 0.0, 0.0}, {1.0, 1.0, 100.0, 100.0});
  const auto size_at = [&](double time) { // by the energy of the frame on its bond
    motion.advance(time);
    return std::sqrt(k23 * std::pow(motion.state()[1], 2) + *record.m3 * std::pow(motion.state()[3], 2));
  };
  const double first = size_at(0.5 * memory), second = size_at(1.5 * memory);
  EXPECT_NEAR(std::log(first / second) / std::log(100.0), 1.0, 0.06);
  record.parameters.erase("k23");
  EXPECT_FALSE(memory_time(record, k, c));
}

TEST_F(MeterCommand, KeepsTheRecord) {
  write_chain_run(folder_ / "run", "II", Transition::B, 12);
  fs::create_symlink(".", folder_ / "here");
  const std::string chain = read_text(folder_ / "run/chain.csv");
  const auto refused = [&](std::vector<std::string> words, const std::string &says) {
    const Outcome outcome = meter(std::move(words));
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_TRUE(printed(outcome, "ERROR: drumlin meter: " + says));
    EXPECT_EQ(lines_of(outcome.output).size(), 1U) << outcome.output;
    EXPECT_EQ(read_text(folder_ / "run/chain.csv"), chain);
  };
  write_files({{folder_ / "run/meter.csv", "of an earlier call"}});
  refused({"run", "--out", "run"},
          "--out is 'run'; allowed: another folder than RECORD 'run/chain.csv', which is read");
  refused({"run/chain.csv", "--out", "here/run"}, "--out is 'here/run'; allowed: another folder than RECORD");
}

TEST_F(MeterCommand, RecordOfARun) {
  draw();
  write_chain_run(folder_ / "run", "II", Transition::B, 20);
  const Outcome outcome = meter({"run", "--drum-radius", "0.759", "--drum-width", "2.13"});
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_TRUE(printed(outcome, {"run/chain.csv: partial uplift, CMV 15", "may be off by",
                                "E_vib: the forces are those of the whole drum, 2.13 m wide."}));
  const fs::path out = folder_ / "results/meter";
  const Table table = read_table(out / "meter.csv");
  ASSERT_EQ(table.rows(), 2U);
  EXPECT_NEAR(table.numbers("CMV [-]").back(), 155.948, 2.0);
  EXPECT_EQ(table.text("stiffness").back(), "apparent");
  for (const char *name :
       {"index.html", "figures/values.png", "figures/spectrum.png", "figures/loop.png", "data/loop.csv"})
    EXPECT_TRUE(fs::exists(out / name)) << name;
  const fs::path parameters = folder_ / "run/parameters.csv";
  write_files({{parameters, std::regex_replace(read_text(parameters), std::regex("\nFw,[^\n]*"), "\nFw,0")}});
  const Outcome still = meter({"run"});
  EXPECT_EQ(still.status, 2);
  EXPECT_TRUE(still.says("ERROR: drumlin meter: Fw is '0'; allowed: a record of a roller that vibrates"));
}

// A bed in two dimensions as its deck writes it: the run of the chain, with the forces of 1 m.
TEST_F(MeterCommand, BedPerMetre) {
  write_chain_run(folder_ / "run", "II", Transition::B, 20);
  const std::vector<std::string> drum = {"--drum-radius", "0.759", "--drum-width", "2.13"};
  const auto E_vib = [&](const std::string &name) {
    std::vector<std::string> words = {name, "--out", "m"};
    words.insert(words.end(), drum.begin(), drum.end());
    well(meter(words));
    return read_table(folder_ / "m/meter.csv").numbers("E_vib [Pa]").back();
  };
  const double whole = E_vib("run/chain.csv");
  const Table chain = read_table(folder_ / "run/chain.csv");
  const std::vector<double> time = chain.numbers("time"), x = chain.numbers("x_drum"),
                            v = chain.numbers("v_drum"), force = chain.numbers("F_contact");
  std::string bed = "time,x_drum,v_drum,F_contact\n";
  for (std::size_t i = 0; i < time.size(); ++i)
    bed += number_text(time[i]) + "," + number_text(x[i]) + "," + number_text(v[i]) + "," +
           number_text(force[i] / 2.13) + "\n";
  fs::create_directories(folder_ / "bed");
  const auto parameters = [](const std::string &more) {
    return "name,value\nomega,125.66370614359172\nm2," + number_text(2000.0 / 2.13) + "\nm3," +
           number_text(1000.0 / 2.13) + "\ng,9.81\n" + more;
  };
  write_files(
      {{folder_ / "bed/bed.csv", bed}, {folder_ / "bed/parameters.csv", parameters("dimension,2\n")}});
  EXPECT_NEAR(E_vib("bed") / whole, 1.0, 0.05);
  EXPECT_TRUE(meter(words_of("bed --drum-radius 0.759 --drum-width 2.13 --out m"))
                  .says("Forces, energy and stiffnesses are those of 1 m of the drum; for E_vib the force is "
                        "that of the whole drum, 2.13 m wide."));
  // Of a bed in three dimensions of unknown thickness it cannot be told.
  write_files({{folder_ / "bed/parameters.csv", parameters("dimension,3\n")}});
  well(meter(words_of("bed --drum-radius 0.759 --drum-width 2.13 --out m")));
  EXPECT_TRUE(read_table(folder_ / "m/meter.csv").text("E_vib [Pa]").back().empty());
}

TEST_F(MeterCommand, MeasuredRecord) {
  write_measured("field.csv", 2001);
  std::vector<std::string> words = {"field.csv", "--window", "0.5s", "--same", "0.1"};
  words.insert(words.end(), as_measured.begin(), as_measured.end());
  const Outcome outcome = meter(words);
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_TRUE(printed(outcome, "same in each cycle, CMV "));
  const Table table = read_table(folder_ / "results/meter/meter.csv");
  ASSERT_EQ(table.rows(), 4U); // 58 cycles in windows of 14
  for (const double cmv : table.numbers("CMV [-]"))
    EXPECT_NEAR(cmv, 60.0, 0.3); // a cycle is no whole number of samples
  EXPECT_TRUE(table.text("k_B [N/m]").front().empty());
  // The harmonics have the size that they had before a filter, which leaves 0.27 of the second here.
  words.insert(words.end(), {"--low-pass", "45"});
  ASSERT_EQ(meter(words).status, 0);
  for (const double cmv : read_table(folder_ / "results/meter/meter.csv").numbers("CMV [-]"))
    EXPECT_NEAR(cmv, 60.0, 0.5);
  words.back() = "20";
  EXPECT_TRUE(
      meter(words).says("the cut-off frequency is '20'; allowed: one that leaves a tenth of the second"));
}

// The same signal behind the low-pass of a logger, by the poles of a Butterworth filter of fourth order: it
// leaves 0.986 of the second harmonic, and shifts the phases.
TEST_F(MeterCommand, GivesBackWhatTheLoggersFilterHasTaken) {
  const auto response = [](double frequency) {
    const std::complex<double> s(0.0, frequency / 90.0);
    std::complex<double> passed = 1.0;
    for (const double angle : {M_PI / 8.0, 3.0 * M_PI / 8.0})
      passed /= s * s + 2.0 * std::sin(angle) * s + 1.0;
    return passed;
  };
  std::string text = "Time,Acc Z\n";
  for (int i = 0; i < 2001; ++i) {
    const std::complex<double> wave = std::polar(1.0, 2.0 * M_PI * 29.0 * 1e-3 * i);
    const double value = (20.0 * response(29.0) * wave + 7.0 * response(58.0) * wave * wave).imag();
    text += number_text(i) + "," + number_text(-value / 9.80665) + "\n";
  }
  write_files({{folder_ / "field.csv", text}});
  std::vector<std::string> words = {"field.csv", "--same", "0.1", "--window", "28"};
  words.insert(words.end(), as_measured.begin(), as_measured.end());
  const auto cmv = [&] {
    well(meter(words));
    return read_table(folder_ / "results/meter/meter.csv").numbers("CMV [-]").back();
  };
  EXPECT_NEAR(cmv(), 300.0 * 7.0 / 20.0 * std::abs(response(58.0) / response(29.0)), 0.3);
  words.insert(words.end(), {"--logger-low-pass", "90,4"});
  EXPECT_NEAR(cmv(), 105.0, 0.3);
  words.back() = "50,4";
  EXPECT_TRUE(meter(words).says("the logger's filter is '50 Hz of order 4'; allowed: one that lets"));
}

TEST_F(MeterCommand, ShowsWhatItUnderstands) {
  draw();
  write_measured("gap.csv", 1000, 500);
  std::vector<std::string> words = {"gap.csv", "--show"};
  words.insert(words.end(), as_measured.begin(), as_measured.end());
  const Outcome outcome = meter(words);
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  for (const char *line :
       {"gap.csv: UTF-8, ',' between cells, decimal '.', header in line 1, 999 rows from line 2\n",
        "time is column 1 'Time' times 0.001, a_drum is column 2 'Acc Z' times -9.80665\n",
        "piece 1: 0 to 0.499 s, 500 samples\n", "piece 2: 0.501 to 0.999 s, 499 samples\n",
        "500 samples, 1000 per second, 0.499 s\n"})
    EXPECT_TRUE(outcome.says(line)) << line << outcome.output;
  EXPECT_TRUE(fs::exists(folder_ / "results/meter/figures/first_second.png"));
  EXPECT_FALSE(fs::exists(folder_ / "results/meter/meter.csv"));
  // A column by its number; a frequency is not needed.
  EXPECT_EQ(meter(words_of("gap.csv --show --column time=1:ms --column a_drum=2:-g")).status, 0);
}

TEST_F(MeterCommand, ShowsAGuessWhereNoNameIsKnown) {
  std::string text = "Date;Time;Note;Ch1 [g];Ch2 [m/s2];Temp [C]\n";
  for (int i = 0; i < 2000; ++i) {
    const double t = 1e-3 * i, w = 2.0 * M_PI * 30.0;
    text += fmt::format("28.11.2026;10:00:{:06.3f};ok;{:.4f};{:.4f};{:.1f}\n", t, 0.1 * std::sin(w * t),
                        20.0 * std::sin(w * t + 1.0), 20.0 + std::sin(t));
  }
  write_files({{folder_ / "unknown.csv", text}});
  const std::string line = "--column 'a_drum=Ch2 [m/s2]' --column 'a_frame=Ch1 [g]'";
  const Outcome shown = well(meter({"unknown.csv", "--show"}));
  EXPECT_TRUE(printed(shown, "type: " + line));
  EXPECT_TRUE(printed(shown, "time is column 2 'Time' with clock times"));
  const Outcome refused = meter({"unknown.csv"});
  EXPECT_NE(refused.status, 0);
  EXPECT_TRUE(printed(refused, "others by --column NAME=HEADER:UNIT, perhaps " + line));
}

TEST_F(MeterCommand, RecordsThatAreRefused) {
  write_measured("gap.csv", 1000, 500);
  write_measured("short.csv", 120);
  write_measured("good.csv", 1000);
  struct Refused {
    std::vector<std::string> words;
    std::string says;
  };
  const std::vector<Refused> table = {
      {{"gap.csv", "--piece", "3"}, "gap.csv: the piece is '3'; allowed: the number of one of its 2 pieces"},
      {{"good.csv", "--decimal", "dot"}, "--decimal is 'dot'; allowed: point, comma"},
      {{"good.csv", "--separator", "colon"}, "--separator is 'colon'; allowed: "},
      {{"short.csv"}, "the number of cycles is '3.451'; allowed: 4 or more at 29 Hz"},
      {{"good.csv", "--window", "40"}, "the window is '40 cycles'; allowed: at most the 28 whole cycles"},
      {{"good.csv", "--window", "0.1s"}, "--window is '0.1s'; allowed: "},
      {{"good.csv", "--low-pass", "600"}, "the cut-off frequency is '600'; allowed: "},
      {{"none.csv"}, "none.csv: cannot be read"}};
  for (const Refused &refused : table) {
    std::vector<std::string> words = refused.words;
    words.insert(words.end(), as_measured.begin(), as_measured.end());
    const Outcome outcome = meter(words);
    EXPECT_NE(outcome.status, 0) << refused.says;
    EXPECT_EQ(outcome.output.rfind("ERROR: drumlin meter: ", 0), 0U) << outcome.output;
    EXPECT_EQ(lines_of(outcome.output).size(), 1U) << outcome.output;
    EXPECT_TRUE(printed(outcome, refused.says));
    EXPECT_FALSE(fs::exists(folder_ / "results"));
  }
  EXPECT_TRUE(meter({"good.csv", "--column", "time=Time:ms", "--column", "a_drum=Acc Z:g"})
                  .says("the frequency of the excitation is ''; allowed: "));
}

} // namespace
} // namespace drumlin::test
