#pragma once
// Words of the pair styles and of pair_coeff, checked.

#include "support/arguments.h"
#include "support/replaced_keywords.h"
#include "contact/contact_settings.h"

#include <array>

namespace drumlin {

constexpr DropInForms drop_in_forms = {"damping coefficient with c in pair_coeff",
                                       "damping ratio with D in pair_coeff", "ct of 0 in pair_coeff",
                                       "kt in pair_coeff"};

/// Keywords up to the end.
/// \param pair_coeff the words of pair_coeff, for error texts
inline ContactSettings read_settings(Arguments &in, const std::string &pair_coeff) {
  ContactSettings settings;
  std::vector<std::string> keywords = common_keywords();
  keywords.insert(keywords.end(), {"tangential", "cap", "rolling"});
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
    } else if (keyword == "rolling")
      settings.rolling = in.choice(what, {"off", "epsd2"}) == 1;
    else if (keyword == "cap")
      cap = in.choice(what, {"spring", "total"}) == 0 ? "spring" : "total";
    else if (keyword == "NULL" || std::isfinite(parse_number(keyword)))
      in.fail(
          ("'" + keyword + "' is no keyword; allowed: numbers in pair_coeff, which is ").append(pair_coeff));
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

/// Whether a number follows; NULL in its place is read. \param what for error texts
inline bool next_is_given(Arguments &in, const char *what) {
  if (in.empty() || in.peek() == "rolling") return false;
  if (in.peek() != "NULL") return true;
  in.word(what);
  return false;
}

/// What pair_coeff gives of the parameters of a law, but its damping. Each law has its own specialization.
template <class Parameters>
struct LawWords;

template <>
struct LawWords<physics::LinearContact> {
  static constexpr const char *stiffness = "k";
  static constexpr const char *all = "I J k damping [mu [kt [ct]]] [rolling mu_r]";
  static constexpr const char *before_friction = "I J k damping";
  static constexpr const char *behind_friction = " mu [kt|NULL [ct|NULL]]";

  /// What stands before the damping.
  static void read(Arguments &in, physics::LinearContact &p) {
    p.stiffness = in.number("normal stiffness k", Range::positive);
    p.tangential_stiffness = default_tangential_stiffness(p.stiffness);
  }
  /// What stands behind the friction coefficient, but ct.
  static void read_tangential(Arguments &in, physics::LinearContact &p) {
    if (next_is_given(in, "tangential stiffness kt"))
      p.tangential_stiffness = in.number("tangential stiffness kt", Range::positive);
  }
  /// What a restart file stores, in this order.
  static std::array<double *, 6> numbers(ContactCoefficients<physics::LinearContact> &p) {
    return {&p.contact.stiffness,  &p.contact.damping,         &p.friction, &p.contact.tangential_stiffness,
            &p.tangential_damping, &p.tangential_damping_share};
  }
};

template <>
struct LawWords<physics::HertzContact> {
  static constexpr const char *stiffness = "E nu";
  static constexpr const char *all =
      "I J E nu damping [mu [ct]] [rolling mu_r] or I J effective E* G* damping [mu [ct]] [rolling mu_r]";
  static constexpr const char *before_friction = "I J E nu damping or I J effective E* G* damping";
  static constexpr const char *behind_friction = ", then mu [ct|NULL]";

  /// E and nu of two bodies of one material, or the effective moduli of two that differ.
  static void read(Arguments &in, physics::HertzContact &p) {
    if (!in.empty() && in.peek() == "effective") {
      in.word("effective");
      p.youngs_modulus = in.number("effective Young's modulus E*", Range::positive);
      p.shear_modulus = in.number("effective shear modulus G*", Range::positive);
      return;
    }
    const double E = in.number("Young's modulus E", Range::positive);
    const std::string word = in.empty() ? "" : in.peek();
    const double nu = in.number("Poisson's ratio nu");
    if (nu <= -1.0 || nu > 0.5)
      in.fail("Poisson's ratio nu is '" + word + "'; allowed: a number > -1 and <= 0.5");
    p.set_moduli(E, nu, E, nu);
  }
  /// The spring of friction follows from the moduli.
  static void read_tangential(Arguments &, physics::HertzContact &) {}
  static std::array<double *, 6> numbers(ContactCoefficients<physics::HertzContact> &p) {
    return {&p.contact.youngs_modulus, &p.contact.shear_modulus,   &p.contact.damping, &p.friction,
            &p.tangential_damping,     &p.tangential_damping_share};
  }
};

/// Damping, N s/m, D or e.
inline double read_damping(Arguments &in, const ContactSettings &settings) {
  const bool restitution = settings.damping == DampingInput::restitution;
  const std::string word = in.empty() ? "" : in.peek();
  const double damping = in.number(restitution                               ? "restitution e"
                                   : settings.damping == DampingInput::ratio ? "damping ratio D"
                                                                             : "damping coefficient c",
                                   restitution ? Range::positive : Range::non_negative);
  if (restitution && damping > 1.0)
    in.fail("restitution e is '" + word + "'; allowed: a finite number > 0 and <= 1");
  return damping;
}

/// `rolling mu_r`, needed with rolling resistance and refused without.
inline double read_rolling(Arguments &in, const ContactSettings &settings) {
  if (!settings.rolling && (in.empty() || in.peek() != "rolling")) return 0.0;
  if (!settings.rolling)
    in.fail("'rolling' is left over; allowed: no rolling without keyword rolling epsd2 of pair_style");
  const std::string what = "rolling friction coefficient mu_r";
  if (in.empty()) in.fail(what + " is missing; allowed: rolling mu_r, a finite number >= 0");
  if (in.peek() != "rolling") return 0.0; // left over: the caller says what is allowed
  in.word("rolling");
  return in.number(what, Range::non_negative);
}

/// Stiffness, damping and, with friction, mu and at will what the law has for friction and ct, then with
/// rolling resistance `rolling mu_r` up to the end.
template <class Parameters>
ContactCoefficients<Parameters> read_coefficients(Arguments &in, const ContactSettings &settings) {
  using Words = LawWords<Parameters>;
  ContactCoefficients<Parameters> p;
  Words::read(in, p.contact);
  settings.set_damping(p.contact, read_damping(in, settings));
  if (settings.tangential != FrictionModel::none) {
    p.friction = in.number("friction coefficient mu", Range::non_negative);
    Words::read_tangential(in, p.contact);
    if (next_is_given(in, "tangential damping ct"))
      p.set_tangential_damping(in.number("tangential damping coefficient ct", Range::non_negative));
  }
  p.rolling = read_rolling(in, settings);
  const bool rubs = settings.tangential != FrictionModel::none;
  if (!in.empty())
    in.fail("'" + in.peek() + "' is left over; allowed: " + Words::before_friction +
            (rubs ? Words::behind_friction : "") + (settings.rolling ? " rolling mu_r" : "") +
            (rubs ? "" : "; friction needs keyword tangential of pair_style"));
  return p;
}

} // namespace drumlin
