#include "commands/roller_options.h"

#include "engine/places.h"
#include "support/csv.h"
#include "support/constants.h"
#include "support/text.h"
#include "support/usage_error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

std::vector<DerivedValue> values_of(const GivenRoller &roller, double g) {
  return derived_values(roller.machine, &roller.setting, 2.0 * pi * roller.setting.frequency, g);
}

/// "279.98 kN" of 279984 N.
std::string shown_value(const DerivedValue &value) {
  const std::string &unit = value.unit;
  if (unit == "N" || unit == "N/m") return fmt::format("{:.5g} k{}", 1e-3 * value.value, unit);
  if (unit == "m") return fmt::format("{:.4g} mm", 1e3 * value.value);
  return fmt::format("{:.6g}{}", value.value, unit == "-" ? "" : " " + unit);
}

} // namespace

std::vector<std::pair<std::string, std::string>> GivenRoller::rows(double g) const {
  std::vector<std::pair<std::string, std::string>> rows = {{"roller", file}, {"setting", setting.name}};
  for (const DerivedValue &value : values_of(*this, g))
    rows.emplace_back("roller_" + value.name, number_text(value.value));
  rows.emplace_back("roller_bond_assumed", machine.bond_assumed ? "yes" : "no");
  return rows;
}

std::vector<std::string> GivenRoller::lines(double g) const {
  std::vector<std::string> lines = {fmt::format("roller {}{}: drum {:g} kg, frame {:g} kg", file,
                                                setting.name.empty() ? "" : ", setting " + setting.name,
                                                machine.m2, machine.m3)};
  for (const DerivedValue &value : values_of(*this, g)) {
    std::string words = value.name;
    std::replace(words.begin(), words.end(), '_', ' ');
    lines.push_back(fmt::format("  {:<24}{}", words, shown_value(value)));
  }
  if (machine.bond_assumed)
    lines.emplace_back("  The bond of drum and frame is assumed: the file has neither bond_stiffness nor "
                       "frame_frequency.");
  return lines;
}

std::optional<GivenRoller> judged(const RollerArguments &arguments) {
  if (!arguments.file) {
    if (arguments.setting) throw arguments.setting.refused("only with --roller");
    return std::nullopt;
  }
  try {
    const std::string file = path_option("--roller", *arguments.file).string();
    GivenRoller given = {file, read_roller(file), {}};
    given.setting = setting_of(given.machine, arguments.setting.text(), file);
    if (arguments.is_first)
      for (const std::string &warning : given.machine.warnings)
        fmt::print(stderr, "WARNING: {}\n", warning);
    return given;
  } catch (const std::invalid_argument &error) {
    const std::string said = error.what();
    const bool of_option = said.rfind("roller is ", 0) == 0 || said.rfind("setting is ", 0) == 0;
    throw UsageError(of_option ? "--" + said : said);
  }
}

std::vector<GivenPath> files_of(const RollerArguments &arguments) {
  if (!arguments.file) return {};
  return {{"--roller", path_option("--roller", *arguments.file)}};
}

std::string deck_words(const RollerArguments &arguments) {
  std::string words;
  if (arguments.file) words += " -var roller " + shell_word(*arguments.file);
  if (arguments.setting) words += " -var setting " + shell_word(*arguments.setting);
  return words;
}

std::optional<LineContact> judged(const DrumArguments &arguments, const std::optional<GivenRoller> &roller) {
  std::optional<double> radius, width;
  if (roller) {
    width = roller->machine.width;
    if (const auto diameter = roller->machine.diameter) radius = 0.5 * *diameter;
  }
  if (arguments.radius) radius = *arguments.radius;
  if (arguments.width) width = *arguments.width;
  const bool both = radius && width;
  if ((arguments.radius || arguments.width) && !both)
    throw UsageError(refusal(radius ? "--drum-width" : "--drum-radius", "",
                             "a number [m], for E_vib needs radius and width of the drum"));
  if (arguments.poisson && !both)
    throw arguments.poisson.refused("only with --drum-radius and --drum-width, or a roller that has both");
  if (!both) return std::nullopt;
  return LineContact{*radius, *width, arguments.poisson.value_or(usual_poisson)};
}

ChainParameters given_case(const std::string &name, Transition transition) {
  if (std::find(table1_cases.begin(), table1_cases.end(), name) != table1_cases.end())
    return table1_case(name, transition);
  std::string allowed = fmt::format("{}", fmt::join(table1_cases, ", "));
  const std::size_t dash = name.find('-');
  const std::string machine = name.substr(0, dash);
  std::error_code ignored; // of a name that is too long
  if (machine.find('/') == std::string::npos &&
      fs::is_regular_file(places().inputs / "rollers" / machine, ignored))
    allowed +=
        fmt::format("; a roller is a file: --roller {}{}", (inputs_here() / "rollers" / machine).string(),
                    dash == std::string::npos ? "" : " --setting " + name.substr(dash + 1));
  throw UsageError(refusal("--case", name, allowed));
}

} // namespace drumlin::post
