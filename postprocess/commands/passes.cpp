#include "commands/commands.h"

#include "commands/chain_options.h"
#include "passes/page.h"
#include "passes/values.h"
#include "runs/parameter_file.h"
#include "support/files.h"
#include "support/options.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr const char *page_folder = "passes"; // in the folder of the results
constexpr const char *usual_out = "results/passes";

struct PassesArguments : Options {
  using Options::Options;
  Texts folders =
      words("FOLDER", "TEXT",
            "folder of a run of inputs/bed/in.drive; several: beds that differ in their seed, of which "
            "means and intervals are written");
  Text meter = text("--meter", "NAME",
                    "value of the cells that is mapped and judged: CMV, RMV, CCV, k_B, E_vib, contact_share, "
                    "peak_force",
                    "CMV");
  Number target = number(
      "--target", {0.0, 1e15, "", false, true},
      "of this value, in its unit in passes.csv: cells at or above it are counted; without it nothing is "
      "judged");
  Number coverage = number("--coverage", {0.0, 100.0, "%", false, true},
                           "share of the cells that must reach the target [%]; rules have 70 or 80", "80");
  Number cell =
      number("--cell", {0.0, 1e3, "m", false, true},
             "length of a cell along the way [m], of four cycles of the excitation or more", "0.34");
  Number spacing =
      number("--spacing", {1e-6, 1e3, "m"},
             "distance of the vertical lines along which surfaces are measured [m]; a quarter of the radius "
             "of the smallest ball if not given");
  DrumArguments drum{command()};
  RollerArguments roller{command(), "E_vib"};
  ResultPath out = result_folder(
      "--out", fmt::format("folder of the tables, and of the page in its folder {}; FOLDER if not given, {} "
                           "for several",
                           page_folder, usual_out));
};

struct PassesTask {
  std::vector<fs::path> folders;
  PassesOptions options;
  AcceptanceRule rule;
  fs::path out;
};

PassesTask judge(const PassesArguments &arguments) {
  PassesTask task;
  task.rule.coverage = 0.01 * *arguments.coverage;
  task.rule.target = arguments.target.value();
  for (const std::string &text : arguments.folders) {
    const fs::path folder = path_option("FOLDER", text);
    for (const fs::path &other : task.folders)
      if (fs::exists(folder) && fs::exists(other) && fs::equivalent(folder, other))
        throw arguments.folders.refused(text, "each run once");
    task.folders.push_back(folder);
  }
  PassesOptions &options = task.options;
  options.cell = *arguments.cell;
  if (arguments.spacing) options.spacing = *arguments.spacing;
  if (const auto drum = judged(arguments.drum, judged(arguments.roller))) {
    options.meter.drum_radius = drum->radius;
    options.meter.drum_width = drum->length;
    options.meter.poisson = drum->poisson;
  }
  const std::string usual = task.folders.size() == 1 ? task.folders.front().string() : usual_out;
  task.out = arguments.out ? *arguments.out : output_folder_option("--out", usual);
  std::vector<GivenPath> inputs = files_of(arguments.roller);
  try {
    cell_meter(*arguments.meter);
  } catch (const std::invalid_argument &names) {
    throw arguments.meter.refused(names.what());
  }
  for (const fs::path &folder : task.folders)
    for (const GivenPath &file :
         files_in("FOLDER", folder, {"parameters.csv", "bed.csv", "cycles.csv", "dump"}))
      inputs.push_back(file);
  keep_apart(inputs, {{"--out", task.out / page_folder, true}});
  return task;
}

/// Refuses a run that is no further sample of the scene of the others.
void check_sample(const Drive &drive, const std::vector<PassesResult> &others) {
  for (const PassesResult &other : others)
    if (const std::string why = no_samples(drive.record.parameters, other.parameters); !why.empty())
      throw UsageError(
          refusal("FOLDER", drive.folder.string(),
                  fmt::format("runs that differ in the seed of their beds alone: here and in {} {}",
                              other.folder.string(), why)));
}

void run(const PassesArguments &arguments) {
  const PassesTask task = judge(arguments);
  std::vector<PassesResult> results;
  for (const fs::path &folder : task.folders) {
    const Drive drive = read_drive(folder);
    check_sample(drive, results);
    try {
      results.push_back(measure_passes(drive, task.options));
    } catch (const std::invalid_argument &fault) {
      throw UsageError(fault.what());
    }
  }
  const JudgedMap judged(meter_map(results, cell_meter(*arguments.meter)), task.rule);
  if (judged.rows.empty() && task.rule.target)
    throw arguments.target.refused(fmt::format("only where cells have a value of {}", *arguments.meter));
  make_output_folder(task.out);
  FolderInProgress page(fs::weakly_canonical(fs::absolute(task.out)) / page_folder);
  write_passes_page(page.path(), results, judged);
  std::vector<FileText> tables = {{task.out / "acceptance.csv", acceptance_csv(judged.map, judged.rows)}};
  if (results.size() == 1) {
    for (FileText &table : pass_tables(task.out, results.front()))
      tables.push_back(std::move(table));
  } else {
    tables.emplace_back(task.out / "passes.csv", passes_csv(results));
    for (std::size_t n = 0; n < results.size(); ++n) {
      const fs::path folder = task.out / fmt::format("run-{}", n + 1);
      make_output_folder(folder);
      for (FileText &table : pass_tables(folder, results[n]))
        tables.push_back(std::move(table));
    }
  }
  write_files(tables);
  page.publish();
  fmt::print("{}\n{}\n", answer_of(results), answer_of(judged.map, judged.rows, judged.rule));
  for (const std::string &answer : answers_on_spots(judged.map))
    fmt::print("{}\n", answer);
  for (const PassesResult &result : results)
    for (const std::string &note : result.notes)
      fmt::print("{}: {}\n", result.folder.string(), note);
  fmt::print("{}\n{}\n", (task.out / "passes.csv").string(),
             (task.out / page_folder / "index.html").string());
}

} // namespace

void add_passes_command(CLI::App &app, Session &session) {
  add_command<PassesArguments>(
      app, session, "passes",
      "What each pass of a roller that drives over a bed leaves: settlement, how much of it is "
      "compaction, solid fraction of each layer, heave, energy, meter values along the way, profiles "
      "over depth, rules of acceptance. Writes passes.csv, way.csv, surface.csv, depth.csv, "
      "acceptance.csv and a page.",
      run,
      "Examples:\n"
      "  drumlin passes results/drive\n"
      "  drumlin passes results/drive-1 results/drive-2 results/drive-3 --out results/seeds\n"
      "  drumlin passes results/drive --target 30 --coverage 70");
}

} // namespace drumlin::post
