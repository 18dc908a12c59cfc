// `drumlin map`: regimes of a roller from the command line.
#pragma once

#include "commands/chain_options.h"

#include <optional>
#include <string>

namespace drumlin::post {

/// The options as given.
struct MapArguments {
  ChainArguments chain;
  std::string x = "k:1e6:200e6:60:log";
  std::string y = "D:0.02:1:50";
  std::optional<std::string> sweep;
  std::optional<std::string> me_re;
  std::string cycles = "300";
  std::string threads = "2";
  std::string out = "results/map";
  bool fresh = false;
  bool axes_given = false;
};

/// Writes the map or the sweep and prints what it holds. Throws UsageError for options that cannot be used.
void print_map(const MapArguments &arguments);

} // namespace drumlin::post
