#include "commands/commands.h"

#include "calibration/calibration.h"
#include "calibration/page.h"
#include "calibration/soil_tests.h"
#include "calibration/task.h"
#include "commands/chain_options.h"
#include "engine/places.h"
#include "experiment/study.h"
#include "support/csv.h"
#include "support/files.h"
#include "support/options.h"
#include "support/progress.h"
#include "support/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr double gravity = 9.81; // m/s2, of in.bed

/// "NAME, MEANING; NAME, MEANING"
template <class Table>
std::string meanings(const Table &table) {
  std::string text;
  for (const auto &row : table)
    text += fmt::format("{}{}, {}", text.empty() ? "" : "; ", row.name, row.meaning);
  return text;
}

struct CalibrateArguments : Options {
  using Options::Options;
  Texts targets = texts(
      "--target", "TARGET",
      "NAME=VALUE or NAME=VALUE:TOLERANCE, once for each target; the tolerance is relative, 0.05 if not "
      "given. " +
          meanings(soil_quantities));
  Texts vary =
      texts("--vary", "RANGE",
            "NAME=LOW:HIGH, once for each parameter, no more than targets. " + meanings(soil_parameters));
  Texts fixed = texts(
      "--set", "SETTING",
      "NAME=VALUE, another value than case gravel has: of these parameters, or of the roller's variables "
      "m2, m3, r2, r3, k23, c23, omega or frequency [Hz], Fw; m2, m3, k23, c23, Fw per metre of the drum's "
      "width");
  RollerArguments roller{command(), "The roller, instead of that of case gravel"};
  Count seeds = count("--seeds", 2, 1000, "beds at each point, 2 or more", "5");
  Count balls = count("--balls", 50, 1'000'000,
                      "soil balls of a bed; its width grows with their square root, 2 m for 2500", "1000");
  Count cycles = count("--cycles", 4, 1'000'000,
                       "cycles of the excitation, of which the second half counts for all but k and D", "6");
  Count evaluations =
      count("--evaluations", 1, 100'000,
            "points of the search; two for each parameter and one more are made in addition", "40");
  Count target_beds = count(
      "--target-beds", 0, 1'000'000,
      "beds of which the targets are means, whose scatter then widens the intervals; 0: they are exact", "0");
  Count jobs = count("--jobs", 1, 100'000, "runs at the same time, one processor each", "1");
  Text name = text("--name", "NAME", "NAME of the file case.NAME", "calibrated");
  ResultPath out = result_folder("--out", "folder of the results", "results/calibration");
  Flag fresh = flag("--fresh", "forget the evaluations of an earlier call");
};

/// Gives the roller to the bed, per metre of the drum's width; what --set gives counts more.
void set_roller(const GivenRoller &roller, CalibrationTask &task) {
  const Roller &machine = roller.machine;
  const auto refuse = [&roller](const char *allowed) {
    throw UsageError(refusal("--roller", roller.file, allowed));
  };
  if (!machine.width) refuse("a file with the width of the drum, since a bed has the roller per metre of it");
  if (!machine.diameter && !task.fixed_value("r2"))
    refuse("a file with the diameter of the drum, or its radius by --set r2=");
  ChainParameters whole;
  set_machine(whole, machine, roller.setting);
  if (const std::optional<std::string> omega = task.fixed_value("omega")) {
    whole.omega = number_from_text(*omega);
    whole.Fw = roller.setting.me_re * whole.omega * whole.omega;
  }
  const double width = *machine.width;
  const std::vector<std::pair<const char *, double>> values = {
      {"m2", whole.m2 / width},   {"m3", whole.m3 / width},   {"r2", 0.5 * machine.diameter.value_or(0.0)},
      {"k23", whole.k23 / width}, {"c23", whole.c23 / width}, {"omega", whole.omega},
      {"Fw", whole.Fw / width}};
  for (const auto &[name, value] : values)
    if (!task.fixed_value(name)) task.fixed.emplace_back(name, number_text(value));
}

CalibrationTask judged_task(const CalibrateArguments &arguments, const std::optional<GivenRoller> &roller) {
  CalibrationTask task;
  for (const std::string &text : arguments.targets)
    task.targets.push_back(target_from_text(text));
  for (const std::string &text : arguments.vary)
    task.vary.push_back(varied_from_text(text));
  for (const std::string &text : arguments.fixed)
    task.fixed.push_back(fixed_from_text(text));
  if (roller) set_roller(*roller, task);
  task.check();
  task.seeds = *arguments.seeds;
  task.balls = *arguments.balls;
  task.cycles = *arguments.cycles;
  task.target_beds = *arguments.target_beds;
  if (const std::optional<std::string> r2 = task.fixed_value("r2")) {
    const double diameter = 2.0 * number_from_text(*r2), width = packing_of(task).width;
    if (!(diameter < width))
      throw arguments.balls.refused(
          fmt::format("at least {:.0f}: the drum has a diameter of {:g} m, the box a width of {:.3g} m",
                      std::ceil(task.balls * diameter * diameter / (width * width)) + 1.0, diameter, width));
  }
  return task;
}

std::string judged_name(const std::string &name) {
  constexpr std::size_t most_letters = 60;
  if (name.empty() || name.size() > most_letters ||
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") !=
          std::string::npos ||
      name == "gravel" || name == "loose")
    throw UsageError(
        refusal("--name", name,
                fmt::format("letters, digits, - and _, {} at most, not gravel or loose", most_letters)));
  return name;
}

constexpr const char *at_once_name = "points at a time";

/// How many points the search asks for at a time: as many as give work to all jobs, or as many as an earlier
/// call asked for, so that this one finds the same.
int points_at_once(const fs::path &settings, int jobs, int seeds) {
  const int now = std::max(1, jobs / seeds);
  if (!fs::is_regular_file(settings)) return now;
  std::istringstream lines(read_text(settings));
  const std::string start = fmt::format("{},", at_once_name);
  for (std::string line; std::getline(lines, line);)
    if (const auto count =
            line.rfind(start, 0) == 0 ? whole_number_from_text(line.substr(start.size())) : std::nullopt;
        count && *count > 0 && *count != now && *count <= std::numeric_limits<int>::max()) {
      print_progress(fmt::format("the search asks for {} points at a time, as in the earlier call", *count));
      return static_cast<int>(*count);
    }
  return now;
}

/// All that the results depend on.
std::string settings_text(const CalibrationTask &task, const std::optional<GivenRoller> &roller,
                          int at_once) {
  std::string text = build_line();
  if (roller)
    for (const auto &[name, value] : roller->rows(gravity))
      text += csv_line({name, value});
  for (const auto &[name, value] : settings_of(task))
    text += csv_line({name, value});
  return text + csv_line({at_once_name, std::to_string(at_once)});
}

/// What a user does with a case file: the decks take it from their own folder, which in an installation
/// cannot be written.
std::string use_of(const fs::path &case_file, const std::string &name) {
  const fs::path decks = places().inputs / "bed";
  if (!places().installed && ::access(decks.c_str(), W_OK) == 0)
    return fmt::format("{}: copy it to inputs/bed, and give in.settle -var case {}", case_file.string(),
                       name);
  return fmt::format("{0}: copy the decks to a folder of your own, this file to them, and give their "
                     "in.settle -var case {2}:\n"
                     "  cp -r {1} . && cp {0} inputs/bed && {3} run inputs/bed/in.settle -var case {2}",
                     shell_word(case_file.string()), shell_word(places().inputs.string()), name,
                     front_command());
}

/// The chain beside the roller's record of each seed at the best point; nothing if no target is measured by
/// the roller.
std::vector<LumpedComparison> compared_records(const CalibrationTask &task, const Calibration &found,
                                               const SoilTests &tests) {
  std::vector<LumpedComparison> compared;
  if (!measures(task, SoilTest::roller)) return compared;
  for (int seed = 1; seed <= task.seeds; ++seed) {
    print_progress(fmt::format("the roller's record at the best evaluation, seed {}", seed));
    const Record record = read_record(tests.record(found.best, seed));
    compared.push_back(compare_lumped(record, identify_record(record, {})));
  }
  return compared;
}

void run(const CalibrateArguments &arguments) {
  std::optional<GivenRoller> roller = judged(arguments.roller);
  const CalibrationTask task = judged_task(arguments, roller);
  CalibrationEffort effort;
  effort.evaluations = *arguments.evaluations;
  effort.jobs = *arguments.jobs;
  const std::string name = judged_name(*arguments.name);
  const fs::path &out = *arguments.out;
  keep_apart(files_of(arguments.roller), {{"--out", out, true}});
  check_engine_path(out);
  effort.at_once = arguments.fresh ? std::max(1, effort.jobs / task.seeds)
                                   : points_at_once(out / settings_name, effort.jobs, task.seeds);
  const ResumedFolder folder(out, "calibration", settings_text(task, roller, effort.at_once),
                             arguments.fresh.given());

  if (roller)
    for (const std::string &line : roller->lines(gravity))
      fmt::print("{}\n", line);
  const SoilTests tests(task, out);
  const MeasureSeed measure = [&tests](const Evaluation &evaluation, int seed) {
    return tests.measure(evaluation, seed);
  };
  const Calibration found = calibrate(task, effort, out, measure);
  const std::vector<LumpedComparison> compared = compared_records(task, found, tests);
  write_calibration_page(out,
                         fmt::format("beds of {} discs of case gravel, {} seeds", task.balls, task.seeds),
                         task, found, compared);
  const std::vector<std::string> answer = calibration_answer(task, found);
  for (const std::string &line : answer)
    fmt::print("  {}\n", line);
  if (!compared.empty())
    for (const std::string &line : lumped_answer(compared))
      fmt::print("  {}\n", line);
  fmt::print("{}\n", (out / "index.html").string());
  const fs::path case_file = out / ("case." + name);
  if (!found.sensitivity.identified()) {
    fs::remove(case_file);
    std::vector<std::string> unknown;
    for (std::size_t i = 0; i < task.vary.size(); ++i)
      if (!found.sensitivity.parameters[i].unidentified.empty()) unknown.push_back(task.vary[i].name);
    throw std::runtime_error(
        refusal("--vary", fmt::format("{}", fmt::join(unknown, ", ")),
                "parameters that the targets identify; the page says why they do not, and no case "
                "file is written"));
  }
  std::vector<std::string> heading = {"A bed calibrated by", "", "  " + arguments.session().command, ""};
  heading.insert(heading.end(), answer.begin(), answer.end());
  fs::remove(case_file); // of an earlier call, in case that there is none of this one
  write_files({{case_file, case_text(task, found_point(task, found), heading)}});
  fmt::print("{}\n", use_of(case_file, name));
}

} // namespace

void add_calibrate_command(CLI::App &app, Session &session) {
  add_command<CalibrateArguments>(
      app, session, "calibrate",
      "Parameters of a bed's contacts with which it meets targets: stiffness and damping that a roller "
      "feels, settlement, plate modulus, friction angle. Runs the decks on beds of several seeds, and writes "
      "a page, evaluations.csv and a file case.NAME for the decks. An interrupted calibration continues "
      "where it was interrupted.",
      run,
      "Example:\n"
      "  drumlin calibrate --target k=20e6 --target D=0.2 --vary k=1e8:2e9 --vary D=0.05:0.8 --jobs 2\n");
}

} // namespace drumlin::post
