// Registration of everything that the plugin adds to a stock LIGGGHTS, called by the preloaded library
// (preload.cpp).

// The order of these matters: the headers below lean on them without including them.
#include "fix_insert_stream.h"
#include "fix_mesh_surface.h"
#include "fix_property_atom.h"
#include "global_properties.h"

#include "contact_models.h"

#include "pair_gran_base.h"

#include "fix_wall_gran_base.h"

#include "comm.h"
#include "input.h"
#include "neighbor.h"
#include "universe.h"

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
#include "liggghts/contact_table.h"
#include "liggghts/fix_keep_history.h"
#include "liggghts/model_settings.h"
#include "liggghts/observed_contact.h"
#include "liggghts/registration.h"
#include "stub.h"

#include <algorithm>
#include <map>
#include <string>

namespace {

using namespace LIGGGHTS::ContactModels; // NOLINT: the engine's model constants
using LAMMPS_NS::Fix;
using LAMMPS_NS::FixWallGran;
using LAMMPS_NS::Input;
using LAMMPS_NS::LAMMPS;
using LAMMPS_NS::Modify;
using LAMMPS_NS::PairGran;
using LAMMPS_NS::Pointers;

// The release that the contact data layout below was built for, without superquadrics.
static_assert(sizeof(SurfacesIntersectData) == 368,
              "contact data of this LIGGGHTS differ from the stock binary's");

// The engine's style maps are not public. An explicit instantiation may name a private member; its friend
// hands it out.
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

/// A combination of models keeps contact history: its shear spring or rolling torque must vanish with the
/// contact.
template <class Style>
constexpr bool has_history = drumlin::has_spring<Style> || Style::ROLLING == ROLLING_EPSD2;

template <class Style>
constexpr drumlin::Companions companions{drumlin::has_spring<Style>, Style::ROLLING != ROLLING_OFF};

/// What a combination of models needs of the engine before it reads its properties.
template <class Style>
void prepare(LAMMPS *engine) {
  if (has_history<Style>) engine->neighbor->register_contact_dist_factor(drumlin::contact_distance_factor);
  if (Style::TANGENTIAL != TANGENTIAL_OFF) drumlin::provide_friction_default(engine, engine->atom->ntypes);
}

template <class Style>
class TransitionPair : public LIGGGHTS::PairStyles::Granular<drumlin::ObservedContact<Style>>,
                       public drumlin::PairContacts {
  using Base = LIGGGHTS::PairStyles::Granular<drumlin::ObservedContact<Style>>;

public:
  TransitionPair(LAMMPS *engine, PairGran *pair, int64_t hash)
      : Base(engine, pair, hash), PairContacts(engine), engine_(engine), pair_(pair) {}
  ~TransitionPair() override { LAMMPS_NS::FixStepping::dismiss(engine_); }

  void settings(int narg, char **arg, LIGGGHTS::IContactHistorySetup *history) override {
    drumlin::ModelSettings words(engine_->error, "pair_style gran model hooke/transition", companions<Style>,
                                 narg, arg);
    LAMMPS_NS::FixKeepHistory::provide(engine_);
    Base::settings(words.size(), words.words(), history);
  }

  void init_granular() override {
    if (drumlin::gran_pair(engine_) != pair_)
      engine_->error->all(
          FLERR, "pair_style gran model hooke/transition: pair_style hybrid has gran more than once; "
                 "allowed: once");
    prepare<Style>(engine_);
    PairContacts::begin(pair_,
                        drumlin::has_spring<Style>                   ? drumlin::FrictionModel::history
                        : Style::TANGENTIAL == TANGENTIAL_NO_HISTORY ? drumlin::FrictionModel::no_history
                                                                     : drumlin::FrictionModel::none,
                        Style::TANGENTIAL == TANGENTIAL_COULOMB ? drumlin::physics::Cap::coulomb
                                                                : drumlin::physics::Cap::spring);
    Base::init_granular();
  }

private:
  LAMMPS *engine_;
  PairGran *pair_;
};

template <class Style>
class TransitionWall : public LIGGGHTS::Walls::Granular<drumlin::ObservedContact<Style>> {
  using Base = LIGGGHTS::Walls::Granular<drumlin::ObservedContact<Style>>;

public:
  TransitionWall(LAMMPS *engine, FixWallGran *wall, int64_t hash)
      : Base(engine, wall, hash), engine_(engine) {}

  void settings(int narg, char **arg, LIGGGHTS::IContactHistorySetup *history) override {
    drumlin::ModelSettings words(engine_->error, "fix wall/gran model hooke/transition", companions<Style>,
                                 narg, arg);
    Base::settings(words.size(), words.words(), history);
  }

  void init_granular() override {
    prepare<Style>(engine_);
    Base::init_granular();
  }

private:
  LAMMPS *engine_;
};

template <int Tangential, int Rolling>
void add_combination() {
  using Style = GranStyle<HOOKE_TRANSITION, Tangential, COHESION_OFF, Rolling, SURFACE_DEFAULT>;
  LIGGGHTS::PairStyles::Factory::instance().addStyle(
      "gran", Style::HASHCODE,
      [](LAMMPS *lmp, PairGran *parent, int64_t hash) -> LIGGGHTS::PairStyles::IGranularPairStyle * {
        return new TransitionPair<Style>(lmp, parent, hash);
      });
  LIGGGHTS::Walls::Factory::instance().addStyle(
      "gran", Style::HASHCODE,
      [](LAMMPS *lmp, FixWallGran *parent, int64_t hash) -> LIGGGHTS::Walls::IGranularWall * {
        return new TransitionWall<Style>(lmp, parent, hash);
      });
}

template <int Tangential>
void add_rolling_combinations() {
  add_combination<Tangential, ROLLING_OFF>();
  add_combination<Tangential, ROLLING_CDT>();
  add_combination<Tangential, ROLLING_EPSD2>();
}

void add_contact_models() {
  Factory::instance().addNormalModel("hooke/transition", HOOKE_TRANSITION);
  Factory::instance().addTangentialModel("coulomb", TANGENTIAL_COULOMB);
  add_rolling_combinations<TANGENTIAL_OFF>();
  add_rolling_combinations<TANGENTIAL_NO_HISTORY>();
  add_rolling_combinations<TANGENTIAL_HISTORY>();
  add_rolling_combinations<TANGENTIAL_COULOMB>();
}

template <class FixStyle>
Fix *create_fix(LAMMPS *lmp, int narg, char **arg) {
  return new FixStyle(lmp, narg, arg);
}

void add_fixes(LAMMPS *lmp) {
  auto &fixes = *fix_map_of(*lmp->modify);
  fixes["drum/excite"] = create_fix<LAMMPS_NS::FixDrumExcite>;
  fixes["bond/spring"] = create_fix<LAMMPS_NS::FixBondSpring>;
  fixes["clump"] = create_fix<LAMMPS_NS::FixClump>;
  fixes["contact/events"] = create_fix<LAMMPS_NS::FixContactEvents>;
  fixes["contact/local"] = create_fix<LAMMPS_NS::FixContactLocal>;
  fixes["roller/history"] = create_fix<LAMMPS_NS::FixRollerHistory>;
  fixes["drumlin/stepping"] = create_fix<LAMMPS_NS::FixStepping>; // made by the pair style, not by decks
  fixes[LAMMPS_NS::FixKeepHistory::style_name] = create_fix<LAMMPS_NS::FixKeepHistory>; // this neither
  fixes[LAMMPS_NS::FixStop::style_name] = create_fix<LAMMPS_NS::FixStop>;               // by commands
  fixes[LAMMPS_NS::FixOutputs::style_name] = create_fix<LAMMPS_NS::FixOutputs>;         // by a command
  fixes["guard"] = create_fix<LAMMPS_NS::FixGuard>;
}

void add_commands(LAMMPS *lmp) {
  auto &commands = *command_map_of(*lmp->input);
  commands["drumlin/check"] = drumlin::check_command;
  commands["drumlin/variables"] = drumlin::variables_command;
  commands["drumlin/outputs"] = drumlin::outputs_command;
  commands["drumlin/take"] = drumlin::take_command;
  commands["drumlin/write_data"] = drumlin::write_data_command;
  commands["drumlin/record"] = drumlin::record_command;
  commands["drumlin/run"] = drumlin::run_command;
  commands["drumlin/settle"] = drumlin::settle_command;
  commands["drumlin/write_restart"] = drumlin::write_restart_command;
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
  // The engine calls this for each file of a deck. Its list of contact models is one for the process, that of
  // fixes for the instance.
  if (fix_map_of(*lmp->modify)->count("drum/excite") != 0) return;
  if (Factory::instance().getNormalModelId("hooke/transition") != HOOKE_TRANSITION) add_contact_models();
  add_fixes(lmp);
  add_commands(lmp);
  drumlin::define_here(lmp);
  drumlin::engine::say(lmp, std::string("drumlin " DRUMLIN_VERSION ", plugin for LIGGGHTS " LIGGGHTS_VERSION
                                        ", loaded in LIGGGHTS " LIGGGHTS_VERSION "\n"));
}
