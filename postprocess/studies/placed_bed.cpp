#include "studies/placed_bed.h"

#include "engine/deck_run.h"
#include "support/files.h"
#include "support/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

fs::path bed_folder(const fs::path &out) {
  fs::path folder = fs::absolute(out / "beds");
  fs::create_directories(folder);
  return folder;
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
  const fs::path folder = bed_folder(out);
  const std::string stem = fmt::format("{}_{}", bed.soil.empty() ? bed.name : bed.soil, seed);
  fs::path done = folder / (stem + ".soil");
  if (fs::exists(done)) return done;
  PackingOptions packing = bed.packing;
  std::vector<BedLayer> layers = bed.layers;
  packing.seed = static_cast<std::uint64_t>(seed);
  for (BedLayer &layer : layers)
    layer.packing.seed = packing.seed;
  const fs::path balls = folder / (stem + ".balls"), unfinished = folder / (stem + ".unfinished");
  write_files({{balls, layers.empty() ? bed_data(packing, soil_density, pack_balls(packing))
                                      : bed_data(layers, soil_density, pack_layers(layers))}});
  print_progress(fmt::format("settling bed {}, seed {}", bed.soil.empty() ? bed.name : bed.soil, seed));
  Variables variables = joined(bed.settle, bed.scene);
  variables.insert(variables.end(),
                   {{"ratio", bed.ratio}, {"balls", balls.string()}, {"bed", unfinished.string()}});
  DeckRun("bed/in.settle", variables).must_succeed();
  fs::rename(unfinished, done);
  fs::remove(unfinished.string() + ".data"); // for in.tile
  fs::remove(balls);
  return done;
}

void in_parallel(const std::vector<std::function<void()>> &tasks, int jobs) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::thread> workers;
  const std::size_t count = std::min(static_cast<std::size_t>(jobs), tasks.size());
  workers.reserve(count);
  for (std::size_t worker = 0; worker < count; ++worker)
    workers.emplace_back([&] {
      for (std::size_t task = next++; task < tasks.size(); task = next++)
        tasks[task]();
    });
  for (std::thread &worker : workers)
    worker.join();
}

Variables joined(Variables first, const Variables &second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

fs::path placed(const PlacedBed &bed, int seed, const fs::path &out) {
  const fs::path folder = bed_folder(out);
  const std::string stem = fmt::format("{}_{}", bed.name, seed);
  fs::path done = folder / (stem + ".restart");
  if (fs::exists(done)) return done;
  const fs::path soil = settled_soil(bed, seed, out), roller = folder / (stem + ".roller");
  print_progress(fmt::format("placing the roller on bed {}, seed {}", bed.name, seed));
  Variables variables = joined(bed.place, bed.scene);
  variables.insert(variables.end(),
                   {{"ratio", bed.ratio}, {"bed", soil.string()}, {"start", roller.string()}});
  DeckRun("bed/in.place", variables).must_succeed();
  fs::rename(roller, done);
  fs::remove(roller.string() + ".data"); // for LAMMPS
  if (bed.soil.empty()) fs::remove(soil);
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
                                   StudyResults &results) {
  std::size_t runs = 0;
  for (const std::vector<SeedRun> &group : groups)
    runs += group.size();
  CountedProgress progress(runs);
  std::mutex mutex; // of results, progress and failures
  std::vector<std::string> failures;
  std::vector<std::function<void()>> tasks;
  tasks.reserve(groups.size());
  for (const std::vector<SeedRun> &group : groups)
    tasks.emplace_back([&] {
      for (const SeedRun &run : group) {
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
  in_parallel(tasks, jobs);
  return failures;
}

} // namespace drumlin::post
