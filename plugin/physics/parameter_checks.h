#pragma once
/// Checks of parameters, with one form of error text for all parameter structs of this folder.

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

namespace drumlin::physics {

/// Which finite numbers a deck may give.
struct Range {
  double least;
  bool least_excluded = false;
  double most = std::numeric_limits<double>::infinity();

  static const Range any, positive, non_negative;

  [[nodiscard]] bool contains(double value) const {
    return std::isfinite(value) && value >= least && (value > least || !least_excluded) && value <= most;
  }
};
inline constexpr Range Range::any{-std::numeric_limits<double>::infinity()};
inline constexpr Range Range::positive{0.0, true};
inline constexpr Range Range::non_negative{0.0};

namespace detail {

/// What a parameter may be. Every kind refuses NaN; only `positive_or_infinite` accepts infinity.
enum class Allowed { finite, not_negative, positive, positive_or_infinite };

/// A number as a user would write it: the shortest text that reads back as the same double, whatever the
/// locale.
inline std::string number_text(double value) {
  if (std::isnan(value)) return "nan"; // without the sign bit that NaN may carry
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

/// Empty if `value` is allowed, else for example "stiffness is '-5 N/m'; allowed: finite and > 0".
/// \param unit of the value; empty for a number without dimension
inline std::string violation(const std::string &name, double value, const std::string &unit,
                             Allowed allowed) {
  bool good = false;
  const char *range = "";
  switch (allowed) {
  case Allowed::finite:
    good = std::isfinite(value);
    range = "finite";
    break;
  case Allowed::not_negative:
    good = std::isfinite(value) && value >= 0.0;
    range = "finite and >= 0";
    break;
  case Allowed::positive:
    good = std::isfinite(value) && value > 0.0;
    range = "finite and > 0";
    break;
  case Allowed::positive_or_infinite:
    good = value > 0.0;
    range = "> 0, may be infinite";
    break;
  }
  if (good) return {};
  return name + " is '" + number_text(value) + (unit.empty() ? "" : " ") + unit + "'; allowed: " + range;
}

/// A range in words, for an error: "a finite number > 0 and <= 1".
inline std::string text_of(const Range &range) {
  std::string text = "a finite number";
  if (std::isfinite(range.least)) text += (range.least_excluded ? " > " : " >= ") + number_text(range.least);
  if (std::isfinite(range.most)) text += " and <= " + number_text(range.most);
  return text;
}

} // namespace detail
} // namespace drumlin::physics
