#include "studies/studies.h"

#include "engine/deck_run.h"
#include "studies/box/results.h"
#include "studies/placed_bed.h"
#include "studies/study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::post {

namespace {

/// A box, and floor and sides of it.
struct BoxVariant {
  std::string name;
  int width, depth;     ///< in those of the default box
  int ground_depth = 0; ///< below an absorbing floor [m]; 0: rigid floor and sides
};

struct BoxPlan {
  std::string beds; ///< in words
  PlacedBed bed;    ///< in the default box
  Variables run;    ///< of in.bed alone
  std::vector<BoxVariant> variants;
  std::vector<BedComparison> comparisons;
  int seeds, cycles;
};

BoxPlan quick_plan() {
  PlacedBed bed{"", {}, {}, "1e-2"};
  bed.packing.balls = 100;
  bed.packing.width = 0.4;
  bed.scene = {{"case", "loose"}, {"m2", "100"},  {"m3", "50"},  {"r2", "0.1"},
               {"r3", "0.05"},    {"k23", "5e4"}, {"c23", "500"}};
  return {"100 discs of case loose, a test of the study",
          bed,
          {{"Fw", "2940"}},
          {{default_box, 1, 1}, {"default absorb", 1, 1, 1}, {"width 2 rigid", 2, 1}},
          {{"width 2 instead of 1", "width 2 rigid", default_box},
           {"absorbing instead of rigid", "default absorb", default_box}},
          2,
          4};
}

BoxPlan full_plan() {
  // Forces that are unbalanced at a ratio of 1, a ball's weight, are a thousandth of the roller's weight.
  PlacedBed bed{"", {}, {{"case", "gravel"}}, "1"};
  // As deep in relation to the width as the default bed, with discs of twice the radius: a fiftieth of its time.
  bed.packing.balls = 250;
  bed.packing.width = 1.26; // m
  bed.packing.radius_min = 0.032;
  bed.packing.radius_max = 0.048;
  constexpr int
      near = 1,
      far = 4; // m, of ground: nearly as deep together with the bed as beds of twice and four times its depth
  return {"250 discs of case gravel, radii 32 to 48 mm, in a box 1.26 m wide, which they fill to 1.2 m",
          bed,
          {},
          {{default_box, 1, 1},
           {"default absorb", 1, 1, near},
           {"default absorb 4 m", 1, 1, far},
           {"width 2 rigid", 2, 1},
           {"width 2 absorb", 2, 1, near},
           {"depth 2 rigid", 1, 2},
           {"depth 2 absorb", 1, 2, near},
           {"width 4 rigid", 4, 1},
           {"width 4 absorb", 4, 1, near},
           {"depth 4 rigid", 1, 4},
           {"depth 4 absorb", 1, 4, near}},
          {{"a box twice as wide", "width 2 rigid", default_box},
           {"four times as wide", "width 4 rigid", default_box},
           {"a bed twice as deep", "depth 2 rigid", default_box},
           {"four times as deep", "depth 4 rigid", default_box},
           {"absorbing instead of rigid", "default absorb", default_box},
           {"absorbing with 4 m of ground instead of rigid", "default absorb 4 m", default_box},
           {"absorbing instead of rigid at twice the width", "width 2 absorb", "width 2 rigid"},
           {"absorbing instead of rigid at four times the width", "width 4 absorb", "width 4 rigid"},
           {"absorbing instead of rigid at twice the depth", "depth 2 absorb", "depth 2 rigid"},
           {"absorbing instead of rigid at four times the depth", "depth 4 absorb", "depth 4 rigid"}},
          3,
          6};
}

BoxRun measure(const BoxPlan &plan, const BoxVariant &variant, int seed, const std::filesystem::path &out) {
  PlacedBed bed = plan.bed;
  bed.name = fmt::format("box_{}_{}", variant.width, variant.depth);
  bed.packing.width *= variant.width;
  bed.packing.balls *= variant.width * variant.depth;
  BoxRun result;
  result.run = variant.name;
  result.seed = seed;
  result.width = variant.width;
  result.depth = variant.depth;
  result.boundary = variant.ground_depth > 0 ? "absorb" : "rigid";
  result.ground_depth = variant.ground_depth;
  Variables variables = joined(plan.run, bed.scene);
  variables.emplace_back("boundary", result.boundary);
  if (variant.ground_depth > 0) variables.emplace_back("ground_depth", std::to_string(variant.ground_depth));
  const DeckRun run("bed/in.bed", with_start(variables, placed(bed, seed, out), plan.cycles));
  run.must_succeed();
  result.values = box_values(run.file(""));
  result.cpu_s = run.outcome().cpu_seconds;
  return result;
}

MeasuredRun measured(const BoxRun &run) {
  std::vector<std::string> words;
  for (const std::size_t q : {0U, 1U, 2U})
    words.push_back(fmt::format("{} {:.3g} {}", box_quantities[q].name,
                                box_quantities[q].scale * run.values[q], box_quantities[q].unit));
  return {box_runs().cells(run), fmt::format("{}", fmt::join(words, ", "))};
}

} // namespace

void run_box_study(const StudyOptions &options) {
  check_engine_path(options.out);
  const BoxPlan plan = options.quick ? quick_plan() : full_plan();
  StudyResults results(options.out / "runs.csv", box_runs());
  std::vector<std::vector<SeedRun>> groups; // one for each seed
  for (int seed = 1; seed <= plan.seeds; ++seed) {
    groups.emplace_back();
    for (const BoxVariant &variant : plan.variants)
      groups.back().push_back({variant.name, seed, [&plan, &variant, &options, seed] {
                                 return measured(measure(plan, variant, seed, options.out));
                               }});
  }
  const std::vector<std::string> failures = make_runs(groups, options.jobs, results);
  write_box_page(options.out, plan.beds, read_points(results.file(), box_runs()), plan.comparisons, failures);
  fmt::print("{}\n", (options.out / "index.html").string());
  if (!failures.empty())
    throw std::runtime_error(fmt::format("{} of the runs failed; the page tells which", failures.size()));
}

} // namespace drumlin::post
