// `drumlin run`: a deck in a stock engine with the plugin.
#pragma once

#include "support/usage_error.h"

namespace drumlin::post {

/// Adds `run [-np N] DECK [engine arguments]`, which prints the plain command and becomes it.
void add_run_command(CLI::App &app, Session &session);

} // namespace drumlin::post
