// in.drive on a small bed, in two dimensions and with a clump that rolls in three: the roller comes to where
// its way says, its work balances, and the run is the same on any number of ranks, in pieces and in both
// engines.
#include "tests/support/engine_runs.h"
#include "bed/dump_readers.h"
#include "engine/engine_command.h"
#include "support/process.h"

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

fs::path bed_folder() { return fs::path(DRUMLIN_SOURCE_DIR) / "inputs/bed"; }

/// A small bed with a roller of 100 and 50 kg per metre and 0.1 m at its left, settled once for all tests.
template <class Bed>
class Driven : public ::testing::Test {
protected:
  const WaitForRanks at_once{0};

  static void SetUpTestSuite() {
    well(run_program(Bed::balls(), {}, scratch().path()));
    well(run_deck(bed_folder() / "in.settle", given("case {}, balls balls.data, bed soil.restart", Bed::soil),
                  scratch().path()));
    place("roller.restart", {});
  }
  static void TearDownTestSuite() { scratch(nullptr); }

  /// Puts the roller on the bed.
  static void place(const char *file, const Variables &more, const fs::path &decks = bed_folder()) {
    well(run_deck(
        decks / "in.place",
        with(more,
             given("bed soil.restart, start {}, place {}, m2 100, m3 50, r2 0.1, r3 0.05, k23 5e4, c23 500",
                   file, Bed::place)),
        scratch().path()));
  }

  /// Two passes of 0.2 m at 2 m/s, 50 Hz in steps as long as those of the decks.
  static Outcome drive(const Scratch &folder, const Variables &more, int ranks = 1,
                       const char *deck = "in.drive") {
    return run_deck(bed_folder() / deck, scene(folder, more), folder.path(), ranks);
  }
  static Variables scene(const Scratch &folder, const Variables &more) {
    return with(more, given("speed 2, ramp 0.05, length 0.2, margin 0.05, omega 314.1592653589793, Fw 2940, "
                            "steps_per_cycle 1000, samples_per_cycle 100, out {}, start {}",
                            folder.path().string(), (scratch().path() / "roller.restart").string()));
  }

  static Scratch &scratch() {
    if (!*held()) *held() = std::make_unique<Scratch>();
    return **held();
  }
  static void scratch(std::nullptr_t) { held()->reset(); }

private:
  static std::unique_ptr<Scratch> *held() {
    static std::unique_ptr<Scratch> one;
    return &one;
  }
};

/// 250 discs in a box of 1 m.
struct Discs {
  static std::vector<std::string> balls() { return tool_words("bed --balls 250 --width 1 --out balls.data"); }
  static constexpr const char *soil = "loose", *place = "-0.2";
};
class BedDriven : public Driven<Discs> {};

/// 350 spheres in a box of 0.6 m by 0.1 m; the drum is a clump.
struct Spheres {
  static std::vector<std::string> balls() {
    return tool_words("bed --balls 350 --width 0.6 --depth 0.1 --out balls.data");
  }
  static constexpr const char *soil = "loose3d", *place = "-0.1";
};
class BedDrivenByAClump : public Driven<Spheres> {};

/// The balls of the drum, by their IDs.
std::map<long, post::Ball> drum_in(const fs::path &dump) {
  std::map<long, post::Ball> drum;
  for (const post::Ball &ball : post::read_ball_dump(dump))
    if (ball.type == post::drum_type) drum[ball.id] = ball;
  return drum;
}

double place_of_drum(const fs::path &dump) {
  double place = 0.0;
  const std::map<long, post::Ball> drum = drum_in(dump);
  for (const auto &[id, ball] : drum)
    place += ball.position[0] / static_cast<double>(drum.size());
  return place;
}

/// What the bed of a run stores and loses beyond the works of exciter, traction and torque, over them.
double unbalanced(const post::Table &rows) {
  const auto change = [&rows](const char *column) {
    const std::vector<double> values = rows.numbers(column);
    return values.back() - values.front();
  };
  double given = 0.0, kept = 0.0;
  for (const char *work : {"work_excitation", "work_traction", "work_torque"})
    given += change(work);
  for (const char *energy : {"kinetic", "potential", "elastic", "dissipated"})
    kept += change(energy);
  EXPECT_GT(std::fabs(change("work_traction")), 0.01 * given);
  return (kept - given) / given;
}

/// Columns of two runs over their first rows, within a part of their largest value.
void expect_same(const post::Table &a, const post::Table &b, std::size_t rows, double part,
                 const std::string &what) {
  ASSERT_EQ(a.header(), b.header());
  for (const std::string &column : a.header()) {
    const std::vector<double> one = a.numbers(column), other = b.numbers(column);
    ASSERT_GE(std::min(one.size(), other.size()), rows) << what;
    double largest = 1e-12; // smaller values are rounding
    for (std::size_t n = 0; n < rows; ++n)
      largest = std::max(largest, std::fabs(one[n]));
    for (std::size_t n = 0; n < rows; ++n)
      EXPECT_NEAR(one[n], other[n], part * largest) << column << ", row " << n << ", " << what;
  }
}

// The dumps behind the passes have the drum at the ends of its way; the works of exciter, traction and torque
// are what the bed stores and loses.
TEST_F(BedDriven, ComesToTheEndsOfItsWayAndItsWorkBalances) {
  const std::array<std::pair<const char *, const char *>, 3> scenes = {
      {{"towed", "rigid"}, {"none", "rigid"}, {"driven", "absorb"}}};
  for (const auto &[rotation, boundary] : scenes) {
    const Scratch folder;
    std::ofstream(folder / "passes.csv") << "of an earlier run\n";
    well(drive(folder, given("drum_rotation {}, boundary {}, steps_per_cycle 2000", rotation, boundary)));
    EXPECT_FALSE(fs::exists(folder / "passes.csv"));
    const std::map<long, post::StepDump> dumps = post::dumped_steps(folder / "dump");
    ASSERT_EQ(dumps.size(), 3U);
    std::vector<double> places;
    places.reserve(dumps.size());
    for (const auto &[step, files] : dumps)
      places.push_back(place_of_drum(files.balls));
    EXPECT_NEAR(places[0], -0.2, 1e-8);
    EXPECT_NEAR(places[1], 0.0, 1e-8);
    EXPECT_NEAR(places[2], -0.2, 1e-8);
    const post::Table rows = post::read_table(folder / "bed.csv");
    EXPECT_LT(std::fabs(unbalanced(rows)), 1e-3) << rotation << " " << boundary;
    const std::vector<double> s = rows.numbers("s"), pass = rows.numbers("pass");
    EXPECT_EQ(pass.front(), 1.0);
    EXPECT_EQ(pass.back(), 2.0);
    EXPECT_NEAR(*std::max_element(s.begin(), s.end()), 0.0, 1e-12);
    // The exciter is off while the roller stands.
    EXPECT_EQ(rows.numbers("F_excitation").back(), 0.0);
  }
}

TEST_F(BedDriven, ContinuesWhereALimitOfTimeStoppedItOnRanksOneAndTwo) {
  for (const int ranks : {1, 2}) {
    const Scratch stayed, left;
    well(drive(stayed, {}, ranks));
    well(drive(left, {{"time_limit", "1e-3"}}, ranks));
    EXPECT_EQ(post::read_table(left / "bed.csv").rows(), 101U); // a cycle
    well(drive(left, {{"start", (left / "stopped.restart").string()}}, ranks));
    for (const char *file : {"bed.csv", "cycles.csv", "events.csv"})
      EXPECT_EQ(read_text(left / file), read_text(stayed / file)) << file << ", ranks " << ranks;
  }
}

// Ctrl-C in the third pass or later: ./drumlin passes shows those before.
TEST_F(BedDriven, KeepsTheFinishedPassesWhenCtrlCStopsItInOne) {
  const Scratch folder;
  std::vector<std::string> words = {"-log", "none"};
  for (const auto &[name, value] : scene(folder, given("length 0.4, passes 40")))
    words.insert(words.end(), {"-var", name, value});
  const post::EngineCommand command = post::engine_command(bed_folder() / "in.drive", words, 1);
  post::Program program;
  program.words = command.words;
  program.environment = command.environment;
  program.folder = folder.path();
  program.output = folder / post::program_output_file;
  program.limit = 200.0;
  program.stop_signal = SIGINT;
  program.stop_when = [&](pid_t) { return post::dumped_steps(folder / "dump").size() >= 3U; };
  const Outcome stopped = post::run_program(program);
  EXPECT_TRUE(fails_with(stopped, "ERROR: drumlin/run: stopped by a signal at step "));
  const Outcome outcome =
      run_program(tool_words("passes {} --cell 0.16", folder.path().string()), {}, folder.path());
  well(outcome);
  const std::size_t kept = post::read_table(folder / "passes.csv").rows() - 1U;
  EXPECT_GE(kept, 2U);
  EXPECT_LT(kept, 40U);
  EXPECT_TRUE(printed(outcome, "Pass " + std::to_string(kept + 1) +
                                   " is not finished and is left out: the run was stopped in it"));
}

TEST_F(BedDriven, GoesTheSameWayOnSeveralRanks) {
  const Scratch one;
  well(drive(one, {{"time_limit", "1e-3"}})); // a cycle, 1000 steps
  const post::Table alone = post::read_table(one / "bed.csv");
  for (int ranks = 2; ranks <= most_ranks(); ranks *= 2) {
    const Scratch folder;
    well(drive(folder, {{"time_limit", "1e-3"}}, ranks));
    const post::Table together = post::read_table(folder / "bed.csv");
    for (const char *column : {"x_drum", "s"}) {
      const std::vector<double> a = alone.numbers(column), b = together.numbers(column);
      ASSERT_EQ(a.size(), 101U);
      ASSERT_EQ(b.size(), 101U);
      for (std::size_t n = 0; n <= 100; ++n)
        EXPECT_NEAR(a[n], b[n], 1e-10) << column << ", row " << n << ", ranks " << ranks;
    }
  }
}

// From the data file bed and roller first come to rest again, so that only the way is the same.
TEST_F(BedDriven, DrivesInLammps) {
  SKIP_WITHOUT_LAMMPS(true);
  const Scratch here, there;
  well(drive(here, {{"passes", "1"}}));
  well(drive(there, {{"passes", "1"}}, 1, "in.drive.lammps"));
  const post::Table a = post::read_table(here / "bed.csv"), b = post::read_table(there / "bed.csv");
  EXPECT_EQ(a.header(), b.header());
  EXPECT_EQ(a.numbers("s"), b.numbers("s"));
  EXPECT_NEAR(place_of_drum(post::dumped_steps(there / "dump").rbegin()->second.balls), 0.0, 1e-8);
}

// From one data file, with a contact history that starts at zero in both engines, over 500 steps; the roller
// has its full speed after the first half of them.
TEST_F(BedDriven, GoesTheSameWayInBothEnginesOver500Steps) {
  SKIP_WITHOUT_LAMMPS(true);
  place("clump.restart", {{"drum", "clump"}});
  for (const auto &[start, rotation] : {std::pair{"roller.restart", "driven"},
                                        {"roller.restart", "towed"},
                                        {"clump.restart", "driven"},
                                        {"clump.restart", "towed"}}) {
    const std::string file = (scratch().path() / start).string(), what = std::string(start) + rotation;
    const Scratch here, there;
    const std::string fresh = (here / "fresh.restart").string();
    well(run_deck(test_deck("bed_from_data.in"),
                  given("start {}, fresh {}, here {}", file, fresh, bed_folder().string()), here.path()));
    const Variables variables = given("omega 628.3185307179587, steps_per_cycle 500, samples_per_cycle 50, "
                                      "ramp 0.005, time_limit 1e-3, balance 1e30, drum_rotation {}",
                                      rotation);
    well(drive(here, with({{"start", fresh}}, variables)));
    well(drive(there, with(given("start {}, rest 0", file), variables), 1, "in.drive.lammps"));
    const post::Table a = post::read_table(here / "bed.csv"), b = post::read_table(there / "bed.csv");
    expect_same(a, b, 51, 1e-9, what);
    EXPECT_GT(a.numbers("s").back() - a.numbers("s").front(), 0.01) << what;
  }
}

// The balls of a drum that is driven turn about its axle by way over radius. A drum of the radius 0.1 m turns
// by 2 in a pass of 0.2 m.
TEST_F(BedDrivenByAClump, RollsToTheEndsOfItsWayAndItsWorkBalances) {
  for (const char *rotation : {"driven", "towed", "none"}) {
    const Scratch folder;
    const bool driven = std::string(rotation) == "driven";
    const Variables way = given("drum_rotation {}, passes 1, margin 0.01, steps_per_cycle 2000", rotation);
    // The others need no cells of a way: at twice the speed they take half as many steps.
    well(drive(folder, driven ? way : with(way, given("speed 4, ramp 0.025"))));
    const std::map<long, post::StepDump> dumps = post::dumped_steps(folder / "dump");
    ASSERT_EQ(dumps.size(), 2U);
    const fs::path first = dumps.begin()->second.balls, last = dumps.rbegin()->second.balls;
    EXPECT_NEAR(place_of_drum(first), -0.1, 1e-7);
    EXPECT_NEAR(place_of_drum(last), 0.1, 1e-7);
    const std::map<long, post::Ball> before = drum_in(first), after = drum_in(last);
    ASSERT_EQ(before.size(), after.size());
    const auto axle = before.begin()->first; // the first ball
    double turned = 0.0, largest = 0.0;
    for (const auto &[id, ball] : before) {
      const post::Ball &now = after.at(id);
      const auto lever = [&](const post::Ball &of, const std::map<long, post::Ball> &drum, std::size_t a) {
        return of.position[a] - drum.at(axle).position[a];
      };
      const double x0 = lever(ball, before, 0), y0 = lever(ball, before, 1);
      const double x = lever(now, after, 0), y = lever(now, after, 1);
      if (id == std::next(before.begin())->first) turned = std::atan2(x, y) - std::atan2(x0, y0);
      largest = std::max({largest, std::fabs(x0 * std::cos(turned) + y0 * std::sin(turned) - x),
                          std::fabs(y0 * std::cos(turned) - x0 * std::sin(turned) - y)});
      EXPECT_NEAR(now.position[2], ball.position[2], 1e-7);
    }
    EXPECT_LT(largest, 1e-6) << rotation;
    if (driven) {
      EXPECT_NEAR(turned, 2.0, 1e-5);
    } else {
      EXPECT_EQ(std::fabs(turned) > 0.1, std::string(rotation) == "towed") << turned;
    }
    EXPECT_LT(std::fabs(unbalanced(post::read_table(folder / "bed.csv"))), 1e-3) << rotation;
    if (!driven) continue;
    well(run_program(tool_words("passes {} --cell 0.17", folder.path().string()), {}, folder.path()));
    EXPECT_EQ(post::read_table(folder / "passes.csv").rows(), 2U);
  }
}

TEST_F(BedDrivenByAClump, ContinuesWhereALimitOfTimeStoppedItOnRanksOneAndTwo) {
  for (const int ranks : {1, 2}) {
    const Scratch stayed, left;
    well(drive(stayed, {{"passes", "1"}}, ranks));
    well(drive(left, given("passes 1, time_limit 1e-3"), ranks));
    well(drive(left, given("passes 1, start {}", (left / "stopped.restart").string()), ranks));
    for (const char *file : {"bed.csv", "cycles.csv", "events.csv"})
      EXPECT_EQ(read_text(left / file), read_text(stayed / file)) << file << ", ranks " << ranks;
  }
}

TEST_F(BedDrivenByAClump, GoesTheSameWayOnTwoRanksAndInLammps) {
  for (const char *rotation : {"driven", "towed"}) {
    const Variables a_cycle = given("time_limit 1e-3, drum_rotation {}, ramp 0.01", rotation);
    const Scratch one, two;
    well(drive(one, a_cycle));
    well(drive(two, a_cycle, 2));
    const post::Table alone = post::read_table(one / "bed.csv");
    expect_same(alone, post::read_table(two / "bed.csv"), 51, 1e-7, rotation);
    if (!post::has_lammps()) continue;
    const Scratch there;
    well(drive(there, with(a_cycle, given("rest 0, balance 1e30")), 1, "in.drive.lammps"));
    const post::Table other = post::read_table(there / "bed.csv");
    EXPECT_EQ(alone.header(), other.header());
    EXPECT_EQ(alone.numbers("s"), other.numbers("s"));
  }
}

// In files of version 0.3 the frame is attached to the highest ball of a clump, which then cannot roll.
TEST_F(BedDriven, DrivesAClumpOfEarlierFilesWithoutRotation) {
  const Scratch earlier;
  fs::copy(bed_folder(), earlier / "bed", fs::copy_options::recursive);
  for (const char *folder : {"chain", "soil"})
    fs::create_directory_symlink(bed_folder().parent_path() / folder, earlier / folder);
  std::string drum = read_text(earlier / "bed/drum.clump");
  const std::string axle = "2 single ${middle} ${y2}", top = "2 single ${middle} $(v_y2+v_r2-v_rc)";
  ASSERT_NE(drum.find(axle), std::string::npos);
  std::ofstream(earlier / "bed/drum.clump") << drum.replace(drum.find(axle), axle.size(), top);
  place("earlier.restart", {{"drum", "clump"}}, earlier / "bed");
  const Scratch folder;
  const Variables variables =
      given("start {}, time_limit 1e-3", (scratch().path() / "earlier.restart").string());
  EXPECT_TRUE(fails_with(drive(folder, variables),
                         "ERROR: drumlin/check: variable drum_rotation is 'driven'; allowed: none"));
  EXPECT_FALSE(fs::exists(folder / "bed.csv"));
  well(drive(folder, with(variables, {{"drum_rotation", "none"}})));
}

TEST_F(BedDriven, RefusesAWayThatItCannotDrive) {
  const Scratch folder;
  const auto refused = [&](const Variables &more, const char *line) {
    EXPECT_TRUE(fails_with(drive(folder, more), line));
    EXPECT_FALSE(fs::exists(folder / "bed.csv")) << line;
  };
  refused({{"passes", "0"}}, "ERROR: drumlin/variable: variable passes is '0'; allowed: ");
  refused({{"length", "0.09"}}, "ERROR: drumlin/variable: variable length is '0.09'; allowed: a finite "
                                "number above 0.1, so that it is longer than both ramps");
  refused({{"length", "0.7"}},
          "ERROR: drumlin/check: variable length is '0.7'; allowed: a finite number below 0.6, ");
  refused({{"margin", "0.1"}}, "ERROR: drumlin/variable: variable margin is '0.1'; allowed: ");
  refused({{"drum_rotation", "free"}}, "variable drum_rotation is 'free'; allowed: ");
  refused({{"speed", "-1"}}, "variable speed is '-1'; allowed: ");
  refused({{"dumps_per_pass", "7"}}, "variable steps_per_cycle is '1000'; allowed: ");
  refused({{"dumps_per_cycle", "10"}},
          "variable dumps_per_cycle is '10'; allowed: a finite number at most 0, ");
  refused({{"cycles", "3"}},
          "ERROR: drumlin/variables: -var cycles is '3', a variable that this deck does not have; allowed: ");
  EXPECT_TRUE(fails_with(
      run_deck(bed_folder() / "in.place",
               given("bed {}, start x.restart, place 0.41, r2 0.1", (scratch() / "soil.restart").string()),
               folder.path()),
      "ERROR: drumlin/check: variable place is '0.41'; allowed: a finite number below 0.4, "));
}

} // namespace
} // namespace drumlin::test
