#include "tests/plugin/bad_input/bad_input.h"
#include "tests/support/lines.h"

#include <fmt/format.h>

namespace drumlin::test {
namespace {

const char *const positive = "a finite number > 0";
const char *const non_negative = "a finite number >= 0";
const char *const whole = "a whole number from ";
const char *const below = "a finite number below ";
const char *const folder = "a folder that can be made or written";

/// Values that variables of a deck may not have. Of each variable only the first one is tried on two ranks.
struct Values {
  std::string variables, values; ///< with blanks between them
  std::string allowed;           ///< in the error line behind "allowed: "
  unsigned kind = on_one_rank;
};

/// The mistakes in variables of a deck of inputs. The lines of a row are "NAME VALUE, NAME VALUE".
BadGroup of_deck(const std::string &name, const std::string &deck, const std::vector<Values> &table,
                 const std::vector<Row> &rows = {}) {
  BadGroup group{name, deck, {}};
  for (const Values &row : table)
    for (const std::string &variable : words_of(row.variables)) {
      unsigned kind = row.kind;
      for (const std::string &value : words_of(row.values)) {
        group.inputs.push_back(
            {fmt::format("{} '{}'", variable, value),
             "",
             {fmt::format(": variable {} is '{}'; ", variable, value), "allowed: " + row.allowed},
             kind,
             {{variable, value}}});
        kind = on_one_rank;
      }
    }
  for (const Row &row : rows) {
    Variables variables;
    for (std::string rest = row.lines + ", "; !rest.empty(); rest.erase(0, rest.find(", ") + 2)) {
      const std::string given = rest.substr(0, rest.find(", "));
      variables.emplace_back(given.substr(0, given.find(' ')), given.substr(given.find(' ') + 1));
    }
    group.inputs.push_back({row.name, "", parts_of(row.says), row.kind, variables});
  }
  return group;
}

BadGroup chain_way() {
  const std::string way = "way " DRUMLIN_SOURCE_DIR "/inputs/chain/way";
  return of_deck(
      "ChainWay", "chain/in.chain", {},
      {{"no file", "way none.csv", "drumlin/way: way is 'none.csv' ... a file that can be read",
        on_two_ranks},
       {"stiffness given", way + ", k 1e7", "drumlin/way: variable k is '1e7' ... none with a way",
        on_two_ranks},
       {"damping given", way + ", D 0.1", "drumlin/way: variable D is '0.1' ... none with a way"},
       {"cycles given", way + ", cycles 5", "variable cycles is '5' ... not given with way"},
       {"speed without way", "speed 1", "variable speed is '1' ... not given without way"},
       {"passes without way", "passes 2", "variable passes is '2' ... not given without way"},
       {"speed zero", way + ", speed 0", "variable speed is '0' ... a finite number > 0"},
       {"no passes", way + ", passes 0", "variable passes is '0' ... a whole number from 1 to 1000"},
       {"too slow", way + ", speed 1e-6", "variable speed is '1e-6' ... so that all passes take"}});
}

BadGroup rocking() {
  const std::string way = DRUMLIN_SOURCE_DIR "/inputs/chain/way", count = " ... a whole number from 1 to 32";
  return of_deck(
      "Rocking", "chain/in.rocking",
      {{"tilt", "0.2", "a finite number at most 0.1"}, {"tilt", "-0.2", "a finite number at least -0.1"}},
      {{"no contacts", "contacts 0", "drumlin/ends: contacts is '0'" + count, on_two_ranks},
       {"too many", "contacts 33", "drumlin/ends: contacts is '33'" + count},
       {"a part", "contacts 2.5", "drumlin/ends: contacts is '2.5'" + count},
       {"no file", "contacts none.csv", "drumlin/ends: contacts is 'none.csv'" + count, on_two_ranks},
       {"another table", "contacts " + way, "header of ' ... y (m),k (N/m),c (N s/m)"},
       {"stiffness given", "k 1e7, contacts " + way, "variable k is '1e7' ... none with a file of contacts",
        on_two_ranks},
       {"a roller that drives", "way " + way, "variable way is ' ... allowed: none"}});
}

BadGroup chain_choices() {
  return of_deck(
      "ChainChoices", "chain/in.chain",
      {{"case", "V ii 2", "I, II, III or IV", on_two_ranks},
       {"transition", "C AB", "A or B", on_two_ranks},
       {"stepping", "exact", "second or stock", on_two_ranks},
       {"guard", "yes", "on or off", on_two_ranks}},
      {{"two values", "k 1e8 2e8", "drumlin/variables: variable k is '1e8 2e8' ... a value without blanks"},
       {"empty value", "k ", "drumlin/variables: variable k is '' ... one value that is not empty"},
       {"a quoted number", "cycles \"5\"",
        "drumlin/variables: variable cycles is '\"5\"' ... a value without blanks, quotes", on_two_ranks},
       {"a command", "out x$(touch pwned)",
        "drumlin/variables: variable out is 'x$(touch pwned)' ... a value without blanks"},
       {"a line end", "out x\ny", "drumlin/variables: variable out is 'x?y' ... a value without blanks"},
       {"a long value", "out " + std::string(5000, 'x'),
        "drumlin/variables: variable out is 'xxx ... a value of at most 1000 characters"},
       {"another case of letters", "Case III",
        "drumlin/variables: -var Case is 'III' ... allowed: case, the nearest of roller, setting, case, g, "
        "way, k, D",
        on_two_ranks},
       {"a misspelt name", "step_per_cycle 1000",
        "-var step_per_cycle is '1000' ... allowed: steps_per_cycle, the nearest of "}});
}

BadGroup chain_numbers() {
  return of_deck("ChainNumbers", "chain/in.chain",
                 {{"k omega m2 m3 k23", "-1 0 nan inf", positive, on_two_ranks},
                  {"D Fw c23 g", "-0.5 NaN -inf", non_negative},
                  {"k", "stiff 100MN/m 1e999", positive, on_two_ranks},
                  {"k omega m2", "1e-308 1e308", "a finite number > 0, between 1e-30 and 1e30 in size"},
                  {"Fw", "58,800", non_negative}});
}

BadGroup chain_counts() {
  return of_deck("ChainCounts", "chain/in.chain",
                 {{"cycles steps_per_cycle samples_per_cycle settle_limit", "0 -5 2.5 many nan 1e30", whole,
                   on_two_ranks}},
                 {{"no multiple", "samples_per_cycle 300",
                   "variable steps_per_cycle is '2000' ... allowed: a multiple of samples_per_cycle, which "
                   "is 300",
                   on_two_ranks},
                  {"a multiple of more", "samples_per_cycle 4000",
                   "variable steps_per_cycle is '2000' ... allowed: a multiple of samples_per_cycle, which "
                   "is 4000"}});
}

BadGroup chain_folder() {
  return of_deck("ChainFolder", "chain/in.chain",
                 {{"out", "out/chain.csv", folder, on_two_ranks}, // a file of the earlier run
                  {"out", "out/chain.csv/below /dev/null/results /dev/drumlin /proc / x*", folder}});
}

BadGroup chain_equilibrium() {
  return of_deck("ChainEquilibrium", "chain/in.chain", {},
                 {{"no damping", "D 0, c23 0, k 5.8e4, guard off, settle_limit 2000",
                   "drumlin/settle: unbalanced ratio is ' ... after 2000 steps ... within 2000 steps ... "
                   "without damping",
                   on_two_ranks},
                  {"too soft to carry", "k 1000",
                   "fix guard: overlap of balls ... of the smaller radius at step ... at most 1 of it"}});
}

BadGroup impact() {
  return of_deck("Impact", "chain/in.impact",
                 {{"transition", "c", "A or B", on_two_ranks},
                  {"stepping", "half", "second or stock"},
                  {"guard", "1", "on or off"},
                  {"k m2 speed", "0 -1 nan", positive},
                  {"D", "-0.5", non_negative, on_two_ranks},
                  {"onset", "-1", non_negative},
                  {"steps_per_contact contacts samples", "0 1.5", whole},
                  {"out", "out/events.csv", folder}},
                 {{"no multiple", "samples 3",
                   "variable steps_per_contact is '2000' ... allowed: a multiple of samples, which is 3"}});
}

/// What all decks of the bed share, tried on the first of them.
BadGroup bed_settle() {
  return of_deck(
      "BedSettle", "bed/in.settle",
      {{"transition", "C", "A or B", on_two_ranks},
       {"stepping", "half", "second or stock"},
       {"tangential", "off", "coulomb or history"},
       {"guard", "1", "on or off"},
       {"k m2 m3 r2 r3 k23 dt ratio pour_k pour_dt", "0 -1 nan", positive},
       {"D friction rolling g c23 drag fall pour_D pour_friction pour_rolling", "-0.5", non_negative},
       {"pour_tensile_strength", "-0.5", non_negative},
       {"k", "1e8,-1 1e8, 1e8;1e9", "a finite number > 0, or several, separated by commas"},
       {"settle_limit", "-1", whole},
       {"loose", "1", "a finite number below 1"},
       {"loose_steps", "0", whole},
       {"drag", "1e9", "a finite number below 15193"},
       {"fall", "1e9", below},
       {"balls", "none.data", "a file that can be read, which './drumlin bed --out none.data' makes",
        on_two_ranks}},
      {{"a case without a file", "case sand",
        "drumlin/variable: variable case is 'sand'; allowed: base, base3d, gravel, gravel3d"}});
}

BadGroup bed_place() {
  return of_deck("BedPlace", "bed/in.place",
                 {{"settle_limit", "1.5", whole},
                  {"m2 m3 r2 r3 k23", "0 -1 nan", positive},
                  {"c23", "-0.5", non_negative},
                  {"sink", "-1", non_negative},
                  {"sink", "1e9", below},
                  {"drag", "1e9", "a finite number below 160000, which is 1/dt"},
                  {"ratio", "0", positive}},
                 {{"no bed", "bed none.restart",
                   "drumlin/variable: variable bed is 'none.restart'; ... ./drumlin run inputs/bed/in.settle "
                   "-var bed none.restart",
                   on_two_ranks}});
}

BadGroup bed() {
  return of_deck(
      "Bed", "bed/in.bed",
      {{"omega time_limit", "0 -1 nan", positive},
       {"Fw", "-1", non_negative},
       {"ground_depth ground_density ground_cp ground_cs side_height", "300",
        "not given with boundary rigid"},
       {"cycles steps_per_cycle samples_per_cycle", "0 1.5", whole},
       {"dumps_per_cycle", "-1", whole}},
      {{"no multiple", "dumps_per_cycle 3",
        "variable steps_per_cycle is '8000' ... allowed: a multiple of dumps_per_cycle, which is "
        "3"},
       {"no roller", "start none.restart",
        "drumlin/variable: variable start is 'none.restart'; ... ./drumlin run inputs/bed/in.place "
        "-var start none.restart",
        on_two_ranks}});
}

BadGroup oedometer() {
  const std::string check = "drumlin/check: variable ";
  const std::string declared = "drumlin/variable: variable ";
  return of_deck(
      "Oedometer", "soil/in.oedometer",
      {{"radius density k kt seating ratio dt drag", "0 -1 nan", positive},
       {"D friction prepare_friction prepare_rolling prepare_time prepare_tensile_strength", "-0.5",
        non_negative},
       {"columns rows layers every ramp seed", "0 2.5", whole},
       {"stepping", "half", "second or stock", on_two_ranks},
       {"guard", "1", "on or off"},
       {"dimension", "4", "2 or 3"},
       {"drag prepare_drag prepare_time", "1e9", below},
       {"dt", "1", below},
       {"rows", "4", "1"},
       {"yield", "0.9 -2 nan", "a finite number at least 1"}},
      {{"balls that fall through the plates", "spread 0.9",
        check + "spread is '0.9' ... allowed: a finite number below 0.481481, so that no ball falls"},
       {"balls that fall through the plates in space", "spread 0.23, dimension 3",
        check + "spread is '0.23' ... allowed: a finite number below 0.224705, so that no ball falls"},
       {"a seating stress that presses balls flat", "seating 1e6",
        check + "seating is '1e6' ... allowed: a finite number below ... half a radius", on_two_ranks},
       {"a load that presses balls flat", "loads 25 1e6",
        check + "loads is '1e6' ... allowed: a finite number below ... half a radius"},
       {"unstable", "D 1e9", check + "D is '1e9'; ... unstable under stepping stock"},
       {"a density with which the drag is too large", "density 1e20",
        check + "density is '1e20' ... allowed: a finite number below ... prepare_drag"},
       {"a drag with which the density does not matter", "density 1e20, prepare_drag 1e9",
        check + "prepare_drag is '1e9'"},
       {"a lattice in the plane", "sample hexagonal, dimension 3",
        declared + "dimension is '3' ... allowed: 2"},
       {"a seed without random numbers", "sample cubic, seed 2", declared + "seed is '2' ... allowed: 1"},
       {"a lattice of several sizes", "sample cubic, spread 0.1",
        declared + "spread is '0.1' ... allowed: 0"},
       {"an unknown sample", "sample clay", declared + "sample is 'clay' ... allowed: hexagonal",
        on_two_ranks},
       {"a load of 0", "loads 25 0 50", check + "loads is '0' ... allowed: " + positive},
       {"a load that is a word", "loads 25 heavy", check + "loads is 'heavy' ... allowed: " + positive},
       {"a ramp that is no multiple", "ramp 300",
        "variable ramp is '300' ... allowed: a multiple of every, which is 200"}});
}

BadGroup density() {
  return of_deck("Density", "soil/in.density",
                 {{"g", "1e9", below},
                  {"beside", "-1", non_negative},
                  {"sample", "square", "hexagonal or random", on_two_ranks}},
                 {{"no loosest packing", "shares 0.5", "drumlin/check: variable shares is '0.5' ... above 1"},
                  {"no densest packing", "shares 1 0.5",
                   "drumlin/check: variable shares is '0.5' ... at most 0, so that the second", on_two_ranks},
                  {"the loosest packing alone", "shares 1", "drumlin/check: variable shares is '1' ... 1 0"},
                  {"looser than the loosest", "shares 1 0 1.5",
                   "drumlin/check: variable shares is '1.5' ... at most 1, the share of the loosest"},
                  {"denser than the densest", "shares 1 0 -0.5",
                   "drumlin/check: variable shares is '-0.5' ... a finite number >= 0", on_two_ranks},
                  {"a friction that the shares decide", "prepare_friction 0.3",
                   "drumlin/variables: -var prepare_friction is '0.3'"}});
}

BadGroup spheres() {
  return of_deck(
      "Spheres", "benchmarks/in.spheres",
      {{"e density r1 E E2 contacts duration", "0 -1 nan", positive},
       {"mu mu_r g onset ceiling vn", "-0.5", non_negative},
       {"spheres every steps_per_contact", "0 2.5", whole},
       {"case", "chung_ooi_9", "chung_ooi_1", on_two_ranks},
       {"material", "gold", "glass or limestone"},
       {"normal", "linear", "hooke or hertz"},
       {"stepping", "half", "second or stock"}},
      {{"a linear law without stiffness", "case slip, k 0",
        std::string("drumlin/check: variable k is '0' ... allowed: ") + positive},
       {"a Hertz law with a stiffness", "k 1e6", "drumlin/check: variable k is '1e6' ... allowed: 0"},
       {"an impact without speed", "vn 0, mu 0.3",
        std::string("drumlin/check: variable vn is '0' ... allowed: ") + positive},
       {"a material of a case without one", "case slip, material glass",
        "drumlin/variables: -var material is 'glass', a variable that this deck does not have"}});
}

BadGroup penetration() {
  return of_deck(
      "Penetration", "benchmarks/in.penetration",
      {{"radius density E e drag ball_radius ball_density ball_E ball_e speed g sample", "0 -1 nan",
        positive},
       {"mu ball_mu", "-0.5", non_negative},
       {"seed columns layers steps_per_contact rows", "0 2.5", whole},
       {"spread", "-0.1", non_negative},
       {"law", "linear", "transition or own"},
       {"stepping", "half", "second or stock"}},
      {{"balls that differ too much", "spread 0.5",
        "drumlin/check: variable spread is '0.5' ... at most 0.3"},
       {"a drag that turns velocities round", "drag 1e6", "drumlin/check: variable drag is '1e6' ... below"},
       {"a ball that meets itself", "columns 3",
        "drumlin/check: variable ball_radius is '0.01' ... half the side of the box", on_two_ranks}});
}

BadGroup biaxial() {
  const std::string lattice = "sample hexagonal, columns 4, layers 5, seating 100, ";
  return of_deck(
      "Biaxial", "soil/in.biaxial",
      {{"side", "0 -1 nan", positive},
       {"strain inertial_number", "0", positive},
       {"rolling", "-0.1", non_negative},
       {"samples_of_strain", "0", whole},
       {"strain", "1", "a finite number below 1, where the platens meet", on_two_ranks},
       {"side", "1e7", below},
       {"sample", "cubic", "hexagonal, square or random"},
       {"dimension", "3", "2"}},
      {{"a platen that never reaches its speed", lattice + "inertial_number 100",
        "drumlin/check: variable inertial_number is '100' ... allowed: a finite number below ... with strain "
        "0.15 and ramp 2000 and dt "},
       {"a test without end", lattice + "inertial_number 1e-20",
        "drumlin/check: variable inertial_number is '1e-20' ... allowed: a finite number above "}});
}

// What differs from the biaxial test, whose deck it shares.
BadGroup triaxial() {
  return of_deck("Triaxial", "soil/in.triaxial",
                 {{"side", "-1", positive, on_two_ranks},
                  {"rows", "0", whole},
                  {"dimension", "2", "3"},
                  {"sample", "hexagonal", "cubic, face_centred or random"}});
}

BadGroup plate() {
  return of_deck(
      "Plate", "soil/in.plate",
      {{"plate_width", "0", positive, on_two_ranks},
       {"plate_thickness plate_density seating max_stress max_settlement drag ratio", "0", positive},
       {"stages ramp every settle_limit", "0", whole},
       {"plate_offset", "left", "a finite number"},
       {"reload", "2", "0 or 1"},
       {"drag", "1e9", below}},
      {{"a plate narrower than a ball of it", "plate_width 0.01",
        "drumlin/check: variable plate_thickness is '0.02' ... allowed: a finite number at most 0.01, which "
        "is plate_width"},
       {"stages below the seating stress", "max_stress 50",
        "drumlin/check: variable seating is '10' ... allowed: a finite number below 8.33333, the stress of "
        "the first stage"},
       {"a ramp that is no multiple", "ramp 700",
        "variable ramp is '700' ... allowed: a multiple of every, which is 500"},
       {"no bed", "bed none.restart",
        "drumlin/variable: variable bed is 'none.restart'; ... ./drumlin run inputs/bed/in.settle -var bed "
        "none.restart",
        on_two_ranks}});
}

/// A test in the plane that moves a plate at a constant speed, on the samples hexagonal and random.
/// \param load the variable that stresses the sample
BadGroup moved_plate(const char *name, const char *deck, const char *load) {
  return of_deck(name, deck,
                 {{load, "0 -1 nan", positive},
                  {"strain inertial_number", "0", positive, on_two_ranks},
                  {"inertial_number", "1e5", below},
                  {"samples_of_strain", "0", whole},
                  {"sample", "cubic", "hexagonal or random"},
                  {"dimension", "3", "2"}});
}

// Variables that in.silo and in.repose have besides those of in.wall.
BadGroup silo() {
  return of_deck("Silo", "soil/in.silo", {{"wall_friction", "-0.1 nan rough", non_negative}},
                 {{"walls with friction, balls without", "friction 0",
                   "drumlin/check: variable friction is '0' ... allowed: a finite number above 0, with "
                   "wall_friction 0.3"}});
}

BadGroup repose() {
  return of_deck("Repose", "soil/in.repose",
                 {{"g", "1e9", below},
                  {"floor", "sand", "balls or plate", on_two_ranks},
                  {"friction", "-0.1", non_negative}});
}

// Decks of the studies.
BadGroup impacts() {
  return of_deck("Impacts", "study/in.impacts",
                 {{"k m2 speed steps_per_contact", "0 nan", positive},
                  {"hertz phases contacts", "-1 2.5", whole},
                  {"out", "out/events.csv", folder, on_two_ranks}});
}

BadGroup reference() {
  return of_deck(
      "Reference", "study/in.reference",
      {{"case", "V", "I, II, III or IV", on_two_ranks}, {"omega m2", "0", positive}, {"cycles", "0", whole}},
      {{"no multiple", "samples_per_cycle 300",
        "drumlin/check: variable steps_per_cycle is '2000' ... allowed: a multiple of samples_per_cycle"}});
}

BadGroup small_bed() {
  return of_deck("SmallBed", "study/in.small_bed",
                 {{"k radius spacing density drum_radius dt", "0 -1", positive},
                  {"D friction ct drum_mass", "-0.5", non_negative, on_two_ranks},
                  {"centre", "left", "a finite number"},
                  {"columns rows settling steps", "0 2.5", whole}});
}

BadGroup stability() {
  return of_deck("Stability", "study/in.stability",
                 {{"scene", "three", "one, two, cross or four", on_two_ranks},
                  {"lowest highest", "0", positive},
                  {"balls half window", "0", whole},
                  {"window", "6000", "a finite number at most 5000"}});
}

BadGroup cost_bed() {
  return of_deck("CostOfABed", "study/in.cost_bed",
                 {{"from", "nowhere", "data, lattice or copies", on_two_ranks},
                  {"sides", "x", "f or p"},
                  {"guards events history", "2", whole},
                  {"data", "none.data", "a file that can be read"}});
}

} // namespace

std::vector<BadGroup> bad_variables() {
  return {chain_way(),
          rocking(),
          chain_choices(),
          chain_numbers(),
          chain_counts(),
          chain_folder(),
          chain_equilibrium(),
          impact(),
          bed_settle(),
          bed_place(),
          bed(),
          oedometer(),
          density(),
          penetration(),
          spheres(),
          biaxial(),
          triaxial(),
          plate(),
          moved_plate("Shear", "soil/in.shear", "normal"),
          moved_plate("RetainingWall", "soil/in.wall", "g"),
          silo(),
          repose(),
          impacts(),
          reference(),
          small_bed(),
          stability(),
          cost_bed()};
}

} // namespace drumlin::test
