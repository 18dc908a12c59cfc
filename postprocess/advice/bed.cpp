#include "advice/bed.h"

#include "support/units.h"
#include "support/text.h"
#include "support/usage_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace drumlin::post {

namespace {

/// A scene counts as cheaper than the complete one if it takes at most this share of its processor time.
constexpr double most_of_cheaper = 0.9;

constexpr int most_beds = 1000000;

/// The smallest number of beds of which the mean has a half width of at most `within`; at least 2, at most
/// `most_beds`.
int beds_for(double scatter, double within) {
  int beds = 2;
  while (beds < most_beds && t_factor(beds - 1.0) * scatter / std::sqrt(static_cast<double>(beds)) > within)
    ++beds;
  return beds;
}

/// Words `-var NAME VALUE`.
std::string variable_words(const Variables &variables) {
  std::string text;
  for (const auto &[name, value] : variables)
    text += fmt::format(" -var {} {}", name, shell_word(value));
  return text;
}

} // namespace

BedExperiment read_bed_experiment(const std::filesystem::path &folder) {
  for (const char *name : {plan_name, results_name})
    if (!std::filesystem::is_regular_file(folder / name))
      throw UsageError(
          refusal("--from", folder.string(),
                  fmt::format("folders of a study of beds, with {} and {}", plan_name, results_name)));
  const Plan plan = read_plan(folder / plan_name);
  BedExperiment found{plan, read_results(folder, plan)};
  for (const Scene &scene : found.plan.scenes)
    if (!scene.bed) throw UsageError(refusal("--from", folder.string(), "folders of a study of beds"));
  return found;
}

BedAdvice advise_bed(const BedExperiment &experiment, const BedQuestion &question) {
  const Plan &plan = experiment.plan;
  const Results &results = experiment.results;
  const Scene &complete = plan.scenes.front();
  const auto quantity = std::find_if(plan.quantities.begin(), plan.quantities.end(),
                                     [&](const Quantity &one) { return one.name == question.quantity; });
  if (quantity == plan.quantities.end())
    throw UsageError(refusal("--question", question.name, "a quantity that the study has measured"));
  const std::vector<double> values = numbers(results.values(complete.name, question.quantity));
  BedAdvice best;
  best.least_error = std::numeric_limits<double>::infinity();
  bool compared = false;
  for (const Effect &effect : effects_of(plan, results)) {
    const auto &[scene, base] = effect.compared->pairs.front();
    if (effect.compared->pairs.size() > 1 || base != complete.name) continue;
    const std::optional<Change> &change =
        effect.changes[static_cast<std::size_t>(quantity - plan.quantities.begin())];
    if (!change || !std::isfinite(change->difference.half_width)) continue;
    compared = true;
    if (!(effect.cost <= most_of_cheaper)) continue;
    const MeanInterval &error = question.absolute ? change->difference : change->relative;
    const double largest = std::fabs(error.mean) + error.half_width;
    if (largest < best.least_error) {
      best.least_error = largest;
      best.closest = scene;
    }
    if (error.within(question.within) && (best.scene == nullptr || effect.cost < best.cost)) {
      best.scene = &plan.scene(scene);
      best.differs = effect.compared->words;
      best.error = error;
      best.seeds = effect.seeds;
      best.cost = effect.cost;
    }
  }
  if (!compared)
    throw std::runtime_error(
        refusal("the table of results", fmt::format("{} scenes", results.scenes().size()),
                "one with two seeds or more of a scene and of the complete one, the first of the plan"));
  const MeanInterval mean = mean_interval(values);
  if (!question.absolute && !mean.significant())
    throw std::runtime_error(
        refusal("--question", question.name,
                fmt::format("a result whose mean over the complete beds differs from zero: theirs is {:.2g} "
                            "+- {:.2g}, and no error relative to it can be given{}",
                            mean.mean, mean.half_width,
                            quantity->absolute ? "; or --within in mm per cycle, as 2mm" : "")));
  if (best.scene == nullptr) {
    best.scene = &complete;
    best.seeds = values.size();
  }
  if (const std::vector<double> costs = numbers(results.costs(best.scene->name)); !costs.empty())
    best.cpu_s = median(costs);
  double squares = 0.0;
  for (const double value : values)
    squares += std::pow(value - mean.mean, 2);
  best.scatter = std::sqrt(squares / static_cast<double>(values.size() - 1));
  if (!question.absolute) best.scatter /= std::fabs(mean.mean);
  best.beds = beds_for(best.scatter, question.within);
  return best;
}

std::vector<SceneScatter> scatter_of_scenes(const BedExperiment &experiment, const BedQuestion &question) {
  std::vector<SceneScatter> all;
  for (const Scene &scene : experiment.plan.scenes) {
    const std::vector<double> values = numbers(experiment.results.values(scene.name, question.quantity));
    if (values.size() < 2) continue;
    SceneScatter one;
    one.scene = &scene;
    one.seeds = values.size();
    one.mean = mean_interval(values);
    one.scatter = scatter_interval(values);
    if (question.absolute || one.mean.significant()) {
      const double within = question.within * (question.absolute ? 1.0 : std::fabs(one.mean.mean));
      const auto beds = [within](double scatter) {
        const int found = beds_for(scatter, within);
        return found < most_beds ? found : 0;
      };
      one.beds = beds(one.scatter.estimate);
      one.least_beds = beds(one.scatter.least);
      one.most_beds = beds(one.scatter.most);
    }
    if (const std::vector<double> costs = numbers(experiment.results.costs(scene.name)); !costs.empty())
      one.cpu_s = median(costs);
    all.push_back(one);
  }
  std::stable_sort(all.begin(), all.end(), [](const SceneScatter &a, const SceneScatter &b) {
    return a.beds > 0 && (b.beds == 0 || a.total_s() < b.total_s());
  });
  return all;
}

std::string scene_words(const Scene &scene) {
  const PackingOptions &packing = scene.bed->packing;
  std::string words =
      fmt::format("{} dimensions, {} {} of {:g} to {:g} mm radius, box {:.3g} m wide", packing.dimensions(),
                  scene.bed->balls(), packing.dimensions() == 2 ? "discs" : "balls", 1e3 * packing.radius_min,
                  1e3 * packing.radius_max, packing.width);
  if (const std::string radius = value_of(scene, "r2"); !radius.empty())
    words += fmt::format(", under a drum of {} m radius", radius);
  return words;
}

std::vector<std::string> scene_commands(const Scene &scene) {
  const PackingOptions &packing = scene.bed->packing;
  const PackingOptions usual;
  std::string bed = "bed";
  if (scene.bed->layers.empty()) bed += fmt::format(" --balls {}", packing.balls);
  for (const BedLayer &layer : scene.bed->layers)
    bed += fmt::format(" --layer {}", layer.thickness) +
           (layer.packing.sieve // SMALLEST-LARGEST, cut at the smallest
                ? fmt::format(":{0}:{1}", layer.packing.sieve_name,
                              layer.packing.sieve_name.substr(0, layer.packing.sieve_name.find('-', 1)))
                : "");
  for (const BedLayer &layer : scene.bed->layers)
    if (layer.pouring) bed += fmt::format(" --relative-density {}", layer.pouring->relative_density);
  for (const Spot &spot : scene.bed->spots)
    bed += fmt::format(" --spot {}:{}", spot.from, spot.to);
  bed += fmt::format(" --width {}", packing.width);
  if (packing.depth > 0.0) bed += fmt::format(" --depth {}", packing.depth);
  if (packing.height > 0.0) bed += fmt::format(" --height {}", packing.height);
  const std::vector<BedLayer> &layers = scene.bed->layers;
  const bool has_radii =
      layers.empty() ||
      std::any_of(layers.begin(), layers.end(), [](const BedLayer &layer) { return !layer.packing.sieve; });
  if (has_radii && (packing.radius_min != usual.radius_min || packing.radius_max != usual.radius_max))
    bed += fmt::format(" --radius-min {} --radius-max {}", packing.radius_min, packing.radius_max);
  if (packing.grading != usual.grading) bed += " --grading " + grading_name(packing.grading);
  std::vector<std::string> commands = {bed};
  for (const SceneDeck deck : {SceneDeck::settle, SceneDeck::place, SceneDeck::run})
    commands.push_back(
        fmt::format("run {}{}", shell_word(("inputs" / std::filesystem::path(deck_of(scene, deck))).string()),
                    variable_words(variables_of(scene, deck))));
  return commands;
}

} // namespace drumlin::post
