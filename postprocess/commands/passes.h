// `drumlin passes`: what each pass of a roller leaves.
#pragma once

#include "commands/roller_options.h"

#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// The options as given. Numbers stay text until all are judged.
struct PassesArguments {
  std::vector<std::string> folders;
  std::string cell = "0.34", meter = "CMV", coverage = "80";
  std::optional<std::string> spacing, out, target;
  RollerArguments roller;
  DrumArguments drum;
};

/// Writes the tables and the page of runs, and prints what they say. Throws UsageError for options and runs
/// that cannot be used.
void print_passes(const PassesArguments &arguments);

} // namespace drumlin::post
