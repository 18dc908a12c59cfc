#include "lab/studies.h"

#include "engine/deck_run.h"
#include "engine/engine_command.h"
#include "lab/settled_bed.h"
#include "lab/speed/page.h"
#include "lab/speed/results.h"
#include "experiment/study.h"
#include "support/progress.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::post {

namespace {

struct Scene {
  CostBed bed;
  int steps;
};

struct Law {
  const char *name;
  const char *deck;
  std::string words;
};

/// All with friction: the engine's own, and that of beds; LAMMPS's if it is set up.
std::vector<Law> laws() {
  const std::string friction = "tangential coulomb";
  const auto &[liggghts, lammps] = engine_laws;
  const char *deck = "study/in.cost_bed";
  std::vector<Law> all = {{liggghts.own, deck, engine_law("tangential history")},
                          {liggghts.stock, deck, plugin_law(friction, "stock")},
                          {liggghts.second, deck, plugin_law(friction, "second")}};
  if (has_lammps()) {
    deck = "study/in.cost_bed.lammps";
    all.insert(
        all.end(),
        {{lammps.own, deck, "engine"}, {lammps.stock, deck, "stock"}, {lammps.second, deck, "second"}});
  } else
    fmt::print("SKIPPED: LAMMPS's law: {}\n", engine_fault(Engine::lammps));
  return all;
}

SpeedRun measure(const Scene &scene, const Law &law, int ranks, int round, const std::filesystem::path &out) {
  Variables variables = scene.bed.sides();
  variables.insert(variables.end(), {{"law", law.words},
                                     {"steps", std::to_string(scene.steps)},
                                     {"data", std::filesystem::absolute(settled(scene.bed, out)).string()}});
  const DeckRun run(law.deck, variables, ranks);
  run.must_succeed();
  return {scene.bed.name(),
          law.name,
          ranks,
          round,
          scene.bed.balls(),
          scene.steps,
          run.loop_seconds(),
          run.outcome().peak_bytes,
          run.printed("ends at ")};
}

/// Checks that all runs of a scene end with the balls at the same positions. The laws limit friction in
/// different ways, and LAMMPS's own scales the dashpot with the mass of each pair, so that these positions
/// differ slightly.
void check_same_work(const std::vector<SpeedRun> &runs) {
  for (const SpeedRun &run : runs)
    for (const SpeedRun &other : runs) {
      const double same = run.law == other.law ? 1e-6 : 1e-5; // m
      if (run.scene == other.scene && !(std::fabs(run.place - other.place) <= same))
        throw std::runtime_error(
            fmt::format("{}: {} on {} ranks and {} on {} ended at {} and {} m: not the same work", run.scene,
                        run.law, run.ranks, other.law, other.ranks, run.place, other.place));
    }
}

} // namespace

void run_speed_study(const StudyOptions &options) {
  check_engine_path(options.out);
  const CostBed plane = options.quick ? CostBed{20, 1, 5, 2000} : CostBed{100, 1, 25, 30000};
  const CostBed cell = options.quick ? CostBed{6, 6, 4, 1000} : CostBed{40, 40, 20, 15000};
  CostBed copies = cell;
  copies.copies_x = options.quick ? 2 : 4;
  copies.copies_y = options.quick ? 1 : 2;
  const std::vector<Scene> scenes = {{plane, options.quick ? 50 : 5000},
                                     {cell, options.quick ? 50 : 240},
                                     {copies, options.quick ? 20 : 60}};
  const int rounds = options.quick ? 1 : 5;
  const std::vector<Law> all = laws();
  ResumedTable results(options.out / "runs.csv", speed_runs());
  CountedProgress progress(2 * static_cast<std::size_t>(rounds) * scenes.size() * all.size());
  for (int round = 1; round <= rounds; ++round)
    for (const Scene &scene : scenes)
      for (const Law &law : all)
        for (const int ranks : {1, 2}) {
          if (results.has({scene.bed.name(), law.name, std::to_string(ranks), std::to_string(round)})) {
            progress.found();
            continue;
          }
          const SpeedRun run = measure(scene, law, ranks, round, options.out);
          results.add(speed_runs().cells(run));
          progress.measured(
              fmt::format("round {}, {}, {}, {} rank{}: {:.3g} million steps of balls per second", round,
                          run.scene, run.law, ranks, ranks > 1 ? "s" : "", run.million_per_second()));
        }
  results.finish();
  check_same_work(read_speed_runs(results.file()));
  write_speed_page(options.out, {plane.name(), cell.name(), copies.name()});
  fmt::print("{}\n", (options.out / "index.html").string());
}

} // namespace drumlin::post
