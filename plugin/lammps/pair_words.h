#pragma once
// Words of pair_style gran/hooke/transition and pair_coeff, checked.

#include "support/arguments.h"
#include "support/replaced_keywords.h"
#include "contact/contact_settings.h"

namespace drumlin {

constexpr DropInForms drop_in_forms = {"damping coefficient with c in pair_coeff",
                                       "damping ratio with D in pair_coeff", "ct of 0 in pair_coeff",
                                       "kt in pair_coeff"};

/// Keywords up to the end.
inline ContactSettings read_settings(Arguments &in) {
  ContactSettings settings;
  std::vector<std::string> keywords = common_keywords();
  keywords.insert(keywords.end(), {"tangential", "cap"});
  bool coulomb = false;
  std::string cap; // as given
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    const std::string what = "keyword " + keyword;
    if (read_setting(in, keyword, settings)) continue;
    if (keyword == "tangential") {
      const int model = in.choice(what, {"off", "no_history", "history", "coulomb"});
      coulomb = model == 3;
      settings.tangential = coulomb ? FrictionModel::history : static_cast<FrictionModel>(model);
    } else if (keyword == "cap")
      cap = in.choice(what, {"spring", "total"}) == 0 ? "spring" : "total";
    else if (keyword == "NULL" || std::isfinite(parse_number(keyword)))
      in.fail("'" + keyword +
              "' is no keyword; allowed: numbers in pair_coeff, which is I J k damping [mu [kt [ct]]]");
    else
      in.fail(unknown_keyword(keyword, drop_in_forms, join_choices(keywords)));
  }
  if (coulomb && !cap.empty())
    in.fail("keyword cap is '" + cap +
            "'; allowed: no cap with tangential coulomb, which limits spring and dashpot together");
  settings.cap = coulomb           ? physics::Cap::coulomb
                 : cap == "spring" ? physics::Cap::spring
                                   : physics::Cap::total;
  return settings;
}

/// k, damping and, with friction, mu and at will kt and ct up to the end.
inline ContactCoefficients read_coefficients(Arguments &in, const ContactSettings &settings) {
  const double stiffness = in.number("normal stiffness k", Range::positive);
  const bool restitution = settings.damping == DampingInput::restitution;
  const std::string word = in.empty() ? "" : in.peek();
  const double damping = in.number(restitution                               ? "restitution e"
                                   : settings.damping == DampingInput::ratio ? "damping ratio D"
                                                                             : "damping coefficient c",
                                   restitution ? Range::positive : Range::non_negative);
  if (restitution && damping > 1.0)
    in.fail("restitution e is '" + word + "'; allowed: a finite number > 0 and <= 1");
  ContactCoefficients p = ContactCoefficients::with_defaults(settings.normal(stiffness, damping));
  if (settings.tangential != FrictionModel::none) {
    p.friction = in.number("friction coefficient mu", Range::non_negative);
    const auto next_is_given = [&in](const char *what) {
      if (in.empty()) return false;
      if (in.peek() != "NULL") return true;
      in.word(what);
      return false;
    };
    if (next_is_given("tangential stiffness kt"))
      p.tangential_stiffness = in.number("tangential stiffness kt", Range::positive);
    if (next_is_given("tangential damping ct"))
      p.set_tangential_damping(in.number("tangential damping coefficient ct", Range::non_negative));
  }
  if (!in.empty())
    in.fail("'" + in.peek() + "' is left over; allowed: I J k damping" +
            (settings.tangential == FrictionModel::none ? "; friction needs keyword tangential of pair_style"
                                                        : " mu [kt|NULL [ct|NULL]]"));
  return p;
}

} // namespace drumlin
