// `drumlin exact`, and the options of all commands.
#include "tests/support/tool.h"
#include "calibration/task.h"
#include "chain/exact_solution.h"
#include "runs/parameter_file.h"
#include "support/process.h"

#include <sys/wait.h>
#include <unistd.h>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

// `drumlin exact` as a user calls it: its files, messages and exit status.
namespace exact {

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

} // namespace exact

// What options of the tools do together: layers of a bed, a roller's file in every command, files that are
// read and not replaced.
namespace options {

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
      well(run(words_of("bed --sieve {} --cut 10 --balls 2000 --out balls.data", "my gravel.csv")));
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
  EXPECT_EQ(force(words_of("--x k:1e7:2e7:2 --y D:0.1:0.2:2 --me-re 4 --omega 100")), "40000");
  EXPECT_EQ(force(words_of("--x k:1e7:2e7:2 --y omega:100:120:2 --me-re 4")), "");
  EXPECT_EQ(force({"--x", "k:1e7:2e7:2", "--y", "Fw:1e4:2e4:2"}), "");
}

// A drum of 6000 kg under B, with condition and numbers that others have computed.
TEST_F(ToolOptions, AMapTakesARollerFromItsFile) {
  std::ofstream(folder_ / "heavy") << "drum_mass 6 t\nframe_mass 3500 kg\nbond_stiffness 3.1 MN/m\n"
                                      "bond_damping 31 kN s/m\nfrequency 1800 vpm\n"
                                      "eccentric_moment 11.4 kg m\n";
  const post::Outcome outcome =
      well(run(words_of("map --sweep k:10e6:100e6:60 --roller heavy --D 0.2 --out m")));
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
    well(run(words_of("map --x {} --y k:20e6:80e6:2 --roller heavy --cycles 100 --out {}", x, x)));
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
  const std::vector<std::string>
      by_file = {"--roller", "mine"},
      by_hand = words_of("--omega 188.49555921538757 --me-re 7.2050619478995772 --m2 4002.8121932775 --m3 "
                         "2997.1878067225 --k23 2748955.8845542 --c23 27412.447104822");
  const auto boundaries = [this](const std::vector<std::string> &roller) {
    std::vector<std::string> words = words_of("map --sweep k:5e6:100e6:15 --D 0.2 --fresh --out m");
    words.insert(words.end(), roller.begin(), roller.end());
    well(run(words));
    return post::read_table(folder_ / "m/boundaries.csv").numbers("k [N/m]");
  };
  const std::vector<double> expected = boundaries(by_hand), found = boundaries(by_file);
  ASSERT_EQ(found.size(), expected.size());
  ASSERT_FALSE(found.empty());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i] / expected[i], 1.0, 1e-9);

  well(run(words_of("exact --roller mine --frequency 29.3 --k 45e6 --D 0.25 --cycles 30 --samples-per-cycle "
                    "40 --out run")));
  fs::rename(folder_ / "run/chain.csv", folder_ / "logged.csv"); // without parameters, and with other columns
  const std::vector<std::string> record =
      words_of("logged.csv --column time=time --column a_drum=a_drum --column a_frame=a_frame --roller mine");
  std::vector<std::string> words = {"identify", "--out", "found"};
  words.insert(words.end(), record.begin(), record.end());
  EXPECT_TRUE(printed(well(run(words)),
                      {"exciter force per metre 120.19 kN/m", "The bond of drum and frame is assumed",
                       "the record has 29.3", "30 Hz was said"}));
  EXPECT_NEAR(post::read_table(folder_ / "found/identify.csv").numbers("k [N/m]").front(), 45e6, 1e4);
  words = {"meter", "--out", "meter"};
  words.insert(words.end(), record.begin(), record.end());
  EXPECT_TRUE(printed(well(run(words)), {"nominal amplitude       1.8 mm", "k_B "}));
  EXPECT_TRUE(printed(well(run(words_of("advise --roller mine --k 45e6 --D 0.25"))),
                      {"frame frequency         4.82 Hz", " -var roller mine -var k 45e6 -var D 0.25 "}));
}

// What is advised for a roller holds for a run of the deck with the same file.
TEST_F(ToolOptions, AdviceForARollerNamesItsFile) {
  const std::string file = (fs::path(DRUMLIN_SOURCE_DIR) / "inputs/rollers/CA3500").string();
  const post::Outcome outcome =
      well(run(words_of("advise --roller {} --setting low --frequency 33 --error 1e-2", file)));
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
         "dimension,spread,made\n1,0.8,0.4,0.3,0.77,0,0.93,3,2,0.2,poured\n"
         "1,0.8,0.4,0.22,0.82,1,1,4,2,0.2,shaken\n0,0,0,0.2,0.83,1.25,1.02,4,2,0.2,frictionless\n"
         "0.5,0.4,0.2,0.28,0.78,0.25,0.95,3,2,0.2,poured\n";
  const post::Outcome outcome =
      well(run(words_of("bed --width 4 --layer 0.3 --layer 0.3 --packings density.csv --relative-density "
                        "0.125 --relative-density 1.25 --out balls.data")));
  EXPECT_TRUE(
      printed(outcome, {"at a relative density of 0.125: void ratio 0.290 (0.300 loosest, 0.220 shaken), "
                        "poured with friction 0.6 and rolling friction 0.3",
                        "Layer 1: in.settle leaves layers that ask for less than 0.4 looser, by 0.2 to 0.3",
                        "friction 0; denser than shaking leaves it, so that it can only loosen"}));
  EXPECT_FALSE(contains(outcome.output, "Layer 2: in.settle leaves"));
  const std::string text = post::read_text(folder_ / "balls.data");
  for (const char *note : {"relative_density 0.125,1.25\n", "e_loosest 0.3,0.3\n", "e_shaken 0.22,0.22\n",
                           "pour_friction 0.6,0\n", "pour_rolling 0.3,0\n", "packings_friction 0.8,0.8\n",
                           "packings_rolling 0.4,0.4\n", "seed 1\n"})
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
  EXPECT_EQ(
      run(words_of("bed --layer 0.3 --packings density.csv --relative-density 1 --out density.csv")).status,
      2);
  const auto densest = [this](const std::string &relative) {
    return run(words_of("bed --layer 0.3 --packings density.csv --relative-density " + relative +
                        " --out dense.data"));
  };
  // Shaken soil is poured with a quarter of the way from void ratio 0.20 to 0.28, of friction 0 to 0.4.
  EXPECT_TRUE(printed(well(densest("1")), "void ratio 0.220 (0.300 loosest, 0.220 shaken), "
                                          "poured with friction 0.1 and rolling friction 0.05"));
  EXPECT_TRUE(printed(densest("1.26"), "--relative-density is '1.26'; allowed: at most 1.250, of the packing "
                                       "without friction"));
}

// A table of packings says of which balls it is.
TEST_F(ToolOptions, PackingsOfOtherBallsAreRefused) {
  const std::string columns =
      "share,friction,rolling,void_ratio,solid_fraction,relative_density,compaction,coordination";
  const auto refused = [&](const std::string &mix, const std::vector<std::string> &more,
                           const std::string &says) {
    const auto row = [&mix](const std::string &numbers, const std::string &made) {
      return "\n" + numbers + mix + (mix.empty() ? "" : "," + made);
    };
    post::write_files({{folder_ / "density.csv", columns + (mix.empty() ? "" : ",dimension,spread,made") +
                                                     row("1,0.8,0.4,0.3,0.77,0,0.9,3", "poured") +
                                                     row("0,0,0,0.2,0.83,1,1,4", "frictionless") +
                                                     row("1,0.8,0.4,0.22,0.82,1,1,4", "shaken") + "\n"}});
    std::vector<std::string> words =
        words_of("bed --layer 0.3 --packings density.csv --relative-density 1 --out none.data");
    words.insert(words.end(), more.begin(), more.end());
    const post::Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 2);
    expect_one_error(outcome.output, "drumlin bed: ");
    EXPECT_TRUE(printed(outcome, says));
    EXPECT_FALSE(fs::exists(folder_ / "none.data"));
  };
  const std::string allowed = "--packings is 'density.csv'; allowed: packings of ";
  refused(
      "", {},
      "density.csv, column 'dimension': is missing; allowed: a table with a shaken packing, as in.density "
      "and drumlin bed make it; earlier ones end at a packing without friction");
  refused(",3,0.2", {},
          allowed + "discs with radii from r to 1.5 r, grading uniform; it has those of spheres");
  refused(",2,0.2", {"--depth", "0.2"}, allowed + "spheres with radii from r to 1.5 r");
  refused(",2,0", {}, "it has those of discs with radii from r to 1 r");
  refused(",2,0.2", {"--radius-max", "0.032"}, allowed + "discs with radii from r to 2 r");
  refused(",2,0.2", {"--grading", "mass"}, allowed + "discs with radii from r to 1.5 r, grading mass");
  // A curve of the same name and limits whose stones are finer.
  post::write_files({{folder_ / "density.csv",
                      "share,friction,rolling,void_ratio,dimension,spread,grading,d50_over_smallest,made\n"
                      "1,0.8,0.4,0.3,2,0.5,20-60_from_20mm,1.6,poured\n"
                      "1,0.8,0.4,0.22,2,0.5,20-60_from_20mm,1.6,shaken\n"
                      "0,0,0,0.2,2,0.5,20-60_from_20mm,1.6,frictionless\n"}});
  const post::Outcome finer =
      run(words_of("bed --layer 0.3:20-60:20 --packings density.csv --relative-density 1 --out none.data"));
  EXPECT_EQ(finer.status, 2);
  EXPECT_TRUE(printed(finer,
                      "grading 20-60_from_20mm with d50 1.732 times the smallest size; it has those of "
                      "discs with radii from r to 3 r, grading 20-60_from_20mm with d50 1.6 times"));
}

TEST_F(ToolOptions, SpotsAreOfTheLowestLayer) {
  well(run(
      words_of("bed --width 2 --layer 0.3 --layer 0.2 --spot -0.5:-0.25 --spot 0.1:0.6 --out balls.data")));
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
  const post::Outcome outcome = well(run(words_of("bed --width 1.5 --layer 0.3 --layer 0.2:stone.csv:20 "
                                                  "--layer 0.1:stone.csv --balls 3000 --out balls.data")));
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
  program.words = tool_words("exact --omega 0.01 --cycles 300 --contacts 8 --out o");
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
      run_program(tool_words("calibrate --target k=20e6 --vary k=1e8:1e10 --roller mine --balls 1500 --set "
                             "frequency=33 --set c23=7 --out out"),
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
