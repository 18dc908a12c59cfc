// Allowed ranges of numbers, and the one form of the message that refuses a value.
#pragma once

#include <string>
#include <string_view>

namespace drumlin::post {

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

} // namespace drumlin::post
