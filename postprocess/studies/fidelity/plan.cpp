#include "studies/fidelity/plan.h"

#include "support/csv.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

namespace drumlin::post {

namespace {

constexpr int digits = 6;              // of scaled values
constexpr double default_k = 1e9;      // N/m, of case gravel
constexpr double default_dt = 6.25e-6; // s, of in.place for that k and balls of 16 mm radius
constexpr int default_steps = 32;      // per cycle, in multiples of 250
constexpr double default_ground = 2.0; // m, below a floor that absorbs, of in.bed

/// The variables of a roller and its force on a bed whose lengths are `scale` times the default's; none for the default.
Variables roller_of(double scale) {
  if (scale == 1.0) return {};
  const double area = scale * scale;
  const auto value = [](double number) { return number_text(number, digits); };
  return {{"r2", value(0.35 * scale)},  {"r3", value(0.25 * scale)}, {"m2", value(2000.0 * area)},
          {"m3", value(1000.0 * area)}, {"k23", value(1e6 * area)},  {"c23", value(1e4 * area)}};
}

/// The name of a scene's files: the engine splits a path at spaces.
std::string file_name(const std::string &scene) {
  std::string name;
  for (const char letter : scene)
    if (std::isalnum(static_cast<unsigned char>(letter)) != 0)
      name += letter;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  return name;
}

/// A copy of a scene in which some variables of its decks have other values.
/// \param values of all its decks
/// \param run of in.bed alone
FidelityScene with(FidelityScene scene, const std::string &name, const std::string &change,
                   const Variables &values, const Variables &run = {}) {
  scene.name = name;
  scene.bed.name = file_name(name);
  scene.change = change;
  scene.bed.scene.insert(scene.bed.scene.begin(), values.begin(), values.end()); // the first value counts
  scene.run.insert(scene.run.begin(), run.begin(), run.end());
  return scene;
}

/// The scene with another stiffness of the contacts and the time steps for it and for the smallest ball.
FidelityScene with_stiffness(const FidelityScene &scene, double k) {
  const double longer = scene.bed.packing.radius_min / PackingOptions().radius_min * std::sqrt(default_k / k);
  const int steps = 250 * static_cast<int>(std::ceil(default_steps / longer));
  return with(scene, scene.name, scene.change,
              {{"k", number_text(k, digits)}, {"dt", number_text(default_dt * longer, digits)}},
              {{"steps_per_cycle", std::to_string(steps)}});
}

} // namespace

std::vector<BedComparison> FidelityPlan::comparisons() const {
  std::vector<BedComparison> all;
  for (const FidelityScene &scene : scenes)
    if (!scene.base.empty()) all.push_back({scene.change, scene.name, scene.base});
  return all;
}

FidelityPlan quick_fidelity_plan() {
  PlacedBed bed = small_bed();
  bed.name = "base";
  bed.scene.emplace_back("m3", "50");
  const FidelityScene base{"base", "", "", bed, {{"Fw", "2940"}}};
  FidelityScene compared = base;
  compared.base = base.name;
  return {{base, with(compared, "A", "A instead of B", {}, {{"transition", "A"}}),
           with(compared, "rolling", "rolling friction", {{"rolling", "0.1"}})},
          2,
          4};
}

// The plan is longer than other functions, since it has a line for each scene and little else.
FidelityPlan fidelity_plan(int balls) {
  const double scale = std::sqrt(static_cast<double>(balls) / default_balls);
  const double k = default_k * scale * scale;
  // A roller at rest on the bed weighs 10,000 balls: forces that are unbalanced at a ratio of 1 are small beside it.
  PlacedBed bed{"", {}, joined({{"case", "gravel"}}, roller_of(scale)), "1"};
  bed.packing.balls = balls;
  bed.packing.width *= scale;
  const FidelityScene whole{
      "", "", "", bed, {{"Fw", number_text(58.8e3 * scale * scale, digits)}, {"balance", "10"}}};
  FidelityScene complete = with_stiffness(with(whole, "complete", "", {}), k);
  complete.bed.soil = complete.bed.name;
  // A scene with the stiffness and the balls of the complete one, which may have other values and balls.
  const auto changed = [&](const std::string &name, const std::string &change, const Variables &values = {},
                           const Variables &run = {}) {
    FidelityScene scene = with(complete, name, change, values, run);
    scene.base = complete.name;
    scene.bed.soil.clear();
    return scene;
  };
  // A scene that differs from the complete one only after the soil has settled: it shares the soil.
  // `values` are given to in.place and in.bed, `run` to in.bed alone.
  const auto on_its_soil = [&](const std::string &name, const std::string &change, const Variables &values,
                               const Variables &run = {}) {
    FidelityScene scene = changed(name, change, {}, joined(values, run));
    scene.bed.place = values;
    scene.bed.soil = complete.bed.soil;
    return scene;
  };
  const auto sized = [&](const std::string &name, const std::string &change, int count, double smallest,
                         double largest, double stiffness) {
    FidelityScene scene = with(whole, name, change, {});
    scene.base = complete.name;
    scene.bed.packing.balls = count;
    scene.bed.packing.radius_min = smallest;
    scene.bed.packing.radius_max = largest;
    return with_stiffness(scene, stiffness);
  };
  FidelityScene graded =
      sized("wide grading", "radii 10 to 30 mm instead of 16 to 24, equal masses", balls, 0.010, 0.030, k);
  graded.bed.packing.grading = Grading::mass;
  graded.bed.packing.height =
      1.75 * bed.packing.width; // with small balls everywhere, large ones find less space
  FidelityScene shallow = changed("half as deep", "a bed half as deep");
  shallow.bed.packing.balls = balls / 2;
  FidelityScene deep = changed("twice as deep", "a bed twice as deep");
  deep.bed.packing.balls = 2 * balls;
  FidelityScene wide = changed("twice as wide", "a box twice as wide");
  wide.bed.packing.balls = 2 * balls;
  wide.bed.packing.width *= 2.0;
  // Settled with the friction that the bed has later, and not densely with little of it.
  FidelityScene loose = changed("not compacted", "packed loosely, with the friction of the bed");
  loose.bed.settle = {{"pour_friction", "0.8"}, {"pour_rolling", "0.45"}};
  const FidelityScene absorbing =
      on_its_soil("absorb", "floor and sides that absorb waves",
                  {{"boundary", "absorb"}, {"ground_depth", number_text(default_ground * scale, digits)}});
  // A base course as thick as the drum, on a subgrade: together as thick as the complete bed.
  FidelityScene layered =
      changed("layers", "the lower 64 % a soft, loose subgrade (case base_course)",
              {{"case", "base_course"}, {"k", number_text(0.1 * k, digits) + "," + number_text(k, digits)}});
  layered.bed.packing.balls = 0;
  for (const double thickness : {1.24, 0.7}) { // m, at the default size
    BedLayer layer{bed.packing, std::stod(number_text(thickness * scale, digits))};
    layer.packing.balls = balls_of(layer);
    layered.bed.packing.balls += layer.packing.balls;
    layered.bed.layers.push_back(layer);
  }
  const std::string twice = std::to_string(2 * std::stoi(complete.run.front().second));
  return {
      {complete,
       sized("large balls with k / 10", "balls twice as large, k / 10 with longer steps", balls / 4, 0.032,
             0.048, 0.1 * k),
       sized("large balls", "balls twice as large, a quarter of their number", balls / 4, 0.032, 0.048, k),
       sized("k / 100", "k / 100 with a tenth of the steps", balls, 0.016, 0.024, 0.01 * k),
       sized("k / 10", "k / 10 with 0.32 times the steps", balls, 0.016, 0.024, 0.1 * k), shallow,
       changed("no rolling friction", "no rolling friction", {{"rolling", "0"}}),
       on_its_soil("A", "A instead of B", {{"transition", "A"}}),
       changed("history", "the engine's friction (tangential history)", {{"tangential", "history"}}), loose,
       sized("one size", "balls of one size", balls, 0.02, 0.02, k),
       changed("second", "stepping second instead of stock", {{"stepping", "second"}}),
       on_its_soil("twice the steps", "twice the steps per cycle", {}, {{"steps_per_cycle", twice}}),
       absorbing, layered, deep, wide, graded,
       on_its_soil("clump", "drum a clump instead of a ball", {{"drum", "clump"}})}};
}

} // namespace drumlin::post
