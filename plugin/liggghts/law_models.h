// The contact models of a law that the plugin adds to LIGGGHTS: with each of its friction models, with and
// without rolling resistance, for pairs and walls. Each law is compiled as a unit of its own.
#pragma once

// These headers must come first: the engine's headers below use them without including them.
#include "fix_insert_stream.h"
#include "fix_mesh_surface.h"
#include "fix_property_atom.h"
#include "global_properties.h"

#include "contact_models.h"

#include "pair_gran_base.h"

#include "fix_wall_gran_base.h"

#include "neighbor.h"

#include "engine.h"
#include "contact/deck_check.h"
#include "contact/fix_between_runs.h"
#include "contact/fix_stepping.h"
#include "liggghts/pair_source.h"
#include "liggghts/model_settings.h"
#include "liggghts/loop_adapter.h"
#include "liggghts/registration.h"
#include "liggghts/transition_model.h"
#include "liggghts/wall_report.h"
#include "support/arguments.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <vector>

namespace drumlin {

namespace detail {

using drumlin::physics::Resisted;
using LAMMPS_NS::FixMeshSurface;
using LAMMPS_NS::FixWallGran;
using LAMMPS_NS::LAMMPS;
using LAMMPS_NS::PairGran;
using LAMMPS_NS::TriMesh;
using LIGGGHTS::ContactModels::SurfacesIntersectData;

// The layout of the contact data in Debian's binary, which is built without superquadrics.
static_assert(sizeof(SurfacesIntersectData) == 368,
              "contact data of this LIGGGHTS differ from the stock binary's");

template <class Models>
class TransitionPair : public LIGGGHTS::PairStyles::Granular<drumlin::TransitionModel<Models>>,
                       public drumlin::PairSource {
  using Base = LIGGGHTS::PairStyles::Granular<drumlin::TransitionModel<Models>>;
  using Contact = typename Models::Contact;

public:
  TransitionPair(LAMMPS *engine, PairGran *pair, int64_t hash)
      : Base(engine, pair, hash), PairSource(engine), engine_(engine), pair_(pair) {}
  ~TransitionPair() override { LAMMPS_NS::FixStepping::dismiss(engine_); }

  void settings(int narg, char **arg, LIGGGHTS::IContactHistorySetup *history) override {
    drumlin::ModelSettings words(engine_->error, command(), Models::rolls, narg, arg);
    torsion_ = words.has("torsionTorque", "on");
    LAMMPS_NS::FixBetweenRuns::provide(engine_);
    Base::settings(words.size(), words.words(), history);
  }

  void init_granular() override {
    if (drumlin::gran_pair(engine_) != pair_)
      engine_->error->all(FLERR,
                          drumlin::engine::error_text(
                              command() + ": pair_style hybrid has gran more than once; allowed: once"));
    if (engine_->domain->triclinic != 0)
      engine_->error->all(FLERR, drumlin::engine::error_text(
                                     command() + ": the box is triclinic, through whose sides this engine "
                                                 "loses balls and contacts; allowed: region block"));
    drumlin::check_deforming_box(engine_, command());
    stepping_ =
        this->get_history_offset(drumlin::force_name) < 0 ? nullptr : LAMMPS_NS::FixStepping::find(engine_);
    PairSource::begin(pair_, Models::settings(stepping_ == nullptr));
    Base::init_granular();
    LAMMPS_NS::FixBetweenRuns::provide(engine_)->check_contacts(command(), places().count() > 0);
    if (stepping_ != nullptr && pair_->storeContactForcesStress())
      engine_->error->all(
          FLERR, drumlin::engine::error_text(
                     command() + ": stepping is 'second' and there is a fix continuum/weighted, which takes "
                                 "forces that are not final; allowed: stepping stock with this fix"));
    observers_.find(*engine_->modify);
    clumps_.find(*engine_->modify);
    constexpr int multi = 2; // Neighbor::style
    if (engine_->neighbor->style == multi)
      engine_->error->all(FLERR, drumlin::engine::error_text(
                                     command() + ": neighbor style is 'multi', with which this engine finds "
                                                 "no contact of balls; allowed: bin or nsq"));
    deck_check_.of_pair(engine_, command(), stepping_ != nullptr);
  }

  void compute_force(PairGran *pair, int eflag, int vflag, int adds) override {
    const LAMMPS_NS::VelocitiesOfStep velocities(engine_);
    const bool history_is_there = places().count() > 0 || pair->listgranhistory == nullptr;
    if (history_is_there &&
        !drumlin::needs_engine_loop(*pair, *engine_->modify, eflag != 0 || vflag != 0, adds != 0)) {
      pair->evflag = pair->vflag_fdotr = 0;
      return stepping_ == nullptr ? compute_contacts<false>() : compute_contacts<true>();
    }
    loop_memory_.pairs.forget();
    Base::compute_force(pair, eflag, vflag, adds);
  }

  std::string law_name() const override { return Contact::name; }

private:
  template <bool stepped>
  void compute_contacts() {
    if (pair_->list->inum == 0) return; // there may be no arrays
    drumlin::LoopAdapter<Models, stepped>(*pair_, *engine_->atom, *engine_->neighbor, clumps_)
        .compute(loop_memory_, {*std::get<const drumlin::CoefficientTable<Contact> *>(table()), places(),
                                cap(), torsion_ ? Resisted::all : Resisted::rolling, stepping_, observers_,
                                engine_->update->dt, true});
  }

  static std::string command() { return std::string("pair_style gran model ") + Contact::name; }

  LAMMPS *engine_;
  PairGran *pair_;
  LAMMPS_NS::FixStepping *stepping_ = nullptr; // none under stock stepping
  drumlin::LoopMemory loop_memory_;
  drumlin::ContactObservers observers_;
  drumlin::DeckCheck deck_check_;
  LAMMPS_NS::Clumps clumps_;
  bool torsion_ = false; // torsionTorque on: rolling friction also brakes spin about the line of centres
};

template <class Models>
class TransitionWall : public LIGGGHTS::Walls::Granular<drumlin::TransitionModel<Models>> {
  using Base = LIGGGHTS::Walls::Granular<drumlin::TransitionModel<Models>>;

public:
  TransitionWall(LAMMPS *engine, FixWallGran *wall, int64_t hash)
      : Base(engine, wall, hash), engine_(engine) {}

  void settings(int narg, char **arg, LIGGGHTS::IContactHistorySetup *history) override {
    const std::string command = std::string("fix wall/gran model ") + Models::Contact::name;
    drumlin::ModelSettings words(engine_->error, command, Models::rolls, narg, arg);
    Base::settings(words.size(), words.words(), history);
  }

  void init_granular() override {
    Base::init_granular();
    report_.begin(*engine_, *this);
  }

  void compute_force(FixWallGran *wall, SurfacesIntersectData &contact, bool touches, double *v_wall,
                     FixMeshSurface *fix_mesh, int mesh_number, TriMesh *mesh, int triangle) override {
    const LAMMPS_NS::VelocitiesOfStep velocities(engine_, contact.i);
    report_.of_contact(*wall, contact, {fix_mesh, mesh, triangle, v_wall}, [&](FixMeshSurface *told) {
      Base::compute_force(wall, contact, touches, v_wall, told, mesh_number, mesh, triangle);
    });
  }

private:
  LAMMPS *engine_;
  drumlin::WallReport report_;
};

template <class Models>
void add_combination() {
  LIGGGHTS::PairStyles::Factory::instance().addStyle(
      "gran", Models::number,
      [](LAMMPS *lmp, PairGran *parent, int64_t hash) -> LIGGGHTS::PairStyles::IGranularPairStyle * {
        return new TransitionPair<Models>(lmp, parent, hash);
      });
  LIGGGHTS::Walls::Factory::instance().addStyle(
      "gran", Models::number,
      [](LAMMPS *lmp, FixWallGran *parent, int64_t hash) -> LIGGGHTS::Walls::IGranularWall * {
        return new TransitionWall<Models>(lmp, parent, hash);
      });
}

template <class Contact, drumlin::FrictionModel tangential, drumlin::physics::Cap cap>
void add_rolling_combinations() {
  add_combination<drumlin::Combination<Contact, tangential, cap, false>>();
  add_combination<drumlin::Combination<Contact, tangential, cap, true>>();
}

/// A model that decks can name besides the normal model.
struct NamedModel : drumlin::NumberedModel {
  bool combined;                ///< whether the plugin combines it with its laws
  const char *replacement = ""; ///< behind the allowed names in the error text
};

/// The models of one kind.
struct KindOfModel {
  const char *keyword;
  int place; ///< the bit of a combination's number at which the model's number begins
  std::vector<NamedModel> models;

  int number_in(int64_t combination) const { return static_cast<int>(combination >> place & 63); }
  const NamedModel &model_in(int64_t combination) const {
    return *std::find_if(models.begin(), models.end(),
                         [&](const NamedModel &model) { return model.number == number_in(combination); });
  }
  std::string allowed() const {
    std::vector<std::string> names;
    for (const NamedModel &model : models)
      if (model.combined) names.emplace_back(model.name);
    return drumlin::join_choices(names);
  }
};

/// All models that the engine's decks can name besides the normal model.
inline std::array<KindOfModel, 4> kinds_of_models() {
  return {{{"tangential",
            6,
            {{drumlin::no_model, true},
             {drumlin::tangential_history, true},
             {drumlin::tangential_coulomb, true},
             {{1, "no_history"}, false, ", of which coulomb replaces no_history"},
             {{4, "tan_luding"}, false}}},
           {"cohesion",
            12,
            {{drumlin::no_model, true},
             {{1, "sjkr"}, false},
             {{2, "sjkr2"}, false},
             {{7, "washino/capillary/viscous"}, false},
             {{8, "easo/capillary/viscous"}, false}}},
           {"rolling_friction",
            18,
            {{drumlin::no_model, true},
             {drumlin::rolling_epsd2, true},
             {{1, "cdt"}, false, ", of which epsd2 replaces cdt"},
             {{2, "epsd"}, false},
             {{4, "epsd3"}, false},
             {{6, "luding"}, false}}},
           {"surface",
            24,
            {{{0, "default"}, true}, {{2, "multicontact"}, false}, {{5, "superquadric"}, false}}}}};
}

/// Ends the run with a line that names the first model of a combination that the plugin does not have.
template <class Contact>
void refuse(LAMMPS *engine, const char *command, int64_t combination) {
  for (const KindOfModel &kind : kinds_of_models()) {
    const NamedModel &model = kind.model_in(combination);
    if (!model.combined)
      engine->error->all(FLERR,
                         drumlin::engine::error_text(std::string(command) + " model " + Contact::name +
                                                     ": keyword " + kind.keyword + " is '" + model.name +
                                                     "'; allowed: " + kind.allowed() + model.replacement));
  }
}

/// Makes the engine call refuse() for the combinations of a law with models that the plugin does not have.
template <class Contact>
void refuse_other_combinations() {
  std::vector<int> all{drumlin::normal_model_number<Contact>}, refused; // 30 bits each
  for (const KindOfModel &kind : kinds_of_models()) {
    std::vector<int> longer;
    for (const int combination : all)
      for (const NamedModel &model : kind.models)
        longer.push_back(combination | model.number << kind.place);
    all.swap(longer);
  }
  std::copy_if(all.begin(), all.end(), std::back_inserter(refused), [](int combination) {
    const auto &kinds = kinds_of_models();
    return std::any_of(kinds.begin(), kinds.end(),
                       [&](const KindOfModel &kind) { return !kind.model_in(combination).combined; });
  });
  for (const int combination : refused) {
    LIGGGHTS::PairStyles::Factory::instance().addStyle(
        "gran", combination,
        [](LAMMPS *lmp, PairGran *, int64_t number) -> LIGGGHTS::PairStyles::IGranularPairStyle * {
          refuse<Contact>(lmp, "pair_style gran", number);
          return nullptr;
        });
    LIGGGHTS::Walls::Factory::instance().addStyle(
        "gran", combination,
        [](LAMMPS *lmp, FixWallGran *, int64_t number) -> LIGGGHTS::Walls::IGranularWall * {
          refuse<Contact>(lmp, "fix wall/gran", number);
          return nullptr;
        });
  }
}

} // namespace detail

template <class Contact>
void add_law() {
  LIGGGHTS::ContactModels::Factory::instance().addNormalModel(Contact::name, normal_model_number<Contact>);
  using physics::Cap;
  detail::add_rolling_combinations<Contact, FrictionModel::none, Cap::spring>();
  detail::add_rolling_combinations<Contact, FrictionModel::history, Cap::spring>();
  detail::add_rolling_combinations<Contact, FrictionModel::history, Cap::coulomb>();
  detail::refuse_other_combinations<Contact>();
}

} // namespace drumlin
