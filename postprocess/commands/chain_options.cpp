#include "commands/chain_options.h"

#include "support/csv.h"
#include "support/constants.h"
#include "support/usage_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

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
    throw UsageError(
        refusal("--k", parameters.k,
                fmt::format("stiffnesses in N/m, above {:.2g}, into which the roller sinks by {:g} "
                            "m; 60 MN/m is 60e6",
                            weight / deepest, deepest)));
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

} // namespace drumlin::post
