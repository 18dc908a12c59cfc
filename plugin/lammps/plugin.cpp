// Registration of everything that the plugin adds to LAMMPS, called by load.cpp.

#include "PLUGIN/plugin.h"
#include "lammpsplugin.h"

#include "command.h"
#include "fix_nve_sphere.h"

#include "engine.h"
#include "commands/commands.h"
#include "support/deck_folder.h"
#include "fixes/fix_bond_spring.h"
#include "fixes/fix_clump.h"
#include "fixes/fix_contact_events.h"
#include "fixes/fix_contact_local.h"
#include "fixes/fix_drum_excite.h"
#include "fixes/fix_guard.h"
#include "commands/fix_outputs.h"
#include "fixes/fix_roller_history.h"
#include "contact/fix_stepping.h"
#include "support/stop_signal.h"
#include "lammps/fix_neigh_history_transition.h"
#include "lammps/fix_wall_gran_transition.h"
#include "lammps/pair_gran_hooke_transition.h"

namespace {

using LAMMPS_NS::Fix;
using LAMMPS_NS::LAMMPS;

// Not public. An explicit instantiation may name a private member; its friend hands it out.
template <auto Member>
struct NVESphereAccess {
  friend auto &inertia_of(LAMMPS_NS::FixNVESphere &fix) { return fix.*Member; }
};
auto &inertia_of(LAMMPS_NS::FixNVESphere &fix);
template struct NVESphereAccess<&LAMMPS_NS::FixNVESphere::inertia>;

/// A function of the core's adapters as a command of the engine.
template <void (*function)(LAMMPS *, int, char **)>
class EngineCommand : public LAMMPS_NS::Command {
public:
  using LAMMPS_NS::Command::Command;
  void command(int narg, char **arg) override { function(lmp, narg, arg); }
};

template <class Style>
void *create(void *lmp) {
  return new Style(static_cast<LAMMPS *>(lmp));
}

/// The engine keeps fixes by their base class.
template <class FixStyle>
void *create_fix(void *lmp, int narg, char **arg) {
  return static_cast<Fix *>(new FixStyle(static_cast<LAMMPS *>(lmp), narg, arg));
}

/// Enters a style into a list of the engine. Its plugin interface, too, takes the functions that make styles
/// for those of its lists.
template <class Styles, class Make>
void enter(Styles &styles, const char *name, Make *make) {
  styles[name] = reinterpret_cast<typename Styles::mapped_type>(reinterpret_cast<void (*)()>(make));
}

void *create_pair(void *lmp) {
  return static_cast<LAMMPS_NS::Pair *>(new LAMMPS_NS::PairGranHookeTransition(static_cast<LAMMPS *>(lmp)));
}

} // namespace

double drumlin::engine::inertia_share(const LAMMPS *lmp) {
  for (int n = 0; n < lmp->modify->nfix; ++n)
    if (auto *fix = dynamic_cast<LAMMPS_NS::FixNVESphere *>(lmp->modify->fix[n])) return inertia_of(*fix);
  return 0.4;
}

extern "C" __attribute__((visibility("default"))) void drumlin_register(void *lmp, void *handle,
                                                                        void *register_function) {
  using namespace LAMMPS_NS;
  auto *engine = static_cast<LAMMPS *>(lmp);
  const auto add = reinterpret_cast<lammpsplugin_regfunc>(register_function);
  lammpsplugin_t plugin{};
  plugin.version = LAMMPS_VERSION;
  plugin.author = "drumlin";
  plugin.handle = handle;
  // The engine keeps one list of plugins for all its instances in a process, and takes a style of a plugin
  // that is in it in no other instance: there it is entered into the instance's own lists, as the engine
  // would.
  const bool listed = plugin_find("pair", "gran/hooke/transition") >= 0;
  const auto add_v1 = [&](const char *style, const char *name, const char *info,
                          lammpsplugin_factory1 *make) {
    plugin.style = style;
    plugin.name = name;
    plugin.info = info;
    plugin.creator.v1 = make;
    if (!listed)
      add(&plugin, lmp);
    else if (std::string(style) == "pair")
      enter(*engine->force->pair_map, name, make);
    else
      enter(*engine->input->command_map, name, make);
  };
  const auto add_fix = [&](const char *name, const char *info, lammpsplugin_factory2 *make) {
    plugin.style = "fix";
    plugin.name = name;
    plugin.info = info;
    plugin.creator.v2 = make;
    if (!listed)
      add(&plugin, lmp);
    else
      enter(*engine->modify->fix_map, name, make);
  };
  add_v1("pair", "gran/hooke/transition", "linear contact with transition A or B", create_pair);
  add_fix("wall/gran/transition", "its planes", create_fix<FixWallGranTransition>);
  add_fix(FixNeighHistoryTransition::style_name, "what contacts remember",
          create_fix<FixNeighHistoryTransition>);
  add_fix("drum/excite", "harmonic excitation of a drum", create_fix<FixDrumExcite>);
  add_fix("bond/spring", "bonded spring-dashpot", create_fix<FixBondSpring>);
  add_fix("clump", "one rigid body that does not turn", create_fix<FixClump>);
  add_fix("contact/events", "makes and breaks of contact", create_fix<FixContactEvents>);
  add_fix("contact/local", "contacts and their forces for dump local", create_fix<FixContactLocal>);
  add_fix("roller/history", "motion and forces of drum and frame", create_fix<FixRollerHistory>);
  add_fix("drumlin/stepping", "second-order stepping", create_fix<FixStepping>);
  add_fix(FixOutputs::style_name, "the files of a run", create_fix<FixOutputs>);
  add_fix(FixStop::style_name, "signals that end a run", create_fix<FixStop>);
  add_fix("guard", "step, overlap and finite numbers", create_fix<FixGuard>);
  add_v1("command", "drumlin/check", "judges a variable", create<EngineCommand<drumlin::check_command>>);
  add_v1("command", "drumlin/variables", "the variables of a deck",
         create<EngineCommand<drumlin::variables_command>>);
  add_v1("command", "drumlin/outputs", "room for the files of a run",
         create<EngineCommand<drumlin::outputs_command>>);
  add_v1("command", "drumlin/take", "values that a bed was made with",
         create<EngineCommand<drumlin::take_command>>);
  add_v1("command", "drumlin/write_data", "a data file with notes",
         create<EngineCommand<drumlin::write_data_command>>);
  add_v1("command", "drumlin/record", "what a run was made with",
         create<EngineCommand<drumlin::record_command>>);
  add_v1("command", "drumlin/run", "a run with progress and a limit",
         create<EngineCommand<drumlin::run_command>>);
  add_v1("command", "drumlin/settle", "a run to equilibrium", create<EngineCommand<drumlin::settle_command>>);
  add_v1("command", "drumlin/write_restart", "a restart file with notes",
         create<EngineCommand<drumlin::write_restart_command>>);
  drumlin::define_here(engine);
  drumlin::engine::say(engine, "drumlin " DRUMLIN_VERSION ", plugin for LAMMPS " LAMMPS_VERSION "\n");
}
