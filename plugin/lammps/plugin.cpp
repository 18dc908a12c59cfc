// Registers what the plugin adds to LAMMPS: pair style, fixes and commands. Called by load.cpp.

#include "PLUGIN/plugin.h"
#include "lammpsplugin.h"

#include "command.h"
#include "fix_nve_sphere.h"

#include "engine.h"
#include "commands/commands.h"
#include "commands/fix_outputs.h"
#include "contact/fix_between_runs.h"
#include "contact/fix_stepping.h"
#include "fixes/fixes.h"
#include "lammps/fix_neigh_history_transition.h"
#include "lammps/fix_wall_gran_transition.h"
#include "lammps/pair_gran_transition.h"
#include "support/deck_folder.h"
#include "support/stop_signal.h"

namespace {

using LAMMPS_NS::Fix;
using LAMMPS_NS::LAMMPS;

// A private member. C++ allows an explicit instantiation to name it as a template argument; the friend
// function of the instance gives access to it.
template <auto Member>
struct NVESphereAccess {
  friend auto &inertia_of(LAMMPS_NS::FixNVESphere &fix) { return fix.*Member; }
};
auto &inertia_of(LAMMPS_NS::FixNVESphere &fix);
template struct NVESphereAccess<&LAMMPS_NS::FixNVESphere::inertia>;

/// A function of commands.h as a command of the engine.
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

/// Makes a fix and returns a pointer to its base class, as the engine requires; it may differ from that to
/// the fix.
template <class FixStyle>
void *create_fix(void *lmp, int narg, char **arg) {
  return static_cast<Fix *>(new FixStyle(static_cast<LAMMPS *>(lmp), narg, arg));
}

/// The name of the pair style with a law. The engine keeps the pointer.
template <class Contact>
const char *pair_style_name() {
  static const std::string name = std::string("gran/") + Contact::name;
  return name.c_str();
}

/// The pair style with the law of the parameters `Contact`.
template <class Contact>
void *create_pair(void *lmp) {
  return static_cast<LAMMPS_NS::Pair *>(
      new LAMMPS_NS::PairGranTransition(static_cast<LAMMPS *>(lmp), drumlin::LawTag<Contact>{}));
}

/// Adds styles to an engine instance. LAMMPS has one list of plugins for all its instances in a process. It
/// does not add a style that is already in this list to a further instance; for such an instance the style is
/// entered into the instance's own lists here.
class Registration {
public:
  Registration(void *lmp, void *handle, void *register_function)
      : lmp_(lmp), add_(reinterpret_cast<lammpsplugin_regfunc>(register_function)),
        listed_(LAMMPS_NS::plugin_find("pair", "gran/hooke/transition") >= 0) {
    plugin_.version = LAMMPS_VERSION;
    plugin_.author = "drumlin";
    plugin_.handle = handle;
  }

  void add(const char *category, const char *name, const char *info, lammpsplugin_factory1 *create) {
    plugin_.creator.v1 = create;
    add(category, name, info, reinterpret_cast<void (*)()>(create));
  }
  void add_fix(const char *name, const char *info, lammpsplugin_factory2 *create) {
    plugin_.creator.v2 = create;
    add("fix", name, info, reinterpret_cast<void (*)()>(create));
  }

private:
  void add(const char *category, const char *name, const char *info, void (*create)()) {
    if (listed_)
      return drumlin::engine::version::enter_style(static_cast<LAMMPS *>(lmp_), category, name, create);
    plugin_.style = category;
    plugin_.name = name;
    plugin_.info = info;
    add_(&plugin_, lmp_);
  }

  void *lmp_;
  lammpsplugin_regfunc add_;
  bool listed_; // by another instance
  lammpsplugin_t plugin_{};
};

} // namespace

double drumlin::engine::inertia_share(const LAMMPS *lmp) {
  for (Fix *fix : fixes(lmp->modify))
    if (auto *integrates = dynamic_cast<LAMMPS_NS::FixNVESphere *>(fix)) return inertia_of(*integrates);
  return 0.4;
}

extern "C" __attribute__((visibility("default"))) void drumlin_register(void *lmp, void *handle,
                                                                        void *register_function) {
  using namespace LAMMPS_NS;
  auto *engine = static_cast<LAMMPS *>(lmp);
  Registration registration(lmp, handle, register_function);
  drumlin::for_each_law([&registration](auto law) {
    using Contact = typename decltype(law)::type;
    registration.add("pair", pair_style_name<Contact>(), "contact with transition A or B",
                     create_pair<Contact>);
  });
  registration.add_fix("wall/gran/transition", "walls with this contact law",
                       create_fix<FixWallGranTransition>);
  drumlin::for_each_fix([&registration](auto fix, const char *name, const char *info) {
    registration.add_fix(name, info, create_fix<typename decltype(fix)::type>);
  });
  // Helper fixes, which the pair style and the commands add; decks do not use them.
  registration.add_fix(FixNeighHistoryTransition::style_name, "contact history",
                       create_fix<FixNeighHistoryTransition>);
  registration.add_fix(FixBetweenRuns::style_name, "what leads from one run to the next",
                       create_fix<FixBetweenRuns>);
  registration.add_fix("drumlin/stepping", "second-order stepping", create_fix<FixStepping>);
  registration.add_fix(FixOutputs::style_name, "output files of a run", create_fix<FixOutputs>);
  registration.add_fix(FixStop::style_name, "signals that end a run", create_fix<FixStop>);
  drumlin::for_each_command([&registration](auto command, const char *name, const char *info) {
    registration.add("command", name, info, create<EngineCommand<decltype(command)::function>>);
  });
  drumlin::define_deck_folder(engine);
  drumlin::engine::log_message(engine, "drumlin " DRUMLIN_VERSION ", plugin for LAMMPS " LAMMPS_VERSION "\n");
}
