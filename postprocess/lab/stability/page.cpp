#include "lab/stability/page.h"

#include "lab/stability/boundary.h"
#include "pages/figure_data.h"
#include "pages/page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string>

namespace drumlin::post {

namespace {

constexpr std::array<const char *, 2> steppings = {"second", "stock"};
constexpr double no_damping = 1e-3; // D = 0 is drawn here on the logarithmic axis

PageFigure map_figure(const std::vector<MapPoint> &map) {
  const std::string name = "stability_map";
  PageFigure figure =
      page_figure("Fig. 1",
                  fmt::format("The longest stable step over the damping ratio of one contact: a step is "
                              "stable below the points. Solid line: theory for stock stepping; dash-dotted "
                              "line: limit of the undamped springs. D = 0 is drawn at {:g}.",
                              no_damping),
                  {name, "Longest stable step over damping", {}, 2}, 1.0);
  CurveTable table("D drawn at (-),measured w0 dt (-),theory w0 dt (-)");
  for (const HeldScene &scene : held_scenes()) {
    Panel panel{scene.what, "damping ratio D (-)", "ω_0 dt (-)", {}};
    panel.log_x = panel.log_y = true;
    panel.x_range = "[5e-4:2e4]";
    panel.y_range = "[1e-5:4]";
    for (const std::string stepping : steppings) {
      const std::string curve_name = fmt::format("{} {}", scene.name, stepping);
      bool any = false;
      for (const MapPoint &point : map)
        if (point.scene == &scene && point.stepping == stepping) {
          table.row(curve_name, {std::max(no_damping, point.D), point.middle(), point.limit});
          any = true;
        }
      if (!any) continue;
      const bool second = stepping == "second";
      panel.add(curve(name, curve_name, "$2", "4", second ? CurveStyle::limit : CurveStyle::plain),
                second ? "limit of the springs" : "theory for stock");
      panel.curves.push_back(
          curve(name, curve_name, "$2", "3", second ? CurveStyle::measured_b : CurveStyle::measured_a));
      panel.curves.back().title = stepping + ", measured";
    }
    if (!panel.curves.empty()) figure.figure.panels.push_back(panel);
  }
  figure.csv = table.text();
  return figure;
}

PageTable boundary_table(const std::vector<MapPoint> &map) {
  PageTable table(
      "boundaries", "Limits of stability",
      "scene | stepping | lowest stable w0 dt (-) | at D (-) | farthest from theory (%) | there at D (-)", 2);
  for (const HeldScene &scene : held_scenes())
    for (const std::string stepping : steppings) {
      const MapPoint *lowest = nullptr;
      const MapPoint *farthest = nullptr;
      for (const MapPoint &point : map) {
        if (point.scene != &scene || point.stepping != stepping) continue;
        if (lowest == nullptr || point.stable < lowest->stable) lowest = &point;
        if (farthest == nullptr || std::fabs(point.miss()) > std::fabs(farthest->miss())) farthest = &point;
      }
      if (lowest != nullptr)
        table.add({scene.what, stepping, fmt::format("{:.4g}", lowest->stable),
                   fmt::format("{:.3g}", lowest->D), fmt::format("{:+.2g}", 100.0 * farthest->miss()),
                   fmt::format("{:.3g}", farthest->D)});
    }
  table.notes = {"w0 = sqrt(k/m) and D are those of one contact of the ball, with the Hertz law those of its "
                 "small motion. Theory: for stock stepping the limit of the scene with its dampers, for "
                 "second the limit of its springs, 2/sqrt(contacts on a line). All points are in map.csv."};
  return table;
}

} // namespace

void write_stability_page(const std::filesystem::path &out, const std::vector<MapPoint> &map) {
  Page page(out, "Stability", Drawing::confined);
  page.answer("The longest time step at which the motion stays bounded, found by runs of balls of graded "
              "mass that are confined between walls. Second is the plugin's second-order scheme, stock the "
              "engine's velocity Verlet scheme with the plugin's contact law.");
  const std::vector<Acceptance> criteria = judge_stability_map(map);
  page.answer(criteria);
  page.section("The longest stable step");
  page.table(acceptance_table(criteria));
  page.figure(map_figure(map));
  page.table(boundary_table(map));
  page.write();
}

} // namespace drumlin::post
