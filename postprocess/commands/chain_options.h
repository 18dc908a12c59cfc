// Options that describe the chain: --case, --transition and the options that replace values of the case. All
// subcommands that need a chain read them here, with the same checks and messages.
#pragma once

#include "chain/parameters.h"

#include <array>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace drumlin::post {

/// The options as given. Numbers stay text until judged() checks them.
struct ChainArguments {
  std::string chain_case = "II";
  std::string transition = "B";
  std::array<std::optional<std::string>, 9> numbers; ///< as in chain_numbers; none: the case's
};

/// Adds --case, --transition, --k and so on; `arguments` must outlive the app.
void add_chain_options(CLI::App &command, ChainArguments &arguments);

/// The chain that was asked for; UsageError if it cannot be computed. The force of a roller's exciter follows
/// from the frequency by its eccentric moment, unless --Fw is given.
NamedChain judged_chain(const ChainArguments &arguments);
/// Its parameters alone.
ChainParameters judged(const ChainArguments &arguments);

/// The same as -var words for in.chain, each after a blank.
std::string deck_words(const ChainArguments &arguments);

} // namespace drumlin::post
