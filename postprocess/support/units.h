// Units of measured columns, as loggers and laboratories write them.
#pragma once

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

} // namespace drumlin::post
