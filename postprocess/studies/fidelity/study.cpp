#include "studies/studies.h"

#include "chain/run_files.h"
#include "engine/deck_run.h"
#include "studies/fidelity/page.h"
#include "studies/fidelity/results.h"
#include "studies/placed_bed.h"
#include "studies/study.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace {

/// One run on a bed of each seed.
struct Variant {
  std::string name;   ///< without commas
  Variables run = {}; ///< of in.bed alone
};

struct BedVariants {
  PlacedBed bed;
  std::vector<Variant> variants;
};

struct Plan {
  std::vector<BedVariants> beds;
  std::vector<BedComparison> comparisons;
  int seeds, cycles;
};

/// The same bed with other values.
PlacedBed with(PlacedBed bed, const std::string &name, const Variables &scene, const Variables &settle = {}) {
  bed.name = name;
  bed.scene.insert(bed.scene.begin(), scene.begin(), scene.end()); // the first value counts
  bed.settle = settle;
  return bed;
}

/// The same bed with other balls.
PlacedBed of_balls(PlacedBed bed, int balls, double smallest, double largest) {
  bed.packing.balls = balls;
  bed.packing.radius_min = smallest;
  bed.packing.radius_max = largest;
  return bed;
}

Plan quick_plan() {
  PlacedBed bed = small_bed();
  bed.scene.emplace_back("m3", "50");
  const std::pair<std::string, std::string> force = {"Fw", "2940"};
  return {{{bed, {{"base", {force}}, {"A", {force, {"transition", "A"}}}}},
           {with(bed, "rolling", {{"rolling", "0.1"}}), {{"rolling", {force}}}}},
          {{"A instead of B", "A", "base"}, {"rolling friction", "rolling", "base"}},
          2,
          4};
}

/// The plan itself: longer than other functions, since it has a line for each bed, run and comparison and
/// little else.
Plan full_plan() {
  // The excitation moves a bed far more than the forces that are unbalanced at a ratio of 1e-3.
  const PlacedBed loose{"loose", {}, {{"case", "loose"}, {"stepping", "second"}}, "1e-3"};
  // The time step follows the contact time: sqrt(m/k), m ~ r^2.
  const auto stiffness = [&loose](const char *name, const char *k, const char *dt) {
    return with(loose, name, {{"k", k}, {"dt", dt}});
  };
  const PlacedBed coarse = with(of_balls(loose, 625, 0.032, 0.048), "coarse", {{"dt", "4e-5"}});
  const PlacedBed fine = with(of_balls(loose, 10000, 0.008, 0.012), "fine", {{"dt", "1e-5"}});
  PlacedBed wide = with(of_balls(loose, 2500, 0.010, 0.030), "wide", {{"dt", "1e-5"}});
  wide.packing.grading = Grading::mass;
  wide.packing.height = 3.5; // m: with small balls everywhere, large ones find less space
  // As wide, as high and as loose as each other, the drum a clump in both.
  PlacedBed plane = with(of_balls(loose, 460, 0.016, 0.024), "plane", {{"drum", "clump"}});
  plane.packing.width = 1.0;
  PlacedBed space = with(of_balls(loose, 2500, 0.016, 0.024), "space", {{"case", "loose3d"}});
  space.packing.width = 1.0;
  space.packing.depth = 0.2;
  const auto frequency = [](double hertz, const char *steps) -> Variables {
    return {{"omega", number_text(2.0 * 3.14159265358979323846 * hertz)}, {"steps_per_cycle", steps}};
  };
  return {{{loose,
            {{"base"},
             {"steps x 2", {{"steps_per_cycle", "5000"}}},
             {"steps x 4", {{"steps_per_cycle", "10000"}}},
             {"A", {{"transition", "A"}}},
             {"no friction", {{"friction", "0"}, {"allow_change", "friction"}, {"balance", "1e30"}}},
             {"30 Hz", frequency(30.0, "1750")},
             {"40 Hz", frequency(40.0, "1250")}}},
           {with(loose, "stock", {{"stepping", "stock"}}),
            {{"stock"}, {"stock steps x 4", {{"steps_per_cycle", "10000"}}}}},
           {with(loose, "rolling", {{"rolling", "0.1"}}), {{"rolling"}}},
           {stiffness("soft10", "1e7", "6e-5"), {{"k / 10", {{"steps_per_cycle", "750"}}}}},
           {stiffness("soft100", "1e6", "2e-4"), {{"k / 100", {{"steps_per_cycle", "250"}}}}},
           {coarse, {{"625 balls", {{"steps_per_cycle", "1250"}}}}},
           {with(of_balls(loose, 2500, 0.02, 0.02), "one_size", {}), {{"one size"}}},
           {wide, {{"wide grading", {{"steps_per_cycle", "5000"}}}}},
           {with(loose, "dense", {}, {{"pour_friction", "0.1"}}), {{"dense"}}},
           {with(loose, "clump", {{"drum", "clump"}}), {{"clump"}}},
           {plane, {{"plane"}}},
           {space, {{"space", {{"steps_per_cycle", "4000"}}}}},
           {fine, {{"10000 balls", {{"steps_per_cycle", "5000"}}}}}},
          {{"A instead of B", "A", "base"},
           {"friction off, shaken only", "no friction", "base"},
           {"rolling friction 0.1", "rolling", "base"},
           {"k / 10 and 1/3.3 of the steps", "k / 10", "base"},
           {"k / 100 and 1/10 of the steps", "k / 100", "base"},
           {"2500 steps a cycle instead of 10000", "base", "steps x 4"},
           {"5000 steps a cycle instead of 10000", "steps x 2", "steps x 4"},
           {"stock: 2500 steps instead of 10000", "stock", "stock steps x 4"},
           {"stock instead of second: 10000 steps", "stock steps x 4", "steps x 4"},
           {"625 balls instead of 10000", "625 balls", "10000 balls"},
           {"2500 balls instead of 10000", "base", "10000 balls"},
           {"balls of one size", "one size", "base"},
           {"radii 10 to 30 mm instead of 16 to 24", "wide grading", "base"},
           {"dense: settled with friction 0.1", "dense", "base"},
           {"30 Hz instead of 20", "30 Hz", "base"},
           {"40 Hz instead of 20", "40 Hz", "base"},
           {"drum a clump instead of a ball", "clump", "base"},
           {"two dimensions instead of three", "plane", "space"}},
          5,
          10};
}

FidelityRun measure(const PlacedBed &bed, const Variant &variant, int seed, const std::filesystem::path &out,
                    int cycles) {
  Variables variables = joined(variant.run, bed.scene);
  variables.insert(variables.end(), {{"start", placed(bed, seed, out).string()},
                                     {"cycles", std::to_string(cycles)},
                                     {"samples_per_cycle", "250"}});
  const DeckRun run("bed/in.bed", variables);
  run.must_succeed();
  const double width = bed.packing.dimensions() == 3 ? bed.packing.depth : 1.0; // m
  return {variant.name, seed, bed_values(read_table(run.file("cycles.csv")), width),
          run.outcome().cpu_seconds};
}

MeasuredRun measured(const FidelityRun &run) {
  return {fidelity_runs().cells(run), fmt::format("{:.3g} m/s2, {:.3g} mm per cycle, {:.3g} s", run.values[0],
                                                  1e3 * run.values[2], run.cpu_s)};
}

} // namespace

void run_fidelity_study(const StudyOptions &options) {
  check_engine_path(options.out);
  const Plan plan = options.quick ? quick_plan() : full_plan();
  StudyResults results(options.out / "runs.csv", fidelity_runs());
  std::vector<std::vector<SeedRun>> groups;
  for (int seed = 1; seed <= plan.seeds; ++seed)
    for (const BedVariants &one : plan.beds) {
      groups.emplace_back();
      for (const Variant &variant : one.variants)
        groups.back().push_back({variant.name, seed, [&one, &variant, &options, &plan, seed] {
                                   return measured(measure(one.bed, variant, seed, options.out, plan.cycles));
                                 }});
    }
  const std::vector<std::string> failures = make_runs(groups, options.jobs, results);

  std::vector<Effect> effects;
  const std::vector<FidelityRun> runs = read_fidelity_runs(results.file());
  for (const BedComparison &comparison : plan.comparisons)
    if (const std::optional<Effect> effect = effect_of(runs, comparison)) effects.push_back(*effect);
  write_fidelity_page(options.out, runs, effects, failures);
  fmt::print("{}\n", (options.out / "index.html").string());
  if (!failures.empty())
    throw std::runtime_error(fmt::format("{} of the runs failed; the page tells which", failures.size()));
}

} // namespace drumlin::post
