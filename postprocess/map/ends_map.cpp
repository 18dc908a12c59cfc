#include "map/ends_map.h"

#include "support/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>

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

std::vector<EndsPoint> judge_map(const EndsFamily &family, const MapGrid &grid, int threads,
                                 const std::function<void(std::size_t)> &progress) {
  std::vector<EndsPoint> points(grid.size());
  std::size_t done = 0;
  std::mutex guard;
  in_parallel(points.size(), threads, [&](std::size_t i) {
    points[i] = judge_ends(machine_at(family, grid, grid.x_of(i), grid.y_of(i)), grid.cycles);
    const std::lock_guard<std::mutex> lock(guard);
    progress(++done);
  });
  return points;
}

std::vector<BoundaryPoint> ends_boundaries(const EndsFamily &family, const MapGrid &grid) {
  std::vector<BoundaryPoint> found;
  const auto held = [&](double x, double y) { return ends_margin(machine_at(family, grid, x, y)) > 0.0; };
  const auto between = [&](double x0, double y0, double x1, double y1) {
    const bool first = held(x0, y0);
    if (first == held(x1, y1)) return;
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (low + high);
      (held(x0 + middle * (x1 - x0), y0 + middle * (y1 - y0)) == first ? low : high) = middle;
    }
    found.push_back({"loss of contact", x0 + low * (x1 - x0), y0 + low * (y1 - y0)});
  };
  const auto width = static_cast<std::size_t>(grid.x.count);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (i % width + 1 < width) between(grid.x_of(i), grid.y_of(i), grid.x_of(i + 1), grid.y_of(i + 1));
    if (i + width < grid.size())
      between(grid.x_of(i), grid.y_of(i), grid.x_of(i + width), grid.y_of(i + width));
  }
  return found;
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
  std::string cells = "x,y,left,right,low,high,mode,tilt_mrad,contact_left,contact_right\n", marks = "x,y\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto mode = static_cast<std::size_t>(points[i].mode);
    seen[mode] = true;
    cells += fmt::format("{},{},{:.6g},{:.6g},{:.6g}\n", point_cells(grid, i), mode, 1e3 * points[i].tilt,
                         points[i].contact_share[0], points[i].contact_share[1]);
  }
  for (const BoundaryPoint &point : boundaries)
    marks += fmt::format("{:.12g},{:.12g}\n", shown_axis(grid.x).scale * point.x,
                         shown_axis(grid.y).scale * point.y);
  result.data = {{"plot_ends.csv", cells}, {"plot_boundaries.csv", marks}};
  const std::string given = conditions(grid.chain, {grid.x.parameter(), grid.y.parameter()});
  const auto add = [&](const std::string &name, const std::string &title, Panel panel) {
    if (!boundaries.empty())
      panel.curves.push_back(
          {"plot_boundaries.csv", "1", "2", boundary_title("loss of contact"), CurveStyle::mark_1});
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
