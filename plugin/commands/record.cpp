#include "commands/commands.h"

#include "commands/deck_variables.h"
#include "commands/fix_outputs.h"
#include "support/arguments.h"
#include "support/command_line.h"
#include "support/whole_file.h"

#include <algorithm>
#include <cstdlib>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;

/// The command line of this process, after its LD_PRELOAD=..., without which LIGGGHTS would run without the
/// plugin.
std::string command_line() {
  const char *preload = std::getenv("LD_PRELOAD");
  std::string text = preload ? "LD_PRELOAD=" + std::string(preload) : "";
  for (const std::string &word : command_line_arguments())
    text += (text.empty() ? "" : " ") +
            (word.empty() || word.find_first_of(" '\"$") != std::string::npos ? "'" + word + "'" : word);
  return text;
}

} // namespace

void record_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/record", narg, arg);
  const std::string name = in.word("file", output_name_allowed);
  std::vector<std::pair<std::string, std::string>> rows;
  while (!in.empty()) {
    const std::string key = in.word("name");
    rows.emplace_back(key, in.word("the value of " + key));
  }
  // Declared variables, unless the deck has given their rows.
  DeckVariables::stop_on_fault(lmp);
  const DeckVariables variables(lmp);
  for (const DeclaredVariable &variable : variables.declared())
    if (std::none_of(rows.begin(), rows.end(), [&](const auto &row) { return row.first == variable.name; }))
      rows.emplace_back(variable.name, variables.value(variable.name).value_or(""));
  rows.emplace_back("engine", engine::name_and_version());
  rows.emplace_back("plugin", std::string("drumlin ") + DRUMLIN_VERSION);
  rows.emplace_back("ranks", std::to_string(lmp->comm->nprocs));
  rows.emplace_back("command", command_line());
  LAMMPS_NS::FixOutputs *outputs = LAMMPS_NS::FixOutputs::of(lmp);
  if (outputs != nullptr) rows.emplace_back(ended_name, ended_not);
  std::string fault;
  if (lmp->comm->me == 0) {
    std::string text = "name,value\n";
    for (const auto &[key, value] : rows)
      text += record_row(key, value);
    if (!is_output_file(name) || !write_whole_file(name, text))
      fault = "file is '" + name + "', which cannot be written; allowed: " + output_name_allowed +
              ", on a disk with room";
  }
  engine::stop_on_fault(lmp, "drumlin/record", fault);
  if (outputs != nullptr) outputs->record(name);
}

} // namespace drumlin
