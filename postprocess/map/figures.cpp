#include "map/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace drumlin::post {

ShownAxis shown_axis(const MapAxis &axis) {
  if (axis.name == "k" || axis.name == "k23") return {1e-6, axis.name + " [MN/m]"};
  if (axis.name == "Fw") return {1e-3, "Fw [kN]"};
  if (axis.name == "c23") return {1e-3, "c23 [kN s/m]"};
  if (axis.name == "me_re") return {1.0, "m_e r_e [kg m]"};
  return {1.0, axis.label()};
}

namespace {

struct Box {
  double left, right, low, high;
};

// The rectangle drawn for some points of the grid: halfway to the neighbours, not beyond the axes' ends. It
// overlaps the next rectangles a little, which are drawn over it: otherwise gaps would show between them.
Box box_of(const MapGrid &grid, int x0, int x1, int y) {
  constexpr double under = 0.06;
  const auto edge = [](const MapAxis &axis, double place) {
    return shown_axis(axis).scale * axis.value(std::clamp(place, 0.0, static_cast<double>(axis.count - 1)));
  };
  return {edge(grid.x, x0 - 0.5), edge(grid.x, x1 + 0.5 + under), edge(grid.y, y - 0.5),
          edge(grid.y, y + 0.5 + under)};
}

std::string box_cells(const MapGrid &grid, const Box &box) {
  const auto middle = [](const MapAxis &axis, double a, double b) {
    return axis.log ? std::sqrt(a * b) : 0.5 * (a + b);
  };
  return fmt::format("{:.8g},{:.8g},{:.8g},{:.8g},{:.8g},{:.8g}", middle(grid.x, box.left, box.right),
                     middle(grid.y, box.low, box.high), box.left, box.right, box.low, box.high);
}

struct Layer {
  const char *name;
  const char *title; ///< on the page
  const char *label; ///< of the colours, in gnuplot's notation
  double (*value)(const RegimePoint &);
};
constexpr std::array<Layer, 4> layers = {
    {{"cmv", "Compaction meter value (CMV)", "CMV = 300 A_2 / A_1",
      [](const RegimePoint &p) { return p.meter.cmv; }},
     {"rmv", "Resonance meter value (RMV)", "RMV = 100 A_{0.5} / A_1",
      [](const RegimePoint &p) { return p.meter.rmv; }},
     {"peak_force", "Peak contact force", "peak contact force [kN]",
      [](const RegimePoint &p) { return p.meter.peak_force / 1e3; }},
     {"contact_share", "Share of time in contact", "share of time in contact",
      [](const RegimePoint &p) { return p.meter.contact_share; }}}};

struct Kind {
  const char *name;
  const char *title;
  CurveStyle style;
};
constexpr std::array<Kind, 3> kinds = {{{"loss of contact", "end of unbroken contact", CurveStyle::mark_1},
                                        {"period doubling", "period doubling", CurveStyle::mark_2},
                                        {"border", "multiplier jumps over -1", CurveStyle::direct_b}}};

} // namespace

Panel map_panel(const MapGrid &grid, const std::string &title) {
  Panel panel;
  panel.title = title;
  const ShownAxis x = shown_axis(grid.x);
  const ShownAxis y = shown_axis(grid.y);
  panel.x_label = x.label;
  panel.y_label = y.label;
  panel.log_x = grid.x.log;
  panel.log_y = grid.y.log;
  constexpr double few = 30.0; // powers of ten would be one or two
  panel.plain_numbers = grid.x.to < few * grid.x.from;
  panel.plain_y = grid.y.to < few * grid.y.from;
  panel.x_range = axis_range(x.scale * grid.x.from, x.scale * grid.x.to);
  panel.y_range = axis_range(y.scale * grid.y.from, y.scale * grid.y.to);
  return panel;
}

std::string point_cells(const MapGrid &grid, std::size_t point) {
  const auto width = static_cast<std::size_t>(grid.x.count);
  const int x = static_cast<int>(point % width), y = static_cast<int>(point / width);
  return box_cells(grid, box_of(grid, x, x, y));
}

namespace {

/// The tables of a map: plot_areas.csv, where neighbours of one regime in a row are one rectangle,
/// plot_cells.csv with the layers of each point; and which regimes they contain.
struct MapTables {
  std::array<bool, regime_count> seen{};
  std::string areas = "regime,x,y,left,right,low,high\n";
  std::string cells = "x,y,left,right,low,high,cmv,rmv,peak_force_kN,contact_share\n";
};

MapTables tables_of(const MapGrid &grid, const std::vector<RegimePoint> &points) {
  MapTables tables;
  const auto at = [&](int x, int y) -> const RegimePoint & {
    return points[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.x.count) +
                  static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < grid.y.count; ++y)
    for (int x = 0; x < grid.x.count; ++x) {
      tables.cells += box_cells(grid, box_of(grid, x, x, y));
      for (const Layer &layer : layers)
        tables.cells += fmt::format(",{:.6g}", layer.value(at(x, y)));
      tables.cells += '\n';
    }
  for (int y = 0; y < grid.y.count; ++y)
    for (int x = 0; x < grid.x.count;) {
      int last = x;
      while (last + 1 < grid.x.count && at(last + 1, y).regime == at(x, y).regime)
        ++last;
      const auto regime = static_cast<std::size_t>(at(x, y).regime);
      tables.seen[regime] = true;
      tables.areas += fmt::format("{},{}\n", regime, box_cells(grid, box_of(grid, x, last, y)));
      x = last + 1;
    }
  return tables;
}

} // namespace

std::string boundary_title(const std::string &kind) {
  for (const Kind &one : kinds)
    if (kind == one.name) return one.title;
  return kind;
}

BoundaryMarks boundary_marks(const MapGrid &grid, const std::vector<BoundaryPoint> &boundaries) {
  BoundaryMarks marks{"kind,x,y\n", {}};
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    std::string rows;
    for (const BoundaryPoint &point : boundaries)
      if (point.kind == kinds[i].name)
        rows += fmt::format("{},{:.12g},{:.12g}\n", i, shown_axis(grid.x).scale * point.x,
                            shown_axis(grid.y).scale * point.y);
    if (rows.empty()) continue;
    marks.rows += rows;
    marks.curves.push_back(
        {"plot_boundaries.csv", fmt::format("($1=={}?$2:NaN)", i), "3", kinds[i].title, kinds[i].style});
  }
  return marks;
}

std::string conditions(const MapChain &chain, const std::vector<std::string> &varied) {
  const auto fixed = [&](const char *name) {
    return std::find(varied.begin(), varied.end(), name) == varied.end();
  };
  const ChainParameters &p = chain.base;
  std::string text = fmt::format("Condition {}", transition_name(p.transition));
  const bool moment = chain.me_re || !fixed("me_re");
  if (fixed("k")) text += fmt::format(", k = {:g} MN/m", p.k / 1e6);
  if (fixed("D")) text += fmt::format(", D = {:g}", p.D);
  if (fixed("omega")) text += fmt::format(", {:.4g} Hz", 1.0 / p.period());
  if (!moment && fixed("Fw")) text += fmt::format(", Fw = {:g} kN", p.Fw / 1e3);
  if (moment && fixed("me_re")) text += fmt::format(", m_e r_e = {:g} kg m", *chain.me_re);
  return text;
}

MapFigures map_figures(const MapGrid &grid, const std::vector<RegimePoint> &points,
                       const std::vector<BoundaryPoint> &boundaries) {
  const MapTables tables = tables_of(grid, points);
  const BoundaryMarks marks = boundary_marks(grid, boundaries);
  MapFigures result;
  result.data = {{"plot_areas.csv", tables.areas},
                 {"plot_cells.csv", tables.cells},
                 {"plot_boundaries.csv", marks.rows}};

  const auto add_marks = [&](Panel &panel) {
    panel.curves.insert(panel.curves.end(), marks.curves.begin(), marks.curves.end());
  };
  const std::string given = conditions(grid.chain, {grid.x.parameter(), grid.y.parameter()});
  Figure regimes;
  regimes.name = "regimes";
  regimes.title = "Motion of the roller";
  regimes.only_png = true;
  Panel panel = map_panel(grid, given);
  constexpr std::array<CurveStyle, regime_count> styles = {CurveStyle::area_1, CurveStyle::area_2,
                                                           CurveStyle::area_3, CurveStyle::area_4,
                                                           CurveStyle::area_5, CurveStyle::area_6};
  for (std::size_t i = 0; i < regime_count; ++i)
    if (tables.seen[i])
      panel.curves.push_back(
          {"plot_areas.csv", fmt::format("($1=={}?$2:NaN)", i), "3:4:5:6:7", regime_names[i], styles[i]});
  add_marks(panel);
  regimes.panels.push_back(panel);
  result.figures.push_back(regimes);

  for (std::size_t i = 0; i < layers.size(); ++i) {
    Figure figure = regimes;
    figure.name = layers[i].name;
    figure.title = layers[i].title;
    Panel layer = map_panel(grid, given);
    layer.color_label = layers[i].label;
    layer.curves.push_back(
        {"plot_cells.csv", "1", fmt::format("2:3:4:5:6:{}", 7 + i), "", CurveStyle::cells});
    add_marks(layer);
    figure.panels = {layer};
    result.figures.push_back(figure);
  }
  return result;
}

MapFigures sweep_figures(const MapChain &chain, const MapAxis &axis, const Sweep &sweep) {
  MapFigures result;
  const ShownAxis shown = shown_axis(axis);
  std::string samples = "up,value,x_drum_mm\n";
  double low = 1e300;
  double high = -1e300;
  for (const SweepSample &sample : sweep.samples) {
    samples +=
        fmt::format("{:d},{:.10g},{:.8g}\n", sample.up, shown.scale * sample.value, 1e3 * sample.x_drum);
    low = std::min(low, 1e3 * sample.x_drum);
    high = std::max(high, 1e3 * sample.x_drum);
  }
  const double rim = std::max(0.05 * (high - low), 1e-9);
  std::string lines = "kind,value,x_drum_mm\n";
  std::array<bool, kinds.size()> has{};
  for (const BoundaryPoint &point : sweep.boundaries)
    for (std::size_t i = 0; i < kinds.size(); ++i)
      if (point.kind == kinds[i].name) {
        has[i] = true;
        lines += fmt::format("{0},{1:.12g},{2:.8g}\n{0},{1:.12g},{3:.8g}\n\n", i, shown.scale * point.x,
                             low - rim, high + rim);
      }
  result.data = {{"plot_samples.csv", samples}, {"plot_lines.csv", lines}};
  Figure figure;
  figure.name = "sweep";
  figure.title = "Once-per-cycle position of the drum";
  figure.only_png = true;
  Panel panel{conditions(chain, {axis.parameter()}), shown.label, "drum at the start of a cycle [mm]", {}};
  panel.log_x = axis.log;
  panel.x_range = axis_range(shown.scale * axis.from, shown.scale * axis.to);
  panel.y_range = axis_range(low - rim, high + rim);
  panel.curves.push_back({"plot_samples.csv", "($1==0?$2:NaN)", "3", "downwards", CurveStyle::dots_down});
  panel.curves.push_back({"plot_samples.csv", "($1==1?$2:NaN)", "3", "upwards", CurveStyle::dots_up});
  constexpr std::array<CurveStyle, 3> line_styles = {CurveStyle::line_5, CurveStyle::line_3,
                                                     CurveStyle::limit};
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (has[i])
      panel.curves.push_back(
          {"plot_lines.csv", fmt::format("($1=={}?$2:NaN)", i), "3", kinds[i].title, line_styles[i]});
  figure.panels = {panel};
  result.figures = {figure};
  return result;
}

} // namespace drumlin::post
