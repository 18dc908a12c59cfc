// Units of measured columns, as loggers and laboratories write them; what numbers may be; constants.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace drumlin::post {

/// What a unit measures.
enum class UnitKind { time, length, velocity, acceleration, force, share, other };

/// A unit, with the factor from it to SI (a share is a number from 0 to 1).
struct Unit {
  const char *name;
  UnitKind quantity;
  double factor;
};

/// The unit that a text names, whatever its case: "m/s2", "m/s^2", "m/s²" and "m s-2" are one unit, "µm" and
/// "um" another. Nothing for a text that is no known unit.
std::optional<Unit> unit_from_text(std::string_view text);

/// The names of all units of a quantity, "m, cm, mm, um".
std::string unit_names(UnitKind quantity);

/// The numbers that an option or a parameter may be, from `least` to `most`.
struct Range {
  double least;
  double most;
  const char *unit = ""; ///< without brackets, empty for a count or a ratio
  bool zero_too = false; ///< 0 is allowed, too
  bool above = false;    ///< `least` itself is not allowed
  bool below = false;    ///< `most` itself is not allowed

  /// Whether the value is allowed; false for NaN.
  bool holds(double value) const;
  /// What is allowed, e.g. "0, or a number from 1e-06 to 1e+15 [N/m]".
  std::string words() const;
};

/// A text of the user as a message shows it: cut where it is long, control characters as '?'.
std::string shown(std::string_view text);

/// "NAME is 'VALUE'; allowed: WHAT", the one form of a refusal, the value as shown() gives it.
std::string refusal(std::string_view name, std::string_view value, std::string_view allowed);
/// The same with a number.
std::string refusal(std::string_view name, double value, std::string_view allowed);

constexpr double pi = 3.14159265358979323846;
constexpr double degree = pi / 180.0; ///< [rad]
constexpr double degrees_per_radian = 180.0 / pi;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

} // namespace drumlin::post
