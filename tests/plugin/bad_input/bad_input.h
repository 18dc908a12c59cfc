// The tables of bad input, and the error line that the engine must print for each.
#pragma once

#include "tests/support/engine_runs.h"

#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::test {

/// Whether plugin or engine prints the error line. The plugin's line names command, keyword, value and what
/// is allowed ("allowed:"); where the engine's own check comes first, only its text is printed (the pages of
/// plugin/doc say where).
enum class Text { ours, engine };

/// One mistake.
struct BadInput {
  std::string name;
  std::string lines;             ///< lines of the host deck; not used for a project deck
  std::vector<std::string> says; ///< all of them are in the one error line
  Variables variables = {};      ///< of a project deck
  bool two_ranks = false;        ///< is among those that are tried under 2 ranks, too
  Text text = Text::ours;
  bool runs = false;     ///< the mistake shows in the run, after the output files were opened
  std::string pair = {}; ///< pair style and properties instead of the host's
};

/// Mistakes of one kind. They share a test, one engine run after the other.
struct BadGroup {
  std::string name;
  std::string deck; ///< of inputs; empty: the host deck
  std::vector<BadInput> inputs;
  bool lammps = false; ///< the host deck is that of LAMMPS, which has no pair style of its own
};

inline BadInput line(const std::string &name, const std::string &lines,
                     const std::vector<std::string> &says) {
  return {name, lines, says};
}
/// Lines that are their own name.
inline BadInput line(const std::string &lines, const std::vector<std::string> &says) {
  return {lines, lines, says};
}

inline BadInput on_two_ranks(BadInput input) {
  input.two_ranks = true;
  return input;
}

inline BadInput in_the_run(BadInput input) {
  input.runs = true;
  return input;
}

inline BadInput in_engine_words(BadInput input) {
  input.text = Text::engine;
  return input;
}

inline BadGroup in_lammps(const std::string &name, std::vector<BadInput> inputs) {
  return {name, "", std::move(inputs), true};
}
/// A pair style for them.
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
