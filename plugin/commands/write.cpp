#include "commands/commands.h"

#include "commands/bed_files.h"
#include "commands/deck_variables.h"
#include "support/arguments.h"

namespace drumlin {

void write_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg) {
  const std::string command = "drumlin/write";
  Arguments in(lmp->error, command, narg, arg);
  DeckVariables::stop_on_fault(lmp);
  enum { restart, data, both };
  const int kind = in.choice("kind of file", {"restart", "data", "both"});
  const std::string file = in.word("file", restart_name_allowed);
  const RestartNotes notes = read_notes(lmp, in);
  if (lmp->domain->box_exist == 0)
    in.fail("simulation box is missing; allowed: the command after create_box, read_data or read_restart");
  if (kind != data) write_noted_restart(lmp, file, notes, command + ": file");
  if (kind != restart) write_noted_data(lmp, kind == both ? file + ".data" : file, notes, command + ": file");
}

} // namespace drumlin
