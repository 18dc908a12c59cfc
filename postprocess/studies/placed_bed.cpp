#include "studies/placed_bed.h"

#include "engine/deck_run.h"
#include "support/files.h"
#include "support/parallel.h"
#include "support/progress.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

fs::path bed_folder(const fs::path &out) {
  fs::path folder = fs::absolute(out / "beds");
  fs::create_directories(folder);
  return folder;
}

std::string words_of(const Variables &variables) {
  std::string words;
  for (const auto &[name, value] : variables)
    words += fmt::format("{}={} ", name, value);
  return words;
}

std::string words_of(const PackingOptions &packing) {
  return fmt::format("{} {} {} {} {} {} {} ", packing.balls, packing.width, packing.depth, packing.height,
                     packing.radius_min, packing.radius_max,
                     grading_name(packing.grading) + packing.sieve_name);
}

/// Name of the file of a bed's soil, without its ending, with the fingerprint of all that it is made of.
std::string soil_stem(const PlacedBed &bed, int seed) {
  std::string made_of = words_of(bed.packing);
  for (const BedLayer &layer : bed.layers)
    made_of += fmt::format("{} {}", layer.thickness, words_of(layer.packing));
  made_of += words_of(bed.settle) + words_of(bed.scene) + bed.ratio;
  return fmt::format("{}_{}_{}", bed.soil.empty() ? bed.name : bed.soil, seed, fingerprint(made_of));
}

} // namespace

PlacedBed small_bed() {
  PlacedBed bed{"loose", {}, {}, "1e-2"};
  bed.packing.balls = 150;
  bed.packing.width = 0.6;
  bed.scene = {{"case", "loose"}, {"m2", "100"},  {"r2", "0.1"},
               {"r3", "0.05"},    {"k23", "5e4"}, {"c23", "500"}};
  return bed;
}

PlacedBed gravel_bed() {
  // Forces that are unbalanced at a ratio of 1, a ball's weight, are a ten-thousandth of the roller's weight;
  // in.bed would refuse them by default.
  PlacedBed bed{"gravel", {}, {{"case", "gravel"}}, "1"};
  bed.packing.balls = 1000;
  bed.packing.width = 1.26;
  return bed;
}

fs::path settled_soil(const PlacedBed &bed, int seed, const fs::path &out) {
  PackingOptions packing = bed.packing;
  std::vector<BedLayer> layers = bed.layers;
  packing.seed = static_cast<std::uint64_t>(seed);
  for (BedLayer &layer : layers)
    layer.packing.seed = packing.seed;
  const fs::path folder = bed_folder(out);
  fs::path done = folder / (soil_stem(bed, seed) + ".soil");
  if (fs::exists(done)) return done;
  const TemporaryFolder unfinished(folder, "unfinished.");
  const fs::path balls = unfinished.path() / "balls", soil = unfinished.path() / "soil";
  write_files({{balls, layers.empty() ? bed_data(packing, soil_density, pack_balls(packing))
                                      : bed_data(layers, soil_density, pack_layers(layers))}});
  print_progress(fmt::format("settling bed {}, seed {}", bed.soil.empty() ? bed.name : bed.soil, seed));
  Variables variables = joined(bed.settle, bed.scene);
  variables.insert(variables.end(),
                   {{"ratio", bed.ratio}, {"balls", balls.string()}, {"bed", soil.string()}});
  DeckRun("bed/in.settle", variables).must_succeed();
  fs::rename(soil, done);
  return done;
}

Variables joined(Variables first, const Variables &second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::string placed_name(const PlacedBed &bed, int seed) {
  return fmt::format("{}_{}_{}", bed.name, seed, fingerprint(soil_stem(bed, seed) + words_of(bed.place)));
}

fs::path placed(const PlacedBed &bed, int seed, const fs::path &out) {
  const fs::path folder = bed_folder(out);
  fs::path done = folder / (placed_name(bed, seed) + ".restart");
  if (!fs::exists(done)) {
    const fs::path soil = settled_soil(bed, seed, out);
    const TemporaryFolder unfinished(folder, "unfinished.");
    const fs::path roller = unfinished.path() / "roller";
    print_progress(fmt::format("placing the roller on bed {}, seed {}", bed.name, seed));
    Variables variables = joined(bed.place, bed.scene);
    variables.insert(variables.end(),
                     {{"ratio", bed.ratio}, {"bed", soil.string()}, {"start", roller.string()}});
    DeckRun("bed/in.place", variables).must_succeed();
    fs::rename(roller, done);
  }
  if (bed.soil.empty()) fs::remove(folder / (soil_stem(bed, seed) + ".soil"));
  return done;
}

Variables with_start(Variables variables, const fs::path &start, int cycles) {
  variables.insert(variables.end(), {{"start", start.string()},
                                     {"balance", "10"},
                                     {"cycles", std::to_string(cycles)},
                                     {"samples_per_cycle", "250"}});
  return variables;
}

std::vector<std::string> make_runs(const std::vector<std::vector<SeedRun>> &groups, int jobs,
                                   ResumedTable &results) {
  std::size_t runs = 0;
  for (const std::vector<SeedRun> &group : groups)
    runs += group.size();
  CountedProgress progress(runs);
  std::mutex mutex; // of results, progress and failures
  std::vector<std::string> failures;
  for (const std::vector<SeedRun> &group : groups)
    for (const SeedRun &run : group)
      results.has({run.name, std::to_string(run.seed)}); // so that the table gets their order
  in_parallel(groups.size(), jobs, [&](std::size_t number) {
    for (const SeedRun &run : groups[number]) {
      {
        const std::lock_guard lock(mutex);
        if (results.has({run.name, std::to_string(run.seed)})) {
          progress.found();
          continue;
        }
      }
      const std::string what = fmt::format("seed {}, {}: ", run.seed, run.name);
      try {
        const MeasuredRun measured = run.measure();
        const std::lock_guard lock(mutex);
        results.add(measured.row);
        progress.measured(what + measured.words);
      } catch (const std::exception &fault) { // a bed that fails does not stop the others
        const std::lock_guard lock(mutex);
        failures.push_back(what + fault.what());
        progress.measured(failures.back());
      }
    }
  });
  results.finish();
  return failures;
}

} // namespace drumlin::post
