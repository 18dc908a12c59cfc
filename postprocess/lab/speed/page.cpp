#include "lab/speed/page.h"

#include "engine/places.h"
#include "pages/acceptance.h"
#include "pages/figure_data.h"
#include "pages/page.h"
#include "lab/speed/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace {

const Throughput &find(const std::vector<Throughput> &all, const std::string &scene, const std::string &law,
                       int ranks) {
  for (const Throughput &one : all)
    if (one.scene == scene && one.law == law && one.ranks == ranks) return one;
  throw std::runtime_error(fmt::format("{}: no run of {} on {} ranks", scene, law, ranks));
}

std::string quartiles(const Spread &spread) {
  return fmt::format("{:.3g} [{:.3g}, {:.3g}]", spread.median, spread.lower, spread.upper);
}

/// What each ball takes of the memory of one rank.
PageTable memory_table(const std::vector<Throughput> &all, const SpeedScenes &scenes,
                       const std::vector<EngineLaws> &engines) {
  PageTable table;
  table.name = "memory";
  table.title = "Memory per ball";
  table.text_columns = 1;
  table.header = {"law", "bytes per ball"};
  for (const EngineLaws &laws : engines)
    for (const char *law : laws.all())
      table.add({law, fmt::format("{:.0f}", bytes_per_ball(all, law, scenes.cell, scenes.copies))});
  table.notes = {
      "Largest memory of the run with the largest bed less that with the second one, on one rank, over the "
      "difference of their balls; with neighbour lists, contact history and what the engine reads from the "
      "file."};
  return table;
}

PageTable speed_table(const std::vector<Throughput> &all) {
  PageTable table;
  table.name = "speed";
  table.title = "Million steps of balls per second";
  table.text_columns = 2;
  table.header = {"scene",
                  "law",
                  "ranks",
                  "rounds",
                  "million balls x steps per s [quartiles]",
                  "time over the engine's law (-) [quartiles]",
                  "efficiency (-) [quartiles]",
                  "memory of the largest rank (MB)"};
  for (const Throughput &one : all)
    table.add({one.scene, one.law, std::to_string(one.ranks), std::to_string(one.rounds),
               quartiles(one.million_per_second), quartiles(one.over_engine),
               one.ranks == 1 ? "-" : quartiles(one.efficiency),
               fmt::format("{:.1f}", 1e-6 * one.peak_bytes)});
  table.notes = {"Medians over the rounds; ratios are within a round and an engine. The law of the engine is "
                 "hooke/stiffness with "
                 "limitForce on, in LAMMPS gran/hooke/history with limit_damping; all have friction, "
                 "the plugin's laws tangential coulomb. Stock "
                 "(velocity Verlet) is "
                 "the default of the decks of beds, second the second-order scheme. The last bed is made of "
                 "copies of the "
                 "second one."};
  return table;
}

std::vector<Acceptance> judge(const std::vector<Throughput> &all, const SpeedScenes &scenes,
                              const EngineLaws &laws) {
  constexpr double least_efficiency = 0.85;
  std::vector<Acceptance> criteria;
  for (const std::string &scene : {scenes.cell, scenes.copies})
    for (const int ranks : {1, 2})
      for (const auto &[law, allowed] :
           {std::pair{laws.stock, laws.allowed_stock}, std::pair{laws.second, laws.allowed_second}}) {
        const Spread ratio = find(all, scene, law, ranks).over_engine;
        criteria.push_back({fmt::format("{}, {} rank{}: {} takes at most {:.2f} of the engine's law", scene,
                                        ranks, ranks > 1 ? "s" : "", law, allowed),
                            quartiles(ratio), ratio.median <= allowed});
      }
  for (const char *law : laws.all()) {
    const Spread efficiency = find(all, scenes.cell, law, 2).efficiency;
    criteria.push_back(
        {fmt::format("{}, {}: efficiency on 2 ranks at least {:.2f}", scenes.cell, law, least_efficiency),
         quartiles(efficiency), efficiency.median >= least_efficiency});
  }
  return criteria;
}

/// Estimate for 1e8 balls from the measured values.
PageTable projection_table(const std::vector<Throughput> &all, const SpeedScenes &scenes) {
  constexpr double balls = 1e8, rows = 20.0, cycles = 10.0, steps_per_cycle = 4000.0;
  constexpr double ghost_rows =
      2.4; // of balls beyond each border: largest diameter and skin, over the mean diameter
  PageTable table;
  table.name = "projection";
  table.title = "Estimate for 1e8 balls in a bed of 20 layers";
  table.header = {"balls per rank", "ranks",          "memory per rank (GB)",    "ghosts per ball (-)",
                  "step (ms)",      "ten cycles (h)", "efficiency of a rank (-)"};
  const double bytes = bytes_per_ball(all, "stock", scenes.cell, scenes.copies);
  const Throughput alone = find(all, scenes.copies, "stock", 1);
  const Throughput shared = find(all, scenes.copies, "stock", 2);
  // Ranks of a node share its memory bandwidth, and each rank computes the contacts of its ghosts in
  // addition.
  const double speed = 1e6 * alone.million_per_second.median * std::min(1.0, shared.efficiency.median);
  for (const double share : {1e4, 3e4, 1e5, 3e5, 1e6}) {
    const double side = std::sqrt(share / rows);
    const double ghosts = (std::pow(side + 2.0 * ghost_rows, 2.0) - side * side) / (side * side);
    const double step = share * (1.0 + 0.5 * ghosts) / speed;
    table.add({fmt::format("{:.0e}", share), fmt::format("{:.0f}", balls / share),
               fmt::format("{:.2g}", 1e-9 * bytes * share * (1.0 + ghosts)), fmt::format("{:.2f}", ghosts),
               fmt::format("{:.3g}", 1e3 * step),
               fmt::format("{:.2g}", cycles * steps_per_cycle * step / 3600.0),
               fmt::format("{:.2f}", 1.0 / (1.0 + 0.5 * ghosts))});
  }
  table.notes = {fmt::format("{:.0f} bytes per ball and {:.3g} million steps of balls per second and rank, "
                             "as measured above with stock stepping; ten "
                             "cycles of 4000 steps. A contact across a border is computed on both sides, so "
                             "half of the ghosts' work is added. "
                             "Messages are not included.",
                             bytes, 1e-6 * speed)};
  return table;
}

PageFigure speed_figure(const std::vector<Throughput> &all, const SpeedScenes &scenes,
                        const std::vector<EngineLaws> &engines) {
  const std::string name = "throughput";
  PageFigure figure;
  figure.label = "Fig. 1";
  figure.weight = 1.0;
  figure.caption = "Steps of balls per second: median over the rounds and quartiles. From left to right: the "
                   "engine's law, stock "
                   "and second on one rank, then the same on two; then those of LAMMPS.";
  figure.figure = {name, "Steps of balls per second", {}, 3};
  CurveTable table("place,million per s,lower quartile,upper quartile");
  for (const std::string &scene : {scenes.plane, scenes.cell, scenes.copies}) {
    Panel panel;
    panel.title = scene;
    panel.y_label = "million balls x steps per s";
    panel.y_range = "[0:*]";
    panel.curves = {curve(name, scene, "$2", "3:4:5", CurveStyle::spread)};
    panel.curves.back().title.clear();
    for (const EngineLaws &laws : engines)
      for (const int ranks : {1, 2})
        for (const char *law : laws.all()) {
          const Spread speed = find(all, scene, law, ranks).million_per_second;
          panel.x_ticks.push_back(fmt::format("{}, {}", law, ranks));
          table.row(scene,
                    {static_cast<double>(panel.x_ticks.size()), speed.median, speed.lower, speed.upper});
        }
    figure.figure.panels.push_back(panel);
  }
  figure.csv = table.text();
  return figure;
}

} // namespace

void write_speed_page(const std::filesystem::path &out, const SpeedScenes &scenes) {
  std::vector<Throughput> all;
  std::vector<EngineLaws> engines; // that ran
  std::vector<Acceptance> criteria;
  for (const EngineLaws &laws : engine_laws) {
    std::vector<SpeedRun> runs = read_speed_runs(out / "runs.csv");
    const auto of_another = [names = laws.all()](const SpeedRun &run) {
      return std::find(names.begin(), names.end(), run.law) == names.end();
    };
    runs.erase(std::remove_if(runs.begin(), runs.end(), of_another), runs.end());
    if (runs.empty()) continue;
    engines.push_back(laws);
    const std::vector<Throughput> of_engine = throughputs(runs, laws.own);
    all.insert(all.end(), of_engine.begin(), of_engine.end());
    const std::vector<Acceptance> of_laws = judge(of_engine, scenes, laws);
    criteria.insert(criteria.end(), of_laws.begin(), of_laws.end());
  }
  Page page(out, "Speed", Drawing::bed);
  page.answer(
      "Time of a step of settled beds, from 2500 balls in two dimensions to a quarter of a million in three, "
      "by the "
      "engine's own law and by the plugin's, on one rank and on two, in LIGGGHTS and, if it is set up, in "
      "LAMMPS. The runs of a round alternate. Times by the engine's own clock, without starting and "
      "reading.");
  page.answer(criteria);
  page.section("Acceptance criteria");
  page.table(acceptance_table(criteria));
  page.section("Throughput");
  page.table(speed_table(all));
  page.figure(speed_figure(all, scenes, engines));
  page.table(memory_table(all, scenes, engines));
  page.section("Estimate for 1e8 balls");
  page.table(projection_table(all, scenes));
  page.paragraph("Decomposition: a bed is wide and flat, so ranks share it along x and z, never along y "
                 "(processors * 1 * in "
                 "the decks). Each rank then has columns of soil of the same height, from floor to surface, "
                 "and needs no "
                 "balancing. The roller is on few ranks. As a clump its balls are as small as soil balls and "
                 "add a few per "
                 "cent of work there; as one ball much larger than the soil it would widen the ghost layer "
                 "of every rank "
                 "to its own size.");
  page.paragraph(
      "Limits: (1) ghosts, from about ten thousand balls per rank on: the column of the table that "
      "decreases. (2) "
      "Messages: each step sends positions and velocities of the ghosts, the second-order scheme those of "
      "coupled balls once more, and every record sums about forty numbers over all ranks: choose "
      "samples_per_cycle and dumps no larger than needed. (3) The memory bandwidth of a node, of which the "
      "efficiency on two ranks shows the beginning. (4) Files: the engine gathers a restart file on one "
      "rank. "
      "(5) Copies: in.tile runs on one rank and must hold the whole bed there, since on more ranks the "
      "engine "
      "gives IDs twice; a bed larger than the memory of one node has to be made by " +
      front_command() + " bed and settled, or read in parts. (6) Integers: an ID has 31 bits, 2.1e9 balls.");
  page.write();
}

} // namespace drumlin::post
