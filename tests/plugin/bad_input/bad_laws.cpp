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
              const std::vector<std::string> &says, unsigned kind = on_one_rank) {
  return {name, "", says,
          kind, {}, "pair_style gran model hooke/transition " + settings + "\npair_coeff * *\n" + properties};
}

/// Takes the lines of a group as settings of the pair style.
BadGroup settings_of(const std::string &law, BadGroup group) {
  for (BadInput &input : group.inputs) {
    input.pair =
        "pair_style gran model " + law + " " + input.lines + "\npair_coeff * *\n" + host_properties();
    input.lines.clear();
  }
  return group;
}

/// A value that one property of the contact law may not have.
BadInput value(const std::string &property_name, const std::string &text, const std::string &settings = "",
               unsigned kind = on_one_rank) {
  const std::string given = property(property_name, text);
  return pair(property_name + " " + text, settings, given + host_properties(given),
              {"model hooke/transition", "property " + property_name, "types 1 and 1", "is " + text,
               "a finite number >"},
              kind);
}

BadInput twice_in_a_hybrid() {
  BadInput input{
      "twice in a hybrid",
      "",
      {"pair_style gran model hooke/transition: pair_style hybrid has gran more than once", "once"},
      on_two_ranks};
  input.pair = "pair_style hybrid gran model hooke/transition gran model hooke/transition\n"
               "pair_coeff * * gran 1\npair_coeff 3 3 gran 2\n" +
               host_properties();
  return input;
}

/// A second scene in the deck: two balls that touch on both sides of a thin periodic box.
std::string thin_box(const std::string &units, bool lammps) {
  const std::string begin = lammps ? "plugin load ${plugin}\natom_style sphere\ncomm_modify vel yes\n"
                                   : "atom_style granular\ncommunicate single vel yes\n";
  const std::string law = lammps ? "pair_style gran/hooke/transition\npair_coeff * * 1e5 0.2\n"
                                 : "pair_style gran model hooke/transition\npair_coeff * *\n"
                                   "fix kn all property/global kn peratomtypepair 1 1e5\n"
                                   "fix D all property/global dampingRatio peratomtypepair 1 0.2\n";
  return "clear\nunits " + units + "\n" + begin +
         "atom_modify map array sort 0 0\nnewton off\nboundary p f f\n"
         "region box block 0 0.198 -0.2 0.2 -0.2 0.2 units box\ncreate_box 1 box\n"
         "neighbor 0.002 bin\ncreate_atoms 1 single 0.05 0 0 units box\n"
         "create_atoms 1 single 0.149 0 0 units box\nset group all diameter 0.1\nset group all mass 1\n" +
         law + "fix integrate all nve/sphere\ntimestep 1e-5\nrun 1";
}

BadGroup pair_style() {
  const std::string kn = property("kn", "1e7"), ratio = property("dampingRatio", "0.5");
  BadGroup group = settings_of(
      "hooke/transition",
      Table{"PairStyle", "pair_style gran model hooke/transition: ", ""}.of({
          {"unknown transition", "transition C", "keyword transition is 'C' ... A or B", on_two_ranks},
          {"small transition", "transition a", "keyword transition is 'a' ... A or B"},
          {"transition without value", "transition", "keyword transition is missing ... A or B"},
          {"unknown damping", "damping high",
           "keyword damping is 'high' ... coefficient, ratio or restitution"},
          {"damping without value", "damping",
           "keyword damping is missing ... coefficient, ratio or restitution"},
          {"damping as a number", "damping 0.5",
           "keyword damping is '0.5' ... coefficient, ratio or restitution"},
          {"unknown stepping", "stepping third", "keyword stepping is 'third' ... stock or second"},
          {"stepping without value", "stepping", "keyword stepping is missing ... stock or second"},
          {"unknown keyword", "limit on", "keyword is 'limit' ... transition, damping or stepping"},
          {"the engine's limitForce", "limitForce on",
           "keyword is 'limitForce' ... transition B in place of 'limitForce on' ... transition A in place "
           "of 'limitForce off'"},
          {"the engine's absolute_damping", "transition A absolute_damping on",
           "keyword is 'absolute_damping' ... damping coefficient with property gamman_abs"},
          {"the engine's tangential_damping", "tangential_damping off",
           "keyword is 'tangential_damping' ... property gammat_abs of 0"},
          {"the engine's viscous", "viscous on",
           "keyword is 'viscous' ... damping ratio with property dampingRatio"},
          {"LAMMPS's limit_damping", "limit_damping",
           "keyword is 'limit_damping' ... transition B in place of it"},
          {"the engine's energies", "computeDissipatedEnergy on",
           "keyword is 'computeDissipatedEnergy' ... the energies of fix roller/history"},
          {"cap", "tangential coulomb cap spring", "keyword is 'cap'"},
          {"a word left over", "transition A B", "keyword is 'B'"},
          {"torsion without rolling", "torsionTorque on", "keyword is 'torsionTorque'"},
          {"torsion without value", "rolling_friction epsd2 torsionTorque",
           "keyword torsionTorque is missing ... on or off"},
          {"unknown torsion", "rolling_friction epsd2 torsionTorque yes",
           "keyword torsionTorque is 'yes' ... on or off"},
          {"model too late", "transition A tangential history", "'tangential' comes too late"},
          {"model without name", "tangential", "'tangential' comes too late or lacks its value"},
          {"unknown tangential model", "tangential sticky", "Invalid model specified", in_engine_words},
          {"cohesion", "cohesion sjkr", "keyword cohesion is 'sjkr'; allowed: off"},
          {"surface", "tangential history surface multicontact",
           "keyword surface is 'multicontact'; allowed: default"},
          {"no_history", "tangential no_history",
           "keyword tangential is 'no_history'; allowed: off, history or coulomb, of which coulomb replaces "
           "no_history",
           on_two_ranks},
          {"cdt", "tangential coulomb rolling_friction cdt",
           "keyword rolling_friction is 'cdt'; allowed: off or epsd2, of which epsd2 replaces cdt"},
          {"epsd", "rolling_friction epsd", "keyword rolling_friction is 'epsd'; allowed: off or epsd2"},
      }));
  group.inputs.push_back(
      {"stress from forces that are not final",
       "fix stress all continuum/weighted kernel_radius 2 compute stress",
       {"pair_style gran model hooke/transition: stepping is 'second' and there is a fix continuum/weighted",
        "stepping stock"},
       on_two_ranks});
  group.inputs.push_back({"balls that get other IDs",
                          with_other_ids(),
                          {"pair_style gran model hooke/transition: history of contacts is 'of other balls'",
                           "delete_atoms with compress no"},
                          on_two_ranks});
  group.inputs.push_back({"two contacts of two balls",
                          thin_box("si", false),
                          {"periodic box is '0.198 m' along x, in which balls 1 and 2 can touch on two sides",
                           "at least two cutoffs"}});
  group.inputs.push_back(twice_in_a_hybrid());
  group.inputs.push_back(pair(
      "no kn", "", ratio,
      {"property kn (normal stiffness, N/m) is missing; allowed: 'fix ID all property/global kn", "9 values"},
      on_two_ranks));
  group.inputs.push_back(
      pair("no damping ratio", "", kn, {"property dampingRatio (damping ratio D", "is missing", "9 values"}));
  group.inputs.push_back(
      pair("no damping coefficient", "damping coefficient", kn + ratio,
           {"property gamman_abs (normal damping coefficient, N s/m", "is missing", "9 values"}));
  group.inputs.push_back(pair("no restitution", "damping restitution", kn + ratio,
                              {"property coefficientRestitution (restitution e", "is missing", "9 values"}));
  return group;
}

/// A mistake in the pair style with the Hertz law, whose host properties are given but those in `properties`.
BadInput hertz(const std::string &name, const std::string &settings, const std::string &E,
               const std::string &nu, const std::vector<std::string> &says, unsigned kind = on_one_rank) {
  BadInput input{name, "", says, kind};
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
  return {"Hertz",
          "",
          {
              hertz("transition", "transition C", "1e7", "0.3",
                    {"pair_style gran model hertz/transition: keyword transition is 'C'", "A or B"}),
              hertz("torsion", "rolling_friction epsd2 torsionTorque yes", "1e7", "0.3",
                    {"pair_style gran model hertz/transition: keyword torsionTorque is 'yes'", "on or off"}),
              hertz("no modulus", "", "", "0.3",
                    {"model hertz/transition: property youngsModulus (Young's modulus, Pa) is missing",
                     "peratomtype' and 3 values"},
                    on_two_ranks),
              hertz("ratio beyond", "", "1e7", "0.6",
                    {"property poissonsRatio of type 1 is 0.6", "a finite number > -1 and <= 0.5"}),
              hertz("damping restitution", "damping restitution", "1e7", "0.3",
                    {"model hertz/transition: property coefficientRestitution", "is missing"}),
          }};
}

/// A mistake in the pair style with the law that yields, whose host properties are given but k2/k1.
BadInput yield(const std::string &name, const std::string &settings, const std::string &ratio,
               const std::string &more, const std::vector<std::string> &says, unsigned kind = on_one_rank) {
  BadInput input{name, "", says, kind};
  input.pair = "pair_style gran model yield/transition " + settings + "\npair_coeff * *\n" +
               property("kn", "1e5") + property("dampingRatio", "0.3") +
               (ratio.empty() ? "" : property("stiffnessRatio", ratio)) + more;
  return input;
}

BadGroup yield_law() {
  const char *const command = "model yield/transition: property ";
  return {
      "Yield",
      "",
      {
          yield("no ratio", "", "", "",
                {std::string(command) + "stiffnessRatio (stiffness of unloading over that of first loading) "
                                        "is missing",
                 "9 values"},
                on_two_ranks),
          yield("k2 below k1", "", "0.99", "",
                {std::string(command) + "stiffnessRatio of types 1 and 1 is 0.99", "a finite number >= 1"},
                on_two_ranks),
          yield("negative ratio", "", "-2", "", {"stiffnessRatio of types 1 and 1 is -2", ">= 1"}),
          yield("a restitution that cannot be had", "damping restitution", "4",
                property("coefficientRestitution", "0.51"),
                {std::string(command) + "coefficientRestitution of types 1 and 1 is 0.51",
                 "a finite number > 0 and <= 0.5"},
                on_two_ranks),
      }};
}

BadGroup yield_law_in_lammps() {
  return Table{"YieldInLammps", "", "gran/yield/transition", true}.of({
      {"", "pair_style @\npair_coeff * * 1e5 0.5 0.2",
       "pair_coeff of @ ... stiffness of unloading over that of first loading k2/k1 is '0.5' ... a finite "
       "number >= 1"},
      {"", "pair_style @\npair_coeff * * 1e5 nan 0.2", "pair_coeff of @ ... k2/k1 is 'nan' ... >= 1"},
      {"", "pair_style @\npair_coeff * * -1e5 2 0.2",
       "pair_coeff of @ ... normal stiffness of first loading k1 is '-1e5' ... a finite number > 0"},
      {"", "pair_style @\npair_coeff * * 1e5 2", "pair_coeff of @ ... damping ratio D is missing"},
      {"", "pair_style @ damping restitution\npair_coeff * * 1e5 4 0.51",
       "pair_coeff of @ ... restitution e is '0.51' ... a finite number > 0 and <= 0.5"},
      {"", "pair_style @\npair_coeff * * 1e5 2 0.2 0.5",
       "pair_coeff of @ ... '0.5' is left over ... I J k1 k2/k1 damping"},
  });
}

BadGroup pair_style_in_lammps() {
  return Table{"PairStyleInLammps", "", "gran/hooke/transition", true}.of({
      {"", "pair_style @ transition C", "pair_style @ ... keyword transition is 'C' ... allowed: A or B"},
      {"", "pair_style @ stepping third", "pair_style @ ... keyword stepping is 'third' ... stock or second"},
      {"", "pair_style @ torsion on", "pair_style @ ... keyword is 'torsion' ... allowed: transition"},
      {"", "pair_style @ rolling on", "pair_style @ ... keyword rolling is 'on' ... off or epsd2"},
      {"", "pair_style @ rolling", "pair_style @ ... keyword rolling is missing ... off or epsd2"},
      {"", "pair_style @ rolling epsd2\npair_coeff * * 1e5 0.2",
       "pair_coeff of @ ... rolling friction coefficient mu_r is missing ... rolling mu_r, a finite number "
       ">= 0"},
      {"", "pair_style @ rolling epsd2\npair_coeff * * 1e5 0.2 rolling",
       "pair_coeff of @ ... rolling friction coefficient mu_r is missing ... a finite number >= 0"},
      {"", "pair_style @ rolling epsd2 tangential coulomb\npair_coeff * * 1e5 0.2 0.5 NULL rolling -0.1",
       "pair_coeff of @ ... rolling friction coefficient mu_r is '-0.1' ... a finite number >= 0"},
      {"", "pair_style @ rolling epsd2\npair_coeff * * 1e5 0.2 0.3 rolling 0.1",
       "pair_coeff of @ ... '0.3' is left over ... I J k damping rolling mu_r"},
      {"", "pair_style @\npair_coeff * * 1e5 0.2 rolling 0.1",
       "pair_coeff of @ ... 'rolling' is left over ... rolling epsd2 of pair_style"},
      {"", "pair_style @ damping", "pair_style @ ... keyword damping is missing"},
      {"", "pair_style @ limit_damping",
       "pair_style @ ... keyword is 'limit_damping' ... transition B in place of it"},
      {"", "pair_style @ absolute_damping on",
       "pair_style @ ... keyword is 'absolute_damping' ... damping coefficient with c in pair_coeff"},
      {"", "pair_style @ 1e5 NULL 50 NULL 0.5 1",
       "pair_style @ ... '1e5' is no keyword ... numbers in pair_coeff"},
      {"", "pair_style @\npair_coeff 1 1 1e5 0.2\npair_coeff 2 2 1e5 0.2",
       "pair_style @ ... types 1 2 have no coefficients ... pair_coeff 1 2 k damping ... pair_coeff * *"},
      {"", "pair_style @\npair_coeff * * 1e5 0.2\npair_style @ damping coefficient",
       "All pair coeffs are not set", in_engine_words},
      {"", "pair_style hybrid @ @\npair_coeff * * @ 1 1e5 0.2\npair_coeff 2 2 @ 2 1e5 0.2",
       "pair_style @ ... pair_style hybrid has it more than once ... once"},
      {"", "pair_style @\npair_coeff * * -1 0.2",
       "pair_coeff of @ ... normal stiffness k is '-1' ... a finite number > 0"},
      {"", "pair_style @\npair_coeff * * 1e5", "pair_coeff of @ ... damping ratio D is missing"},
      {"", "pair_style @\npair_coeff * * 1e5 0.2 0.4",
       "pair_coeff of @ ... '0.4' is left over ... tangential"},
      {"", "pair_style @ tangential history\npair_coeff * * 1e5 0.2 nan",
       "pair_coeff of @ ... friction coefficient mu is 'nan'"},
      {"", "pair_style @ tangential sticky",
       "pair_style @ ... keyword tangential is 'sticky' ... off, no_history, history or coulomb"},
      {"", "pair_style @ cap spring tangential coulomb",
       "pair_style @ ... keyword cap is 'spring' ... no cap with tangential coulomb"},
      {"", "pair_style @ tangential coulomb\npair_coeff * * 1e5 0.2 -1",
       "pair_coeff of @ ... friction coefficient mu is '-1' ... a finite number >= 0"},
      {"", "pair_style @\npair_coeff * * 1e5 0.2\nfix body all rigid single",
       "pair_style @ ... fix body (rigid) ... stepping is 'second' ... stepping stock, or fix clump"},
      {"", "fix early all nve/sphere\npair_style @\npair_coeff * * 1e5 0.2\n",
       "pair_style @ ... fix early (nve/sphere) stands before it ... stepping stock"},
      {"balls that get other IDs",
       "pair_style @\npair_coeff * * 1e5 0.2\nfix integrate all nve/sphere\nrun 1\ndelete_atoms group soil\n"
       "run 1",
       "pair_style @: history of contacts is 'of other balls' ... delete_atoms with compress no",
       on_two_ranks},
      {"two contacts of two balls", thin_box("si", true),
       "periodic box is '0.198 m' along x, in which balls 1 and 2 can touch on two sides ... two cutoffs"},
      {"units real", thin_box("real", true), "pair_style @: units is 'real' ... si, cgs, micro, nano or lj"},
      {"units metal", thin_box("metal", true),
       "pair_style @: units is 'metal' ... si, cgs, micro, nano or lj"},
  });
}

BadGroup hertz_law_in_lammps() {
  return Table{"HertzInLammps", "", "gran/hertz/transition", true}.of({
      {"", "pair_style @\npair_coeff * * -1 0.3 0.2",
       "pair_coeff of @ ... Young's modulus E is '-1' ... a finite number > 0"},
      {"", "pair_style @\npair_coeff * * 1e7 0.6 0.2",
       "pair_coeff of @ ... Poisson's ratio nu is '0.6' ... a finite number > -1 and <= 0.5"},
      {"", "pair_style @\npair_coeff * * 1e7 0.3", "pair_coeff of @ ... damping ratio D is missing"},
      {"", "pair_style @\npair_coeff * * effective 1e7 0 0.2",
       "pair_coeff of @ ... effective shear modulus G* is '0' ... a finite number > 0"},
      {"", "pair_style @ tangential coulomb\npair_coeff * * 1e7 0.3 0.2 0.5 NULL 1",
       "pair_coeff of @ ... '1' is left over ... I J E nu damping ... mu [ct|NULL]"},
      {"", "pair_style @ rolling epsd2\npair_coeff * * 1e7 0.3 0.2",
       "pair_coeff of @ ... rolling friction coefficient mu_r is missing ... rolling mu_r, a finite number "
       ">= 0"},
      {"", "pair_style @ rolling epsd2\npair_coeff * * effective 1e7 3e6 0.2 rolling -1",
       "pair_coeff of @ ... rolling friction coefficient mu_r is '-1' ... a finite number >= 0"},
      {"", "pair_style @\npair_coeff 1 1 1e7 0.3 0.2\npair_coeff 2 2 1e7 0.3 0.2",
       "types 1 2 have no coefficients ... pair_coeff 1 2 E nu damping"},
      {"",
       "pair_style hybrid gran/hooke/transition @\npair_coeff * * gran/hooke/transition 1e5 0.2\npair_coeff "
       "2 2 @ 1e7 0.3 0.2",
       "or two laws of this plugin ... one law, once"},
  });
}

BadGroup properties() {
  const std::string damping = property("dampingRatio", "0.5");
  const auto engine_value = [&damping](const std::string &text) {
    return pair("kn " + text, "", property("kn", text) + damping,
                {"Expected floating point parameter", "fix_property_global"}, in_engine_words);
  };
  return {"Properties",
          "",
          {
              value("kn", "-5", "", on_two_ranks),
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
              pair("kn for two types", "",
                   "fix kn all property/global kn peratomtypepair 2 1e7 1e7 1e7 1e7\n" + damping,
                   {"property/global", "kn"}, in_engine_words),
              pair("rolling friction missing", "rolling_friction epsd2", property("kn", "1e7") + damping,
                   {"property coefficientRollingFriction (rolling resistance mu_r", "is missing"}),
          }};
}

/// Lines in the host deck with another pair style.
BadInput with_pair_style(const std::string &name, const std::string &pair_style_line,
                         const std::string &lines, const std::vector<std::string> &says,
                         unsigned kind = on_one_rank) {
  BadInput input{name, lines, says, kind};
  input.pair = pair_style_line + "\npair_coeff * *\n" + host_properties();
  return input;
}

BadGroup wall() {
  const std::string plane = "fix wall all wall/gran model hooke/transition primitive type 1 zplane -1.8 ";
  BadGroup group = Table{"Wall", "fix wall/gran model hooke/transition: ", plane}.of({
      {"unknown transition", "@transition C", "keyword transition is 'C' ... A or B", on_two_ranks},
      {"transition without value", "@transition", "keyword transition is missing ... A or B"},
      {"unknown damping", "@damping 1e5", "keyword damping is '1e5' ... coefficient, ratio or restitution"},
      {"unknown keyword", "@limit on", "keyword is 'limit'"},
      {"the engine's limitForce", "@limitForce on",
       "keyword is 'limitForce' ... transition B in place of 'limitForce on'"},
      {"stock with a pair style with second", "@stepping stock",
       "keyword stepping is 'stock' and that of the pair style is 'second' ... the same stepping for both",
       on_two_ranks},
      {"no_history",
       "fix wall all wall/gran model hooke/transition tangential no_history primitive type 1 zplane -1.8",
       "keyword tangential is 'no_history'; allowed: off, history or coulomb"},
      {"cdt",
       "fix wall all wall/gran model hooke/transition rolling_friction cdt primitive type 1 zplane -1.8",
       "keyword rolling_friction is 'cdt'; allowed: off or epsd2", on_two_ranks},
      {"unknown stepping", "@stepping 2", "keyword stepping is '2' ... stock or second"},
      {"settings before the wall",
       "fix wall all wall/gran model hooke/transition transition A primitive type 1 zplane -1.8",
       "'primitive' comes too late"},
      {"model after the wall", "@tangential history", "'tangential' comes too late"},
      {"no wall", "fix wall all wall/gran model hooke/transition", "wall/gran ... 'mesh' or 'primitive'",
       in_engine_words},
      {"type", "fix wall all wall/gran model hooke/transition primitive type 9 zplane -1.8",
       "wall/gran ... type", in_engine_words},
  });
  group.inputs.push_back(with_pair_style("second with a pair style with stock",
                                         "pair_style gran model hooke/transition stepping stock", plane,
                                         {"fix wall/gran model hooke/transition: keyword stepping is "
                                          "'second' (its default) and that of the pair style is 'stock'",
                                          "the same stepping for both"},
                                         on_two_ranks));
  group.inputs.push_back(
      with_pair_style("stock, and a later pair style that changes to second",
                      "pair_style gran model hooke/transition stepping stock",
                      plane + "stepping stock\npair_style gran model hooke/transition\npair_coeff * *",
                      {"fix wall/gran model hooke/transition: keyword stepping is 'stock' and that of the "
                       "pair style is 'second'"}));
  group.inputs.push_back(
      with_pair_style("second with the engine's law", "pair_style gran model hooke/stiffness", plane,
                      {"fix wall/gran model hooke/transition: keyword stepping is 'second' (its default)",
                       "there is no pair_style gran model hooke/transition yet"}));
  return group;
}

BadGroup wall_in_lammps() {
  return Table{"WallInLammps", "fix wall/gran/transition ... ",
               "pair_style gran/hooke/transition\npair_coeff * * 1e5 0.2\nfix floor all wall/gran/transition",
               true}
      .of({
          {"", "@ 2 zplane 0 NULL limit_damping",
           "'limit_damping' is left over ... its settings are those of the pair style"},
          {"",
           "pair_style hybrid gran/hooke/transition lj/cut 0.1\npair_coeff * * lj/cut 0 1\npair_coeff 1 1 "
           "gran/hooke/transition 1e5 0.2\nfix floor all wall/gran/transition 2 zplane 0 NULL",
           "types 1 2 have no coefficients ... pair_coeff 1 2 k damping"},
          {"", "@ 3 zplane 0 NULL", "type of the wall is '3' ... 1 to 2"},
          {"", "@ 2 zcylinder 0 NULL", "'zcylinder' ... xplane, yplane, zplane or region"},
          {"",
           "pair_style gran/hooke/transition\npair_coeff * * 1e5 0.2\nfix pipe all wall/gran/transition 2 "
           "region pipe",
           "region 'pipe' is unknown ... the ID of a region"},
          {"",
           "pair_style gran/hooke/transition\npair_coeff * * 1e5 0.2\nvariable dx equal step\nregion pipe "
           "cylinder z 0 0 1 INF INF move v_dx NULL NULL\nfix pipe all wall/gran/transition 2 region pipe",
           "region 'pipe' moves ... a region at rest"},
          {"",
           "pair_style gran/hooke/transition\npair_coeff * * 1e5 0.2\nregion hopper cone y 0 0 1.5 1.5 -1 "
           "1\nfix hopper all wall/gran/transition 2 region hopper",
           "region 'hopper' is a cone along y ... open 1 open 2", on_two_ranks},
          {"",
           "pair_style gran/hooke/transition\npair_coeff * * 1e5 0.2\nregion hopper cone y 0 0 1.5 1 -1 1 "
           "open 1\nregion box2 block -1 1 -1 1 -1 1\nregion both union 2 hopper box2\nfix hopper all "
           "wall/gran/transition 2 region both",
           "region 'both' has a part that is a cone along y ... open 1 open 2"},
          {"", "@ 2 zplane NULL NULL", "both places are NULL"},
          {"", "@ 2 zplane 1 0", "allowed: LOW < HIGH"},
          {"",
           "pair_style gran/hooke/history 1e5 NULL 1 NULL 0.4 1\npair_coeff * *\nfix floor all "
           "wall/gran/transition 2 zplane 0 NULL",
           "pair_style is 'gran/hooke/history' ... pair_style gran/hooke/transition or"},
      });
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
  BadGroup properties{name + "_properties", "", {}}, words{name + "_words", "", {}, true};
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
    BadInput input{std::string(wrong.property) + " " + value,
                   "",
                   {"model " + law + ": property " + wrong.property, says}};
    input.pair = "pair_style gran model " + law + "\npair_coeff * *\n" +
                 host_properties(lines + "property/global " + wrong.property) + lines;
    properties.inputs.push_back(input);
    if (!value.empty())
      words.inputs.push_back({std::string(wrong.word) + " " + value,
                              "pair_style gran/" + law + " tangential coulomb\npair_coeff * *" + coefficients,
                              {"pair_coeff of gran/" + law,
                               std::string(wrong.name) + " " + wrong.word + " is '" + value + "'", says}});
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
    BadInput input{std::string(property_name) + " -1e-9",
                   "",
                   {"model " + law + ": property " + property_name, "a finite number >= 0"}};
    const std::string roll = what == std::string("rolling friction coefficient mu_r")
                                 ? ""
                                 : property("coefficientRollingFriction", "0.1");
    input.pair = fmt::format(
        "pair_style gran model {} tangential coulomb rolling_friction epsd2\npair_coeff * *\n{}{}{}{}", law,
        host_properties(good_lines + wrong), good_lines, wrong, roll);
    properties.inputs.push_back(input);
    for (const char *value : {"-1e-9", "nan", "inf"})
      words.inputs.push_back(
          {fmt::format("{} {}", property_name, value),
           fmt::format("pair_style gran/{} tangential coulomb rolling epsd2\npair_coeff * *{}{}{}{}", law,
                       good_words, before, value, behind),
           {"pair_coeff of gran/" + law, fmt::format("{} is '{}'", what, value), "a finite number >= 0"}});
  }
  return {properties, words};
}

} // namespace

std::vector<BadGroup> bad_laws() {
  std::vector<BadGroup> all = {
      pair_style(), pair_style_in_lammps(), properties(), hertz_law(),     hertz_law_in_lammps(),
      yield_law(),  yield_law_in_lammps(),  wall(),       wall_in_lammps()};
  for_each_law([&all](auto law) {
    for (BadGroup &group : parameters_of<typename decltype(law)::type>())
      all.push_back(std::move(group));
  });
  return all;
}

} // namespace drumlin::test
