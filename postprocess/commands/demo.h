// `drumlin demo`: the paper's cases and a bed under both transitions, and the report on them.
#pragma once

#include "support/usage_error.h"

namespace drumlin::post {

/// Adds `demo [--cycles N] [--balls N]`, which makes results/demo and report in the working folder.
void add_demo_command(CLI::App &app, Session &session);

} // namespace drumlin::post
