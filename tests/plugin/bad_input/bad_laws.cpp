// Wrong input to the contact laws and to the walls that use them, in LIGGGHTS and in LAMMPS: the lines of a
// deck, and what the error must say.
#include "tests/plugin/bad_input/bad_input.h"
#include "tests/support/host_deck.h"
#include "tests/plugin/law_samples.h"

#include <fmt/format.h>

#include <cmath>
#include <type_traits>
#include <utility>

namespace drumlin::test {
namespace {

/// A mistake in the pair style: settings after `model hooke/transition`, then properties.
BadInput pair(const std::string &name, const std::string &settings, const std::string &properties,
              const std::vector<std::string> &says) {
  BadInput input = line(name, "", says);
  input.pair = "pair_style gran model hooke/transition " + settings + "\npair_coeff * *\n" + properties;
  return input;
}

/// A value that one property of the contact law may not have.
BadInput value(const std::string &property_name, const std::string &text, const std::string &settings = "") {
  const std::string given = property(property_name, text);
  return pair(property_name + " " + text, settings, given + host_properties(given),
              {"model hooke/transition", "property " + property_name, "types 1 and 1", "is " + text,
               "a finite number >"});
}

BadInput twice_in_a_hybrid() {
  BadInput input =
      line("twice in a hybrid", "",
           {"pair_style gran model hooke/transition: pair_style hybrid has gran more than once", "once"});
  input.pair = "pair_style hybrid gran model hooke/transition gran model hooke/transition\n"
               "pair_coeff * * gran 1\npair_coeff 3 3 gran 2\n" +
               host_properties();
  return input;
}

// Longer than other functions: it has a line for each mistake and nothing else.
BadGroup pair_style() {
  const std::string command = "pair_style gran model hooke/transition: ";
  const std::string good = host_properties();
  const std::string kn = property("kn", "1e7");
  const std::string ratio = property("dampingRatio", "0.5");
  return {
      "PairStyle",
      "",
      {
          on_two_ranks(pair("unknown transition", "transition C", good,
                            {command + "keyword transition is 'C'", "A or B"})),
          pair("small transition", "transition a", good, {command + "keyword transition is 'a'", "A or B"}),
          pair("transition without value", "transition", good,
               {command + "keyword transition is missing", "A or B"}),
          pair("unknown damping", "damping high", good,
               {command + "keyword damping is 'high'", "coefficient, ratio or restitution"}),
          pair("damping without value", "damping", good,
               {command + "keyword damping is missing", "coefficient, ratio or restitution"}),
          pair("damping as a number", "damping 0.5", good,
               {command + "keyword damping is '0.5'", "coefficient, ratio or restitution"}),
          pair("unknown stepping", "stepping third", good,
               {command + "keyword stepping is 'third'", "stock or second"}),
          pair("stepping without value", "stepping", good,
               {command + "keyword stepping is missing", "stock or second"}),
          on_two_ranks(line(
              "stress from forces that are not final",
              "fix stress all continuum/weighted kernel_radius 2 compute stress",
              {command + "stepping is 'second' and there is a fix continuum/weighted", "stepping stock"})),
          pair("unknown keyword", "limit on", good,
               {command + "keyword is 'limit'", "transition, damping or stepping"}),
          pair("the engine's limitForce", "limitForce on", good,
               {command + "keyword is 'limitForce'", "transition B in place of 'limitForce on'",
                "transition A in place of 'limitForce off'"}),
          pair("the engine's absolute_damping", "transition A absolute_damping on", good,
               {command + "keyword is 'absolute_damping'", "damping coefficient with property gamman_abs"}),
          pair("the engine's tangential_damping", "tangential_damping off", good,
               {command + "keyword is 'tangential_damping'", "property gammat_abs of 0"}),
          pair("the engine's viscous", "viscous on", good,
               {command + "keyword is 'viscous'", "damping ratio with property dampingRatio"}),
          pair("LAMMPS's limit_damping", "limit_damping", good,
               {command + "keyword is 'limit_damping'", "transition B in place of it"}),
          pair("the engine's energies", "computeDissipatedEnergy on", good,
               {command + "keyword is 'computeDissipatedEnergy'", "the energies of fix roller/history"}),
          on_two_ranks(twice_in_a_hybrid()),
          pair("cap", "tangential coulomb cap spring", good, {command + "keyword is 'cap'"}),
          pair("a word left over", "transition A B", good, {command + "keyword is 'B'"}),
          pair("torsion without rolling", "torsionTorque on", good, {command + "keyword is 'torsionTorque'"}),
          pair("torsion without value", "rolling_friction epsd2 torsionTorque", good,
               {command + "keyword torsionTorque is missing", "on or off"}),
          pair("unknown torsion", "rolling_friction epsd2 torsionTorque yes", good,
               {command + "keyword torsionTorque is 'yes'", "on or off"}),
          pair("model too late", "transition A tangential history", good,
               {command + "'tangential' comes too late"}),
          pair("model without name", "tangential", good,
               {command + "'tangential' comes too late or lacks its value"}),
          in_engine_words(
              pair("unknown tangential model", "tangential sticky", good, {"Invalid model specified"})),
          pair("cohesion", "cohesion sjkr", good, {command + "keyword cohesion is 'sjkr'; allowed: off"}),
          pair("surface", "tangential history surface multicontact", good,
               {command + "keyword surface is 'multicontact'; allowed: default"}),
          on_two_ranks(pair("no_history", "tangential no_history", good,
                            {command + "keyword tangential is 'no_history'; allowed: off, history or "
                                       "coulomb, of which coulomb replaces no_history"})),
          pair("cdt", "tangential coulomb rolling_friction cdt", good,
               {command + "keyword rolling_friction is 'cdt'; allowed: off or epsd2, of which epsd2 replaces "
                          "cdt"}),
          pair("epsd", "rolling_friction epsd", good,
               {command + "keyword rolling_friction is 'epsd'; allowed: off or epsd2"}),
          on_two_ranks(
              pair("no kn", "", ratio,
                   {"property kn (normal stiffness, N/m) is missing; allowed: 'fix ID all property/global kn",
                    "9 values"})),
          pair("no damping ratio", "", kn,
               {"property dampingRatio (damping ratio D", "is missing", "9 values"}),
          pair("no damping coefficient", "damping coefficient", kn + ratio,
               {"property gamman_abs (normal damping coefficient, N s/m", "is missing", "9 values"}),
          pair("no restitution", "damping restitution", kn + ratio,
               {"property coefficientRestitution (restitution e", "is missing", "9 values"}),
      }};
}

/// A mistake in the pair style with the Hertz law, whose host properties are given but those in `properties`.
BadInput hertz(const std::string &name, const std::string &settings, const std::string &E,
               const std::string &nu, const std::vector<std::string> &says) {
  BadInput input = line(name, "", says);
  const auto of_types = [](const std::string &property_name, const std::string &value) {
    return value.empty() ? std::string()
                         : "fix " + property_name + " all property/global " + property_name +
                               " peratomtype " + value + " " + value + " " + value + "\n";
  };
  input.pair = "pair_style gran model hertz/transition " + settings + "\npair_coeff * *\n" +
               host_properties() + of_types("youngsModulus", E) + of_types("poissonsRatio", nu);
  return input;
}

BadGroup hertz_law() {
  const std::string command = "pair_style gran model hertz/transition: ";
  return {"Hertz",
          "",
          {
              hertz("transition", "transition C", "1e7", "0.3",
                    {command + "keyword transition is 'C'", "A or B"}),
              hertz("torsion", "rolling_friction epsd2 torsionTorque yes", "1e7", "0.3",
                    {command + "keyword torsionTorque is 'yes'", "on or off"}),
              on_two_ranks(
                  hertz("no modulus", "", "", "0.3",
                        {"model hertz/transition: property youngsModulus (Young's modulus, Pa) is missing",
                         "peratomtype' and 3 values"})),
              hertz("ratio beyond", "", "1e7", "0.6",
                    {"property poissonsRatio of type 1 is 0.6", "a finite number > -1 and <= 0.5"}),
              hertz("damping restitution", "damping restitution", "1e7", "0.3",
                    {"model hertz/transition: property coefficientRestitution", "is missing"}),
          }};
}

// Longer than other functions: it has a line for each mistake and nothing else.
BadGroup pair_style_in_lammps() {
  const std::string pair = "pair_style gran/hooke/transition", coeff = "pair_coeff of gran/hooke/transition",
                    good = lammps_pair_style;
  return in_lammps(
      "PairStyleInLammps",
      {line("pair_style gran/hooke/transition transition C",
            {pair, "keyword transition is 'C'", "allowed: A or B"}),
       line("pair_style gran/hooke/transition stepping third",
            {pair, "keyword stepping is 'third'", "stock or second"}),
       line("pair_style gran/hooke/transition torsion on",
            {pair, "keyword is 'torsion'", "allowed: transition"}),
       line("pair_style gran/hooke/transition rolling on", {pair, "keyword rolling is 'on'", "off or epsd2"}),
       line("pair_style gran/hooke/transition rolling", {pair, "keyword rolling is missing", "off or epsd2"}),
       line("pair_style gran/hooke/transition rolling epsd2\npair_coeff * * 1e5 0.2",
            {coeff, "rolling friction coefficient mu_r is missing", "rolling mu_r, a finite number >= 0"}),
       line("pair_style gran/hooke/transition rolling epsd2\npair_coeff * * 1e5 0.2 rolling",
            {coeff, "rolling friction coefficient mu_r is missing", "a finite number >= 0"}),
       line("pair_style gran/hooke/transition rolling epsd2 tangential coulomb\n"
            "pair_coeff * * 1e5 0.2 0.5 NULL rolling -0.1",
            {coeff, "rolling friction coefficient mu_r is '-0.1'", "a finite number >= 0"}),
       line("pair_style gran/hooke/transition rolling epsd2\npair_coeff * * 1e5 0.2 0.3 rolling 0.1",
            {coeff, "'0.3' is left over", "I J k damping rolling mu_r"}),
       line("pair_style gran/hooke/transition\npair_coeff * * 1e5 0.2 rolling 0.1",
            {coeff, "'rolling' is left over", "rolling epsd2 of pair_style"}),
       line("pair_style gran/hooke/transition damping", {pair, "keyword damping is missing"}),
       line("pair_style gran/hooke/transition limit_damping",
            {pair, "keyword is 'limit_damping'", "transition B in place of it"}),
       line("pair_style gran/hooke/transition absolute_damping on",
            {pair, "keyword is 'absolute_damping'", "damping coefficient with c in pair_coeff"}),
       line("pair_style gran/hooke/transition 1e5 NULL 50 NULL 0.5 1",
            {pair, "'1e5' is no keyword", "numbers in pair_coeff"}),
       line("pair_style gran/hooke/transition\npair_coeff 1 1 1e5 0.2\npair_coeff 2 2 1e5 0.2",
            {pair, "types 1 2 have no coefficients", "pair_coeff 1 2 k damping", "pair_coeff * *"}),
       in_engine_words(line(good + "pair_style gran/hooke/transition damping coefficient",
                            {"All pair coeffs are not set"})),
       line("pair_style hybrid gran/hooke/transition gran/hooke/transition\n"
            "pair_coeff * * gran/hooke/transition 1 1e5 0.2\npair_coeff 2 2 gran/hooke/transition 2 1e5 0.2",
            {pair, "pair_style hybrid has it more than once", "once"}),
       line("pair_style gran/hooke/transition\npair_coeff * * -1 0.2",
            {coeff, "normal stiffness k is '-1'", "a finite number > 0"}),
       line("pair_style gran/hooke/transition\npair_coeff * * 1e5", {coeff, "damping ratio D is missing"}),
       line("pair_style gran/hooke/transition\npair_coeff * * 1e5 0.2 0.4",
            {coeff, "'0.4' is left over", "tangential"}),
       line("pair_style gran/hooke/transition tangential history\npair_coeff * * 1e5 0.2 nan",
            {coeff, "friction coefficient mu is 'nan'"}),
       line("pair_style gran/hooke/transition tangential sticky",
            {pair, "keyword tangential is 'sticky'", "off, no_history, history or coulomb"}),
       line("pair_style gran/hooke/transition cap spring tangential coulomb",
            {pair, "keyword cap is 'spring'", "no cap with tangential coulomb"}),
       line("pair_style gran/hooke/transition tangential coulomb\npair_coeff * * 1e5 0.2 -1",
            {coeff, "friction coefficient mu is '-1'", "a finite number >= 0"}),
       line(good + "fix body all rigid single",
            {pair, "fix body (rigid)", "stepping is 'second'", "stepping stock, or fix clump"}),
       line("fix early all nve/sphere\n" + good,
            {pair, "fix early (nve/sphere) stands before it", "stepping stock"})});
}

BadGroup hertz_law_in_lammps() {
  const std::string coeff = "pair_coeff of gran/hertz/transition";
  return in_lammps(
      "HertzInLammps",
      {line("pair_style gran/hertz/transition\npair_coeff * * -1 0.3 0.2",
            {coeff, "Young's modulus E is '-1'", "a finite number > 0"}),
       line("pair_style gran/hertz/transition\npair_coeff * * 1e7 0.6 0.2",
            {coeff, "Poisson's ratio nu is '0.6'", "a finite number > -1 and <= 0.5"}),
       line("pair_style gran/hertz/transition\npair_coeff * * 1e7 0.3",
            {coeff, "damping ratio D is missing"}),
       line("pair_style gran/hertz/transition\npair_coeff * * effective 1e7 0 0.2",
            {coeff, "effective shear modulus G* is '0'", "a finite number > 0"}),
       line("pair_style gran/hertz/transition tangential coulomb\npair_coeff * * 1e7 0.3 0.2 0.5 NULL 1",
            {coeff, "'1' is left over", "I J E nu damping", "mu [ct|NULL]"}),
       line("pair_style gran/hertz/transition rolling epsd2\npair_coeff * * 1e7 0.3 0.2",
            {coeff, "rolling friction coefficient mu_r is missing", "rolling mu_r, a finite number >= 0"}),
       line("pair_style gran/hertz/transition rolling epsd2\npair_coeff * * effective 1e7 3e6 0.2 rolling -1",
            {coeff, "rolling friction coefficient mu_r is '-1'", "a finite number >= 0"}),
       line("pair_style gran/hertz/transition\npair_coeff 1 1 1e7 0.3 0.2\npair_coeff 2 2 1e7 0.3 0.2",
            {"types 1 2 have no coefficients", "pair_coeff 1 2 E nu damping"}),
       line("pair_style hybrid gran/hooke/transition gran/hertz/transition\n"
            "pair_coeff * * gran/hooke/transition 1e5 0.2\npair_coeff 2 2 gran/hertz/transition 1e7 0.3 0.2",
            {"or two laws of this plugin", "one law, once"})});
}

BadGroup properties() {
  const std::string damping = property("dampingRatio", "0.5");
  const auto engine_value = [&damping](const std::string &text) {
    return in_engine_words(pair("kn " + text, "", property("kn", text) + damping,
                                {"Expected floating point parameter", "fix_property_global"}));
  };
  return {
      "Properties",
      "",
      {
          on_two_ranks(value("kn", "-5")),
          value("kn", "0"),
          value("dampingRatio", "-1"),
          value("gamman_abs", "-1", "damping coefficient"),
          value("coefficientRestitution", "0", "damping restitution"),
          value("coefficientRestitution", "1.1", "damping restitution"),
          value("coefficientRollingFriction", "-0.1"),
          value("kt", "-1"),
          value("gammat_abs", "-1"),
          value("coefficientFriction", "-1", "tangential history"),
          value("coefficientFriction", "-0.5", "tangential coulomb"),
          pair("kn beyond a double", "", property("kn", "1e400") + damping,
               {"property kn of types 1 and 1 is inf", "> 0"}),
          engine_value("nan"),
          engine_value("inf"),
          engine_value("stiff"),
          in_engine_words(pair("kn for two types", "",
                               "fix kn all property/global kn peratomtypepair 2 1e7 1e7 1e7 1e7\n" + damping,
                               {"kn", "property/global"})),
          pair("rolling friction missing", "rolling_friction epsd2", property("kn", "1e7") + damping,
               {"property coefficientRollingFriction (rolling resistance mu_r", "is missing"}),
      }};
}

/// Lines in the host deck with another pair style.
BadInput with_pair_style(const std::string &name, const std::string &pair_style_line,
                         const std::string &lines, const std::vector<std::string> &says) {
  BadInput input = line(name, lines, says);
  input.pair = pair_style_line + "\npair_coeff * *\n" + host_properties();
  return input;
}

BadGroup wall() {
  const std::string command = "fix wall/gran model hooke/transition: ";
  const std::string fix = "fix wall all wall/gran model hooke/transition ";
  const std::string plane = "primitive type 1 zplane -1.8 ";
  return {
      "Wall",
      "",
      {
          on_two_ranks(line("unknown transition", fix + plane + "transition C",
                            {command + "keyword transition is 'C'", "A or B"})),
          line("transition without value", fix + plane + "transition",
               {command + "keyword transition is missing", "A or B"}),
          line("unknown damping", fix + plane + "damping 1e5",
               {command + "keyword damping is '1e5'", "coefficient, ratio or restitution"}),
          line("unknown keyword", fix + plane + "limit on", {command + "keyword is 'limit'"}),
          line("the engine's limitForce", fix + plane + "limitForce on",
               {command + "keyword is 'limitForce'", "transition B in place of 'limitForce on'"}),
          on_two_ranks(line("stock with a pair style with second", fix + plane + "stepping stock",
                            {command + "keyword stepping is 'stock' and that of the pair style is 'second'",
                             "the same stepping for both"})),
          on_two_ranks(with_pair_style(
              "second with a pair style with stock", "pair_style gran model hooke/transition stepping stock",
              fix + plane,
              {command + "keyword stepping is 'second' (its default) and that of the pair style is 'stock'",
               "the same stepping for both"})),
          with_pair_style("stock, and a later pair style that changes to second",
                          "pair_style gran model hooke/transition stepping stock",
                          fix + plane +
                              "stepping stock\npair_style gran model hooke/transition\npair_coeff * *",
                          {command + "keyword stepping is 'stock' and that of the pair style is 'second'"}),
          with_pair_style("second with the engine's law", "pair_style gran model hooke/stiffness",
                          fix + plane,
                          {command + "keyword stepping is 'second' (its default)",
                           "there is no pair_style gran model hooke/transition yet"}),
          line("no_history", fix + "tangential no_history " + plane,
               {command + "keyword tangential is 'no_history'; allowed: off, history or coulomb"}),
          on_two_ranks(line("cdt", fix + "rolling_friction cdt " + plane,
                            {command + "keyword rolling_friction is 'cdt'; allowed: off or epsd2"})),
          line("unknown stepping", fix + plane + "stepping 2",
               {command + "keyword stepping is '2'", "stock or second"}),
          line("settings before the wall", fix + "transition A " + plane,
               {command + "'primitive' comes too late"}),
          line("model after the wall", fix + plane + "tangential history",
               {command + "'tangential' comes too late"}),
          in_engine_words(line("no wall", fix, {"wall/gran", "'mesh' or 'primitive'"})),
          in_engine_words(line("type", fix + "primitive type 9 zplane -1.8", {"wall/gran", "type"})),
      }};
}

BadGroup wall_in_lammps() {
  const std::string wall = "fix wall/gran/transition", good = lammps_pair_style;
  return in_lammps(
      "WallInLammps",
      {line(good + "fix floor all wall/gran/transition 2 zplane 0 NULL limit_damping",
            {wall, "'limit_damping' is left over", "its settings are those of the pair style"}),
       line(
           "pair_style hybrid gran/hooke/transition lj/cut 0.1\npair_coeff * * lj/cut 0 1\n"
           "pair_coeff 1 1 gran/hooke/transition 1e5 0.2\nfix floor all wall/gran/transition 2 zplane 0 NULL",
           {wall, "types 1 2 have no coefficients", "pair_coeff 1 2 k damping"}),
       line(good + "fix floor all wall/gran/transition 3 zplane 0 NULL",
            {wall, "type of the wall is '3'", "1 to 2"}),
       line(good + "fix floor all wall/gran/transition 2 zcylinder 0 NULL",
            {wall, "'zcylinder'", "xplane, yplane, zplane or region"}),
       line(good + "fix pipe all wall/gran/transition 2 region pipe",
            {wall, "region 'pipe' is unknown", "the ID of a region"}),
       line(good + "variable dx equal step\nregion pipe cylinder z 0 0 1 INF INF move v_dx NULL NULL\n"
                   "fix pipe all wall/gran/transition 2 region pipe",
            {wall, "region 'pipe' moves", "a region at rest"}),
       on_two_ranks(line(
           good +
               "region hopper cone y 0 0 1.5 1.5 -1 1\nfix hopper all wall/gran/transition 2 region hopper",
           {wall, "region 'hopper' is a cone along y", "open 1 open 2"})),
       line(good + "region hopper cone y 0 0 1.5 1 -1 1 open 1\nregion box2 block -1 1 -1 1 -1 1\n"
                   "region both union 2 hopper box2\nfix hopper all wall/gran/transition 2 region both",
            {wall, "region 'both' has a part that is a cone along y", "open 1 open 2"}),
       line(good + "fix floor all wall/gran/transition 2 zplane NULL NULL", {wall, "both places are NULL"}),
       line(good + "fix floor all wall/gran/transition 2 zplane 1 0", {wall, "allowed: LOW < HIGH"}),
       line("pair_style gran/hooke/history 1e5 NULL 1 NULL 0.4 1\npair_coeff * *\nfix floor all "
            "wall/gran/transition 2 zplane 0 NULL",
            {wall, "pair_style is 'gran/hooke/history'", "pair_style gran/hooke/transition or"})});
}

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

/// The parameters of a law, each with values that it may not have, and left out: LIGGGHTS's properties, then
/// the words of LAMMPS.
template <class Law>
std::vector<BadGroup> parameters_of() {
  const std::string law = Law::name, name = law.substr(0, law.find('/'));
  BadGroup properties{name + "_properties", "", {}}, words = in_lammps(name + "_words", {});
  const auto number = [](double value) { return fmt::format("{}", value); };
  const auto property_line = [](const auto &p, const std::string &given) {
    const std::string text = property(p.property, given);
    if (!std::is_same_v<std::decay_t<decltype(p)>, physics::MaterialParameter>) return text;
    return text.substr(0, text.find("pair 3")) + " " + given + " " + given + " " + given + "\n";
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
    BadInput input = line(std::string(wrong.property) + " " + value, "",
                          {"model " + law + ": property " + wrong.property, says});
    input.pair = "pair_style gran model " + law + "\npair_coeff * *\n" +
                 host_properties(lines + "property/global " + wrong.property) + lines;
    properties.inputs.push_back(input);
    if (!value.empty())
      words.inputs.push_back(
          line("pair_style gran/" + law + " tangential coulomb\npair_coeff * *" + coefficients,
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
                       ""}}) {
    const std::string wrong = property(property_name, "-1e-9");
    BadInput input = line(std::string(property_name) + " -1e-9", "",
                          {"model " + law + ": property " + property_name, "a finite number >= 0"});
    const std::string roll = what == std::string("rolling friction coefficient mu_r")
                                 ? ""
                                 : property("coefficientRollingFriction", "0.1");
    input.pair = "pair_style gran model " + law +
                 " tangential coulomb rolling_friction epsd2\npair_coeff * *\n" +
                 host_properties(good_lines + wrong) + good_lines + wrong + roll;
    properties.inputs.push_back(input);
    for (const char *value : {"-1e-9", "nan", "inf"})
      words.inputs.push_back(line(
          "pair_style gran/" + law + " tangential coulomb rolling epsd2\npair_coeff * *" + good_words +
              before + value + behind,
          {"pair_coeff of gran/" + law, std::string(what) + " is '" + value + "'", "a finite number >= 0"}));
  }
  return {properties, words};
}

} // namespace

std::vector<BadGroup> bad_laws() {
  std::vector<BadGroup> all = {pair_style(),    pair_style_in_lammps(), properties(),
                               hertz_law(),     hertz_law_in_lammps(),  wall(),
                               wall_in_lammps()};
  for_each_law([&all](auto law) {
    for (BadGroup &group : parameters_of<typename decltype(law)::type>())
      all.push_back(std::move(group));
  });
  return all;
}

} // namespace drumlin::test
