// The tables of mistakes in tests/refused. `engine` has a file for each command or style of the plugin,
// `decks` one for each deck of inputs, `tools` one for each subcommand of drumlin.
//
//     # a comment
//     command fix guard:                  what the error begins with, until the next such line
//     @ fix guard all guard               what @ stands for in the rows below
//     @ every 0 | keyword every is '0' ... a whole number from 1   {two ranks}
//     deck bed/in.bed                     the rows below are variables of this deck, `NAME VALUE, NAME VALUE`
//
// A row has two sides, with " | " between them. On the left are lines of a deck, which are added to the host
// deck. On the right is the error line that the run must end with: parts of it in their order, with " ... "
// where other text may stand. It begins with the command named above, or with "ERROR: " if it names none. A
// long right side begins a line of its own, and goes on in further ones; these lines begin with four blanks.
// A line `pair_style` at the beginning of a row, with `property NAME VALUE` for all pairs and `material NAME
// VALUE` for all types below it, replaces the host's. \n is the end of a line within a value, INPUTS the
// folder of the decks, LONG a word of 5000 letters. Marks at the end:
//     {two ranks}       tried on two ranks, too
//     {in the run}      shows in the run, after the output files were opened
//     {engine's words}  the engine's own check comes first; its text does not say what is allowed
//     {bare}            the host's properties are not added to those of the row
// A file NAME.lammps is for the host deck of LAMMPS, which has no pair style.
//
// In `tools` the left side is a command line; '' is an empty word. The error line begins with the command and
// the right side, or has the right side anywhere behind the command if that begins with "... ". Lines between
// the rows make or remove files that the rows below them read:
//     file NAME TEXT                      writes this text; it may go on in lines that begin with four blanks
//     file NAME                           removes the file
//     made NAME chain                     makes the folder of a run of the chain; also impact, bed
// The exit status is 2; {status 1} where the command line is right, but what it names is not.
//
// With DRUMLIN_REWRITE=1 a row of `tools` whose error line is another gets that line.
#pragma once

#include "tests/support/prelude.h"

namespace drumlin::test {

/// A mistake, and what the engine must say.
struct Refusal {
  std::string place;                                          ///< file and line of the table
  std::string deck;                                           ///< of inputs; empty: the host deck
  std::vector<std::pair<std::string, std::string>> variables; ///< of a deck of inputs
  std::string pair;  ///< pair style and properties of the host deck; empty: its own
  std::string lines; ///< of the host deck; of a tool its command line
  std::vector<std::pair<std::string, std::string>> files; ///< of a tool: names and texts
  std::vector<std::pair<std::string, std::string>> made;  ///< of a tool: names and kinds of folders
  int status = 2;                                         ///< of a tool
  std::vector<std::string> says;
  bool on_two_ranks = false, in_the_run = false, in_engine_words = false, lammps = false;
};

/// The tables in folders of tests/refused by their names, such as engine/fix_guard.
std::vector<std::string> refusal_tables(const std::vector<std::string> &folders);
/// Such a name as the name of a test.
std::string name_of_table(const ::testing::TestParamInfo<std::string> &info);
bool is_of_lammps(const std::string &table);
/// Throws std::runtime_error with file and line for a line that is none of the above.
std::vector<Refusal> read_refusals(const std::string &table);

/// Whether an error line has the parts of a refusal, in their order.
::testing::AssertionResult says_so(const Refusal &refusal, const std::string &error);
/// Puts the message of an error line in the place of a row's own.
void rewrite(const Refusal &refusal, const std::string &error);

/// Every parameter of every law, left out and with values out of its range.
std::vector<Refusal> law_refusals();

} // namespace drumlin::test
