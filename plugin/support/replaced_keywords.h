#pragma once
// Keywords of the engines' own contact laws, and what does the same here. A deck that only exchanges the name of the law has them.

#include <string>

namespace drumlin {

/// How an engine's adapter takes what the engines' own laws have keywords for.
struct DropInForms {
  const char *coefficient; ///< a dashpot coefficient, N s/m
  const char *ratio;       ///< a damping ratio
  const char *no_tangential_dashpot;
  const char *tangential_stiffness; ///< kt, N/m
};

/// What does the same here as a keyword of the engines' own laws, for an error's "allowed:"; empty for another word.
inline std::string in_its_place(const std::string &keyword, const DropInForms &here) {
  const auto quoted = [&keyword](const char *value) { return "'" + keyword + " " + value + "'"; };
  if (keyword == "limitForce")
    return "transition B in place of " + quoted("on") + ", transition A in place of " + quoted("off");
  if (keyword == "limit_damping") return "transition B in place of it, transition A where it is not given";
  if (keyword == "absolute_damping")
    return here.coefficient + (" in place of " + quoted("on") + ", ") + here.ratio + " in place of " +
           quoted("off");
  if (keyword == "viscous") return std::string(here.ratio) + " or " + here.coefficient;
  if (keyword == "tangential_damping")
    return here.no_tangential_dashpot +
           (" in place of " + quoted("off") + ", no word in place of " + quoted("on"));
  if (keyword == "ktToKnUser") return here.tangential_stiffness;
  if (keyword == "tangential_reduce" || keyword == "limitLiquidContent")
    return "no word in its place: there is no cohesion";
  if (keyword == "computeElasticPotential" || keyword == "computeDissipatedEnergy")
    return "the energies of fix roller/history in place of it";
  return {};
}

/// The text behind "COMMAND: " for a keyword that is unknown. \param allowed the keywords there are
inline std::string unknown_keyword(const std::string &keyword, const DropInForms &here,
                                   const std::string &allowed) {
  const std::string place = in_its_place(keyword, here);
  return "unknown keyword '" + keyword + "'; allowed: " + (place.empty() ? allowed : place);
}

} // namespace drumlin
