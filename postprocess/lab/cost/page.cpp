#include "lab/cost/page.h"

#include "pages/figure_data.h"
#include "pages/page.h"
#include "lab/cost/results.h"

#include <fmt/format.h>

namespace drumlin::post {

namespace {

/// Allowed ratio for parts that should not add cost: the scatter of the ratios is about 2 %.
constexpr double nothing = 1.02;

const std::vector<Comparison> comparisons = {
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

PageTable variant_table(const std::vector<VariantCost> &costs) {
  PageTable table;
  table.name = "variants";
  table.title = "Time of a step";
  table.text_columns = 2;
  table.header = {
      "scene",     "variant",           "rounds", "step (us)", "lower quartile (us)", "upper quartile (us)",
      "pair (us)", "ball and step (ns)"};
  for (const VariantCost &cost : costs)
    table.add({cost.scene, cost.variant, std::to_string(cost.rounds),
               fmt::format("{:.4g}", cost.us_per_step.median), fmt::format("{:.4g}", cost.us_per_step.lower),
               fmt::format("{:.4g}", cost.us_per_step.upper), fmt::format("{:.4g}", cost.pair_us_per_step),
               fmt::format("{:.4g}", cost.ns_per_ball)});
  table.notes = {"Medians over the rounds. Pair: the part of a step that the pair style takes. Per ball: of "
                 "the balls that move."};
  return table;
}

PageTable piece_table(const std::vector<PieceCost> &costs) {
  PageTable table;
  table.name = "pieces";
  table.title = "Cost of each part";
  table.criterion = "parts that have an acceptance criterion cost no more than it allows";
  table.text_columns = 4;
  table.header = {"scene",
                  "piece",
                  "variant",
                  "over",
                  "ratio (-)",
                  "lower quartile (-)",
                  "upper quartile (-)",
                  "allowed at most (-)",
                  "extra per step (us)"};
  for (const PieceCost &cost : costs)
    table.add({cost.scene, cost.comparison.piece, cost.comparison.variant, cost.comparison.base,
               fmt::format("{:.3f}", cost.ratio.median), fmt::format("{:.3f}", cost.ratio.lower),
               fmt::format("{:.3f}", cost.ratio.upper),
               cost.allowed() > 0.0 ? fmt::format("{:.2f}", cost.allowed()) : "–",
               fmt::format("{:.3g}", cost.extra_us_per_step)},
              cost.allowed() == 0.0 ? RowState::plain
              : cost.holds()        ? RowState::agrees
                                    : RowState::differs);
  table.notes = {
      "Law: the plugin's law with stock stepping (velocity Verlet) over the engine's law. Second: the "
      "second-order "
      "scheme over stock stepping. History includes the energy balance.",
      fmt::format(
          "Median over the rounds of the ratio within a round. Where no cost is allowed, {:.2f} is the "
          "criterion, since smaller ratios cannot be told from the scatter.",
          nothing)};
  return table;
}

/// The acceptance criteria of the parts that have one.
std::vector<Acceptance> acceptance_of(const std::vector<PieceCost> &costs) {
  std::vector<Acceptance> criteria;
  for (const PieceCost &cost : costs)
    if (cost.allowed() > 0.0)
      criteria.push_back(
          {fmt::format("{}, {}: ratio at most {:.2f}", cost.scene, cost.comparison.piece, cost.allowed()),
           fmt::format("{:.3f}", cost.ratio.median), cost.holds()});
  return criteria;
}

PageFigure piece_figure(const std::vector<PieceCost> &costs) {
  const std::string name = "ratios";
  PageFigure figure;
  figure.label = "Fig. 1";
  figure.weight = 1.0;
  figure.caption = "Time per step of a run over that of the run without the part: median over the rounds and "
                   "quartiles.";
  figure.figure = {name, "Time per step over that without the part", {}, 1};
  CurveTable table("piece,ratio (-),lower quartile (-),upper quartile (-)");
  for (const PieceCost &cost : costs) {
    std::vector<Panel> &panels = figure.figure.panels;
    if (panels.empty() || panels.back().title != cost.scene) {
      panels.emplace_back();
      panels.back().title = cost.scene;
      panels.back().y_label = "time per step over that without (-)";
      panels.back().curves = {curve(name, cost.scene, "$2", "3:4:5", CurveStyle::spread)};
      panels.back().curves.back().title.clear();
    }
    panels.back().x_ticks.emplace_back(cost.comparison.piece);
    table.row(cost.scene, {static_cast<double>(panels.back().x_ticks.size()), cost.ratio.median,
                           cost.ratio.lower, cost.ratio.upper});
  }
  figure.csv = table.text();
  return figure;
}

} // namespace

void write_cost_page(const std::filesystem::path &out) {
  const std::vector<CostRun> runs = read_cost_runs(out / "runs.csv");
  const std::vector<PieceCost> pieces = piece_costs(runs, comparisons);
  Page page(out, "Cost of a time step", Drawing::bed);
  page.answer(
      "Runs of the chain and of settled beds by the engine's own law hooke/stiffness and by the plugin's "
      "law, whose "
      "optional parts are switched on one by one. The runs of a round alternate, so that other load on the "
      "machine "
      "affects all of them. One rank; times by the engine's own clock, without starting and reading.");
  page.answer(acceptance_of(pieces));
  page.section("Cost of each part");
  page.table(piece_table(pieces));
  page.figure(piece_figure(pieces));
  page.section("Time of a step");
  page.table(variant_table(variant_costs(runs)));
  page.write();
}

} // namespace drumlin::post
