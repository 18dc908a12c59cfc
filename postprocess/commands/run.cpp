#include "commands/commands.h"

#include "engine/deck_variables.h"
#include "engine/engine_command.h"
#include "engine/places.h"
#include "support/options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace {

constexpr int most_ranks = 1'000'000;

std::string usage() { return fmt::format("{} run [-np N] DECK [engine arguments]", front_command()); }

/// Refuses a log in the place of the deck or of a file that a variable names.
void keep_inputs(const std::filesystem::path &deck, const std::vector<std::string> &words) {
  std::vector<GivenPath> inputs = {{"DECK", deck}}, logs;
  bool values = false; // words behind -var
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string &word = words[i];
    if (!word.empty() && word.front() == '-')
      values = word == "-var" || word == "-v";
    else if (values && std::filesystem::is_regular_file(word))
      inputs.push_back({"-var", word});
    const bool log = word == "-log" || word == "-l" || word == "-screen" || word == "-sc";
    if (log && i + 1 < words.size() && words[i + 1] != "none") logs.push_back({word, words[i + 1]});
  }
  keep_apart(inputs, logs);
}

void run(const std::vector<std::string> &words) {
  int ranks = 1;
  std::size_t next = 0;
  // CLI11 has no options of one dash and two letters, so that the words in front of the deck are read here.
  for (; next < words.size() && words[next] == "-np"; next += 2)
    ranks = count_option("-np", next + 1 < words.size() ? words[next + 1] : "", 1, most_ranks);
  if (next >= words.size()) throw UsageError("the deck is missing; allowed: " + usage());
  const std::string &deck = words[next];
  const std::vector<std::string> rest(words.begin() + static_cast<std::ptrdiff_t>(next) + 1, words.end());
  const std::filesystem::path file = find_deck(deck);
  if (const auto help = std::find_if(
          rest.begin(), rest.end(), [](const std::string &word) { return word == "--help" || word == "-h"; });
      help != rest.end()) {
    std::map<std::string, std::string> given;
    for (std::size_t i = 0; i + 2 < rest.size(); ++i)
      if (rest[i] == "-var" || rest[i] == "-v") given.emplace(rest[i + 1], rest[i + 2]);
    const std::vector<DeckVariable> variables = deck_variables(file, given);
    if (variables.empty())
      throw UsageError(
          fmt::format("DECK is '{}'; allowed with --help: a deck with lines drumlin/variable", deck));
    fmt::print("Variables of {}, by -var NAME VALUE, with defaults:\n{}", deck,
               variables_text(variables, 100));
    return;
  }
  keep_inputs(file, rest);
  EngineCommand command = engine_command(file, plain_words(rest), ranks);
  if (engine_of(deck) == Engine::lammps)
    if (const std::string fault = lammps_package_fault(); !fault.empty()) throw UsageError(fault);

  // A reader that stops reading, as `head` does, does not end the run; nor does an output that cannot be
  // written.
  std::signal(SIGPIPE, SIG_IGN);
  const std::string line = "+ " + shell_line(command) + "\n";
  std::fputs(line.c_str(), stdout);
  std::fflush(stdout);
  execute(std::move(command));
}

} // namespace

void add_run_command(CLI::App &app, Session &) {
  CLI::App *command = app.add_subcommand(
      "run", "Runs a deck in the stock engine with the plugin: in LAMMPS if the deck's name ends in .lammps, "
             "else in LIGGGHTS. Prints the plain command and then becomes it.");
  command->prefix_command(); // the first word that CLI11 does not know, and all behind it, stay as they are
  command->footer("Words:\n"
                  "  -np N             number of MPI ranks, started by mpirun; 1 if not given\n"
                  "  DECK              a file, or one of inputs by its name, such as chain/in.chain\n"
                  "  engine arguments  all further words, as they are, such as -var NAME VALUE\n"
                  "  DECK --help       the variables of a deck, with defaults, units and meaning\n");
  command->callback([command] { run(command->remaining()); });
}

} // namespace drumlin::post
