#include "studies/studies.h"

#include "engine/deck_run.h"
#include "studies/fidelity/results.h"
#include "studies/friction/results.h"
#include "studies/placed_bed.h"
#include "studies/stiffness/results.h"
#include "studies/study.h"
#include "runs/parameter_file.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::post {

namespace {

struct FrictionPlan {
  std::string beds; ///< in words
  PlacedBed bed;
  Variables run; ///< of in.bed alone
  int seeds, cycles;
};

FrictionPlan quick_plan() {
  PlacedBed bed = small_bed();
  bed.scene.emplace_back("m3", "50");
  return {"150 discs of case loose, a test of the study", bed, {{"Fw", "2940"}}, 1, 4};
}

FrictionPlan full_plan() {
  return {"1000 discs of case gravel in a box 1.26 m wide, six cycles", gravel_bed(), {}, 5, 6};
}

MeasuredRun measure(const FrictionPlan &plan, const std::string &tangential, int seed,
                    const std::filesystem::path &out) {
  PlacedBed bed = plan.bed;
  bed.name = tangential;
  bed.scene.emplace_back("tangential", tangential);
  Variables variables = joined(plan.run, bed.scene);
  variables.insert(variables.end(), {{"start", placed(bed, seed, out).string()},
                                     {"balance", "10"},
                                     {"cycles", std::to_string(plan.cycles)},
                                     {"samples_per_cycle", "250"}});
  const DeckRun run("bed/in.bed", variables);
  run.must_succeed();
  const auto parameter = [values = read_parameters(run.file("parameters.csv"))](const char *name) {
    return csv_value<double>(values.at(name));
  };
  const BedLaw law = identified_law(run.file(""));
  const Table cycles = read_table(run.file("cycles.csv"));
  const BedValues values = bed_values(cycles, 1.0);
  const auto value = [&values](BedQuantity quantity) {
    return values.at(static_cast<std::size_t>(quantity));
  };
  const FrictionRun found{tangential,
                          seed,
                          0.5 * parameter("drum_depth") / parameter("r2"),
                          cycles.numbers("settlement").back(),
                          value(BedQuantity::force),
                          value(BedQuantity::acceleration),
                          value(BedQuantity::contact),
                          law.k,
                          law.D,
                          law.r2};
  return {friction_runs().cells(found),
          fmt::format("{:.3g} mm, {:.3g} kN/m, k = {:.3g} MN/m", 1e3 * found.settlement,
                      1e-3 * found.peak_force, 1e-6 * found.k)};
}

} // namespace

void run_friction_study(const StudyOptions &options) {
  check_engine_path(options.out);
  const FrictionPlan plan = options.quick ? quick_plan() : full_plan();
  ResumedTable results(options.out / "runs.csv", friction_runs());
  std::vector<std::vector<SeedRun>> groups;
  for (int seed = 1; seed <= plan.seeds; ++seed)
    for (const char *model : {"coulomb", "history"})
      groups.push_back({{model, seed, [&plan, model, seed, &options] {
                           return measure(plan, model, seed, options.out);
                         }}});
  const std::vector<std::string> failures = make_runs(groups, options.jobs, results);
  write_friction_page(options.out, plan.beds, read_points(results.file(), friction_runs()), failures);
  fmt::print("{}\n", (options.out / "index.html").string());
  if (!failures.empty())
    throw std::runtime_error(fmt::format("{} of the runs failed; the page tells which", failures.size()));
}

} // namespace drumlin::post
