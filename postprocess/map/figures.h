// Pictures of a map and of a sweep, with the data that they are drawn from.
#pragma once

#include "map/regime_map.h"
#include "pages/gnuplot.h"

#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// Figures, and the CSV files that their scripts read, by name.
struct MapFigures {
  std::vector<Figure> figures;
  std::vector<std::pair<std::string, std::string>> data;
};

/// regimes, cmv, rmv, peak_force and contact_share over the axes, boundaries drawn in.
MapFigures map_figures(const MapGrid &grid, const std::vector<RegimePoint> &points,
                       const std::vector<BoundaryPoint> &boundaries);

/// Once-per-cycle positions of the drum, up and down, with the boundaries as vertical lines.
MapFigures sweep_figures(const MapChain &chain, const MapAxis &axis, const Sweep &sweep);

} // namespace drumlin::post
