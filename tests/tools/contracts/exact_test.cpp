// `drumlin exact` as a user calls it: its files, messages and exit status.
#include "chain/exact_solution.h"
#include "runs/chain_files.h"
#include "support/files.h"
#include "tests/support/lines.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

namespace drumlin::test {

namespace {

namespace fs = std::filesystem;

struct Outcome {
  int status = -1;
  std::string out;
  std::string err;
};

/// A roller file as a data sheet fills it.
const std::string data_sheet = "operating_mass 12.1 t\ndrum_load 7000 kg\nwidth 2.13 m\ndiameter 1.5 m\n"
                               "frequency 30 Hz\nforce 256 kN\namplitude 1.8 mm\n";

/// A roller file of the project.
std::string roller_file(const std::string &machine) {
  return (fs::path(DRUMLIN_SOURCE_DIR) / "inputs/rollers" / machine).string();
}

class ExactCommand : public ::testing::Test {
protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("drumlin-exact-" + std::to_string(::getpid()) + "-" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string get(const fs::path &path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  // Runs the tool in the test's folder, through the shell.
  Outcome run(const std::string &arguments) const {
    const std::string command =
        "cd '" + folder_.string() + "' && '" DRUMLIN_TOOLS "' " + arguments + " >.out 2>.err";
    const int status = std::system(command.c_str());
    Outcome outcome = {WIFEXITED(status) ? WEXITSTATUS(status) : -1, get(folder_ / ".out"),
                       get(folder_ / ".err")};
    fs::remove(folder_ / ".out");
    fs::remove(folder_ / ".err");
    return outcome;
  }

  // Every file below the folder with its text.
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> texts;
    for (const fs::directory_entry &entry : fs::recursive_directory_iterator(folder_))
      texts[entry.path().string()] = entry.is_directory() ? "(folder)" : get(entry.path());
    return texts;
  }

  fs::path folder_;
};

TEST_F(ExactCommand, WritesWhatTheSolverFound) {
  const Outcome outcome =
      run("exact --case III --transition A --D 0.4 --cycles 6 --samples-per-cycle 100 --out 'a/b c'");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1) << outcome.out;

  post::ChainParameters parameters = post::table1_case("III", post::Transition::A);
  parameters.D = 0.4;
  post::ExactOptions options;
  options.cycles = 6;
  options.samples_per_cycle = 100;
  const post::ExactSolution expected = post::solve_chain(parameters, options);
  const fs::path out = folder_ / "a" / "b c";
  const post::ChainHistory history = post::read_chain(out / "chain.csv");
  EXPECT_EQ(history.size(), 601U);
  EXPECT_EQ(history.v_drum, expected.history.v_drum);
  EXPECT_EQ(history.a_frame, expected.history.a_frame);
  EXPECT_EQ(get(out / "events.csv"), post::events_text(expected.events));
  EXPECT_EQ(get(out / "cycles.csv"), post::cycles_text(expected.cycles));
  EXPECT_EQ(post::read_table(out / "cycles.csv").rows(), 6U);

  const std::map<std::string, std::string> record = post::read_parameters(out / "parameters.csv");
  for (const char *name : {"case", "transition", "k", "D", "c", "omega", "Fw", "m2", "m3", "k23", "c23", "g",
                           "cycles", "samples_per_cycle", "command"})
    EXPECT_EQ(record.count(name), 1U) << name;
  EXPECT_EQ(record.at("case"), "III");
  EXPECT_EQ(post::number_from_text(record.at("D")), 0.4);
  EXPECT_EQ(post::number_from_text(record.at("c")), parameters.damping());
  EXPECT_NE(record.at("command").find("drumlin exact --case III"), std::string::npos);
  EXPECT_EQ(std::distance(fs::directory_iterator(out), fs::directory_iterator()), 4);
  EXPECT_NE(outcome.out.find(" steps), Fw 58800 N\n"), std::string::npos) << outcome.out;
  EXPECT_EQ(record.at("deck"), "exact");
  EXPECT_EQ(record.at("ended"), "yes");
}

// Of a roller the eccentric moment stays when masses or frequency are others, and the command says so.
TEST_F(ExactCommand, SaysFromWhichMomentTheForceFollows) {
  const std::string roller = "exact --roller " + roller_file("CA3500") + " --setting high ";
  const Outcome outcome = run(roller + "--m2 6000 --omega 100 --cycles 1 --out o");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find(", Fw 73800 N, of the eccentric moment 7.38 kg m of the roller"),
            std::string::npos)
      << outcome.out;
  EXPECT_NE(run(roller + "--Fw 1e5 --cycles 1 --out o").out.find(", Fw 100000 N\n"), std::string::npos);
}

TEST_F(ExactCommand, RefusesFilesThatAreOne) {
  fs::create_directories(folder_ / "o");
  std::ofstream(folder_ / "o/shared") << "kept\n";
  fs::create_symlink("shared", folder_ / "o/chain.csv");
  fs::create_symlink("shared", folder_ / "o/events.csv");
  const Outcome outcome = run("exact --cycles 1 --out o");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err, "ERROR: drumlin exact: --out is 'o/events.csv'; allowed: another file than --out "
                         "'o/chain.csv', which is written, too\n");
  EXPECT_EQ(get(folder_ / "o/shared"), "kept\n");
}

TEST_F(ExactCommand, EveryOverrideArrives) {
  const Outcome outcome = run("exact --k 2e7 --D 0.3 --omega 100 --Fw 5e4 --m2 1500 --m3 700 --k23 2e6 --c23 "
                              "2e4 --g 1.62 --impact-speed 0.25 --cycles 1.5 --out o");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::map<std::string, std::string> record = post::read_parameters(folder_ / "o" / "parameters.csv");
  const std::map<std::string, double> expected = {
      {"k", 2e7},     {"D", 0.3},   {"omega", 100}, {"Fw", 5e4}, {"m2", 1500},
      {"m3", 700},    {"k23", 2e6}, {"c23", 2e4},   {"g", 1.62}, {"impact_speed", 0.25},
      {"cycles", 1.5}};
  for (const auto &[name, value] : expected)
    EXPECT_EQ(post::number_from_text(record.at(name)), value) << name;
  EXPECT_EQ(post::read_chain(folder_ / "o" / "chain.csv").size(), 301U);
  EXPECT_EQ(post::read_chain(folder_ / "o" / "chain.csv").v_drum.front(), -0.25);
  EXPECT_EQ(post::read_table(folder_ / "o" / "cycles.csv").rows(), 1U);
}

// A way of the project, there and back: place and pass stand in chain.csv, and the soil of each place in the
// forces.
TEST_F(ExactCommand, DrivesOverAWay) {
  const std::string way = (fs::path(DRUMLIN_SOURCE_DIR) / "inputs/chain/way").string();
  const Outcome outcome = run("exact --case II --way " + way + " --speed 2 --passes 2 --out o");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const post::ChainHistory h = post::read_chain(folder_ / "o/chain.csv");
  ASSERT_EQ(h.s.size(), h.size());
  EXPECT_EQ(h.s.front(), 0.0);
  EXPECT_NEAR(h.s.back(), 0.0, 1e-9);
  EXPECT_NEAR(h.time.back(), 12.0, 1e-3);
  EXPECT_NEAR(*std::max_element(h.s.begin(), h.s.end()), 12.0, 1e-3);
  for (std::size_t i = 0; i < h.size(); i += 97) {
    const double s = h.s[i];
    EXPECT_EQ(h.pass[i], h.time[i] < 6.0 ? 1.0 : 2.0) << i;
    EXPECT_NEAR(s, h.time[i] < 6.0 ? 2.0 * h.time[i] : 24.0 - 2.0 * h.time[i], 1e-9) << i;
    const double k = s < 4.0 ? 3e7 : s < 6.0 ? 8e7 : s < 8.0 ? 8e7 - 2e7 * (s - 6.0) : 4e7;
    const double law = -k * h.x_drum[i] - 0.5 * std::sqrt(2000.0 * k) * h.v_drum[i];
    EXPECT_NEAR(h.F_contact[i], h.F_contact[i] > 0.0 ? law : 0.0, 1e-6 * 1e5) << i;
  }
  const std::map<std::string, std::string> record = post::read_parameters(folder_ / "o/parameters.csv");
  for (const char *of_place : {"k", "D", "c"})
    EXPECT_EQ(record.count(of_place), 0U);
  EXPECT_EQ(record.at("way"), way);
  EXPECT_EQ(record.at("passes"), "2");
}

TEST_F(ExactCommand, WritesARandomWayAndDrivesOverIt) {
  const std::string options = "--mean 5e7 --variation 0.3 --correlation 1.5 --from 2 --to 5 --step 0.25 ";
  ASSERT_EQ(run("way " + options + "--out w.csv").status, 0);
  ASSERT_EQ(run("way " + options + "--seed 2 --out other.csv").status, 0);
  EXPECT_NE(get(folder_ / "w.csv"), get(folder_ / "other.csv"));
  EXPECT_EQ(post::read_table(folder_ / "w.csv").header(),
            (std::vector<std::string>{"s (m)", "k (N/m)", "D (-)"}));
  EXPECT_EQ(post::read_table(folder_ / "w.csv").rows(), 13U);
  ASSERT_EQ(run("exact --way w.csv --speed 1 --out o").status, 0);
  EXPECT_EQ(post::read_chain(folder_ / "o/chain.csv").s.front(), 2.0);
}

// A soft left side from 4 m on, forth and back: the force of each half is k of its side of that place. In
// reverse the left end stays on the soft side; a roller that turns round has its right end there.
TEST_F(ExactCommand, DrivesOverASoftSide) {
  std::ofstream(folder_ / "w.csv") << "s (m),k_left (N/m),k_right (N/m),D (-)\n0,7e6,7e6,0\n4,7e6,7e6,0\n"
                                      "4,4e6,8e6,0\n6,5e6,9e6,0\n";
  for (const bool turned : {false, true}) {
    const Outcome outcome =
        run("exact --roller " + roller_file("Axas2020") +
            " --way w.csv --speed 1 --passes 2 --contacts 2 --out o" + (turned ? " --turn-round" : ""));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out.find("multiplier"), std::string::npos);
    EXPECT_EQ(get(folder_ / "o/chain.csv").substr(0, get(folder_ / "o/chain.csv").find('\n')),
              "time,x_drum,v_drum,a_drum,x_frame,v_frame,a_frame,F_contact,F_excitation,F_bond,theta_drum,"
              "omega_drum,theta_frame,omega_frame,a_left,a_right,F_left,F_right,s,pass");
    const post::ChainHistory h = post::read_chain(folder_ / "o/chain.csv");
    const double b = 2.13 / std::sqrt(12.0);
    for (std::size_t i = 0; i < h.size(); i += 53) {
      const double s = h.s[i], k_left = s < 4.0 ? 7e6 : 4e6 + 5e5 * (s - 4.0),
                   k_right = s < 4.0 ? 7e6 : 8e6 + 5e5 * (s - 4.0);
      const bool swapped = turned && h.pass[i] == 2.0;
      EXPECT_NEAR(h.F_left[i],
                  std::max(0.0, -(swapped ? k_right : k_left) * (h.x_drum[i] - b * h.theta_drum[i])), 1.0)
          << i;
      EXPECT_NEAR(h.F_right[i],
                  std::max(0.0, -(swapped ? k_left : k_right) * (h.x_drum[i] + b * h.theta_drum[i])), 1.0)
          << i;
    }
    const std::map<std::string, std::string> record = post::read_parameters(folder_ / "o/parameters.csv");
    EXPECT_EQ(record.at("way_back"), turned ? "turned round" : "in reverse");
    EXPECT_EQ(record.at("contacts"), "2");
    EXPECT_EQ(record.count("k") + record.count("D") + record.count("c"), 0U);
  }
}

TEST_F(ExactCommand, WritesAWayWithASoftSide) {
  const std::string options = "--mean 5e7 --variation 0.3 --correlation 1.5 --to 5 --step 0.25 ";
  ASSERT_EQ(run("way " + options + "--out w.csv").status, 0);
  ASSERT_EQ(run("way " + options + "--ratio 3 --out halves.csv").status, 0);
  const post::Table whole = post::read_table(folder_ / "w.csv"),
                    halves = post::read_table(folder_ / "halves.csv");
  const std::vector<double> k = whole.numbers("k (N/m)"), left = halves.numbers("k_left (N/m)"),
                            right = halves.numbers("k_right (N/m)");
  ASSERT_EQ(left.size(), k.size());
  for (std::size_t i = 0; i < k.size(); ++i) {
    EXPECT_NEAR(left[i] / right[i], 3.0, 1e-12);
    EXPECT_NEAR(left[i] + right[i], k[i], 1e-12 * k[i]);
  }
  EXPECT_EQ(run("way " + options + "--ratio 0 --out w.csv").err,
            "ERROR: drumlin way: --ratio is '0'; allowed: a number from 0.001 to 1000\n");
  ASSERT_EQ(run("exact --way halves.csv --speed 5 --contacts 3 --out o").status, 0);
}

// The machine of the roller file on two contacts that carry 3 to 2 in unbroken contact: amplitudes of the
// left end, the middle and the right end, tilt, and apparent stiffness of each, from complex algebra.
TEST_F(ExactCommand, ADrumOnUnequalHalvesTilts) {
  const double b = 2.13 / std::sqrt(12.0), c = 0.4 * std::sqrt(3962.07 * 15e6);
  std::ofstream(folder_ / "soil.csv")
      << fmt::format("y (m),k (N/m),c (N s/m)\n{},9e6,{}\n{},6e6,{}\n", -b, 0.6 * c, b, 0.4 * c);
  const Outcome outcome = run("exact --roller " + roller_file("Axas2020") +
                              " --contacts soil.csv --cycles 400 --samples-per-cycle 100 --out o");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("The motion repeats after 1 cycle; largest multiplier 0."), std::string::npos)
      << outcome.out;
  EXPECT_EQ(outcome.out.find("Assumed"), std::string::npos);
  EXPECT_EQ(
      post::read_text(folder_ / "o/chain.csv")
          .rfind("time,x_drum,v_drum,a_drum,x_frame,v_frame,a_frame,F_contact,F_excitation,F_bond,theta_drum,"
                 "omega_drum,theta_frame,omega_frame,a_left,a_right,F_left,F_right\n",
                 0),
      0U);
  const post::ChainHistory h = post::read_chain(folder_ / "o/chain.csv");
  constexpr double samples = 100.0;
  const std::size_t first = h.size() - 100;
  const auto amplitude = [&](const std::vector<double> &values) {
    std::complex<double> sum = 0.0;
    for (std::size_t i = first; i < h.size(); ++i)
      sum += values[i] *
             std::polar(2.0 / samples, -2.0 * 3.14159265358979323846 * static_cast<double>(i) / samples);
    return sum;
  };
  const double w2 = std::pow(2.0 * 3.14159265358979323846 * 29.0, 2);
  struct End {
    std::complex<double> z;
    double amplitude_mm, stiffness;
  };
  for (const auto &[z, amplitude_mm, stiffness] : {End{amplitude(h.a_left) / -w2, 2.1388, 18.29},
                                                   {amplitude(h.x_drum), 2.0894, 14.97},
                                                   {amplitude(h.a_right) / -w2, 2.0424, 11.73}}) {
    EXPECT_NEAR(1e3 * std::abs(z), amplitude_mm, 5e-5);
    const std::complex<double> force =
        -amplitude(h.F_excitation) + w2 * (3962.07 * z + 3379.4 * amplitude(h.x_frame));
    EXPECT_NEAR(1e-6 * (force / z).real(), stiffness, 5e-3);
  }
  EXPECT_NEAR(1e3 * std::abs(amplitude(h.theta_drum)), 0.0797, 5e-5);
  for (std::size_t i = 0; i < h.size(); i += 37)
    EXPECT_NEAR(h.F_left[i] + h.F_right[i], h.F_contact[i], 1e-9 * 2e5) << i;
  const std::map<std::string, std::string> record = post::read_parameters(folder_ / "o/parameters.csv");
  for (const char *of_each : {"k", "D", "c"})
    EXPECT_EQ(record.count(of_each), 0U);
  EXPECT_EQ(record.at("contacts"), "soil.csv");
  EXPECT_EQ(post::number_from_text(record.at("drum_inertia")), 2138.594);
  EXPECT_EQ(record.at("ends_assumed"), "");
}

// Of a machine whose file does not say how it tilts the command says what is assumed.
TEST_F(ExactCommand, SaysWhatIsAssumedOfADrumThatTilts) {
  const Outcome outcome = run("exact --roller " + roller_file("CA3500") +
                              " --setting high --contacts 5 --cycles 2 --tilt 1e-3 --out o");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(
      outcome.out.find("Assumed, as of Axas2020: drum_inertia, frame_inertia, bond_left, bond_right.\n"),
      std::string::npos)
      << outcome.out;
  EXPECT_EQ(post::read_chain(folder_ / "o/chain.csv").theta_drum.front(), 1e-3);
  EXPECT_EQ(post::read_parameters(folder_ / "o/parameters.csv").at("ends_assumed"),
            "drum_inertia frame_inertia bond_left bond_right");
}

TEST_F(ExactCommand, SolvesEveryCase) {
  for (const std::string name : post::table1_cases) {
    SCOPED_TRACE(name);
    const Outcome outcome = run("exact --case " + name + " --cycles 1 --samples-per-cycle 10 --out o");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const std::map<std::string, std::string> record = post::read_parameters(folder_ / "o" / "parameters.csv");
    EXPECT_EQ(record.at("case"), name);
    const post::ChainParameters p = post::table1_case(name, post::Transition::B);
    for (const post::ChainNumber &number : post::chain_numbers)
      EXPECT_EQ(post::number_from_text(record.at(number.name)), p.*number.value) << number.name;
  }
}

TEST_F(ExactCommand, TheForceOfARollerFollowsFromItsFrequency) {
  const auto force = [&](const std::string &options) {
    const std::string roller = "exact --roller " + roller_file("CA3500") + " --setting high ";
    EXPECT_EQ(run(roller + "--cycles 1 --out o " + options).status, 0);
    return post::number_from_text(post::read_parameters(folder_ / "o" / "parameters.csv").at("Fw"));
  };
  EXPECT_DOUBLE_EQ(force("--omega 200"), 7.38 * 200.0 * 200.0);
  EXPECT_DOUBLE_EQ(force("--omega 200 --Fw 1e5"), 1e5);
  constexpr double pi = 3.14159265358979323846;
  EXPECT_DOUBLE_EQ(force("--frequency 30"), 7.38 * std::pow(60.0 * pi, 2));
}

// A roller known by its data sheet alone. Computed by hand: m_e r_e = 256e3/(60 pi)^2 = 7.205062 kg m, m2
// = m_e r_e/1.8 mm = 4002.812 kg, m3 = 7000 kg - m2, k23 = m3 (2 pi 4.82 Hz)^2, c23 = 2 0.151 sqrt(k23 m3).
TEST_F(ExactCommand, TakesARollerKnownByItsDataSheet) {
  std::ofstream(folder_ / "mine") << data_sheet;
  const Outcome outcome = run("exact --roller mine --k 45e6 --D 0.25 --cycles 2 --out o");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::map<std::string, std::string> record = post::read_parameters(folder_ / "o" / "parameters.csv");
  const auto near = [&record](const std::string &name, double expected) {
    EXPECT_NEAR(post::number_from_text(record.at(name)) / expected, 1.0, 1e-6) << name;
  };
  near("m2", 4002.8122);
  near("m3", 2997.1878);
  near("k23", 2748955.9);
  near("c23", 27412.447);
  near("omega", 188.49556);
  near("Fw", 256e3);
  near("k", 45e6);
  near("roller_frequency", 30.0);
  near("roller_eccentric_moment", 7.2050619);
  near("roller_exciter_force", 256e3);
  near("roller_static_load", 68670.0);
  near("roller_exciter_force_per_metre", 120187.79);
  near("roller_static_load_per_metre", 32239.437);
  near("roller_nominal_amplitude", 1.8e-3);
  near("roller_frame_frequency", 4.82);
  EXPECT_EQ(record.at("roller"), "mine");
  EXPECT_EQ(record.at("setting"), "");
  EXPECT_EQ(record.at("roller_bond_assumed"), "yes");
  EXPECT_EQ(record.at("ended"), "yes");
  for (const char *line :
       {"roller mine: drum 4002.81 kg, frame 2997.19 kg\n", "exciter force           256 kN\n",
        "static load per metre   32.239 kN/m\n", "nominal amplitude       1.8 mm\n",
        "frame frequency         4.82 Hz\n", "The bond of drum and frame is assumed"})
    EXPECT_NE(outcome.out.find(line), std::string::npos) << outcome.out;
  // Pages name it, and what follows from it.
  const std::string words =
      "The roller is that of mine: 30 Hz, eccentric moment 7.205 kg m, exciter force 256 kN "
      "(120.2 kN/m), nominal amplitude 1.8 mm, static load 68.67 kN (32.24 kN/m), frame on its "
      "bond 4.82 Hz, a bond that is assumed";
  for (const char *axes : {"--x k:40e6:50e6:2 --identify 0", "--x k:40e6:50e6:2 --y D:0.2:0.3:2"}) {
    const std::string text = fmt::format("map {} --roller mine --cycles 100 --fresh --out map", axes);
    ASSERT_EQ(run(text).status, 0) << run(text).err;
    EXPECT_NE(post::read_text(folder_ / "map" / "index.html").find(words), std::string::npos) << axes;
  }
  // What a single option gives counts, also in what follows.
  ASSERT_EQ(run("exact --roller mine --m2 4000 --frequency 33 --cycles 1 --out o").status, 0);
  const std::map<std::string, std::string> other = post::read_parameters(folder_ / "o" / "parameters.csv");
  EXPECT_EQ(other.at("m2"), "4000");
  EXPECT_NEAR(post::number_from_text(other.at("Fw")), 256e3 * 1.21, 1e-6);
  EXPECT_EQ(other.at("roller_frequency"), "33");
  EXPECT_NEAR(post::number_from_text(other.at("roller_exciter_force")), 256e3 * 1.21, 1e-6);
  EXPECT_NEAR(post::number_from_text(other.at("roller_nominal_amplitude")), 7.2050619 / 4000.0, 1e-9);
}

TEST_F(ExactCommand, KeepsTheFilesThatItReads) {
  fs::create_directories(folder_ / "o");
  std::ofstream(folder_ / "o/parameters.csv") << data_sheet;
  const Outcome outcome = run("exact --roller o/parameters.csv --cycles 1 --out o");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err, "ERROR: drumlin exact: --out is 'o/parameters.csv'; allowed: another file than "
                         "--roller 'o/parameters.csv', which is read\n");
  EXPECT_EQ(get(folder_ / "o/parameters.csv"), data_sheet);
  const std::string contacts = "y (m),k (N/m),c (N s/m)\n-0.6,1e7,0\n0.6,2e7,1e4\n";
  std::ofstream(folder_ / "o/chain.csv") << contacts;
  EXPECT_EQ(run("exact --contacts o/chain.csv --cycles 1 --out o").status, 2);
  EXPECT_EQ(get(folder_ / "o/chain.csv"), contacts);
}

TEST_F(ExactCommand, HelpAndVersionAnswer) {
  for (const char *arguments : {"--help", "exact --help", "--version"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << arguments;
    EXPECT_EQ(outcome.err, "") << arguments;
    EXPECT_NE(outcome.out, "") << arguments;
  }
  EXPECT_NE(run("exact --help").out.find("--samples-per-cycle"), std::string::npos);
  const Outcome unknown = run("precise");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_EQ(unknown.err.rfind("ERROR: drumlin: ", 0), 0U) << unknown.err;
  EXPECT_NE(unknown.err.find("'precise'"), std::string::npos);
  EXPECT_EQ(run("").status, 2);
}

} // namespace

} // namespace drumlin::test
