#include "commands/commands.h"

#include "commands/command.h"
#include "engine/deck_run.h"
#include "engine/engine_command.h"
#include "experiment/results.h"
#include "experiment/runner.h"
#include "experiment/study.h"
#include "map/map_results.h"
#include "support/files.h"
#include "support/options.h"
#include "support/usage_error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <unistd.h>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// Runs at the same time, each a process of its own.
constexpr int most_jobs = 1000;
/// Least number of balls of a scaled bed: the drum of a smaller one would have hardly any below it.
constexpr int least_balls = 100;
constexpr int most_balls = 1000000;

struct StudyArguments : Options {
  explicit StudyArguments(Command &of) : Options(of) { not_with(page_only, {&part}); }
  Text name = text("NAME", "TEXT",
                   "one of the studies below, or the file of a plan of your own (inputs/study/plans.md)");
  ResultPath out = result_folder("--out", "folder of the results; if not given, results/study/NAME");
  Count jobs = count("--jobs", 1, most_jobs, "of a plan: runs at the same time, one processor each");
  Count balls = count(
      "--balls", least_balls, most_balls,
      "of a plan of beds: balls of its first scene; box and roller are scaled with their root, the balls "
      "are not");
  Text part =
      text("--part", "K/N",
           "of a plan: every N-th run alone, beginning with the K-th, for a job of its own; a call without "
           "it takes over what all parts have made, makes what is missing, and writes the page");
  Flag page_only =
      flag("--page-only", "of a plan: makes no run; tells which are missing, and writes the page");
  Flag keep =
      flag("--keep", "of a plan: keep all files of the runs that this call makes, in runs/SCENE/SEED of the "
                     "results");
  Flag fresh = flag("--fresh", "forget the points of an earlier call");
  Flag quick = flag("--quick", "few points: to see that it works");
};

/// The studies that are no plans, in the order of the help.
std::vector<Study> other_studies() {
  return {
      {"meter",
       "What the meters of rollers show on soil of 1 to 200 MN/m, where a value may mean several "
       "stiffnesses, and what identification finds in the same records. Half a minute, without an engine.",
       [](const StudyOptions &options) { run_meter_study(options.out, options.quick); }}};
}

/// Names of the plans of the project.
std::set<std::string> plan_names() {
  std::set<std::string> names;
  for (const fs::directory_entry &entry : fs::directory_iterator(input_file("study")))
    if (fs::is_regular_file(entry.path() / plan_name)) names.insert(entry.path().filename().string());
  return names;
}

/// The file of a plan of the project by its name, or of a user's own.
fs::path plan_file(const std::string &name) {
  std::set<std::string> names = plan_names();
  if (names.count(name) > 0) return input_file("study") / name / plan_name;
  std::error_code ignored; // of a name that is too long
  if (fs::is_regular_file(name, ignored) && ::access(name.c_str(), R_OK) == 0) return name;
  if (name == "cost" || name == "speed")
    throw UsageError(refusal("NAME", name, "timing, which measures both"));
  for (const Study &study : other_studies())
    names.insert(study.name);
  throw UsageError(refusal(
      "NAME", name, fmt::format("{}, or the file of a plan that can be read", fmt::join(names, ", "))));
}

/// The name of a study: that of its plan's file or, of inputs/study/NAME/plan, of its folder.
std::string study_name(const fs::path &file) {
  const fs::path whole = fs::absolute(file);
  return whole.filename() == plan_name ? whole.parent_path().filename().string() : whole.stem().string();
}

/// The decks of a plan's scenes, those that make their beds included.
std::set<fs::path> decks_of(const Plan &plan) {
  std::set<fs::path> decks;
  for (const Scene &scene : plan.scenes) {
    decks.insert(input_file(scene.deck));
    for (const MadeFile &made : scene.made)
      decks.insert(input_file(made.deck));
    for (const SceneDeck deck : {SceneDeck::settle, SceneDeck::place})
      if (scene.bed) decks.insert(input_file(deck_of(scene, deck)));
  }
  return decks;
}

/// What the results of a plan depend on besides the build: a line for each, so that a refusal tells which of
/// them differs.
std::string settings_of(const Plan &plan) {
  std::string settings = fmt::format("plan {}\n", fingerprint(plan.text));
  for (const fs::path &deck : decks_of(plan)) {
    std::string made_of;
    for (const fs::path &file : deck_files(deck))
      made_of += file.filename().string() + fingerprint(read_text(file));
    settings += fmt::format("deck {} {}\n", deck.filename().string(), fingerprint(made_of));
  }
  return settings;
}

StudyOptions judged(const StudyArguments &arguments, const std::string &name) {
  StudyOptions options;
  options.fresh = arguments.fresh.given();
  options.quick = arguments.quick.given();
  options.out = arguments.out ? *arguments.out : output_folder_option("--out", "results/study/" + name);
  return options;
}

/// "3/8"
Part part_from_text(const std::string &text) {
  constexpr int most = 100000;
  const std::size_t slash = text.find('/');
  const auto whole = [](const std::string &digits) {
    const std::optional<long> number = whole_number_from_text(digits);
    return number && *number >= 1 && *number <= most ? static_cast<int>(*number) : 0;
  };
  Part part{0, 0};
  if (slash != std::string::npos) part = {whole(text.substr(0, slash)), whole(text.substr(slash + 1))};
  if (part.of == 0 || part.number == 0 || part.number > part.of)
    throw UsageError(refusal("--part", text, "K/N, every N-th run, beginning with the K-th: 3/8"));
  return part;
}

/// The folder of a part.
fs::path folder_of(const fs::path &out, const Part &part) {
  return out / parts_name / fmt::format("{}_of_{}", part.number, part.of);
}

/// Holds the folders of all parts, which no other call may be writing.
std::vector<ResumedFolder> hold_parts(const StudyOptions &options, const std::string &settings) {
  std::vector<ResumedFolder> held;
  StudyOptions of_part = options;
  if (fs::is_directory(options.out / parts_name))
    for (const fs::directory_entry &part : fs::directory_iterator(options.out / parts_name)) {
      of_part.out = part.path();
      held.push_back(open_study(of_part, settings));
    }
  return held;
}

void run_plan(const StudyArguments &arguments) {
  const fs::path file = plan_file(arguments.name.text());
  const int jobs = arguments.jobs.value_or(1), balls = arguments.balls.value_or(0);
  StudyOptions options = judged(arguments, study_name(file));
  std::optional<Part> part;
  if (arguments.part) {
    part = part_from_text(*arguments.part);
    options.out = folder_of(options.out, *part);
  }
  check_engine_path(options.out);
  Plan plan = read_plan(file);
  std::vector<GivenPath> read = {{"NAME", file}};
  for (const fs::path &deck : decks_of(plan))
    for (const fs::path &included : deck_files(deck))
      read.push_back({"deck", included});
  for (const fs::path &values : plan.files)
    read.push_back({"a file of the plan", values.is_absolute() ? values : input_file(values.string())});
  keep_apart(read, {{"--out", options.out, true}});
  if (balls > 0 && !plan.can_be_scaled()) throw arguments.balls.refused(what_can_be_scaled);
  if (balls > 0) plan = plan.with_balls(balls);
  if (options.quick) plan = plan.quick();
  for (const Scene &scene : plan.scenes)
    if (const std::string fault = engine_fault(engine_of(scene.deck)); !fault.empty())
      throw UsageError(fault);
  const std::string settings = settings_of(plan);
  const RunOptions how{jobs, arguments.keep.given(), arguments.page_only.given()};
  if (part) {
    const ResumedFolder folder = open_study(options, settings);
    return make_part(plan, *part, options.out, how);
  }
  const std::vector<ResumedFolder> parts = hold_parts(options, settings);
  const ResumedFolder folder = open_study(options, settings);
  run_experiment(plan, options.out, how);
}

void run_study(const Study &study, const StudyArguments &arguments) {
  for (const Option *option :
       std::initializer_list<const Option *>{&arguments.jobs, &arguments.balls, &arguments.part})
    if (*option) throw option->refused("with a study that is a plan of beds");
  for (const Flag *flag : {&arguments.page_only, &arguments.keep})
    if (*flag) throw UsageError(flag->name() + " is given; allowed: with a study that is a plan");
  const StudyOptions options = judged(arguments, study.name);
  keep_apart({}, {{"--out", options.out, true}});
  const ResumedFolder folder = open_study(options);
  study.run(options);
}

void run(const StudyArguments &arguments) {
  for (const Study &study : other_studies())
    if (arguments.name.text() == study.name) return run_study(study, arguments);
  run_plan(arguments);
}

} // namespace

void add_study_command(CLI::App &app, Session &session) {
  std::string footer =
      "Plans, in inputs/study/NAME/plan; those of beds and samples have 95 % confidence intervals over "
      "seeds:\n"
      "  accuracy   error of chain and impacts over steps; `drumlin advise` answers from it\n"
      "  drive      what passes of a roller leave in a lift, and what decides it\n"
      "  base       what yield, suction and density do for a roller on a base course\n"
      "  box        what width, depth, walls and absorbing sides of the box change\n"
      "  cyclic     what cyclic simple shear does to loose and to dense soil\n"
      "  loosening  why a bed loosens under a roller\n"
      "  damping    where the energy of a cycle goes, and which damping follows\n"
      "  fidelity   effect and time of each part of a bed's model; `drumlin advise --bed` answers "
      "from it\n"
      "  friction   the friction models coulomb and history\n"
      "  benchmarks published tests of one or two spheres, in both engines against closed forms\n"
      "  extremes   runs at the limits of the allowed parameters, against independent solutions\n"
      "  penetration a ball that sinks into a bed, against laws that others measured\n"
      "  scatter    how many beds give a result within 5 or 10 %; A against B\n"
      "  stability  the longest stable time step over damping, for both integration schemes\n"
      "  stiffness  k and D that `drumlin identify` finds, over load, force and frequency\n"
      "  suction    what suction adds to the strength of a soil, in the biaxial test\n"
      "  timing     time of a step on the chain and on beds, part by part, beside the engines' own laws\n"
      "Others:\n";
  for (const Study &study : other_studies())
    footer += fmt::format("  {:<10} {}\n", study.name, study.summary);
  add_command<StudyArguments>(
      app, session, "study",
      "Measures what steps, laws and options cost and what they bring, and what differs between scenes of "
      "a plan. An interrupted study continues where it was interrupted.",
      run, footer);
}

} // namespace drumlin::post
