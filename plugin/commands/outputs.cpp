#include "commands/commands.h"

#include "commands/deck_variables.h"
#include "support/arguments.h"
#include "commands/fix_outputs.h"
#include "support/output_set.h"

#include <algorithm>
#include <limits>
#include <memory>

namespace drumlin {
namespace {

/// The arguments of the command.
struct Outputs {
  std::string folder, subfolder;
  engine::bigint step = 0; ///< step from which the run continues; 0: a new run
  double time = 0.0;       ///< s, at that step
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
  const std::vector<std::string> keywords = {"folder", "subfolder", "continue", "files",
                                             "inputs", "restart",   "numbered"};
  const auto is_keyword = [&keywords](const std::string &word) {
    return std::find(keywords.begin(), keywords.end(), word) != keywords.end();
  };
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "folder")
      outputs.folder = in.word("keyword folder", "a folder, made if missing");
    else if (keyword == "subfolder")
      outputs.subfolder = in_folder(in.word("keyword subfolder", "a folder, made if missing"));
    else if (keyword == "continue") {
      outputs.step = in.integer("keyword continue, step", 0, std::numeric_limits<engine::bigint>::max());
      outputs.time = in.number("keyword continue, time", Range::non_negative);
    } else if (keyword == "files")
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
      in.fail("keyword", keyword, "inputs, folder, subfolder, continue, files, restart or numbered");
  }
  return outputs;
}

/// Makes the folders and backs up the files of an earlier run. \param half_step s, half of the time step:
/// rows up to the step are kept even if their time is rounded up
void prepare(OutputSet &set, const Outputs &outputs, double half_step) {
  set.keep(outputs.inputs);
  if (!outputs.folder.empty()) set.lock_folder(outputs.folder);
  if (!outputs.subfolder.empty()) set.make_folder(outputs.subfolder);
  for (const std::string &file : outputs.files)
    if (outputs.step > 0)
      set.truncate_table(file, outputs.time + half_step);
    else
      set.replace(file);
  for (const std::string &file : outputs.restarts) {
    if (outputs.step == 0) set.replace(file);
    set.continues_from(file);
  }
  set.replace_numbered(outputs.numbered, outputs.step > 0 ? static_cast<long>(outputs.step) + 1 : 0);
}

} // namespace

void outputs_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg) {
  DeckVariables::stop_on_fault(lmp);
  const std::string command = "drumlin/outputs";
  Arguments in(lmp->error, command, narg, arg);
  const Outputs outputs = read_outputs(in);
  if (lmp->domain->box_exist == 0)
    in.fail("simulation box is missing; allowed: the command after create_box, read_data or read_restart");
  std::unique_ptr<OutputSet> set;
  std::string fault;
  if (lmp->comm->me == 0) {
    try {
      set = std::make_unique<OutputSet>();
      prepare(*set, outputs, 0.5 * lmp->update->dt);
    } catch (const std::runtime_error &found) {
      fault = found.what();
    }
  }
  engine::stop_on_fault(lmp, command, fault);
  LAMMPS_NS::FixOutputs::provide(lmp, std::move(set));
}

} // namespace drumlin
