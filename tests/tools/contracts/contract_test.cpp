// What every command that writes results keeps to, as a table of commands: results are replaced as a whole or
// continued, another call that writes there is waited for by nobody, a folder of something else is not
// touched, and a full disk, a signal and a kill leave no half results.
//
// Commands that continue are killed at random times, three times each; the environment variable DRUMLIN_KILLS
// asks for another number, and DRUMLIN_SEED for the times of an earlier run, which has printed it.
#include "tests/support/engine_runs.h"
#include "tests/support/run_folders.h"
#include "engine/places.h"
#include "support/process.h"

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

int kills() {
  const char *wanted = std::getenv("DRUMLIN_KILLS");
  return wanted == nullptr ? 3 : std::atoi(wanted);
}

/// All files below a folder by their names, without what differs from call to call: dates, and names of
/// temporary folders.
std::map<std::string, std::string> content(const fs::path &folder) {
  static const std::regex varies("[0-9]{4}-[0-9]{2}-[0-9]{2} [0-9]{2}:[0-9]{2} UTC|" +
                                 fs::temp_directory_path().string() + "/[^,\\s]*");
  std::map<std::string, std::string> files;
  for (const fs::directory_entry &entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    files[name] =
        entry.is_directory() ? "folder" : std::regex_replace(read_text(entry.path()), varies, "VARIES");
  }
  return files;
}

/// A table's text without the column of processor times.
std::string without_times(const std::string &table) {
  const std::size_t column = [&] {
    const std::string header = table.substr(0, table.find('\n'));
    const std::size_t place = header.find("cost");
    return static_cast<std::size_t>(
        std::count(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(place), ','));
  }();
  std::string text;
  std::size_t cell = 0;
  for (const char letter : table) {
    if (letter == ',' || letter == '\n') cell = letter == ',' ? cell + 1 : 0;
    if (cell != column || letter == ',') text += letter;
  }
  return text;
}

/// Calls a command without interruption in the folder `whole` of a scratch folder, then, with each of `more`
/// words, in others, where it is killed at random times until it ends by itself; as often as kills() says.
/// `compare` gets the folders of `--out` of the two.
template <class Compare>
void kill_and_resume(const std::vector<std::string> &words, const Compare &compare,
                     const std::vector<std::vector<std::string>> &more = {{}}) {
  const Scratch scratch;
  post::Program program;
  const auto call = [&](const std::string &folder, double limit, int signal,
                        const std::vector<std::string> &further) {
    program.words = {DRUMLIN_TOOLS};
    for (const std::vector<std::string> &part : {words, further})
      program.words.insert(program.words.end(), part.begin(), part.end());
    fs::create_directory(scratch / folder);
    program.folder = scratch / folder;
    program.output = scratch / (folder + ".txt");
    program.limit = limit;
    program.stop_signal = signal;
    return run_program(program);
  };
  const auto begin = std::chrono::steady_clock::now();
  well(call("whole", 600.0, SIGKILL, more.front()));
  const double length = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const char *wanted = std::getenv("DRUMLIN_SEED");
  const unsigned long seed = wanted == nullptr ? std::random_device{}() : std::stoul(wanted);
  fmt::print("DRUMLIN_SEED={}\n", seed);
  std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
  int folders = 0;
  for (const std::vector<std::string> &further : more)
    for (int killed = 0; killed < kills() && !testing::Test::HasFailure();) {
      const std::string folder = fmt::format("killed-{}", ++folders);
      for (int times = 1;; ++times) {
        const double limit = std::uniform_real_distribution<double>(0.0, length / 3.0)(random);
        const Outcome outcome = call(folder, killed < kills() && times < 20 ? limit : 600.0,
                                     killed % 2 == 0 ? SIGKILL : SIGTERM, further);
        if (!outcome.timed_out) {
          well(outcome);
          break;
        }
        ++killed;
      }
      compare(scratch / "whole/out", scratch / folder / "out");
      EXPECT_EQ(content(scratch / folder).count("out"), 1U);
      for (const fs::directory_entry &entry : fs::directory_iterator(scratch / folder))
        EXPECT_EQ(entry.path().filename(), "out");
    }
  fmt::print("at least {} kills of each in {} folders\n", kills(), folders);
}

void expect_same(const fs::path &whole, const fs::path &resumed) {
  const auto expected = content(whole), found = content(resumed);
  for (const auto &[name, text] : expected)
    EXPECT_TRUE(found.count(name) == 1 && found.at(name) == text)
        << name << (found.count(name) == 1 ? " differs" : " is missing");
  for (const auto &[name, text] : found)
    EXPECT_EQ(expected.count(name), 1U) << name;
}

enum class Results {
  folder, ///< a folder that is replaced as a whole
  files,  ///< files of a folder that may have others
  rows    ///< a folder whose rows are continued
};

/// A command, called in a folder that has `run`, made by `drumlin exact`, and `bed`, a bed run with dumps.
/// Its results are in `out` or, where that is a file, beside it.
struct Command {
  const char *name, *words;
  Results results;
};

constexpr Command commands[] = {
    {"exact", "exact --cycles 30 --out out", Results::files},
    {"vtk", "vtk bed --out out", Results::files},
    {"report", "report run --out out", Results::folder},
    {"meter", "meter run --out out", Results::folder},
    {"identify", "identify run --out out", Results::folder},
    {"map", "map --x k:5e6:40e6:40 --y D:0.1:0.5:30 --out out", Results::rows},
    {"map_of_the_meter", "map --x k:5e6:150e6:80 --identify 4 --out out", Results::rows},
    {"study_of_the_meter", "study meter --quick --out out", Results::rows},
};

void PrintTo(const Command &command, std::ostream *out) { *out << command.name; }

std::string name_of(const ::testing::TestParamInfo<Command> &command) { return command.param.name; }

class Contract : public ::testing::TestWithParam<Command> {
protected:
  static void SetUpTestSuite() {
    made_ = std::make_unique<Scratch>();
    well(run_program(tool_words("exact --cycles 30 --out run"), {}, made_->path()));
    write_bed_run(*made_ / "bed", post::Transition::B);
    write_bed_dumps(*made_ / "bed");
    fs::remove(*made_ / post::program_output_file);
  }
  static void TearDownTestSuite() { made_.reset(); }

  Contract() { fs::copy(made_->path(), folder_, fs::copy_options::recursive); }

  std::vector<std::string> words() const {
    std::vector<std::string> all = words_of(GetParam().words);
    all.insert(all.begin(), DRUMLIN_TOOLS);
    return all;
  }
  post::Program program() const {
    post::Program program;
    program.words = words();
    program.folder = folder_;
    program.output = scratch_ / "screen.txt";
    return program;
  }
  Outcome call() const { return run_program(program()); }
  bool is(Results results) const { return GetParam().results == results; }
  /// The one line of error of a call that has failed; what it has printed besides may stand around it.
  static std::string error_in(const std::string &output) {
    std::string error;
    for (const std::string &line : lines_of(output))
      if (line.rfind("ERROR: drumlin ", 0) == 0) error += line;
    EXPECT_EQ(error.find("ERROR: ", 1), std::string::npos) << output;
    return error;
  }
  static void expect_refused(const Outcome &outcome, const Texts &says) {
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(contains(error_in(outcome.output), says));
  }
  /// Nothing but what was there before the call, and its results.
  void expect_no_leavings() const {
    for (const fs::directory_entry &entry : fs::recursive_directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      EXPECT_TRUE(name.front() != '.' && name.rfind("unfinished.", 0) != 0) << entry.path();
    }
  }

  /// Whether the call that runs has made a file or folder by now.
  bool has_begun() const {
    for (const fs::directory_entry &entry : fs::directory_iterator(folder_))
      if (!fs::exists(made_->path() / entry.path().filename())) return true;
    return false;
  }

  /// Whether the process has locked something: between making a folder and locking it nobody is refused.
  static bool holds_a_lock(pid_t tool) {
    std::error_code ignored; // files are closed meanwhile
    for (const fs::directory_entry &file :
         fs::directory_iterator(fmt::format("/proc/{}/fdinfo", tool), ignored)) {
      std::ifstream in(file.path());
      for (std::string line; std::getline(in, line);)
        if (line.rfind("lock:", 0) == 0) return true;
    }
    return false;
  }

  static std::unique_ptr<Scratch> made_;
  const Scratch scratch_;
  const fs::path folder_ = scratch_ / "folder";
};
std::unique_ptr<Scratch> Contract::made_;

// The second call gives the same again; of a folder that is replaced nothing is left of the first.
TEST_P(Contract, CalledAgainItGivesTheSame) {
  well(call());
  const auto first = content(folder_ / "out");
  if (is(Results::folder)) post::write_files({{folder_ / "out/data/stale.csv", "of an earlier call"}});
  well(call());
  EXPECT_TRUE(content(folder_ / "out") == first);
  expect_no_leavings();
}

TEST_P(Contract, AFolderOfSomethingElseIsKept) {
  fs::create_directory(folder_ / "out");
  post::write_files({{folder_ / "out/thesis.txt", "years\n"}});
  const Outcome outcome = call();
  if (is(Results::files))
    well(outcome);
  else
    expect_refused(outcome, {"--out is 'out'", "; allowed: a "});
  EXPECT_EQ(read_text(folder_ / "out/thesis.txt"), "years\n");
  expect_no_leavings();
}

// The first call is stopped as soon as it holds a folder of its own, and goes on when the second one has
// ended. Commands that write files are done before they can be stopped.
TEST_P(Contract, OneCallWritesAtATime) {
  if (is(Results::files)) return;
  bool tried = false;
  post::Program first = program();
  first.stop_when = [&](pid_t tool) {
    if (tried || !has_begun() || !holds_a_lock(tool)) return false;
    tried = true;
    ::kill(tool, SIGSTOP);
    post::Program second = program();
    second.output = scratch_ / "second.txt";
    expect_refused(run_program(second), "into which another call writes; allowed: another folder");
    ::kill(tool, SIGCONT);
    return false;
  };
  well(run_program(first));
  EXPECT_TRUE(tried);
  EXPECT_FALSE(content(folder_ / "out").empty());
  expect_no_leavings();
}

// A full disk is imitated by a limit on the size of files. What the command prints goes through `cat`, which
// has no such limit.
TEST_P(Contract, OnAFullDiskItIsAnErrorAndEarlierResultsStay) {
  if (!is(Results::rows)) well(call());
  const auto before = content(folder_);
  const std::string limited = fmt::format("(trap '' XFSZ; ulimit -f 1; '{}' {} || echo status $?) 2>&1 | cat",
                                          DRUMLIN_TOOLS, GetParam().words);
  post::Program full = program();
  full.words = {"sh", "-c", limited};
  const std::string printed = run_program(full).output;
  EXPECT_NE(error_in(printed), "");
  EXPECT_EQ(printed.substr(printed.rfind("status ")).size(), 9U) << printed; // of one digit
  EXPECT_TRUE(is(Results::rows) || content(folder_) == before);
  expect_no_leavings();
  well(call());
}

// Ctrl-C, or what a scheduler sends: no temporary folder stays beside the results.
TEST_P(Contract, ASignalLeavesNoHalfResults) {
  if (!is(Results::folder)) return; // rows are killed and continued
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    SCOPED_TRACE(signal);
    post::Program stopped = program();
    stopped.stop_signal = signal;
    bool begun = false;
    stopped.stop_when = [&](pid_t) { return begun = has_begun(); };
    const Outcome outcome = run_program(stopped);
    EXPECT_TRUE(begun);
    EXPECT_EQ(outcome.status, 128 + signal) << outcome.output;
    EXPECT_FALSE(has_begun());
  }
}

INSTANTIATE_TEST_SUITE_P(, Contract, ::testing::ValuesIn(commands), name_of);

class KilledAndCalledAgain : public ::testing::TestWithParam<Command> {};

TEST_P(KilledAndCalledAgain, ItIsTheSame) { kill_and_resume(words_of(GetParam().words), expect_same); }

INSTANTIATE_TEST_SUITE_P(, KilledAndCalledAgain,
                         ::testing::ValuesIn(std::begin(commands) + 5, std::end(commands)), name_of);

TEST(KilledStudyOfBeds, IsTheSame) {
  kill_and_resume({"study", "box", "--quick", "--out", "out"},
                  [](const fs::path &whole, const fs::path &resumed) {
                    EXPECT_EQ(without_times(read_text(resumed / "runs.csv")),
                              without_times(read_text(whole / "runs.csv")));
                    const auto expected = content(whole), found = content(resumed);
                    for (const auto &[name, text] : expected)
                      EXPECT_EQ(found.count(name), 1U) << name;
                    EXPECT_EQ(found.size(), expected.size());
                  },
                  {{"--jobs", "1"}, {"--jobs", "2"}});
}

/// A calibration on beds of 60 discs under a small roller, which takes some ten seconds.
const std::vector<std::string> small_calibration =
    words_of("calibrate --target k=1e6 --vary k=2e6:2e7 --seeds 3 --balls 60 --cycles 4 --evaluations 3 "
             "--jobs 2 --out out --set m2=100 --set m3=50 --set r2=0.1 --set r3=0.05 --set k23=5e4 --set "
             "c23=500 --set Fw=2940");

TEST(KilledCalibration, IsTheSame) { kill_and_resume(small_calibration, expect_same); }

/// The processes that a process has started.
std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> children;
  std::error_code ignored; // a thread can end meanwhile
  for (const fs::directory_entry &thread :
       fs::directory_iterator(fmt::format("/proc/{}/task", parent), ignored)) {
    std::ifstream in(thread.path() / "children");
    for (pid_t child = 0; in >> child;)
      children.push_back(child);
  }
  return children;
}

// What ends an engine from outside is no property of the scene: the calibration ends, too, in one line, and
// continues.
TEST(KilledEngine, EndsACalibrationThatContinues) {
  const Scratch scratch;
  std::vector<std::string> words = small_calibration;
  words.insert(words.begin(), DRUMLIN_TOOLS);
  const auto call = [&](const std::string &folder, const post::StopCondition &asked) {
    fs::create_directory(scratch / folder);
    return run_program(words, {}, scratch / folder, 300.0, asked);
  };
  const auto rows = [&](const std::string &folder) {
    const fs::path file = scratch / folder / "out/evaluations.csv";
    return fs::exists(file) ? read_text(file) : "";
  };
  well(call("whole", {}));
  for (const int signal : {SIGKILL, SIGTERM}) {
    const std::string folder = fmt::format("signal-{}", signal);
    bool sent = false;
    const Outcome killed = call(folder, [&](pid_t tool) {
      const std::string text = rows(folder);
      // Two beds of the first point. More than once: an engine that has just ended takes a signal, too.
      if (std::count(text.begin(), text.end(), '\n') == 3)
        for (const pid_t engine : children_of(tool))
          sent = ::kill(engine, signal) == 0 || sent;
      return false;
    });
    ASSERT_TRUE(sent);
    EXPECT_EQ(killed.status, 1) << killed.output;
    const std::size_t error = killed.output.rfind("ERROR: drumlin calibrate: bed/in.");
    ASSERT_NE(error, std::string::npos) << killed.output;
    EXPECT_EQ(killed.output.find('\n', error) + 1, killed.output.size());
    std::istringstream lines(rows(folder)); // no failure among them
    for (std::string line; std::getline(lines, line);)
      EXPECT_TRUE(contains(rows("whole"), line + '\n')) << line;
    well(call(folder, {}));
    expect_same(scratch / "whole/out", scratch / folder / "out");
  }
}

TEST(KilledReport, IsTheSame) {
  const Scratch scratch;
  well(run_program(tool_words("exact --cycles 30 --out run"), {}, scratch.path()));
  const std::string run = (scratch / "run").string();
  kill_and_resume({"report", run, "--out", "out"}, expect_same);
}

// In an installation the decks are in a folder that a user cannot write: the case file goes into a copy of
// theirs.
TEST(CaseFile, GoesIntoACopyOfInstalledDecks) {
  const Scratch scratch;
  post::write_files(
      {{scratch / "places",
        fmt::format("inputs={}\nliggghts_plugin={}\nliggghts={}\ninstalled=yes\n",
                    post::places().inputs.string(), post::plugin_library(), post::places().liggghts)}});
  std::vector<std::string> words = small_calibration;
  words.insert(words.begin(), DRUMLIN_TOOLS);
  *(std::find(words.begin(), words.end(), "--evaluations") + 1) = "1";
  const Outcome outcome =
      well(run_program(words, {"DRUMLIN_PLACES=" + (scratch / "places").string()}, scratch.path(), 300.0));
  const std::string command = fmt::format(
      "\n  cp -r {} . && cp out/case.calibrated inputs/bed && drumlin run ", post::places().inputs.string());
  ASSERT_TRUE(outcome.says(command)) << outcome.output;
  // The line is followed as far as the copies.
  well(run_program({"sh", "-c", command.substr(0, command.rfind(" && "))}, {}, scratch.path()));
  EXPECT_TRUE(fs::is_regular_file(scratch / "inputs/bed/case.calibrated"));
  EXPECT_TRUE(fs::is_regular_file(scratch / "inputs/bed/in.settle"));
}

} // namespace
} // namespace drumlin::test
