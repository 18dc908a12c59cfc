#include "studies/cost/page.h"

#include "pages/figure_data.h"
#include "pages/page.h"
#include "studies/cost/results.h"

#include <fmt/format.h>

namespace drumlin::post {

namespace {

/// What the scatter of a ratio leaves to be told, where nothing is to be added.
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

ReportTable variant_table(const std::vector<VariantCost> &costs) {
  ReportTable table;
  table.name = "variants";
  table.title = "What a step takes";
  table.text_columns = 2;
  table.header = {
      "scene",     "variant",           "rounds", "step (us)", "lower quartile (us)", "upper quartile (us)",
      "pair (us)", "ball and step (ns)"};
  for (const VariantCost &cost : costs)
    table.add({cost.scene, cost.variant, std::to_string(cost.rounds),
               fmt::format("{:.4g}", cost.us_per_step.median), fmt::format("{:.4g}", cost.us_per_step.lower),
               fmt::format("{:.4g}", cost.us_per_step.upper), fmt::format("{:.4g}", cost.pair_us_per_step),
               fmt::format("{:.4g}", cost.ns_per_ball)});
  table.notes = {
      "Medians over the rounds. Pair is the part of a step in the pair style; balls are those that move."};
  return table;
}

ReportTable piece_table(const std::vector<PieceCost> &costs) {
  ReportTable table;
  table.name = "pieces";
  table.title = "What a piece adds";
  table.text_columns = 4;
  table.header = {"scene",
                  "piece",
                  "variant",
                  "over",
                  "ratio (-)",
                  "lower quartile (-)",
                  "upper quartile (-)",
                  "promised at most (-)",
                  "extra per step (us)"};
  for (const PieceCost &cost : costs)
    table.add({cost.scene, cost.comparison.piece, cost.comparison.variant, cost.comparison.base,
               fmt::format("{:.3f}", cost.ratio.median), fmt::format("{:.3f}", cost.ratio.lower),
               fmt::format("{:.3f}", cost.ratio.upper),
               cost.promised() > 0.0 ? fmt::format("{:.2f}", cost.promised()) : "–",
               fmt::format("{:.3g}", cost.extra_us_per_step)},
              cost.promised() == 0.0 ? RowState::plain
              : cost.holds()         ? RowState::agrees
                                     : RowState::differs);
  table.notes = {
      "Law: the plugin's law with stock stepping over the engine's; second: the second-order stepping over "
      "stock. "
      "History keeps the energy ledger.",
      fmt::format(
          "Median over the rounds of the ratio within a round. {:.2f} stands for nothing: less cannot be "
          "told from the scatter.",
          nothing)};
  return table;
}

PlannedFigure piece_figure(const std::vector<PieceCost> &costs) {
  const std::string name = "ratios";
  PlannedFigure figure;
  figure.label = "Fig. 1";
  figure.caption = "Cost per step of a variant over the one without the piece: median over the rounds, "
                   "quartiles.";
  figure.figure = {name, "Cost per step over that without the piece", {}, 1, 1000, 520};
  CurveTable table("piece,ratio (-),lower quartile (-),upper quartile (-)");
  for (const PieceCost &cost : costs) {
    std::vector<Panel> &panels = figure.figure.panels;
    if (panels.empty() || panels.back().title != cost.scene) {
      panels.emplace_back();
      panels.back().title = cost.scene;
      panels.back().y_label = "cost per step over base (-)";
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
  StudyPage page(out, "Cost of a step");
  page.paragraph("Runs of the chain and of settled beds by the engine's own law hooke/stiffness and by the "
                 "plugin's, with its "
                 "optional pieces switched on one by one. Runs of one round are interleaved, so that a busy "
                 "moment of the "
                 "machine falls on all of them. One rank; times by the engine's own clock, without starting "
                 "and reading.");
  page.section("Pieces");
  page.table(piece_table(pieces));
  page.figure(piece_figure(pieces));
  page.section("Variants");
  page.table(variant_table(variant_costs(runs)));
  page.write();
}

} // namespace drumlin::post
