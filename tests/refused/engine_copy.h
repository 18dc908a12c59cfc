// The stock LIGGGHTS with the plugin in a copy of the test's own process, which has read both libraries and
// begun MPI already: hundreds of decks that end in an error take as long as a few starts of the program.
#pragma once

#include "tests/support/prelude.h"
#include "engine/deck_run.h"

namespace drumlin::test {

/// Runs a deck in a folder on one rank. There are no -var, which the plugin reads from the command line.
post::Outcome run_in_copy(const std::filesystem::path &deck, const std::filesystem::path &folder);

} // namespace drumlin::test
