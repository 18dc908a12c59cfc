// Runs and their files: earlier ones, and what the tools find in them.
#include "tests/support/chain_record.h"
#include "tests/support/engine_runs.h"
#include "identify/identified_record.h"
#include "map/orbits.h"
#include "meter/values.h"
#include "report/report.h"
#include "runs/parameter_file.h"

#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

namespace drumlin::test {
namespace {

// The files of a run: earlier results stay until a new run has passed its first steps, two runs do not mix,
// signals and full disks are errors, and nothing but regular files is replaced.
namespace earlier_runs {

namespace fs = std::filesystem;

const std::vector<std::string> chain_files = {"parameters.csv", "chain.csv", "events.csv", "cycles.csv"};

std::map<std::string, std::string> texts(const fs::path &folder) {
  std::map<std::string, std::string> all;
  for (const auto &entry : fs::directory_iterator(folder))
    if (entry.path().filename() != "screen.txt")
      all[entry.path().filename().string()] = read_text(entry.path());
  return all;
}

/// A force that drives the drum through the soil: the guard ends the run at step 100.
const Variables too_strong = given("Fw 1e10, cycles 1");

TEST(EarlierRuns, OfAnEarlierRunStayWhenTheFirstStepFailsOnRanksOneAndTwo) {
  for (const int ranks : {1, 2}) {
    const Scratch folder;
    well(run_deck(chain_deck("in.chain"), {{"cycles", "1"}}, folder.path()));
    const auto before = texts(folder.path());
    ASSERT_EQ(before.size(), chain_files.size());
    EXPECT_TRUE(fails_with(run_deck(chain_deck("in.chain"), too_strong, folder.path(), ranks),
                           "ERROR: fix guard: overlap of balls "));
    EXPECT_EQ(texts(folder.path()), before);
  }
}

TEST(EarlierRuns, OfARunThatFailsAtOnceAreNotThere) {
  const Scratch folder;
  const Outcome failed = run_deck(chain_deck("in.chain"), too_strong,
                                  folder.path()); // writes into the folder itself, which exists
  EXPECT_EQ(failed.status, 1);
  EXPECT_TRUE(texts(folder.path()).empty());
}

// A process that is killed cannot restore its backups: the next run does.
TEST(EarlierRuns, KeptAsideByAKilledRunComeBack) {
  const Scratch folder;
  well(run_deck(chain_deck("in.chain"), {{"cycles", "1"}}, folder.path()));
  const auto before = texts(folder.path());
  for (const std::string &name : chain_files)
    fs::rename(folder / name, folder / (name + ".earlier"));
  std::ofstream(folder / "chain.csv") << "time,half a r";
  EXPECT_EQ(run_deck(chain_deck("in.chain"), too_strong, folder.path()).status, 1);
  EXPECT_EQ(texts(folder.path()), before);
}

/// A run that a signal ends after a while; meanwhile a second one is refused its folder.
struct Ended {
  std::string deck;
  Variables variables;
  int ranks;
  Outcome first, second;
};

void run_until_a_signal(Ended &run) {
  const Scratch folder, other;
  const auto deck = chain_deck(run.deck);
  std::atomic<bool> second_ended = false;
  std::thread runner([&] {
    run.first = run_deck(deck, run.variables, folder.path(), run.ranks, 60.0,
                         [&](pid_t /*child*/) { return second_ended.load(); });
  });
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!fs::exists(folder / "chain.csv") && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  run.second = run_deck(deck, {{"out", folder.path().string()}}, other.path(), 1, 25.0);
  second_ended = true;
  runner.join();
}

TEST(EarlierRuns, OfARunAreItsOwnUntilASignalEndsItOnRanksOneAndTwo) {
  std::vector<Ended> runs = {{"in.chain", {{"cycles", "1000000"}}, 2, {}, {}},
                             {"in.impact", given("contacts 1000, steps_per_contact 1000000"), 1, {}, {}}};
  if (post::has_lammps()) runs.push_back({"in.chain.lammps", {{"cycles", "1000000"}}, 1, {}, {}});
  const WaitForRanks wait(2); // on a busy machine the default can be too short
  std::vector<std::thread> side_by_side;
  side_by_side.reserve(runs.size());
  for (Ended &run : runs)
    side_by_side.emplace_back(run_until_a_signal, std::ref(run));
  for (std::thread &one : side_by_side)
    one.join();
  // When mpirun of Open MPI 5 has received a signal, it no longer prints what its ranks write.
  const bool mpirun_hands_on =
      run_program({"mpirun", "--version"}, {}, Scratch().path()).says("(Open MPI) 4.");
  for (const Ended &run : runs) {
    EXPECT_EQ(run.second.status, 1) << run.deck;
    EXPECT_TRUE(run.second.says(", into which another run writes; allowed: ")) << run.second.output;
    EXPECT_EQ(errors_in(run.second.output), 1U) << run.second.output;
    EXPECT_TRUE(run.first.timed_out) << run.deck;
    EXPECT_EQ(run.first.status, 1) << run.deck;
    if (run.ranks > 1 && !mpirun_hands_on) continue;
    EXPECT_TRUE(run.first.says("ERROR: drumlin/run: stopped by a signal at step ")) << run.first.output;
    EXPECT_EQ(errors_in(run.first.output), 1U) << run.first.output;
  }
}

// Nodes are made in the scratch folder.
TEST(EarlierRuns, ReplaceRegularFilesOnly) {
  for (const char *kind : {"device", "pipe", "link", "broken link", "folder", "read-only file"}) {
    const Scratch folder;
    const fs::path node = folder / "chain.csv";
    const std::string what = kind;
    if (what == "device") {
      if (mknod(node.c_str(), S_IFCHR | 0600, makedev(1, 3)) != 0) continue; // needs root
    } else if (what == "pipe") {
      ASSERT_EQ(mkfifo(node.c_str(), 0600), 0);
    } else if (what == "folder") {
      fs::create_directory(node);
    } else if (what == "read-only file") {
      std::ofstream(node) << "kept\n";
      fs::permissions(node, fs::perms::owner_read);
    } else {
      if (what == "link") std::ofstream(folder / "target") << "kept\n";
      fs::create_symlink(folder / "target", node);
    }
    const fs::file_type type = fs::symlink_status(node).type();
    EXPECT_TRUE(fails_with(run_deck(chain_deck("in.chain"), {{"cycles", "1"}}, folder.path(), 1, 10.0),
                           "ERROR: drumlin/outputs: file is '"))
        << kind;
    EXPECT_EQ(fs::symlink_status(node).type(), type) << kind;

    std::ofstream(folder / "balls.data") << "balls\n\n0 atoms\n";
    const Outcome settle = run_deck(
        chain_deck("../bed/in.settle"),
        given("balls {}, bed {}", (folder / "balls.data").string(), node.string()), folder.path(), 1, 10.0);
    EXPECT_EQ(settle.status, 1) << kind;
    EXPECT_TRUE(settle.says("variable ba") || settle.says("variable bed is ")) << kind << settle.output;
    EXPECT_EQ(fs::symlink_status(node).type(), type) << kind;
    if (what == "link") {
      EXPECT_EQ(read_text(folder / "target"), "kept\n");
    }
  }
}

/// Whether and why a run has ended, in its own words.
std::string end_of(const fs::path &folder) {
  return post::read_parameters(folder / "parameters.csv").at("ended");
}

constexpr const char *own_outputs = "drumlin/outputs folder out files parameters.csv\n"
                                    "drumlin/record out/parameters.csv deck own\n";

// Lines behind 150 steps of a deck of one's own.
TEST(EndOfARun, StandsInItsParametersInEitherEngine) {
  struct End {
    std::string lines, says;
    bool in_lammps = true; ///< there the host deck has neither contacts nor gravity
  };
  const std::vector<End> ends = {
      {"", "yes"},
      {"no_such_command", "an error, which the engine's output names"},
      {"drumlin/run 1000 every 10 limit 1e-9 restart out/s.restart",
       "drumlin/run: stopped at step 160 of 1000 by limit 1e-09 s; continue from out/s.restart"},
      {"drumlin/settle ratio 1e-30 limit 10 every 5", "drumlin/settle: unbalanced ratio is '", false},
      {"fix guard all guard every 1 links 1 overlap 1e-12\nrun 100",
       "fix guard: overlap of balls 1 and 2 is '", false}};
  for (const bool lammps : {false, true})
    for (const End &end : ends) {
      if (lammps && !(end.in_lammps && post::has_lammps())) continue;
      const Scratch folder;
      const std::string lines = std::string(own_outputs) + "run 150\n" + end.lines;
      const Outcome outcome = lammps
                                  ? run_lammps_host(lines, folder.path(), 1)
                                  : run_host(host_properties() + host_pair_style(), lines, folder.path(), 1);
      ASSERT_TRUE(fs::exists(folder / "out/parameters.csv")) << end.says << outcome.output;
      EXPECT_EQ(end_of(folder / "out").rfind(end.says, 0), 0u) << end_of(folder / "out") << outcome.output;
      EXPECT_FALSE(fs::exists(folder / "out/parameters.csv.unfinished"));
    }
}

TEST(EndOfARun, OfAChainIsToldApartOnRanksOneAndTwo) {
  for (const char *deck : {"in.chain", "in.chain.lammps"})
    for (const int ranks : {1, 2}) {
      if (std::string(deck) == "in.chain.lammps" && !post::has_lammps()) continue;
      const Scratch folder;
      const auto run = [&](const Variables &variables, const post::StopCondition &stop_when) {
        return run_deck(chain_deck(deck), variables, folder.path(), ranks, 60.0, stop_when);
      };
      well(run({{"cycles", "1"}}, {}));
      EXPECT_EQ(end_of(folder.path()), "yes") << deck << ranks;
      // The guard ends the run when the first steps, after which no earlier results come back, are over.
      const Outcome guarded = run(given("cycles 1, Fw 3e8, steps_per_cycle 20000"), {});
      EXPECT_EQ(guarded.status, 1) << guarded.output;
      EXPECT_EQ(end_of(folder.path()).rfind("fix guard: overlap of balls 1 and 2 is '", 0), 0u)
          << deck << ranks << end_of(folder.path()) << guarded.output;
      if (ranks > 1) continue; // mpirun may kill a rank before it has noted its end
      const auto has_rows = [&] {
        std::error_code code;
        return fs::file_size(folder / "chain.csv", code) > 5000 && !code;
      };
      fs::remove(folder / "chain.csv");
      run({{"cycles", "1000000"}}, [&](pid_t) { return has_rows(); });
      EXPECT_EQ(end_of(folder.path()).rfind("drumlin/run: stopped by a signal at step ", 0), 0u)
          << deck << end_of(folder.path());
      fs::remove(folder / "chain.csv");
      run({{"cycles", "1000000"}}, [&](pid_t engine) {
        if (has_rows()) ::kill(engine, SIGKILL);
        return false;
      });
      EXPECT_EQ(end_of(folder.path()), "no") << deck;
    }
}

// The engine's own command run ends after a signal, and the deck goes on.
TEST(EndOfARun, OfTheEnginesOwnCommandIsNoted) {
  const Scratch folder;
  write_text(folder / "pair", host_properties() + host_pair_style());
  write_text(folder / "lines", std::string(own_outputs) + "run 1000000000\n");
  const Outcome stopped = run_deck(fs::path(DRUMLIN_SOURCE_DIR) / "tests/support/in.host", {}, folder.path(),
                                   1, 60.0, after_processor_time(1.0));
  EXPECT_EQ(end_of(folder / "out").rfind("stopped by a signal or a limit of time at step ", 0), 0u)
      << end_of(folder / "out") << stopped.output;
}

// A sample whose balls are too soft for the second load: the loads before are there.
TEST(EndOfARun, OfATestOfSoilIsInItsReport) {
  const Scratch folder, out;
  const Outcome stopped =
      run_deck(chain_deck("../soil/in.oedometer"),
               given("sample random, columns 4, layers 4, loads 25 50 2e4"), folder.path());
  ASSERT_EQ(stopped.status, 1) << stopped.output;
  ASSERT_TRUE(stopped.says("ERROR: fix guard: overlap of ")) << stopped.output;
  EXPECT_EQ(end_of(folder.path()).rfind("fix guard: overlap of ", 0), 0u) << end_of(folder.path());
  EXPECT_EQ(post::read_parameters(folder / "parameters.csv").at("loads"), "25,50,2e4");
  post::ReportOptions options;
  options.folders = {folder.path()};
  options.out = out / "report";
  const post::ReportOutcome outcome = post::write_report(options);
  ASSERT_EQ(outcome.left_out.size(), 1u);
  EXPECT_TRUE(outcome.left_out[0].cut);
  EXPECT_EQ(outcome.left_out[0].why.rfind("it was cut: fix guard: overlap of ", 0), 0u)
      << outcome.left_out[0].why;
  EXPECT_TRUE(contains(read_text(outcome.page), "it was cut: fix guard: overlap of "));
  EXPECT_FALSE(fs::exists(out / "report/oedometer"));
}

// Under any name and through links; two fixes do not write one file.
TEST(EarlierRuns, AndInputsAreNotReplaced) {
  const Scratch folder;
  write_text(folder / "measured.csv", "kept\n");
  fs::create_hard_link(folder / "measured.csv", folder / "hard.csv");
  for (const bool lammps : {false, true}) {
    if (lammps && !post::has_lammps()) continue;
    const auto run = [&](const std::string &lines) {
      return lammps ? run_lammps_host(lines, folder.path(), 1)
                    : run_host(host_properties() + host_pair_style(), lines, folder.path(), 1);
    };
    for (const char *output : {"measured.csv", "./measured.csv", "hard.csv"}) {
      EXPECT_TRUE(fails_with(run(fmt::format("drumlin/outputs files {} inputs measured.csv", output)),
                             fmt::format("ERROR: drumlin/outputs: file is '{}'; allowed: another file than "
                                         "'measured.csv', which the run has read",
                                         output)));
      EXPECT_EQ(read_text(folder / "measured.csv"), "kept\n");
      EXPECT_FALSE(fs::exists(folder / "measured.csv.earlier"));
    }
  }
  // The data file of in.settle has the name of the balls from which it starts.
  run_program(tool_words("bed --balls 20 --width 0.5 --out bed.data"), {}, folder.path());
  const std::string balls = read_text(folder / "bed.data");
  for (const char *deck : {"../bed/in.settle", "../bed/in.settle.lammps"}) {
    if (std::string(deck) == "../bed/in.settle.lammps" && !post::has_lammps()) continue;
    EXPECT_TRUE(
        fails_with(run_deck(chain_deck(deck), given("balls bed.data, bed bed"), folder.path()),
                   "file is 'bed.data'; allowed: another file than 'bed.data', which the run has read"));
    EXPECT_EQ(read_text(folder / "bed.data"), balls);
  }
  EXPECT_TRUE(fails_with(
      run_host(host_properties() + host_pair_style(),
               "fix a all contact/events file one.csv types 1 2\n"
               "fix b all contact/events file one.csv types 1 2",
               folder.path(), 1),
      "one.csv', which cannot be written; allowed: a file that no other fix and no other run writes"));
}

TEST(EarlierRuns, OnAFullDiskAreAnError) {
  if (!can_mount_small_disk()) GTEST_SKIP() << "SKIPPED: a file system of its own needs root";
  const Scratch folder;
  const Outcome chain =
      on_small_disk(folder.path(), "LD_PRELOAD=$DRUMLIN_PRELOAD exec liggghts -in \"$DECKS/in.chain\" -log "
                                   "none -var cycles 120 -var out small");
  EXPECT_TRUE(fails_with(chain, "chain.csv', which cannot be written; allowed: a file on a disk with room"));
  EXPECT_EQ(errors_in(chain.output), 1U) << chain.output;
}

TEST(EarlierRuns, OnAFullDiskAnEarlierRestartFileStaysWhole) {
  if (!can_mount_small_disk()) GTEST_SKIP() << "SKIPPED: a file system of its own needs root";
  const Scratch folder;
  std::ofstream(folder / "keep.in")
      << "drumlin/variable keep none any - test \"folder of the files\"\ninclude ${here}/in.chain\n"
         "drumlin/write restart ${keep}/x.restart stage one\n"
         "drumlin/write data ${keep}/x.data stage one\n";
  const std::string run =
      "env LD_PRELOAD=$DRUMLIN_PRELOAD liggghts -in keep.in -log none -var here \"$DECKS\" -var cycles 1 "
      "-var out out -var keep small\n";
  for (const char *file : {"x.restart", "x.data"}) {
    const std::string remove =
        std::string(file) == "x.data" ? "rm small/x.restart; head -c 3000 /dev/zero > small/room\n" : "";
    const Outcome both = on_small_disk(
        folder.path(),
        fmt::format("{0}cp small/{1} before\nhead -c 1000000 /dev/zero > small/fill\n{2}{0}echo status $?\n"
                    "cmp before small/{1} && echo whole; ls small\n",
                    run, file, remove));
    fs::remove_all(folder / "small");
    EXPECT_TRUE(printed(both, {"status 1", "whole"}));
    EXPECT_FALSE(both.says("unfinished")) << both.output;
    EXPECT_TRUE(printed(both, "; allowed: a file on a disk with room"));
  }
}

} // namespace earlier_runs

// What the tools find in runs of the decks: meter values, stiffness and damping, boundaries of regimes.
namespace tools_on_runs {

// Meter values of the chain in the engine: from the sums over every step, against those of the exact
// solution.
namespace meter {

TEST(MeterOfDecks, CmvFromEveryStep) {
  struct Known {
    const char *name;
    double cmv; // reference value, from Fourier integrals over each phase of the exact solution
  };
  for (const Known &known : {Known{"II", 155.948}, Known{"III", 105.730}, Known{"IV", 247.175}}) {
    const Scratch scratch;
    const Outcome outcome = run_deck(
        chain_deck("in.chain"), given("case {}, cycles 120, out {}", known.name, (scratch / "run").string()),
        scratch.path());
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    for (const char *name : {"run", "run/cycles.csv"}) {
      const post::MeterRecord record = post::meter_cycles(post::read_record(scratch / name));
      EXPECT_EQ(record.source, post::HarmonicSource::every_step);
      EXPECT_EQ(record.cycles.size(), 120U);
      const post::MeterWindow window = post::meter_windows(record, {}).back();
      EXPECT_NEAR(*window.cmv / known.cmv, 1.0, 1e-3) << known.name;
      EXPECT_EQ(window.mode, post::OperatingMode::partial_uplift);
      EXPECT_LT(*window.rmv, 0.01);
      EXPECT_GT(*window.energy, 0.0);
    }
    // The samples alone, 200 per cycle, are within their own bound.
    const post::MeterWindow sampled =
        post::meter_windows(post::meter_cycles(post::read_record(scratch / "run/chain.csv")), {}).back();
    EXPECT_LT(std::abs(*sampled.cmv - known.cmv), sampled.cmv_bound) << known.name;
  }
}

} // namespace meter

// Stiffness and damping found from runs of the engine at the decks' default steps.
namespace identify {

TEST(Identify, EightChainRuns) {
  for (const char *name : post::table1_cases)
    for (const post::Transition transition : {post::Transition::A, post::Transition::B}) {
      SCOPED_TRACE(std::string(name) + post::transition_name(transition));
      const post::ChainParameters p = post::table1_case(name, transition);
      const ChainRun run = run_chain(name, transition, 2000, 200, {{"stepping", "second"}});
      const post::Record record = record_of(p, run.history);
      for (const bool accelerations_only : {false, true}) {
        post::RecordSetting setting;
        setting.accelerations_only = accelerations_only;
        const post::LawEstimate law = post::identify_record(record, setting).whole.law;
        EXPECT_NEAR(law.k.mean, p.k, 1e-3 * p.k);
        EXPECT_NEAR(law.c.mean, p.damping(), 3e-3 * p.damping());
        EXPECT_NEAR(law.D.mean, p.D, 3e-3 * p.D);
      }
    }
}

} // namespace identify

// Boundaries of regimes that are computed in closed form and from orbits, against runs of the chain in the
// engine on both sides of them, as near as the error of these runs permits.
namespace boundaries {

using namespace post;

// A run with the deck's default step, 2000 per cycle.
struct Run {
  ChainHistory history; ///< one sample per cycle
  CycleColumns cycles;
  std::vector<ContactEvent> events;
};

Run run(const ChainParameters &p, int cycles) {
  const Scratch scratch;
  const Outcome outcome = run_deck(chain_deck("in.chain"),
                                   given("case II, k {}, D {}, cycles {}, samples_per_cycle 1, out {}", p.k,
                                         p.D, cycles, (scratch / "run").string()),
                                   scratch.path());
  if (!outcome.ok()) throw std::runtime_error("in.chain failed:\n" + outcome.output);
  return {read_chain(scratch / "run/chain.csv"), read_cycle_columns(scratch / "run/cycles.csv"),
          read_events(scratch / "run/events.csv")};
}

ChainParameters chain(double k, double D) {
  ChainParameters p = table1_case("II", Transition::B);
  p.k = k;
  p.D = D;
  return p;
}

TEST(BoundariesOfDecks, ContactIsLostWhereItIsInClosedForm) {
  constexpr int cycles = 80; // until the frame has come to its steady motion
  const ChainFamily family = [](double k) { return chain(k, 0.5); };
  const auto onset = locate_contact_loss(family, 3e6, 20e6);
  ASSERT_TRUE(onset);
  // The error of the engine is that of the least force in the last cycle, as the relative change of k that
  // causes it.
  const double below = 0.99;
  const double exact = contact_margin(family(below * onset->value));
  const double error =
      std::fabs(run(family(below * onset->value), cycles).cycles.at("F_contact_min").back() - exact) /
      (exact / (1.0 - below));
  EXPECT_LT(error, 1e-5);
  for (const double side : {-1.0, 1.0}) {
    const ChainParameters p = family(onset->value * (1.0 + side * std::max(4.0 * error, 1e-6)));
    const std::vector<ContactEvent> events = run(p, cycles).events;
    const auto late = std::count_if(events.begin(), events.end(), [&](const ContactEvent &event) {
      return !event.make && event.time > (cycles - 10) * p.period();
    });
    EXPECT_EQ(late, side > 0.0 ? 10 : 0) << side << ", error " << error;
  }
}

// The ratio of successive changes of v_drum at the start of a cycle is the multiplier of the orbit that they
// die away to; beyond the boundary they persist.
TEST(BoundariesOfDecks, ThePeriodDoublesWhereAMultiplierPassesMinusOne) {
  const ChainFamily family = [](double k) { return chain(k, 0.1); };
  constexpr double from = 15e6;
  const ChainSolver solver(family(from));
  ChainMotion motion = solver.start();
  for (int cycle = 0; cycle < 400; ++cycle)
    solver.finish_cycle(motion);
  const auto start = find_orbit(solver, motion.state, 1);
  ASSERT_TRUE(start);
  const auto doubling = locate_doubling(family, from, 25e6, *start);
  ASSERT_TRUE(doubling);
  constexpr std::size_t cycles = 200;
  const auto changes = [&](double k) {
    const std::vector<double> v = run(family(k), cycles).history.v_drum;
    return std::vector<double>{v[cycles - 2] - v[cycles - 3], v[cycles - 1] - v[cycles - 2],
                               v[cycles] - v[cycles - 1]};
  };
  const double below = 0.95 * doubling->value;
  const std::vector<double> dying = changes(below);
  EXPECT_NEAR(dying[2] / dying[1],
              continue_orbit(family, from, below, 8, *start).back().orbit.multipliers[0].real(),
              3e-4); // 4e-4 of k
  const std::vector<double> lasting = changes(1.02 * doubling->value);
  EXPECT_NEAR(lasting[2] / lasting[1], -1.0, 1e-3);
  EXPECT_GT(std::fabs(lasting[2]), 100.0 * std::fabs(dying[2]));
}

} // namespace boundaries

} // namespace tools_on_runs

} // namespace
} // namespace drumlin::test
