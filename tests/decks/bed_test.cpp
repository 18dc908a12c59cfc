// The decks of the bed on a small bed: balls are placed, settle, get a roller, and are excited.
#include "tests/support/engine_runs.h"
#include "bed/dump_readers.h"
#include "runs/parameter_file.h"

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

constexpr double gravity = 9.81;
constexpr double in_the_run = 0.5; ///< s of processor time: start and set-up of an engine take 0.1

fs::path bed_folder() { return fs::path(DRUMLIN_SOURCE_DIR) / "inputs/bed"; }

/// 150 balls in a box of 0.6 m under a drum of 100 kg and 0.1 m: settled once for all tests.
class Bed : public ::testing::Test {
protected:
  const WaitForRanks at_once{0}; // the runs on two ranks that fail are refused, or have lost a ball
  static constexpr double roller_mass = 150.0;

  static Variables roller() { return given("m2 100, m3 50, r2 0.1, r3 0.05, k23 5e4, c23 500"); }
  static constexpr std::array<const char *, 2> drums = {"ball", "clump"};
  static constexpr std::array<const char *, 2> steppings = {"stock", "second"}; // the decks' default first

  static void SetUpTestSuite() { scratch = settled("stock"); }
  /// Folder of a bed settled with a scheme and a coefficient of rolling friction, made by the first test that
  /// needs it.
  static fs::path settled(const std::string &stepping, const std::string &rolling = "0") {
    const auto [bed, is_new] = beds.try_emplace(stepping + ", rolling " + rolling);
    if (is_new)
      make(bed->second, "1", {drums.begin(), rolling == "0" ? drums.end() : drums.begin() + 1},
           given("stepping {}, rolling {}, ratio {}", stepping, rolling, rolling == "0" ? "1e-4" : "1e-2"));
    return bed->second.path();
  }
  /// DRUM.restart for each kind of drum, in a folder.
  static void make(const Scratch &folder, const std::string &seed, const std::vector<std::string> &kinds,
                   const Variables &more = {}) {
    well(run_program(tool_words("bed --balls 150 --width 0.6 --seed {} --out balls.data", seed), {},
                     folder.path()));
    const Variables settling = with(more, given("case loose, balls balls.data, bed soil.restart"));
    well(run_deck(bed_folder() / "in.settle", settling, folder.path()));
    for (const std::string &drum : kinds) {
      const Variables variables =
          with(with(roller(), more), given("bed soil.restart, drum {}, start {}", drum, drum + ".restart"));
      well(run_deck(bed_folder() / "in.place", variables, folder.path()));
    }
  }
  /// A cycle of 50 Hz in 1000 steps, which are as long as those of the decks' 2500 in a cycle of 20 Hz.
  static Variables short_cycle() {
    return given("omega 314.1592653589793, steps_per_cycle 1000, samples_per_cycle 100");
  }
  static Outcome run(const fs::path &deck, const Scratch &folder, const Variables &more, int ranks = 1) {
    Variables variables = more; // the engine takes the first of a name
    const std::string name = deck.filename().string();
    for (const auto &variable : roller())
      variables.push_back(variable);
    std::string drum = "ball", stepping = "stock";
    for (const auto &[variable, value] : more)
      if (variable == "drum")
        drum = value;
      else if (variable == "stepping")
        stepping = value;
    const fs::path bed = settled(stepping);
    variables.emplace_back("here", bed_folder().string());
    if (name == "in.settle") variables.emplace_back("case", "loose");
    if (name != "in.settle" && name != "in.place" && name != "in.tile")
      variables = with(variables, given("start {}, Fw 2940, cycles 2", (bed / (drum + ".restart")).string()));
    return run_deck(deck, variables, folder.path(), ranks);
  }
  static Outcome shake(const Scratch &folder, const Variables &more, int ranks = 1) {
    return run(bed_folder() / "in.bed", folder, more, ranks);
  }

  /// Output folders whose names a shell would interpret or expand, such as `B[1]` and `x$(touch pwned)`: a
  /// run removes the dumps of an earlier run in the same folder, and leaves those of other runs.
  static void expect_dumps_into_folders_of_any_name(const char *deck, const Variables &more) {
    const Scratch folder;
    const auto shaken = [&](const std::string &out, const char *dumps) {
      const Variables variables =
          with({{"cycles", "1"},
                {"omega", "3141.6"}, // a high frequency: a cycle of few steps of the usual length
                {"steps_per_cycle", "100"},
                {"samples_per_cycle", "10"},
                {"dumps_per_cycle", dumps},
                {"out", (folder / out).string()}},
               more);
      return run(bed_folder() / deck, folder, variables);
    };
    well(shaken("B1", "5"));
    for (const char *out : {"B[1]", "run(1)", "A&B", "-x", "{}", "B?", "~", "x;echo", "x|y", "`id`"}) {
      fs::create_directories(folder / out / "dump");
      for (const char *earlier : {"balls_7.vtp", "contacts_7.dump"})
        std::ofstream(folder / out / "dump" / earlier) << "old";
      const Outcome outcome = shaken(out, "5");
      ASSERT_TRUE(outcome.ok()) << out << outcome.output;
      EXPECT_EQ(post::dumped_steps(folder / out / "dump").size(), 6u) << out;
      EXPECT_EQ(post::dumped_steps(folder / "B1/dump").size(), 6u) << out;
    }
    std::ofstream(folder / "B1/dump/thesis.txt") << "mine\n";
    const std::string before = read_text(folder / "B1/bed.csv");
    EXPECT_TRUE(
        fails_with(shaken("B1", "10"), "with the file 'thesis.txt', which is no dump of a run; allowed: "));
    EXPECT_EQ(read_text(folder / "B1/bed.csv"), before);
    EXPECT_EQ(post::dumped_steps(folder / "B1/dump").size(), 6u);
    for (const char *out : {"x$(touch pwned)", "B*", "100%", "a b"})
      EXPECT_TRUE(fails_with(shaken(out, "5"), "ERROR: drumlin/")) << out;
    EXPECT_FALSE(fs::exists(folder / "pwned"));
  }

  /// On a disk without space for the first dump the run ends with an error, and the earlier run's files are
  /// unchanged.
  static void expect_cut_dumps_are_an_error(const std::string &engine_and_deck, const std::string &more) {
    if (!can_mount_small_disk()) GTEST_SKIP() << "SKIPPED: a file system of its own needs root";
    const Scratch folder;
    std::string words = engine_and_deck + more;
    for (const auto &[name, value] :
         given("omega 3141.6, steps_per_cycle 100, samples_per_cycle 10, cycles 2, Fw 2940, out o, start {}",
               (scratch / "ball.restart").string()))
      words += fmt::format(" -var {} '{}'", name, value);
    for (const auto &[name, value] : roller())
      words += fmt::format(" -var {} {}", name, value);
    const Outcome outcome = on_small_disk(
        folder.path(), fmt::format("run() {{ {} -log none -var dumps_per_cycle $1; }}\n"
                                   "mkdir -p o/dump; mount -t tmpfs -o size=8k tmpfs o/dump || exit 77\n"
                                   "run 0 || exit 10\ncp -r o before\n"
                                   "run 2\necho status $?\ndiff -r before o && echo whole\n",
                                   words));
    if (outcome.says("ERROR on proc 0: Error writing dump")) { // LAMMPS of 2025 and later, which aborts
      EXPECT_TRUE(printed(outcome, "Only in o: bed.csv.earlier"));
      return;
    }
    EXPECT_TRUE(printed(outcome, {"status 1\nwhole\n", "ERROR: drumlin/outputs: dump is 'o/dump/",
                                  "', which is incomplete; allowed: a disk with room"}));
    EXPECT_EQ(outcome.output.find("ERROR"), outcome.output.rfind("ERROR")) << outcome.output;
  }

  /// A signal stops a run in the middle of a piece; another run continues from the restart file that it has
  /// written.
  static void expect_ends_at_a_signal(const char *deck, const Variables &more) {
    const Scratch folder;
    const auto shaken = [&](const Variables &variables) {
      const Variables all =
          with(with(with(variables, more), {{"omega", "0.12566370614359174"}, // a period of 50 s
                                            {"steps_per_cycle", "2500000"},
                                            {"samples_per_cycle", "250000"},
                                            {"start", (scratch / "ball.restart").string()},
                                            {"Fw", "2940"}}),
               roller());
      return run_deck(bed_folder() / deck, all, folder.path(), 1, 60.0, after_processor_time(in_the_run));
    };
    const Outcome stopped = shaken({});
    EXPECT_TRUE(stopped.timed_out);
    EXPECT_TRUE(fails_with(
        stopped, {"ERROR: drumlin/run: stopped by a signal at step ", "; allowed: to continue from "}));
    EXPECT_EQ(stopped.output.find("ERROR"), stopped.output.rfind("ERROR")) << stopped.output;

    const std::size_t rows_before = post::read_table(folder / "bed.csv").rows();
    const Outcome resumed = shaken({{"start", (folder / "stopped.restart").string()}});
    EXPECT_EQ(resumed.status, 1);
    const post::Table rows = post::read_table(folder / "bed.csv");
    ASSERT_GT(rows.rows(), rows_before) << resumed.output;
    const std::vector<double> time = rows.numbers("time");
    for (std::size_t n = 1; n < time.size(); ++n)
      ASSERT_NEAR(time[n] - time[n - 1], 50.0 / 250000.0, 1e-9) << "row " << n;
  }

  /// Stopped by the limit of wall time in the middle of the excitation, and continued from there in another
  /// process.
  static void expect_goes_on(const char *deck, const char *stepping, const char *boundary) {
    const auto shaken = [=](const Scratch &folder, Variables more, int ranks) {
      more = with(more, given("cycles 3, dumps_per_cycle 2, stepping {}, boundary {}", stepping, boundary));
      more = with(more, short_cycle());
      if (std::string(deck) == "in.bed.lammps") more = with(more, given("rest 0, balance 1e30"));
      return run(bed_folder() / deck, folder, more, ranks);
    };
    for (const int ranks : {1, 2}) {
      if (most_ranks() == 2 && (ranks == 1) == (std::string(stepping) == "stock")) continue; // by night
      const Scratch stayed, left;
      well(shaken(stayed, {}, ranks));
      const Outcome stopped = well(shaken(left, {{"time_limit", "1e-3"}}, ranks));
      EXPECT_TRUE(
          printed(stopped, "drumlin/run: stopped at step 1000 of 3000 by limit 0.001 s; continue from "));
      EXPECT_EQ(post::read_table(left / "bed.csv").rows(), 101u);
      const std::string start = (left / "stopped.restart").string();
      // A changed value of any of the three is refused, on any number of ranks. To save time omega is tried
      // on one rank, the others on two.
      const Variables of_another_scene =
          ranks == 1 ? Variables{{"omega", "100"}} : given("Fw 10, steps_per_cycle 5000");
      for (const auto &[name, value] : of_another_scene) {
        EXPECT_TRUE(
            fails_with(shaken(left, {{"start", start}, {name, value}}, ranks),
                       fmt::format("ERROR: drumlin/variable: variable {} is '{}'; allowed: ", name, value)));
      }
      EXPECT_EQ(post::read_parameters(left / "parameters.csv").at("ended"),
                "drumlin/run: stopped at step 1000 of 3000 by limit 0.001 s; continue from " + start);
      const std::string copy = (stayed / "copy.restart").string();
      fs::copy_file(start, copy);
      for (const std::string &from : {start, copy}) { // continued twice, the tables have each row once
        well(shaken(left, {{"start", from}}, ranks));
        EXPECT_EQ(post::read_parameters(left / "parameters.csv").at("ended"), "yes");
        EXPECT_FALSE(fs::exists(start)); // of a run that has ended there is nothing to continue
      }
      EXPECT_TRUE(printed(shaken(left, {{"start", start}}, ranks),
                          "ERROR: drumlin/variable: variable start is '" + start +
                              "'; allowed: a file that can be read, which a run writes when it is stopped"));
      for (const char *file : {"bed.csv", "cycles.csv", "events.csv"})
        EXPECT_EQ(read_text(left / file), read_text(stayed / file)) << file << ", ranks " << ranks;
      EXPECT_EQ(post::read_table(left / "bed.csv").rows(), 301u);

      const std::map<long, post::StepDump> whole = post::dumped_steps(stayed / "dump"),
                                           parts = post::dumped_steps(left / "dump");
      ASSERT_EQ(whole.size(), 7u);
      ASSERT_EQ(parts.size(), 7u);
      for (const auto &[step, files] : whole) {
        const std::vector<post::Ball> balls = post::read_ball_dump(files.balls);
        const auto summed = [&balls](const fs::path &file) {
          const post::BedContacts contacts = post::read_contact_dump(file, balls);
          double sum = 0.0;
          for (const post::BallContact &contact : contacts.balls)
            sum += std::hypot(contact.force[0], contact.force[1]);
          for (const post::WallContact &contact : contacts.walls)
            sum += std::hypot(contact.force[0], contact.force[1]);
          return sum;
        };
        const double before = summed(files.contacts), after = summed(parts.at(step).contacts);
        if (step == 1000) // a set-up: a contact that slid then has the force of its dashpot as well
          EXPECT_NEAR(after, before, 5e-2 * before);
        else
          EXPECT_EQ(after, before) << "step " << step << ", ranks " << ranks;
      }
    }
  }

  static double soil_mass() {
    double mass = 0.0;
    for (const double r : radii())
      mass += pi * r * r * 2650.0;
    return mass;
  }
  struct DataBall {
    int type;
    double radius, x, y; // m
  };
  /// The balls of a data file.
  static std::vector<DataBall> balls_of(const fs::path &file) {
    const std::string text = read_text(file);
    std::istringstream lines(text.substr(text.find("Atoms")));
    std::vector<DataBall> balls;
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line) && line.rfind("Velocities", 0) != 0) {
      std::istringstream row(line);
      DataBall ball{};
      double id = 0, diameter = 0, density = 0;
      if (!(row >> id >> ball.type >> diameter >> density >> ball.x >> ball.y)) continue;
      ball.radius = 0.5 * diameter;
      balls.push_back(ball);
    }
    return balls;
  }
  /// Of the soil balls as they are poured.
  static std::vector<double> radii() {
    std::vector<double> radii;
    for (const DataBall &ball : balls_of(scratch / "balls.data"))
      radii.push_back(ball.radius);
    return radii;
  }
  /// How deep the lowest point of a drum that is one ball lies below the mean surface that the soil had
  /// before, m. The surface is taken farther than 1.5 radii of the drum from the middle, on lines that are
  /// 0.1 mm apart.
  static double depth_of_drum(const fs::path &soil, const fs::path &placed) {
    constexpr double half_width = 0.3, spacing = 1e-4; // m
    const std::vector<DataBall> balls = balls_of(soil), after = balls_of(placed);
    const DataBall drum =
        *std::find_if(after.begin(), after.end(), [](const DataBall &ball) { return ball.type == 2; });
    double sum = 0.0;
    int lines = 0;
    const auto all = static_cast<int>(std::lround(2.0 * half_width / spacing));
    for (int line = 0; line < all; ++line) {
      const double x = -half_width + (line + 0.5) * spacing;
      if (std::fabs(x) < 1.5 * drum.radius) continue;
      double top = 0.0;
      for (const DataBall &ball : balls)
        if (const double across = std::fabs(x - ball.x); across < ball.radius)
          top = std::max(top, ball.y + std::sqrt(ball.radius * ball.radius - across * across));
      sum += top;
      ++lines;
    }
    return sum / lines - (drum.y - drum.radius);
  }

  static fs::path scratch; ///< folder of the bed of most tests
  static std::map<std::string, Scratch> beds;

public:
  /// Removes the beds after the last test.
  class Removal : public ::testing::Environment {
    void TearDown() override { beds.clear(); }
  };
};
fs::path Bed::scratch;
std::map<std::string, Scratch> Bed::beds;
const auto *const removal = ::testing::AddGlobalTestEnvironment(new Bed::Removal); // GoogleTest owns it

TEST_F(Bed, CarriesTheRollerAtRestAndIsShakenUnderBothTransitions) {
  ASSERT_EQ(radii().size(), 150u);
  for (const char *transition : {"A", "B"}) {
    const Scratch folder;
    EXPECT_TRUE(
        printed(well(shake(folder, {{"transition", transition}})), "drumlin/run: 100 %, step 5000 of 5000"));
    const post::Table table = post::read_table(folder / "bed.csv");
    ASSERT_EQ(table.rows(), 501u);
    const auto start = [&](const char *column) { return table.numbers(column).front(); };
    EXPECT_NEAR(start("F_contact"), roller_mass * gravity, 1e-4 * roller_mass * gravity);
    const double weight = (roller_mass + soil_mass()) * gravity;
    EXPECT_NEAR(start("F_floor") + start("F_sides"), weight, 1e-4 * weight);
    EXPECT_EQ(start("x_drum"), 0.0);
    // The bond carries the frame: x_frame = x_drum where it is unstretched.
    EXPECT_NEAR(start("x_frame"), -50.0 * gravity / 5e4, 1e-6);
    for (const char *column : {"F_contact", "F_floor", "kinetic", "elastic", "dissipated", "void_ratio"})
      for (const double value : table.numbers(column))
        ASSERT_TRUE(std::isfinite(value)) << column;
    EXPECT_GT(start("coordination"), 2.0);
    EXPECT_LT(start("coordination"), 4.5);
    EXPECT_GT(start("void_ratio"), 0.1); // the closest packing of discs of one size has 0.10
    EXPECT_LT(start("void_ratio"), 0.45);
    // A second cycle begins: the first one's mean position of the drum is there, and the same in both files.
    const post::Table cycles = post::read_table(folder / "cycles.csv");
    EXPECT_EQ(table.numbers("settlement").back(), cycles.numbers("settlement").back());
    EXPECT_NE(cycles.numbers("settlement").back(), 0.0);
  }
}

// All forces on the drum are in a row, friction of contacts that slide included: except for makes and breaks
// within a step, they account for the change of its velocity.
TEST_F(Bed, RecordsTheForcesThatMoveTheDrum) {
  for (const auto &[transition, stepping] : {std::pair{"A", "second"}, {"B", "second"}, {"B", "stock"}}) {
    const Scratch folder;
    well(shake(folder, given("transition {}, stepping {}, friction 0.2, allow_change friction, balance 1e30, "
                             "cycles 1, samples_per_cycle 2500",
                             transition, stepping)));
    const post::Table table = post::read_table(folder / "bed.csv");
    const std::vector<double> time = table.numbers("time"), v = table.numbers("v_drum"),
                              a = table.numbers("a_drum");
    ASSERT_EQ(time.size(), 2501u);
    double missed = 0.0, largest = 0.0;
    for (std::size_t n = 1; n < time.size(); ++n) {
      missed += std::fabs((v[n] - v[n - 1]) / (time[n] - time[n - 1]) - 0.5 * (a[n] + a[n - 1]));
      largest = std::max(largest, std::fabs(a[n]));
    }
    EXPECT_GT(largest, 10.0); // m/s2
    EXPECT_LT(missed / 2500.0, 1e-3 * largest) << transition << ", " << stepping;
  }
}

// The same bed, whatever the number of ranks; borders between ranks lie under the drum.
TEST_F(Bed, GoesTheSameWayOnSeveralRanks) {
  const std::array<std::array<const char *, 3>, 4> scenes = {{{"ball", "stock", "rigid"},
                                                              {"clump", "stock", "rigid"},
                                                              {"ball", "second", "rigid"},
                                                              {"clump", "second", "absorb"}}};
  for (const auto &[drum, stepping, boundary] : scenes) {
    const Scratch one;
    const Variables variables =
        with(short_cycle(), given("cycles 1, drum {}, stepping {}, boundary {}", drum, stepping, boundary));
    well(shake(one, variables));
    const std::vector<double> alone = post::read_table(one / "bed.csv").numbers("x_drum");
    for (int ranks = 2; ranks <= most_ranks(); ranks *= 2) {
      const Scratch folder;
      EXPECT_TRUE(printed(well(shake(folder, variables, ranks)),
                          std::to_string(ranks) + " by 1 by 1 MPI processor grid"));
      const std::vector<double> together = post::read_table(folder / "bed.csv").numbers("x_drum");
      ASSERT_EQ(alone.size(), together.size());
      ASSERT_EQ(alone.size(), 101u);
      EXPECT_NE(alone[100], 0.0);
      for (std::size_t i = 0; i <= 100; ++i) // 1000 steps
        EXPECT_NEAR(alone[i], together[i], 1e-10)
            << "row " << i << ", ranks " << ranks << ", " << drum << ", " << stepping << ", " << boundary;
    }
  }
}

// The motion of a bed is chaotic: after six cycles one rank and two agree only in means over several beds.
// The means of five seeds may differ by two standard errors. It takes 19 s, so .ci/nightly runs it; other
// tests compare the rows of shorter runs on both.
TEST_F(Bed, DISABLED_MeansOverSeedsAgreeOnRanksOneAndTwo) {
  constexpr std::size_t seeds = 5;
  const std::array<const char *, 3> columns = {"settlement", "a_drum_max", "F_contact_max"};
  std::array<std::array<std::vector<double>, 3>, 2>
      means; // [ranks - 1][column][seed], over the last four cycles
  for (std::size_t seed = 1; seed <= seeds; ++seed) {
    const Scratch made;
    make(made, std::to_string(seed), {"ball"});
    for (const int ranks : {1, 2}) {
      const Scratch folder;
      well(shake(folder, given("start {}, cycles 6", (made / "ball.restart").string()), ranks));
      const post::Table cycles = post::read_table(folder / "cycles.csv");
      ASSERT_EQ(cycles.rows(), 7u);
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const std::vector<double> all = cycles.numbers(columns[c]);
        means[static_cast<std::size_t>(ranks) - 1][c].push_back(
            std::accumulate(all.begin() + 3, all.end(), 0.0) / 4);
      }
    }
  }
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::array<double, 2> mean{}, variance_of_mean{};
    for (std::size_t r = 0; r < 2; ++r) {
      for (const double value : means[r][c])
        mean[r] += value / seeds;
      for (const double value : means[r][c])
        variance_of_mean[r] += (value - mean[r]) * (value - mean[r]) / (seeds * (seeds - 1));
    }
    const double two_errors = 2.0 * std::sqrt(variance_of_mean[0] + variance_of_mean[1]);
    EXPECT_LT(std::fabs(mean[0] - mean[1]), two_errors)
        << columns[c] << ": " << mean[0] << " and " << mean[1];
    EXPECT_GT(two_errors, 0.0); // the seeds are different beds
    RecordProperty(columns[c], std::to_string(mean[0]) + " " + std::to_string(mean[1]) + " +- " +
                                   std::to_string(two_errors));
  }
}

TEST_F(Bed, RepeatsItselfOnRanksOneAndTwo) {
  for (const char *stepping : steppings)
    for (const int ranks : {1, 2}) {
      const Scratch once, again;
      const Variables variables = with(short_cycle(), given("cycles 1, stepping {}", stepping));
      well(shake(once, variables, ranks));
      well(shake(again, variables, ranks));
      for (const char *file : {"bed.csv", "cycles.csv", "events.csv"})
        EXPECT_EQ(read_text(once / file), read_text(again / file))
            << file << ", ranks " << ranks << ", " << stepping;
    }
}

TEST_F(Bed, ContinuesWhereALimitOfTimeStoppedItOnRanksOneAndTwo) {
  expect_goes_on("in.bed", "stock", "rigid");
  expect_goes_on("in.bed", "second", "absorb");
}

// Contacts between balls conserve momentum: the total changes by the impulses of walls, weight and exciter
// only. They are compared with the engine's own forces, ball by ball, and with the velocities that these lead
// to.
TEST_F(Bed, ForcesOfTheWallsMinusWeightAreTheRateOfChangeOfMomentum) {
  for (const auto &[stepping, boundary] :
       {std::pair{"stock", "rigid"}, {"second", "rigid"}, {"stock", "absorb"}}) {
    const Scratch folder;
    const Variables variables =
        given("cycles 1, samples_per_cycle 2500, stepping {}, boundary {}", stepping, boundary);
    well(run(test_deck("bed_steps.in"), folder, variables));
    const post::Table table = post::read_table(folder / "bed.csv");
    const std::vector<Frame> frames = read_dump(folder / "state.dump");
    ASSERT_EQ(frames.size(), 51u);
    const std::vector<double> floor = table.numbers("F_floor"), sides = table.numbers("F_sides"),
                              excitation = table.numbers("F_excitation"), kinetic = table.numbers("kinetic");
    const std::vector<double> radius = radii();
    const double weight = (roller_mass + soil_mass()) * gravity;
    const auto mass = [&](long id) {
      return id == 151   ? 100.0
             : id == 152 ? 50.0
                         : pi * std::pow(radius.at(static_cast<std::size_t>(id) - 1), 2) * 2650.0;
    };
    double momentum_before = 0.0, force_before = 0.0;
    std::size_t exact = 0;
    for (std::size_t n = 1; n < frames.size();
         ++n) { // the first one is dumped before its forces are computed again
      const auto row = static_cast<std::size_t>(frames[n].step);
      const double recorded = floor.at(row) + sides.at(row) - weight - excitation.at(row);
      double force = 0.0, momentum = 0.0, energy = 0.0;
      for (const auto &[id, ball] : frames[n].balls) {
        force += ball.f[1];
        momentum += mass(id) * ball.v[1];
        energy += 0.5 * mass(id) * (ball.v[0] * ball.v[0] + ball.v[1] * ball.v[1]);
        if (id <= 150) {
          const double r = radius.at(static_cast<std::size_t>(id) - 1);
          energy += 0.25 * mass(id) * r * r * ball.omega[2] * ball.omega[2];
        }
      }
      EXPECT_NEAR(kinetic.at(row), energy, 1e-10 * energy);
      EXPECT_NEAR(recorded, force, 1e-10 * weight) << "step " << row;
      if (n > 1) {
        const double change = (momentum - momentum_before) / (0.05 / 2500);
        const double mean = 0.5 * (force_before + recorded);
        EXPECT_NEAR(change, mean, 1e-3 * weight) << "step " << row;
        exact += std::fabs(change - mean) < 1e-10 * weight ? 1 : 0;
      }
      momentum_before = momentum;
      force_before = recorded;
    }
    // In the step of a make the halves of a second-order step get unlike forces (doc page of the pair style);
    // all others are exact.
    EXPECT_GT(exact, std::string(stepping) == "second" ? 25u : 48u) << stepping;
  }
}

// Single balls of the clump make and break contacts; all of them move alike.
TEST_F(Bed, ClumpStaysRigidOnRanksOneAndTwo) {
  for (const auto &[stepping, ranks] : {std::pair{"stock", 1}, {"second", 1}, {"second", 2}}) {
    const Scratch folder;
    well(run(test_deck("bed_steps.in"), folder,
             given("cycles 1, drum clump, Fw 6000, steps 500, stepping {}", stepping), ranks));
    const std::vector<Frame> frames = read_dump(folder / "state.dump");
    const std::map<long, Ball> &first = frames.front().balls, &last = frames.back().balls;
    const long frame = last.rbegin()->first;
    const std::array<double, 3> moved = {0.0, last.at(151).x[1] - first.at(151).x[1], 0.0};
    EXPECT_NE(moved[1], 0.0);
    for (long id = 151; id < frame; ++id)
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_NEAR(last.at(id).x[a] - first.at(id).x[a], moved[a], 1e-12) << id << ", ranks " << ranks;
        EXPECT_NEAR(last.at(id).v[a], last.at(151).v[a], 1e-12) << id << ", ranks " << ranks;
      }
  }
}

/// Energy error over the work of the exciter: the largest value over all rows.
double imbalance(const fs::path &file, double until = std::numeric_limits<double>::infinity()) {
  const post::Table table = post::read_table(file);
  const std::vector<double> time = table.numbers("time"), kinetic = table.numbers("kinetic"),
                            potential = table.numbers("potential"), elastic = table.numbers("elastic"),
                            dissipated = table.numbers("dissipated"), work = table.numbers("work_excitation");
  double worst = 0.0;
  std::size_t n = 0;
  for (; n < work.size() && time[n] <= until; ++n)
    worst = std::max(worst, std::fabs(kinetic[n] + potential[n] + elastic[n] + dissipated[n] - work[n] -
                                      kinetic[0] - potential[0] - elastic[0]));
  return worst / work.at(n - 1);
}

TEST_F(Bed, EnergyErrorIsBelowAPercentOverTenCyclesAndFallsWithTheStep) {
  const std::array<std::array<const char *, 3>, 4> scenes = {
      {{"A", "ball", "stock"}, {"B", "ball", "stock"}, {"B", "clump", "stock"}, {"B", "ball", "second"}}};
  for (const auto &[transition, drum, stepping] : scenes) {
    const auto shaken = [transition = transition, drum = drum,
                         stepping = stepping](const Scratch &folder, const char *cycles, const char *steps) {
      well(shake(folder, given("cycles {}, transition {}, steps_per_cycle {}, drum {}, stepping {}", cycles,
                               transition, steps, drum, stepping)));
    };
    const Scratch coarse, fine;
    shaken(coarse, "10", "2500");
    shaken(fine, "2", "10000");
    const std::string scene = std::string(transition) + ", " + drum + ", " + stepping;
    EXPECT_LT(imbalance(coarse / "bed.csv"), 0.01) << scene;
    const double two_cycles = 2.0 * 0.05 + 1e-9; // s
    const double less = imbalance(fine / "bed.csv"), more = imbalance(coarse / "bed.csv", two_cycles);
    RecordProperty("missing " + scene, std::to_string(more) + ", " + std::to_string(less));
    EXPECT_LT(less, more) << scene;
  }
}

TEST_F(Bed, EnergyErrorIsBelowAPercentWithRollingFriction) {
  const fs::path bed = settled("stock", "0.1");
  std::vector<double> heat;
  for (const char *rolling : {"0.1", "1e-6"}) {
    const Scratch folder;
    well(shake(folder, given("cycles 5, rolling {}, allow_change rolling, balance 1e30, start {}", rolling,
                             (bed / "ball.restart").string())));
    EXPECT_LT(imbalance(folder / "bed.csv"), 0.01) << rolling;
    heat.push_back(post::read_table(folder / "bed.csv").numbers("dissipated").back());
  }
  EXPECT_GT(std::fabs(heat[0] - heat[1]), 0.05 * heat[0]); // the torques of rolling friction dissipate energy
}

/// Springs and dashpots of all balls of the floor are together those of the ground below it: the area times
/// rho c_p^2/H and rho c_p.
void expect_ground_below_floor(const std::string &output, const fs::path &folder) {
  constexpr double area = 0.6; // m2, width of the bed times a thickness of 1 m
  const std::string name = "fix boundary/absorb ground_floor: ";
  const std::size_t line = output.find(name);
  ASSERT_NE(line, std::string::npos) << output;
  double balls = 0.0, spring = 0.0, dashpot = 0.0;
  ASSERT_EQ(std::sscanf(output.c_str() + line + name.size(),
                        "%lf balls, each with normal k = %lf N/m, c = %lf", &balls, &spring, &dashpot),
            3);
  const std::map<std::string, std::string> made = post::read_parameters(folder / "parameters.csv");
  const auto value = [&made](const char *key) { return std::stod(made.at(key)); };
  const double impedance = value("ground_density") * value("ground_cp");
  EXPECT_NEAR(balls * dashpot, impedance * area, 1e-5 * impedance * area);
  const double stiffness = impedance * value("ground_cp") / value("ground_depth") * area;
  EXPECT_NEAR(balls * spring, stiffness, 1e-5 * stiffness);
}

TEST_F(Bed, EnergyErrorIsBelowAThousandthOnGroundThatAbsorbs) {
  for (const char *stepping : steppings) {
    const Scratch folder;
    const Outcome outcome = well(shake(folder, given("boundary absorb, cycles 4, stepping {}", stepping)));
    const double error = imbalance(folder / "bed.csv");
    RecordProperty(stepping, std::to_string(error));
    EXPECT_LT(error, 1e-3) << stepping;
    const post::Table cycles = post::read_table(folder / "cycles.csv");
    const std::vector<double> work = cycles.numbers("work_excitation"),
                              heat = cycles.numbers("dissipated_ground"),
                              stored = cycles.numbers("stored_ground");
    EXPECT_GT(heat.back(), 0.05 * work.back()) << stepping; // so the ground takes part in the balance
    expect_ground_below_floor(outcome.output, folder.path());
    double balance = -work.back();
    for (const char *column : {"dissipated_contact", "dissipated_bond", "dissipated_friction", "kinetic",
                               "potential", "stored_contact", "stored_bond"})
      balance += cycles.numbers(column).back() - cycles.numbers(column).front();
    EXPECT_NEAR(balance, -(heat.back() + stored.back()), 1e-3 * work.back()) << stepping;
  }
}

// The energy balance closes with the heat of yielding as a term of its own, and a run that continues from a
// restart file has the same rows: the file holds that heat and the largest overlap of each contact.
TEST_F(Bed, EnergyErrorIsBelowAThousandthWithContactsThatYieldAndContinue) {
  for (const char *stepping : steppings) {
    const Scratch bed, stayed, left;
    make(bed, "1", {"ball"}, given("stepping {}, yield 3, ratio 1e-2", stepping));
    const auto shaken = [&](const Scratch &folder, const Variables &more) {
      return well(shake(folder, with(more, given("stepping {}, cycles 4, balance 1e30, start {}", stepping,
                                                 (bed / "ball.restart").string()))));
    };
    shaken(stayed, {});
    const double error = imbalance(stayed / "bed.csv");
    RecordProperty(stepping, std::to_string(error));
    EXPECT_LT(error, 1e-3) << stepping;
    const post::Table cycles = post::read_table(stayed / "cycles.csv");
    const double work = cycles.numbers("work_excitation").back();
    EXPECT_GT(cycles.numbers("dissipated_yield").back(), 0.05 * work) << stepping;
    double balance = -work;
    for (const char *column : {"dissipated_contact", "dissipated_bond", "dissipated_friction", "kinetic",
                               "potential", "stored_contact", "stored_bond", "dissipated_yield"})
      balance += cycles.numbers(column).back() - cycles.numbers(column).front();
    EXPECT_NEAR(balance, 0.0, 1e-3 * work) << stepping;
    shaken(left, {{"time_limit", "1e-3"}});
    shaken(left, {{"start", (left / "stopped.restart").string()}});
    for (const char *file : {"bed.csv", "cycles.csv", "events.csv"})
      EXPECT_EQ(read_text(left / file), read_text(stayed / file)) << file << ", " << stepping;
  }
}

// On gravel a vibrating drum stays within 2 % of its diameter of 0.2 m. Without rolling friction
// it settles more: of four seeds by 2 to 18 mm in four cycles. At rest the sides carry a part of the weight
// by friction, as in a silo. A bed that was poured with k / 10 is wedged between them: they press it down,
// and the floor carries 1.15 weights.
TEST_F(Bed, OfGravelCarriesTheVibratingDrum) {
  const Scratch gravel;
  make(gravel, "1", {"ball"}, given("case gravel, ratio 1"));
  double sides = 0.0; // N per m, upward, at rest
  double depth = 0.0; // m
  const auto settlement = [&](const Variables &soil) {
    const Scratch folder;
    const Variables variables =
        with(soil, given("cycles 4, balance 1e9, start {}", (gravel / "ball.restart").string()));
    well(shake(folder, variables));
    sides = post::read_table(folder / "bed.csv").numbers("F_sides").front();
    depth = std::stod(post::read_parameters(folder / "parameters.csv").at("drum_depth"));
    return post::read_table(folder / "cycles.csv").numbers("settlement").back();
  };
  const double carried = settlement({});
  EXPECT_LT(carried, 0.004);
  EXPECT_GT(sides, 0.0);
  EXPECT_NEAR(depth, depth_of_drum(gravel / "soil.restart.data", gravel / "ball.restart.data"), 5e-4);
  EXPECT_GT(settlement(given("rolling 0, allow_change rolling")), carried + 0.001);
}

// A base course, the default case, carries it within 5 %; its contacts yield meanwhile.
TEST_F(Bed, OfABaseCourseCarriesTheVibratingDrum_ByNight) {
  const Scratch base, folder;
  make(base, "1", {"ball"}, given("case base, ratio 1"));
  well(shake(folder, given("cycles 4, balance 1e9, start {}", (base / "ball.restart").string())));
  EXPECT_EQ(post::read_parameters(folder / "parameters.csv").at("tensile_strength"), "2e4");
  const post::Table cycles = post::read_table(folder / "cycles.csv");
  EXPECT_LT(cycles.numbers("settlement").back(), 0.01);
  EXPECT_GT(cycles.numbers("dissipated_yield").back(), 0.0);
}

// Absorbing sides keep the reaction of the walls: they do not creep under the earth pressure.
TEST_F(Bed, LeftAloneStaysAsItIs) {
  for (const auto &[stepping, boundary] :
       {std::pair{"stock", "rigid"}, {"second", "rigid"}, {"stock", "absorb"}}) {
    const Scratch folder;
    const Outcome outcome =
        shake(folder, given("Fw 0, cycles 4, stepping {}, boundary {}", stepping, boundary)); // 10,000 steps
    ASSERT_TRUE(outcome.ok()) << outcome.output;
    const post::Table table = post::read_table(folder / "bed.csv");
    const std::vector<double> x = table.numbers("x_drum"), force = table.numbers("F_contact"),
                              coordination = table.numbers("coordination"),
                              kinetic = table.numbers("kinetic");
    double support = 0.0;
    for (std::size_t n = 0; n < x.size(); ++n) {
      EXPECT_NEAR(x[n], 0.0, 1e-7) << n; // m
      EXPECT_NEAR(force[n], force[0], 1e-4 * force[0]) << n;
      EXPECT_NEAR(coordination[n], coordination[0], 0.02) << n;
      EXPECT_LT(kinetic[n], 1e-6) << n; // J
      support += table.numbers("F_floor")[n] + table.numbers("F_sides")[n];
    }
    const double weight = (roller_mass + soil_mass()) * gravity;
    EXPECT_NEAR(support / static_cast<double>(x.size()), weight, 1e-4 * weight);
  }
}

TEST_F(Bed, NeedsTheFilesOfTheDecksBeforeIt) {
  const Scratch folder;
  const Outcome outcome = shake(folder, {{"start", "nowhere.restart"}});
  EXPECT_TRUE(fails_with(outcome, {"variable start is 'nowhere.restart'; allowed: ",
                                   "./drumlin run inputs/bed/in.place -var start nowhere.restart"}));
  EXPECT_FALSE(fs::exists(folder / "bed.csv"));
}

// The engine would hang on two ranks, or continue with laws that do not fit the contact history.
TEST_F(Bed, RefusesFilesThatAreCutShortOrOfAnotherSceneOnRanksOneAndTwo) {
  const std::string whole = read_text(scratch / "ball.restart"), balls = read_text(scratch / "balls.data");
  const std::string cut = ", which is incomplete, damaged or no restart file; allowed: a restart file of "
                          "drumlin/write or drumlin/run";
  const auto refused = [](const char *deck, const Variables &variables, const std::string &says, int ranks) {
    const Scratch folder;
    EXPECT_TRUE(fails_with(run(bed_folder() / deck, folder, variables, ranks), says)) << says;
    EXPECT_FALSE(fs::exists(folder / "bed.csv"));
    EXPECT_FALSE(fs::exists(folder / "x.restart"));
  };
  const Scratch files;
  const auto written = [&files](const char *name, const std::string &text) {
    std::ofstream(files / name, std::ios::binary) << text;
    return (files / name).string();
  };
  std::string flipped = whole;
  flipped[whole.size() / 2] ^= 1;
  const std::string header = written("cut.restart", whole.substr(0, 100)),
                    half = written("half.restart", whole.substr(0, whole.size() / 2)),
                    nearly = written("nearly.restart", whole.substr(0, whole.size() - 1)),
                    longer = written("longer.restart", "x" + whole),
                    damaged = written("damaged.restart", flipped), other = written("other.restart", balls),
                    some = written("some.data", balls.substr(0, balls.size() / 2)),
                    none = written("none.data", whole);
  for (const int ranks : {1, 2}) {
    for (const std::string &file :
         ranks == 1 ? std::vector{header, half, nearly, longer, damaged, other} : std::vector{half})
      refused("in.bed", {{"start", file}},
              std::string("variable start is '").append(file).append("'").append(cut), ranks);
    refused("in.place", given("bed {}, start x.restart", (scratch / "ball.restart").string()),
            ", made with bed roller; allowed: made with bed soil", ranks);
    refused("in.settle", given("balls {}, bed x.restart", some),
            "variable balls is '" + some + "'; allowed: a complete data file of balls in their box", ranks);
    refused("in.settle", given("balls {}, bed x.restart", none),
            "variable balls is '" + none + "'; allowed: a data file with a box, atoms and their types",
            ranks);
  }
  refused("in.bed", {{"start", (scratch / "soil.restart").string()}},
          ", made with bed soil; allowed: made with bed roller", 1);
  refused("in.bed", given("stepping second, start {}", (scratch / "ball.restart").string()),
          "variable stepping is 'second'; allowed: stock, with which ", 1);
  refused("in.settle", given("case sand, balls {}, bed x.restart", (scratch / "balls.data").string()),
          "variable case is '", 1);
}

// On two ranks one value, and the bed that is not at rest; the table of refusals has the commands' other
// rules there.
TEST_F(Bed, RefusesValuesThatAreNotTheBedsOnRanksOneAndTwo) {
  const Scratch folder;
  const auto refused = [&folder](const char *deck, const Variables &more, const std::string &says,
                                 int ranks = 1) {
    EXPECT_TRUE(fails_with(run(bed_folder() / deck, folder, more, ranks), "ERROR: " + says)) << says;
    EXPECT_FALSE(fs::exists(folder / "bed.csv"));
  };
  for (const auto &[name, value, was] :
       {std::array{"m2", "4000", "100"}, std::array{"k", "1e7", "1e8"}, std::array{"D", "0.1", "0.3"},
        std::array{"friction", "0.2", "0.5"}, std::array{"rolling", "0.1", "0"}, std::array{"g", "1", "9.81"},
        std::array{"walls", "0", "1"}, std::array{"r2", "0.2", "0.1"}, std::array{"k23", "1e6", "5e4"},
        std::array{"case", "gravel", "loose"}, std::array{"tangential", "history", "coulomb"},
        std::array{"dimension", "3", "2"}})
    for (const int ranks : {1, 2})
      if (ranks == 1 || name == std::string("k"))
        refused("in.bed", {{name, value}},
                std::string("drumlin/variable: variable ") + name + " is '" + value + "'; allowed: " + was +
                    ", with which ",
                ranks);
  refused("in.place", given("friction 0.2, bed {}, start x.restart", (scratch / "soil.restart").string()),
          "drumlin/variable: variable friction is '0.2'; allowed: 0.5, with which ");
  refused("in.bed", {{"boundary", "soft"}}, "drumlin/variable: variable boundary is 'soft'; allowed: ");
  for (const char *name : {"ground_depth", "ground_density", "ground_cp"})
    refused("in.bed", {{"boundary", "absorb"}, {name, "0"}},
            std::string("drumlin/variable: variable ") + name + " is '0'; allowed: ");
  refused("in.bed", given("boundary absorb, ground_cs 1e4"),
          "fix boundary/absorb: speed of shear waves is '10000 m/s'; allowed: at most");
  refused("in.bed", {{"allow_change", "m2"}},
          "drumlin/variables: variable allow_change is 'm2'; allowed: none, or ");
  // Variables that may be changed take effect, so that the bed is no longer in equilibrium.
  for (const int ranks : {1, 2})
    refused("in.bed", given("friction 0.2, allow_change friction"), "drumlin/settle: unbalanced ratio is '",
            ranks);
  well(shake(folder, given("friction 0.2, allow_change friction, balance 1e9")));
  const std::string parameters = read_text(folder / "parameters.csv");
  EXPECT_TRUE(contains(parameters, {"\nfriction,0.2\n", "\nallow_change,friction\n"}));
}

// A bed poured with little friction lies denser; in.place lets it come to rest with its own.
TEST_F(Bed, IsPouredWithContactsOfItsOwn) {
  const Scratch folder;
  well(run_deck(bed_folder() / "in.settle",
                given("balls {}, bed {}, case loose, ratio 1e-2, pour_friction 0",
                      (scratch / "balls.data").string(), (folder / "dense").string()),
                folder.path()));
  const Variables placing = with(roller(), given("bed {}, start {}, ratio 1e-2", (folder / "dense").string(),
                                                 (folder / "start").string()));
  well(run_deck(bed_folder() / "in.place", placing, folder.path()));
  well(shake(folder, given("start {}, cycles 1, friction 0.5, balance 1", (folder / "start").string())));
  const Scratch loose;
  well(shake(loose, {{"cycles", "1"}}));
  EXPECT_LT(post::read_table(folder / "bed.csv").numbers("void_ratio").front(),
            post::read_table(loose / "bed.csv").numbers("void_ratio").front() - 0.01);
}

TEST_F(Bed, DumpsIntoFoldersOfAnyName) { expect_dumps_into_folders_of_any_name("in.bed", {}); }

TEST_F(Bed, OnAFullDiskCutDumpsAreAnError) {
  expect_cut_dumps_are_an_error("LD_PRELOAD=$DRUMLIN_PRELOAD liggghts -in $DECKS/../bed/in.bed", "");
}

// Data files that the engine itself would read without end, or accept.
TEST_F(Bed, RefusesDataFilesThatTheEngineWouldNot) {
  const std::string good = read_text(scratch / "balls.data");
  const std::size_t row = good.find('\n', good.find("Atoms")) + 2;
  const std::string first = good.substr(row, good.find('\n', row) + 1 - row);
  const auto changed = [&](std::size_t word, const char *text) {
    std::istringstream words(first);
    std::string line, next;
    for (std::size_t n = 0; words >> next; ++n)
      line += (n == word ? text : next) + std::string(" ");
    return good.substr(0, row) + line + "\n" + good.substr(row + first.size());
  };
  const Scratch folder;
  for (const std::string &text :
       {changed(0, "9.2e18"), changed(0, "9223372036854775807"), changed(4, "1e308"), changed(5, "nan"),
        changed(2, "-1"), changed(0, "2"), changed(1, "4"), good.substr(0, row) + first + good.substr(row),
        good + good}) {
    std::ofstream(folder / "bad.data") << text;
    EXPECT_TRUE(fails_with(run_deck(bed_folder() / "in.settle",
                                    given("balls {}, bed x.restart", (folder / "bad.data").string()),
                                    folder.path(), 1, 20.0),
                           "ERROR: drumlin/check: variable balls is '"));
    EXPECT_FALSE(fs::exists(folder / "x.restart"));
  }
}

// Otherwise a script could mistake the old file for a result of the run that was stopped.
TEST_F(Bed, LeavesNoOldFileWhenASignalStopsTheRunThatReplacesIt) {
  const Scratch folder;
  const std::string file = (folder / "kept.restart").string();
  const auto stopped = [&](const char *deck, const Variables &variables) {
    fs::copy_file(scratch / "soil.restart", file, fs::copy_options::overwrite_existing);
    const Outcome outcome =
        run_deck(bed_folder() / deck, variables, folder.path(), 1, 60.0, after_processor_time(in_the_run));
    EXPECT_TRUE(outcome.timed_out) << deck;
    EXPECT_TRUE(fails_with(outcome, "ERROR: drumlin/run: stopped by a signal at step ")) << deck;
    EXPECT_FALSE(fs::exists(file)) << deck;
  };
  stopped("in.settle",
          given("case loose, fall 1000, balls {}, bed {}", (scratch / "balls.data").string(), file));
  const Variables placing =
      with(roller(), given("sink 1000, bed {}, start {}", (scratch / "soil.restart").string(), file));
  stopped("in.place", placing);
}

// A drum that is shot through the floor, and soil whose contacts are too soft for the floor to carry it:
// without any other check that would stop the run.
TEST_F(Bed, ALostBallIsAnErrorOnRanksOneAndTwo) {
  for (const int ranks : {1, 2}) {
    const Scratch folder;
    EXPECT_TRUE(fails_with(shake(folder, given("guard off, Fw 1e12"), ranks),
                           "ERROR: fix bond/spring: ball is '151', which was lost at step "));
    EXPECT_TRUE(fails_with(run(bed_folder() / "in.settle", folder,
                               given("guard off, pour_k 10, stepping stock, balls {}, bed {}",
                                     (scratch / "balls.data").string(), (folder / "x.restart").string()),
                               ranks),
                           "ERROR: Lost atoms"));
    EXPECT_FALSE(fs::exists(folder / "x.restart"));
  }
}

// The signal comes in the middle of one run command, during which the deck prints no progress; pouring takes
// half a second of processor time before.
TEST_F(Bed, EndsAtASignalWhileItSettles) {
  const Scratch folder;
  const Outcome settling = run_deck(bed_folder() / "in.settle",
                                    given("case loose, ratio 1e-29, balls {}, bed {}",
                                          (scratch / "balls.data").string(), (folder / "x.restart").string()),
                                    folder.path(), 1, 60.0, after_processor_time(2.0));
  EXPECT_TRUE(settling.timed_out);
  EXPECT_TRUE(fails_with(settling, "ERROR: drumlin/settle: stopped by a signal after "));
  EXPECT_FALSE(fs::exists(folder / "x.restart"));
}

TEST_F(Bed, EndsAtASignalAndContinues) { expect_ends_at_a_signal("in.bed", {}); }

// A restart file of any step has the whole state: what differs from an uninterrupted run is that the engine
// sets up the run again at this step.
TEST_F(Bed, ContinuesAfterASignalLikeARunDividedThere) {
  const Scratch folder;
  const std::string deck = read_text(bed_folder() / "in.bed");
  const std::size_t last = deck.rfind("\ndrumlin/run ");
  ASSERT_NE(last, std::string::npos);
  const auto shaken = [&](const std::string &out, const std::string &start, const std::string &commands,
                          const post::StopCondition &stop = {}) {
    post::write_files({{folder / "deck", commands.empty() ? deck : deck.substr(0, last + 1) + commands}});
    const Variables variables =
        with({{"here", bed_folder().string()},
              {"omega", "0.12566370614359174"}, // a period of 50 s, without end for a test
              {"steps_per_cycle", "2500000"},
              {"samples_per_cycle", "250000"},
              {"Fw", "2940"},
              {"start", start},
              {"out", out}},
             roller());
    return run_deck(folder / "deck", variables, folder.path(), 1, 60.0, stop);
  };
  const std::string placed = (scratch / "ball.restart").string(), says = "stopped by a signal at step ";
  const Outcome stopped = shaken("left", placed, "", after_processor_time(in_the_run));
  ASSERT_TRUE(stopped.says(says)) << stopped.output;
  const long step = std::stol(stopped.output.substr(stopped.output.find(says) + says.size()));
  const std::string rest = fmt::format("drumlin/run {}\n", step + 500);
  well(shaken("left", "left/stopped.restart", rest));
  well(shaken("stayed", placed, fmt::format("drumlin/run {}\n{}", step, rest)));
  for (const char *file : {"bed.csv", "events.csv", "cycles.csv"})
    EXPECT_EQ(read_text(folder / "left" / file), read_text(folder / "stayed" / file)) << file;
}

// Three balls side by side, and one that rolls off the top of the middle one so slowly under a strong drag
// that it needs 2 million steps; then one that falls from high above for as long.
TEST(BedAtRest, LeavesOutAFewRollingBallsIfAsked) {
  const Scratch folder;
  const auto write_balls = [&folder](double falls_from) {
    std::string balls = fmt::format(
        "balls\n\n{} atoms\n3 atom types\n\n-0.12 0.12 xlo xhi\n0 8 ylo yhi\n-0.04 0.04 zlo zhi\n\nAtoms\n\n",
        falls_from > 0.0 ? 5 : 4);
    for (int id = 1; id <= 3; ++id)
      balls += fmt::format("{} 1 0.08 2650 {} 0.04 0\n", id, 0.08 * (id - 2));
    balls +=
        fmt::format("4 1 0.08 2650 {:.17g} {:.17g} 0\n", 0.08 * std::sin(0.1), 0.04 + 0.08 * std::cos(0.1));
    if (falls_from > 0.0) balls += fmt::format("5 1 0.08 2650 -0.08 {} 0\n", falls_from);
    post::write_files({{folder / "balls", balls}});
  };
  for (const std::string deck : {"in.settle", "in.settle.lammps"}) {
    if (deck == "in.settle.lammps" && !post::has_lammps()) continue;
    const auto settle = [&](const Variables &more, int ranks = 1) {
      const Variables variables =
          with(more, given("balls balls, bed soil, fall 0, drag 1000, settle_limit 60000"));
      return run_deck(bed_folder() / deck, variables, folder.path(), ranks);
    };
    const Variables a_third = given("loose 0.34, loose_steps 5000");
    const auto expect_moving = [&](const Variables &more) {
      EXPECT_TRUE(fails_with(settle(more), "ERROR: drumlin/settle: unbalanced ratio is '"));
      EXPECT_FALSE(fs::exists(folder / "soil"));
    };
    write_balls(0.0);
    expect_moving({});                                    // by default none may move
    expect_moving(given("loose 0.24, loose_steps 5000")); // 1 of 4 balls is more
    for (const int ranks : {1, 2}) {
      EXPECT_TRUE(printed(well(settle(a_third, ranks)),
                          ", 1 of 4 balls still not at rest, all others for 5000 steps"));
      EXPECT_TRUE(fs::exists(folder / "soil"));
      fs::remove(folder / "soil");
    }
    write_balls(7.0);
    expect_moving(given("loose 0.9, loose_steps 5000"));
  }
}

// The error comes before the bed has settled, not after.
TEST_F(Bed, RefusesNamesThatCannotBeWrittenAtTheBeginning) {
  const Scratch folder;
  for (const std::string &file :
       {std::string("nowhere/x.restart"), folder.path().string(), std::string("x.*")}) {
    const std::string allowed = "is '" + file + "'; allowed: a file in a folder that exists, without * and %";
    const Outcome settled = run(bed_folder() / "in.settle", folder,
                                given("balls {}, bed {}", (scratch / "balls.data").string(), file));
    EXPECT_TRUE(printed(settled, "ERROR: drumlin/variable: variable bed " + allowed));
    const Outcome placed = run(bed_folder() / "in.place", folder,
                               given("bed {}, start {}", (scratch / "soil.restart").string(), file));
    EXPECT_TRUE(printed(placed, "ERROR: drumlin/variable: variable start " + allowed));
    const Outcome tiled = run(bed_folder() / "in.tile", folder,
                              given("cell {}, bed {}", (scratch / "balls.data").string(), file));
    EXPECT_TRUE(printed(tiled, "ERROR: drumlin/variable: variable bed " + allowed));
    for (const Outcome &outcome : {settled, placed, tiled}) {
      EXPECT_EQ(outcome.status, 1);
      EXPECT_FALSE(outcome.says("Loop time")) << outcome.output;
    }
  }
}

TEST_F(Bed, NeedsSpaceForTheRoller) {
  for (const auto &[name, value, says] :
       {std::array{"r2", "0.5",
                   "variable r2 is '0.5'; allowed: a finite number below 0.3, half the width of the box"},
        std::array{"r3", "2", "variable r3 is '2'; allowed: a finite number below "}}) {
    const Scratch folder;
    const Variables variables = with(with({{name, value}}, roller()),
                                     given("bed {}, start x.restart", (scratch / "soil.restart").string()));
    EXPECT_TRUE(fails_with(run_deck(bed_folder() / "in.place", variables, folder.path()), says)) << name;
    EXPECT_FALSE(fs::exists(folder / "x.restart"));
  }
}

/// The same beds in LAMMPS.
class BedInLammps : public Bed {
protected:
  void SetUp() override { SKIP_WITHOUT_LAMMPS(true); }
  static Outcome shake(const Scratch &folder, const Variables &more, int ranks = 1) {
    return run(bed_folder() / "in.bed.lammps", folder, more, ranks);
  }
};

// From the same data file, with a contact history that starts at zero in both engines: the difference is
// rounding. Over 500 steps it stays small; later the bed makes it grow.
TEST_F(BedInLammps, GoesAsInLiggghtsOnSeveralRanksWithNewtonOffAndOn) {
  // What ranks tell each other does not depend on the transition: without `split`, one division only, and by
  // day the drum of one ball. With it each number of ranks and each word for newton is tried under both
  // schemes, with one of the two drums.
  struct Law {
    Variables variables;
    bool split;
  };
  const std::vector<Law> laws = {{{}, true},
                                 {{{"stepping", "second"}}, true},
                                 {given("stepping second, transition A"), false},
                                 {given("transition A, friction 0, allow_change friction"), false}};
  using Divisions = std::vector<std::pair<int, const char *>>; // ranks and newton
  for (const char *drum : drums)
    for (const Law &law : laws) {
      if (most_ranks() == 2 && !law.split && drum != drums.front()) continue;
      const Divisions divisions = !law.split ? Divisions{{2, "on"}}
                                  : std::string(drum) == "clump"
                                      ? Divisions{{1, "on"}, {2, "off"}, {4, "on"}}
                                      : Divisions{{1, "off"}, {2, "on"}, {4, "off"}};
      Variables variables = law.variables;
      // A cycle of 100 Hz in steps as long as those of the 2500 in a cycle of 20 Hz.
      variables =
          with(variables,
               given("drum {}, cycles 1, omega 628.3185307179587, steps_per_cycle 500, samples_per_cycle 50",
                     drum));
      const Scratch here;
      const std::string fresh = (here / "fresh.restart").string();
      const Variables from_data = with(variables, {{"fresh", fresh}});
      well(run(test_deck("bed_from_data.in"), here, from_data));
      const Variables in_liggghts = with(variables, given("start {}, balance 1e30", fresh));
      well(Bed::shake(here, in_liggghts));
      const post::Table expected = post::read_table(here / "bed.csv");
      for (const auto &[ranks, newton] : divisions) {
        if (ranks > most_ranks()) continue;
        const Scratch there;
        const Variables in_lammps = with(variables, given("newton {}, rest 0, balance 1e30", newton));
        well(shake(there, in_lammps, ranks));
        const post::Table found = post::read_table(there / "bed.csv");
        ASSERT_EQ(found.rows(), expected.rows());
        ASSERT_EQ(found.header(), expected.header());
        for (const std::string &column : expected.header()) {
          const std::vector<double> a = expected.numbers(column), b = found.numbers(column);
          double largest = 1e-12; // smaller values are rounding
          for (const double value : a)
            largest = std::max(largest, std::fabs(value));
          for (std::size_t n = 0; n < a.size(); ++n)
            EXPECT_NEAR(a[n], b[n], 1e-9 * largest)
                << column << ", row " << n << ", ranks " << ranks << ", newton " << newton << ", " << drum;
        }
        const std::vector<double> x = expected.numbers("x_drum"), y = found.numbers("x_drum");
        ASSERT_EQ(x.size(), 51u); // 500 steps
        for (std::size_t n = 0; n < x.size(); ++n)
          EXPECT_NEAR(x[n], y[n], 1e-9); // m
        EXPECT_LT(*std::min_element(x.begin(), x.end()), -5e-5);
      }
    }
}

// The balls of ./drumlin bed become discs, and walls and floor carry their weight and that of the roller.
TEST_F(BedInLammps, SettlesAndCarriesTheRollerAtRest) {
  const Scratch folder;
  const Variables at_rest = {{"ratio", "1e-2"}};
  const Variables settling =
      with(at_rest, given("balls {}, bed soil.restart, case loose", (scratch / "balls.data").string()));
  well(run_deck(bed_folder() / "in.settle.lammps", settling, folder.path()));
  const Variables placing =
      with(with(roller(), given("bed soil.restart, start ball.restart, sink 0.1")), at_rest);
  EXPECT_TRUE(printed(well(run_deck(bed_folder() / "in.place.lammps", placing, folder.path())),
                      "The drum at rest: its lowest point is "));
  well(shake(
      folder,
      given("start ball.restart, Fw 0, cycles 1, omega 3141.6, steps_per_cycle 100, samples_per_cycle 10")));
  const post::Table rows = post::read_table(folder / "bed.csv");
  EXPECT_NEAR(rows.numbers("F_contact").front(), roller_mass * gravity, 1e-3 * roller_mass * gravity);
  const double weight = (roller_mass + soil_mass()) * gravity;
  EXPECT_NEAR(rows.numbers("F_floor").front() + rows.numbers("F_sides").front(), weight, 1e-3 * weight);
}

TEST_F(BedInLammps, GoesAsInLiggghtsWithRollingFriction) {
  for (const auto &[scheme, boundary] : {std::pair{"stock", "rigid"}, {"second", "absorb"}}) {
    const fs::path bed = settled(scheme, "0.1");
    const Scratch here, there;
    const std::string start = (bed / "ball.restart").string(), fresh = (here / "fresh.restart").string();
    well(run(test_deck("bed_from_data.in"), here,
             given("start {}, fresh {}, stepping {}", start, fresh, scheme)));
    Variables variables =
        given("start {}, stepping {}, boundary {}, cycles 1, balance 1e30", fresh, scheme, boundary);
    well(Bed::shake(here, variables));
    variables.front().second = start;
    variables.emplace_back("rest", "0");
    well(shake(there, variables, 2));
    EXPECT_LT(imbalance(there / "bed.csv"), 0.01);
    const post::Table expected = post::read_table(here / "bed.csv"),
                      found = post::read_table(there / "bed.csv");
    for (const char *column : {"x_drum", "kinetic", "dissipated"}) {
      const std::vector<double> a = expected.numbers(column), b = found.numbers(column);
      for (std::size_t n = 0; n <= 50; ++n) // 500 steps
        EXPECT_NEAR(a[n], b[n], 1e-9 * std::max(1.0, std::fabs(a[n])))
            << column << ", row " << n << ", " << scheme << ", " << boundary;
    }
  }
}

// Longer than other tests: it compares balls and contacts of every dump, column by column.
TEST_F(BedInLammps, DumpsWhatLiggghtsDumpsOnRanksOneAndTwo) {
  for (const char *stepping : steppings) {
    const Variables often = {{"cycles", "1"},
                             {"omega", "628.3185307179587"}, // 100 Hz in steps of the usual length
                             {"steps_per_cycle", "500"},
                             {"samples_per_cycle", "50"},
                             {"dumps_per_cycle", "5"},
                             {"stepping", stepping}};
    const Scratch here;
    well(run(test_deck("bed_from_data.in"), here,
             given("fresh {}, stepping {}", (here / "fresh.restart").string(), stepping)));
    const Variables in_liggghts =
        with(often, given("start {}, balance 1e30", (here / "fresh.restart").string()));
    well(Bed::shake(here, in_liggghts));
    const std::map<long, post::StepDump> expected = post::dumped_steps(here / "dump");
    ASSERT_EQ(expected.size(), 6u);
    for (const auto &[ranks, newton] : {std::pair{1, "off"}, {2, "off"}, {2, "on"}}) {
      const Scratch there;
      fs::create_directory(there / "dump");
      std::ofstream(there / "dump/balls_7.dump") << "old";
      const Variables in_lammps = with(often, given("newton {}, rest 0, balance 1e30", newton));
      well(shake(there, in_lammps, ranks));
      const std::map<long, post::StepDump> found = post::dumped_steps(there / "dump");
      ASSERT_EQ(found.size(), 6u);
      for (const auto &[step, files] : expected) {
        const std::string where = "step " + std::to_string(step) + ", ranks " + std::to_string(ranks);
        const std::vector<post::Ball> a = post::read_ball_dump(files.balls),
                                      b = post::read_ball_dump(found.at(step).balls);
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t n = 0; n < a.size(); ++n) {
          EXPECT_EQ(a[n].id, b[n].id);
          EXPECT_EQ(a[n].type, b[n].type);
          EXPECT_NEAR(a[n].radius, b[n].radius, 1e-12);
          EXPECT_NEAR(a[n].mass, b[n].mass, 1e-9 * a[n].mass);
          for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(a[n].position[axis], b[n].position[axis], 1e-7) << where; // a float there
            EXPECT_NEAR(a[n].velocity[axis], b[n].velocity[axis], 1e-9) << where;
            EXPECT_NEAR(a[n].force[axis], b[n].force[axis], 1e-4) << where; // N
          }
        }
        const post::BedContacts all_c = post::read_contact_dump(files.contacts, a),
                                all_d = post::read_contact_dump(found.at(step).contacts, b);
        const std::vector<post::BallContact> &c = all_c.balls, &d = all_d.balls;
        ASSERT_EQ(c.size(), d.size()) << where;
        ASSERT_GT(c.size(), 150u);
        ASSERT_EQ(all_c.walls.size(), all_d.walls.size()) << where;
        ASSERT_GT(all_c.walls.size(), 15u);
        double largest = 0.0;
        for (const post::BallContact &contact : c)
          for (const double component : contact.force)
            largest = std::max(largest, std::fabs(component));
        for (std::size_t n = 0; n < c.size(); ++n) {
          EXPECT_EQ(c[n].i, d[n].i);
          EXPECT_EQ(c[n].j, d[n].j);
          EXPECT_NEAR(c[n].overlap, d[n].overlap, 1e-12);
          for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(c[n].force[axis], d[n].force[axis], 1e-6 * largest) << where;
        }
        for (std::size_t n = 0; n < all_c.walls.size(); ++n) {
          EXPECT_EQ(all_c.walls[n].i, all_d.walls[n].i);
          EXPECT_NEAR(all_c.walls[n].overlap, all_d.walls[n].overlap, 1e-12);
          for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(all_c.walls[n].normal[axis], all_d.walls[n].normal[axis], 1e-12);
            EXPECT_NEAR(all_c.walls[n].force[axis], all_d.walls[n].force[axis], 1e-6 * largest) << where;
          }
        }
      }
      well(run_program({DRUMLIN_TOOLS, "vtk", there.path().string()}, {}, there.path()));
      for (const char *file : {"balls.pvd", "contacts.pvd", "fields.pvd", "contacts_500.vtp"})
        EXPECT_TRUE(fs::exists(there / "vtk" / file)) << file;
    }
  }
}

TEST_F(BedInLammps, ContinuesWhereALimitOfTimeStoppedItOnRanksOneAndTwo) {
  expect_goes_on("in.bed.lammps", "stock", "rigid");
  expect_goes_on("in.bed.lammps", "second", "absorb");
}

TEST_F(BedInLammps, RefusesWhatItDoesNotHaveOnRanksOneAndTwo) {
  const Scratch files;
  fs::copy_file(scratch / "ball.restart", files / "alone.restart");
  const auto refused = [](const Variables &variables, const std::string &says, int ranks) {
    const Scratch folder;
    EXPECT_TRUE(fails_with(shake(folder, variables, ranks), says)) << says;
    EXPECT_FALSE(fs::exists(folder / "bed.csv"));
  };
  for (const int ranks : {1, 2})
    refused({{"start", (scratch / "balls.data").string()}},
            ", which is incomplete, damaged or no restart file; allowed: a restart file of "
            "drumlin/write or drumlin/run, or a data file NAME.data in the same folder",
            ranks);
  refused({{"start", "nowhere"}}, "variable start is 'nowhere'; allowed: a file that can be read", 1);
  refused({{"start", (files / "alone.restart").string()}},
          ", made with engine LIGGGHTS; allowed: made with engine LAMMPS", 1);
  refused({{"newton", "maybe"}}, "variable newton is 'maybe'; allowed: on or off", 1);
  refused({{"rest", "2"}}, "variable rest is '2'; allowed: 0 or 1", 1);
}

TEST_F(BedInLammps, DumpsIntoFoldersOfAnyName) {
  expect_dumps_into_folders_of_any_name("in.bed.lammps", given("rest 0, balance 1e30"));
}

TEST_F(BedInLammps, OnAFullDiskCutDumpsAreAnError) {
  expect_cut_dumps_are_an_error("'" LAMMPS_PROGRAM "' -in $DECKS/../bed/in.bed.lammps",
                                " -var plugin '" DRUMLIN_LAMMPS_PLUGIN "' -var rest 0 -var balance 1e30");
}

TEST_F(BedInLammps, EndsAtASignalAndContinues) {
  expect_ends_at_a_signal("in.bed.lammps", given("rest 0, balance 1e30"));
}

// Three dimensions: spheres, a cylinder of soil-sized balls on a cell that was copied, periodic all around.
// Longer than other tests: making the cell and placing the cylinder are part of what is tested.
/// The file of a roller of twice the masses and forces of `roller`, which is given per metre, and 2 m wide.
fs::path roller_file(const Scratch &folder, const Variables &roller, double Fw, double frequency) {
  const auto value = [&roller](const char *name) {
    for (const auto &[other, text] : roller)
      if (other == name) return std::stod(text);
    throw std::invalid_argument(name);
  };
  fs::path file = folder / "my_roller";
  std::ofstream(file) << fmt::format("drum_mass {} kg\nframe_mass {} kg\nwidth 2 m\ndiameter {} m\n"
                                     "bond_stiffness {} N/m\nbond_damping {} N s/m\n"
                                     "frequency {} Hz\nforce {} N\n",
                                     2 * value("m2"), 2 * value("m3"), 2 * value("r2"), 2 * value("k23"),
                                     2 * value("c23"), frequency, 2 * Fw);
  return file;
}

// All values of the file are divided by the width of the drum: the run is that with the values per metre.
TEST_F(Bed, TakesARollerFromItsFileOnRanksOneAndTwo) {
  const Scratch folder;
  const std::string file = roller_file(folder, roller(), 2940.0, 50.0).string();
  const std::string start = (folder / "drum.restart").string();
  const Variables soil = given("bed {}, start {}", (scratch / "soil.restart").string(), start);
  well(run_deck(bed_folder() / "in.place", with(given("roller {}, r3 0.05", file), soil), folder.path()));
  const auto shaken = [&](const char *deck, const Variables &more, int ranks) {
    const Variables variables = with(more, given("start {}, cycles 1, samples_per_cycle 100", start));
    const Outcome outcome = run_deck(bed_folder() / deck, variables, folder.path(), ranks);
    EXPECT_TRUE(outcome.ok()) << outcome.output;
    return read_text(folder / "bed.csv");
  };
  // Who reads the file and tells the other ranks is the same in both engines.
  for (const auto &[deck, ranks] : {std::pair{"in.bed", 1}, {"in.bed.lammps", 2}}) {
    const bool lammps = ranks == 2;
    if (lammps && !post::has_lammps()) continue;
    const Variables without_rest = lammps ? given("rest 0, balance 1e30") : Variables{};
    const std::string from_file = shaken(deck, without_rest, ranks);
    const std::map<std::string, std::string> noted = post::read_parameters(folder / "parameters.csv");
    const Variables by_value =
        with(without_rest, given("omega {}, Fw {}", noted.at("omega"), noted.at("Fw")));
    EXPECT_EQ(shaken(deck, by_value, ranks), from_file) << deck;
    EXPECT_NEAR(std::stod(noted.at("omega")), 314.1592653589793, 1e-9);
    EXPECT_NEAR(std::stod(noted.at("m2")), 100.0, 1e-9);
    EXPECT_NEAR(std::stod(noted.at("Fw")), 2940.0, 1e-9);
    EXPECT_NEAR(std::stod(noted.at("roller_exciter_force_per_metre")), 2940.0, 1e-4);
    EXPECT_EQ(noted.at("steps_per_cycle"), "1000"); // 2500 at 20 Hz
  }
  // A value that differs from that of the file counts, and must be the bed's.
  EXPECT_TRUE(fails_with(run_deck(bed_folder() / "in.bed", given("start {}, m2 200", start), folder.path()),
                         "drumlin/variable: variable m2 is '200'; allowed: 100"));
  EXPECT_TRUE(
      fails_with(run_deck(bed_folder() / "in.bed", given("start {}, setting high", start), folder.path()),
                 "drumlin/roller: setting is 'high'; allowed: none, of "));
  EXPECT_TRUE(
      fails_with(run_deck(bed_folder() / "in.bed", given("start {}, roller other", start), folder.path()),
                 "drumlin/roller: roller is 'other'; allowed: a file that can be read"));
  std::ofstream(file, std::ios::app) << "operating_mass 10 kg\n";
  EXPECT_TRUE(fails_with(run_deck(bed_folder() / "in.bed", {{"start", start}}, folder.path()),
                         "drumlin/roller: operating_mass of '" + file + "' is '10 kg'; allowed: at least "));
}

TEST_F(Bed, SaysWhenTheDrumTouchesFewBalls) {
  const Scratch folder;
  const auto placed = [&](const char *r2) {
    return run_deck(bed_folder() / "in.place",
                    with({{"r2", r2}}, with(roller(), given("bed {}, start x.restart",
                                                            (scratch / "soil.restart").string()))),
                    folder.path());
  };
  // A round drum stands on two balls, or on one.
  EXPECT_TRUE(printed(placed("0.1"), "WARNING: with fewer than 5 balls below the drum"));
}

TEST(Bed3d, CarriesACylinderOnCopiesOfACellOnRanksOneAndTwo) {
  const Scratch scratch;
  const Variables per_metre = given("m2 1000, m3 500, r2 0.1, k23 5e5, c23 5e3");
  const std::string roller = roller_file(scratch, per_metre, 29400.0, 20.0).string();
  const auto file = [&scratch](const char *name) { return (scratch / name).string(); };
  const auto run = [&](const Scratch &folder, const char *deck, Variables variables, int ranks = 1) {
    variables = with(variables, given("case loose3d, walls 0"));
    const std::string name = deck;
    if (name == "in.settle") variables.emplace_back("roller", roller); // and from there to the others
    if (name == "in.tile") variables.emplace_back("cell", file("cell.data"));
    if (name.rfind("in.bed", 0) != 0) {
      variables.emplace_back("bed", file("soil.restart"));
      if (name != "in.tile") variables.emplace_back("ratio", "0.01");
    } else
      variables.emplace_back("cycles", "1");
    if (name == "in.place" || name.rfind("in.bed", 0) == 0)
      variables.emplace_back("start", file("roller.restart"));
    return run_deck(bed_folder() / deck, variables, folder.path(), ranks);
  };
  well(run_program(tool_words("bed --balls 100 --width 0.15 --depth 0.1 --out balls.data"), {},
                   scratch.path()));
  well(run(scratch, "in.settle", given("balls {}, bed {}", file("balls.data"), file("cell"))));
  EXPECT_TRUE(fails_with(run(scratch, "in.tile", {{"copies_x", "3"}}, 2),
                         "/cell.data' on 2 ranks; allowed: one rank"));
  well(run(scratch, "in.tile", {{"copies_x", "3"}}));
  well(run(scratch, "in.place", {}));

  std::vector<std::vector<double>> heights;
  for (const int ranks : {1, 2}) {
    const Scratch folder;
    well(run(folder, "in.bed3d", {}, ranks));
    const post::Table table = post::read_table(folder / "bed.csv");
    heights.push_back(table.numbers("x_drum"));
    EXPECT_LT(imbalance(folder / "bed.csv"), 0.01);
    // The mean of r^3 over 16 to 24 mm is 8.32e-6 m3; the roller is as wide as the box is deep.
    const double soil = 300.0 * 4.0 / 3.0 * pi * 8.32e-6 * 2650.0;
    EXPECT_NEAR(table.numbers("F_floor").front(), (soil + 150.0) * gravity, 0.02 * (soil + 150.0) * gravity);
    EXPECT_EQ(table.numbers("F_sides").front(), 0.0);
    EXPECT_NEAR(table.numbers("F_contact").front(), 150.0 * gravity, 1e-2 * 150.0 * gravity);
    EXPECT_GT(table.numbers("coordination").front(), 3.0);
    EXPECT_LT(table.numbers("coordination").front(), 6.5);
    EXPECT_GT(table.numbers("void_ratio").front(), 0.5);
    EXPECT_LT(table.numbers("void_ratio").front(),
              1.6); // the floor has layers, and the drum may be in the window
  }
  ASSERT_EQ(heights[0].size(), heights[1].size());
  for (std::size_t i = 0; i <= 100; ++i) // 1000 steps
    EXPECT_NEAR(heights[0][i], heights[1][i], 1e-10) << "row " << i;

  if (!post::has_lammps()) return;
  std::vector<std::vector<double>> in_lammps;
  for (const auto &[ranks, newton] : {std::pair{1, "off"}, {2, "on"}, {2, "off"}, {1, "on"}}) {
    if (most_ranks() == 2 && in_lammps.size() == 2) break; // by night
    const Scratch folder;
    well(run(folder, "in.bed.lammps", given("steps_per_cycle 4000, newton {}, rest 0, balance 1e30", newton),
             ranks));
    in_lammps.push_back(post::read_table(folder / "bed.csv").numbers("x_drum"));
    EXPECT_LT(imbalance(folder / "bed.csv"), 0.01);
  }
  ASSERT_EQ(in_lammps[0].size(), heights[0].size());
  for (std::size_t i = 0; i <= 100; ++i) {
    for (std::size_t other = 1; other < in_lammps.size(); ++other)
      EXPECT_NEAR(in_lammps[0][i], in_lammps[other][i], 1e-10) << "row " << i << ", run " << other;
    EXPECT_NEAR(in_lammps[0][i], heights[0][i], 2e-3)
        << "row " << i; // m; in LAMMPS the contact history starts at zero
  }
}

/// Largest relative difference between drum and frame on frozen soil balls and the chain with the summed
/// stiffness and damping.
double farthest_from_chain(const Variables &row, double stiffness_share, int ranks = 1) {
  double worst = 0.0;
  for (const auto &[transition, stepping] : {std::pair{"A", "second"}, {"B", "second"}, {"B", "stock"}}) {
    const Scratch bed, chain;
    const Variables variables = with(row, given("here {}, D 0.5, transition {}, stepping {}",
                                                bed_folder().string(), transition, stepping));
    well(run_deck(test_deck("frozen_row.in"), variables, bed.path(), ranks));
    well(run_deck(chain_deck("in.chain"),
                  {{"k", number(1e8 * stiffness_share)},
                   {"D", number(0.5 * std::sqrt(stiffness_share))}, // c sums up as k does
                   {"cycles", "10"},
                   {"transition", transition},
                   {"stepping", stepping}},
                  chain.path()));
    const post::ChainHistory one = post::read_chain(bed / "chain.csv"),
                             other = post::read_chain(chain / "chain.csv");
    worst = std::max({worst, relative_difference(one.v_drum, other.v_drum),
                      relative_difference(one.x_frame, other.x_frame),
                      relative_difference(one.F_contact, other.F_contact)});
  }
  return worst;
}

TEST(FrozenRow, OfOneBallIsTheChain) { EXPECT_LT(farthest_from_chain({}, 1.0), 1e-8); }

// The contacts turn with the drum by overlap over distance, some 1e-3.
TEST(FrozenRow, OfThreeBallsIsTheChainWithTheSums) {
  EXPECT_LT(farthest_from_chain({{"theta", "20"}}, 1.0 + 2.0 * std::pow(std::cos(20.0 * pi / 180.0), 2)),
            0.02);
}

// A body on three feet: its mass, not that of its balls, sets damping and motion. Each contact solves for its
// own dashpot only, which is second order, too.
TEST(FrozenRow, UnderAClumpIsTheChainWithTheSumsOnRanksOneAndTwo) {
  EXPECT_LT(farthest_from_chain({{"feet", "3"}}, 3.0), 2e-3);
  EXPECT_LT(farthest_from_chain({{"feet", "3"}}, 3.0, 2), 2e-3);
}

} // namespace
} // namespace drumlin::test
