#include "study_fidelity.h"

#include "bed_packing.h"
#include "chain_csv.h"
#include "command.h"
#include "fidelity_page.h"
#include "fidelity_results.h"
#include "study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr double density = 2650.0; // kg/m3

/// A bed with a roller on it, made once for each seed.
struct Bed {
  std::string name; ///< of its files
  PackingOptions packing;
  Variables scene;       ///< of all its decks, in.bed included
  Variables settle = {}; ///< of in.settle alone, before `scene`
};

/// Something that is put in, left out or set, and the one that it is compared with.
struct Ingredient {
  std::string variant;
  std::string base; ///< empty: it is one itself
  Bed bed;
  Variables run = {}; ///< of in.bed alone
};

/// The same bed with other values.
Bed with(Bed bed, const std::string &name, const Variables &scene, const Variables &settle = {}) {
  bed.name = name;
  bed.scene.insert(bed.scene.begin(), scene.begin(), scene.end()); // the engine takes the first of a name
  bed.settle = settle;
  return bed;
}

/// Balls of another size that fill the same area.
Bed sized(Bed bed, const std::string &name, int balls, double smallest, double largest, double dt) {
  bed.name = name;
  bed.packing.balls = balls;
  bed.packing.radius_min = smallest;
  bed.packing.radius_max = largest;
  bed.scene.insert(bed.scene.begin(), {"dt", number_text(dt)});
  return bed;
}

std::vector<Ingredient> ingredients(bool quick) {
  if (quick) {
    Bed bed{"gravel", {}, {}};
    bed.packing.balls = 150;
    bed.packing.width = 0.6;
    bed.scene = {{"m2", "100"},  {"m3", "50"},   {"r2", "0.1"},  {"r3", "0.05"},
                 {"k23", "5e4"}, {"c23", "500"}, {"Fw", "2940"}, {"ratio", "1e-2"}};
    return {{"base", "", bed, {}},
            {"transition A", "base", bed, {{"transition", "A"}}},
            {"no friction", "base", with(bed, "smooth", {{"friction", "0"}}), {}}};
  }
  const Bed gravel{"gravel", {}, {}};
  const Bed stock = with(gravel, "stock", {{"stepping", "stock"}});
  // The time step follows the contact time, which goes with the radius: m ~ r^2, k as it was.
  const Bed coarse = sized(gravel, "coarse", 625, 0.032, 0.048, 4e-5);
  const Bed fine = sized(gravel, "fine", 10000, 0.008, 0.012, 1e-5);
  Bed one_size = gravel;
  one_size.name = "one_size";
  one_size.packing.radius_min = one_size.packing.radius_max = 0.02;
  Bed wide = gravel;
  wide.name = "wide";
  wide.packing.radius_min = 0.010;
  wide.packing.radius_max = 0.030;
  wide.packing.grading = Grading::mass;
  wide.scene = {{"dt", "1e-5"}};
  return {
      {"base", "", gravel, {}},
      {"transition A", "base", gravel, {{"transition", "A"}}},
      {"steps x 2", "base", gravel, {{"steps_per_cycle", "5000"}}},
      {"steps x 4", "base", gravel, {{"steps_per_cycle", "10000"}}},
      {"stock", "base", stock, {}},
      {"stock, steps x 4", "base", stock, {{"steps_per_cycle", "10000"}}},
      {"no friction", "base", with(gravel, "smooth", {{"friction", "0"}}), {}},
      {"k / 10", "base", with(gravel, "soft10", {{"k", "1e7"}}), {}},
      {"k / 100", "base", with(gravel, "soft100", {{"k", "1e6"}}), {}},
      {"625 balls", "base", coarse, {{"steps_per_cycle", "1250"}}},
      {"10000 balls", "base", fine, {{"steps_per_cycle", "5000"}}},
      {"one size", "base", one_size, {}},
      {"wide grading", "base", wide, {{"steps_per_cycle", "5000"}}},
      {"dense", "base", with(gravel, "dense", {}, {{"friction", "0"}}), {}},
      {"clump drum", "base", with(gravel, "clump", {{"drum", "clump"}}), {}},
      {"30 Hz",
       "base",
       gravel,
       {{"omega", number_text(60 * 3.14159265358979323846)}, {"steps_per_cycle", "1750"}}},
      {"40 Hz",
       "base",
       gravel,
       {{"omega", number_text(80 * 3.14159265358979323846)}, {"steps_per_cycle", "1250"}}},
  };
}

Variables joined(Variables first, const Variables &second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// The restart file of a bed with its roller at rest, made if an earlier call did not finish it.
fs::path made(const Bed &bed, int seed, const fs::path &out) {
  const fs::path folder = fs::absolute(out / "beds");
  fs::create_directories(folder);
  fs::path done = folder / fmt::format("{}_{}.restart", bed.name, seed);
  if (fs::exists(done)) return done;
  fmt::print("making bed {}, seed {}\n", bed.name, seed);
  std::fflush(stdout);
  PackingOptions packing = bed.packing;
  packing.seed = static_cast<std::uint64_t>(seed);
  const fs::path balls = folder / "unfinished.data", soil = folder / "unfinished.soil",
                 roller = folder / "unfinished.roller";
  write_files({{balls, bed_data(packing, density, pack_balls(packing))}});
  const Variables files = {{"balls", balls.string()}, {"start", roller.string()}};
  Variables settling = joined(bed.settle, bed.scene);
  settling.insert(settling.end(), {{"balls", balls.string()}, {"bed", soil.string()}});
  DeckRun("bed/in.settle", settling).must_succeed();
  Variables placing = bed.scene;
  placing.insert(placing.end(), {{"bed", soil.string()}, {"start", roller.string()}});
  DeckRun("bed/in.place", placing).must_succeed();
  fs::rename(roller, done);
  fs::remove(balls);
  fs::remove(soil);
  return done;
}

FidelityRun measure(const Ingredient &ingredient, int seed, const fs::path &out, int cycles) {
  Variables variables = joined(ingredient.run, ingredient.bed.scene);
  variables.insert(variables.end(), {{"start", made(ingredient.bed, seed, out).string()},
                                     {"cycles", std::to_string(cycles)},
                                     {"samples_per_cycle", "250"}});
  const DeckRun run("bed/in.bed", variables);
  run.must_succeed();
  const Table table = read_table(run.file("cycles.csv"));
  const auto first = static_cast<std::ptrdiff_t>(table.rows()) - cycles / 2; // the second half
  const auto mean = [&](const char *column) {
    const std::vector<double> all = table.numbers(column);
    double sum = 0.0;
    std::for_each(all.begin() + first, all.end(), [&sum](double value) { sum += value; });
    return sum / static_cast<double>(all.size() - static_cast<std::size_t>(first));
  };
  const std::vector<double> settlement = table.numbers("settlement");
  const double per_cycle = (settlement.back() - settlement[static_cast<std::size_t>(first) - 1]) /
                           static_cast<double>(settlement.size() - static_cast<std::size_t>(first));
  return {ingredient.variant,
          seed,
          {mean("a_drum_max"), mean("F_contact_max"), per_cycle, mean("contact_share")},
          run.wall_seconds()};
}

} // namespace

void run_fidelity_study(const StudyOptions &options) {
  if (fs::absolute(options.out).string().find(' ') != std::string::npos)
    throw UsageError(
        fmt::format("--out is '{}'; allowed: a path without spaces, at which the engine would split it",
                    options.out.string()));
  const std::vector<Ingredient> all = ingredients(options.quick);
  const int seeds = options.quick ? 2 : 5;
  const int cycles = options.quick ? 4 : 10;
  StudyResults results(options.out / "runs.csv", fidelity_run_columns, fidelity_run_keys);
  StudyProgress progress(static_cast<std::size_t>(seeds) * all.size());
  for (int seed = 1; seed <= seeds; ++seed)
    for (const Ingredient &ingredient : all) {
      if (results.find({ingredient.variant, std::to_string(seed)}) != nullptr) {
        progress.found();
        continue;
      }
      const FidelityRun run = measure(ingredient, seed, options.out, cycles);
      results.add(cells(run));
      progress.measured(fmt::format("seed {}, {}: {:.3g} m/s2, {:.3g} mm per cycle, {:.3g} s", seed,
                                    run.variant, run.values[0], 1e3 * run.values[2], run.wall_s));
    }
  std::vector<Effect> effects;
  const std::vector<FidelityRun> runs = read_fidelity_runs(results.file());
  for (const Ingredient &ingredient : all)
    if (!ingredient.base.empty()) effects.push_back(effect_of(runs, ingredient.variant, ingredient.base));
  write_fidelity_page(options.out, runs, effects);
  fmt::print("{}\n", (options.out / "index.html").string());
}

} // namespace drumlin::post
