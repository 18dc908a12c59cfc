// What the plugin refuses: tables of mistakes, a file for each command or style and one for each deck of
// inputs, each mistake with the one line that the engine must print for it (tests/README.md).
#include "tests/refused/engine_copy.h"
#include "tests/refused/refusals.h"
#include "tests/support/checks.h"
#include "tests/support/host_deck.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

const fs::path inputs = fs::path(DRUMLIN_SOURCE_DIR) / "inputs";

/// The folder `out` of an earlier run.
class EarlierRun {
public:
  explicit EarlierRun(const fs::path &folder) : folder_(folder / "out") {
    fs::create_directory(folder_);
    for (const char *name : files) {
      write_text(folder_ / name, std::string("the earlier ") + name + "\n");
      fs::last_write_time(folder_ / name, written_);
    }
  }
  void expect_untouched() const {
    for (const char *name : files) {
      EXPECT_EQ(read_text(folder_ / name), std::string("the earlier ") + name + "\n");
      EXPECT_EQ(fs::last_write_time(folder_ / name), written_) << name;
    }
  }

private:
  static constexpr const char *files[] = {"chain.csv", "events.csv", "cycles.csv", "parameters.csv"};
  fs::path folder_;
  fs::file_time_type written_ = fs::file_time_type::clock::now() - std::chrono::hours(1);
};

/// The deck around the mistake: it writes into the folder of the earlier run.
constexpr const char *outputs =
    "\nfix out_events all contact/events file out/events.csv types 1 2\n"
    "fix out_history drum roller/history file out/chain.csv every 10 cycles out/cycles.csv 10\n";

/// How a mistake is tried.
enum class By { copy, program, ranks };

void expect_refused(const Refusal &refusal, const Outcome &outcome) {
  EXPECT_FALSE(outcome.timed_out);
  EXPECT_NE(outcome.status, 0);
  std::vector<std::string> errors;
  for (const std::string &line : lines_of(outcome.output))
    if (line.rfind("ERROR", 0) == 0)
      errors.push_back(line); // mpirun may add lines of its own when a rank ends
  ASSERT_EQ(errors.size(), 1U) << outcome.output;
  // The engine by itself adds a line to one error in five, by chance, with the same place in its source at
  // its end.
  const std::size_t at = errors.front().rfind(" (");
  const std::string place = at == std::string::npos ? errors.front() : errors.front().substr(at);
  EXPECT_EQ(outcome.output.find(place), outcome.output.rfind(place)) << outcome.output;
  ASSERT_TRUE(says_so(refusal, errors.front()));
  if (refusal.in_engine_words) return;
  EXPECT_TRUE(contains(errors.front(), "; allowed: "));
}

/// A file with the notes of a bed, which in.place and in.bed read before they check their other variables.
/// The engine never reads it.
const std::string &bed_file(const std::string &stage) {
  static std::map<std::string, std::string> files;
  std::string &text = files[stage];
  if (text.empty()) {
    const Scratch scratch;
    well(run_host(host_pair_style() + host_properties(),
                  "drumlin/write restart bed.restart bed " + stage +
                      " case gravel dimension 2 walls 1 stepping stock g 9.81 tangential "
                      "coulomb rolling_history 1 k 1e9 D 0.3 friction 0.8 rolling 0.3" +
                      (stage == "soil" ? ""
                                       : " drum ball m2 2000 m3 1000 r2 0.35 r3 0.25 rc 0.02 drum_depth 0.01 "
                                         "k23 1e6 c23 1e4") +
                      "\n",
                  scratch.path(), 1));
    text = read_text(scratch / "bed.restart");
  }
  return text;
}

Outcome run_deck_of(const Refusal &refusal, const fs::path &folder, int ranks) {
  std::vector<std::string> words;
  const auto give = [&words](const std::string &name, const std::string &value) {
    words.insert(words.end(), {"-var", name, value});
  };
  for (const auto &[name, value] : refusal.variables)
    give(name, value);
  // The first of two counts: a mistake in these variables stays.
  const std::string &deck = refusal.deck;
  if (deck == "bed/in.settle") {
    write_text(folder / "balls", "no notes\n"); // which in.settle reads first, before it checks the rest
    give("balls", "balls");
  } else if (deck == "bed/in.place" || deck == "soil/in.plate") {
    write_text(folder / "soil", bed_file("soil"));
    give("bed", "soil");
  } else if (deck == "bed/in.bed") {
    write_text(folder / "roller", bed_file("roller"));
    give("start", "roller");
  }
  if (deck != "bed/in.place" && deck != "bed/in.settle") give("out", "out");
  return run_engine(inputs / deck, words, folder, ranks);
}

Outcome run(const Refusal &refusal, const fs::path &folder, By by) {
  const int ranks = by == By::ranks ? 2 : 1;
  if (!refusal.deck.empty()) return run_deck_of(refusal, folder, ranks);
  if (refusal.lammps) return run_lammps_host(refusal.lines + outputs, folder, ranks);
  const std::string pair = refusal.pair.empty() ? host_pair_style() + host_properties() : refusal.pair;
  if (by != By::copy) return run_host(pair, refusal.lines + outputs, folder, ranks);
  write_host(pair, refusal.lines + outputs, folder);
  return run_in_copy(host_deck, folder);
}

void try_refusal(const Refusal &refusal, By by) {
  SCOPED_TRACE(refusal.place);
  const Scratch scratch;
  const EarlierRun earlier(scratch.path());
  Outcome outcome = run(refusal, scratch.path(), by);
  // On a busy machine the launcher of Open MPI 5 may end before it has passed on the last lines of rank 0.
  const auto lost = [&] { return outcome.says("prterun detected") && !outcome.says("ERROR"); };
  for (int again = 0; again < 3 && lost(); ++again)
    outcome = run(refusal, scratch.path(), by);
  expect_refused(refusal, outcome);
  if (!refusal.in_the_run) earlier.expect_untouched();
}

/// A table each; those of LAMMPS are skipped without it.
class Refused : public ::testing::TestWithParam<std::string> {
protected:
  std::vector<Refusal> table() const { return read_refusals(GetParam()); }
  void SetUp() override {
    if (is_of_lammps(GetParam()) && !post::has_lammps())
      GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  }
};
using RefusedOnRanks = Refused;
using FirstOnRanks = Refused;

TEST_P(Refused, InOneLine) {
  bool first = true; // the program itself, and not a copy of this one, has the first mistake of each table
  for (const Refusal &refusal : table())
    try_refusal(refusal, std::exchange(first, false) ? By::program : By::copy);
}

TEST_P(RefusedOnRanks, InOneLine) {
  for (const Refusal &refusal : table())
    if (refusal.on_two_ranks) try_refusal(refusal, By::ranks);
}

// By night: whatever a table's first mistake is, it ends on two ranks as the marked ones do by day.
TEST_P(FirstOnRanks, InOneLine) {
  const std::vector<Refusal> rows = table();
  if (!rows.front().on_two_ranks) try_refusal(rows.front(), By::ranks);
}

TEST(RefusedLaws, InOneLine) {
  for (const Refusal &refusal : law_refusals())
    if (!refusal.lammps || post::has_lammps()) try_refusal(refusal, By::copy);
}

INSTANTIATE_TEST_SUITE_P(, Refused, ::testing::ValuesIn(refusal_tables({"engine", "decks"})), name_of_table);
INSTANTIATE_TEST_SUITE_P(, RefusedOnRanks, ::testing::ValuesIn(refusal_tables({"engine", "decks"})),
                         name_of_table);
INSTANTIATE_TEST_SUITE_P(, FirstOnRanks, ::testing::ValuesIn(refusal_tables({"engine", "decks"})),
                         name_of_table);

// The tests above would pass for any mistake if the host deck itself failed: it runs, and writes.
TEST(RefusedHost, RunsWithoutAMistake) {
  const Scratch scratch;
  const EarlierRun earlier(scratch.path());
  write_host(host_pair_style() + host_properties(), outputs, scratch.path());
  const Outcome outcome = well(run_in_copy(host_deck, scratch.path()));
  EXPECT_FALSE(outcome.says("ERROR")) << outcome.output;
  for (const char *name : {"chain.csv", "events.csv", "cycles.csv"})
    EXPECT_FALSE(contains(read_text(scratch.path() / "out" / name), "earlier")) << name;
}

} // namespace
} // namespace drumlin::test
