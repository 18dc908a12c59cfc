// Runs of the stock engine for tests, and readers of their files.
#pragma once

#include "chain/parameters.h"
#include "engine/engine_run.h"
#include "runs/chain_files.h"
#include "support/files.h"

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

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

} // namespace drumlin::test
