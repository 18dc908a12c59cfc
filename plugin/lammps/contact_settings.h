#pragma once
// Words of pair_style gran/hooke/transition and pair_coeff, checked.

#include "support/arguments.h"
#include "support/replaced_keywords.h"
#include "lammps/contact_terms.h"

namespace drumlin {

constexpr DropInForms drop_in_forms = {"damping coefficient with c in pair_coeff",
                                       "damping ratio with D in pair_coeff", "ct of 0 in pair_coeff",
                                       "kt in pair_coeff"};

/// Keywords up to the end.
inline ContactSettings read_settings(Arguments &in) {
  ContactSettings settings;
  bool coulomb = false;
  std::string cap; // as given
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    const std::string what = "keyword " + keyword;
    if (keyword == "transition")
      settings.transition =
          in.choice(what, {"A", "B"}) == 0 ? physics::Transition::A : physics::Transition::B;
    else if (keyword == "damping")
      settings.damping = in.choice(what, {"coefficient", "ratio"}) == 0 ? physics::Damping::coefficient
                                                                        : physics::Damping::ratio;
    else if (keyword == "stepping")
      settings.stock = in.choice(what, {"second", "stock"}) == 1;
    else if (keyword == "tangential") {
      const int model = in.choice(what, {"off", "no_history", "history", "coulomb"});
      coulomb = model == 3;
      settings.tangential = coulomb ? FrictionModel::history : static_cast<FrictionModel>(model);
    } else if (keyword == "cap")
      cap = in.choice(what, {"spring", "total"}) == 0 ? "spring" : "total";
    else if (keyword == "NULL" || std::isfinite(parse_number(keyword)))
      in.fail("'" + keyword +
              "' is no keyword; allowed: numbers in pair_coeff, which is I J k damping [mu [kt [ct]]]");
    else
      in.fail(unknown_keyword(keyword, drop_in_forms, "transition, damping, stepping, tangential or cap"));
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
  ContactCoefficients p;
  p.normal.stiffness = in.number("normal stiffness k", Range::positive);
  p.normal.damping =
      in.number(settings.damping == physics::Damping::ratio ? "damping ratio D" : "damping coefficient c",
                Range::non_negative);
  p.normal.damping_kind = settings.damping;
  p.normal.transition = settings.transition;
  p.tangential_stiffness = 2.0 / 7.0 * p.normal.stiffness;
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
    if (next_is_given("tangential damping ct")) {
      p.tangential_damping = in.number("tangential damping coefficient ct", Range::non_negative);
      p.tangential_damping_share = 0.0;
    }
  }
  if (!in.empty())
    in.fail("'" + in.peek() + "' is left over; allowed: I J k damping" +
            (settings.tangential == FrictionModel::none ? "; friction needs keyword tangential of pair_style"
                                                        : " mu [kt|NULL [ct|NULL]]"));
  return p;
}

} // namespace drumlin
