#include "studies/fidelity/advice.h"

#include "support/range.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>

namespace drumlin::post {

namespace {

std::vector<double> values_of(const std::vector<FidelityRun> &runs, const std::string &scene,
                              std::size_t quantity) {
  std::vector<double> values;
  for (const FidelityRun &run : runs)
    if (run.variant == scene && std::isfinite(run.values[quantity])) values.push_back(run.values[quantity]);
  return values;
}

/// The largest error that the 95 % confidence interval of a change leaves possible.
double largest_error(const MeanInterval &change) { return std::fabs(change.mean) + change.half_width; }

/// A scene counts as cheaper than the complete one if it takes at most this share of its processor time. Measured times depend on
/// what else the machine does, so that a smaller saving may be chance.
constexpr double most_of_cheaper = 0.9;

/// The smallest number of beds of which the mean has a half width of at most `within`; at least 2.
int beds_for(double scatter, double within) {
  constexpr int most = 1000000;
  int beds = 2;
  while (beds < most && t_factor(beds - 1.0) * scatter / std::sqrt(static_cast<double>(beds)) > within)
    ++beds;
  return beds;
}

/// Words `-var NAME VALUE`, the first value of each name.
std::string variable_words(const Variables &variables) {
  std::set<std::string> seen;
  std::string text;
  for (const auto &[name, value] : variables)
    if (seen.insert(name).second) text += fmt::format(" -var {} {}", name, value);
  return text;
}

} // namespace

FidelityPlan plan_of(const std::vector<FidelityRun> &runs) {
  const std::string name = fidelity_plan(default_balls).reference().name;
  for (const FidelityRun &run : runs)
    if (run.variant == name && run.balls > 0) return fidelity_plan(run.balls);
  throw std::runtime_error(
      refusal("the table of scenes", fmt::format("{} runs", runs.size()),
              fmt::format("one with runs of the scene '{}', with which the others are compared", name)));
}

BedAdvice advise_bed(const FidelityPlan &plan, const std::vector<FidelityRun> &runs,
                     const BedAdviceRequest &request) {
  const auto q = static_cast<std::size_t>(request.question);
  BedAdvice best;
  best.least_error = std::numeric_limits<double>::infinity();
  bool compared = false;
  for (const FidelityScene &scene : plan.scenes) {
    if (scene.base != plan.reference().name) continue;
    const std::optional<Effect> effect = effect_of(runs, {scene.change, scene.name, scene.base});
    if (!effect) continue;
    const MeanInterval &change = (request.absolute ? effect->difference : effect->change)[q];
    if (!std::isfinite(change.half_width)) continue;
    compared = true;
    if (effect->cost > most_of_cheaper) continue;
    const double error = largest_error(change);
    if (error < best.least_error) {
      best.least_error = error;
      best.closest = scene.name;
    }
    if (error <= request.within && (best.scene == nullptr || effect->cost < best.effect.cost)) {
      best.scene = &scene;
      best.effect = *effect;
    }
  }
  if (!compared)
    throw std::runtime_error(refusal("the table of scenes", fmt::format("{} runs", runs.size()),
                                     "one with two seeds or more of a scene and of the complete one"));
  const std::vector<double> complete = values_of(runs, plan.reference().name, q);
  const MeanInterval mean = mean_interval(complete);
  if (!request.absolute && !mean.significant())
    throw std::runtime_error(refusal("--question", request.name,
                                     fmt::format("a result whose mean over the complete beds differs from "
                                                 "zero: theirs is {:.2g} +- {:.2g}, and no "
                                                 "error relative to it can be given{}",
                                                 mean.mean, mean.half_width,
                                                 request.question == BedQuantity::settlement
                                                     ? "; or --within in mm per cycle, as 2mm"
                                                     : "")));
  if (best.scene == nullptr) {
    best.scene = &plan.reference();
    best.effect = {{}, static_cast<int>(complete.size()), {}, {}, 1.0};
  }
  std::vector<double> times;
  for (const FidelityRun &run : runs)
    if (run.variant == best.scene->name) times.push_back(run.cpu_s);
  best.cpu_s = median(times);
  double squares = 0.0;
  for (const double value : complete)
    squares += std::pow(value - mean.mean, 2);
  best.scatter = std::sqrt(squares / static_cast<double>(complete.size() - 1));
  if (!request.absolute) best.scatter /= std::fabs(mean.mean);
  best.beds = beds_for(best.scatter, request.within);
  return best;
}

std::string scene_words(const FidelityScene &scene) {
  const PackingOptions &packing = scene.bed.packing;
  std::string words =
      fmt::format("{} dimensions, {} {} of {:g} to {:g} mm radius, box {:.3g} m wide", packing.dimensions(),
                  packing.balls, packing.dimensions() == 2 ? "discs" : "balls", 1e3 * packing.radius_min,
                  1e3 * packing.radius_max, packing.width);
  for (const auto &[name, value] : scene.bed.scene)
    if (name == "r2") words += fmt::format(", under a drum of {} m radius", value);
  return words;
}

std::vector<std::string> scene_commands(const FidelityScene &scene, int cycles) {
  const PackingOptions &packing = scene.bed.packing;
  const PackingOptions usual;
  std::string bed = "bed";
  if (scene.bed.layers.empty()) bed += fmt::format(" --balls {}", packing.balls);
  for (const BedLayer &layer : scene.bed.layers)
    bed += fmt::format(" --layer {}", layer.thickness);
  bed += fmt::format(" --width {}", packing.width);
  if (packing.depth > 0.0) bed += fmt::format(" --depth {}", packing.depth);
  if (packing.height > 0.0) bed += fmt::format(" --height {}", packing.height);
  if (packing.radius_min != usual.radius_min || packing.radius_max != usual.radius_max)
    bed += fmt::format(" --radius-min {} --radius-max {}", packing.radius_min, packing.radius_max);
  if (packing.grading != usual.grading) bed += " --grading " + grading_name(packing.grading);
  const Variables ratio = {{"ratio", scene.bed.ratio}};
  return {bed,
          "run inputs/bed/in.settle" +
              variable_words(joined(joined(scene.bed.settle, scene.bed.scene), ratio)),
          "run inputs/bed/in.place" + variable_words(joined(joined(scene.bed.place, scene.bed.scene), ratio)),
          "run inputs/bed/in.bed" +
              variable_words(joined(scene.run_variables(), {{"cycles", std::to_string(cycles)}}))};
}

} // namespace drumlin::post
