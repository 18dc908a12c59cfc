#include "commands/chain_options.h"

#include "engine/places.h"
#include "support/csv.h"
#include "support/text.h"
#include "support/units.h"
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

namespace {

const Range &range_of(double ChainParameters::*value) {
  return std::find_if(chain_numbers.begin(), chain_numbers.end(),
                      [&](const ChainNumber &one) { return one.value == value; })
      ->range;
}

} // namespace

ChainNumberArguments::ChainNumberArguments(Command &of) : Options(of, ChainArguments::group) {
  not_with(all[2], {&all[3]}, "without --omega, which says the same");
}

Number ChainNumberArguments::of_chain(std::size_t number_of_chain) const {
  const ChainNumber &one = chain_numbers.at(number_of_chain);
  return number(fmt::format("--{}", one.name), one.range, one.help);
}

const Number *ChainArguments::given(const std::string &name) const {
  for (const Number &number : numbers.all)
    if (number.given() &&
        (number.name() == "--" + name || (name == "omega" && number.name() == "--frequency")))
      return &number;
  return nullptr;
}

std::string frequency_refusal(const ChainArguments &arguments, double omega, const std::string &allowed) {
  const Number *const given = arguments.given("omega");
  const bool in_hertz = given != nullptr ? given->name() == "--frequency" : arguments.roller.file.given();
  return refusal(in_hertz ? "--frequency" : "--omega", in_hertz ? omega / (2.0 * pi) : omega, allowed);
}

AskedChain judged_chain(const ChainArguments &arguments) {
  AskedChain chain;
  ChainParameters &parameters = chain.parameters;
  try {
    parameters = given_case(*arguments.chain_case, transition_from_name(*arguments.transition));
  } catch (const std::invalid_argument &error) {
    throw UsageError(fmt::format("--{}", error.what()));
  }
  chain.roller = judged(arguments.roller);
  if (chain.roller) {
    set_machine(parameters, chain.roller->machine, chain.roller->setting);
    for (const auto &[name, value, range, help] : chain_numbers)
      if (!range.holds(parameters.*value))
        throw UsageError(refusal("--roller", chain.roller->file,
                                 fmt::format("a file by which {} is {}", name, range.words())));
    chain.me_re = chain.roller->setting.me_re;
  }
  for (const ChainNumber &number : chain_numbers)
    if (const Number *const given = arguments.given(number.name))
      parameters.*number.value = given->name() == "--frequency" ? 2.0 * pi * **given : **given;
  if (arguments.given("Fw") != nullptr) chain.me_re.reset();
  if (chain.me_re) {
    parameters.Fw = *chain.me_re * parameters.omega * parameters.omega;
    if (const Range &range = range_of(&ChainParameters::Fw); !range.holds(parameters.Fw))
      throw UsageError(
          frequency_refusal(arguments, parameters.omega,
                            fmt::format("a frequency with which m_e r_e omega^2 is {}", range.words())));
  }
  if (const std::string fault = parameters.invalid(); !fault.empty()) throw UsageError("--" + fault);
  constexpr double deepest = 10.0; // m, beyond what any soil would bear: k was meant in MN/m
  const double weight = (parameters.m2 + parameters.m3) * parameters.g;
  if (arguments.given("k") != nullptr && weight > deepest * parameters.k)
    throw UsageError(refusal(
        "--k", parameters.k,
        fmt::format("above {:.2g} N/m, into which the roller sinks by {:g} m", weight / deepest, deepest)));
  if (chain.roller) {
    Roller &machine = chain.roller->machine;
    machine.m2 = parameters.m2;
    machine.m3 = parameters.m3;
    machine.k23 = parameters.k23;
    machine.c23 = parameters.c23;
    if (arguments.given("k23") != nullptr) machine.bond_assumed = false;
    RollerSetting &setting = chain.roller->setting;
    if (arguments.given("omega") != nullptr) setting.frequency = parameters.omega / (2.0 * pi);
    if (!chain.me_re) setting.me_re = parameters.Fw / (parameters.omega * parameters.omega);
  }
  return chain;
}

std::string deck_words(const ChainArguments &arguments) {
  std::string words = fmt::format(" -var case {} -var transition {}{}", *arguments.chain_case,
                                  *arguments.transition, deck_words(arguments.roller));
  for (const ChainNumber &number : chain_numbers)
    if (const Number *const given = arguments.given(number.name))
      words += fmt::format(" -var {} {}", number.name,
                           given->name() == "--frequency" ? number_text(2.0 * pi * **given) : given->text());
  return words;
}

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
