// `drumlin exact`: the direct solver from the command line.
#pragma once

#include "support/usage_error.h"

namespace drumlin::post {

/// Adds `exact`, which solves a case of the chain and writes chain.csv, events.csv, cycles.csv and
/// parameters.csv into the folder --out, all or none.
void add_exact_command(CLI::App &app, Session &session);

} // namespace drumlin::post
