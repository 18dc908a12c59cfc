// Registers what the plugin adds to LIGGGHTS: contact models, fixes and commands.

#include "engine.h"
#include "commands/commands.h"
#include "commands/fix_outputs.h"
#include "contact/fix_between_runs.h"
#include "contact/fix_stepping.h"
#include "fixes/fixes.h"
#include "liggghts/registration.h"
#include "stub.h"
#include "support/deck_folder.h"
#include "support/stop_signal.h"

#include "universe.h"

#include <map>
#include <string>

namespace {

using LAMMPS_NS::Fix;
using LAMMPS_NS::Input;
using LAMMPS_NS::LAMMPS;
using LAMMPS_NS::Modify;
using LAMMPS_NS::Pointers;

// The engine's lists of styles are private members. C++ allows an explicit instantiation to name a private
// member as a template argument; the friend function of the instance gives access to it.
template <auto Member>
struct ModifyAccess {
  friend auto &fix_map_of(Modify &modify) { return modify.*Member; }
};
auto &fix_map_of(Modify &modify);
template struct ModifyAccess<&Modify::fix_map>;

template <auto Member>
struct InputAccess {
  friend auto &command_map_of(Input &input) { return input.*Member; }
};
auto &command_map_of(Input &input);
template struct InputAccess<&Input::command_map>;

// Input's base class is protected: only a C-style cast converts to it.
struct PointersAccess : Pointers {
  static LAMMPS *engine_of(Input &input) { return ((Pointers &)input).*(&PointersAccess::lmp); } // NOLINT
};

template <class FixStyle>
Fix *create_fix(LAMMPS *lmp, int narg, char **arg) {
  return new FixStyle(lmp, narg, arg);
}

void add_fixes(LAMMPS *lmp) {
  auto &fixes = *fix_map_of(*lmp->modify);
  drumlin::for_each_fix([&fixes](auto fix, const char *name, const char *) {
    fixes[name] = create_fix<typename decltype(fix)::type>;
  });
  // Helper fixes, which the pair style and the commands add; decks do not use them.
  fixes["drumlin/stepping"] = create_fix<LAMMPS_NS::FixStepping>;
  fixes[LAMMPS_NS::FixBetweenRuns::style_name] = create_fix<LAMMPS_NS::FixBetweenRuns>;
  fixes[LAMMPS_NS::FixStop::style_name] = create_fix<LAMMPS_NS::FixStop>;
  fixes[LAMMPS_NS::FixOutputs::style_name] = create_fix<LAMMPS_NS::FixOutputs>;
}

void add_commands(LAMMPS *lmp) {
  auto &commands = *command_map_of(*lmp->input);
  drumlin::for_each_command([&commands](auto command, const char *name, const char *) {
    commands[name] = decltype(command)::function;
  });
}

} // namespace

void drumlin_register_again(void *engine) { add_fixes(static_cast<LAMMPS *>(engine)); }

void drumlin_register(void *input) {
  LAMMPS *lmp = PointersAccess::engine_of(*static_cast<Input *>(input));
  const std::string version = lmp->universe->version; // "Version LIGGGHTS-PUBLIC 3.8.0, compiled ..."
  if (version.find(" " LIGGGHTS_VERSION ",") == std::string::npos)
    drumlin::stop("built for LIGGGHTS " LIGGGHTS_VERSION ", but this process runs '" +
                  version.substr(0, version.find(',')) +
                  "'; build drumlin against the source of this version");
  // The engine calls this for each file of a deck. Its fixes belong to the instance; its list of contact
  // models belongs to the process, see add_contact_models().
  if (fix_map_of(*lmp->modify)->count("drum/excite") != 0) return;
  drumlin::add_contact_models();
  add_fixes(lmp);
  add_commands(lmp);
  drumlin::define_deck_folder(lmp);
  drumlin::engine::log_message(lmp, "drumlin " DRUMLIN_VERSION ", plugin for LIGGGHTS " LIGGGHTS_VERSION
                                    ", loaded in LIGGGHTS " LIGGGHTS_VERSION "\n");
}
