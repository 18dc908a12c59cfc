#include "commands/commands.h"

#include "commands/deck_variables.h"
#include "commands/fix_outputs.h"
#include "contact/contact_source.h"
#include "support/arguments.h"
#include "support/command_line.h"
#include "support/output_set.h"
#include "support/whole_file.h"

#include <algorithm>
#include <cstdlib>
#include <memory>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;

/// The arguments of drumlin/outputs.
struct Outputs {
  std::string folder, subfolder;
  bool continues = false; ///< whether a stopped run goes on from the scene that drumlin/read has read
  std::vector<std::string> files;
  std::vector<std::string> inputs;   ///< files that the deck has read
  std::vector<std::string> restarts; ///< restart files, which a run that continues does not back up
  std::vector<NumberedFiles> numbered;
};

Outputs read_outputs(Arguments &in) {
  Outputs outputs;
  const auto in_folder = [&outputs](const std::string &name) {
    return outputs.folder.empty() ? name : outputs.folder + '/' + name;
  };
  const std::vector<std::string> keywords = {"folder", "subfolder", "files", "inputs", "restart", "numbered"};
  const auto is_keyword = [&keywords](const std::string &word) {
    return std::find(keywords.begin(), keywords.end(), word) != keywords.end();
  };
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "folder")
      outputs.folder = in.word("keyword folder", "a folder, made if missing");
    else if (keyword == "subfolder")
      outputs.subfolder = in_folder(in.word("keyword subfolder", "a folder, made if missing"));
    else if (keyword == "files")
      while (!in.empty() && !is_keyword(in.peek()))
        outputs.files.push_back(in_folder(in.word("file")));
    else if (keyword == "inputs")
      while (!in.empty() && !is_keyword(in.peek()))
        outputs.inputs.push_back(in.word("keyword inputs"));
    else if (keyword == "restart")
      outputs.restarts.push_back(in_folder(in.word("keyword restart")));
    else if (keyword == "numbered")
      while (!in.empty() && !is_keyword(in.peek())) {
        const std::string folder = in_folder(in.word("folder"));
        const std::string prefix = in.word("keyword numbered, prefix");
        outputs.numbered.push_back({folder, prefix, in.word("keyword numbered, suffix")});
      }
    else
      in.fail("keyword", keyword, "inputs, folder, subfolder, files, restart or numbered");
  }
  return outputs;
}

/// Makes the folders and renames the files of an earlier run, so that they can be put back if this one fails.
void prepare(OutputSet &set, const Outputs &outputs, const LAMMPS_NS::Update &now) {
  // Rows up to the present step are kept even if their time is rounded up.
  const double end = (static_cast<double>(now.ntimestep) + 0.5) * now.dt;
  set.keep(outputs.inputs);
  if (!outputs.folder.empty()) set.lock_folder(outputs.folder);
  if (!outputs.subfolder.empty()) set.make_folder(outputs.subfolder);
  for (const std::string &file : outputs.files)
    if (outputs.continues)
      set.truncate_table(file, end);
    else
      set.replace(file);
  for (const std::string &file : outputs.restarts) {
    if (!outputs.continues) set.replace(file);
    set.continues_from(file);
  }
  set.replace_numbered(outputs.numbered, outputs.continues ? static_cast<long>(now.ntimestep) + 1 : 0);
}

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

void outputs_command(LAMMPS *lmp, int narg, char **arg) {
  DeckVariables::stop_on_fault(lmp);
  const std::string command = "drumlin/outputs";
  Arguments in(lmp->error, command, narg, arg);
  Outputs outputs = read_outputs(in);
  if (const auto scene = DeckVariables(lmp).value("scene")) outputs.inputs.push_back(*scene);
  outputs.continues = engine::continues(lmp);
  if (lmp->domain->box_exist == 0)
    in.fail("simulation box is missing; allowed: the command after create_box, read_data or read_restart");
  std::unique_ptr<OutputSet> set;
  std::string fault;
  if (lmp->comm->me == 0) {
    try {
      set = std::make_unique<OutputSet>();
      prepare(*set, outputs, *lmp->update);
    } catch (const std::runtime_error &found) {
      fault = found.what();
    }
  }
  engine::stop_on_fault(lmp, command, fault);
  LAMMPS_NS::FixOutputs::provide(lmp, std::move(set));
}

void record_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/record", narg, arg);
  const std::string name = in.word("file", output_name_allowed);
  std::vector<std::pair<std::string, std::string>> rows;
  while (!in.empty()) {
    const std::string key = in.word("name");
    std::string value = in.word("the value of " + key);
    if (value == "*") value = joined(words_of(DeckVariables(lmp).value(key).value_or("")), ",");
    rows.emplace_back(key, value);
  }
  // Declared variables, unless the deck has given their rows.
  DeckVariables::stop_on_fault(lmp);
  const DeckVariables variables(lmp);
  for (const DeclaredVariable &variable : variables.declared())
    if (std::none_of(rows.begin(), rows.end(), [&](const auto &row) { return row.first == variable.name; }))
      rows.emplace_back(variable.name, variables.value(variable.name).value_or(""));
  if (const std::string law = law_name(lmp); !law.empty()) rows.emplace_back("contact_law", law);
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
