// Options that describe the chain: --case, --transition, --roller and the options that replace single values.
// All subcommands that need a chain read them here, with the same checks and messages.
#pragma once

#include "chain/parameters.h"
#include "commands/roller_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace drumlin::post {

/// The numbers of the chain; not given: the roller's or the case's.
struct ChainNumberArguments : Options {
  explicit ChainNumberArguments(Command &of);
  /// As in chain_numbers, and --frequency in place of --omega.
  std::array<Number, 10> all = {
      of_chain(0), of_chain(1),
      of_chain(2), number("--frequency", {1e-6, 1e8, "Hz"}, "the same in Hz, instead"),
      of_chain(3), of_chain(4),
      of_chain(5), of_chain(6),
      of_chain(7), of_chain(8)};

private:
  Number of_chain(std::size_t number_of_chain) const;
};

struct ChainArguments : Options {
  using Options::Options;
  static constexpr const char *group = "Instead of the case's values";
  Text chain_case = text("--case", "TEXT",
                         fmt::format("case of the paper's Table 1, with --roller of its soil alone: {}",
                                     fmt::join(table1_cases, ", ")),
                         "II");
  Text transition = text("--transition", "TEXT", "transition condition of the contact: A or B", "B");
  RollerArguments roller{command(), group}; ///< all values but k, D and g
  ChainNumberArguments numbers{command()};

  /// The option that was given for one of chain_numbers: of omega, --omega or --frequency; none if neither
  /// was.
  const Number *given(const std::string &name) const;
};

/// The chain that was asked for.
struct AskedChain {
  ChainParameters parameters;
  std::optional<double> me_re; ///< eccentric moment [kg m] from which Fw follows; none: Fw is given
  /// With the values that single options put in place of its own.
  std::optional<GivenRoller> roller;
};

/// What is wrong with the frequency [rad/s] of the excitation, said of the option that a user gave it with.
std::string frequency_refusal(const ChainArguments &arguments, double omega, const std::string &allowed);

/// The chain; UsageError if it cannot be computed. The force of a roller's exciter follows from the frequency
/// by its eccentric moment, unless --Fw is given.
AskedChain judged_chain(const ChainArguments &arguments);
/// The same as -var words for in.chain, each after a blank.
std::string deck_words(const ChainArguments &arguments);

} // namespace drumlin::post
