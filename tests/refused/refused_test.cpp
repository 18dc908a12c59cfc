// What the plugin and its decks refuse, by the tables beside this file.
#include "tests/refused/engine_copy.h"
#include "tests/refused/refusals.h"
#include "tests/support/engine_runs.h"
#include "tests/support/run_folders.h"
#include "engine/deck_variables.h"

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

// What the plugin refuses: tables of mistakes, a file for each command or style and one for each deck of
// inputs, each mistake with the one line that the engine must print for it (tests/README.md).
namespace refused {

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
  void SetUp() override { SKIP_WITHOUT_LAMMPS(is_of_lammps(GetParam())); }
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

} // namespace refused

// What the decks of inputs refuse: variables by their rules, and damaged files of beds.
namespace refused_decks {

// The variables of each deck in inputs/: their names and the rules for their values, mostly read without an
// engine. The table engine/drumlin_check shows that each kind of rule refuses wrong values, the tables in
// decks/ that each deck applies its rules.
namespace decks {

const fs::path inputs = fs::path(DRUMLIN_SOURCE_DIR) / "inputs";

/// The decks of inputs, such as chain/in.chain, in the order of their names.
std::vector<std::string> decks() {
  std::vector<std::string> all;
  for (const char *room : {"benchmarks", "chain", "bed", "soil", "study"})
    for (const auto &entry : fs::directory_iterator(inputs / room))
      if (entry.path().filename().string().rfind("in.", 0) == 0)
        all.push_back(room + ("/" + entry.path().filename().string()));
  std::sort(all.begin(), all.end());
  return all;
}

/// A rule in which the folder of the decks, which differs between checkouts, is replaced by the word INPUTS.
std::string in_any_folder(std::string rule) {
  const std::string folder = inputs.string();
  if (const std::size_t at = rule.find(folder); at != std::string::npos)
    rule.replace(at, folder.size(), "INPUTS");
  return rule;
}

// `rules` has a line for each variable of each deck. DRUMLIN_REWRITE=1 writes it anew, and git shows the
// change.
TEST(RefusedDecks, VariablesHaveTheirRules) {
  std::string text = "# Each variable of each deck of inputs, and the rule of its value.\n";
  for (const std::string &deck : decks())
    if (deck.find(".lammps") == std::string::npos)
      for (const post::DeckVariable &variable : post::deck_variables(inputs / deck, {}))
        text += deck + " " + variable.name + " " + in_any_folder(variable.rule) + "\n";
  const fs::path file = fs::path(DRUMLIN_SOURCE_DIR) / "tests/refused/rules";
  if (std::getenv("DRUMLIN_REWRITE") != nullptr) write_text(file, text);
  EXPECT_EQ(read_text(file), text);
}

/// The names that an error of drumlin/variables lists behind "the nearest of".
std::set<std::string> names_in(const std::string &output) {
  const std::string mark = "the nearest of ";
  const std::size_t begin = output.find(mark);
  if (begin == std::string::npos) return {};
  std::istringstream list(
      output.substr(begin + mark.size(), output.find_first_of("(\n", begin) - begin - mark.size()));
  std::set<std::string> names;
  for (std::string name; list >> name;)
    names.insert(name.substr(0, name.find(',')));
  return names;
}

// A misspelt name is an error in every deck, LAMMPS's included; `drumlin run DECK --help`, which reads the
// deck without the engine, lists the same names as the engine.
TEST(RefusedDecks, KnowTheirVariables) {
  std::size_t known = 0;
  for (const std::string &name : decks()) {
    const fs::path deck = inputs / name;
    const bool lammps = deck.extension() == ".lammps";
    if (lammps && !post::has_lammps()) continue;
    const Scratch scratch;
    const Outcome outcome = lammps ? post::run_deck(deck, {{"stepz", "1"}}, scratch.path())
                                   : run_engine(deck, {"-var", "stepz", "1"}, scratch.path(), 1);
    ++known;
    EXPECT_TRUE(fails_with(outcome,
                           "ERROR: drumlin/variables: -var stepz is '1', a variable that this deck does "
                           "not have; allowed: "))
        << name;
    std::set<std::string> in_help;
    for (const post::DeckVariable &variable : post::deck_variables(deck, {}))
      in_help.insert(variable.name);
    EXPECT_EQ(in_help, names_in(outcome.output)) << name;
  }
  EXPECT_GE(known, 20u);
}

// A variable that a deck uses internally cannot be set on the command line either. Decks define such
// variables behind the first drumlin/variable. Before it one of another style than index would end the run
// with "Cannot redefine variable as a different style", which does not tell the name of the variable.
TEST(RefusedDecks, KeepTheirOwnVariables) {
  const std::vector<std::pair<const char *, std::vector<std::string>>> table = {
      {"bed/in.bed", {"rolls", "contact_k", "absorbing", "ground_rule", "in_lammps", "engine"}},
      {"chain/in.chain", {"roller_values", "drumlin_fault"}},
      {"benchmarks/in.spheres", {"m1", "rest", "step", "E2_over_E", "engine"}},
      {"soil/in.biaxial", {"test", "dimensions", "engine"}},
      {"soil/in.density", {"share", "packings", "in_lammps", "of_preparation"}},
      {"soil/in.oedometer", {"test", "mass", "pitch", "h", "flat", "softer", "loose"}},
      {"soil/in.repose", {"test", "files", "moved", "pull_x", "wall_friction", "rough"}},
      {"soil/in.shear", {"test", "dimensions"}},
      {"soil/in.silo", {"floor", "test_drag", "ended", "pull_y", "flat_radius"}},
      {"soil/in.triaxial", {"test", "balls"}},
      {"soil/in.wall", {"floor", "rough"}}};
  for (const auto &[deck, names] : table)
    for (const std::string &name : names) {
      const Scratch scratch;
      EXPECT_TRUE(fails_with(run_engine(inputs / deck, {"-var", name, "mud"}, scratch.path(), 1),
                             "ERROR: drumlin/variables: -var " + name +
                                 " is 'mud', a variable that this deck does not have; allowed: "))
          << deck << ' ' << name;
    }
}

/// The commands of a deck, without those of engine-specific syntax: start of the deck, contact law.
std::vector<std::string> without_engine_specific(const std::string &deck) {
  const std::set<std::string> own = {"plugin",      "atom_style", "communicate",
                                     "comm_modify", "pair_style", "pair_coeff"};
  std::vector<std::string> commands;
  std::string command;
  for (std::string line : lines_of(read_text(inputs / deck))) {
    line.erase(std::min(line.find('#'), line.size()));
    line.erase(line.find_last_not_of(' ') + 1);
    const bool continued = !line.empty() && line.back() == '&';
    command += line;
    if (continued) continue;
    std::istringstream words(std::exchange(command, ""));
    std::string first, id, group, style;
    words >> first >> id >> group >> style;
    if (!first.empty() && own.count(first) == 0 && style != "property/global")
      commands.push_back(words.str());
  }
  return commands;
}

// Decks that are complete for each engine differ in engine-specific syntax only.
TEST(RefusedDecks, OfBothEnginesDifferInEngineSpecificSyntaxOnly) {
  for (const std::string deck : {"chain/in.chain", "chain/in.way", "chain/in.impact"}) {
    const std::vector<std::string> commands = without_engine_specific(deck);
    EXPECT_GT(commands.size(), 30u) << deck;
    EXPECT_EQ(commands, without_engine_specific(deck + ".lammps")) << deck;
  }
}

// The engine's error->all() would use the text as a format, in which {} means an argument.
TEST(RefusedDecks, BracesStayAsTheyAreInLammps) {
  SKIP_WITHOUT_LAMMPS(true);
  const Scratch scratch;
  for (const auto &[deck, name] : {std::pair("chain/in.chain.lammps", "k"),
                                   {"chain/in.chain.lammps", "case"},
                                   {"bed/in.bed.lammps", "start"}})
    for (const std::string value : {"{}", "{0}", "{"}) {
      EXPECT_TRUE(fails_with(post::run_deck(inputs / deck, {{name, value}}, scratch.path()),
                             "ERROR: drumlin/variable: variable " + std::string(name) + " is '" + value +
                                 "'; allowed: "));
    }
}

} // namespace decks

// Damaged files given to the decks of the bed, as tests/tools/contracts/fuzz_test.cpp gives them to the
// tools: each deck ends within 200 s in a result or in one line of error, and leaves nothing half-written.
// The number of a damaged file is the seed of its faults.
namespace fuzz {

namespace fs = std::filesystem;

struct BedFile {
  const char *name;
  const char *deck;
  const char *variable; ///< that names the file
  int mutants;
  Variables more;
};

void PrintTo(const BedFile &file, std::ostream *out) { *out << file.name; }

class BedFuzz : public ::testing::TestWithParam<BedFile> {
protected:
  static constexpr const char *result = "result.restart";

  static Outcome run(const char *deck, const char *variable, const fs::path &file, const Variables &more,
                     const fs::path &folder) {
    const Variables variables = with(more, {{variable, file.string()}});
    return post::run_deck(fs::path(DRUMLIN_SOURCE_DIR) / "inputs/bed" / deck, variables, folder, 1, 200.0);
  }

  /// A settled bed of 30 balls, its data file and the bed with its roller, by the names of BedFile.
  static void make(const Scratch &folder) {
    well(post::run_program(tool_words("bed --balls 30 --width 0.3 --out data"), {}, folder.path(), 200.0));
    well(run("in.settle", "balls", folder / "data", given("case loose, bed soil, ratio 0.1"), folder.path()));
    well(run("in.place", "bed", folder / "soil", placing(), folder.path()));
    fs::rename(folder / result, folder / "roller");
  }
  static Variables placing() {
    return given("m2 50, m3 25, r2 0.06, r3 0.05, k23 5e4, c23 500, ratio 1, start {}, sink 0.1", result);
  }
};

TEST_P(BedFuzz, EndsInAResultOrInOneLine) {
  const Scratch sound;
  make(sound);
  const BedFile &file = GetParam();
  Variables more = file.more;
  if (std::string(file.deck) == "in.place") more = placing();
  int refused = 0;
  for (int mutant = 0; mutant < file.mutants; ++mutant) {
    const Scratch place;
    Choice choice(static_cast<unsigned>(mutant));
    write_text(place / file.name, damaged(read_text(sound / file.name), choice));
    const Outcome outcome = run(file.deck, file.variable, place / file.name, more, place.path());
    const std::vector<std::string> lines = lines_of(outcome.output);
    const auto errors = std::count_if(lines.begin(), lines.end(), [](const std::string &line) {
      return line.find("ERROR") != std::string::npos;
    });
    if (outcome.status != 0) ++refused;
    EXPECT_FALSE(outcome.timed_out) << mutant;
    EXPECT_TRUE(outcome.status == 0 || outcome.status == 1)
        << mutant << ": " << outcome.status << outcome.output;
    EXPECT_EQ(errors, outcome.status == 0 ? 0 : 1) << mutant << outcome.output;
    if (outcome.status == 0) continue;
    for (const auto &entry : fs::directory_iterator(place.path())) {
      const std::string name = entry.path().filename().string();
      EXPECT_TRUE(name == file.name || name == post::program_output_file) << mutant << " left " << name;
    }
  }
  EXPECT_GT(refused, file.mutants / 2);
}

INSTANTIATE_TEST_SUITE_P(
    Files, BedFuzz,
    ::testing::Values(BedFile{"data", "in.settle", "balls", 60, given("bed result.restart, ratio 1")},
                      BedFile{"soil", "in.place", "bed", 12, {}},
                      BedFile{"roller", "in.bed", "start", 12, given("cycles 1, Fw 500, balance 10")}),
    [](const ::testing::TestParamInfo<BedFile> &file) { return std::string(file.param.name); });

} // namespace fuzz

} // namespace refused_decks

} // namespace
} // namespace drumlin::test
