#include "passes/map_figures.h"

#include "pages/figure.h"
#include "passes/drive.h"
#include "support/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace {

std::string label_of(const MeterMap &map) { return fmt::format("{} [{}]", map.meter, map.unit); }

std::string percent(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

/// Colours from the least to the largest value.
std::string color_range_of(const std::vector<double> &values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *least < *most ? axis_range(*least, *most) : axis_range(*least - 1.0, *most + 1.0);
}

/// A panel of one line with markers.
Panel line_panel(const std::string &figure, const std::string &key, const std::string &title,
                 const std::string &x, const std::string &y) {
  Panel panel{title, x, y, {}};
  panel.add(curve(figure, key, "$2", "3", CurveStyle::series_1), "");
  return panel;
}

} // namespace

CurveStyle pass_line(std::size_t n) {
  constexpr std::array<CurveStyle, 5> styles = {CurveStyle::line_5, CurveStyle::line_2, CurveStyle::line_3,
                                                CurveStyle::line_4, CurveStyle::line_1};
  return styles[n % styles.size()];
}

std::vector<std::size_t> shown_passes(std::size_t passes) {
  const std::set<std::size_t> some = {0, std::min<std::size_t>(1, passes), std::min<std::size_t>(2, passes),
                                      (passes + 2) / 2, passes};
  return {some.begin(), some.end()};
}

JudgedMap::JudgedMap(MeterMap values, const AcceptanceRule &asked)
    : map(std::move(values)), rule(asked), rows(cells_of_passes(map, rule)) {}

std::vector<Acceptance> criteria_of(const JudgedMap &judged) {
  const AcceptanceRule &rule = judged.rule;
  if (!rule.target) return {};
  const PassCells &last = judged.rows.back();
  const std::string unit = judged.map.unit_words();
  std::vector<Acceptance> criteria;
  constexpr double rounding = 1e-9;
  criteria.push_back({fmt::format("at least {} of the cells have {} of {:g}{} or more after their last pass",
                                  percent(rule.coverage), judged.map.meter, *rule.target, unit),
                      fmt::format("{} of {} cells", percent(*last.coverage), last.cells),
                      *last.coverage >= rule.coverage - rounding});
  criteria.push_back(
      {fmt::format("the coefficient of variation of the cells is at most {}", percent(rule.variation)),
       std::isfinite(last.variation()) ? percent(last.variation()) : "one cell",
       last.variation() <= rule.variation + rounding});
  criteria.push_back({fmt::format("the last pass changes the mean by less than {}", percent(rule.gain)),
                      last.gain ? fmt::format("{:+.1f} %", 100.0 * *last.gain) : "not known",
                      last.gain && std::abs(*last.gain) < rule.gain});
  return criteria;
}

PageFigure map_figure(const std::string &label, const JudgedMap &judged) {
  const std::string name = "meter";
  const MeterMap &map = judged.map;
  PageFigure figure = page_figure(
      label,
      fmt::format(
          "{} of the cells of {:g} m along the way in each pass, and the last passes as curves, drawn "
          "at the middles of the cells.",
          map.meter, map.cell),
      {name, fmt::format("{} along the way", map.meter), {}, 1}, 0.8);
  CurveTable table(fmt::format("s [m],pass,left [m],right [m],bottom,top,{}", label_of(map)));
  const double half = 0.5 * map.cell;
  double first = INFINITY, end_of_way = -INFINITY;
  std::vector<double> shown;
  std::vector<std::vector<MapValue>> passes; // of the first run
  for (int pass = 1; pass <= map.passes(); ++pass) {
    passes.emplace_back();
    for (const MapValue &one : map.of_pass(pass)) {
      if (map.places[one.place].area != 0) continue;
      const double s = map.places[one.place].along;
      table.row("map", {s, static_cast<double>(pass), s - half, s + half, pass - 0.5, pass + 0.5, one.value});
      passes.back().push_back(one);
      shown.push_back(one.value);
      first = std::min(first, s - half);
      end_of_way = std::max(end_of_way, s + half);
    }
  }
  Panel colours{"", "place along the way [m]", "pass", {}};
  colours.add(curve(name, "map", "$2", "3:4:5:6:7:8", CurveStyle::cells), "");
  colours.color_label = label_of(map);
  colours.color_range = color_range_of(shown);
  colours.whole_y = map.passes() <= 20;
  colours.y_range = fmt::format("[0.5:{}.5]", map.passes());
  Panel curves{"", "place along the way [m]", label_of(map), {}};
  std::size_t n = 0;
  for (const std::size_t pass : shown_passes(static_cast<std::size_t>(map.passes()))) {
    if (pass == 0 || passes[pass - 1].empty()) continue;
    const std::string key = fmt::format("pass {}", pass);
    std::size_t before = passes[pass - 1].front().place;
    for (const MapValue &one : passes[pass - 1]) {
      if (one.place > before + 1) table.row(key, {NAN, NAN, NAN, NAN, NAN, NAN, NAN}); // a gap
      before = one.place;
      table.row(key, {map.places[one.place].along, static_cast<double>(pass), NAN, NAN, NAN, NAN, one.value});
    }
    curves.curves.push_back(curve(name, key, "$2", "8", pass_line(++n)));
  }
  if (judged.rule.target) {
    for (const double end : {first, end_of_way})
      table.row("target", {end, NAN, NAN, NAN, NAN, NAN, *judged.rule.target});
    curves.curves.push_back(curve(name, "target", "$2", "8", CurveStyle::limit));
  }
  curves.y_range = "[0:*]";
  colours.x_range = curves.x_range = axis_range(first, end_of_way);
  figure.csv = table.text();
  figure.figure.panels = {colours, curves};
  return figure;
}

std::optional<PageFigure> rule_figure(const std::string &label, const JudgedMap &judged, bool mean) {
  const std::string name = "rules";
  const MeterMap &map = judged.map;
  const AcceptanceRule &rule = judged.rule;
  PageFigure figure = page_figure(label, "", {name, "What rules of acceptance ask for", {}, 2});
  CurveTable table("pass,value,low,high");
  std::string caption;
  const std::string passes_range = fmt::format("[0.7:{}.3]", std::max(2, map.passes()));
  const auto add = [&](Panel panel) {
    if (panel.x_label == "passes") {
      panel.x_range = passes_range;
      panel.whole_x = map.passes() <= 12;
    }
    figure.figure.panels.push_back(std::move(panel));
  };
  const auto line_at = [&](const std::string &key, double height) {
    table.row(key, {0.7, height});
    table.row(key, {std::max(2, map.passes()) + 0.3, height});
  };
  const auto rows_end = judged.rows.end() - 1; // the last row is no pass
  if (mean) {
    for (auto row = judged.rows.begin(); row != rows_end; ++row)
      table.row("mean", {static_cast<double>(row->pass), row->mean, row->mean - row->deviation,
                         row->mean + row->deviation});
    Panel panel = line_panel(name, "mean", "Mean of the cells", "passes", label_of(map));
    panel.add(curve(name, "mean", "$2", "3:4:5", CurveStyle::spread), "");
    panel.y_range = "[0:*]";
    if (rule.target) {
      line_at("target", *rule.target);
      panel.add(curve(name, "target", "$2", "3", CurveStyle::limit), "target");
    }
    add(std::move(panel));
    caption += "Bars: standard deviation of the cells. ";
  }
  bool gains = false;
  for (auto row = judged.rows.begin(); row != rows_end; ++row)
    if (row->gain) {
      table.row("gain", {static_cast<double>(row->pass), 100.0 * *row->gain});
      gains = true;
    }
  if (gains) {
    Panel panel = line_panel(name, "gain", fmt::format("Gain of the mean {}", map.meter), "passes",
                             "gain of the mean per pass [%]");
    for (const double sign : {1.0, -1.0}) {
      const std::string key = sign > 0.0 ? "bound" : "lower bound";
      line_at(key, sign * 100.0 * rule.gain);
      panel.add(curve(name, key, "$2", "3", CurveStyle::limit),
                sign > 0.0 ? fmt::format("± {:g} %", 100.0 * rule.gain) : "");
    }
    add(std::move(panel));
    caption += "Gain: of the mean of the cells that both passes have, over the pass before. ";
  }
  if (rule.target) {
    for (auto row = judged.rows.begin(); row != rows_end; ++row)
      table.row("coverage", {static_cast<double>(row->pass), 100.0 * *row->coverage});
    Panel panel = line_panel(name, "coverage", "Coverage", "passes", "cells at or above the target [%]");
    line_at("least coverage", 100.0 * rule.coverage);
    panel.add(curve(name, "least coverage", "$2", "3", CurveStyle::limit),
              fmt::format("{:g} %", 100.0 * rule.coverage));
    panel.y_range = "[0:105]";
    add(std::move(panel));
    caption += "Coverage: share of the cells at or above the target.";
  }
  if (figure.figure.panels.empty()) return std::nullopt;
  figure.caption = caption;
  figure.csv = table.text();
  return figure;
}

PageTable map_table(const JudgedMap &judged) {
  const MeterMap &map = judged.map;
  PageTable table(
      "cells_by_pass", fmt::format("{} of the cells", map.meter),
      fmt::format("pass | cells | mean ({0}) | standard deviation ({0}) | coefficient of variation "
                  "(%) | gain of the mean (%) | at or above the target (%)",
                  map.unit));
  const auto number = [](double value, const char *format) {
    return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : std::string(no_value);
  };
  for (const PassCells &row : judged.rows)
    table.add({row.pass == 0 ? "last of each cell" : std::to_string(row.pass), std::to_string(row.cells),
               number(row.mean, "{:.4g}"), number(row.deviation, "{:.3g}"),
               number(100.0 * row.variation(), "{:.1f}"), number(100.0 * row.gain.value_or(NAN), "{:+.1f}"),
               number(100.0 * row.coverage.value_or(NAN), "{:.0f}")});
  if (!judged.rule.target)
    table.notes.emplace_back("No target was given (--target): coverage is not known and nothing is judged.");
  return table;
}

PageFigure animation_of(const std::string &label, const PassesResult &result) {
  const std::string name = "animation";
  const PassDumps &dumps = result.animated;
  PageFigure figure = page_figure(
      label,
      fmt::format("Pass {} in {} pictures, {:.3g} s apart; balls of soil coloured by the mean pressure in "
                  "them{}, drum and frame as outlines. Colours end where 99 % of the values do. The picture "
                  "here plays on its own; the PNG has the one in the middle.",
                  dumps.pass, dumps.steps.size(),
                  (dumps.times.back() - dumps.times.front()) / static_cast<double>(dumps.steps.size() - 1),
                  result.flat ? "" : ", those that the middle section across the drum's axis cuts"),
      {name, fmt::format("Pass {} as an animation", dumps.pass), {}, 1, false, true});
  CurveTable table("picture,x [m],y [m],radius [m],pressure [kPa]");
  std::vector<double> shown; // pressures of all pictures
  Bounds bounds;
  for (std::size_t n = 0; n < dumps.steps.size(); ++n) {
    const DumpedBed state = read_dumped_bed(result.folder, dumps.steps[n]);
    const std::vector<double> pressures =
        state.contacts ? ball_pressures(state.balls, *state.contacts) : std::vector<double>();
    double middle = 0.0;
    if (!result.flat) {
      Bounds all;
      for (const Ball &ball : state.balls)
        if (is_soil(ball.type)) all.add(ball);
      middle = 0.5 * (all.low[2] + all.high[2]);
    }
    for (std::size_t b = 0; b < state.balls.size(); ++b) {
      const Ball &ball = state.balls[b];
      const bool soil = is_soil(ball.type);
      if (soil && !result.flat && std::abs(ball.position[2] - middle) > ball.radius) continue;
      bounds.add(ball);
      const double kilo = 1e-3 * (b < pressures.size() ? std::max(0.0, pressures[b]) : 0.0);
      table.row(soil ? "soil" : "roller", {static_cast<double>(n + 1), ball.position[0], ball.position[1],
                                           ball.radius, soil ? kilo : NAN});
      if (soil) shown.push_back(kilo);
    }
    figure.figure.frames.push_back(fmt::format("pass {}, t = {:.3f} s, drum at s = {:.2f} m", dumps.pass,
                                               dumps.times[n], dumps.places[n]));
  }
  const double most = shown.empty() ? 0.0 : quantile(std::move(shown), 0.99);
  Panel panel{"", "place along the way [m]", "height above the floor [m]", {}};
  const std::string x = "($2==frame ? $3 : NaN)";
  panel.add(curve(name, "soil", x, "4:5:6", CurveStyle::discs), "");
  panel.add(curve(name, "roller", x, "4:5", CurveStyle::circles), "");
  panel.equal_scales = true;
  panel.color_label = "pressure [kPa]";
  panel.color_range = axis_range(0.0, most > 0.0 ? most : 1.0);
  panel.x_range = axis_range(bounds.low[0], bounds.high[0]);
  panel.y_range = axis_range(std::min(0.0, bounds.low[1]), bounds.high[1]);
  const double shape = (bounds.high[1] - std::min(0.0, bounds.low[1])) / (bounds.high[0] - bounds.low[0]);
  constexpr double wide = 900.0, margins = 110.0; // px: width of the axes, space above and below
  figure.figure.height = static_cast<int>(std::clamp(wide * shape + margins, 260.0, 800.0));
  figure.figure.panels = {panel};
  figure.csv = table.text();
  return figure;
}

} // namespace drumlin::post
