#include "calibration/task.h"

#include "support/csv.h"
#include "support/units.h"
#include "support/usage_error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>

namespace drumlin::post {

const std::array<SoilParameter, 5> soil_parameters = {
    {{"k", {1e5, 1e12, "N/m"}, "stiffness of all contacts [N/m]"},
     {"D", {1e-3, 1.0}, "damping ratio of all contacts [-]"},
     {"friction", {1e-2, 10.0}, "coefficient of friction [-]"},
     {"rolling", {1e-3, 10.0}, "coefficient of rolling friction [-]"},
     {"pour_friction",
      {1e-3, 10.0},
      "friction while the balls settle [-]: less of it makes a denser packing"}}};

const std::array<SoilQuantity, 9> soil_quantities = {
    {{"k", {1e3, 1e12, "N/m per m"}, SoilTest::roller, "stiffness that identify finds [N/m per m]"},
     {"D", {1e-4, 10.0}, SoilTest::roller, "damping ratio that identify finds [-]"},
     {"settlement", {1e-9, 1.0, "m"}, SoilTest::roller, "settlement per cycle [m]"},
     {"force", {1.0, 1e12, "N/m"}, SoilTest::roller, "peak contact force [N/m]"},
     {"acceleration", {1e-2, 1e6, "m/s2"}, SoilTest::roller, "peak acceleration of the drum [m/s2]"},
     {"contact", {1e-3, 1.0}, SoilTest::roller, "share of time in contact [-]"},
     {"E_v1", {1e3, 1e12, "Pa"}, SoilTest::plate, "strain modulus of the first loading of a plate [Pa]"},
     {"E_v2", {1e3, 1e12, "Pa"}, SoilTest::plate, "strain modulus of the second loading of a plate [Pa]"},
     {"friction_angle",
      {1.0, 89.0, "degrees"},
      SoilTest::biaxial,
      "peak friction angle in the plane [degrees]"}}};

namespace {

constexpr Range tolerance_range = {1e-4, 1.0};
constexpr double default_tolerance = 0.05;
constexpr const char *target_option = "--target";

/// Variables of in.place and in.bed that describe the roller and its excitation.
constexpr std::array roller_variables = {"m2", "m3", "r2", "r3", "k23", "c23", "omega", "Fw"};

template <class Named>
std::string names_of(const Named &named) {
  std::vector<std::string> names;
  names.reserve(named.size());
  for (const auto &one : named)
    names.emplace_back(one.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

template <class Named>
const typename Named::value_type *find_named(const Named &named, const std::string &name) {
  const auto found =
      std::find_if(named.begin(), named.end(), [&](const auto &one) { return name == one.name; });
  return found == named.end() ? nullptr : &*found;
}

/// The two texts around the first `mark`; nothing without one.
std::optional<std::pair<std::string, std::string>> parts(const std::string &text, char mark) {
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) return std::nullopt;
  return std::pair{text.substr(0, at), text.substr(at + 1)};
}

/// The number of a part of an option's text, which the message gives whole.
double number_in(const char *option, const std::string &whole, const std::string &part, const Range &range) {
  const std::optional<double> value = any_number_from_text(part);
  if (!value || !range.holds(*value))
    throw UsageError(refusal(option, whole, fmt::format("for '{}': {}", shown(part), range.words())));
  return *value;
}

/// Weight of drum and frame together, per metre of drum width [N/m].
double weight(const CalibrationTask &task) {
  const auto mass = [&task](const char *name, double of_gravel) {
    const std::optional<std::string> value = task.fixed_value(name);
    return value ? number_from_text(*value) : of_gravel;
  };
  constexpr double g = 9.81;
  return (mass("m2", gravel_drum) + mass("m3", gravel_frame)) * g;
}

void check_once(const char *option, const std::vector<std::string> &names) {
  std::set<std::string> seen;
  for (const std::string &name : names)
    if (!seen.insert(name).second) throw UsageError(refusal(option, name, "each name once"));
}

} // namespace

const SoilQuantity &soil_quantity(const std::string &name) { return *find_named(soil_quantities, name); }

CalibrationTarget target_from_text(const std::string &text) {
  const auto named = parts(text, '=');
  const SoilQuantity *quantity = named ? find_named(soil_quantities, named->first) : nullptr;
  if (quantity == nullptr)
    throw UsageError(refusal(
        target_option, text,
        fmt::format("NAME=VALUE or NAME=VALUE:TOLERANCE, NAME one of {}", names_of(soil_quantities))));
  const auto tolerance = parts(named->second, ':');
  CalibrationTarget target{named->first, 0.0, default_tolerance};
  target.value =
      number_in(target_option, text, tolerance ? tolerance->first : named->second, quantity->range);
  if (tolerance) target.tolerance = number_in(target_option, text, tolerance->second, tolerance_range);
  return target;
}

VariedParameter varied_from_text(const std::string &text) {
  constexpr const char *option = "--vary";
  constexpr double least_ratio = 1.05;
  const auto named = parts(text, '=');
  const SoilParameter *parameter = named ? find_named(soil_parameters, named->first) : nullptr;
  const auto bounds = named ? parts(named->second, ':') : std::nullopt;
  if (parameter == nullptr || !bounds)
    throw UsageError(
        refusal(option, text, fmt::format("NAME=LOW:HIGH, NAME one of {}", names_of(soil_parameters))));
  VariedParameter varied{named->first, number_in(option, text, bounds->first, parameter->range),
                         number_in(option, text, bounds->second, parameter->range)};
  if (varied.high < least_ratio * varied.low)
    throw UsageError(refusal(option, text, fmt::format("HIGH at least {} times LOW", least_ratio)));
  return varied;
}

std::pair<std::string, std::string> fixed_from_text(const std::string &text) {
  constexpr const char *option = "--set";
  const auto named = parts(text, '=');
  const SoilParameter *parameter = named ? find_named(soil_parameters, named->first) : nullptr;
  const bool in_hertz = named && named->first == "frequency";
  const bool of_roller =
      in_hertz || (named && std::count(roller_variables.begin(), roller_variables.end(), named->first) > 0);
  if (parameter == nullptr && !of_roller)
    throw UsageError(refusal(option, text,
                             fmt::format("NAME=VALUE, NAME one of {}, {}, frequency",
                                         names_of(soil_parameters), fmt::join(roller_variables, ", "))));
  constexpr Range any = {1e-9, 1e15};
  const double value = number_in(option, text, named->second, of_roller ? any : parameter->range);
  return in_hertz ? std::pair{std::string("omega"), number_text(2.0 * pi * value)} : *named;
}

std::optional<std::string> CalibrationTask::fixed_value(const std::string &name) const {
  for (const auto &[fixed_name, value] : fixed)
    if (fixed_name == name) return value;
  return std::nullopt;
}

bool CalibrationTask::varies(const std::string &name) const { return find_named(vary, name) != nullptr; }

void CalibrationTask::check() const {
  if (targets.empty()) throw UsageError(refusal("--target", "", "one or more targets"));
  if (vary.empty()) throw UsageError(refusal("--vary", "", "one or more parameters"));
  std::vector<std::string> wanted, varied, set;
  for (const CalibrationTarget &target : targets)
    wanted.push_back(target.name);
  for (const VariedParameter &parameter : vary)
    varied.push_back(parameter.name);
  for (const auto &[name, value] : fixed)
    set.push_back(name);
  check_once("--target", wanted);
  check_once("--vary", varied);
  check_once("--set", set);
  for (const std::string &name : set)
    if (varies(name)) throw UsageError(refusal("--set", name, "a variable that --vary does not name"));
  if (vary.size() > targets.size())
    throw UsageError(refusal(
        "--vary", fmt::format("{}", fmt::join(varied, ", ")),
        fmt::format("at most as many parameters as targets, {}: more cannot be identified", targets.size())));
  // The soil below the plate has been compacted by the first loading.
  const CalibrationTarget *first = find_named(targets, "E_v1"), *second = find_named(targets, "E_v2");
  if (first != nullptr && second != nullptr && second->value < first->value)
    throw UsageError(
        refusal("--target E_v2", second->value,
                fmt::format("no less than E_v1 = {:g} Pa, since a second loading is stiffer", first->value)));
  // Averaged over a cycle, the contact force on the drum equals the weight of the roller. It acts for the
  // share `contact` of the time and never exceeds the peak `force`. So peak times share cannot be less than
  // the weight.
  const CalibrationTarget *force = find_named(targets, "force"), *contact = find_named(targets, "contact");
  const double least = weight(*this) / (contact != nullptr ? contact->value : 1.0);
  if (force != nullptr && force->value > 0.0 && force->value < least) // 0: its value will be measured
    throw UsageError(
        refusal("--target force", force->value,
                fmt::format("at least {:g} N/m, the weight of the roller{}", least,
                            contact != nullptr ? " divided by the share of time in contact" : "")));
}

std::vector<std::pair<std::string, std::string>> settings_of(const CalibrationTask &task) {
  std::vector<std::pair<std::string, std::string>> rows;
  for (const VariedParameter &parameter : task.vary)
    rows.emplace_back("vary " + parameter.name,
                      number_text(parameter.low) + ":" + number_text(parameter.high));
  for (const CalibrationTarget &target : task.targets)
    rows.emplace_back("target " + target.name,
                      number_text(target.value) + ":" + number_text(target.tolerance));
  for (const auto &[name, value] : task.fixed)
    rows.emplace_back("set " + name, value);
  rows.emplace_back("seeds", std::to_string(task.seeds));
  rows.emplace_back("balls", std::to_string(task.balls));
  rows.emplace_back("cycles", std::to_string(task.cycles));
  return rows;
}

} // namespace drumlin::post
