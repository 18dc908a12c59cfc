#include "liggghts/model_settings.h"

#include "contact/contact_settings.h"
#include "support/arguments.h"
#include "support/replaced_keywords.h"

namespace drumlin {
namespace {

constexpr DropInForms drop_in_forms = {"damping coefficient with property gamman_abs",
                                       "damping ratio with property dampingRatio", "property gammat_abs of 0",
                                       "property kt"};

} // namespace

ModelSettings::ModelSettings(LAMMPS_NS::Error *error, const std::string &command, bool rolls, int narg,
                             char **arg) {
  std::vector<std::string> keywords = common_keywords();
  ContactSettings settings;
  const auto add = [this](const char *word, bool on) {
    words_.insert(words_.end(), {word, on ? "on" : "off"});
  };
  if (rolls) keywords.emplace_back("torsionTorque");

  Arguments in(error, command, narg, arg);
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (read_setting(in, keyword, settings)) continue;
    if (keyword == "torsionTorque" && rolls) {
      add("torsionTorque", in.choice("keyword " + keyword, {"on", "off"}) == 0);
    } else if (keyword == "tangential" || keyword == "rolling_friction" || keyword == "cohesion" ||
               keyword == "surface" || keyword == "primitive" || keyword == "mesh") {
      in.fail("'" + keyword +
              "' comes too late or lacks its value; allowed: models first, for a wall then primitive or "
              "mesh, then " +
              join_choices(keywords));
    } else {
      in.fail(unknown_keyword(keyword, drop_in_forms, join_choices(keywords)));
    }
  }
  add("transition_A", settings.transition == physics::Transition::A);
  add("damping_coefficient", settings.damping == DampingInput::coefficient);
  add("damping_restitution", settings.damping == DampingInput::restitution);
  add("stepping_stock", settings.stock);
  for (std::string &word : words_)
    pointers_.push_back(word.data());
}

} // namespace drumlin
