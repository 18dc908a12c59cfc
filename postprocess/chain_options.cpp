#include "chain_options.h"

#include "command.h"
#include "options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <stdexcept>

namespace drumlin::post {

namespace {

// A number of the chain that the command line may set instead of the case.
struct Override {
  const char *option;
  double ChainParameters::*value;
  const char *help;
};
constexpr std::array<Override, 9> overrides = {{
    {"--k", &ChainParameters::k, "contact stiffness [N/m]"},
    {"--D", &ChainParameters::D, "contact damping ratio [-], c = 2 D sqrt(m2 k)"},
    {"--omega", &ChainParameters::omega, "angular frequency of the excitation [rad/s]"},
    {"--Fw", &ChainParameters::Fw, "amplitude of the excitation force [N]"},
    {"--m2", &ChainParameters::m2, "mass of the drum [kg]"},
    {"--m3", &ChainParameters::m3, "mass of the frame [kg]"},
    {"--k23", &ChainParameters::k23, "stiffness of the bond drum - frame [N/m]"},
    {"--c23", &ChainParameters::c23, "damping of the bond drum - frame [N s/m]"},
    {"--g", &ChainParameters::g, "gravity [m/s2]"},
}};

} // namespace

void add_chain_options(CLI::App &command, ChainArguments &arguments) {
  command.add_option("--case", arguments.chain_case, "case of the paper's Table 1: I, II, III or IV")
      ->capture_default_str();
  command.add_option("--transition", arguments.transition, "transition condition of the contact: A or B")
      ->capture_default_str();
  for (std::size_t i = 0; i < overrides.size(); ++i)
    command.add_option(overrides[i].option, arguments.numbers[i], overrides[i].help)
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
  for (std::size_t i = 0; i < overrides.size(); ++i)
    if (!arguments.numbers[i].empty())
      parameters.*overrides[i].value = number_option(overrides[i].option, arguments.numbers[i]);
  if (const std::string fault = parameters.invalid(); !fault.empty()) throw UsageError("--" + fault);
  return parameters;
}

std::string deck_words(const ChainArguments &arguments) {
  std::string words =
      fmt::format(" -var case {} -var transition {}", arguments.chain_case, arguments.transition);
  for (std::size_t i = 0; i < overrides.size(); ++i)
    if (!arguments.numbers[i].empty())
      words +=
          fmt::format(" -var {} {}", overrides[i].option + 2, arguments.numbers[i]); // without the two dashes
  return words;
}

} // namespace drumlin::post
