#include "commands/commands.h"

#include "bed/packing.h"
#include "commands/command.h"
#include "engine/engine_command.h"
#include "engine/deck_run.h"
#include "engine/places.h"
#include "support/csv.h"
#include "support/files.h"
#include "support/options.h"
#include "support/process.h"
#include "support/text.h"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <future>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// Cycles of a run of the chain: enough for the steady state, which the report judges by reference values.
constexpr int chain_cycles = 120;
constexpr int bed_cycles = 10, bed_balls = 1800;
/// Fewer balls would not keep the drum from the floor.
constexpr int least_demo_balls = 300;
/// The narrowest box, m: the drum is 0.7 m wide.
constexpr double least_width = 1.0;

constexpr const char *results_folder = "results/demo";
constexpr const char *report_folder = "report";
constexpr const char *commands_name = "commands.sh";

struct DemoArguments : Options {
  using Options::Options;
  Count cycles =
      count("--cycles", 1, 10'000'000,
            fmt::format("cycles of each run of chain and bed; {} and {} if not given. Below 100 the report "
                        "does not judge the chain by reference values",
                        chain_cycles, bed_cycles));
  Count balls = count(
      "--balls", least_demo_balls, PackingOptions::most_balls,
      fmt::format("soil balls of the bed, {} or more; {} if not given. The box gets narrower with fewer",
                  least_demo_balls, bed_balls));
};

enum class Kind {
  tool,
  run,               ///< of an engine
  run_with_progress, ///< the engine's own lines of progress are printed
  run_beside,        ///< on a second core, one after another, beside the steps below them
  tool_of_beside     ///< waits for the runs beside
};

/// A step of the demo: a command that a user can type.
struct Step {
  std::string name;               ///< empty: the command tells of itself
  std::vector<std::string> words; ///< of the command, behind `drumlin`
  Kind kind = Kind::tool;
  std::string printed = {}; ///< folder of what the engine of a run prints
};

/// All steps, in their order, as a user would type them.
std::vector<Step> steps_of(const DemoArguments &arguments, bool with_lammps) {
  const bool few_cycles = arguments.cycles.given(), drives = !few_cycles && !arguments.balls;
  const PackingOptions usual;
  const int balls = arguments.balls.value_or(bed_balls);
  const double width =
      std::max(least_width, usual.width * std::sqrt(static_cast<double>(balls) / usual.balls));
  std::vector<Step> steps;
  // {t} is a transition, {c} a case; the other names stand for what the demo's options change.
  const auto add = [&](Kind kind, const std::string &name, const std::string &command,
                       const std::string &printed = "", const char *t = "", const char *c = "") {
    const auto filled = [&](const std::string &text) {
      return fmt::format(fmt::runtime(text), fmt::arg("t", t), fmt::arg("c", c), //
                         fmt::arg("in", inputs_here().string()), fmt::arg("out", results_folder),
                         fmt::arg("cycles", arguments.cycles.value_or(chain_cycles)),
                         fmt::arg("bed_cycles", arguments.cycles.value_or(bed_cycles)),
                         fmt::arg("balls", balls), fmt::arg("width", number_text(width)),
                         fmt::arg("k_count", few_cycles ? 8 : 40), fmt::arg("D_count", few_cycles ? 5 : 25),
                         fmt::arg("quick", few_cycles ? "--quick" : ""), fmt::arg("page", report_folder));
    };
    Step &step = steps.emplace_back(Step{filled(name), {}, kind, filled(printed)});
    std::istringstream words(command);
    for (std::string word; words >> word;)
      if (const std::string value = filled(word); !value.empty()) step.words.push_back(value);
  };

  // The single impact and the four cases of the paper.
  for (const char *t : {"A", "B"}) {
    add(Kind::run, "impact, {t}", "run {in}/chain/in.impact -var out {out}/impact/{t} -var transition {t}",
        "{out}/impact/{t}", t);
    for (const char *c : {"I", "II", "III", "IV"}) {
      add(Kind::run, "chain, case {c}, {t}",
          "run {in}/chain/in.chain -var out {out}/chain/{c}-{t} -var case {c} -var transition {t} "
          "-var cycles {cycles}",
          "{out}/chain/{c}-{t}", t, c);
      if (with_lammps)
        add(Kind::run, "in LAMMPS",
            "run {in}/chain/in.chain.lammps -var out {out}/lammps/{c}-{t} -var case {c} -var transition {t} "
            "-var cycles {cycles}",
            "{out}/lammps/{c}-{t}", t, c);
    }
  }
  // A roller that drives over a loose lift, tipped moist, on dense soil, of grains 1.5 times as large as
  // those of case gravel. It takes minutes.
  if (drives) {
    add(Kind::tool, "",
        "bed --width 4.4 --radius-min 0.024 --radius-max 0.036 --layer 0.4 0.3 --relative-density 1.237 "
        "0.137 "
        "--out {out}/drive/balls.data");
    add(Kind::run_beside, "loose lift comes to rest",
        "run {in}/bed/in.settle -var balls {out}/drive/balls.data -var bed {out}/drive/soil.restart "
        "-var pour_tensile_strength 2e4",
        "{out}/drive/made/soil");
    add(Kind::run_beside, "roller comes to rest on it",
        "run {in}/bed/in.place -var bed {out}/drive/soil.restart -var start {out}/drive/roller.restart "
        "-var roller {in}/rollers/Axas2020 -var place -1.2 -var ratio 0.1",
        "{out}/drive/made/roller");
    add(Kind::run_beside, "roller drives",
        "run {in}/bed/in.drive -var start {out}/drive/roller.restart -var out {out}/drive/B "
        "-var roller {in}/rollers/Axas2020 -var balance 1 -var dumps_per_pass 25",
        "{out}/drive/B");
  }
  add(Kind::tool, "first pages of the report", "report {out}/impact {out}/chain --out {page}");
  // A bed of balls placed at random: it settles, the roller settles on it, and vibrates.
  add(Kind::tool, "", "bed --balls {balls} --width {width} --out {out}/bed/balls.data");
  add(Kind::run_with_progress, "bed comes to rest",
      "run {in}/bed/in.settle -var balls {out}/bed/balls.data -var bed {out}/bed/soil.restart",
      "{out}/bed/made/soil");
  add(Kind::run_with_progress, "roller comes to rest",
      "run {in}/bed/in.place -var bed {out}/bed/soil.restart -var start {out}/bed/roller.restart",
      "{out}/bed/made/roller");
  for (const char *t : {"A", "B"}) {
    add(Kind::run_with_progress, "bed, {bed_cycles} cycles, {t}",
        "run {in}/bed/in.bed -var start {out}/bed/roller.restart -var out {out}/bed/{t} -var transition {t} "
        "-var cycles {bed_cycles} -var dumps_per_cycle 10",
        "{out}/bed/{t}", t);
    add(Kind::tool, "", "vtk {out}/bed/{t}", "", t);
  }
  // The regimes of the paper's roller over stiffness and damping of the soil, and what its meter says.
  add(Kind::tool, "regimes of the roller",
      "map --x k:2e6:150e6:{k_count} --y D:0.02:0.6:{D_count} --out {out}/map");
  add(Kind::tool, "what the meter says of the soil", "study meter {quick} --out {out}/meter");
  if (drives) add(Kind::tool_of_beside, "roller over a lift", "passes {out}/drive/B");
  add(Kind::tool, "report", "report {out} --out {page}");
  return steps;
}

/// The commands as a script that a user can read, and run.
std::string script_of(const std::vector<Step> &steps) {
  std::string text = "# What the demo has run.\n";
  for (const Step &step : steps) {
    if (!step.name.empty()) text += fmt::format("\n# {}\n", step.name);
    text += front_command();
    for (const std::string &word : step.words)
      text += " " + shell_word(word);
    text += "\n";
  }
  return text;
}

/// Prints without delay. Throws std::runtime_error if the output cannot be written.
void print(const std::string &text) {
  errno = 0;
  if (std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0) return;
  throw std::runtime_error(errno == EPIPE ? "nobody reads its output any more, so it has stopped"
                                          : "standard output cannot be written; allowed: one that can");
}

class FailedRun : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Demo {
public:
  explicit Demo(std::vector<Step> steps) : steps_(std::move(steps)) {}
  Demo(const Demo &) = delete;
  Demo &operator=(const Demo &) = delete;
  ~Demo() { left_ = true; }

  void run() {
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const Step &step = steps_[i];
      print(fmt::format("[{:2}/{:2}] ", i + 1, steps_.size()));
      switch (step.kind) {
      case Kind::tool:
        if (!step.name.empty()) print(step.name + "\n");
        call(step.words);
        break;
      case Kind::run:
      case Kind::run_with_progress:
        print(fmt::format("{:<22}{}", step.name, step.kind == Kind::run ? "" : "\n"));
        told([&] { print(fmt::format(" {:5.1f} s\n", run_engine(step))); });
        break;
      case Kind::run_beside:
        print(fmt::format("{}, beside the steps below\n", step.name));
        if (!beside_.valid())
          beside_ = std::async(std::launch::async, [this, i] {
            for (std::size_t n = i; steps_[n].kind == Kind::run_beside; ++n)
              run_engine(steps_[n]);
          });
        break;
      case Kind::tool_of_beside:
        print(fmt::format("{:<22}", step.name));
        const auto begin = std::chrono::steady_clock::now();
        told([this] { beside_.get(); });
        print(fmt::format(" {:5.1f} s after the other runs\n", seconds_since(begin)));
        call(step.words);
      }
    }
  }

private:
  static double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

  /// Ends the line of a step that fails.
  template <class Work>
  static void told(const Work &work) {
    try {
      work();
    } catch (const FailedRun &) {
      print(" failed\n");
      throw;
    }
  }

  /// Its wall time, s. Throws FailedRun. Thread-safe.
  double run_engine(const Step &step) const {
    const fs::path out = step.printed;
    fs::create_directories(out);
    std::vector<std::string> words = step.words; // run DECK -var ...
    const fs::path deck = words[1];
    words[0] = "-log";
    words[1] = (out / "log.liggghts").string();
    const EngineCommand command = engine_command(deck, words, 1);
    Program program;
    program.words = command.words;
    program.environment = command.environment;
    program.output = out / program_output_file;
    program.own_group = false; // so that Ctrl-C ends it, too
    program.stop_when = [this](pid_t) { return left_.load(); };
    if (step.kind == Kind::run_with_progress)
      program.line = [](const std::string &line) {
        for (const char *start : {"drumlin/run:", "drumlin/settle:"})
          if (line.rfind(start, 0) == 0) print("        " + line + "\n");
      };
    const auto begin = std::chrono::steady_clock::now();
    const Outcome outcome = run_program(program);
    if (!outcome.ok()) {
      std::string why = engine_error(outcome.output);
      if (why.empty()) why = fmt::format("exit status {}", outcome.status);
      throw FailedRun(
          fmt::format("{} failed; its output is in {}: {}", step.name, program.output.string(), why));
    }
    return seconds_since(begin);
  }

  std::vector<Step> steps_;
  std::atomic<bool> left_ = false; ///< ends what runs beside the steps
  std::future<void> beside_;
};

void run(const DemoArguments &arguments) {
  if (const std::string fault = engine_fault(Engine::liggghts); !fault.empty()) throw UsageError(fault);
  if (::access(".", W_OK) != 0)
    throw UsageError(fmt::format(
        "results and report are written to the working folder '{}'; allowed: one that can be written",
        fs::current_path().string()));
  keep_apart({}, {{"the folder", results_folder, true},
                  {"the report", output_folder_option("report", report_folder), true}});
  std::signal(SIGPIPE, SIG_IGN); // print() reports a closed pipe
  bool with_lammps = engine_fault(Engine::lammps).empty();
  if (with_lammps)
    if (const std::string fault = lammps_package_fault(); !fault.empty()) {
      print(fmt::format("SKIPPED: the cases in LAMMPS: {}\n", fault));
      with_lammps = false;
    }
  const fs::path results = results_folder;
  fs::create_directories(results);
  const FolderLock lock = lock_output_folder(results, "the folder of results");
  for (const fs::directory_entry &entry : fs::directory_iterator(results))
    fs::remove_all(entry.path());
  const std::vector<Step> steps = steps_of(arguments, with_lammps);
  const bool drives = !arguments.cycles && !arguments.balls;
  print(fmt::format("Single impacts, the four cases of the paper, a bed of {} balls{}: {} steps, {}. Pages "
                    "of the chain can be opened when the first are made.\n",
                    arguments.balls.value_or(bed_balls), drives ? " and a roller that drives" : "",
                    steps.size(),
                    drives ? "some four minutes on two cores" : "a minute or less for short runs"));
  write_files({{results / commands_name, script_of(steps)}});
  Demo(steps).run();
  print(fmt::format("The report: {}\n", (fs::current_path() / report_folder / "index.html").string()));
  print(fmt::format("The bed, for ParaView: {0}/bed/A/vtk and {0}/bed/B/vtk, the .pvd files\n"
                    "The commands of these steps: {0}/{1}\n",
                    results_folder, commands_name));
}

} // namespace

void add_demo_command(CLI::App &app, Session &session) {
  add_command<DemoArguments>(
      app, session, "demo",
      "Runs the single impact, the four cases of the paper and a roller on a bed, under transition A and B; "
      "the cases in LAMMPS, too, if it is set up. Maps the roller's regimes and what its meter says of the "
      "soil. Without --cycles and --balls a roller also drives over a loose lift, twice. Writes results/demo "
      "and report in the working folder. Takes some four minutes on two cores.",
      run);
}

} // namespace drumlin::post
