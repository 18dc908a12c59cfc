#include "passes/soil.h"

#include "support/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace drumlin::post {

namespace {

constexpr double most_lines = 1e6;

double square(double x) { return x * x; }

/// Area of a disc, or volume of a sphere, of radius 1 to the left of `x`, -1 to 1.
double content_left_of(double x, bool flat) {
  const double at = std::clamp(x, -1.0, 1.0);
  return flat ? pi - std::acos(at) + at * std::sqrt(1.0 - at * at) : pi / 3.0 * square(1.0 + at) * (2.0 - at);
}

/// Area of a disc, or volume of a sphere, between two planes along an axis.
double content_between(const Ball &ball, std::size_t axis, double from, double to, bool flat) {
  const double r = ball.radius, x = ball.position[axis];
  return (flat ? r * r : r * r * r) *
         (content_left_of((to - x) / r, flat) - content_left_of((from - x) / r, flat));
}

double mean_diameter(const Drive &drive) {
  double diameters = 0.0, count = 0.0;
  for (const Ball &ball : drive.states.front().balls)
    if (is_soil(ball.type)) {
      diameters += 2.0 * ball.radius;
      count += 1.0;
    }
  return diameters / count;
}

/// Calls visit(line) for the lines that meet a ball, with their distance from its centre along the way.
template <class Visit>
void for_lines_of(const Ball &ball, const VerticalLines &lines, const Visit &visit) {
  const double first = std::ceil((ball.position[0] - ball.radius - lines.low) / lines.spacing - 0.5);
  for (auto line = static_cast<std::size_t>(std::max(0.0, first)); line < lines.count; ++line) {
    const double across = lines.at(line) - ball.position[0];
    if (across > ball.radius) break;
    if (across >= -ball.radius) visit(line, across);
  }
}

} // namespace

double usual_spacing(const Drive &drive) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Ball &ball : drive.states.front().balls)
    if (is_soil(ball.type)) smallest = std::min(smallest, ball.radius);
  return 0.25 * smallest;
}

VerticalLines lines_over(const Drive &drive, double spacing) {
  Bounds soil;
  for (const Ball &ball : drive.states.front().balls)
    if (is_soil(ball.type)) soil.add(ball);
  const double low = soil.low[0], high = soil.high[0];
  const double rows = drive.flat ? 1.0 : drive.thickness / spacing;
  if (!((high - low) / spacing * rows <= most_lines))
    throw std::invalid_argument(fmt::format("a spacing of at most {:g} lines in the bed", most_lines));
  const WayPart &measured = drive.measured;
  VerticalLines lines;
  lines.spacing = measured.length() / std::max(1.0, std::round(measured.length() / spacing));
  const double before = std::floor(std::max(0.0, measured.from - low) / lines.spacing + 1e-9);
  lines.low = measured.from - before * lines.spacing;
  lines.count = static_cast<std::size_t>(
      std::max(1.0, std::floor((std::max(high, measured.to) - lines.low) / lines.spacing + 1e-9)));
  return lines;
}

LayerTops layer_tops(const Drive &drive, const DumpedBed &state, const VerticalLines &lines) {
  const auto rows =
      static_cast<std::size_t>(drive.flat ? 1.0 : std::max(1.0, std::round(drive.thickness / lines.spacing)));
  const double apart = drive.thickness / static_cast<double>(rows);
  const auto layers = static_cast<std::size_t>(drive.layers);
  // Of all lines, those across the bed one after the other.
  std::vector<std::vector<double>> highest(layers, std::vector<double>(lines.count * rows, 0.0));
  for (std::size_t b = 0; b < state.balls.size(); ++b) {
    if (!state.lies[b]) continue;
    const Ball &ball = state.balls[b];
    std::vector<double> &heights = highest[drive.layer_at(ball)];
    for_lines_of(ball, lines, [&](std::size_t line, double along) {
      const double section = square(ball.radius) - square(along);
      for (std::size_t row = 0; row < rows; ++row) {
        const double z = drive.flat ? 0.0 : (static_cast<double>(row) + 0.5) * apart - 0.5 * drive.thickness;
        const double left = section - (drive.flat ? 0.0 : square(z - ball.position[2]));
        if (left < 0.0) continue;
        double &height = heights[line * rows + row];
        height = std::max(height, ball.position[1] + std::sqrt(left));
      }
    });
  }
  LayerTops tops(layers, std::vector<double>(lines.count, 0.0));
  for (std::size_t layer = 0; layer < layers; ++layer)
    for (std::size_t at = 0; at < lines.count * rows; ++at) {
      if (layer > 0) highest[layer][at] = std::max(highest[layer][at], highest[layer - 1][at]);
      tops[layer][at / rows] += highest[layer][at] / static_cast<double>(rows);
    }
  return tops;
}

double mean_over(const std::vector<double> &heights, const VerticalLines &lines, const WayPart &part) {
  double sum = 0.0, count = 0.0;
  for (std::size_t line = 0; line < lines.count; ++line) {
    if (!part.holds(lines.at(line))) continue;
    sum += heights[line];
    count += 1.0;
  }
  return count > 0.0 ? sum / count : not_a_number;
}

SoilLayers soil_on(const Drive &drive, const DumpedBed &state, const VerticalLines &lines,
                   const LayerTops &tops, const WayPart &part) {
  SoilLayers soil;
  const double base = part.length() * (drive.flat ? 1.0 : drive.thickness),
               diameters = 2.0 * mean_diameter(drive);
  std::vector<WayPart> inside; // heights
  double below = 0.0;
  for (const std::vector<double> &heights : tops) {
    const double top = mean_over(heights, lines, part), thick = top - below;
    const double beside = std::min(diameters, 0.25 * thick);
    inside.push_back({below + beside, top - beside});
    soil.thickness.push_back(thick);
    soil.inner_space.push_back(base * inside.back().length());
    below = top;
  }
  soil.surface = below;
  std::vector<double> contents(tops.size(), 0.0);
  soil.inner_content.assign(tops.size(), 0.0);
  const bool flat = drive.flat;
  for (std::size_t b = 0; b < state.balls.size(); ++b) {
    if (!state.lies[b]) continue;
    const Ball &ball = state.balls[b];
    const double content = content_between(ball, 0, part.from, part.to, flat);
    if (content == 0.0) continue;
    contents[drive.layer_at(ball)] += content;
    const double r = ball.radius, share = content / (flat ? pi * r * r : 4.0 / 3.0 * pi * r * r * r);
    for (std::size_t layer = 0; layer < inside.size(); ++layer)
      soil.inner_content[layer] +=
          share * content_between(ball, 1, inside[layer].from, inside[layer].to, flat);
  }
  for (std::size_t layer = 0; layer < tops.size(); ++layer)
    soil.solid_fraction.push_back(contents[layer] / (base * soil.thickness[layer]));
  return soil;
}

void take_inside(SoilLayers &whole, const std::vector<SoilLayers> &cells) {
  for (std::size_t layer = 0; layer < whole.thickness.size(); ++layer) {
    whole.inner_content[layer] = whole.inner_space[layer] = 0.0;
    for (const SoilLayers &cell : cells) {
      whole.inner_content[layer] += cell.inner_content[layer];
      whole.inner_space[layer] += cell.inner_space[layer];
    }
  }
}

double compaction_of(const SoilLayers &before, const SoilLayers &after) {
  double sum = 0.0;
  for (std::size_t layer = 0; layer < before.thickness.size(); ++layer)
    sum += before.thickness[layer] * (1.0 - before.solid_fraction[layer] / after.solid_fraction[layer]);
  return sum;
}

double heave_of(const std::vector<double> &before, const std::vector<double> &after,
                const VerticalLines &lines, const WayPart &measured, double length) {
  double largest = not_a_number;
  const double end = lines.low + static_cast<double>(lines.count) * lines.spacing;
  const auto look = [&](const WayPart &side) {
    for (double from = side.from; from + length <= side.to + 1e-9; from += lines.spacing) {
      const WayPart part = {from, from + length};
      const double rise = mean_over(after, lines, part) - mean_over(before, lines, part);
      if (!(rise <= largest)) largest = rise;
    }
  };
  look({lines.low, measured.from});
  look({measured.to, end});
  return largest;
}

std::vector<DepthRow> depth_profile(const Drive &drive, const DumpedBed &state,
                                    const std::vector<DumpedBed> &loaded, double surface, double cell) {
  constexpr double high = 1.5; // mean diameters
  const double slice = high * mean_diameter(drive);
  const double slices = std::floor(surface / slice + 1e-9);
  if (!(slices >= 1.0)) return {};
  const double along = std::max(1.0, std::round(drive.measured.length() / cell));
  FieldGrid grid;
  grid.flat = drive.flat;
  grid.origin = {drive.measured.from, 0.0, drive.flat ? 0.0 : -0.5 * drive.thickness};
  grid.sides = {drive.measured.length() / along, slice, drive.thickness};
  // One slice more than is shown: it takes what lies above.
  grid.cells = {static_cast<std::size_t>(along), static_cast<std::size_t>(slices) + 1, 1};

  std::vector<DepthRow> rows(static_cast<std::size_t>(slices));
  const auto for_cells = [&](const auto &visit) {
    for (std::size_t row = 0; row < rows.size(); ++row)
      for (std::size_t n = 0; n < grid.cells[0]; ++n)
        visit(rows[row], row * grid.cells[0] + n);
  };
  const double share = 1.0 / along;
  const std::vector<BallContact> no_contacts;
  const BedFields fields =
      coarse_grained(state.balls, state.contacts ? state.contacts->balls : no_contacts, grid);
  for (std::size_t row = 0; row < rows.size(); ++row)
    rows[row].height = (static_cast<double>(row) + 0.5) * slice;
  for_cells([&](DepthRow &row, std::size_t at) {
    row.solid_fraction += share * fields.solid_fraction[at];
    if (state.contacts) row.coordination = row.coordination.value_or(0.0) + share * fields.coordination[at];
  });
  const auto add_stress = [&](const std::vector<Tensor> &stress, double weight) {
    constexpr std::size_t xx = 0, yy = 4;
    for_cells([&](DepthRow &row, std::size_t at) {
      row.horizontal = row.horizontal.value_or(0.0) + weight * share * stress[at][xx];
      row.vertical = row.vertical.value_or(0.0) + weight * share * stress[at][yy];
      row.largest_horizontal = std::max(row.largest_horizontal.value_or(stress[at][xx]), stress[at][xx]);
      row.largest_vertical = std::max(row.largest_vertical.value_or(stress[at][yy]), stress[at][yy]);
    });
  };
  if (loaded.empty() && state.contacts) add_stress(fields.stress, 1.0);
  for (const DumpedBed &one : loaded)
    add_stress(coarse_grained(one.balls, one.contacts->balls, grid).stress,
               1.0 / static_cast<double>(loaded.size()));
  return rows;
}

} // namespace drumlin::post
