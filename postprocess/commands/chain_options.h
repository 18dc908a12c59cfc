// The chain on a command line: --case, --transition and what replaces the case's values. One rule and one kind of message
// for all subcommands that take a chain.
#pragma once

#include "chain/parameters.h"

#include <array>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace drumlin::post {

/// The options as given. Numbers stay text until all are judged.
struct ChainArguments {
  std::string chain_case = "II";
  std::string transition = "B";
  std::array<std::optional<std::string>, 9> numbers; ///< as in chain_numbers; none: the case's
};

/// Adds --case, --transition, --k and so on; `arguments` must outlive the app.
void add_chain_options(CLI::App &command, ChainArguments &arguments);

/// The chain that was asked for; UsageError if it cannot be computed.
ChainParameters judged(const ChainArguments &arguments);

/// The same as -var words for in.chain, each after a blank.
std::string deck_words(const ChainArguments &arguments);

} // namespace drumlin::post
