#pragma once
// Keywords of the engines' own contact laws, and what replaces them in the plugin's. A deck in which only the
// name of the law was exchanged still has them.

#include <string>

namespace drumlin {

/// How decks of an engine set for the plugin's law the properties that the engines' own laws set by keywords.
struct DropInForms {
  const char *coefficient;           ///< a dashpot coefficient, N s/m
  const char *ratio;                 ///< a damping ratio
  const char *no_tangential_dashpot; ///< friction without a dashpot
  const char *tangential_stiffness;  ///< kt, N/m
};

/// What replaces a keyword of the engines' own laws, for an error's "allowed:"; empty for a word that is no
/// such keyword.
inline std::string replacement_of(const std::string &keyword, const DropInForms &here) {
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

/// The error text, behind "COMMAND: ", for a keyword that the command does not have. \param allowed the
/// keywords that it has
inline std::string unknown_keyword(const std::string &keyword, const DropInForms &here,
                                   const std::string &allowed) {
  const std::string replacement = replacement_of(keyword, here);
  return "keyword is '" + keyword + "'; allowed: " + (replacement.empty() ? allowed : replacement);
}

} // namespace drumlin
