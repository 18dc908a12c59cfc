// The values that the report judges runs by, as data: steady states of the paper's four cases, compaction
// meter values, restitution of a single impact, and velocity errors known for a number of steps per cycle.
// Each value has its source. SI units unless a unit is named.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// What a reference value measures. The unit is that of ReferenceValue::unit.
enum class ReferenceQuantity {
  drum_acceleration_min, ///< smallest drum acceleration of the steady state
  drum_acceleration_max, ///< largest drum acceleration of the steady state
  contact_force_min,     ///< smallest contact force; negative is tension
  contact_force_max,     ///< largest contact force
  contact_share,         ///< share of time in contact, 0 to 1
  force_at_break,        ///< contact force just before a break (condition A)
  overlap_at_break,      ///< overlap at a break (condition B)
  force_at_make,         ///< contact force just after a make
  breaks_per_cycle,      ///< breaks per excitation cycle (0 where the drum never lifts off)
  makes_per_cycle,       ///< makes per excitation cycle
  compaction_meter_value ///< CMV = 300 A_2 / A_1
};

/// Name of a quantity as the report's tables and CSV files print it.
std::string quantity_name(ReferenceQuantity quantity);

/// One reference value of a case and a transition. `low` equals `high` unless the reference gives a range.
struct ReferenceValue {
  std::string case_name;  ///< "I" to "IV"
  std::string transition; ///< "A" or "B"
  ReferenceQuantity quantity;
  double low;         ///< in `unit`
  double high;        ///< in `unit`
  int decimals;       ///< digits given after the point
  double tolerance;   ///< in `unit`; how far outside [low, high] a value may lie and still agree
  double scale;       ///< `unit` per SI unit: value in `unit` = scale * value in SI
  std::string unit;   ///< unit of low, high and tolerance; empty for a pure number
  std::string source; ///< where the value comes from
};

/// Restitution e of a single impact without gravity on a fixed ball.
struct ReferenceRestitution {
  std::string transition;
  double damping_ratio; ///< D (-)
  double restitution;   ///< e (-)
  double tolerance;     ///< (-)
  std::string source;
};

/// Every steady-state and meter value, in the order of the reference table.
const std::vector<ReferenceValue> &reference_values();

/// Every restitution given by number.
const std::vector<ReferenceRestitution> &reference_restitutions();

/// Ratio of the largest drum acceleration of case III to that of case II under B: about half (0.40).
struct ReferencePeakRatio {
  double ratio = 0.40;
  double tolerance = 0.005;
  std::string source = "paper, Case III (\"approximately half\"); reference, steady states";
};

/// Relative RMS error of drum velocity, cycles 25 to 30, condition B, of the integration scheme that the
/// reference recommends ("2 theta then 1") at a number of steps per cycle; nothing where the table has no
/// entry.
std::optional<double> reference_velocity_error(const std::string &case_name, int steps_per_cycle);

/// The same for the integration scheme of the stock engine; the table has case II only.
std::optional<double> reference_stock_velocity_error(const std::string &case_name, int steps_per_cycle);

/// Share of the impact velocity that a single impact without gravity returns, closed form. transition "A" or
/// "B"; damping_ratio D >= 0. A with D >= 1 gives 0: no rebound.
double closed_form_restitution(const std::string &transition, double damping_ratio);

} // namespace drumlin::post
