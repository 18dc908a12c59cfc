#include "studies/fidelity/plan.h"

#include "support/csv.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace drumlin::post {

namespace {

constexpr int digits = 6; // of scaled values

/// The variables of a roller and its force on a bed whose lengths are `scale` times the default's; none for the default.
Variables roller_of(double scale) {
  if (scale == 1.0) return {};
  const double area = scale * scale;
  const auto value = [](double number) { return number_text(number, digits); };
  return {{"r2", value(0.35 * scale)},  {"r3", value(0.25 * scale)}, {"m2", value(2000.0 * area)},
          {"m3", value(1000.0 * area)}, {"k23", value(1e6 * area)},  {"c23", value(1e4 * area)}};
}

/// The scene with other values, which all its decks take.
FidelityScene with(FidelityScene scene, const std::string &name, const std::string &change,
                   const Variables &values, const Variables &run = {}) {
  scene.name = scene.bed.name = scene.bed.soil = name;
  scene.change = change;
  scene.bed.scene.insert(scene.bed.scene.begin(), values.begin(), values.end()); // the first value counts
  scene.run.insert(scene.run.begin(), run.begin(), run.end());
  return scene;
}

/// The same bed, shaken in another way.
FidelityScene shaken(FidelityScene scene, const std::string &name, const std::string &change,
                     const Variables &run) {
  scene.name = name;
  scene.change = change;
  scene.run.insert(scene.run.begin(), run.begin(), run.end());
  return scene;
}

/// The same soil under a roller that is placed with other values.
FidelityScene replaced(FidelityScene scene, const std::string &name, const std::string &change,
                       const Variables &values) {
  const std::string soil = scene.bed.soil;
  scene = with(std::move(scene), name, change, values);
  scene.bed.soil = soil;
  return scene;
}

} // namespace

std::vector<BedComparison> FidelityPlan::comparisons() const {
  std::vector<BedComparison> all;
  for (const FidelityScene &scene : scenes)
    if (!scene.base.empty()) all.push_back({scene.change, scene.name, scene.base});
  return all;
}

FidelityPlan quick_fidelity_plan() {
  PlacedBed bed{"loose", {}, {}, "1e-2"};
  bed.packing.balls = 150;
  bed.packing.width = 0.6;
  bed.scene = {{"case", "loose"}, {"m2", "100"},  {"m3", "50"},  {"r2", "0.1"},
               {"r3", "0.05"},    {"k23", "5e4"}, {"c23", "500"}};
  const FidelityScene base{"base", "", "", bed, {{"Fw", "2940"}}};
  FidelityScene compared = base;
  compared.base = base.name;
  return {{base, shaken(compared, "A", "A instead of B", {{"transition", "A"}}),
           with(compared, "rolling", "rolling friction", {{"rolling", "0.1"}})},
          2,
          4};
}

// The plan is longer than other functions, since it has a line for each scene and little else.
FidelityPlan fidelity_plan(int balls) {
  const double scale = std::sqrt(static_cast<double>(balls) / default_balls);
  // A roller at rest on the bed weighs 10,000 balls: forces that are unbalanced at a ratio of 1 are small beside it.
  PlacedBed bed{"complete", {}, joined({{"case", "gravel"}}, roller_of(scale)), "1", {}, "complete"};
  bed.packing.balls = balls;
  bed.packing.width *= scale;
  const FidelityScene complete{
      "complete", "", "", bed, {{"Fw", number_text(58.8e3 * scale * scale, digits)}, {"balance", "10"}}};
  FidelityScene other = complete;
  other.base = complete.name;

  FidelityScene coarse = with(other, "large balls", "balls twice as large, a quarter of their number", {});
  coarse.bed.packing.balls = std::max(1, balls / 4);
  coarse.bed.packing.radius_min *= 2.0;
  coarse.bed.packing.radius_max *= 2.0;
  const auto soft = [](const FidelityScene &scene, const std::string &name, const std::string &change,
                       double divisor) {
    const double longer = std::sqrt(divisor); // steps that the contact time allows
    const double size = scene.bed.packing.radius_min / PackingOptions().radius_min;
    const int steps = 250 * static_cast<int>(std::ceil(32.0 / longer / size));
    return with(scene, name, change,
                {{"k", number_text(1e9 / divisor)}, {"dt", number_text(6.25e-6 * longer * size, digits)}},
                {{"steps_per_cycle", std::to_string(steps)}});
  };
  FidelityScene one_size = with(other, "one size", "balls of one size", {});
  one_size.bed.packing.radius_min = one_size.bed.packing.radius_max = 0.02;
  FidelityScene graded =
      with(other, "wide grading", "radii 10 to 30 mm instead of 16 to 24, equal masses", {});
  graded.bed.packing.radius_min = 0.010;
  graded.bed.packing.radius_max = 0.030;
  graded.bed.packing.grading = Grading::mass;
  graded.bed.packing.height =
      1.75 * graded.bed.packing.width; // with small balls everywhere, large ones find less space
  FidelityScene shallow = with(other, "half as deep", "a bed half as deep", {});
  shallow.bed.packing.balls = balls / 2;
  FidelityScene deep = with(other, "twice as deep", "a bed twice as deep", {});
  deep.bed.packing.balls = 2 * balls;
  FidelityScene wide = with(other, "twice as wide", "a box twice as wide", {});
  wide.bed.packing.balls = 2 * balls;
  wide.bed.packing.width *= 2.0;
  // Settled with the friction that the bed has later, and not densely with little of it.
  FidelityScene loose = with(other, "not compacted", "packed loosely, with the friction of the bed", {});
  loose.bed.settle = {{"pour_friction", "0.8"}, {"pour_rolling", "0.45"}};
  // As wide, as high and as dense as each other, the drum a clump in both.
  FidelityScene plane = with(complete, "plane", "two dimensions instead of three", {{"drum", "clump"}});
  plane.base = "space";
  plane.bed.packing.balls = std::max(1, static_cast<int>(std::lround(460.0 / default_balls * balls)));
  plane.bed.packing.width *= 0.5;
  FidelityScene space = with(complete, "space", "", {{"case", "gravel3d"}});
  space.bed.packing.width *= 0.5;
  space.bed.packing.depth = 0.2 * scale;
  return {{complete,
           soft(coarse, "large balls with k / 10", "balls twice as large, k / 10 with longer steps", 10.0),
           coarse, soft(other, "k / 100", "k / 100 with a tenth of the steps", 100.0),
           soft(other, "k / 10", "k / 10 with 0.32 times the steps", 10.0), shallow,
           shaken(other, "A", "A instead of B", {{"transition", "A"}}),
           with(other, "no rolling friction", "no rolling friction", {{"rolling", "0"}}), loose,
           with(other, "history", "the engine's friction (tangential history)", {{"tangential", "history"}}),
           one_size, with(other, "second", "stepping second instead of stock", {{"stepping", "second"}}),
           replaced(other, "clump", "drum a clump instead of a ball", {{"drum", "clump"}}),
           shaken(other, "twice the steps", "twice the steps per cycle", {{"steps_per_cycle", "16000"}}),
           deep, wide, graded, plane, space}};
}

} // namespace drumlin::post
