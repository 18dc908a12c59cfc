// The subcommand "bed": soil balls at random in a box, as a data file for the decks in inputs/bed.
#pragma once

#include "support/usage_error.h"

namespace drumlin::post {

void add_bed_command(CLI::App &app, Session &session);

} // namespace drumlin::post
