#include "lab/studies.h"

#include "engine/deck_run.h"
#include "lab/cost/page.h"
#include "lab/cost/results.h"
#include "lab/settled_bed.h"
#include "experiment/study.h"
#include "support/progress.h"

#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// A variant of a scene: the words of its pair style, and values of deck variables.
struct Variant {
  std::string name;
  std::string law;
  Variables switches;
};

const Variables watching = {{"guards", "1"}};
const Variables events = {{"events", "1"}};
const Variables history = {{"history", "1"}};
const Variables all_records = {{"guards", "1"}, {"events", "1"}, {"history", "1"}};

std::vector<Variant> chain_variants() {
  const std::string none = "tangential off";
  const std::string stock = plugin_law(none, "stock");
  const Variables bare = {{"fixes", "0"}};
  return {{"engine law alone", engine_law(none), bare},
          {"stock alone", stock, bare},
          {"engine law", engine_law(none), {}},
          {"stock", stock, {}},
          {"second", plugin_law(none, "second"), {}},
          {"stock + guard", stock, watching},
          {"stock + events", stock, events},
          {"stock + history", stock, history},
          {"stock + guard + events + history", stock, all_records}};
}

std::vector<Variant> bed_variants() {
  const std::string none = "tangential off";
  const std::string friction = "tangential history";
  const std::string rolling = "tangential history rolling_friction cdt";
  const std::string stock = plugin_law(none, "stock");
  const Variables light = {{"D", "0.1"}};
  return {{"engine law", engine_law(none), {}},
          {"stock", stock, {}},
          {"second", plugin_law(none, "second"), {}},
          {"stock + guard", stock, watching},
          {"stock + events", stock, events},
          {"stock + history", stock, history},
          {"engine law + friction", engine_law(friction), {}},
          {"stock + friction", plugin_law(friction, "stock"), {}},
          {"second + friction", plugin_law(friction, "second"), {}},
          {"stock + friction + D = 0.1", plugin_law(friction, "stock"), light},
          {"second + friction + D = 0.1", plugin_law(friction, "second"), light},
          {"stock + friction + rolling", plugin_law(rolling, "stock"), {}}};
}

/// The deck that the variants run.
struct Scene {
  std::string name;
  std::string deck;
  Variables variables;
  std::optional<CostBed> bed;
  int balls;
  int steps;
  std::vector<Variant> variants;
  double same; ///< m: law and engine's law, which are one to rounding, end no farther apart
};

Scene on_bed(const CostBed &bed, int steps) {
  return {bed.name(), "study/in.cost_bed", bed.sides(), bed, bed.balls(), steps, bed_variants(), 1e-6};
}

std::vector<Scene> scenes(bool quick) {
  // Over many jumps of the force rounding grows on the chain, but not to a tenth of a millimetre.
  const Scene chain = {"chain", "study/in.cost_chain", {}, {}, 2, quick ? 2000 : 200000, chain_variants(),
                       1e-4};
  if (quick) return {chain, on_bed({20, 1, 5, 2000}, 50)};
  return {chain, on_bed({100, 1, 25, 30000}, 5000), on_bed({40, 40, 20, 15000}, 120)};
}

CostRun measure(const Scene &scene, const Variant &variant, int round, const fs::path &out) {
  Variables variables = variant.switches;
  variables.insert(variables.end(), scene.variables.begin(), scene.variables.end());
  variables.emplace_back("law", variant.law);
  variables.emplace_back("steps", std::to_string(scene.steps));
  if (scene.bed) variables.emplace_back("data", fs::absolute(settled(*scene.bed, out)).string());
  const DeckRun run(scene.deck, variables);
  run.must_succeed();
  return {scene.name,
          variant.name,
          round,
          scene.balls,
          scene.steps,
          run.loop_seconds(),
          run.printed("Pair  time (%) = "),
          run.printed("ends at ")};
}

void check_same_work(const std::vector<Scene> &all, const std::vector<CostRun> &runs) {
  for (const Scene &scene : all) {
    const CostRun *engine = nullptr;
    const CostRun *plugin = nullptr;
    for (const CostRun &run : runs)
      if (run.scene == scene.name && run.variant == "engine law")
        engine = &run;
      else if (run.scene == scene.name && run.variant == "stock")
        plugin = &run;
    if (engine == nullptr || plugin == nullptr)
      throw std::logic_error("a scene without the two laws that are compared");
    if (!(std::fabs(engine->place - plugin->place) <= scene.same))
      throw std::runtime_error(fmt::format("{}: the two laws ended at {} and {} m: not the same work",
                                           scene.name, engine->place, plugin->place));
  }
}

} // namespace

void run_cost_study(const StudyOptions &options) {
  check_engine_path(options.out);
  const std::vector<Scene> all = scenes(options.quick);
  // Many short rounds: how busy the machine is changes within minutes.
  const int rounds = options.quick ? 1 : 25;
  ResumedTable results(options.out / "runs.csv", cost_runs());
  std::size_t variants = 0;
  for (const Scene &scene : all)
    variants += scene.variants.size();
  CountedProgress progress(static_cast<std::size_t>(rounds) * variants);
  for (int round = 1; round <= rounds; ++round)
    for (const Scene &scene : all)
      for (const Variant &variant : scene.variants) {
        if (results.has({scene.name, variant.name, std::to_string(round)})) {
          progress.found();
          continue;
        }
        const CostRun run = measure(scene, variant, round, options.out);
        results.add(cost_runs().cells(run));
        progress.measured(fmt::format("round {}, {}, {}: {:.4g} us per step", round, run.scene, run.variant,
                                      run.us_per_step()));
      }
  results.finish();
  check_same_work(all, read_cost_runs(results.file()));
  write_cost_page(options.out);
  fmt::print("{}\n", (options.out / "index.html").string());
}

} // namespace drumlin::post
