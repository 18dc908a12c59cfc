#include "commands/commands.h"

#include "bed/relative_density.h"
#include "commands/bed.h"
#include "commands/map.h"
#include "commands/passes.h"
#include "commands/report.h"
#include "commands/text_options.h"
#include "commands/vtk.h"
#include "engine/engine_command.h"
#include "engine/engine_run.h"
#include "engine/places.h"
#include "experiment/study.h"
#include "map/meter_study.h"
#include "support/files.h"
#include "support/options.h"
#include "support/process.h"

#include <CLI/CLI.hpp>
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
#include <functional>
#include <future>
#include <memory>
#include <optional>
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
constexpr int most_cycles = 10'000'000;
/// Fewer balls would not keep the drum from the floor.
constexpr int least_balls = 300;
/// The narrowest box, m: the drum is 0.7 m wide.
constexpr double least_width = 1.0;

constexpr const char *results_folder = "results/demo";
constexpr const char *page_folder = "report";

struct Arguments {
  std::optional<std::string> cycles, balls;
};

struct Plan {
  int chain_cycles = post::chain_cycles;
  int bed_cycles = post::bed_cycles;
  bool quick = false; ///< few points of what needs no engine
  bool drives = true; ///< a roller that drives over a loose lift
  BedRequest bed;
};

Plan plan_of(const Arguments &arguments) {
  Plan plan;
  plan.quick = arguments.cycles.has_value();
  plan.drives = !arguments.cycles && !arguments.balls;
  if (arguments.cycles)
    plan.chain_cycles = plan.bed_cycles = count_option("--cycles", *arguments.cycles, 1, most_cycles);
  PackingOptions &packing = plan.bed.packing;
  const int of_usual_width = packing.balls;
  packing.balls = bed_balls;
  if (arguments.balls)
    packing.balls = count_option("--balls", *arguments.balls, least_balls, PackingOptions::most_balls);
  packing.width =
      std::max(least_width, packing.width * std::sqrt(static_cast<double>(packing.balls) / of_usual_width));
  return plan;
}

/// Prints without delay. Throws std::runtime_error if the output cannot be written.
void print(const std::string &text) {
  errno = 0;
  if (std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0) return;
  throw std::runtime_error(errno == EPIPE ? "nobody reads its output any more, so it has stopped"
                                          : "standard output cannot be written; allowed: one that can");
}

/// One run of an engine.
struct DemoRun {
  std::string name;
  fs::path out; ///< folder of what the engine prints
  fs::path deck;
  Variables variables;
  bool shows_progress = false; ///< the engine's own lines of progress are printed
};

class FailedRun : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The demo: steps that are planned first, so that each can tell how many there are.
class Demo {
public:
  Demo(Plan plan, fs::path decks, bool with_lammps)
      : plan_(std::move(plan)), decks_(std::move(decks)), with_lammps_(with_lammps) {}
  Demo(const Demo &) = delete;
  Demo &operator=(const Demo &) = delete;
  ~Demo() { left_ = true; }

  void run() {
    fs::create_directories(results_);
    const FolderLock lock = lock_output_folder(results_, "the folder of results");
    for (const fs::directory_entry &entry : fs::directory_iterator(results_))
      fs::remove_all(entry.path());
    for (const char *transition : {"A", "B"}) {
      plan_impact(transition);
      for (const char *chain_case : {"I", "II", "III", "IV"})
        plan_chain(chain_case, transition);
    }
    if (plan_.drives) plan_drive();
    step("first pages of the report\n", [this] {
      print_report({{(results_ / "impact").string(), (results_ / "chain").string()}, page_folder});
    });
    plan_settling();
    for (const char *transition : {"A", "B"})
      plan_bed_run(transition);
    step("regimes of the roller\n", [this] { map_regimes(); });
    step("what the meter says of the soil\n", [this] { study_meter(); });
    if (plan_.drives) step(fmt::format("{:<22}", "roller over a lift"), [this] { wait_for_drive(); });
    step("report\n", [] { print_report({{results_folder}, page_folder}); });
    print(fmt::format("Single impacts, the four cases of the paper, a bed of {} balls{}: {} steps, {}. Pages "
                      "of the chain can be opened when the first are made.\n",
                      plan_.bed.packing.balls, plan_.drives ? " and a roller that drives" : "", steps_.size(),
                      plan_.drives ? "some four minutes on two cores" : "a minute or less for short runs"));
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      print(fmt::format("[{:2}/{:2}] {}", i + 1, steps_.size(), steps_[i].words));
      steps_[i].make();
    }
    print(fmt::format("The report: {}\n", (fs::current_path() / page_folder / "index.html").string()));
    print(fmt::format("The bed, for ParaView: {} and {}, the .pvd files\n", (bed_ / "A/vtk").string(),
                      (bed_ / "B/vtk").string()));
  }

private:
  struct Step {
    std::string words; ///< that are printed before it
    std::function<void()> make;
  };

  void step(std::string words, std::function<void()> make) {
    steps_.push_back({std::move(words), std::move(make)});
  }

  void engine_step(
      const DemoRun &run, const std::function<void()> &then = [] {}) {
    step(fmt::format("{:<22}{}", run.name, run.shows_progress ? "\n" : ""), [this, run, then] {
      engine_run(run);
      then();
    });
  }

  void plan_impact(const std::string &transition) {
    const fs::path out = results_ / "impact" / transition;
    engine_step({"impact, " + transition,
                 out,
                 decks_ / "chain/in.impact",
                 {{"out", out.string()}, {"transition", transition}}});
  }

  void plan_chain(const std::string &chain_case, const std::string &transition) {
    const std::string folder = chain_case + "-" + transition;
    const auto variables = [&](const fs::path &out) {
      return Variables{{"out", out.string()},
                       {"case", chain_case},
                       {"transition", transition},
                       {"cycles", std::to_string(plan_.chain_cycles)}};
    };
    fs::path out = results_ / "chain" / folder;
    engine_step({fmt::format("chain, case {}, {}", chain_case, transition), out, decks_ / "chain/in.chain",
                 variables(out)});
    if (!with_lammps_) return;
    out = results_ / "lammps" / folder;
    engine_step({"in LAMMPS", out, decks_ / "chain/in.chain.lammps", variables(out)});
  }

  /// Makes a bed of balls placed at random, lets it settle, and lets the roller settle on it.
  void plan_settling() {
    plan_.bed.out = bed_ / "balls.data";
    step("", [this] { write_bed(plan_.bed); });
    const std::string soil = (bed_ / "soil.restart").string();
    engine_step({"bed comes to rest",
                 bed_ / "made/soil",
                 decks_ / "bed/in.settle",
                 {{"balls", plan_.bed.out.string()}, {"bed", soil}},
                 true});
    engine_step({"roller comes to rest",
                 bed_ / "made/roller",
                 decks_ / "bed/in.place",
                 {{"bed", soil}, {"start", start_.string()}},
                 true});
  }

  void plan_bed_run(const std::string &transition) {
    const fs::path out = bed_ / transition;
    Variables variables = {{"start", start_.string()}, {"out", out.string()}, {"transition", transition}};
    if (plan_.bed_cycles != bed_cycles) variables.emplace_back("cycles", std::to_string(plan_.bed_cycles));
    variables.emplace_back("dumps_per_cycle", "10");
    const std::string cycles = plan_.bed_cycles == bed_cycles ? "ten" : std::to_string(plan_.bed_cycles);
    engine_step(
        {fmt::format("bed, {} cycles, {}", cycles, transition), out, decks_ / "bed/in.bed", variables, true},
        [out] {
          write_vtk_series({out.string(), {}, {}});
        });
  }

  /// The regimes of the paper's roller over stiffness and damping of the soil.
  void map_regimes() {
    MapArguments map;
    map.x = plan_.quick ? "k:2e6:150e6:8" : "k:2e6:150e6:40";
    map.y = plan_.quick ? "D:0.02:0.6:5" : "D:0.02:0.6:25";
    map.out = (results_ / "map").string();
    print_map(map);
  }

  /// A roller that drives over a loose lift, tipped moist, on dense soil. The runs take minutes: they go on
  /// on a second core beside the bed's, and the last step waits for them.
  void plan_drive() {
    step("", [this] {
      BedRequest bed;
      bed.out = lift_ / "balls.data";
      bed.packing.width = 4.4;
      bed.packing.radius_min = 0.024; // 1.5 times those of the gravel, whose packings are of any scale
      bed.packing.radius_max = 0.036;
      const MeasuredPackings packings = read_packings(decks_ / "bed/packings.gravel.csv");
      for (const auto &[thickness, relative_density] : {std::pair{0.4, 0.9}, std::pair{0.3, 0.1}}) {
        BedLayer layer{bed.packing, thickness, packings.pouring(relative_density)};
        layer.packing.balls = balls_of(layer);
        bed.layers.push_back({layer, {}});
      }
      write_bed(bed);
      drive_ = std::async(std::launch::async, [this] { drive_over_lift(); });
    });
  }

  void drive_over_lift() {
    const std::string soil = (lift_ / "soil.restart").string(), start = (lift_ / "roller.restart").string(),
                      roller = (decks_ / "rollers/Axas2020").string();
    run_engine(
        {"loose lift comes to rest",
         lift_ / "made/soil",
         decks_ / "bed/in.settle",
         {{"balls", (lift_ / "balls.data").string()}, {"bed", soil}, {"pour_tensile_strength", "2e4"}}});
    run_engine({"roller comes to rest on it",
                lift_ / "made/roller",
                decks_ / "bed/in.place",
                {{"bed", soil}, {"start", start}, {"roller", roller}, {"place", "-1.2"}, {"ratio", "0.1"}}});
    run_engine({"roller drives",
                lift_ / "B",
                decks_ / "bed/in.drive",
                {{"start", start},
                 {"out", (lift_ / "B").string()},
                 {"roller", roller},
                 {"balance", "1"},
                 {"dumps_per_pass", "25"}}});
  }

  void wait_for_drive() {
    const auto begin = std::chrono::steady_clock::now();
    try {
      drive_.get();
    } catch (const FailedRun &) {
      print(" failed\n");
      throw;
    }
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    print(fmt::format(" {:5.1f} s after the other runs\n", time.count()));
    PassesArguments passes;
    passes.folders = {(lift_ / "B").string()};
    print_passes(passes);
  }

  void study_meter() {
    StudyOptions study;
    study.out = results_ / "meter";
    study.quick = plan_.quick;
    const ResumedFolder folder = open_study(study);
    run_meter_study(study.out, study.quick);
  }

  void engine_run(const DemoRun &run) const {
    try {
      print(fmt::format(" {:5.1f} s\n", run_engine(run)));
    } catch (const FailedRun &) {
      print(" failed\n");
      throw;
    }
  }

  /// Its wall time, s. Throws FailedRun. Thread-safe.
  double run_engine(const DemoRun &run) const {
    fs::create_directories(run.out);
    std::vector<std::string> words = {"-log", (run.out / "log.liggghts").string()};
    for (const auto &[name, value] : run.variables)
      words.insert(words.end(), {"-var", name, value});
    const EngineCommand command = engine_command(run.deck, words, 1);
    Program program;
    program.words = command.words;
    program.environment = command.environment;
    program.output = run.out / program_output_file;
    program.own_group = false; // so that Ctrl-C ends it, too
    program.stop_when = [this](pid_t) { return left_.load(); };
    if (run.shows_progress)
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
          fmt::format("{} failed; its output is in {}: {}", run.name, program.output.string(), why));
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

  const fs::path results_ = results_folder, bed_ = results_ / "bed", start_ = bed_ / "roller.restart",
                 lift_ = results_ / "drive";
  Plan plan_;
  fs::path decks_;
  bool with_lammps_;
  std::vector<Step> steps_;
  std::atomic<bool> left_ = false; ///< ends what runs beside the steps
  std::future<void> drive_;
};

void run(const Arguments &arguments) {
  const Plan plan = plan_of(arguments);
  if (const std::string fault = engine_fault(Engine::liggghts); !fault.empty()) throw UsageError(fault);
  if (::access(".", W_OK) != 0)
    throw UsageError(fmt::format(
        "results and report are written to the working folder '{}'; allowed: one that can be written",
        fs::current_path().string()));
  keep_apart({}, {{"the folder", results_folder, true},
                  {"the report", output_folder_option("report", page_folder), true}});
  std::signal(SIGPIPE, SIG_IGN); // print() reports a closed pipe
  bool with_lammps = engine_fault(Engine::lammps).empty();
  if (with_lammps)
    if (const std::string fault = lammps_package_fault(); !fault.empty()) {
      print(fmt::format("SKIPPED: the cases in LAMMPS: {}\n", fault));
      with_lammps = false;
    }
  Demo(plan, inputs_here(), with_lammps).run();
}

} // namespace

void add_demo_command(CLI::App &app, Session &) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App *demo = app.add_subcommand(
      "demo",
      "Runs the single impact, the four cases of the paper and a roller on a bed, under transition A and B; "
      "the cases in LAMMPS, too, if it is set up. Maps the roller's regimes and what its meter says of the "
      "soil. Without --cycles and --balls a roller also drives over a loose lift, twice. Writes results/demo "
      "and report in the working folder. Takes some four minutes on two cores.");
  text_option(demo, "--cycles", "COUNT", arguments->cycles,
              fmt::format("cycles of each run of chain and bed; {} and {} if not given. Below 100 the report "
                          "does not judge the chain by reference values",
                          chain_cycles, bed_cycles));
  text_option(
      demo, "--balls", "COUNT", arguments->balls,
      fmt::format("soil balls of the bed, {} or more; {} if not given. The box gets narrower with fewer",
                  least_balls, bed_balls));
  demo->callback([arguments] { run(*arguments); });
}

} // namespace drumlin::post
