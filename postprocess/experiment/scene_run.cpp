#include "experiment/scene_run.h"

#include "engine/engine_command.h"
#include "support/csv.h"
#include "support/files.h"
#include "support/progress.h"
#include "support/resumed.h"

#include <fmt/format.h>

#include <cstdint>

namespace drumlin::post {

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
