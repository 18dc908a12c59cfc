#include "commands/commands.h"

#ifdef DRUMLIN_LAB
#include "lab/studies.h"
#endif
#include "map/meter_study/study.h"
#include "studies/studies.h"
#include "studies/study.h"
#include "support/options.h"
#include "support/usage_error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

namespace drumlin::post {

namespace {

/// Runs at the same time, each a process of its own.
constexpr int most_jobs = 1000;
/// Least number of balls of a scaled bed: the drum of a smaller one would have hardly any below it.
constexpr int least_balls = 100;
constexpr int most_balls = 1000000;

/// The studies of the laboratory, which a build may not have.
constexpr std::array lab_names = {"accuracy", "benchmarks", "stability", "timing"};

/// All studies of this build, in the order of the help.
std::vector<Study> all_studies() {
  std::vector<Study> studies(bed_studies.begin(), bed_studies.end());
  studies.push_back(
      {"meter",
       "What the meters of rollers show on soil of 1 to 200 MN/m, where a value may mean several "
       "stiffnesses, and what identification finds in the same records. Half a minute, without an engine.",
       [](const StudyOptions &options) { run_meter_study(options.out, options.quick); }});
#ifdef DRUMLIN_LAB
  studies.insert(studies.end(), lab_studies.begin(), lab_studies.end());
#endif
  std::sort(studies.begin(), studies.end(),
            [](const Study &a, const Study &b) { return std::string(a.name) < b.name; });
  return studies;
}

/// Says why there is no study of a name. Throws UsageError.
[[noreturn]] void refuse(const std::string &name, const std::vector<Study> &studies) {
  if (name == "cost" || name == "speed")
    throw UsageError(refusal("NAME", name, "timing, which measures both"));
  if (std::find(lab_names.begin(), lab_names.end(), name) != lab_names.end())
    throw UsageError(
        refusal("NAME", name, "a study of the laboratory only in a build with -DDRUMLIN_LAB=ON"));
  std::vector<std::string> names;
  names.reserve(studies.size());
  for (const Study &study : studies)
    names.emplace_back(study.name);
  throw UsageError(refusal("NAME", name, fmt::format("{}", fmt::join(names, ", "))));
}

} // namespace

void add_study_command(CLI::App &app, Session &) {
  CLI::App *command =
      app.add_subcommand("study", "Measures what steps, laws and options cost and what they "
                                  "bring. An interrupted study continues where it was interrupted.");
  const std::vector<Study> studies = all_studies();
  for (const Study &study : studies) {
    const auto options = std::make_shared<StudyOptions>();
    const auto out = std::make_shared<std::string>(std::string("results/study/") + study.name);
    CLI::App *one = command->add_subcommand(study.name, study.summary);
    one->add_option("--out", *out, "folder of the results")->type_name("DIR")->capture_default_str();
    one->add_flag("--fresh", options->fresh, "forget the points of an earlier call");
    one->add_flag("--quick", options->quick, "few points: to see that it works");
    const auto jobs = std::make_shared<std::string>("1");
    if (study.parallel)
      one->add_option("--jobs", *jobs, "runs at the same time, one processor each")
          ->type_name("COUNT")
          ->capture_default_str();
    const auto balls = std::make_shared<std::string>(std::to_string(StudyOptions().balls));
    if (study.scaled)
      one->add_option("--balls", *balls,
                      "of the complete bed; box and roller are scaled with their root, the balls are not")
          ->type_name("COUNT")
          ->capture_default_str();
    one->callback([options, out, jobs, balls, run = study.run] {
      options->balls = count_option("--balls", *balls, least_balls, most_balls);
      options->jobs = count_option("--jobs", *jobs, 1, most_jobs);
      options->out = output_folder_option("--out", *out);
      keep_apart({}, {{"--out", options->out, true}});
      const ResumedFolder folder = open_study(*options);
      run(*options);
    });
  }
  command->allow_extras(); // to name a study that does not exist
  command->callback([command, studies] {
    if (!command->get_subcommands().empty()) return;
    const std::vector<std::string> given = command->remaining();
    refuse(given.empty() ? "" : given.front(), studies);
  });
}

} // namespace drumlin::post
