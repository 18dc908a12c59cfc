// The tables of bad input, and the error line that the engine must print for each.
#pragma once

#include "tests/support/engine_runs.h"

#include <ostream>
#include <string>
#include <vector>

namespace drumlin::test {

/// How a mistake is tried; kinds are added.
enum Kind : unsigned {
  on_one_rank = 0,
  on_two_ranks = 1, ///< is among those that are tried under 2 ranks, too
  in_the_run = 2,   ///< shows in the run, after the output files were opened
  /// The engine's own check comes first, and its text is printed (the pages of plugin/doc say where). The
  /// plugin's line names command, keyword, value and what is allowed ("allowed:").
  in_engine_words = 4
};

/// One mistake.
struct BadInput {
  std::string name;
  std::string lines;             ///< lines of the host deck; not used for a project deck
  std::vector<std::string> says; ///< all of them are in the one error line, in this order
  unsigned kind = on_one_rank;
  Variables variables = {}; ///< of a project deck
  std::string pair = {};    ///< pair style and properties instead of the host's
};

/// Mistakes of one kind. They share a test, one engine run after the other.
struct BadGroup {
  std::string name;
  std::string deck; ///< of inputs; empty: the host deck
  std::vector<BadInput> inputs;
  bool lammps = false; ///< the host deck is that of LAMMPS, which has no pair style of its own
};

/// A mistake in a table: its name (empty: the lines), the lines of the deck, and what the error line says
/// behind the name of the command, in parts with " ... " between them.
struct Row {
  std::string name, lines, says;
  unsigned kind = on_one_rank;
};

/// A group whose error lines name one command. In lines and errors of its rows, @ stands for `beginning`.
struct Table {
  std::string name, command, beginning;
  bool lammps = false;

  BadGroup of(const std::vector<Row> &rows) const;
};

/// The parts of an error line in a row.
std::vector<std::string> parts_of(const std::string &says);

/// A pair style for LAMMPS.
inline const std::string lammps_pair_style = "pair_style gran/hooke/transition\npair_coeff * * 1e5 0.2\n";

/// How a test's listing shows a group.
inline void PrintTo(const BadGroup &group, std::ostream *out) { *out << group.inputs.size() << " inputs"; }

/// The contact laws and their walls, in lines of the host deck.
std::vector<BadGroup> bad_laws();
/// Fixes and commands in lines of the host deck, command by command.
std::vector<BadGroup> bad_lines();
/// Variables of the decks of inputs/chain and inputs/bed.
std::vector<BadGroup> bad_variables();

} // namespace drumlin::test
