// The host deck of these tests, and what every run of it has in common.
#pragma once

#include "tests/support/engine_runs.h"
#include "tests/support/lines.h"

#include <string>
#include <vector>

namespace drumlin::test {

/// The pair style and pair_coeff of the host deck.
std::string host_pair_style();
/// A property for all pairs of the host's three types.
std::string property(const std::string &name, const std::string &value);
/// All properties that the contact law may ask for, but those that `text` gives itself.
std::string host_properties(const std::string &text = "");

/// Lines of the host deck of LIGGGHTS in which, between two runs, ball 4 gets the ID 1. \param lines before
/// the first run
std::string with_other_ids(const std::string &lines = "");

/// Runs a deck with the plugin, output in a file; `words` follow the deck on the command line. Standard
/// limit: 60 s.
Outcome run_engine(const std::filesystem::path &deck, const std::vector<std::string> &words,
                   const std::filesystem::path &folder, int ranks);

/// Runs the host deck with a pair style (and properties) and the lines under test.
Outcome run_host(const std::string &pair, const std::string &lines, const std::filesystem::path &folder,
                 int ranks);

/// Runs the host deck of LAMMPS, which has no pair style, with the lines under test.
Outcome run_lammps_host(const std::string &lines, const std::filesystem::path &folder, int ranks);

/// Environment with which MPI runs as root, with more ranks than cores, and several runs at once; its own
/// files go to `folder`.
std::vector<std::string> mpi_environment(const std::filesystem::path &folder);

void write_text(const std::filesystem::path &file, const std::string &text);

} // namespace drumlin::test
