// What a calibration looks for: the parameters of a bed's contacts that vary, and the targets that they are
// to meet.
#pragma once

#include "support/units.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// A parameter of the soil: a variable of the decks in inputs/bed.
struct SoilParameter {
  const char *name;
  Range range;
  const char *meaning; ///< with unit
};
/// k, D, friction, rolling, pour_friction: above zero, since a search takes their logarithms.
extern const std::array<SoilParameter, 5> soil_parameters;

/// The test that measures a target.
enum class SoilTest {
  roller, ///< inputs/bed/in.bed
  plate,  ///< inputs/soil/in.plate
  biaxial ///< inputs/soil/in.biaxial
};

/// A measured quantity for which a target value can be given. Its values are above zero.
struct SoilQuantity {
  const char *name;
  Range range;
  SoilTest test;
  const char *meaning; ///< with unit
};
/// k, D, settlement, force, acceleration, contact; E_v1, E_v2; friction_angle.
extern const std::array<SoilQuantity, 9> soil_quantities;

/// A parameter that varies, 0 < low < high.
struct VariedParameter {
  std::string name;
  double low, high;
};

/// A quantity, its wanted value, above zero, and the relative difference that counts as one in the objective.
struct CalibrationTarget {
  std::string name;
  double value;
  double tolerance;
};

/// The masses m2 of the drum and m3 of the frame that inputs/bed/case.gravel has, per metre of drum width
/// [kg/m].
constexpr double gravel_drum = 2000.0, gravel_frame = 1000.0;

/// A calibration: what varies, what is wanted, and on which beds it is measured.
struct CalibrationTask {
  std::vector<VariedParameter> vary;
  std::vector<CalibrationTarget> targets;
  std::vector<std::pair<std::string, std::string>> fixed; ///< variables of the decks, the same at all points
  int seeds = 5;                                          ///< beds at each point: seeds 1 to `seeds`
  int balls = 1000;                                       ///< of a bed
  int cycles = 6;                                         ///< of the excitation
  /// Number of beds of which the targets are means, 0 for exact numbers: their scatter widens the intervals.
  int target_beds = 0;

  bool varies(const std::string &name) const;
  /// The text of a fixed variable; nothing if it has the deck's value.
  std::optional<std::string> fixed_value(const std::string &name) const;
  /// Throws UsageError unless there are parameters and targets, each once, no more parameters than targets,
  /// no parameter that is also fixed, and no targets that contradict each other.
  void check() const;
};

/// From "NAME=VALUE" or "NAME=VALUE:TOLERANCE"; the tolerance is 0.05 if it is not given. Throws UsageError
/// for the option --target.
CalibrationTarget target_from_text(const std::string &text);
/// From "NAME=LOW:HIGH". Throws UsageError for the option --vary.
VariedParameter varied_from_text(const std::string &text);
/// From "NAME=VALUE", NAME a parameter of the soil, a variable of the roller, or frequency [Hz], which
/// becomes omega; VALUE a number. Throws UsageError for the option --set.
std::pair<std::string, std::string> fixed_from_text(const std::string &text);

/// The quantity of that name. \pre there is one
const SoilQuantity &soil_quantity(const std::string &name);

/// The settings on which the results of a point depend, as rows of name and value.
std::vector<std::pair<std::string, std::string>> settings_of(const CalibrationTask &task);

} // namespace drumlin::post
