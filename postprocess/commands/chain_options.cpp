#include "commands/chain_options.h"

#include "commands/text_options.h"
#include "support/options.h"
#include "support/usage_error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

namespace drumlin::post {

void add_chain_options(CLI::App &command, ChainArguments &arguments) {
  command
      .add_option("--case", arguments.chain_case,
                  fmt::format("case of the paper's Table 1, or a roller of a manufacturer: {}",
                              fmt::join(chain_cases, ", ")))
      ->capture_default_str();
  command.add_option("--transition", arguments.transition, "transition condition of the contact: A or B")
      ->capture_default_str();
  for (std::size_t i = 0; i < chain_numbers.size(); ++i)
    text_option(&command, fmt::format("--{}", chain_numbers[i].name), "NUMBER", arguments.numbers[i],
                chain_numbers[i].help)
        ->group("Instead of the case's values");
}

NamedChain judged_chain(const ChainArguments &arguments) {
  NamedChain chain;
  try {
    chain = named_chain(arguments.chain_case, transition_from_name(arguments.transition));
  } catch (const std::invalid_argument &error) {
    throw UsageError(fmt::format("--{}", error.what()));
  }
  ChainParameters &parameters = chain.parameters;
  for (std::size_t i = 0; i < chain_numbers.size(); ++i) {
    const auto &[name, value, range, help] = chain_numbers[i];
    if (!arguments.numbers[i]) continue;
    parameters.*value = number_option(fmt::format("--{}", name).c_str(), *arguments.numbers[i], range);
    if (value == &ChainParameters::Fw) chain.me_re.reset();
  }
  if (chain.me_re) parameters.Fw = *chain.me_re * parameters.omega * parameters.omega;
  if (const std::string fault = parameters.invalid(); !fault.empty()) throw UsageError("--" + fault);
  return chain;
}

ChainParameters judged(const ChainArguments &arguments) { return judged_chain(arguments).parameters; }

std::string deck_words(const ChainArguments &arguments) {
  std::string words =
      fmt::format(" -var case {} -var transition {}", arguments.chain_case, arguments.transition);
  for (std::size_t i = 0; i < chain_numbers.size(); ++i)
    if (arguments.numbers[i])
      words += fmt::format(" -var {} {}", chain_numbers[i].name, *arguments.numbers[i]);
  return words;
}

} // namespace drumlin::post
