#include "commands/commands.h"
#include "commands/deck_variables.h"

#include "support/arguments.h"

#include <fmt/format.h>

namespace drumlin {

using LAMMPS_NS::LAMMPS;

void repeat_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/repeat", narg, arg);
  const std::string name = in.word("variable", "the name of a variable");
  const engine::bigint times = in.integer("times", 0);
  std::vector<std::string> commands;
  do
    commands.push_back(in.word("command", "a command of the deck, in quotes"));
  while (!in.empty());
  for (engine::bigint n = 1; n <= times; ++n) {
    DeckVariables(lmp).set(name, fmt::format("{}", n));
    for (const std::string &command : commands)
      lmp->input->one(command.c_str());
  }
}

} // namespace drumlin
