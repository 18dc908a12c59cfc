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

/// A box, and what floor and sides of it are in turn.
struct Box {
  int width, depth;               ///< in those of the default box
  int seeds;                      ///< how many beds
  std::vector<int> ground_depths; ///< below an absorbing floor [m]; 0: rigid floor and sides
};

struct BoxPlan {
  std::string beds; ///< in words
  PlacedBed bed;    ///< in the default box
  Variables run;    ///< of in.bed alone
  std::vector<Box> boxes;
  std::vector<BedComparison> comparisons;
  int cycles;
};

constexpr int rigid = 0, near = 1, far = 4; // m of ground

std::string run_name(const Box &box, int ground_depth) {
  std::vector<std::string> words;
  if (box.width > 1) words.push_back(fmt::format("width {}", box.width));
  if (box.depth > 1) words.push_back(fmt::format("depth {}", box.depth));
  if (words.empty()) words.emplace_back("default");
  words.emplace_back(ground_depth == rigid ? "rigid" : "absorb");
  if (ground_depth > near) words.push_back(fmt::format("{} m", ground_depth));
  return fmt::format("{}", fmt::join(words, " "));
}

BoxPlan quick_plan() {
  PlacedBed bed{"", {}, {}, "1e-2"};
  bed.packing.balls = 100;
  bed.packing.width = 0.4;
  bed.scene = {{"case", "loose"}, {"m2", "100"},  {"m3", "50"},  {"r2", "0.1"},
               {"r3", "0.05"},    {"k23", "5e4"}, {"c23", "500"}};
  return {"100 discs of case loose, a test of the study",
          bed,
          {{"Fw", "2940"}},
          {{1, 1, 2, {rigid, near}}, {2, 1, 2, {rigid}}},
          {{"width 2 instead of 1", "width 2 rigid", "default rigid"},
           {"absorbing instead of rigid", "default absorb", "default rigid"}},
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
  // An interrupted study has the whole rows of its first boxes.
  return {"250 discs of case gravel, radii 32 to 48 mm, in a box 1.26 m wide, which they fill to 1.2 m",
          bed,
          {},
          {{1, 1, 6, {rigid, near, far}},
           {4, 1, 3, {rigid, near}},
           {1, 2, 3, {rigid, near}},
           {2, 1, 3, {rigid, near}},
           {1, 4, 3, {rigid, near}},
           {4, 4, 3, {rigid, near}}},
          {{"absorbing instead of rigid", "default absorb", "default rigid"},
           {"absorbing with 4 m of ground instead of 1 m", "default absorb 4 m", "default absorb"},
           {"rigid: four times as wide", "width 4 rigid", "default rigid"},
           {"rigid: twice as deep", "depth 2 rigid", "default rigid"},
           {"rigid: four times as deep", "depth 4 rigid", "default rigid"},
           {"rigid: four times as wide and deep", "width 4 depth 4 rigid", "default rigid"},
           {"absorbing: four times as wide", "width 4 absorb", "default absorb"},
           {"absorbing: twice as deep", "depth 2 absorb", "default absorb"},
           {"absorbing: four times as deep", "depth 4 absorb", "default absorb"},
           {"absorbing: four times as wide and deep", "width 4 depth 4 absorb", "default absorb"}},
          6};
}

BoxRun measure(const BoxPlan &plan, const Box &box, int ground_depth, int seed,
               const std::filesystem::path &out) {
  PlacedBed bed = plan.bed;
  bed.name = fmt::format("box_{}_{}", box.width, box.depth);
  bed.packing.width *= box.width;
  bed.packing.balls *= box.width * box.depth;
  BoxRun result;
  result.run = run_name(box, ground_depth);
  result.seed = seed;
  result.width = box.width;
  result.depth = box.depth;
  result.boundary = ground_depth == rigid ? "rigid" : "absorb";
  result.ground_depth = ground_depth;
  Variables variables = joined(plan.run, bed.scene);
  variables.emplace_back("boundary", result.boundary);
  if (ground_depth != rigid) variables.emplace_back("ground_depth", std::to_string(ground_depth));
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
  ResumedTable results(options.out / "runs.csv", box_runs());
  std::vector<std::vector<SeedRun>>
      groups; // runs on the same bed, one after the other: the first of them makes the bed
  for (const Box &box : plan.boxes)
    for (int seed = 1; seed <= box.seeds; ++seed) {
      groups.emplace_back();
      for (const int ground_depth : box.ground_depths)
        groups.back().push_back(
            {run_name(box, ground_depth), seed, [&plan, &box, ground_depth, &options, seed] {
               return measured(measure(plan, box, ground_depth, seed, options.out));
             }});
    }
  const std::vector<std::string> failures = make_runs(groups, options.jobs, results);
  write_box_page(options.out, plan.beds, read_points(results.file(), box_runs()), plan.comparisons, failures);
  fmt::print("{}\n", (options.out / "index.html").string());
  if (!failures.empty())
    throw std::runtime_error(fmt::format("{} of the runs failed; the page tells which", failures.size()));
}

} // namespace drumlin::post
