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

/// How a number is shown on an axis of a picture: k in MN/m rather than 1e+08.
struct ShownAxis {
  double scale = 1.0; ///< from SI
  std::string label;
};
ShownAxis shown_axis(const MapAxis &axis);

/// A panel of a map without curves.
Panel map_panel(const MapGrid &grid, const std::string &title);
/// A point of the grid as CurveStyle::cells takes it: "x,y,left,right,low,high".
std::string point_cells(const MapGrid &grid, std::size_t point);

/// Kinds of boundaries as pictures name them.
std::string boundary_title(const std::string &kind);

/// Boundaries as marks in panels of a map, a curve for each kind, and the file that they are drawn from.
struct BoundaryMarks {
  std::string rows; ///< of plot_boundaries.csv: kind, x, y
  std::vector<Curve> curves;
};
BoundaryMarks boundary_marks(const MapGrid &grid, const std::vector<BoundaryPoint> &boundaries);

/// What the chain has at all points of a map, in words. \param varied numbers of the axes
std::string conditions(const MapChain &chain, const std::vector<std::string> &varied);

/// regimes, cmv, rmv, peak_force and contact_share over the axes, boundaries drawn in.
MapFigures map_figures(const MapGrid &grid, const std::vector<RegimePoint> &points,
                       const std::vector<BoundaryPoint> &boundaries);

/// Once-per-cycle positions of the drum, up and down, with the boundaries as vertical lines.
MapFigures sweep_figures(const MapChain &chain, const MapAxis &axis, const Sweep &sweep);

} // namespace drumlin::post
