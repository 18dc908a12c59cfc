#include "commands/commands.h"

#include "commands/bed_files.h"
#include "commands/deck_variables.h"
#include "support/arguments.h"

namespace drumlin {

using LAMMPS_NS::LAMMPS;

void read_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/read", narg, arg);
  DeckVariables::stop_on_fault(lmp);
  const std::string file = in.word("file", "a restart file or a data file");
  const bool may_continue = !in.empty() && in.choice("word behind the file", {"may_continue"}) == 0;
  in.expect_end("FILE [may_continue]");
  if (lmp->domain->box_exist != 0) in.fail("simulation box exists; allowed: the command before create_box");
  const bool on_rank_0 = lmp->comm->me == 0;
  const std::string name = engine::from_rank_0(lmp, on_rank_0 ? scene_file(file) : "");
  const bool is_data = !engine::from_rank_0(lmp, on_rank_0 && is_text(name) ? "data" : "").empty();
  std::string fault;
  if (on_rank_0)
    fault = !can_be_read(name) ? "; allowed: a file that can be read"
            : is_data          ? data_file_fault(name)
                               : restart_fault(name, {});
  engine::stop_on_fault(lmp, "drumlin/read", fault.empty() ? "" : "file is '" + name + "'" + fault);
  lmp->input->one(((is_data ? "read_data " : "read_restart ") + name).c_str());
  DeckVariables variables(lmp);
  variables.set("scene", name);
  variables.set("from_data", is_data ? "1" : "0");
  variables.set("continues", may_continue && lmp->update->ntimestep > 0 ? "1" : "0");
}

void write_command(LAMMPS *lmp, int narg, char **arg) {
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
