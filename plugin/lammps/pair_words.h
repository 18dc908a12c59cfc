#pragma once
// Words of the pair styles and of pair_coeff, checked.

#include "support/arguments.h"
#include "support/replaced_keywords.h"
#include "contact/contact_settings.h"

#include <array>
#include <fmt/format.h>
#include <string>
#include <vector>

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
  if (in.empty() || in.peek() == "rolling" || in.peek() == "suction") return false;
  if (in.peek() != "NULL") return true;
  in.word(what);
  return false;
}

/// The words of pair_coeff for a law, which follow from the table of its parameters, for error texts.
template <class Contact>
struct LawWords {
  static std::string of_pair() {
    std::string words;
    for (const auto &p : Contact::parameters())
      if (!p.of_friction) words += std::string(" ") + p.word;
    return words;
  }
  static std::string of_material() {
    std::string words;
    for (const physics::MaterialParameter &p : Contact::material())
      words += std::string(" ") + p.word;
    return words;
  }
  static bool has_material() { return Contact::material().size() > 0; }
  /// What stands before the damping.
  static std::string stiffness() { return has_material() ? of_material() : of_pair(); }
  /// The forms of a line up to the damping, each with an end.
  static std::string forms(const std::string &end) {
    const std::string own = "I J" + stiffness() + " damping" + end;
    return has_material() ? own + " or I J effective" + of_pair() + " damping" + end : own;
  }
  static std::string all() {
    std::string friction = "[ct]", close;
    for (const auto &p : Contact::parameters())
      if (p.of_friction) {
        friction = fmt::format("[{} {}", p.word, friction);
        close += "]";
      }
    return forms(" [mu " + friction + close + "] [rolling mu_r] [suction F_a]");
  }
  static std::string behind_friction() {
    std::string friction = "[ct|NULL", close = "]";
    for (const auto &p : Contact::parameters())
      if (p.of_friction) {
        friction = fmt::format("[{}|NULL {}", p.word, friction);
        close += "]";
      }
    return (has_material() ? ", then mu " : " mu ") + friction + close;
  }
};

/// Reads a parameter of a law.
template <class Parameter>
double read_parameter(Arguments &in, const Parameter &p) {
  return in.number(std::string(p.name) + " " + p.word, p.range);
}

/// What stands before the damping: numbers of the materials, the same for both bodies, or after the word
/// `effective` those of the pair; of a law without materials those of the pair.
template <class Contact>
void read_before_damping(Arguments &in, Contact &contact) {
  if constexpr (constexpr std::size_t numbers = Contact::material().size(); numbers > 0) {
    if (in.empty() || in.peek() != "effective") {
      std::array<double, numbers> values{};
      for (std::size_t n = 0; n < numbers; ++n)
        values[n] = read_parameter(in, Contact::material()[n]);
      contact.set_material(values, values);
      return contact.set_defaults();
    }
    in.word("effective");
  }
  for (const auto &p : Contact::parameters())
    if (!p.of_friction) contact.*p.value = read_parameter(in, p);
  contact.set_defaults();
}

/// What a restart file stores, in this order.
template <class Contact>
std::vector<double *> restart_numbers(ContactCoefficients<Contact> &p) {
  std::vector<double *> numbers, of_friction;
  for (const auto &one : Contact::parameters())
    (one.of_friction ? of_friction : numbers).push_back(&(p.contact.*one.value));
  numbers.insert(numbers.end(), {&p.contact.damping, &p.friction});
  numbers.insert(numbers.end(), of_friction.begin(), of_friction.end());
  numbers.insert(numbers.end(), {&p.tangential_damping, &p.tangential_damping_share});
  return numbers;
}

/// Damping, N s/m, D or e, of a contact whose other parameters are read.
template <class Contact>
double read_damping(Arguments &in, const ContactSettings &settings, const Contact &contact) {
  return in.number(settings.damping == DampingInput::restitution ? "restitution e"
                   : settings.damping == DampingInput::ratio     ? "damping ratio D"
                                                                 : "damping coefficient c",
                   settings.damping_range(contact));
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
/// rolling resistance `rolling mu_r`, and at will `suction F_a`, up to the end.
template <class Parameters>
ContactCoefficients<Parameters> read_coefficients(Arguments &in, const ContactSettings &settings) {
  using Words = LawWords<Parameters>;
  ContactCoefficients<Parameters> p;
  read_before_damping(in, p.contact);
  settings.set_damping(p.contact, read_damping(in, settings, p.contact));
  if (settings.tangential != FrictionModel::none) {
    p.friction = in.number("friction coefficient mu", Range::non_negative);
    for (const auto &one : Parameters::parameters())
      if (one.of_friction && next_is_given(in, one.name)) p.contact.*one.value = read_parameter(in, one);
    if (next_is_given(in, "tangential damping ct"))
      p.set_tangential_damping(in.number("tangential damping coefficient ct", Range::non_negative));
  }
  p.rolling = read_rolling(in, settings);
  if (!in.empty() && in.peek() == "suction") {
    in.word("suction");
    p.suction = in.number("suction F_a", Range::non_negative);
  }
  const bool rubs = settings.tangential != FrictionModel::none;
  if (!in.empty())
    in.fail("'" + in.peek() + "' is left over; allowed: " + Words::forms("") +
            (rubs ? Words::behind_friction() : "") + (settings.rolling ? " rolling mu_r" : "") +
            " [suction F_a]" + (rubs ? "" : "; friction needs keyword tangential of pair_style"));
  return p;
}

} // namespace drumlin
