// Motions of a drum with two ends over two numbers of it, and along one.
#pragma once

#include "map/ends.h"
#include "map/figures.h"
#include "map/regime_map.h"

#include <functional>
#include <vector>

namespace drumlin::post {

/// The drum on equal contacts that share k and D of the chain, those left of the middle as much stiffer and
/// more damped than those right of it as the axis `ratio` says.
struct EndsFamily {
  MapChain chain;
  Roller roller; ///< how it tilts: see two_ends()
  int contacts = 2;

  /// With the numbers set by axes. It starts with the drum tilted by 1e-5 rad from its static equilibrium, so
  /// that a motion that is unstable against tilting does not last.
  TwoEnds at(const std::vector<std::pair<std::string, double>> &values) const;
};

/// What the drum settles to at a point of a map.
EndsPoint judged(const EndsFamily &family, const MapGrid &grid, std::size_t point);

/// Where unbroken contact ends and where orbits double (double jump or rocking begins), between neighbours of
/// the grid. \param points judged
std::vector<BoundaryPoint> ends_boundaries(const EndsFamily &family, const MapGrid &grid,
                                           const std::vector<EndsPoint> &points, int threads,
                                           const std::function<void(double)> &progress = {});

/// A motion along an axis, with the mode that it has there.
struct EndsSample {
  bool up = true;
  double value = 0.0;
  EndsPoint point;
};

/// Follows the motion from one value to the next, up and then down; each value starts from the motion at the
/// value before, tilted by 1e-6 rad more.
std::vector<EndsSample> sweep_ends(const EndsFamily &family, const MapAxis &axis, int cycles,
                                   const std::function<void(double)> &progress);

/// modes, tilt and contact shares over the axes.
MapFigures ends_figures(const MapGrid &grid, const std::vector<EndsPoint> &points,
                        const std::vector<BoundaryPoint> &boundaries);
/// Tilt over the axis, up and down.
MapFigures ends_sweep_figures(const MapChain &chain, const MapAxis &axis,
                              const std::vector<EndsSample> &samples);

} // namespace drumlin::post
