// Regimes over two numbers of the chain, and motions along one.
#pragma once

#include "map/orbit_search.h"
#include "map/regime.h"
#include "support/parallel.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// The axis of a drum with two ends: stiffness and damping below its left half over those below its right
/// one.
constexpr const char *ratio_name = "ratio";

/// An axis of a map: the number's name as in decks; ratio_name; frequency, omega/(2 pi) [Hz]; or me_re, the
/// eccentric moment m_e r_e [kg m] with Fw = m_e r_e omega^2.
struct MapAxis {
  std::string name;
  double from = 0.0;
  double to = 0.0;
  int count = 0;    ///< of values, the first at `from`, the last at `to`
  bool log = false; ///< values in equal ratios instead of equal steps

  double value(double place) const; ///< place 0 to count - 1, also between
  std::string parameter() const;    ///< the number of the chain that it sets: its name, or omega of frequency
  std::string unit() const;         ///< "N/m"; "-" for a ratio
  std::string label() const;        ///< "k [N/m]"
};

/// "NAME:FROM:TO:COUNT", behind it ":UNIT" of FROM and TO if not SI, ":log" or both; std::invalid_argument as
/// support/units.h words it.
MapAxis axis_from_text(const std::string &option, const std::string &text, int most_values);

/// The chain that others of a map differ from.
struct MapChain {
  ChainParameters base;
  std::optional<double> me_re; ///< eccentric moment [kg m]; none: the amplitude is Fw whatever the frequency

  /// The chain with the numbers set by axes; Fw is computed from me_re last.
  ChainParameters with(const std::vector<std::pair<std::string, double>> &values) const;
};

/// Points of a map in rows along x. A map along x alone has a y without a name, of one value.
struct MapGrid {
  MapChain chain;
  MapAxis x;
  MapAxis y = {"", 0.0, 0.0, 1, false};
  int cycles = 300;

  std::size_t size() const { return static_cast<std::size_t>(x.count) * static_cast<std::size_t>(y.count); }
  double x_of(std::size_t point) const;
  double y_of(std::size_t point) const;
  ChainParameters at(double x_value, double y_value) const;
  /// What the chain settles to at a point.
  RegimePoint judged(std::size_t point) const { return judge_regime(at(x_of(point), y_of(point)), cycles); }
};

/// Judges points, given by their numbers, by several threads; `done` gets `at_once` of them after the others,
/// in order: the place of the first in `numbers`, and the points.
template <class Point, class Judge, class Done>
void judge_points(const std::vector<std::size_t> &numbers, int threads, std::size_t at_once,
                  const Judge &judge, const Done &done) {
  for (std::size_t first = 0; first < numbers.size(); first += at_once) {
    std::vector<Point> points(std::min(at_once, numbers.size() - first));
    in_parallel(points.size(), threads, [&](std::size_t i) { points[i] = judge(numbers[first + i]); });
    done(first, points);
  }
}

/// A point of a boundary between regimes, on the line between two neighbours of the grid, located to 1e-11 of
/// it.
struct BoundaryPoint {
  std::string kind; ///< "loss of contact", "period doubling" (a multiplier passes -1) or "border" (it jumps
                    ///< beyond -1)
  double x = 0.0;
  double y = 0.0;
};

/// The line between two neighbours of a map.
struct GridEdge {
  std::size_t a = 0, b = 0;    ///< their numbers
  double from = 0.0, to = 0.0; ///< value at a and b of the axis along which they are neighbours
  double other = 0.0;          ///< of the other axis
  bool along_x = true;

  std::pair<double, double> at(double value) const { ///< x and y
    return along_x ? std::pair(value, other) : std::pair(other, value);
  }
};

/// Finds boundaries on all edges of a map, by several threads. \param margin of contact, at x and y, whose
/// sign changes where unbroken contact ends \param period of the motion of each point, 0 without one
/// \param doubling where an orbit of a period that begins at `from` of the edge doubles before `to`
std::vector<BoundaryPoint> boundaries_on_edges(
    const MapGrid &grid, int threads, const std::function<void(double)> &progress,
    const std::function<double(double x, double y)> &margin,
    const std::function<int(std::size_t point)> &period,
    const std::function<std::optional<OrbitChange>(const GridEdge &edge, double from, double to, int period)>
        &doubling);

/// Where unbroken contact ends (closed form) and where orbits double.
std::vector<BoundaryPoint> find_boundaries(const MapGrid &grid, const std::vector<RegimePoint> &points,
                                           int threads, const std::function<void(double)> &progress = {});

/// Once-per-cycle samples along an axis.
struct SweepSample {
  bool up = true;
  double value = 0.0;
  double x_drum = 0.0; ///< at the start of a cycle [m]
  double v_drum = 0.0; ///< [m/s]
};
struct Sweep {
  std::vector<SweepSample> samples;
  std::vector<BoundaryPoint> boundaries; ///< y unused
};

/// Follows the motion from one value to the next, up and then down, `cycles` cycles at each, of which the
/// last `kept` are samples. Doublings are those of the orbit of period 1 that unbroken contact or the first
/// value begins with.
Sweep sweep(const MapChain &chain, const MapAxis &axis, int cycles, int kept,
            const std::function<void(double)> &progress = {});

} // namespace drumlin::post
