#include "lab/studies.h"

#include "engine/deck_run.h"
#include "engine/engine_command.h"
#include "experiment/study.h"
#include "lab/timing/bed.h"
#include "lab/timing/page.h"
#include "lab/timing/results.h"
#include "support/progress.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

// Many short rounds of the parts: how busy the machine is changes within minutes.
constexpr int part_rounds = 25, size_rounds = 5;

/// Runs of a scene: the words of a pair style, values of deck variables, and how often it is run.
struct Variant {
  std::string name;
  std::string law;
  Variables switches{};
  int rounds = part_rounds;
  std::vector<int> ranks = {1};
  double same =
      0.0; ///< m: variants of a scene that have the same number here end no farther apart; 0: not compared
  bool lammps = false;
};

const Variables watching = {{"guards", "1"}};
const Variables events = {{"events", "1"}};
const Variables history = {{"history", "1"}};
const Variables all_records = {{"guards", "1"}, {"events", "1"}, {"history", "1"}};

std::vector<Variant> chain_variants() {
  constexpr double same = 1e-4; // over many jumps of the force rounding grows on the chain, but not to this
  const std::string none = "tangential off";
  const std::string stock = plugin_law(none, "stock");
  const Variables bare = {{"fixes", "0"}};
  return {{"engine law alone", engine_law(none), bare},
          {"stock alone", stock, bare},
          {"engine law", engine_law(none), {}, part_rounds, {1}, same},
          {"stock", stock, {}, part_rounds, {1}, same},
          {"second", plugin_law(none, "second")},
          {"stock + guard", stock, watching},
          {"stock + events", stock, events},
          {"stock + history", stock, history},
          {"stock + guard + events + history", stock, all_records}};
}

std::vector<Variant> part_variants() {
  constexpr double same = 1e-6; // the two laws are one to rounding
  const std::string none = "tangential off";
  const std::string friction = "tangential history";
  const std::string rolling = "tangential history rolling_friction epsd2";
  const std::string stock = plugin_law(none, "stock");
  const Variables light = {{"D", "0.1"}};
  return {{"engine law", engine_law(none), {}, part_rounds, {1}, same},
          {"stock", stock, {}, part_rounds, {1}, same},
          {"second", plugin_law(none, "second")},
          {"stock + guard", stock, watching},
          {"stock + events", stock, events},
          {"stock + history", stock, history},
          {"stock + friction", plugin_law(friction, "stock")},
          {"second + friction", plugin_law(friction, "second")},
          {"stock + friction + D = 0.1", plugin_law(friction, "stock"), light},
          {"second + friction + D = 0.1", plugin_law(friction, "second"), light},
          {"stock + friction + rolling", plugin_law(rolling, "stock")}};
}

/// The laws that are run on beds of each size, on one rank and on two, all with friction: the engine's own,
/// and the plugin's as beds have it; those of LAMMPS if it is set up.
/// \param alone rounds of the engine's own law on one rank, over which parts are compared
std::vector<Variant> size_variants(int alone, bool lammps) {
  // The laws limit friction in different ways, and LAMMPS's own scales the dashpot with the mass of each
  // pair.
  constexpr double same = 1e-5;
  const auto &[own, other] = engine_laws;
  const auto bed = [](const char *name, const std::string &law, bool in_lammps) {
    return Variant{name, law, {}, size_rounds, {1, 2}, same, in_lammps};
  };
  std::vector<Variant> all = {bed(own.own, engine_law("tangential history"), false),
                              bed(own.stock, plugin_law("tangential coulomb", "stock"), false),
                              bed(own.second, plugin_law("tangential coulomb", "second"), false)};
  all.front().rounds = std::max(alone, size_rounds);
  if (lammps)
    for (const auto &[name, law] :
         {std::pair{other.own, "engine"}, std::pair{other.stock, "stock"}, std::pair{other.second, "second"}})
      all.push_back(bed(name, law, true));
  return all;
}

/// What the variants run on: the chain, or a bed.
struct Scene {
  std::string name;
  int balls;
  int steps;
  std::vector<Variant> variants;
  std::optional<TimedBed> bed{};
};

Scene on_bed(const TimedBed &bed, int steps, bool parts, bool lammps) {
  std::vector<Variant> variants = size_variants(parts ? part_rounds : 0, lammps);
  if (parts) {
    const std::vector<Variant> more = part_variants();
    variants.insert(variants.end(), more.begin(), more.end());
  }
  return {bed.name(), bed.balls(), steps, variants, bed};
}

std::vector<Scene> scenes(bool quick, bool lammps) {
  const Scene chain = {"chain", 2, quick ? 2000 : 200000, chain_variants()};
  TimedBed cell = quick ? TimedBed{6, 6, 4, 1000} : TimedBed{40, 40, 20, 15000};
  const Scene plane =
      on_bed(quick ? TimedBed{20, 1, 5, 2000} : TimedBed{100, 1, 25, 30000}, quick ? 50 : 5000, true, lammps);
  const Scene block = on_bed(cell, quick ? 50 : 120, !quick, lammps);
  cell.copies_x = quick ? 2 : 4;
  cell.copies_y = quick ? 1 : 2;
  return {chain, plane, block, on_bed(cell, quick ? 20 : 60, false, lammps)};
}

TimedRun measure(const Scene &scene, const Variant &variant, int ranks, int round, const fs::path &out) {
  Variables variables = variant.switches;
  variables.insert(variables.end(), {{"law", variant.law}, {"steps", std::to_string(scene.steps)}});
  if (scene.bed) {
    const Variables sides = scene.bed->sides();
    variables.insert(variables.end(), sides.begin(), sides.end());
    variables.emplace_back("data", fs::absolute(settled(*scene.bed, out)).string());
  }
  const std::string deck = scene.bed ? "study/in.cost_bed" : "study/in.cost_chain";
  const DeckRun run(deck + (variant.lammps ? ".lammps" : ""), variables, ranks);
  run.must_succeed();
  return {scene.name,
          variant.name,
          ranks,
          round,
          scene.balls,
          scene.steps,
          run.loop_seconds(),
          variant.lammps ? std::nan("") : run.printed("Pair  time (%) = "),
          run.outcome().peak_bytes,
          run.printed("ends at ")};
}

/// Checks that the runs of a variant, and those of variants that are compared, end with the balls at the same
/// positions.
void check_same_work(const Scene &scene, const std::vector<TimedRun> &runs) {
  const auto same_of = [&scene](const TimedRun &run) {
    for (const Variant &variant : scene.variants)
      if (variant.name == run.variant) return variant.same;
    return 0.0;
  };
  for (const TimedRun &run : runs)
    for (const TimedRun &other : runs) {
      if (run.scene != scene.name || other.scene != scene.name) continue;
      const double same = same_of(run), most = run.variant == other.variant ? 1e-6 : same; // m
      const bool compared = run.variant == other.variant || (same > 0.0 && same == same_of(other));
      if (compared && !(std::fabs(run.place - other.place) <= most))
        throw std::runtime_error(
            fmt::format("{}: {} on {} ranks and {} on {} ended at {} and {} m: not the same work", run.scene,
                        run.variant, run.ranks, other.variant, other.ranks, run.place, other.place));
    }
}

} // namespace

void run_timing_study(const StudyOptions &options) {
  check_engine_path(options.out);
  const bool lammps = has_lammps();
  if (!lammps) fmt::print("SKIPPED: LAMMPS's law: {}\n", engine_fault(Engine::lammps));
  const std::vector<Scene> all = scenes(options.quick, lammps);
  const auto rounds_of = [&options](const Variant &variant, int ranks) {
    return options.quick ? 1 : ranks == 1 ? variant.rounds : std::min(variant.rounds, size_rounds);
  };
  std::size_t count = 0;
  for (const Scene &scene : all)
    for (const Variant &variant : scene.variants)
      for (const int ranks : variant.ranks)
        count += static_cast<std::size_t>(rounds_of(variant, ranks));
  ResumedTable results(options.out / "runs.csv", timed_runs());
  CountedProgress progress(count);
  for (int round = 1; round <= part_rounds; ++round)
    for (const Scene &scene : all)
      for (const Variant &variant : scene.variants)
        for (const int ranks : variant.ranks) {
          if (round > rounds_of(variant, ranks)) continue;
          if (results.has({scene.name, variant.name, std::to_string(ranks), std::to_string(round)})) {
            progress.found();
            continue;
          }
          const TimedRun run = measure(scene, variant, ranks, round, options.out);
          results.add(timed_runs().cells(run));
          progress.measured(fmt::format("round {}, {}, {}, {} rank{}: {:.4g} us per step", round, run.scene,
                                        run.variant, ranks, ranks > 1 ? "s" : "", run.us_per_step()));
        }
  results.finish();
  const std::vector<TimedRun> runs = read_timed_runs(results.file());
  for (const Scene &scene : all)
    check_same_work(scene, runs);
  write_timing_page(options.out, {all[1].name, all[2].name, all[3].name});
  fmt::print("{}\n", (options.out / "index.html").string());
}

} // namespace drumlin::post
