#include "passes/animation.h"

#include "pages/figure_data.h"
#include "passes/drive.h"
#include "support/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace drumlin::post {

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
  constexpr double wide = 900.0, margins = 110.0; // px, of the axes and below and above them
  figure.figure.height = static_cast<int>(std::clamp(wide * shape + margins, 260.0, 800.0));
  figure.figure.panels = {panel};
  figure.csv = table.text();
  return figure;
}

} // namespace drumlin::post
