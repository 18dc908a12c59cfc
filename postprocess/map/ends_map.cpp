#include "map/ends_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace drumlin::post {

TwoEnds EndsFamily::at(const std::vector<std::pair<std::string, double>> &values) const {
  constexpr double small = 1e-5; // rad
  const ChainParameters parameters = chain.with(values);
  TwoEnds machine = two_ends(parameters, roller);
  machine.contacts = equal_contacts(contacts, drum_width(roller), parameters.k, parameters.damping());
  machine.tilt = small;
  for (const auto &[name, value] : values)
    if (name == ratio_name) set_ratio(machine.contacts, value);
  return machine;
}

namespace {

TwoEnds machine_at(const EndsFamily &family, const MapGrid &grid, double x, double y) {
  return family.at({{grid.x.name, x}, {grid.y.name, y}});
}

} // namespace

EndsPoint judged(const EndsFamily &family, const MapGrid &grid, std::size_t point) {
  return judge_ends(machine_at(family, grid, grid.x_of(point), grid.y_of(point)), grid.cycles);
}

std::vector<BoundaryPoint> ends_boundaries(const EndsFamily &family, const MapGrid &grid,
                                           const std::vector<EndsPoint> &points, int threads,
                                           const std::function<void(double)> &progress) {
  return boundaries_on_edges(
      grid, threads, progress,
      [&](double x, double y) { return ends_margin(machine_at(family, grid, x, y)); },
      [&](std::size_t point) { return points[point].period; },
      [&](const GridEdge &edge, double from, double to, int period) -> std::optional<OrbitChange> {
        const auto solver_at = [&](double value) {
          const auto [x, y] = edge.at(value);
          return TwoEndsSolver(machine_at(family, grid, x, y));
        };
        const TwoEndsSolver solver = solver_at(from);
        TwoEndsMotion motion = solver.start();
        for (int cycle = 0; cycle < grid.cycles; ++cycle)
          solver.finish_cycle(motion);
        const auto orbit = newton_orbit(EndsCycles{solver}, motion.state, period);
        if (!orbit || !orbit->stable()) return std::nullopt;
        return located_doubling<EndsCycles>(solver_at, from, to, *orbit);
      });
}

std::vector<EndsSample> sweep_ends(const EndsFamily &family, const MapAxis &axis, int cycles,
                                   const std::function<void(double)> &progress) {
  constexpr double kick = 1e-6; // rad
  std::vector<EndsSample> samples;
  std::optional<TwoEndsState> state;
  for (const bool up : {true, false})
    for (int i = 0; i < axis.count; ++i) {
      const double value = axis.value(up ? i : axis.count - 1 - i);
      const TwoEndsSolver solver(family.at({{axis.name, value}}));
      if (state) (*state)[2] += kick;
      TwoEndsMotion motion = state ? solver.start_at(*state) : solver.start();
      samples.push_back({up, value, judge_ends_from(solver, motion, cycles)});
      state = motion.state;
      progress((up ? 0.0 : 0.5) + 0.5 * (i + 1) / axis.count);
    }
  return samples;
}

MapFigures ends_figures(const MapGrid &grid, const std::vector<EndsPoint> &points,
                        const std::vector<BoundaryPoint> &boundaries) {
  MapFigures result;
  std::array<bool, ends_mode_count> seen{};
  std::string cells = "x,y,left,right,low,high,mode,tilt_mrad,contact_left,contact_right\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto mode = static_cast<std::size_t>(points[i].mode);
    seen[mode] = true;
    cells += fmt::format("{},{},{:.6g},{:.6g},{:.6g}\n", point_cells(grid, i), mode, 1e3 * points[i].tilt,
                         points[i].contact_share[0], points[i].contact_share[1]);
  }
  const BoundaryMarks marks = boundary_marks(grid, boundaries);
  result.data = {{"plot_ends.csv", cells}, {"plot_boundaries.csv", marks.rows}};
  const std::string given = conditions(grid.chain, {grid.x.parameter(), grid.y.parameter()});
  const auto add = [&](const std::string &name, const std::string &title, Panel panel) {
    panel.curves.insert(panel.curves.end(), marks.curves.begin(), marks.curves.end());
    Figure figure;
    figure.name = name;
    figure.title = title;
    figure.only_png = true;
    figure.panels = {std::move(panel)};
    result.figures.push_back(figure);
  };
  constexpr std::array<CurveStyle, ends_mode_count> styles = {
      CurveStyle::area_1, CurveStyle::area_2, CurveStyle::area_4, CurveStyle::area_3, CurveStyle::area_7,
      CurveStyle::area_8, CurveStyle::area_9, CurveStyle::area_5, CurveStyle::area_6};
  Panel modes = map_panel(grid, given);
  for (std::size_t i = 0; i < ends_mode_count; ++i)
    if (seen[i])
      modes.curves.push_back(
          {"plot_ends.csv", fmt::format("($7=={}?$1:NaN)", i), "2:3:4:5:6", ends_mode_names[i], styles[i]});
  add("modes", "Motion of both ends", modes);
  struct Layer {
    const char *name, *title, *label;
    int column;
  };
  for (const Layer &layer :
       {Layer{"tilt", "Tilt of the drum", "half the range of the tilt [mrad]", 8},
        {"contact_left", "Contact of the left half", "share of time in contact", 9},
        {"contact_right", "Contact of the right half", "share of time in contact", 10}}) {
    Panel panel = map_panel(grid, given);
    panel.color_label = layer.label;
    panel.curves.push_back(
        {"plot_ends.csv", "1", fmt::format("2:3:4:5:6:{}", layer.column), "", CurveStyle::cells});
    add(layer.name, layer.title, panel);
  }
  return result;
}

MapFigures ends_sweep_figures(const MapChain &chain, const MapAxis &axis,
                              const std::vector<EndsSample> &samples) {
  MapFigures result;
  const ShownAxis shown = shown_axis(axis);
  std::string rows = "up,value,tilt_mrad\n";
  for (const EndsSample &sample : samples)
    rows +=
        fmt::format("{:d},{:.10g},{:.8g}\n", sample.up, shown.scale * sample.value, 1e3 * sample.point.tilt);
  result.data = {{"plot_samples.csv", rows}};
  Figure figure;
  figure.name = "sweep";
  figure.title = "Tilt of the drum";
  figure.only_png = true;
  Panel panel{conditions(chain, {axis.parameter()}), shown.label, "half the range of the tilt [mrad]", {}};
  panel.log_x = axis.log;
  panel.x_range = axis_range(shown.scale * axis.from, shown.scale * axis.to);
  panel.curves.push_back({"plot_samples.csv", "($1==0?$2:NaN)", "3", "downwards", CurveStyle::measured_a});
  panel.curves.push_back({"plot_samples.csv", "($1==1?$2:NaN)", "3", "upwards", CurveStyle::mark_1});
  figure.panels = {panel};
  result.figures = {figure};
  return result;
}

} // namespace drumlin::post
