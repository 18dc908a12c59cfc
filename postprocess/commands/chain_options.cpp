#include "commands/chain_options.h"

#include "support/options.h"
#include "support/usage_error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <stdexcept>

namespace drumlin::post {

void add_chain_options(CLI::App &command, ChainArguments &arguments) {
  command.add_option("--case", arguments.chain_case, "case of the paper's Table 1: I, II, III or IV")
      ->capture_default_str();
  command.add_option("--transition", arguments.transition, "transition condition of the contact: A or B")
      ->capture_default_str();
  for (std::size_t i = 0; i < chain_numbers.size(); ++i)
    command
        .add_option_function<std::string>(
            fmt::format("--{}", chain_numbers[i].name),
            [&number = arguments.numbers[i]](const std::string &text) { number = text; },
            chain_numbers[i].help)
        ->type_name("NUMBER")
        ->group("Instead of the case's values");
}

ChainParameters judged(const ChainArguments &arguments) {
  ChainParameters parameters;
  try {
    parameters = table1_case(arguments.chain_case, transition_from_name(arguments.transition));
  } catch (const std::invalid_argument &error) {
    throw UsageError(fmt::format("--{}", error.what()));
  }
  for (std::size_t i = 0; i < chain_numbers.size(); ++i)
    if (arguments.numbers[i])
      parameters.*chain_numbers[i].value = number_option(fmt::format("--{}", chain_numbers[i].name).c_str(),
                                                         *arguments.numbers[i], chain_numbers[i].range);
  if (const std::string fault = parameters.invalid(); !fault.empty()) throw UsageError("--" + fault);
  return parameters;
}

std::string deck_words(const ChainArguments &arguments) {
  std::string words =
      fmt::format(" -var case {} -var transition {}", arguments.chain_case, arguments.transition);
  for (std::size_t i = 0; i < chain_numbers.size(); ++i)
    if (arguments.numbers[i])
      words += fmt::format(" -var {} {}", chain_numbers[i].name, *arguments.numbers[i]);
  return words;
}

} // namespace drumlin::post
