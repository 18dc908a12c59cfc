#include "commands/commands.h"

#include "support/arguments.h"
#include "commands/bed_files.h"

namespace drumlin {

void write_data_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg) {
  const std::string command = "drumlin/write_data";
  Arguments in(lmp->error, command, narg, arg);
  const std::string file = in.word("file", restart_name_allowed);
  const RestartNotes notes = read_notes(lmp, in);
  if (lmp->domain->box_exist == 0)
    in.fail("simulation box is missing; allowed: the command after create_box, read_data or read_restart");
  write_noted_data(lmp, file, notes, command + ": file");
}

} // namespace drumlin
