#include "studies/studies.h"

#include "support/csv.h"
#include "engine/deck_run.h"
#include "studies/fidelity/page.h"
#include "studies/fidelity/plan.h"
#include "studies/fidelity/results.h"
#include "studies/placed_bed.h"
#include "studies/stiffness/results.h"
#include "studies/study.h"

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::post {

namespace {

FidelityRun measure(const FidelityScene &scene, int seed, const std::filesystem::path &out, int cycles) {
  Variables variables = scene.run_variables();
  variables.insert(variables.end(), {{"start", placed(scene.bed, seed, out).string()},
                                     {"cycles", std::to_string(cycles)},
                                     {"samples_per_cycle", "250"}});
  const DeckRun run("bed/in.bed", variables);
  run.must_succeed();
  const double width = scene.bed.packing.dimensions() == 3 ? scene.bed.packing.depth : 1.0; // m
  BedValues values = bed_values(read_table(run.file("cycles.csv")), width);
  values[static_cast<std::size_t>(BedQuantity::stiffness)] = identified_law(run.file("")).k / width;
  return {scene.name, seed, values, run.outcome().cpu_seconds, scene.bed.packing.balls};
}

MeasuredRun measured(const FidelityRun &run) {
  return {fidelity_runs().cells(run), fmt::format("{:.3g} m/s2, {:.3g} mm per cycle, {:.3g} s", run.values[0],
                                                  1e3 * run.values[2], run.cpu_s)};
}

} // namespace

void run_fidelity_study(const StudyOptions &options) {
  check_engine_path(options.out);
  const FidelityPlan plan = options.quick ? quick_fidelity_plan() : fidelity_plan(options.balls);
  ResumedTable results(options.out / "runs.csv", fidelity_runs());
  // Scenes that share their soil are run together, seed by seed. All seeds of such a group come before the next group: a study that is
  // interrupted has whole rows for its first groups.
  std::vector<std::vector<SeedRun>> groups;
  std::set<std::string> soils;
  for (const FidelityScene &scene : plan.scenes) {
    if (!soils.insert(scene.soil()).second) continue;
    for (int seed = 1; seed <= plan.seeds; ++seed) {
      std::vector<SeedRun> group;
      for (const FidelityScene &one : plan.scenes)
        if (one.soil() == scene.soil())
          group.push_back({one.name, seed, [&one, &options, &plan, seed] {
                             return measured(measure(one, seed, options.out, plan.cycles));
                           }});
      groups.push_back(group);
    }
  }
  const std::vector<std::string> failures = make_runs(groups, options.jobs, results);

  std::vector<Effect> effects;
  const std::vector<FidelityRun> runs = read_fidelity_runs(results.file());
  for (const BedComparison &comparison : plan.comparisons())
    if (const std::optional<Effect> effect = effect_of(runs, comparison)) effects.push_back(*effect);
  write_fidelity_page(options.out,
                      fmt::format("{} discs of case {}, {} cycles, {} seeds at most",
                                  plan.reference().bed.packing.balls, options.quick ? "loose" : "gravel",
                                  plan.cycles, plan.seeds),
                      runs, effects, failures);
  fmt::print("{}\n", (options.out / "index.html").string());
  if (!failures.empty())
    throw std::runtime_error(fmt::format("{} of the runs failed; the page tells which", failures.size()));
}

} // namespace drumlin::post
