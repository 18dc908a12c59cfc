// Runs of the stock engine for tests, of decks, scenes and the host deck, and readers of their files.
#pragma once

#include "tests/support/checks.h"
#include "chain/parameters.h"
#include "engine/deck_run.h"
#include "runs/chain_files.h"
#include "support/csv.h"
#include "support/files.h"

namespace drumlin::test {

constexpr double pi = 3.141592653589793;

/// A fresh temporary folder, removed with everything in it at the end (kept if the test has failed by then).
class Scratch {
public:
  Scratch();
  ~Scratch();
  Scratch(const Scratch &) = delete;
  Scratch &operator=(const Scratch &) = delete;
  const std::filesystem::path &path() const { return path_; }
  std::filesystem::path operator/(const std::string &name) const { return path_ / name; }

private:
  std::filesystem::path path_;
};

using post::Outcome;
using post::plugin_library;
using post::read_text;
using post::run_deck;
using post::run_program;
using post::Variables;

/// Whether a process has used this processor time, in seconds: an engine's start, which takes less, is over
/// then, however busy the machine is.
post::StopCondition after_processor_time(double seconds);

/// Sets, for its lifetime, how long mpirun waits for the other ranks when one has failed. The default of one
/// to two seconds is for ranks that put back earlier files; refused runs have none to put back.
class WaitForRanks {
public:
  explicit WaitForRanks(int seconds);
  ~WaitForRanks();
  WaitForRanks(const WaitForRanks &) = delete;
  WaitForRanks &operator=(const WaitForRanks &) = delete;

private:
  std::string before_;
};

/// A number for -var, bit for bit.
std::string number(double value);

/// A deck of the project (inputs/chain/...) or of these tests.
std::filesystem::path chain_deck(const std::string &name);
std::filesystem::path test_deck(const std::string &name);

/// Runs a scene of these tests, NAME.scene in tests/decks, in an engine, "liggghts" or "lammps".
Outcome run_scene(const std::string &engine, const std::string &name, const Variables &variables,
                  const std::filesystem::path &folder, int ranks = 1);

/// One ball in a dump.
struct Ball {
  std::array<double, 3> x{}, v{}, f{}, omega{}, torque{};
};

/// The dumps of the test decks: balls by ID, one entry per dumped step.
struct Frame {
  long step = 0;
  std::map<long, Ball> balls;
};
std::vector<Frame> read_dump(const std::filesystem::path &file);

/// The files of a run of the chain or of a single impact.
struct ChainRun {
  post::ChainHistory history;
  std::vector<post::ContactEvent> events;
};
ChainRun read_run(const std::filesystem::path &folder);

/// The largest number of ranks of tests that try several: two, or by night DRUMLIN_RANKS, since more would
/// take turns on two cores.
int most_ranks();

/// Runs in.chain in a folder of its own for a case of Table 1, 30 cycles with stock stepping unless a
/// variable says otherwise. Fails the test on an error.
ChainRun run_chain(const std::string &name, post::Transition transition, int steps_per_cycle,
                   int samples_per_cycle, const Variables &more = {});

/// A copy of the chain's decks in a folder, with the box from `bottom` up instead of the deck's own, so that
/// the borders between ranks are at chosen heights: N ranks are N layers of one height up to z = 4. Returns
/// where the copy is.
std::filesystem::path chain_with_bottom(const std::filesystem::path &folder, double bottom);

/// Runs a shell script in a folder with a file system of 600 kB at `small`, which only its processes see; the
/// variables $DRUMLIN_PRELOAD and $DECKS are the plugin and inputs/chain. Status 77: this needs root.
Outcome on_small_disk(const std::filesystem::path &folder, const std::string &script);
bool can_mount_small_disk();

/// Slope of log(error) over log(steps) by least squares: -1 for a first-order scheme.
double fitted_order(const std::vector<double> &steps, const std::vector<double> &errors);

/// Largest |a - b| over the largest |b|; infinite if the lengths differ.
double relative_difference(const std::vector<double> &a, const std::vector<double> &b);

/// A run of balls.in that has ended well.
struct BallsRun {
  std::vector<Frame> frames;
  std::vector<post::ContactEvent> events;
  std::vector<double> reaction; ///< what the fixed ball's fix reads along z, N, from the second frame on
  std::string output;

  /// A component of one ball over the frames.
  std::vector<double> series(long id, std::array<double, 3> Ball::*part, std::size_t axis) const;
};

/// Runs balls.in in a folder of its own, with a triangle of z = 0 as floor.stl. Throws with the output if
/// that fails.
BallsRun run_balls(const Variables &variables, int ranks = 1);

/// Writes triangles that cover x and y from -half_width to half_width in z = 0; one if `single`, which covers
/// the middle.
void write_floor(const std::filesystem::path &file, double half_width, bool single);

/// "x y z" for a variable.
std::string vector_text(double x, double y, double z);

/// Largest distance of two states in position, m, over the frames; infinite if they have other steps or
/// balls.
inline double distance(const std::vector<Frame> &a, const std::vector<Frame> &b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    if (a[n].step != b[n].step || a[n].balls.size() != b[n].balls.size())
      return std::numeric_limits<double>::infinity();
    for (const auto &[id, ball] : a[n].balls)
      for (std::size_t axis = 0; axis < 3; ++axis)
        largest = std::max(largest, std::fabs(ball.x[axis] - b[n].balls.at(id).x[axis]));
  }
  return largest;
}

/// The pair style and pair_coeff of the host deck.
std::string host_pair_style();
/// A property for all pairs of the host's three types.
std::string property(const std::string &name, const std::string &value);
/// All properties that the contact law may ask for, but those that `text` gives itself.
std::string host_properties(const std::string &text = "");

/// Lines of the host deck of LIGGGHTS in which, between two runs, ball 4 gets the ID 1. \param lines before
/// the first run
std::string with_other_ids(const std::string &lines = "");

/// Runs a deck with the plugin, output in a file; `words` follow the deck on the command line. Standard
/// limit: 60 s.
Outcome run_engine(const std::filesystem::path &deck, const std::vector<std::string> &words,
                   const std::filesystem::path &folder, int ranks);

/// The host deck, and the files that it reads: a pair style with properties, and the lines under test.
extern const std::filesystem::path host_deck;
void write_host(const std::string &pair, const std::string &lines, const std::filesystem::path &folder);

/// Runs the host deck with a pair style (and properties) and the lines under test.
Outcome run_host(const std::string &pair, const std::string &lines, const std::filesystem::path &folder,
                 int ranks);

/// Runs the host deck of LAMMPS, which has no pair style, with the lines under test.
Outcome run_lammps_host(const std::string &lines, const std::filesystem::path &folder, int ranks);

/// Environment with which MPI runs as root, with more ranks than cores, and several runs at once; its own
/// files go to `folder`.
std::vector<std::string> mpi_environment(const std::filesystem::path &folder);

void write_text(const std::filesystem::path &file, const std::string &text);

/// Runs a deck of inputs/soil in an engine and returns a table, by default that of the test: "biaxial" has
/// in.biaxial(.lammps) and biaxial.csv. Throws std::runtime_error with the output of a run that fails.
inline post::Table run_element_test(const std::string &engine, const std::string &name,
                                    const Variables &variables, int ranks = 1, const std::string &file = "") {
  const Scratch scratch;
  const std::string deck = "../soil/in." + name + (engine == "lammps" ? ".lammps" : "");
  well(run_deck(chain_deck(deck), variables, scratch.path(), ranks));
  return post::read_table(scratch / (file.empty() ? name + ".csv" : file));
}

/// Ends a test as skipped where it needs LAMMPS, which is not set up.
#define SKIP_WITHOUT_LAMMPS(needed)                                                                          \
  if ((needed) && !post::has_lammps())                                                                       \
  GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)"

/// Tests in an engine, "liggghts" or "lammps"; skipped if LAMMPS is not set up.
class InEngine : public ::testing::TestWithParam<std::string> {
protected:
  void SetUp() override { SKIP_WITHOUT_LAMMPS(GetParam() == "lammps"); }
};

/// Engine and stepping.
class BothEngines : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
protected:
  void SetUp() override { SKIP_WITHOUT_LAMMPS(std::get<0>(GetParam()) == "lammps"); }

  /// Runs the scene into the folder.
  static Outcome run(const std::string &scene, const Scratch &folder, Variables variables = {}) {
    const auto &[engine, stepping] = GetParam();
    variables.emplace_back("stepping", stepping);
    return run_scene(engine, scene, variables, folder.path());
  }
};

inline auto engines_and_steppings() {
  return ::testing::Combine(::testing::Values("liggghts", "lammps"), ::testing::Values("second", "stock"));
}

inline std::string engine_and_stepping(const ::testing::TestParamInfo<BothEngines::ParamType> &test) {
  return std::get<0>(test.param) + "_" + std::get<1>(test.param);
}

} // namespace drumlin::test
