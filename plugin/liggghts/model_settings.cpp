#include "liggghts/model_settings.h"

#include "support/arguments.h"
#include "support/replaced_keywords.h"

namespace drumlin {
namespace {

constexpr DropInForms drop_in_forms = {"damping coefficient with property gamman_abs",
                                       "damping ratio with property dampingRatio", "property gammat_abs of 0",
                                       "property kt"};

} // namespace

ModelSettings::ModelSettings(LAMMPS_NS::Error *error, const std::string &command,
                             const Companions &companions, int narg, char **arg) {
  std::vector<std::string> keywords = {"transition", "damping", "stepping"};
  if (companions.rolling) keywords.emplace_back("torsionTorque");

  Arguments in(error, command, narg, arg);
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "transition") {
      words_.insert(words_.end(),
                    {"transition_A", in.choice("keyword " + keyword, {"A", "B"}) == 0 ? "on" : "off"});
    } else if (keyword == "damping") {
      words_.insert(words_.end(),
                    {"damping_coefficient",
                     in.choice("keyword " + keyword, {"coefficient", "ratio"}) == 0 ? "on" : "off"});
    } else if (keyword == "stepping") {
      words_.insert(words_.end(), {"stepping_stock",
                                   in.choice("keyword " + keyword, {"stock", "second"}) == 0 ? "on" : "off"});
    } else if (keyword == "torsionTorque" && companions.rolling) {
      words_.insert(words_.end(),
                    {keyword, in.choice("keyword " + keyword, {"on", "off"}) == 0 ? "on" : "off"});
    } else if (keyword == "tangential" || keyword == "rolling_friction" || keyword == "cohesion" ||
               keyword == "surface" || keyword == "primitive" || keyword == "mesh") {
      in.fail(
          "'" + keyword +
          "' comes too late or lacks its value; allowed: models first, for a wall then primitive or mesh, "
          "then " +
          join_choices(keywords));
    } else {
      in.fail(unknown_keyword(keyword, drop_in_forms, join_choices(keywords)));
    }
  }
  for (const auto &[word, given] : {std::pair{"tangential_spring", companions.tangential_spring},
                                    std::pair{"tangential_dashpot", companions.tangential_dashpot},
                                    std::pair{"rolling_spring", companions.rolling_spring}})
    words_.insert(words_.end(), {word, given ? "on" : "off"});
  for (std::string &word : words_)
    pointers_.push_back(word.data());
}

} // namespace drumlin
