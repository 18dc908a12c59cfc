// The motion to which a roller settles (its regime), and the values of a compaction meter in it.
#pragma once

#include "map/orbits.h"

#include <array>
#include <string>
#include <vector>

namespace drumlin::post {

/// Motions by their period and by whether the drum leaves the ground, after Adam's operating modes.
/// `undecided`: no stable orbit was reached, and the interval of the largest exponent contains 0.
enum class Regime { continuous_contact, partial_uplift, period_2, higher_period, aperiodic, undecided };
constexpr std::size_t regime_count = 6;

/// Their names in files: "continuous contact", "partial uplift", "period 2", "higher period", "aperiodic",
/// "undecided".
extern const std::array<const char *, regime_count> regime_names;
/// The regime of a name; std::invalid_argument says which there are.
Regime regime_from_name(const std::string &name);

/// Values over a whole number of periods, or over 64 cycles of a motion without one. Of the exact motion: no
/// sampling. As in meter/values.h.
struct MeterValues {
  double cmv = 0.0;           ///< 300 A_2 / A_1 [-]
  double rmv = 0.0;           ///< 100 A_0.5 / A_1 [-]
  double ccv = 0.0;           ///< [-]
  double k_B = 0.0;           ///< from the drum's mass alone: contains the force of the frame [N/m]
  double k_1 = 0.0;           ///< the same with the frame's force: that of the soil [N/m]
  double c_1 = 0.0;           ///< [N s/m]
  double energy = 0.0;        ///< given to the soil in two cycles [J]
  double peak_force = 0.0;    ///< largest contact force [N]
  double contact_share = 0.0; ///< share of time in contact [-]
  /// Lowest position of the drum in each cycle below that where it just touches, if it is in contact there:
  /// its velocity is zero, so that the contact force is k times this [m].
  std::vector<double> deflections;
};

/// Meter values of the motion from a state at the start of a cycle, over an even number of cycles. The
/// integrals over each piece are by Gauss's rule with 12 points, exact to rounding for its length.
MeterValues meter_values(const ChainSolver &solver, const ChainState &state, int cycles);

struct RegimePoint {
  Regime regime = Regime::undecided;
  int period = 0;          ///< in cycles; 0 without one
  int followed = 0;        ///< cycles after which the motion was judged
  double multiplier = 0.0; ///< largest modulus of the orbit's multipliers [-]; 0 without an orbit
  Exponent
      exponent; ///< per cycle; of an orbit the logarithm of its multiplier over its period, without interval
  MeterValues meter;
};

/// Follows the chain from static equilibrium for `cycles` cycles, 100 or more, and determines the regime that
/// it has reached. An orbit counts if Newton finds it near the last state, it is stable, and the motion has
/// come nearer to it. A motion can be aperiodic for thousands of cycles before it falls into a stable orbit
/// (chaotic transient). Without an orbit it is therefore followed for up to longest_transient times as many
/// cycles, until it reaches one. If it does not, the exponent is taken over `cycles` cycles, and over twice
/// and three times as many while its interval contains 0 or its mean is below 0.02 per cycle. With fewer than
/// 129 cycles the first look for an orbit finds periods up to half of `cycles` only.
RegimePoint judge_regime(const ChainParameters &parameters, int cycles);

} // namespace drumlin::post
