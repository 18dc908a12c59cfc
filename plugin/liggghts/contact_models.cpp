// The contact models that the plugin adds to LIGGGHTS: the contact laws as normal models, the tangential
// model coulomb and a rolling model, in combination with the engine's own models, for pairs and walls.

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
#include "contact/fix_stepping.h"
#include "liggghts/pair_source.h"
#include "liggghts/fix_keep_history.h"
#include "liggghts/model_settings.h"
#include "liggghts/observed_contact.h"
#include "liggghts/loop_adapter.h"
#include "liggghts/registration.h"
#include "liggghts/wall_report.h"
#include "support/arguments.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <vector>

namespace {

using namespace LIGGGHTS::ContactModels; // NOLINT: the engine's model constants
using LAMMPS_NS::FixMeshSurface;
using LAMMPS_NS::FixWallGran;
using LAMMPS_NS::LAMMPS;
using LAMMPS_NS::PairGran;
using LAMMPS_NS::TriMesh;

// The layout of the contact data in Debian's binary, which is built without superquadrics.
static_assert(sizeof(SurfacesIntersectData) == 368,
              "contact data of this LIGGGHTS differ from the stock binary's");

/// Whether a combination keeps a tangential spring or a rolling torque as contact history, which has to be
/// reset when the contact ends, as what a law remembers has.
template <class Style>
constexpr bool has_springs = drumlin::has_spring<Style> || Style::ROLLING == ROLLING_SPRING;

template <class Style>
constexpr drumlin::OtherModels other_models{drumlin::has_spring<Style>, Style::ROLLING == ROLLING_SPRING,
                                            Style::ROLLING != ROLLING_OFF};

/// Prepares the engine for a combination, before that reads its properties.
template <class Style, class Contact>
void prepare(LAMMPS *engine) {
  if (has_springs<Style> || Contact::remembers)
    engine->neighbor->register_contact_dist_factor(drumlin::contact_distance_factor);
  if (Style::TANGENTIAL != TANGENTIAL_OFF)
    drumlin::provide_friction_default(engine, std::string("model ") + Contact::name, engine->atom->ntypes);
}

template <class Style, class Contact>
class TransitionPair : public LIGGGHTS::PairStyles::Granular<drumlin::ObservedContact<Style, Contact>>,
                       public drumlin::PairSource {
  using Base = LIGGGHTS::PairStyles::Granular<drumlin::ObservedContact<Style, Contact>>;

public:
  TransitionPair(LAMMPS *engine, PairGran *pair, int64_t hash)
      : Base(engine, pair, hash), PairSource(engine), engine_(engine), pair_(pair) {}
  ~TransitionPair() override { LAMMPS_NS::FixStepping::dismiss(engine_); }

  void settings(int narg, char **arg, LIGGGHTS::IContactHistorySetup *history) override {
    drumlin::ModelSettings words(engine_->error, command(), other_models<Style>, narg, arg);
    torsion_ = words.has("torsionTorque", "on");
    LAMMPS_NS::FixKeepHistory::provide(engine_);
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
    prepare<Style, Contact>(engine_);
    stepping_ =
        this->get_history_offset(drumlin::force_name) < 0 ? nullptr : LAMMPS_NS::FixStepping::find(engine_);
    drumlin::ContactSettings settings;
    settings.tangential =
        drumlin::has_spring<Style> ? drumlin::FrictionModel::history : drumlin::FrictionModel::none;
    settings.cap = Style::TANGENTIAL == TANGENTIAL_COULOMB ? drumlin::physics::Cap::coulomb
                                                           : drumlin::physics::Cap::spring;
    settings.rolling = Style::ROLLING == ROLLING_SPRING;
    settings.stock = stepping_ == nullptr;
    settings.take_law<Contact>();
    PairSource::begin(pair_, settings);
    Base::init_granular();
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
    if ((has_springs<Style> || Contact::remembers || stepping_ != nullptr ||
         pair->listgranhistory == nullptr) &&
        !torsion_ &&
        !drumlin::needs_engine_loop(*pair, *engine_->modify, eflag != 0 || vflag != 0, adds != 0)) {
      pair->evflag = pair->vflag_fdotr = 0;
      return stepping_ == nullptr ? compute_contacts<false>() : compute_contacts<true>();
    }
    loop_memory_.pairs.forget();
    Base::compute_force(pair, eflag, vflag, adds);
  }

private:
  template <bool stepped>
  void compute_contacts() {
    constexpr bool rubs = Style::TANGENTIAL != TANGENTIAL_OFF, rolls = Style::ROLLING != ROLLING_OFF;
    constexpr int flag =
        CONTACT_NORMAL_MODEL | (rubs ? CONTACT_TANGENTIAL_MODEL : 0) | (rolls ? CONTACT_ROLLING_MODEL : 0);
    if (pair_->list->inum == 0) return; // there may be no arrays
    drumlin::LoopAdapter<Contact, stepped,
                         rubs ? drumlin::FrictionModel::history : drumlin::FrictionModel::none, rolls, flag>(
        *pair_, *engine_->atom, *engine_->neighbor, clumps_)
        .compute(loop_memory_, *std::get<const drumlin::CoefficientTable<Contact> *>(table()), places(),
                 cap(), stepping_, observers_, engine_->update->dt);
  }

  static std::string command() { return std::string("pair_style gran model ") + Contact::name; }

  LAMMPS *engine_;
  PairGran *pair_;
  LAMMPS_NS::FixStepping *stepping_ = nullptr; // none under stock stepping
  drumlin::LoopMemory loop_memory_;
  drumlin::ContactObservers observers_;
  drumlin::DeckCheck deck_check_;
  LAMMPS_NS::Clumps clumps_;
  bool torsion_ = false; // whether rolling resistance also resists torsion
};

template <class Style, class Contact>
class TransitionWall : public LIGGGHTS::Walls::Granular<drumlin::ObservedContact<Style, Contact>> {
  using Base = LIGGGHTS::Walls::Granular<drumlin::ObservedContact<Style, Contact>>;

public:
  TransitionWall(LAMMPS *engine, FixWallGran *wall, int64_t hash)
      : Base(engine, wall, hash), engine_(engine) {}

  void settings(int narg, char **arg, LIGGGHTS::IContactHistorySetup *history) override {
    const std::string command = std::string("fix wall/gran model ") + Contact::name;
    drumlin::ModelSettings words(engine_->error, command, other_models<Style>, narg, arg);
    Base::settings(words.size(), words.words(), history);
  }

  void init_granular() override {
    prepare<Style, Contact>(engine_);
    Base::init_granular();
    report_.begin(*engine_, *this);
  }

  void compute_force(FixWallGran *wall, SurfacesIntersectData &contact, bool touches, double *v_wall,
                     FixMeshSurface *fix_mesh, int mesh_number, TriMesh *mesh, int triangle) override {
    report_.of_contact(*wall, contact, {fix_mesh, mesh, triangle, v_wall}, [&](FixMeshSurface *told) {
      Base::compute_force(wall, contact, touches, v_wall, told, mesh_number, mesh, triangle);
    });
  }

private:
  LAMMPS *engine_;
  drumlin::WallReport report_;
};

/// \tparam TangentialWord, RollingWord the models whose names in a deck mean this combination
template <class Contact, int Tangential, int TangentialWord, int Rolling, int RollingWord = Rolling>
void add_combination() {
  constexpr int normal = drumlin::normal_model_number<Contact>;
  using Style = drumlin::NamedStyle<
      GranStyle<normal, Tangential, COHESION_OFF, Rolling, SURFACE_DEFAULT>,
      GranStyle<normal, TangentialWord, COHESION_OFF, RollingWord, SURFACE_DEFAULT>::HASHCODE>;
  LIGGGHTS::PairStyles::Factory::instance().addStyle(
      "gran", Style::HASHCODE,
      [](LAMMPS *lmp, PairGran *parent, int64_t hash) -> LIGGGHTS::PairStyles::IGranularPairStyle * {
        return new TransitionPair<Style, Contact>(lmp, parent, hash);
      });
  LIGGGHTS::Walls::Factory::instance().addStyle(
      "gran", Style::HASHCODE,
      [](LAMMPS *lmp, FixWallGran *parent, int64_t hash) -> LIGGGHTS::Walls::IGranularWall * {
        return new TransitionWall<Style, Contact>(lmp, parent, hash);
      });
}

template <class Contact, int Tangential, int Word = Tangential>
void add_rolling_combinations() {
  add_combination<Contact, Tangential, Word, ROLLING_OFF>();
  add_combination<Contact, Tangential, Word, ROLLING_SPRING, ROLLING_EPSD2>();
}

/// A model as a deck names it, and its number among those of its kind.
struct NamedModel {
  int number;
  const char *name;
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
const std::array<KindOfModel, 4> &kinds_of_models() {
  static const std::array<KindOfModel, 4> kinds{
      {{"tangential",
        6,
        {{TANGENTIAL_OFF, "off", true},
         {TANGENTIAL_HISTORY, "history", true},
         {TANGENTIAL_COULOMB, "coulomb", true},
         {1, "no_history", false, ", of which coulomb replaces no_history"},
         {4, "tan_luding", false}}},
       {"cohesion",
        12,
        {{COHESION_OFF, "off", true},
         {1, "sjkr", false},
         {2, "sjkr2", false},
         {7, "washino/capillary/viscous", false},
         {8, "easo/capillary/viscous", false}}},
       {"rolling_friction",
        18,
        {{ROLLING_OFF, "off", true},
         {ROLLING_EPSD2, "epsd2", true},
         {1, "cdt", false, ", of which epsd2 replaces cdt"},
         {2, "epsd", false},
         {4, "epsd3", false},
         {6, "luding", false}}},
       {"surface",
        24,
        {{SURFACE_DEFAULT, "default", true}, {2, "multicontact", false}, {5, "superquadric", false}}}}};
  return kinds;
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

template <class Contact>
void add_law() {
  Factory::instance().addNormalModel(Contact::name, drumlin::normal_model_number<Contact>);
  add_rolling_combinations<Contact, TANGENTIAL_OFF>();
  add_rolling_combinations<Contact, TANGENTIAL_SPRING, TANGENTIAL_HISTORY>();
  add_rolling_combinations<Contact, TANGENTIAL_COULOMB>();
  refuse_other_combinations<Contact>();
}

} // namespace

void drumlin::add_contact_models() {
  // The engine's list of models is one for all instances in the process.
  if (Factory::instance().getTangentialModelId("coulomb") == TANGENTIAL_COULOMB) return;
  Factory::instance().addTangentialModel("coulomb", TANGENTIAL_COULOMB);
  for_each_law([](auto law) { add_law<typename decltype(law)::type>(); });
}
