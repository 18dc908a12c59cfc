#include "commands/chain_options.h"

#include "commands/text_options.h"
#include "support/csv.h"
#include "support/options.h"
#include "support/constants.h"
#include "support/usage_error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

namespace drumlin::post {

namespace {

constexpr const char *group = "Instead of the case's values";

/// Of a name that is none of chain_numbers, as me_re of an axis, nothing is given.
std::optional<std::string> text_of(const ChainArguments &arguments, const std::string &name) {
  const auto *const number = std::find_if(chain_numbers.begin(), chain_numbers.end(),
                                          [&](const ChainNumber &one) { return name == one.name; });
  if (number == chain_numbers.end()) return std::nullopt;
  return arguments.numbers.at(static_cast<std::size_t>(number - chain_numbers.begin()));
}

const Range &range_of(double ChainParameters::*value) {
  return std::find_if(chain_numbers.begin(), chain_numbers.end(),
                      [&](const ChainNumber &one) { return one.value == value; })
      ->range;
}

} // namespace

void add_chain_options(CLI::App &command, ChainArguments &arguments) {
  command
      .add_option("--case", arguments.chain_case,
                  fmt::format("case of the paper's Table 1, with --roller of its soil alone: {}",
                              fmt::join(table1_cases, ", ")))
      ->capture_default_str();
  command.add_option("--transition", arguments.transition, "transition condition of the contact: A or B")
      ->capture_default_str();
  add_roller_options(command, arguments.roller, group);
  for (std::size_t i = 0; i < chain_numbers.size(); ++i) {
    text_option(&command, fmt::format("--{}", chain_numbers[i].name), "NUMBER", arguments.numbers[i],
                chain_numbers[i].help)
        ->group(group);
    if (chain_numbers[i].value == &ChainParameters::omega)
      text_option(&command, "--frequency", "NUMBER", arguments.frequency, "the same in Hz, instead")
          ->group(group);
  }
}

std::optional<std::pair<std::string, std::string>> given_number(const ChainArguments &arguments,
                                                                const std::string &name) {
  if (const std::optional<std::string> text = text_of(arguments, name)) return std::pair{"--" + name, *text};
  if (name == "omega" && arguments.frequency) return std::pair{"--frequency", *arguments.frequency};
  return std::nullopt;
}

std::string frequency_refusal(const ChainArguments &arguments, double omega, const std::string &allowed) {
  const bool in_hertz = !text_of(arguments, "omega") && (arguments.frequency || arguments.roller.file);
  return refusal(in_hertz ? "--frequency" : "--omega", in_hertz ? omega / (2.0 * pi) : omega, allowed);
}

AskedChain judged_chain(const ChainArguments &arguments) {
  AskedChain chain;
  ChainParameters &parameters = chain.parameters;
  try {
    parameters = given_case(arguments.chain_case, transition_from_name(arguments.transition));
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
  for (std::size_t i = 0; i < chain_numbers.size(); ++i) {
    const auto &[name, value, range, help] = chain_numbers[i];
    if (!arguments.numbers[i]) continue;
    parameters.*value = number_option(fmt::format("--{}", name).c_str(), *arguments.numbers[i], range);
    if (value == &ChainParameters::Fw) chain.me_re.reset();
  }
  if (arguments.frequency) {
    if (text_of(arguments, "omega"))
      throw UsageError(refusal("--frequency", *arguments.frequency, "without --omega, which says the same"));
    parameters.omega = 2.0 * pi * number_option("--frequency", *arguments.frequency, {1e-6, 1e8, "Hz"});
  }
  if (chain.me_re) {
    parameters.Fw = *chain.me_re * parameters.omega * parameters.omega;
    if (const Range &range = range_of(&ChainParameters::Fw); !range.holds(parameters.Fw))
      throw UsageError(
          frequency_refusal(arguments, parameters.omega,
                            fmt::format("a frequency with which m_e r_e omega^2 is {}", range.words())));
  }
  if (const std::string fault = parameters.invalid(); !fault.empty()) throw UsageError("--" + fault);
  if (chain.roller) {
    Roller &machine = chain.roller->machine;
    machine.m2 = parameters.m2;
    machine.m3 = parameters.m3;
    machine.k23 = parameters.k23;
    machine.c23 = parameters.c23;
    if (given_number(arguments, "k23")) machine.bond_assumed = false;
    RollerSetting &setting = chain.roller->setting;
    if (given_number(arguments, "omega")) setting.frequency = parameters.omega / (2.0 * pi);
    if (!chain.me_re) setting.me_re = parameters.Fw / (parameters.omega * parameters.omega);
  }
  return chain;
}

std::string deck_words(const ChainArguments &arguments) {
  std::string words = fmt::format(" -var case {} -var transition {}{}", arguments.chain_case,
                                  arguments.transition, deck_words(arguments.roller));
  for (std::size_t i = 0; i < chain_numbers.size(); ++i)
    if (arguments.numbers[i])
      words += fmt::format(" -var {} {}", chain_numbers[i].name, *arguments.numbers[i]);
  if (arguments.frequency)
    words += fmt::format(" -var omega {}", number_text(2.0 * pi * number_from_text(*arguments.frequency)));
  return words;
}

} // namespace drumlin::post
