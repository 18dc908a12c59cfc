#include "tests/core/law_samples.h"
#include "tests/refused/refusals.h"
#include "tests/support/engine_runs.h"

namespace drumlin::test {
namespace {

/// Numbers that a range does not have.
std::vector<double> outside(const physics::Range &range) {
  std::vector<double> values = {range.least_excluded ? range.least : range.least - 1.0};
  if (std::isfinite(range.most)) values.push_back(range.most + 0.1);
  return values;
}

/// A number of friction or rolling resistance, which all laws have, in the words of both engines.
struct FrictionNumber {
  const char *property, *name;
  std::string before, behind; ///< the other numbers of pair_coeff
};

Refusal in_liggghts(const std::string &place, const std::string &pair, const std::vector<std::string> &says) {
  Refusal refusal;
  refusal.place = place;
  refusal.pair = pair;
  refusal.says = says;
  return refusal;
}

Refusal in_lammps(const std::string &place, const std::string &lines, const std::vector<std::string> &says) {
  Refusal refusal;
  refusal.place = place;
  refusal.lines = lines;
  refusal.says = says;
  refusal.lammps = true;
  return refusal;
}

/// The parameters of a law, each with values that it may not have, and left out: LIGGGHTS's properties, then
/// the words of LAMMPS.
template <class Law>
std::vector<Refusal> parameters_of() {
  const std::string law = Law::name;
  std::vector<Refusal> properties, words;
  const auto number = [](double value) { return fmt::format("{}", value); };
  const auto property_line = [](const auto &p, const std::string &given) {
    std::string text = property(p.property, given);
    if (!std::is_same_v<std::decay_t<decltype(p)>, physics::MaterialParameter>) return text;
    return fmt::format("{0} {1} {1} {1}\n", text.substr(0, text.find("pair 3")), given);
  };
  const auto mistake = [&](const auto &wrong, const std::string &value, const std::string &says) {
    std::string lines, coefficients;
    test::for_each_given<Law>(1e7, [&](const auto &p, double good) {
      const bool is_wrong = std::string(p.word) == wrong.word;
      if (may_be_left_out(p) && !is_wrong) return;
      const std::string given = is_wrong ? value : number(good);
      coefficients += (may_be_left_out(p) ? " 0.2 0.5 " : " ") + given;
      if (!given.empty()) lines += property_line(p, given);
    });
    properties.push_back(in_liggghts(std::string(wrong.property) + " " + value,
                                     "pair_style gran model " + law + "\npair_coeff * *\n" +
                                         host_properties(lines + "property/global " + wrong.property) + lines,
                                     {"model " + law + ": property " + wrong.property, says}));
    if (!value.empty())
      words.push_back(
          in_lammps(std::string(wrong.word) + " " + value,
                    "pair_style gran/" + law + " tangential coulomb\npair_coeff * *" + coefficients,
                    {"pair_coeff of gran/" + law,
                     std::string(wrong.name) + " " + wrong.word + " is '" + value + "'", says}));
  };
  test::for_each_given<Law>(1e7, [&](const auto &p, double) {
    if (!may_be_left_out(p)) mistake(p, "", std::string("(") + physics::meaning_of(p) + ") is missing");
    for (const double value : outside(p.range))
      mistake(p, number(value), physics::detail::text_of(p.range));
  });
  std::string good_lines, good_words, left_out;
  test::for_each_given<Law>(1e7, [&](const auto &p, double good) {
    if (may_be_left_out(p)) {
      left_out += " NULL";
      return;
    }
    good_lines += property_line(p, number(good));
    good_words += " " + number(good);
  });
  for (const auto &[property_name, what, before, behind] :
       {FrictionNumber{"coefficientFriction", "friction coefficient mu", " 0.2 ", " rolling 0.1"},
        FrictionNumber{"gammat_abs", "tangential damping coefficient ct", " 0.2 0.5" + left_out + " ",
                       " rolling 0.1"},
        FrictionNumber{"coefficientRollingFriction", "rolling friction coefficient mu_r", " 0.2 0.5 rolling ",
                       ""},
        FrictionNumber{"suction", "suction F_a", " 0.2 0.5 rolling 0.1 suction ", ""}}) {
    const std::string wrong = property(property_name, "-1e-9");
    const std::string roll = what == std::string("rolling friction coefficient mu_r")
                                 ? ""
                                 : property("coefficientRollingFriction", "0.1");
    properties.push_back(in_liggghts(
        std::string(property_name) + " -1e-9",
        fmt::format("pair_style gran model {} tangential coulomb rolling_friction epsd2\npair_coeff * "
                    "*\n{}{}{}{}",
                    law, host_properties(good_lines + wrong), good_lines, wrong, roll),
        {"model " + law + ": property " + property_name, "a finite number >= 0"}));
    for (const char *value : {"-1e-9", "nan", "inf"})
      words.push_back(in_lammps(
          fmt::format("{} {}", property_name, value),
          fmt::format("pair_style gran/{} tangential coulomb rolling epsd2\npair_coeff * *{}{}{}{}", law,
                      good_words, before, value, behind),
          {"pair_coeff of gran/" + law, fmt::format("{} is '{}'", what, value), "a finite number >= 0"}));
  }
  properties.insert(properties.end(), words.begin(), words.end());
  return properties;
}

} // namespace

std::vector<Refusal> law_refusals() {
  std::vector<Refusal> all;
  for_each_law([&all](auto law) {
    for (Refusal &refusal : parameters_of<typename decltype(law)::type>())
      all.push_back(std::move(refusal));
  });
  return all;
}

} // namespace drumlin::test
