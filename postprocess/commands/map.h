// `drumlin map`: regimes of a roller from the command line.
#pragma once

#include "commands/chain_options.h"

#include <optional>
#include <string>

namespace drumlin::post {

/// The options as given.
struct MapArguments {
  ChainArguments chain;
  /// The axes that were given. Neither: a map over k and D. x alone: meter values over x, without a map.
  std::optional<std::string> x, y;
  std::optional<std::string> identify; ///< every so many-th point of one axis
  DrumArguments drum;                  ///< of one axis
  std::optional<std::string> sweep;
  std::optional<std::string> me_re;
  std::optional<std::string> contacts; ///< of a drum with two ends
  std::string cycles = "300";
  std::string threads = "2";
  std::string out = "results/map";
  bool fresh = false;
};

/// Writes the map or the sweep and prints what it holds. Throws UsageError for options that cannot be used.
void print_map(const MapArguments &arguments);

} // namespace drumlin::post
