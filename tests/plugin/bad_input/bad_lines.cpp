#include "tests/plugin/bad_input/bad_input.h"
#include "tests/support/host_deck.h"

namespace drumlin::test {
namespace {

// Longer than other functions: it has a line for each mistake and nothing else.
BadGroup drum_excite() {
  const std::string command = "fix drum/excite: ";
  const auto with = [](const std::string &words) { return "fix excite drum drum/excite " + words; };
  const auto more = [&with](const std::string &words) { return with("amplitude 1e3 omega 100 " + words); };
  return {
      "DrumExcite",
      "",
      {
          on_two_ranks(line("nothing", with(""),
                            {command + "keyword amplitude is missing", "amplitude Fw or eccentric me re"})),
          line("no frequency", with("amplitude 1e3"),
               {command + "keyword omega is missing", "omega w or frequency f"}),
          line("no amplitude", with("omega 100"), {command + "keyword amplitude is missing"}),
          line("amplitude without value", with("omega 100 amplitude"),
               {command + "keyword amplitude is missing", ">= 0"}),
          line("amplitude a word", with("amplitude big omega 100"),
               {command + "keyword amplitude is 'big'", "a finite number >= 0"}),
          line("amplitude a number and more", with("amplitude 58.8kN omega 100"),
               {command + "keyword amplitude is '58.8kN'"}),
          on_two_ranks(line("amplitude negative", with("amplitude -1 omega 100"),
                            {command + "keyword amplitude is '-1'", ">= 0"})),
          line("amplitude NaN", with("amplitude nan omega 100"),
               {command + "keyword amplitude is 'nan'", "finite"}),
          line("amplitude infinite", with("amplitude inf omega 100"),
               {command + "keyword amplitude is 'inf'", "finite"}),
          line("amplitude beyond a double", with("amplitude 1e999 omega 100"),
               {command + "keyword amplitude is '1e999'", "finite"}),
          line("two amplitudes", with("amplitude 1 amplitude 2 omega 100"),
               {command + "keyword is 'amplitude', a second amplitude", "once"}),
          line("amplitude and eccentric", with("amplitude 1 eccentric 1 1 omega 100"),
               {command + "keyword is 'eccentric', a second amplitude"}),
          line("eccentric with one value", with("eccentric 10 omega 100"),
               {command + "keyword eccentric, radius is 'omega'", "> 0"}),
          line("eccentric of no mass", with("eccentric 0 0.1 omega 100"),
               {command + "keyword eccentric, mass is '0'", "> 0"}),
          on_two_ranks(line("omega without value", with("amplitude 1 omega"),
                            {command + "keyword omega is missing", "> 0"})),
          line("omega zero", with("amplitude 1 omega 0"), {command + "keyword omega is '0'", "> 0"}),
          line("omega negative", with("amplitude 1 omega -100"),
               {command + "keyword omega is '-100'", "> 0"}),
          line("omega NaN", with("amplitude 1 omega NaN"), {command + "keyword omega is 'NaN'", "> 0"}),
          line("frequency infinite", with("amplitude 1 frequency -inf"),
               {command + "keyword frequency is '-inf'", "> 0"}),
          line("two frequencies", with("amplitude 1 omega 100 frequency 20"),
               {command + "keyword is 'frequency', a second frequency", "once"}),
          line("phase without value", more("phase"),
               {command + "keyword phase is missing", "a finite number"}),
          line("phase a word", more("phase pi"), {command + "keyword phase is 'pi'", "a finite number"}),
          line("start negative", more("start -1"), {command + "keyword start is '-1'", ">= 0"}),
          line("ramp negative", more("ramp -1"), {command + "keyword ramp is '-1'", ">= 0"}),
          on_two_ranks(line("sweep with one value", more("sweep 200"),
                            {command + "keyword sweep, duration is missing", "> 0"})),
          line("sweep without value", more("sweep"),
               {command + "keyword sweep, end frequency is missing", "> 0"}),
          line("sweep in no time", more("sweep 200 0"), {command + "keyword sweep, duration is '0'", "> 0"}),
          line("direction with two", more("direction 0 1"),
               {command + "keyword direction, z is missing", "a finite number"}),
          line("direction with a word", more("direction 0 0 down"),
               {command + "keyword direction, z is 'down'", "a finite number"}),
          line("direction of no length", more("direction 0 0 0"),
               {command + "keyword direction is '0 0 0'", "a length"}),
          line("unknown mode", more("mode circular"),
               {command + "keyword mode is 'circular'", "directed or rotating"}),
          line("mode without value", more("mode"),
               {command + "keyword mode is missing", "directed or rotating"}),
          line("rotating without axis", more("mode rotating"),
               {command + "keyword axis is missing with mode rotating", "axis x y z"}),
          line("axis along the force", more("mode rotating axis 0 0 1"),
               {command + "keyword axis", "cosine", "right angles"}),
          line("axis without rotation", more("axis 0 1 0"),
               {command + "keyword mode is 'directed', with keyword axis", "mode rotating"}),
          line("unknown keyword", more("amplitud 5"),
               {command + "keyword is 'amplitud'", "amplitude", "axis"}),
          on_two_ranks(line("empty group", "fix excite nobody drum/excite amplitude 1 omega 100",
                            {command + "group is 'nobody', which is empty", "at least one ball"})),
          line("no direction and no gravity", "unfix gravity\n" + more(""),
               {command + "keyword direction is missing", "direction x y z"}),
          in_engine_words(line("unknown group", "fix excite nogroup drum/excite amplitude 1 omega 100",
                               {"Could not find fix group ID"})),
          in_engine_words(line("no style", "fix excite drum", {"Illegal fix command"})),
      }};
}

BadGroup bond_spring() {
  const std::string command = "fix bond/spring: ";
  const auto with = [](const std::string &words) { return "fix bond all bond/spring " + words; };
  return {
      "BondSpring",
      "",
      {
          line("nothing", with(""), {command + "ball i is missing", "a whole number from 1"}),
          line("one ball", with("2"), {command + "ball j is missing", "a whole number from 1"}),
          line("no stiffness", with("2 3"), {command + "stiffness k is missing", "> 0"}),
          line("no damping", with("2 3 1e6"), {command + "damping c is missing", ">= 0"}),
          line("ball zero", with("0 3 1e6 1e4"), {command + "ball i is '0'", "a whole number from 1"}),
          line("a fraction of a ball", with("2 2.5 1e6 1e4"),
               {command + "ball j is '2.5'", "a whole number from 1"}),
          line("ball by name", with("drum 3 1e6 1e4"),
               {command + "ball i is 'drum'", "a whole number from 1"}),
          on_two_ranks(line("to itself", with("2 2 1e6 1e4"),
                            {command + "ball j is '2', the same as ball i", "another ball"})),
          on_two_ranks(line("missing ball", with("2 99 1e6 1e4"),
                            {command + "ball is '99', which is not in the box", "the ID of a ball"})),
          line("stiffness zero", with("2 3 0 1e4"), {command + "stiffness k is '0'", "> 0"}),
          on_two_ranks(
              line("stiffness negative", with("2 3 -1e6 1e4"), {command + "stiffness k is '-1e6'", "> 0"})),
          line("stiffness NaN", with("2 3 nan 1e4"), {command + "stiffness k is 'nan'", "> 0"}),
          line("stiffness infinite", with("2 3 inf 1e4"), {command + "stiffness k is 'inf'", "> 0"}),
          line("damping negative", with("2 3 1e6 -1"), {command + "damping c is '-1'", ">= 0"}),
          line("damping a word", with("2 3 1e6 none"), {command + "damping c is 'none'", ">= 0"}),
          line("strength without value", with("2 3 1e6 1e4 strength"),
               {command + "keyword strength is missing", "> 0"}),
          line("strength zero", with("2 3 1e6 1e4 strength 0"), {command + "keyword strength is '0'", "> 0"}),
          line("strength negative", with("2 3 1e6 1e4 strength -5"),
               {command + "keyword strength is '-5'", "> 0"}),
          line("strength NaN", with("2 3 1e6 1e4 strength nan"),
               {command + "keyword strength is 'nan'", "> 0"}),
          line("length without value", with("2 3 1e6 1e4 length"),
               {command + "keyword length", "is missing", "> 0"}),
          line("length a word", with("2 3 1e6 1e4 length now"),
               {command + "keyword length is 'now'", "current or a finite number > 0"}),
          line("length negative", with("2 3 1e6 1e4 length -1"),
               {command + "keyword length", "is '-1'", "> 0"}),
          line("unknown keyword", with("2 3 1e6 1e4 1e5"),
               {command + "keyword is '1e5'", "length or strength"}),
          on_two_ranks(
              in_the_run(line("a ball gets lost", with("2 3 1e6 1e4") + "\nvelocity frame set 0 0 -1e6",
                              {command + "ball is '3', which was lost at step 1", "both balls in the box"}))),
      }};
}

BadGroup boundary_absorb() {
  const std::string command = "fix boundary/absorb: ";
  const auto with = [](const std::string &words) { return "fix floor soil boundary/absorb " + words; };
  const auto more = [with](const std::string &words) {
    return with("normal 0 0 -1 area 1 density 1800 speeds 300 170 " + words);
  };
  return {
      "BoundaryAbsorb",
      "",
      {
          line("nothing", with(""), {command + "keyword normal is missing", "normal x y z"}),
          line("no area", with("normal 0 0 -1"), {command + "keyword area is missing", "area A"}),
          line("no density", with("normal 0 0 -1 area 1"),
               {command + "keyword density is missing", "density rho"}),
          line("no speeds", with("normal 0 0 -1 area 1 density 1800"),
               {command + "keyword speeds is missing", "speeds cp cs"}),
          line("normal of no length", with("normal 0 0 0"),
               {command + "keyword normal is '0 0 0'", "a vector with a length"}),
          line("area zero", with("normal 0 0 -1 area 0"), {command + "keyword area is '0'", "> 0"}),
          line("density negative", with("density -1800"), {command + "keyword density is '-1800'", "> 0"}),
          line("density NaN", with("density nan"), {command + "keyword density is 'nan'", "> 0"}),
          line("one speed", with("speeds 300"),
               {command + "keyword speeds, of shear waves is missing", ">= 0"}),
          line("speed zero", with("speeds 0 0"),
               {command + "keyword speeds, of compression waves is '0'", "> 0"}),
          on_two_ranks(line("shear waves that are faster",
                            with("normal 0 0 -1 area 1 density 1800 speeds 300 301"),
                            {command + "speed of shear waves is '301 m/s'", "at most", "300 m/s"})),
          line("depth zero", more("depth 0"), {command + "keyword depth is '0'", "> 0"}),
          line("depth without value", more("depth"), {command + "keyword depth is missing", "> 0"}),
          line("static a word", more("static maybe"), {command + "keyword static is 'maybe'", "yes or no"}),
          line("unknown keyword", more("stiffness 5"),
               {command + "keyword is 'stiffness'", "normal, area, density, speeds, depth or static"}),
          on_two_ranks(
              line("empty group",
                   "fix floor nobody boundary/absorb normal 0 0 -1 area 1 density 1800 speeds 300 170",
                   {command + "group is 'nobody', which is empty", "the boundary's balls"})),
          line("static behind the integration", "fix early soil nve/sphere\n" + more("static yes"),
               {command + "keyword static is 'yes' behind fix ", "which integrates",
                "before all fixes that integrate balls of the boundary"}),
      }};
}

BadGroup clump() {
  const std::string command = "fix clump: ";
  return {
      "Clump",
      "",
      {
          line("a word too many", "fix body drum clump rigid",
               {command + "argument is 'rigid'", "fix ID group clump"}),
          line("group all", "fix body all clump", {command + "group is 'all'", "the balls of the body"}),
          on_two_ranks(line("empty group", "fix body nobody clump",
                            {command + "group is 'nobody', which is empty", "balls of the body"})),
          on_two_ranks(line("a ball in two", "fix one drum clump\nfix two roller clump",
                            {command + "group is 'drum', of which 1 balls are in the clump '",
                             "each ball in one clump only"})),
          line("a force fix after it", "fix body drum clump\nfix bond all bond/spring 2 3 1e6 1e4",
               {command + "group is 'drum', on which the later fix bond (bond/spring) exerts forces",
                "after all fixes"}),
          on_two_ranks(line("unequal velocities", "velocity drum set 0 0 -1 units box\nfix body roller clump",
                            {command + "velocity of the balls of group roller along z is '-1 to 0 m/s'",
                             "one velocity for all balls of a body"})),
          in_the_run(line("unequal velocities in a second run",
                          "fix body roller clump\nrun 5\nvelocity frame set 2 0 0 units box sum yes",
                          {command + "velocity of the balls of group roller along x is '0 to 2 m/s'",
                           "one velocity for all balls of a body"})),
      }};
}

BadGroup contact_events() {
  const std::string command = "fix contact/events: ";
  const auto with = [](const std::string &words) { return "fix events all contact/events " + words; };
  return {"ContactEvents",
          "",
          {
              line("nothing", with(""), {command + "keyword file is missing", "file NAME"}),
              line("file not first", with("types 1 2 file out/x.csv"),
                   {command + "keyword file is missing", "as the first keyword"}),
              line("file without name", with("file"),
                   {command + "keyword file is missing", "a folder that exists"}),
              on_two_ranks(line("file in no folder", with("file nowhere/x.csv"),
                                {command + "keyword file is 'nowhere/x.csv', which cannot be written",
                                 "a file in a folder that exists"})),
              line("a folder as file", with("file out"),
                   {command + "keyword file is 'out', which cannot be written",
                    "a file in a folder that exists"}),
              line("one type", with("file out/x.csv types 1"),
                   {command + "keyword types is missing", "a whole number from 1 to 3"}),
              line("type 0", with("file out/x.csv types 0 1"),
                   {command + "keyword types is '0'", "a whole number from 1 to 3"}),
              line("type 4", with("file out/x.csv types 1 4"),
                   {command + "keyword types is '4'", "a whole number from 1 to 3"}),
              line("types by star", with("file out/x.csv types * 2"),
                   {command + "keyword types is '*'", "a whole number from 1 to 3"}),
              line("append without value", with("file out/x.csv append"),
                   {command + "keyword append is missing", "yes or no"}),
              line("append a number", with("file out/x.csv append 1"),
                   {command + "keyword append is '1'", "yes or no"}),
              line("unknown keyword", with("file out/x.csv every 10"),
                   {command + "keyword is 'every'", "types, between or append"}),
              line("between one group", with("file out/x.csv between soil"),
                   {command + "keyword between is missing", "the name of a group"}),
              on_two_ranks(line("between an unknown group", with("file out/x.csv between soil rock"),
                                {command + "keyword between is 'rock'", "the name of a group"})),
          }};
}

BadGroup contact_local() {
  const std::string command = "fix contact/local: ";
  const auto with = [](const std::string &words) { return "fix contacts all contact/local " + words; };
  return {
      "ContactLocal",
      "",
      {
          line("nothing", with(""), {command + "keyword is missing", "every"}),
          line("no number", with("every"), {command + "keyword every is missing", "a whole number from 1"}),
          line("every zero", with("every 0"), {command + "keyword every is '0'", "a whole number from 1"}),
          line("every a fraction", with("every 0.5"),
               {command + "keyword every is '0.5'", "a whole number from 1"}),
          on_two_ranks(
              line("another keyword", with("file out/x.csv"), {command + "keyword is 'file'", "every"})),
          line("a word too many", with("every 10 append yes"), {command + "argument is 'append'", "every N"}),
      }};
}

BadGroup contact_energy() {
  const std::string command = "fix contact/energy: ";
  return {"ContactEnergy",
          "",
          {
              on_two_ranks(line("a word too many", "fix energy all contact/energy every 10",
                                {command + "argument is 'every'", "fix ID group contact/energy"})),
          }};
}

BadInput with_the_stock_law(const std::string &lines, const std::string &command) {
  BadInput input = line("the stock law, " + command, lines,
                        {command + ": pair_style is '", "pair_style gran model hooke/transition"});
  input.pair = "pair_style gran model hooke/stiffness\npair_coeff * *\n" + property("kn", "1e7") +
               property("kt", "1e7") + property("gamman", "1") + property("gammat", "1");
  return input;
}

// Longer than other functions: it has a line for each mistake and nothing else.
BadGroup roller_history() {
  const std::string command = "fix roller/history: ";
  const auto with = [](const std::string &words) { return "fix history drum roller/history " + words; };
  const auto more = [&with](const std::string &words) { return with("file out/x.csv every 10 " + words); };
  return {
      "RollerHistory",
      "",
      {
          line("nothing", with(""), {command + "keyword file is missing", "file NAME every N"}),
          line("no interval", with("file out/x.csv"),
               {command + "keyword every is missing", "file NAME every N"}),
          line("file without name", with("every 10 file"),
               {command + "keyword file is missing", "a folder that exists"}),
          line("every without value", with("file out/x.csv every"),
               {command + "keyword every is missing", "a whole number from 1"}),
          line("every zero", with("file out/x.csv every 0"),
               {command + "keyword every is '0'", "a whole number from 1"}),
          line("every negative", with("file out/x.csv every -10"),
               {command + "keyword every is '-10'", "a whole number from 1"}),
          line("every a fraction", with("file out/x.csv every 0.5"),
               {command + "keyword every is '0.5'", "a whole number from 1"}),
          line("every beyond an int", with("file out/x.csv every 3000000000"),
               {command + "keyword every is '3000000000'", "2147483647"}),
          on_two_ranks(line("file in no folder", with("file nowhere/x.csv every 10"),
                            {command + "keyword file is 'nowhere/x.csv', which cannot be written",
                             "a file in a folder that exists"})),
          line("file in no folder, after a good one",
               "fix events all contact/events file out/events.csv\n" + with("file nowhere/x.csv every 10"),
               {command + "keyword file is 'nowhere/x.csv', which cannot be written"}),
          line("a folder as cycles file", more("cycles out 10"),
               {command + "keyword cycles is 'out', which cannot be written", "a folder that exists"}),
          line("cycles without steps", more("cycles out/y.csv"),
               {command + "keyword cycles, steps per cycle is missing", "from 1"}),
          line("cycles of no steps", more("cycles out/y.csv 0"),
               {command + "keyword cycles, steps per cycle is '0'", "from 1"}),
          line("unknown frame group", more("frame top"),
               {command + "keyword frame is 'top'", "the name of a group"}),
          line("frame without group", more("frame"),
               {command + "keyword frame is missing", "the name of a group"}),
          line("empty frame group", more("frame nobody"),
               {command + "keyword frame is 'nobody', which is empty", "frame's balls"}),
          line("unknown soil group", more("soil mud"),
               {command + "keyword soil is 'mud'", "the name of a group"}),
          line("soil without group", more("soil"),
               {command + "keyword soil is missing", "the name of a group"}),
          line("soil without cycles", more("frame frame soil soil"),
               {command + "keyword frame or cycles is missing with keyword soil", "all three"}),
          line("empty soil group", more("frame frame soil nobody cycles out/y.csv 10"),
               {command + "keyword soil is a group that is empty", "the soil balls"}),
          on_two_ranks(line("unknown excite", more("excite motor"),
                            {command + "keyword excite is 'motor'", "ID of a fix drum/excite"})),
          line("excite of another style", more("excite gravity"),
               {command + "keyword excite is 'gravity'", "ID of a fix drum/excite"}),
          line("excite without ID", more("excite"),
               {command + "keyword excite is missing", "ID of a fix drum/excite"}),
          line("unknown bond", more("bond spring"),
               {command + "keyword bond is 'spring'", "ID of a fix bond/spring"}),
          line("bond without ID", more("bond"),
               {command + "keyword bond is missing", "ID of a fix bond/spring"}),
          line("axis with two", more("axis 0 1"),
               {command + "keyword axis, z is missing", "a finite number"}),
          line("axis of no length", more("axis 0 0 0"), {command + "keyword axis is '0 0 0'", "a length"}),
          line("origin with one", more("origin 0.75"),
               {command + "keyword origin, of the frame is missing", "a finite number"}),
          line("append a word", more("append always"), {command + "keyword append is 'always'", "yes or no"}),
          line("unknown keyword", more("types 1 2"),
               {command + "keyword is 'types'", "file, every", "append"}),
          line("empty group", "fix history nobody roller/history file out/x.csv every 10",
               {command + "group is 'nobody', which is empty", "the drum's balls"}),
          line("no axis and no gravity", "unfix gravity\n" + more(""),
               {command + "keyword axis is missing", "axis x y z"}),
          on_two_ranks(
              line("cycles and a time step that varies", "fix dt all dt/reset 1 1e-6 1e-4 1e-5 units box",
                   {command +
                        "keyword cycles is '10' steps per cycle, and fix dt (dt/reset) changes the time step",
                    "one time step as long as the fix is defined, or no keyword cycles"})),
          in_the_run(line("cycles and two time steps", more("cycles out/c.csv 10") + "\nrun 5\ntimestep 2e-5",
                          {command + "keyword cycles is '10' steps per cycle, and the time step has changed "
                                     "from 1e-05 to 2e-05 s",
                           "one time step as long as the fix is defined, or no keyword cycles"})),
          with_the_stock_law(with("file out/x.csv every 10"), "fix roller/history"),
          on_two_ranks(
              with_the_stock_law("fix events all contact/events file out/x.csv", "fix contact/events")),
          with_the_stock_law("fix contacts all contact/local every 10", "fix contact/local"),
          with_the_stock_law("fix energy all contact/energy", "fix contact/energy"),
      }};
}

BadGroup guard() {
  const std::string command = "fix guard: ";
  // No formula of the engine makes a NaN from words; an overflow does.
  const std::string undefined = "variable undefined equal (1e300*1e300)*0\n";
  const std::string addforce = undefined + "fix wrong drum addforce 0 0 v_undefined\n";
  return {
      "Guard",
      "",
      {
          line("every zero", "fix guard all guard every 0",
               {command + "keyword every is '0'", "a whole number from 1"}),
          line("every without value", "fix guard all guard every",
               {command + "keyword every is missing", "a whole number from 1"}),
          line("watch of version 0.1.0", "fix guard all guard watch off",
               {command + "keyword is 'watch'", "every, links, step or overlap"}),
          line("unknown keyword", "fix guard all guard on",
               {command + "keyword is 'on'", "every, links, step or overlap"}),
          line("links zero", "fix guard all guard links 0",
               {command + "keyword links is '0'", "a whole number from 1"}),
          line("step without value", "fix guard all guard step",
               {command + "keyword step is missing", "a finite number > 0"}),
          line("step zero", "fix guard all guard step 0",
               {command + "keyword step is '0'", "a finite number > 0"}),
          line("overlap is no number", "fix guard all guard overlap half",
               {command + "keyword overlap is 'half'", "a finite number > 0"}),
          on_two_ranks(in_the_run(
              line("step beyond the critical one", "fix bond all bond/spring 2 3 1e15 0\nfix guard all guard",
                   {command + "time step is '1e-05 s' at step 0, where ball 3 has the critical step "
                              "1.531e-06 s (mostly because of the link of balls 2 and 3)",
                    "at most 1.531e-06 s"}))),
          on_two_ranks(in_the_run(line(
              "a ball in a ball", "displace_atoms drum move 0 0 -0.6 units box\nfix guard all guard",
              {command + "overlap of balls ", " is '1.2' of the smaller radius at step 0", "at most 0.5"}))),
          on_two_ranks(in_the_run(line("NaN at the start", addforce + "fix guard all guard",
                                       {command + "ball 2 is '", "at step 0; allowed: finite numbers"}))),
          on_two_ranks(
              in_the_run(line("NaN in the run",
                              "fix guard all guard\n" + undefined +
                                  "fix wrong drum addforce 0 0 0\nrun 5\nunfix wrong\nfix wrong drum "
                                  "addforce 0 0 v_undefined",
                              {command + "ball 2 is '", "m/s, 0 0 ", "at step 6; allowed: finite numbers"}))),
          in_the_run(line("NaN seen by the history", "fix guard all guard every 7\n" + addforce,
                          {"fix roller/history: drum is '", " at step 1", "finite position and velocity"})),
          in_the_run(line("infinite velocity",
                          "fix guard all guard\nvelocity drum set 0 0 1e308 units box\nvelocity drum set 0 0 "
                          "1e308 sum yes units box",
                          {command + "ball 2 is '", "m, 0 0 inf m/s, ", "at step 0; allowed: "})),
      }};
}

BadGroup check() {
  const std::string command = "drumlin/check: ";
  return {
      "Check",
      "",
      {
          line("nothing", "drumlin/check", {command + "the variable's name is missing"}),
          line("no value", "drumlin/check k", {command + "the value of variable k is missing"}),
          line("no rule", "drumlin/check k 1", {command + "the rule for variable k is missing", "one_of"}),
          on_two_ranks(line("unknown rule", "drumlin/check k 1 small",
                            {command + "rule for variable k is 'small'", "multiple_of"})),
          line("no choice", "drumlin/check k 1 one_of",
               {command + "word of rule one_of for variable k is missing"}),
          line("another choice", "drumlin/check k z one_of x y", {command + "variable k is 'z'", "x or y"}),
          line("words left over", "drumlin/check k 1 positive 2",
               {command + "argument behind the rule for variable k is '2'", "one value and one rule"}),
          line("not positive", "drumlin/check k 0 positive",
               {command + "variable k is '0'", "a finite number > 0"}),
          line("not non-negative", "drumlin/check k -1e-9 non_negative",
               {command + "variable k is '-1e-9'", "a finite number >= 0"}),
          line("not finite", "drumlin/check k inf finite",
               {command + "variable k is 'inf'", "a finite number"}),
          line("not a number", "drumlin/check k 0x10 finite",
               {command + "variable k is '0x10'", "a finite number"}),
          line("integer without range", "drumlin/check k 1 integer",
               {command + "rule integer, lowest is missing"}),
          line("integer without end", "drumlin/check k 1 integer 1",
               {command + "rule integer, highest is missing"}),
          line("out of range", "drumlin/check k 11 integer 1 10",
               {command + "variable k is '11'", "a whole number from 1 to 10"}),
          line("a fraction", "drumlin/check k 2.5 integer 1 10",
               {command + "variable k is '2.5'", "a whole number from 1 to 10"}),
          line("no limit", "drumlin/check k 1 below", {command + "rule below, the limit is missing"}),
          line("not below", "drumlin/check k 2 below 2 which is twice m",
               {command + "variable k is '2'; allowed: a finite number below 2, which is twice m"}),
          line("not above", "drumlin/check k 2 above 2",
               {command + "variable k is '2'; allowed: a finite number above 2"}),
          line("more than at most", "drumlin/check k 2.5 at_most 2",
               {command + "variable k is '2.5'; allowed: a finite number at most 2"}),
          line("a limit for a word", "drumlin/check k nan below 2",
               {command + "variable k is 'nan'", "below 2"}),
          line("multiple of nothing", "drumlin/check k 1 multiple_of",
               {command + "rule multiple_of, the other variable's name is missing"}),
          line("no multiple", "drumlin/check k 10 multiple_of n 4",
               {command + "variable k is '10'", "a multiple of n, which is 4"}),
          line("multiple of zero", "drumlin/check k 10 multiple_of n 0",
               {command + "variable k is '10'", "a multiple of n, which is 0"}),
          on_two_ranks(
              line("no restart file", "drumlin/check start nowhere restart stage ten",
                   {command + "variable start is 'nowhere'", "a restart file of drumlin/write_restart"})),
          line("note without value", "drumlin/check start nowhere restart stage",
               {command + "the value of note stage is missing"}),
          line("no data file", "drumlin/check balls nowhere data_file",
               {command + "variable balls is 'nowhere'", "a data file with atoms"}),
          on_two_ranks(line("no name of a restart file", "drumlin/check bed nowhere/x restart_name",
                            {command + "variable bed is 'nowhere/x'", "a file in a folder that exists"})),
          on_two_ranks(line("a file as folder", "drumlin/check out pair/x directory",
                            {command + "variable out is 'pair/x'", "a folder that can be made or written"})),
          in_engine_words(
              line("unknown command", "drumlin/chek k 1 positive", {"Unknown command: drumlin/chek"})),
      }};
}

BadGroup record() {
  const std::string command = "drumlin/record: ";
  return {
      "Record",
      "",
      {
          line("nothing", "drumlin/record", {command + "file is missing", "a file in a folder that exists"}),
          line("name without value", "drumlin/record out/x.csv k", {command + "the value of k is missing"}),
          on_two_ranks(line("file in no folder", "drumlin/record nowhere/x.csv k 1",
                            {command + "file is 'nowhere/x.csv', which cannot be written",
                             "a file in a folder that exists"})),
      }};
}

BadGroup run() {
  const std::string command = "drumlin/run: ";
  return {
      "Run",
      "",
      {
          line("nothing", "drumlin/run", {command + "the last step is missing", "a whole number from 0"}),
          line("last step a word", "drumlin/run soon every 10",
               {command + "the last step is 'soon'", "a whole number from 0"}),
          line("last step in the past", "run 20\ndrumlin/run 10 every 10",
               {command + "the last step is '10'", "at least 20, the present step"}),
          line("every zero", "drumlin/run 10 every 0",
               {command + "keyword every is '0'", "a whole number from 1"}),
          line("limit zero", "drumlin/run 10 every 10 limit 0", {command + "keyword limit is '0'", "> 0"}),
          line("limit without restart", "drumlin/run 10 every 10 limit 60",
               {command + "keyword restart is missing with keyword limit", "limit SECONDS restart FILE"}),
          line("restart without file", "drumlin/run 10 every 10 restart",
               {command + "keyword restart is missing", "a file in a folder that exists"}),
          on_two_ranks(line("restart in no folder", "drumlin/run 10 every 10 limit 60 restart nowhere/x",
                            {command + "keyword restart is 'nowhere/x', which cannot be written",
                             "a file in a folder that exists"})),
          line("unknown keyword", "drumlin/run 10 every 10 for 3",
               {command + "keyword is 'for'", "every, limit or restart"}),
      }};
}

BadGroup write_restart() {
  const std::string command = "drumlin/write_restart: ";
  return {"WriteRestart",
          "",
          {
              line("nothing", "drumlin/write_restart",
                   {command + "file is missing", "a file in a folder that exists"}),
              line("name without value", "drumlin/write_restart out/x bed",
                   {command + "the value of note bed is missing"}),
              line("name with a star", "drumlin/write_restart out/x.*",
                   {command + "file is 'out/x.*', which cannot be written", "without * and %"}),
              on_two_ranks(line("file in no folder", "drumlin/write_restart nowhere/x bed soil",
                                {command + "file is 'nowhere/x', which cannot be written",
                                 "a file in a folder that exists"})),
          }};
}

BadGroup write_data() {
  const std::string command = "drumlin/write_data: ";
  return {"WriteData",
          "",
          {
              line("nothing", "drumlin/write_data",
                   {command + "file is missing", "a file in a folder that exists"}),
              line("unknown variable", "drumlin/write_data out/x values_of depth",
                   {command + "keyword values_of is 'depth'", "the names of variables"}),
              on_two_ranks(line("file in no folder", "drumlin/write_data nowhere/x bed soil",
                                {command + "file is 'nowhere/x', which cannot be written",
                                 "a file in a folder that exists"})),
          }};
}

BadGroup outputs() {
  const std::string command = "drumlin/outputs: ";
  return {
      "Outputs",
      "",
      {
          line("unknown keyword", "drumlin/outputs empty out",
               {command + "keyword is 'empty'", "folder, subfolder, continue, files, restart or numbered"}),
          line("folder without path", "drumlin/outputs folder",
               {command + "keyword folder is missing", "a folder"}),
          line("continue without time", "drumlin/outputs continue 5",
               {command + "keyword continue, time is missing", ">= 0"}),
          line("numbered without suffix", "drumlin/outputs numbered out/dump balls_",
               {command + "keyword numbered, suffix is missing"}),
          on_two_ranks(line("a file as folder", "drumlin/outputs folder out/chain.csv files x.csv",
                            {command + "folder is 'out/chain.csv'", "one that can be made"})),
          on_two_ranks(
              line("a folder as file", "drumlin/outputs files out",
                   {command + "file is 'out', which cannot be written", "a file in a folder that exists"})),
          on_two_ranks(line("a file that was read",
                            "drumlin/outputs folder out files chain.csv inputs ./out/chain.csv",
                            {command + "file is 'out/chain.csv'",
                             "another file than './out/chain.csv', which the run has read"})),
          on_two_ranks(
              line("a folder with other files", "drumlin/outputs numbered out balls_ .vtp",
                   {command + "folder is 'out' with the file '", "a folder with nothing but dumps"})),
      }};
}

BadGroup surface() {
  const std::string command = "drumlin/surface: ";
  return {
      "Surface",
      "",
      {
          line("no variable", "drumlin/surface", {command + "variable is missing", "the name of a variable"}),
          line("no group", "drumlin/surface h", {command + "group is missing", "the name of a group"}),
          line("unknown group", "drumlin/surface h rock spacing 0.1",
               {command + "group is 'rock'", "the name of a group"}),
          line("no spacing", "drumlin/surface h soil", {command + "keyword spacing is missing", "> 0"}),
          line("spacing zero", "drumlin/surface h soil spacing 0",
               {command + "keyword spacing is '0'", "> 0"}),
          line("spacing tiny", "drumlin/surface h soil spacing 1e-9",
               {command + "keyword spacing is '1e-09'", "at most 1e+07 lines"}),
          line("beyond without x", "drumlin/surface h soil spacing 0.1 beyond 1",
               {command + "keyword beyond, x is missing", "a finite number"}),
          line("beyond negative", "drumlin/surface h soil spacing 0.1 beyond -1 0",
               {command + "keyword beyond, distance is '-1'", ">= 0"}),
          line("unknown keyword", "drumlin/surface h soil width 0.1",
               {command + "keyword is 'width'", "spacing or beyond"}),
          on_two_ranks(line("nothing there", "drumlin/surface h soil spacing 0.1 beyond 1.9 0",
                            {command + "group is 'soil'", "one with a ball that a vertical line meets"})),
      }};
}

BadGroup layers() {
  const std::string command = "drumlin/layers: ";
  return {
      "Layers",
      "",
      {
          line("nothing", "drumlin/layers", {command + "keyword is missing", "k"}),
          line("keywords in another order", "drumlin/layers D 0.1", {command + "keyword is 'D'", "k"}),
          line("no list", "drumlin/layers k", {command + "keyword k is missing", "a number for each layer"}),
          line("k zero", "drumlin/layers k 0", {command + "keyword k is '0'", "> 0"}),
          line("a word in a list", "drumlin/layers k 1e8,soft", {command + "keyword k is '1e8,soft'", "> 0"}),
          line("an empty entry", "drumlin/layers k 1e8,", {command + "keyword k is '1e8,'", "> 0"}),
          on_two_ranks(line("more layers than types", "drumlin/layers k 1e8,1e9",
                            {command + "keyword k is '1e8,1e9'", "one number, since the bed has one layer"})),
          on_two_ranks(line("k too stiff for the time step",
                            "timestep 1e-3\ndrumlin/layers k 1e18 D 0 friction 0 rolling off 0",
                            {command + "keyword k is '1e18', with which two of the lightest balls of layer 1 "
                                       "have the critical step ",
                             "with the time step 0.001 s"})),
          on_two_ranks(line("D too large for the time step",
                            "timestep 1e-6\npair_style gran model hooke/transition damping ratio stepping "
                            "stock\ndrumlin/layers k 1e8 D 1e9 friction 0 rolling off 0",
                            {command + "keyword D is '1e9', with which two of the lightest balls of layer 1 "
                                       "have the critical step ",
                             "with the time step 1e-06 s"})),
          line("a list that has a variable",
               "drumlin/layers k 0 D 0 friction 0 rolling off 0 variables pour_k D f r",
               {command + "variable pour_k is '0'", "> 0"}),
          line("a list whose variable follows another",
               "variable k index 0\ndrumlin/layers k 0 D 0 friction 0 rolling off 0 variables pour_k/k D f r",
               {command + "variable k is '0'", "> 0"}),
          line("D negative", "drumlin/layers k 1e8 D -0.1", {command + "keyword D is '-0.1'", ">= 0"}),
          line("friction negative", "drumlin/layers k 1e8 D 0 friction -1",
               {command + "keyword friction is '-1'", ">= 0"}),
          line("no model of rolling", "drumlin/layers k 1e8 D 0 friction 0.5 rolling 0.1",
               {command + "keyword rolling, model is '0.1'", "off or epsd2"}),
          line("rolling negative", "drumlin/layers k 1e8 D 0 friction 0.5 rolling off -1",
               {command + "keyword rolling is '-1'", ">= 0"}),
          line("a word too many", "drumlin/layers k 1e8 D 0 friction 0.5 rolling off 0 all",
               {command + "argument is 'all'", "k LIST D LIST"}),
      }};
}

BadGroup pick() {
  const std::string command = "drumlin/pick: ";
  return {
      "Pick",
      "",
      {
          line("nothing", "drumlin/pick", {command + "variable is missing", "the name of a variable"}),
          line("not which", "drumlin/pick x", {command + "which is missing", "largest, or the place"}),
          line("a place between", "drumlin/pick x 1.5 1,2", {command + "which is '1.5'", "from 1"}),
          line("a place too high", "drumlin/pick x 3 1,2", {command + "which is '3'", "at most 2"}),
          line("no list", "drumlin/pick x 1", {command + "list is missing", "separated by commas"}),
          line("a word", "drumlin/pick x largest 1,soft", {command + "list is '1,soft'", "finite numbers"}),
          line("a word too many", "drumlin/pick x 1 1 2",
               {command + "argument is '2'", "a variable, which number, and a list"}),
      }};
}

BadGroup take() {
  const std::string command = "drumlin/take: ";
  return {"Take",
          "",
          {
              line("nothing", "drumlin/take", {command + "file is missing"}),
              line("no decks", "drumlin/take out/x", {command + "the list of decks is missing"}),
              on_two_ranks(line(
                  "no notes", "drumlin/take out/chain.csv in.settle none fixed k",
                  {command + "file is 'out/chain.csv', which does not note the value of k", "in.settle"})),
              on_two_ranks(line("no file", "drumlin/take nofile in.settle none fixed k",
                                {command + "file is 'nofile'; allowed: a file that can be read"})),
              line("a folder", "drumlin/take out in.settle none if_noted k",
                   {command + "file is 'out'; allowed: a file that can be read"}),
              line("a change that is not free", "drumlin/take out/chain.csv in.settle m2 fixed m2 free k",
                   {command + "variable allow_change is 'm2'", "none, or names between commas out of k"}),
          }};
}

BadGroup variables() {
  return {
      "Variables", "", {line("nothing", "drumlin/variables", {"drumlin/variables: the names are missing"})}};
}

BadGroup settle() {
  const std::string command = "drumlin/settle: ";
  return {
      "Settle",
      "",
      {
          line("ratio without value", "drumlin/settle ratio", {command + "keyword ratio is missing", "> 0"}),
          line("ratio zero", "drumlin/settle ratio 0", {command + "keyword ratio is '0'", "> 0"}),
          line("ratio a word", "drumlin/settle ratio small", {command + "keyword ratio is 'small'", "> 0"}),
          line("every zero", "drumlin/settle every 0",
               {command + "keyword every is '0'", "a whole number from 1"}),
          line("limit negative", "drumlin/settle limit -1",
               {command + "keyword limit is '-1'", "a whole number from 0"}),
          line("fixed without group", "drumlin/settle fixed",
               {command + "keyword fixed is missing", "the name of a group"}),
          line("unknown fixed group", "drumlin/settle fixed rock",
               {command + "keyword fixed is 'rock'", "the name of a group"}),
          line("unknown keyword", "drumlin/settle steps 10",
               {command + "keyword is 'steps'", "ratio, every, limit, force, loose or fixed"}),
          line("loose negative", "drumlin/settle loose -1 100",
               {command + "keyword loose, share is '-1'", ">= 0"}),
          line("loose without steps", "drumlin/settle loose 0.1",
               {command + "keyword loose, steps is missing", "a whole number from 1"}),
          line("more than the loose balls", "drumlin/settle limit 10 every 1 loose 1e-3 5 fixed soil",
               {command + "unbalanced ratio is '", "after 10 steps"}),
          line("force zero", "drumlin/settle force 0", {command + "keyword force is '0'", "> 0"}),
          line("force without value", "drumlin/settle force", {command + "keyword force is missing", "> 0"}),
          on_two_ranks(
              line("limit too short", "drumlin/settle limit 10 fixed soil",
                   {command + "unbalanced ratio is '", "after 10 steps", "at most 1e-10 within 10 steps"})),
      }};
}

/// What decks have besides the plugin.
BadGroup other_styles() {
  const std::string pair = "pair_style gran model hooke/transition: ";
  return {
      "OtherStyles",
      "",
      {
          on_two_ranks(line("run_style respa 2 2", {pair + "run_style is 'respa'", "verlet"})),
          on_two_ranks(line(
              "neighbor 0.25 multi",
              {pair + "neighbor style is 'multi', with which this engine finds no contact", "bin or nsq"})),
          on_two_ranks(line(
              "fix slow all momentum 10 linear 1 1 1",
              {pair + "stepping is 'second' and fix slow (momentum) changes velocities", "stepping stock"})),
          line("unfix integrate\nfix slow all nve/limit absolute 0.1",
               {pair + "stepping is 'second' and fix slow (nve/limit) changes velocities", "stepping stock"}),
          in_the_run(
              line("another time step without a set-up", "run 5\ntimestep 2e-5\nrun 5 pre no",
                   {"stepping second: time step is '2e-05' at step 6, changed from 1e-05 s within a run",
                    "no keyword pre no"})),
      }};
}

BadGroup other_styles_in_lammps() {
  const std::string pair = "pair_style gran/hooke/transition: ", good = lammps_pair_style,
                    moves = good + "fix move all nve/sphere\n";
  return in_lammps(
      "OtherStylesInLammps",
      {on_two_ranks(line(good + "run_style respa 2 2", {pair + "run_style is 'respa'", "verlet"})),
       on_two_ranks(
           line(good + "minimize 1e-6 1e-6 10 10",
                {pair + "command is 'minimize', which does not move balls in time", "allowed: run"})),
       line(good + "min_style quickmin\nminimize 1e-6 1e-6 10 10",
            {pair + "command is 'minimize', which does not move balls in time", "allowed: run"}),
       line(moves + "dump d all custom 5 out/all.dump id type x y z vx vy vz\nrun 10\nundump d\nrerun "
                    "out/all.dump dump x y z vx vy vz",
            {pair + "command is 'rerun', which does not move balls in time", "allowed: run"}),
       on_two_ranks(line(good + "fix cool all temp/berendsen 1 1 0.1",
                         {pair + "stepping is 'second' and fix cool (temp/berendsen) changes velocities",
                          "stepping stock"})),
       line(good + "fix move all nve/limit 0.01",
            {pair + "stepping is 'second' and fix move (nve/limit) changes velocities", "stepping stock"}),
       line(good + "fix back all wall/reflect zlo -1.9",
            {pair + "stepping is 'second' and fix back (wall/reflect) changes velocities", "stepping stock"}),
       line("variable half equal 0.5\npair_style hybrid/scaled v_half gran/hooke/transition 1.0 lj/cut 0.1\n"
            "pair_coeff * * lj/cut 0 1\npair_coeff * * gran/hooke/transition 1e5 0.2",
            {pair + "pair_style is 'hybrid/scaled'", "hybrid or hybrid/overlay"})});
}

BadGroup fixes_in_lammps() {
  const std::string good = lammps_pair_style, absorb = "fix boundary/absorb",
                    ground = good + "fix ground all boundary/absorb ",
                    whole = ground + "normal 0 0 -1 area 1 density 1800 speeds 300 170";
  return in_lammps(
      "FixesInLammps",
      {line(good + "fix guard all guard every 0", {"fix guard", "keyword every is '0'"}),
       line(good + "fix excite all drum/excite amplitude 1 omega -1",
            {"fix drum/excite", "keyword omega is '-1'"}),
       line(ground, {absorb, "keyword normal is missing", "normal x y z"}),
       line(ground + "normal 0 0 0", {absorb, "keyword normal is '0 0 0'", "a vector with a length"}),
       line(ground + "density nan", {absorb, "keyword density is 'nan'", "> 0"}),
       line(ground + "speeds 300", {absorb, "keyword speeds, of shear waves is missing", ">= 0"}),
       line(ground + "normal 0 0 -1 area 1 density 1800 speeds 300 301",
            {absorb, "speed of shear waves is '301 m/s'", "at most", "300 m/s"}),
       line(whole + " depth", {absorb, "keyword depth is missing", "> 0"}),
       line(whole + " static maybe", {absorb, "keyword static is 'maybe'", "yes or no"}),
       line(whole + " stiffness 5",
            {absorb, "keyword is 'stiffness'", "normal, area, density, speeds, depth or static"}),
       line(good + "group nobody id 1000\nfix ground nobody boundary/absorb normal 0 0 -1 area 1 density "
                   "1800 speeds 300 170",
            {absorb, "group is 'nobody', which is empty", "the boundary's balls"}),
       line(good + "fix early all nve/sphere\n" + whole.substr(good.size()) + " static yes",
            {absorb, "keyword static is 'yes' behind fix early (nve/sphere), which integrates",
             "before all fixes that integrate balls of the boundary"}),
       line("drumlin/check k 0 positive", {"drumlin/check", "variable k is '0'", "a finite number > 0"})});
}

} // namespace

std::vector<BadGroup> bad_lines() {
  return {drum_excite(),
          bond_spring(),
          boundary_absorb(),
          clump(),
          contact_events(),
          contact_local(),
          contact_energy(),
          roller_history(),
          guard(),
          check(),
          record(),
          run(),
          settle(),
          surface(),
          write_restart(),
          write_data(),
          outputs(),
          take(),
          variables(),
          layers(),
          pick(),
          other_styles(),
          other_styles_in_lammps(),
          fixes_in_lammps()};
}

} // namespace drumlin::test
