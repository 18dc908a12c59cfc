// Options that describe the chain: --case, --transition, --roller and the options that replace single values.
// All subcommands that need a chain read them here, with the same checks and messages.
#pragma once

#include "chain/parameters.h"
#include "commands/roller_options.h"

#include <array>
#include <optional>
#include <string>
#include <utility>

namespace CLI {
class App;
}

namespace drumlin::post {

/// The options as given. Numbers stay text until judged() checks them.
struct ChainArguments {
  std::string chain_case = "II";
  std::string transition = "B";
  RollerArguments roller; ///< all values but k, D and g
  std::array<std::optional<std::string>, 9>
      numbers;                          ///< as in chain_numbers; none: the roller's or the case's
  std::optional<std::string> frequency; ///< in place of omega
};

/// The chain that was asked for.
struct AskedChain {
  ChainParameters parameters;
  std::optional<double> me_re; ///< eccentric moment [kg m] from which Fw follows; none: Fw is given
  /// With the values that single options put in place of its own.
  std::optional<GivenRoller> roller;
};

/// Adds --case, --transition, --roller, --k and so on; `arguments` must outlive the app.
void add_chain_options(CLI::App &command, ChainArguments &arguments);

/// The option that was given for one of chain_numbers, and its text: --omega or --frequency; none if neither
/// was.
std::optional<std::pair<std::string, std::string>> given_number(const ChainArguments &arguments,
                                                                const std::string &name);

/// What is wrong with the frequency [rad/s] of the excitation, said of the option that a user gave it with.
std::string frequency_refusal(const ChainArguments &arguments, double omega, const std::string &allowed);

/// The chain; UsageError if it cannot be computed. The force of a roller's exciter follows from the frequency
/// by its eccentric moment, unless --Fw is given.
AskedChain judged_chain(const ChainArguments &arguments);
/// The same as -var words for in.chain, each after a blank.
std::string deck_words(const ChainArguments &arguments);

} // namespace drumlin::post
