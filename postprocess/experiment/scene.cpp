#include "experiment/scene.h"

#include "engine/engine_command.h"
#include "support/units.h"
#include "support/csv.h"
#include "support/files.h"
#include "support/progress.h"
#include "support/resumed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <sstream>

namespace drumlin::post {

namespace {

constexpr int digits = 6; // of values that rules compute

// The time steps of case gravel: those of discs of 16 mm radius with k = 1e9 N/m, as many per cycle of 20 Hz
// as in.bed makes.
constexpr double gravel_radius = 0.016, gravel_k = 1e9, gravel_dt = 6.25e-6, gravel_frequency = 20.0;
constexpr int gravel_steps = 32; // in multiples of samples_per_cycle, 250
constexpr int samples_per_cycle = 250;

/// How much longer the time step of a scene is than that of case gravel. Contacts that yield are stiffer in
/// unloading.
double longer_step(const Scene &scene) {
  double stiffer = 1.0;
  for (const Setting &setting : scene.settings)
    if (setting.name == "yield") // the decks refuse what is below 1 or no number
      stiffer = std::max(1.0, any_number_from_text(setting.value).value_or(1.0));
  double smallest = std::numeric_limits<double>::infinity();
  for (const BedLayer &layer : scene.bed->layers)
    smallest = std::min(smallest, layer.packing.smallest_radius());
  if (scene.bed->layers.empty()) smallest = scene.bed->packing.radius_min;
  return smallest / gravel_radius * std::sqrt(gravel_k / (scene.stiffness * stiffer));
}

/// The variables that rules give, in the scope of each.
std::vector<Setting> settings_of_rules(const Scene &scene) {
  std::vector<Setting> settings;
  if (scene.frequency > 0.0)
    settings.push_back({Scope::run, "omega", number_text(2.0 * pi * scene.frequency)});
  if (scene.stiffness > 0.0) {
    const double longer = longer_step(scene);
    const double per_cycle = scene.frequency > 0.0 ? gravel_frequency / scene.frequency : 1.0;
    const int steps =
        samples_per_cycle *
        static_cast<int>(std::ceil(scene.more_steps * std::ceil(gravel_steps / longer * per_cycle)));
    settings.push_back({Scope::all, "k", number_text(scene.stiffness, digits)});
    settings.push_back({Scope::all, "dt", number_text(gravel_dt * longer, digits)});
    settings.push_back({Scope::run, "steps_per_cycle", std::to_string(steps)});
  }
  return settings;
}

bool reaches(Scope scope, SceneDeck deck) {
  switch (scope) {
  case Scope::all:
    return true;
  case Scope::settle:
    return deck == SceneDeck::settle;
  case Scope::placed:
    return deck != SceneDeck::settle;
  case Scope::run:
    return deck == SceneDeck::run;
  }
  return false;
}

std::string text_of(const PackingOptions &packing) {
  return fmt::format("{} {} {} {} {} {} {} ", packing.balls, packing.width, packing.depth, packing.height,
                     packing.radius_min, packing.radius_max,
                     grading_name(packing.grading) + packing.sieve_name);
}

/// The power of the scale of lengths with which a variable of the decks goes in the plane; 0 if it does not
/// depend on it.
int power_of(const std::string &name) {
  static const std::map<std::string, int> powers = {
      {"r2", 1}, {"r3", 1}, {"ground_depth", 1}, {"suction", 1}, {"tensile_strength", 1},
      {"m2", 2}, {"m3", 2}, {"k23", 2},          {"c23", 2},     {"Fw", 2},
      {"k", 2}};
  const auto found = powers.find(name);
  return found == powers.end() ? 0 : found->second;
}

/// A number, or several separated by commas, times a factor.
std::string scaled_text(const std::string &text, double factor) {
  std::string scaled, cell;
  for (std::istringstream cells(text); std::getline(cells, cell, ',');)
    scaled += (scaled.empty() ? "" : ",") + number_text(number_from_text(cell) * factor, digits);
  return scaled;
}

} // namespace

int SoilBed::balls() const {
  if (layers.empty()) return packing.balls;
  int sum = 0;
  for (const BedLayer &layer : layers)
    sum += layer.packing.balls;
  return sum;
}

std::string deck_of(const Scene &scene, SceneDeck deck) {
  if (deck == SceneDeck::run) return scene.deck;
  const std::filesystem::path own = scene.deck;
  const std::string name = deck == SceneDeck::settle ? "in.settle" : "in.place";
  return (own.parent_path() / (engine_of(own) == Engine::lammps ? name + ".lammps" : name)).string();
}

Variables variables_of(const Scene &scene, SceneDeck deck) {
  Variables found;
  const auto add = [&](const Setting &setting) {
    if (reaches(setting.scope, deck) &&
        std::none_of(found.begin(), found.end(), [&](const auto &one) { return one.first == setting.name; }))
      found.emplace_back(setting.name, setting.value);
  };
  // Of two values of a name the one that fewer decks get counts.
  for (const Scope scope : {Scope::run, Scope::placed, Scope::settle, Scope::all})
    for (const Setting &setting : scene.settings)
      if (setting.scope == scope) add(setting);
  for (const Setting &setting : settings_of_rules(scene))
    add(setting);
  if (scene.bed && deck != SceneDeck::run) add({Scope::all, "ratio", scene.bed->ratio});
  return found;
}

std::string value_of(const Scene &scene, const std::string &name) {
  for (const auto &[variable, value] : variables_of(scene, SceneDeck::run))
    if (variable == name) return value;
  return {};
}

Scene scaled(Scene scene, int balls, int of) {
  if (balls == of) return scene;
  const double scale = std::sqrt(static_cast<double>(balls) / of), area = scale * scale;
  SoilBed &bed = *scene.bed;
  bed.packing.balls = static_cast<int>(static_cast<long>(bed.packing.balls) * balls / of);
  bed.packing.width *= scale;
  bed.packing.height *= scale;
  for (Spot &spot : bed.spots)
    spot = {spot.from * scale, spot.to * scale};
  for (BedLayer &layer : bed.layers) {
    layer.packing.width *= scale;
    layer.thickness = number_from_text(number_text(layer.thickness * scale, digits));
    layer.packing.balls = balls_of(layer);
  }
  scene.stiffness *= area;
  for (Setting &setting : scene.settings)
    if (const int power = power_of(setting.name); power > 0)
      setting.value = scaled_text(setting.value, power == 1 ? scale : area);
  return scene;
}

std::string soil_text(const Scene &scene) {
  std::string text = deck_of(scene, SceneDeck::settle) + " " + text_of(scene.bed->packing);
  for (const BedLayer &layer : scene.bed->layers) {
    text += fmt::format("{} {}", layer.thickness, text_of(layer.packing));
    if (layer.pouring) text += fmt::format("{} ", layer.pouring->relative_density);
  }
  for (const Spot &spot : scene.bed->spots)
    text += fmt::format("{}:{} ", spot.from, spot.to);
  return text + words_of(variables_of(scene, SceneDeck::settle));
}

const Expected *known_value(const Scene &scene, const std::string &quantity) {
  for (const Expected &one : scene.expected)
    if (one.quantity == quantity) return &one;
  return nullptr;
}

std::string words_of(const Variables &variables) {
  std::string words;
  for (const auto &[name, value] : variables)
    words += fmt::format("{}={} ", name, value);
  return words;
}

Variables joined(Variables first, const Variables &second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

namespace fs = std::filesystem;

namespace {

fs::path bed_folder(const fs::path &out) {
  fs::path folder = fs::absolute(out / "beds");
  fs::create_directories(folder);
  return folder;
}

fs::path soil_file(const Scene &scene, int seed, const fs::path &folder) {
  return folder / fmt::format("soil_{}_{}.soil", seed, fingerprint(soil_text(scene)));
}

/// The data file that the decks write beside a restart file; those for LAMMPS start from it.
fs::path data_of(const fs::path &restart) { return restart.string() + ".data"; }

/// Gives a finished restart file its name, the last of its files.
void publish(const Scene &scene, const fs::path &finished, const fs::path &file) {
  if (engine_of(scene.deck) == Engine::lammps) fs::rename(data_of(finished), data_of(file));
  fs::rename(finished, file);
}

/// The text of cost.csv. A deck without a line `run` has no loop.
std::string cost_text(const DeckRun &run) {
  const std::string loop = run.outcome().says("Loop time of ") ? number_text(run.loop_seconds()) : "";
  return "loop [s],processor [s],memory [B]\n" +
         csv_line({loop, number_text(run.outcome().cpu_seconds), number_text(run.outcome().peak_bytes)});
}

void remove_bed(const fs::path &file) {
  fs::remove(file);
  fs::remove(data_of(file));
}

/// A file that a scene reads, in the folder `beds` of `out`; made if an earlier call did not finish it.
fs::path made_file(const MadeFile &made, const Variables &above, const fs::path &out) {
  const Variables variables = joined(made.settings, above);
  const fs::path folder = bed_folder(out);
  fs::path done =
      folder / fmt::format("{}_{}", made.variable, fingerprint(made.deck + " " + words_of(variables)));
  if (fs::exists(done)) return done;
  const TemporaryFolder unfinished(folder, "unfinished.");
  const fs::path file = unfinished.path() / "made";
  print_progress(fmt::format("making {} by {}", done.filename().string(), made.deck));
  DeckRun(made.deck, joined(variables, {{made.output, file.string()}})).must_succeed();
  fs::rename(file, done);
  return done;
}

} // namespace

fs::path settled_soil(const Scene &scene, int seed, const fs::path &out) {
  const fs::path folder = bed_folder(out);
  fs::path done = soil_file(scene, seed, folder);
  if (fs::exists(done)) return done;
  PackingOptions packing = scene.bed->packing;
  std::vector<BedLayer> layers = scene.bed->layers;
  packing.seed = static_cast<std::uint64_t>(seed);
  for (BedLayer &layer : layers)
    layer.packing.seed = packing.seed;
  const TemporaryFolder unfinished(folder, "unfinished.");
  const fs::path balls = unfinished.path() / "balls", soil = unfinished.path() / "soil";
  write_files(
      {{balls, layers.empty() ? bed_data(packing, soil_density, pack_balls(packing))
                              : bed_data(layers, soil_density, pack_layers(layers), scene.bed->spots)}});
  print_progress(fmt::format("settling the soil of {}, seed {}", scene.name, seed));
  DeckRun(deck_of(scene, SceneDeck::settle),
          joined(variables_of(scene, SceneDeck::settle), {{"balls", balls.string()}, {"bed", soil.string()}}))
      .must_succeed();
  publish(scene, soil, done);
  return done;
}

std::string placed_name(const Scene &scene, int seed) {
  return fmt::format("roller_{}_{}", seed,
                     fingerprint(soil_text(scene) + words_of(variables_of(scene, SceneDeck::place))));
}

fs::path placed_roller(const Scene &scene, int seed, const fs::path &out, Soil kept) {
  const fs::path folder = bed_folder(out);
  fs::path done = folder / (placed_name(scene, seed) + ".restart");
  if (!fs::exists(done)) {
    const fs::path soil = settled_soil(scene, seed, out);
    const TemporaryFolder unfinished(folder, "unfinished.");
    const fs::path roller = unfinished.path() / "roller";
    print_progress(fmt::format("placing the roller of {}, seed {}", scene.name, seed));
    DeckRun(deck_of(scene, SceneDeck::place), joined(variables_of(scene, SceneDeck::place),
                                                     {{"bed", soil.string()}, {"start", roller.string()}}))
        .must_succeed();
    publish(scene, roller, done);
  }
  if (kept == Soil::used_up) remove_bed(soil_file(scene, seed, folder));
  return done;
}

std::unique_ptr<DeckRun> run_scene(const Scene &scene, int seed, const fs::path &out, Soil soil) {
  Variables files;
  for (const MadeFile &made : scene.made)
    files.emplace_back(made.variable, made_file(made, files, out).string());
  Variables variables = joined(variables_of(scene, SceneDeck::run), files);
  if (scene.bed) variables.emplace_back("start", placed_roller(scene, seed, out, soil).string());
  if (!scene.seed_variable.empty()) variables.emplace_back(scene.seed_variable, std::to_string(seed));
  auto run = std::make_unique<DeckRun>(scene.deck, variables, scene.ranks);
  run->must_succeed();
  write_files({{run->file(cost_name), cost_text(*run)}});
  return run;
}

} // namespace drumlin::post
