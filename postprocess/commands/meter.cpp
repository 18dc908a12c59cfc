#include "commands/commands.h"

#include "commands/record_options.h"
#include "meter/page.h"
#include "record/excitation.h"
#include "support/files.h"
#include "support/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr const char *values_name = "meter.csv";
constexpr const char *shown_name = "first_second.csv"; // in the folder of --show

struct MeterArguments : Options {
  using Options::Options;
  RecordArguments record{command()};
  Flag show = flag("--show", "only print how the file was understood and draw its first second");
  Number rmv_constant = number("--rmv-constant", {1.0, 1e4}, "constant of RMV, 100 or 300 in sources", "100");
  Number same =
      number("--same", {1e-9, 1.0},
             "relative difference of the harmonics of two cycles up to which they count as the same "
             "motion; more for noisy records",
             "0.05");
  Text window =
      text("--window", "COUNT",
           "cycles in a window, an even number of 4 or more, or seconds such as 0.5s, or of a roller "
           "that drives metres such as 0.5m; without it 10 cycles, or all of a shorter record");
  WayArguments way{command()};
  DrumArguments drum{command()};
  ResultPath out =
      result_folder("--out", "folder of meter.csv and the page; an earlier one is replaced", "results/meter");
};

struct MeterTask {
  MeterOptions options;
  std::optional<double> window_seconds, window_metres; ///< instead of a number of cycles
  WayRange way;
  fs::path out;
};

constexpr int longest_window = 1000000;

/// The window: an even number of cycles, or seconds with an 's' behind them.
void take_window(const std::string &text, MeterTask &task) {
  constexpr const char *allowed =
      "an even whole number of cycles from 4 to 1000000 (RMV needs whole periods of half the "
      "excitation frequency), seconds such as 0.5s, or of a roller that drives metres such as 0.5m";
  task.window_metres = window_length(text);
  if (task.window_metres) return;
  if (!text.empty() && text.back() == 's') {
    task.window_seconds = number_option("--window", text.substr(0, text.size() - 1), Range{1e-6, 1e6, "s"});
    return;
  }
  try {
    task.options.window = count_option("--window", text, least_cycles, longest_window);
  } catch (const UsageError &) {
    throw UsageError(refusal("--window", text, allowed));
  }
  if (task.options.window % 2 != 0) throw UsageError(refusal("--window", text, allowed));
}

/// A folder that is new, empty or of an earlier call.
fs::path checked_out(const ResultPath &asked) {
  const fs::path &out = *asked;
  if (fs::is_directory(out) && !fs::is_empty(out) && !fs::exists(out / values_name) &&
      !fs::exists(out / "data" / shown_name))
    throw asked.refused("a folder that is new, empty or of an earlier 'drumlin meter'");
  return out;
}

MeterTask judge(const MeterArguments &arguments) {
  MeterTask task;
  if (arguments.window) take_window(*arguments.window, task);
  MeterOptions &options = task.options;
  options.rmv_constant = *arguments.rmv_constant;
  options.same = *arguments.same;
  RollerArguments roller = arguments.record.roller;
  roller.is_first = false; // of two readings
  if (const auto drum = judged(arguments.drum, judged(roller))) {
    options.drum_radius = drum->radius;
    options.drum_width = drum->length;
    options.poisson = drum->poisson;
  }
  task.way = judged(arguments.way);
  task.out = checked_out(arguments.out);
  keep_apart(files_of(arguments.record), {{"--out", task.out, true}});
  return task;
}

/// The window of so many seconds, in whole pairs of cycles.
int cycles_in(double seconds, double period) {
  const double pairs = seconds / (2.0 * period) + 1e-6;
  const int cycles = pairs < longest_window ? 2 * static_cast<int>(pairs) : longest_window;
  if (cycles < least_cycles)
    throw UsageError(
        refusal("--window", fmt::format("{:g}s", seconds),
                fmt::format("{:g}s or more, four cycles of the excitation", least_cycles * period)));
  return cycles;
}

void print_windows(const MeterResult &result) {
  constexpr std::size_t most = 12;
  const auto cell = [](std::optional<double> value, int decimals, double scale) {
    return value ? fmt::format("{:12.{}f}", scale * *value, decimals) : fmt::format("{:>12}", "-");
  };
  fmt::print("{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}  {}\n", "begin [s]", "CMV [-]", "RMV [-]",
             "contact [-]", "peak [kN]", "energy [J]", "k_B [MN/m]", "mode");
  const std::size_t count = result.windows.size();
  for (std::size_t i = count > most ? count - most : 0; i < count; ++i) {
    const MeterWindow &w = result.windows[i];
    fmt::print("{}{}{}{}{}{}{}  {}\n", cell(w.begin, 3, 1.0), cell(w.cmv, 2, 1.0), cell(w.rmv, 2, 1.0),
               cell(w.contact_share, 3, 1.0), cell(w.peak_force, 1, 1e-3), cell(w.energy, 1, 1.0),
               cell(w.k_B, 2, 1e-6), mode_names[static_cast<std::size_t>(w.mode)]);
  }
  if (count > most) fmt::print("the last {} of {} windows; all are in {}\n", most, count, values_name);
}

/// Prints and draws how the record was understood.
void show(const Record &record, const fs::path &out) {
  if (record.time.empty()) throw UsageError(refusal("--show", record.file.string(), "a record with samples"));
  for (const std::string &line : reading_words(record))
    fmt::print("{}\n", line);
  const fs::path place = fs::weakly_canonical(fs::absolute(out));
  make_output_folder(place.parent_path());
  FolderInProgress draft(place);
  write_reading_page(draft.path(), record);
  draft.publish();
  fmt::print("{}\n", (out / "index.html").string());
}

void run(const MeterArguments &arguments) {
  MeterTask task = judge(arguments);
  if (arguments.show) {
    RecordArguments record = arguments.record;
    record.guess = true;
    show(judged(record), task.out);
    return;
  }
  MeterResult result;
  result.record = judged(arguments.record);
  refuse_doubtful(result.record);
  result.cycles = meter_cycles(result.record);
  if (!result.cycles.vibrates)
    throw UsageError(refusal("Fw", "0", "a record of a roller that vibrates, else no meter shows anything"));
  if (task.way.given()) keep_cycles(result.cycles, result.record, rows_on(result.record, task.way));
  if (!arguments.window) // the usual one, or of a short record all of it
    task.options.window =
        std::min(task.options.window, static_cast<int>(result.cycles.cycles.size() / 2 * 2));
  if (task.window_seconds) task.options.window = cycles_in(*task.window_seconds, result.record.period());
  result.options = task.options;
  if (task.window_metres && result.record.two_sided())
    throw arguments.window.refused(
        "a number of cycles, or seconds as 2s, for a record of both ends of the drum");
  result.windows = task.window_metres
                       ? windows_of_length(result.cycles, result.record, *task.window_metres, result.options)
                       : meter_windows(result.cycles, result.options);
  if (task.window_metres)
    result.options.window = static_cast<int>(
        std::lround((result.windows.back().end - result.windows.back().begin) / result.record.period()));
  add_places(result.windows, result.record);
  result.ends = both_ends(result.record, result.options, task.way);

  for (const std::string &line : result.record.notes)
    fmt::print("{}\n", line);
  fmt::print("{}: {}\n{}\n", result.record.file.string(), answer_line(result), source_words(result));
  for (const std::string &words : {width_words(result), averaging_words(result)})
    if (!words.empty()) fmt::print("{}\n", words);
  print_windows(result);
  if (result.ends)
    for (const std::string &line : answer_lines(*result.ends, result.windows.back()))
      fmt::print("{}\n", line);
  const fs::path place = fs::weakly_canonical(fs::absolute(task.out));
  make_output_folder(place.parent_path());
  FolderInProgress draft(place);
  write_files({{draft.path() / values_name, meter_csv(result)},
               {draft.path() / "parameters.csv", settings_of(result.record)}});
  write_meter_page(draft.path(), result);
  draft.publish();
  fmt::print("{}\n", (task.out / "index.html").string());
}

} // namespace

void add_meter_command(CLI::App &app, Session &session) {
  add_command<MeterArguments>(
      app, session, "meter",
      "What the meter of a roller shows, from a record of its "
      "motion: harmonics of the drum's acceleration, CMV, RMV, "
      "stiffness k_B, modulus E_vib, energy and operating mode "
      "over windows of whole cycles. Writes meter.csv and a "
      "page with plots.",
      run,
      "Examples:\n"
      "  drumlin meter results/my-run\n"
      "  drumlin meter results/my-run/chain.csv --window 0.5s --out results/meter-samples\n"
      "  drumlin meter field.csv --column 'time=Time:ms' --column 'a_drum=Acc Z:-g' --frequency 29 "
      "--low-pass 200 \\\n"
      "      --window 20");
}

} // namespace drumlin::post
