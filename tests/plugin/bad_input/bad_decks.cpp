#include "tests/plugin/bad_input/bad_input.h"

namespace drumlin::test {
namespace {

const char *const positive = "allowed: a finite number > 0";
const char *const non_negative = "allowed: a finite number >= 0";
const char *const whole = "allowed: a whole number from ";

/// A value that a variable may not have.
BadInput variable(const std::string &name, const std::string &value, const std::string &allowed,
                  bool two_ranks = false) {
  BadInput input{name + " '" + value + "'",
                 "",
                 {"drumlin/check: ", "variable " + name + " is '" + value + "'; ", allowed}};
  input.variables = {{name, value}};
  input.two_ranks = two_ranks;
  return input;
}

BadInput variables(const std::string &name, const Variables &values, const std::vector<std::string> &says,
                   bool two_ranks = false) {
  BadInput input{name, "", says};
  input.variables = values;
  input.two_ranks = two_ranks;
  return input;
}

BadGroup chain_choices() {
  return {"ChainChoices",
          "chain/in.chain",
          {
              variable("case", "V", "allowed: I, II, III, IV, BW120-63Hz, ", true),
              variable("case", "ii", "allowed: I, II, III, IV, BW120-63Hz, "),
              variable("case", "2", "allowed: I, II, III, IV, BW120-63Hz, "),
              variable("transition", "C", "allowed: A or B", true),
              variable("transition", "AB", "allowed: A or B"),
              variable("stepping", "exact", "allowed: second or stock", true),
              variable("guard", "yes", "allowed: on or off", true),
              variables("two values", {{"k", "1e8 2e8"}},
                        {"drumlin/variables: variable k is '1e8 2e8'", "a value without blanks"}),
              variables("empty value", {{"k", ""}},
                        {"drumlin/variables: variable k is ''", "one value that is not empty"}),
              variables("a quoted number", {{"cycles", "\"5\""}},
                        {"drumlin/variables: variable cycles is '\"5\"'", "a value without blanks, quotes"},
                        true),
              variables("a command", {{"out", "x$(touch pwned)"}},
                        {"drumlin/variables: variable out is 'x$(touch pwned)'", "a value without blanks"}),
              variables("a line end", {{"out", "x\ny"}},
                        {"drumlin/variables: variable out is 'x?y'", "a value without blanks"}),
              variables("a long value", {{"out", std::string(5000, 'x')}},
                        {"drumlin/variables: variable out is 'xxx", "a value of at most 1000 characters"}),
              variables("another case of letters", {{"Case", "III"}},
                        {"drumlin/variables: -var Case is 'III'", "allowed: case, the nearest of case, k, D"},
                        true),
              variables("a misspelt name", {{"step_per_cycle", "1000"}},
                        {"-var step_per_cycle is '1000'", "allowed: steps_per_cycle, the nearest of "}),
          }};
}

BadGroup chain_numbers() {
  BadGroup group{"ChainNumbers", "chain/in.chain", {}};
  for (const char *name : {"k", "omega", "m2", "m3", "k23"})
    for (const char *value : {"0", "-1", "nan", "inf"})
      group.inputs.push_back(variable(name, value, positive, std::string(value) == "-1"));
  for (const char *name : {"D", "Fw", "c23", "g"})
    for (const char *value : {"-0.5", "NaN", "-inf"})
      group.inputs.push_back(variable(name, value, non_negative));
  group.inputs.push_back(variable("k", "stiff", positive, true));
  group.inputs.push_back(variable("k", "100MN/m", positive));
  group.inputs.push_back(variable("k", "1e999", positive));
  for (const char *name : {"k", "omega", "m2"})
    for (const char *value : {"1e-308", "1e308"})
      group.inputs.push_back(variable(name, value, "between 1e-30 and 1e30 in size"));
  group.inputs.push_back(variable("Fw", "58,800", non_negative));
  return group;
}

BadGroup chain_counts() {
  BadGroup group{"ChainCounts", "chain/in.chain", {}};
  for (const char *name : {"cycles", "steps_per_cycle", "samples_per_cycle", "settle_limit"})
    for (const char *value : {"0", "-5", "2.5", "many", "nan", "1e30"})
      group.inputs.push_back(variable(name, value, whole, std::string(value) == "0"));
  group.inputs.push_back(variable("samples_per_cycle", "300", "allowed"));
  group.inputs.back().says = {"variable steps_per_cycle is '2000'",
                              "allowed: a multiple of samples_per_cycle, which is 300"};
  group.inputs.back().two_ranks = true;
  group.inputs.push_back(variable("samples_per_cycle", "4000", "allowed"));
  group.inputs.back().says = {"variable steps_per_cycle is '2000'",
                              "allowed: a multiple of samples_per_cycle, which is 4000"};
  return group;
}

BadGroup chain_folder() {
  const std::string allowed = "allowed: a folder that can be made or written";
  return {"ChainFolder",
          "chain/in.chain",
          {
              variable("out", "out/chain.csv", allowed, true), // a file of the earlier run
              variable("out", "out/chain.csv/below", allowed),
              variable("out", "/dev/null/results", allowed),
              variable("out", "/dev/drumlin", allowed),
              variable("out", "/proc", allowed),
              variable("out", "/", allowed),
              variable("out", "x*", allowed),
          }};
}

BadGroup chain_equilibrium() {
  return {
      "ChainEquilibrium",
      "chain/in.chain",
      {
          variables("no damping",
                    {{"D", "0"}, {"c23", "0"}, {"k", "5.8e4"}, {"guard", "off"}, {"settle_limit", "2000"}},
                    {"drumlin/settle: unbalanced ratio is '", "after 2000 steps", "within 2000 steps",
                     "without damping"},
                    true),
          variables("too soft to carry", {{"k", "1000"}},
                    {"fix guard: overlap of balls ", " of the smaller radius at step ", "at most 1 of it"}),
      }};
}

BadGroup impact() {
  BadGroup group{"Impact", "chain/in.impact", {}};
  group.inputs.push_back(variable("transition", "c", "allowed: A or B", true));
  group.inputs.push_back(variable("stepping", "half", "allowed: second or stock"));
  group.inputs.push_back(variable("guard", "1", "allowed: on or off"));
  for (const char *name : {"k", "m2", "speed"})
    for (const char *value : {"0", "-1", "nan"})
      group.inputs.push_back(variable(name, value, positive));
  group.inputs.push_back(variable("D", "-0.5", non_negative, true));
  group.inputs.push_back(variable("onset", "-1", non_negative));
  for (const char *name : {"steps_per_contact", "contacts", "samples"})
    for (const char *value : {"0", "1.5"})
      group.inputs.push_back(variable(name, value, whole));
  group.inputs.push_back(variable("samples", "3", ""));
  group.inputs.back().says = {"variable steps_per_contact is '2000'",
                              "allowed: a multiple of samples, which is 3"};
  group.inputs.push_back(variable("out", "out/events.csv", "allowed: a folder that can be made or written"));
  return group;
}

/// What all decks of the bed share, tried on the first of them.
BadGroup bed_settle() {
  BadGroup group{"BedSettle", "bed/in.settle", {}};
  group.inputs.push_back(variable("transition", "C", "allowed: A or B", true));
  group.inputs.push_back(variable("stepping", "half", "allowed: second or stock"));
  group.inputs.push_back(variable("tangential", "off", "allowed: coulomb or history"));
  group.inputs.push_back(variable("guard", "1", "allowed: on or off"));
  for (const char *name : {"k", "m2", "m3", "r2", "r3", "k23", "dt", "ratio", "pour_k", "pour_dt"})
    for (const char *value : {"0", "-1", "nan"})
      group.inputs.push_back(variable(name, value, positive));
  for (const char *name :
       {"D", "friction", "rolling", "g", "c23", "drag", "fall", "pour_D", "pour_friction", "pour_rolling"})
    group.inputs.push_back(variable(name, "-0.5", non_negative));
  for (const char *list : {"1e8,-1", "1e8,", "1e8;1e9"})
    group.inputs.push_back(
        variable("k", list, "allowed: a finite number > 0, or several, separated by commas"));
  group.inputs.push_back(variable("settle_limit", "-1", whole));
  group.inputs.push_back(variable("loose", "1", "allowed: a finite number below 1"));
  group.inputs.push_back(variable("loose_steps", "0", whole));
  group.inputs.push_back(
      variables("a case without a file", {{"case", "sand"}},
                {"drumlin/check: variable case is '", "allowed: a file that can be read"}));
  group.inputs.push_back(
      variable("drag", "1e9", "allowed: a finite number below 160000, which is 1/pour_dt"));
  group.inputs.push_back(variable("fall", "1e9", "allowed: a finite number below "));
  group.inputs.push_back(
      variable("balls", "none.data",
               "allowed: a file that can be read, which './drumlin bed --out none.data' makes", true));
  return group;
}

BadGroup bed_place() {
  BadGroup group{"BedPlace", "bed/in.place", {}};
  group.inputs.push_back(variable("settle_limit", "1.5", whole));
  group.inputs.push_back(variable("sink", "-1", non_negative));
  group.inputs.push_back(variable("sink", "1e9", "allowed: a finite number below "));
  group.inputs.push_back(variable("drag", "1e9", "allowed: a finite number below 160000, which is 1/dt"));
  group.inputs.push_back(variable("ratio", "0", positive));
  group.inputs.push_back(
      variable("bed", "none.restart", "./drumlin run inputs/bed/in.settle -var bed none.restart", true));
  return group;
}

BadGroup bed() {
  BadGroup group{"Bed", "bed/in.bed", {}};
  for (const char *name : {"omega", "time_limit"})
    for (const char *value : {"0", "-1", "nan"})
      group.inputs.push_back(variable(name, value, positive));
  group.inputs.push_back(variable("Fw", "-1", non_negative));
  for (const char *name : {"ground_depth", "ground_density", "ground_cp", "ground_cs", "side_height"})
    group.inputs.push_back(variable(name, "300", "allowed: not given with boundary rigid"));
  for (const char *name : {"cycles", "steps_per_cycle", "samples_per_cycle"})
    for (const char *value : {"0", "1.5"})
      group.inputs.push_back(variable(name, value, whole));
  group.inputs.push_back(variable("dumps_per_cycle", "-1", whole));
  group.inputs.push_back(variable("dumps_per_cycle", "3", ""));
  group.inputs.back().says = {"variable steps_per_cycle is '8000'",
                              "allowed: a multiple of dumps_per_cycle, which is 3"};
  group.inputs.push_back(
      variable("start", "none.restart", "./drumlin run inputs/bed/in.place -var start none.restart", true));
  return group;
}

BadGroup oedometer() {
  BadGroup group{"Oedometer", "soil/in.oedometer", {}};
  for (const char *name : {"radius", "density", "k", "kt", "seating", "ratio", "dt", "drag"})
    for (const char *value : {"0", "-1", "nan"})
      group.inputs.push_back(variable(name, value, positive));
  for (const char *name : {"D", "friction", "prepare_friction", "prepare_time"})
    group.inputs.push_back(variable(name, "-0.5", non_negative));
  for (const char *name : {"columns", "rows", "layers", "every", "ramp", "seed"})
    for (const char *value : {"0", "2.5"})
      group.inputs.push_back(variable(name, value, whole));
  group.inputs.push_back(variable("stepping", "half", "allowed: second or stock", true));
  group.inputs.push_back(variable("guard", "1", "allowed: on or off"));
  group.inputs.push_back(variable("dimension", "4", "allowed: 2 or 3"));
  group.inputs.push_back(variables("balls that fall through the plates", {{"spread", "0.9"}},
                                   {"drumlin/check: variable spread is '0.9'",
                                    "allowed: a finite number below 0.481481, so that no ball falls"}));
  group.inputs.push_back(variables("balls that fall through the plates in space",
                                   {{"spread", "0.23"}, {"dimension", "3"}},
                                   {"drumlin/check: variable spread is '0.23'",
                                    "allowed: a finite number below 0.224705, so that no ball falls"}));
  for (const char *drag : {"drag", "prepare_drag"})
    group.inputs.push_back(variable(drag, "1e9", "allowed: a finite number below "));
  group.inputs.push_back(variables(
      "a seating stress that presses balls flat", {{"seating", "1e6"}},
      {"drumlin/check: variable seating is '1e6'", "allowed: a finite number below ", "half a radius"},
      true));
  group.inputs.push_back(variables(
      "a load that presses balls flat", {{"loads", "25 1e6"}},
      {"drumlin/check: variable loads is '1e6'", "allowed: a finite number below ", "half a radius"}));
  group.inputs.push_back(variable("dt", "1", "allowed: a finite number below "));
  group.inputs.push_back(variable("D", "1e9", "unstable under stepping stock"));
  group.inputs.push_back(variables(
      "a density with which the drag is too large", {{"density", "1e20"}},
      {"drumlin/check: variable density is '1e20'", "allowed: a finite number below ", "prepare_drag"}));
  group.inputs.push_back(variables("a drag with which the density does not matter",
                                   {{"density", "1e20"}, {"prepare_drag", "1e9"}},
                                   {"drumlin/check: variable prepare_drag is '1e9'"}));
  group.inputs.push_back(variable("prepare_time", "1e9", "allowed: a finite number below "));
  group.inputs.push_back(variables("a lattice in the plane", {{"sample", "hexagonal"}, {"dimension", "3"}},
                                   {"drumlin/check: variable dimension is '3'", "allowed: 2"}));
  group.inputs.push_back(variables("a seed without random numbers", {{"sample", "cubic"}, {"seed", "2"}},
                                   {"drumlin/check: variable seed is '2'", "allowed: 1"}));
  group.inputs.push_back(
      variables("rows in the plane", {{"rows", "4"}}, {"drumlin/check: variable rows is '4'", "allowed: 1"}));
  group.inputs.push_back(variables("a lattice of several sizes", {{"sample", "cubic"}, {"spread", "0.1"}},
                                   {"drumlin/check: variable spread is '0.1'", "allowed: 0"}));
  group.inputs.push_back(variables("an unknown sample", {{"sample", "clay"}},
                                   {"drumlin/check: variable sample is 'clay'", "allowed: hexagonal"}, true));
  group.inputs.push_back(
      variables("a load of 0", {{"loads", "25 0 50"}}, {"drumlin/check: variable loads is '0'", positive}));
  group.inputs.push_back(variables("a load that is a word", {{"loads", "25 heavy"}},
                                   {"drumlin/check: variable loads is 'heavy'", positive}));
  group.inputs.push_back(variables("a ramp that is no multiple", {{"ramp", "300"}},
                                   {"variable ramp is '300'", "allowed: a multiple of every, which is 200"}));
  return group;
}

BadGroup spheres() {
  BadGroup group{"Spheres", "benchmarks/in.spheres", {}};
  for (const char *name : {"e", "density", "r1", "E", "E2", "contacts", "duration"})
    for (const char *value : {"0", "-1", "nan"})
      group.inputs.push_back(variable(name, value, positive));
  for (const char *name : {"mu", "mu_r", "g", "onset", "ceiling", "vn"})
    group.inputs.push_back(variable(name, "-0.5", non_negative));
  for (const char *name : {"spheres", "every", "steps_per_contact"})
    for (const char *value : {"0", "2.5"})
      group.inputs.push_back(variable(name, value, whole));
  group.inputs.push_back(variable("case", "chung_ooi_9", "allowed: chung_ooi_1", true));
  group.inputs.push_back(variable("material", "gold", "allowed: glass or limestone"));
  group.inputs.push_back(variable("normal", "linear", "allowed: hooke or hertz"));
  group.inputs.push_back(variable("stepping", "half", "allowed: second or stock"));
  group.inputs.push_back(variables("a linear law without stiffness", {{"case", "slip"}, {"k", "0"}},
                                   {"drumlin/check: variable k is '0'", positive}));
  return group;
}

BadGroup biaxial() {
  BadGroup group{"Biaxial", "soil/in.biaxial", {}};
  for (const char *value : {"0", "-1", "nan"})
    group.inputs.push_back(variable("side", value, positive));
  for (const char *name : {"strain", "inertial_number"})
    group.inputs.push_back(variable(name, "0", positive));
  group.inputs.push_back(variable("rolling", "-0.1", non_negative));
  group.inputs.push_back(variable("samples_of_strain", "0", whole));
  group.inputs.push_back(variables(
      "platens that meet", {{"strain", "1"}},
      {"drumlin/check: variable strain is '1'", "allowed: a finite number below 1, where the platens meet"},
      true));
  group.inputs.push_back(variable("side", "1e7", "allowed: a finite number below "));
  group.inputs.push_back(
      variables("an unknown sample", {{"sample", "cubic"}},
                {"drumlin/check: variable sample is 'cubic'", "allowed: hexagonal, square or random"}));
  group.inputs.push_back(variables("a sample in space", {{"dimension", "3"}},
                                   {"drumlin/check: variable dimension is '3'", "allowed: 2"}));
  const Variables lattice = {{"sample", "hexagonal"}, {"columns", "4"}, {"layers", "5"}, {"seating", "100"}};
  Variables fast = lattice;
  fast.insert(fast.end(), {{"inertial_number", "100"}});
  group.inputs.push_back(
      variables("a platen that never reaches its speed", fast,
                {"drumlin/check: variable inertial_number is '100'", "allowed: a finite number below ",
                 "with strain 0.15 and ramp 2000 and dt "}));
  Variables slow = lattice;
  slow.insert(slow.end(), {{"inertial_number", "1e-20"}});
  group.inputs.push_back(
      variables("a test without end", slow,
                {"drumlin/check: variable inertial_number is '1e-20'", "allowed: a finite number above "}));
  return group;
}

// What differs from the biaxial test, whose deck it shares.
BadGroup triaxial() {
  BadGroup group{"Triaxial", "soil/in.triaxial", {}};
  group.inputs.push_back(variable("side", "-1", positive, true));
  group.inputs.push_back(variable("rows", "0", whole));
  group.inputs.push_back(variable("dimension", "2", "allowed: 3"));
  group.inputs.push_back(variable("sample", "hexagonal", "allowed: cubic, face_centred or random"));
  return group;
}

BadGroup plate() {
  BadGroup group{"Plate", "soil/in.plate", {}};
  for (const char *name : {"plate_width", "plate_thickness", "plate_density", "seating", "max_stress",
                           "max_settlement", "drag", "ratio"})
    group.inputs.push_back(variable(name, "0", positive, name == std::string("plate_width")));
  for (const char *name : {"stages", "ramp", "every", "settle_limit"})
    group.inputs.push_back(variable(name, "0", whole));
  group.inputs.push_back(variable("plate_offset", "left", "allowed: a finite number"));
  group.inputs.push_back(variable("reload", "2", "allowed: 0 or 1"));
  group.inputs.push_back(variables("a plate narrower than a ball of it", {{"plate_width", "0.01"}},
                                   {"drumlin/check: variable plate_thickness is '0.02'",
                                    "allowed: a finite number at most 0.01, which is plate_width"}));
  group.inputs.push_back(variable("drag", "1e9", "allowed: a finite number below "));
  group.inputs.push_back(
      variables("stages below the seating stress", {{"max_stress", "50"}},
                {"drumlin/check: variable seating is '10'",
                 "allowed: a finite number below 8.33333, the stress of the first stage"}));
  group.inputs.push_back(variables("a ramp that is no multiple", {{"ramp", "700"}},
                                   {"variable ramp is '700'", "allowed: a multiple of every, which is 500"}));
  group.inputs.push_back(
      variable("bed", "none.restart", "./drumlin run inputs/bed/in.settle -var bed none.restart", true));
  return group;
}

/// A test in the plane that moves a plate at a constant speed, on the samples hexagonal and random.
/// \param load the variable that stresses the sample
BadGroup moved_plate(const char *name, const char *deck, const char *load) {
  BadGroup group{name, deck, {}};
  for (const char *value : {"0", "-1", "nan"})
    group.inputs.push_back(variable(load, value, positive));
  for (const char *rate : {"strain", "inertial_number"})
    group.inputs.push_back(variable(rate, "0", positive, true));
  group.inputs.push_back(variable("inertial_number", "1e5", "allowed: a finite number below "));
  group.inputs.push_back(variable("samples_of_strain", "0", whole));
  group.inputs.push_back(variable("sample", "cubic", "allowed: hexagonal or random"));
  group.inputs.push_back(variable("dimension", "3", "allowed: 2"));
  return group;
}

BadGroup shear() { return moved_plate("Shear", "soil/in.shear", "normal"); }
BadGroup wall() { return moved_plate("RetainingWall", "soil/in.wall", "g"); }

// Variables that in.silo and in.repose have besides those of in.wall.
BadGroup silo() {
  BadGroup group{"Silo", "soil/in.silo", {}};
  for (const char *value : {"-0.1", "nan", "rough"})
    group.inputs.push_back(variable("wall_friction", value, non_negative));
  group.inputs.push_back(variables("walls with friction, balls without", {{"friction", "0"}},
                                   {"drumlin/check: variable friction is '0'",
                                    "allowed: a finite number above 0, with wall_friction 0.3"}));
  return group;
}

BadGroup repose() {
  BadGroup group{"Repose", "soil/in.repose", {}};
  group.inputs.push_back(variable("g", "1e9", "allowed: a finite number below "));
  group.inputs.push_back(variable("floor", "sand", "allowed: balls or plate", true));
  group.inputs.push_back(variable("friction", "-0.1", non_negative));
  return group;
}

} // namespace

std::vector<BadGroup> bad_variables() {
  return {chain_choices(), chain_numbers(), chain_counts(), chain_folder(), chain_equilibrium(),
          impact(),        bed_settle(),    bed_place(),    bed(),          oedometer(),
          spheres(),       biaxial(),       triaxial(),     plate(),        shear(),
          wall(),          silo(),          repose()};
}

} // namespace drumlin::test
