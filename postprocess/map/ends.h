// The motion to which a drum with two ends settles: how both ends leave the soil, and whether they do so
// together or by turns (rocking).
#pragma once

#include "chain/two_ends.h"
#include "map/figures.h"
#include "map/orbit_search.h"
#include "map/regime_map.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace drumlin::post {

/// The drum with two ends as a System of map/orbit_search.h. Tilts count at the radii of gyration.
struct EndsCycles {
  using State = TwoEndsState;
  using Matrix = TwoEndsMatrix;
  using Motion = TwoEndsMotion;
  struct Passage {
    TwoEndsState end = TwoEndsState::Zero();
    TwoEndsMatrix jacobian = TwoEndsMatrix::Identity(); ///< only if asked for
  };
  const TwoEndsSolver &solver;

  Passage pass(const TwoEndsState &state, int cycles, bool with_jacobian) const;
  TwoEndsState scale() const;
  TwoEndsMotion start_at(const TwoEndsState &state) const { return solver.start_at(state); }
  void advance(TwoEndsMotion &motion, TwoEndsState *tangent) const;
};

/// Motions by their period and by which end leaves the soil, after Adam's operating modes. A motion of two
/// cycles is told by what differs from one cycle to the next: the height of the drum's middle (double jump),
/// its tilt (rocking: the ends jump by turns), or both (combined; neither is three times the other).
enum class EndsMode {
  continuous_contact,
  uplift_of_one_end,
  uplift_of_both_ends,
  double_jump,
  rocking,
  combined,
  higher_period,
  aperiodic,
  undecided
};
constexpr std::size_t ends_mode_count = 9;
/// Their names in files, "continuous contact" and so on.
extern const std::array<const char *, ends_mode_count> ends_mode_names;

struct EndsPoint {
  EndsMode mode = EndsMode::undecided;
  int period = 0;          ///< in cycles; 0 without one
  double multiplier = 0.0; ///< largest modulus of the orbit's multipliers [-]; 0 without an orbit
  Exponent exponent{};     ///< per cycle, as RegimePoint has it
  /// Over a period, or over 64 cycles of a motion without one: half the range of the drum's tilt [rad], and
  /// the shares of time in which a contact of the left half and of the right one acts.
  double tilt = 0.0;
  std::array<double, 2> contact_share{};
};

/// Follows the machine from rest with its tilt, which lets a motion that is not stable against tilting leave
/// it, and says what it settles to. \param cycles as settle() takes them
EndsPoint judge_ends(const TwoEnds &machine, int cycles);

/// The same from a motion, which is replaced by that at the end.
EndsPoint judge_ends_from(const TwoEndsSolver &solver, TwoEndsMotion &motion, int cycles);

/// How far the linear steady motion of unbroken contact is from losing contact, at the contact where it is
/// nearest: the least force of the contact under B, k times its least overlap under A [N]. Negative: it loses
/// it. Closed form.
double ends_margin(const TwoEnds &machine);

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
