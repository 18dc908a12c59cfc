#include "lab/timing/page.h"

#include "engine/places.h"
#include "lab/timing/results.h"
#include "pages/acceptance.h"
#include "pages/figure_data.h"
#include "pages/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace {

std::string quartiles(const Spread &spread) {
  return fmt::format("{:.3g} [{:.3g}, {:.3g}]", spread.median, spread.lower, spread.upper);
}

/// What each ball takes of the memory of one rank.
PageTable memory_table(const std::vector<VariantTime> &all, const TimedBeds &beds,
                       const std::vector<EngineLaws> &engines) {
  PageTable table("memory", "Memory per ball", "law | bytes per ball");
  for (const EngineLaws &laws : engines)
    for (const char *law : laws.all())
      table.add({law, fmt::format("{:.0f}", bytes_per_ball(all, law, beds.cell, beds.copies))});
  table.notes = {"Largest memory of the run with the largest bed less that with the second one, on one rank, "
                 "over the difference of their balls; with neighbour lists, contact history and what the "
                 "engine reads from the file."};
  return table;
}

/// Median and quartiles of ratios; a dash where there are none.
std::string quartiles_or_dash(const std::vector<double> &ratios) {
  return ratios.empty() ? no_value : quartiles(spread(ratios));
}

/// The engine's own law with friction that a variant is compared with; nullptr for one without friction.
const char *own_law(const std::string &variant) {
  for (const EngineLaws &laws : engine_laws)
    for (const char *law : laws.all())
      if (variant == law) return laws.own;
  return nullptr;
}

PageTable time_table(const std::vector<TimedRun> &runs, const std::vector<VariantTime> &all) {
  PageTable table("times", "Time of a step",
                  "scene | variant | ranks | rounds | step (us) [quartiles] | pair (us) | ball and step (ns) "
                  "| million balls x steps per s [quartiles] | time over the engine's law (-) [quartiles] | "
                  "efficiency (-) [quartiles] | memory of the largest rank (MB)",
                  2);
  for (const VariantTime &one : all) {
    const Measured what = {one.variant, one.ranks};
    const char *own = own_law(one.variant);
    table.add(
        {one.scene, one.variant, std::to_string(one.ranks), std::to_string(one.rounds),
         quartiles(one.us_per_step),
         std::isnan(one.pair_us_per_step) ? no_value : fmt::format("{:.4g}", one.pair_us_per_step),
         fmt::format("{:.4g}", one.ns_per_ball()), quartiles(one.million_per_second),
         own == nullptr ? no_value : quartiles_or_dash(time_ratios(runs, one.scene, what, {own, one.ranks})),
         one.ranks == 1 ? no_value : quartiles_or_dash(efficiencies(runs, one.scene, what)),
         fmt::format("{:.1f}", 1e-6 * one.peak_bytes)});
  }
  table.notes = {
      "Medians over the rounds; ratios are within a round and an engine. Pair: the part of a step that the "
      "pair style takes. Per ball: of the balls that move. The law of the engine is hooke/stiffness with "
      "limitForce on, in LAMMPS gran/hooke/history with limit_damping; with friction the plugin's laws have "
      "tangential history or, where it is named so, coulomb. Stock (velocity Verlet) is the default of the "
      "decks of beds, second the second-order scheme. The last bed is made of copies of the one before."};
  return table;
}

void judge_sizes(const std::vector<TimedRun> &runs, const TimedBeds &beds, const EngineLaws &laws,
                 std::vector<Acceptance> &criteria) {
  constexpr double least_efficiency = 0.85;
  for (const std::string &scene : {beds.cell, beds.copies})
    for (const int ranks : {1, 2})
      for (const auto &[law, allowed] :
           {std::pair{laws.stock, laws.allowed_stock}, std::pair{laws.second, laws.allowed_second}}) {
        const Spread ratio = spread(time_ratios(runs, scene, {law, ranks}, {laws.own, ranks}));
        criteria.push_back({fmt::format("{}, {} rank{}: {} takes at most {:.2f} of the engine's law", scene,
                                        ranks, ranks > 1 ? "s" : "", law, allowed),
                            quartiles(ratio), ratio.median <= allowed});
      }
  for (const char *law : laws.all()) {
    const Spread efficiency = spread(efficiencies(runs, beds.cell, {law, 2}));
    criteria.push_back(
        {fmt::format("{}, {}: efficiency on 2 ranks at least {:.2f}", beds.cell, law, least_efficiency),
         quartiles(efficiency), efficiency.median >= least_efficiency});
  }
}

/// Estimate for 1e8 balls from the measured values.
PageTable projection_table(const std::vector<TimedRun> &runs, const std::vector<VariantTime> &all,
                           const TimedBeds &beds) {
  constexpr double balls = 1e8, rows = 20.0, cycles = 10.0, steps_per_cycle = 4000.0;
  constexpr double ghost_rows =
      2.4; // of balls beyond each border: largest diameter and skin, over the mean diameter
  PageTable table("projection", "Estimate for 1e8 balls in a bed of 20 layers",
                  "balls per rank | ranks | memory per rank (GB) | ghosts per ball (-) | step (ms) | ten "
                  "cycles (h) | efficiency of a rank (-)");
  const char *law = engine_laws.front().stock;
  const double bytes = bytes_per_ball(all, law, beds.cell, beds.copies);
  // Ranks of a node share its memory bandwidth, and each rank computes the contacts of its ghosts in
  // addition.
  const double speed = 1e6 * find_time(all, beds.copies, law, 1).million_per_second.median *
                       std::min(1.0, spread(efficiencies(runs, beds.copies, {law, 2})).median);
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
  table.notes = {
      fmt::format("{:.0f} bytes per ball and {:.3g} million steps of balls per second and rank, as measured "
                  "above with stock stepping; ten cycles of 4000 steps. A contact across a border is "
                  "computed on both sides, so half of the ghosts' work is added. Messages are not included.",
                  bytes, 1e-6 * speed)};
  return table;
}

PageFigure size_figure(const std::vector<VariantTime> &all, const TimedBeds &beds,
                       const std::vector<EngineLaws> &engines) {
  const std::string name = "throughput";
  PageFigure figure =
      page_figure("Fig. 2",
                  "Steps of balls per second: median over the rounds and quartiles. From left to right: the "
                  "engine's law, stock and second on one rank, then the same on two; then those of LAMMPS.",
                  {name, "Steps of balls per second", {}, 3}, 1.0);
  CurveTable table("place,million per s,lower quartile,upper quartile");
  for (const std::string &scene : {beds.plane, beds.cell, beds.copies}) {
    Panel panel{scene, "", "million balls x steps per s", {}};
    panel.y_range = "[0:*]";
    panel.add(curve(name, scene, "$2", "3:4:5", CurveStyle::spread), "");
    for (const EngineLaws &laws : engines)
      for (const int ranks : {1, 2})
        for (const char *law : laws.all()) {
          const Spread speed = find_time(all, scene, law, ranks).million_per_second;
          panel.x_ticks.push_back(fmt::format("{}, {}", law, ranks));
          table.row(scene,
                    {static_cast<double>(panel.x_ticks.size()), speed.median, speed.lower, speed.upper});
        }
    figure.figure.panels.push_back(panel);
  }
  figure.csv = table.text();
  return figure;
}

/// Allowed ratio for parts that should not add cost: the scatter of the ratios is about 2 %.
constexpr double nothing = 1.02;

const std::vector<PieceComparison> comparisons = {
    {"law alone", "stock alone", "engine law alone", nothing},
    {"law", "stock", "engine law", nothing},
    {"law + friction", "stock + friction", "engine law + friction", nothing},
    {"bond and exciter", "stock", "stock alone", 0.0},
    {"guard", "stock + guard", "stock", 0.0},
    {"events", "stock + events", "stock", 0.0},
    {"history", "stock + history", "stock", 0.0},
    {"all three", "stock + guard + events + history", "stock", 0.0},
    {"friction", "stock + friction", "stock", 0.0},
    {"rolling", "stock + friction + rolling", "stock + friction", 0.0},
    {"second", "second", "stock", 0.0},
    {"second + friction", "second + friction", "stock + friction", 1.10, "bed 2500"},
    {"second, D = 0.1", "second + friction + D = 0.1", "stock + friction + D = 0.1", 1.10, "bed 2500"}};

PageTable piece_table(const std::vector<PieceCost> &costs) {
  PageTable table("pieces", "Cost of each part",
                  "scene | piece | variant | over | ratio (-) | lower quartile (-) | upper quartile (-) | "
                  "allowed at most (-) | extra per step (us)",
                  4);
  table.criterion = "parts that have an acceptance criterion cost no more than it allows";
  for (const PieceCost &cost : costs)
    table.add({cost.scene, cost.comparison.piece, cost.comparison.variant, cost.comparison.base,
               fmt::format("{:.3f}", cost.ratio.median), fmt::format("{:.3f}", cost.ratio.lower),
               fmt::format("{:.3f}", cost.ratio.upper),
               cost.allowed() > 0.0 ? fmt::format("{:.2f}", cost.allowed()) : "–",
               fmt::format("{:.3g}", cost.extra_us_per_step)},
              cost.allowed() == 0.0 ? RowState::plain
              : cost.holds()        ? RowState::agrees
                                    : RowState::differs);
  table.notes = {"Law: the plugin's law with stock stepping (velocity Verlet) over the engine's law. Second: "
                 "the second-order scheme over stock stepping. History includes the energy balance.",
                 fmt::format("Median over the rounds of the ratio within a round. Where no cost is allowed, "
                             "{:.2f} is the criterion, since smaller ratios cannot be told from the scatter.",
                             nothing)};
  return table;
}

void judge_pieces(const std::vector<PieceCost> &costs, std::vector<Acceptance> &criteria) {
  for (const PieceCost &cost : costs)
    if (cost.allowed() > 0.0)
      criteria.push_back(
          {fmt::format("{}, {}: ratio at most {:.2f}", cost.scene, cost.comparison.piece, cost.allowed()),
           fmt::format("{:.3f}", cost.ratio.median), cost.holds()});
}

PageFigure piece_figure(const std::vector<PieceCost> &costs) {
  const std::string name = "ratios";
  PageFigure figure = page_figure(
      "Fig. 1",
      "Time per step of a run over that of the run without the part: median over the rounds and quartiles.",
      {name, "Time per step over that without the part", {}, 1}, 1.0);
  CurveTable table("piece,ratio (-),lower quartile (-),upper quartile (-)");
  for (const PieceCost &cost : costs) {
    std::vector<Panel> &panels = figure.figure.panels;
    if (panels.empty() || panels.back().title != cost.scene) {
      panels.emplace_back();
      panels.back().title = cost.scene;
      panels.back().y_label = "time per step over that without (-)";
      panels.back().add(curve(name, cost.scene, "$2", "3:4:5", CurveStyle::spread), "");
    }
    panels.back().x_ticks.emplace_back(cost.comparison.piece);
    table.row(cost.scene, {static_cast<double>(panels.back().x_ticks.size()), cost.ratio.median,
                           cost.ratio.lower, cost.ratio.upper});
  }
  figure.csv = table.text();
  return figure;
}

} // namespace

void write_timing_page(const std::filesystem::path &out, const TimedBeds &beds) {
  const std::vector<TimedRun> runs = read_timed_runs(out / "runs.csv");
  const std::vector<VariantTime> all = variant_times(runs);
  const std::vector<PieceCost> pieces = piece_costs(runs, comparisons);
  std::vector<Acceptance> criteria;
  judge_pieces(pieces, criteria);
  std::vector<EngineLaws> engines; // that ran
  for (const EngineLaws &laws : engine_laws)
    if (std::any_of(all.begin(), all.end(),
                    [&](const VariantTime &one) { return one.variant == laws.own; })) {
      engines.push_back(laws);
      judge_sizes(runs, beds, laws, criteria);
    }
  Page page(out, "Time of a step", Drawing::bed);
  page.answer("Runs of the chain and of settled beds, from 2500 balls in two dimensions to a quarter of a "
              "million in three, by the engine's own law and by the plugin's, whose optional parts are "
              "switched on one by one; with friction on one rank and on two, in LIGGGHTS and, if it is set "
              "up, in LAMMPS. The runs of a round alternate, so that other load on the machine affects all "
              "of them. Times by the engine's own clock, without starting and reading.");
  page.answer(criteria);
  page.section("Acceptance criteria");
  page.table(acceptance_table(criteria));
  page.section("Cost of each part");
  page.table(piece_table(pieces));
  page.figure(piece_figure(pieces));
  page.section("Throughput");
  page.figure(size_figure(all, beds, engines));
  page.table(memory_table(all, beds, engines));
  page.section("Time of a step");
  page.table(time_table(runs, all));
  page.section("Estimate for 1e8 balls");
  page.table(projection_table(runs, all, beds));
  page.paragraph("Decomposition: a bed is wide and flat, so ranks share it along x and z, never along y "
                 "(processors * 1 * in the decks). Each rank then has columns of soil of the same height, "
                 "from floor to surface, and needs no balancing. The roller is on few ranks. As a clump its "
                 "balls are as small as soil balls and add a few per cent of work there; as one ball much "
                 "larger than the soil it would widen the ghost layer of every rank to its own size.");
  page.paragraph(
      "Limits: (1) ghosts, from about ten thousand balls per rank on: the column of the table that "
      "decreases. (2) Messages: each step sends positions and velocities of the ghosts, the second-order "
      "scheme those of coupled balls once more, and every record sums about forty numbers over all ranks: "
      "choose samples_per_cycle and dumps no larger than needed. (3) The memory bandwidth of a node, of "
      "which the efficiency on two ranks shows the beginning. (4) Files: the engine gathers a restart file "
      "on one rank. (5) Copies: in.tile runs on one rank and must hold the whole bed there, since on more "
      "ranks the engine gives IDs twice; a bed larger than the memory of one node has to be made by " +
      front_command() + " bed and settled, or read in parts. (6) Integers: an ID has 31 bits, 2.1e9 balls.");
  page.write();
}

} // namespace drumlin::post
