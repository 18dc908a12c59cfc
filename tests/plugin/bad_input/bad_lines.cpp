#include "tests/plugin/bad_input/bad_input.h"
#include "tests/support/host_deck.h"

namespace drumlin::test {
namespace {

BadGroup drum_excite() {
  const std::string more = "@ amplitude 1e3 omega 100";
  return Table{"DrumExcite", "fix drum/excite: ", "fix excite drum drum/excite"}.of({
      {"nothing", "@", "keyword amplitude is missing ... amplitude Fw or eccentric me re", on_two_ranks},
      {"no frequency", "@ amplitude 1e3", "keyword omega is missing ... omega w or frequency f"},
      {"no amplitude", "@ omega 100", "keyword amplitude is missing"},
      {"amplitude without value", "@ omega 100 amplitude", "keyword amplitude is missing ... >= 0"},
      {"amplitude a word", "@ amplitude big omega 100",
       "keyword amplitude is 'big' ... a finite number >= 0"},
      {"amplitude a number and more", "@ amplitude 58.8kN omega 100", "keyword amplitude is '58.8kN'"},
      {"amplitude negative", "@ amplitude -1 omega 100", "keyword amplitude is '-1' ... >= 0", on_two_ranks},
      {"amplitude NaN", "@ amplitude nan omega 100", "keyword amplitude is 'nan' ... finite"},
      {"amplitude infinite", "@ amplitude inf omega 100", "keyword amplitude is 'inf' ... finite"},
      {"amplitude beyond a double", "@ amplitude 1e999 omega 100", "keyword amplitude is '1e999' ... finite"},
      {"two amplitudes", "@ amplitude 1 amplitude 2 omega 100",
       "keyword is 'amplitude', a second amplitude ... once"},
      {"amplitude and eccentric", "@ amplitude 1 eccentric 1 1 omega 100",
       "keyword is 'eccentric', a second amplitude"},
      {"eccentric with one value", "@ eccentric 10 omega 100",
       "keyword eccentric, radius is 'omega' ... > 0"},
      {"eccentric of no mass", "@ eccentric 0 0.1 omega 100", "keyword eccentric, mass is '0' ... > 0"},
      {"omega without value", "@ amplitude 1 omega", "keyword omega is missing ... > 0", on_two_ranks},
      {"omega zero", "@ amplitude 1 omega 0", "keyword omega is '0' ... > 0"},
      {"omega negative", "@ amplitude 1 omega -100", "keyword omega is '-100' ... > 0"},
      {"omega NaN", "@ amplitude 1 omega NaN", "keyword omega is 'NaN' ... > 0"},
      {"frequency infinite", "@ amplitude 1 frequency -inf", "keyword frequency is '-inf' ... > 0"},
      {"two frequencies", "@ amplitude 1 omega 100 frequency 20",
       "keyword is 'frequency', a second frequency ... once"},
      {"phase without value", more + " phase", "keyword phase is missing ... a finite number"},
      {"phase a word", more + " phase pi", "keyword phase is 'pi' ... a finite number"},
      {"start negative", more + " start -1", "keyword start is '-1' ... >= 0"},
      {"ramp negative", more + " ramp -1", "keyword ramp is '-1' ... >= 0"},
      {"sweep with one value", more + " sweep 200", "keyword sweep, duration is missing ... > 0",
       on_two_ranks},
      {"sweep without value", more + " sweep", "keyword sweep, end frequency is missing ... > 0"},
      {"sweep in no time", more + " sweep 200 0", "keyword sweep, duration is '0' ... > 0"},
      {"direction with two", more + " direction 0 1", "keyword direction, z is missing ... a finite number"},
      {"direction with a word", more + " direction 0 0 down",
       "keyword direction, z is 'down' ... a finite number"},
      {"direction of no length", more + " direction 0 0 0", "keyword direction is '0 0 0' ... a length"},
      {"unknown mode", more + " mode circular", "keyword mode is 'circular' ... directed or rotating"},
      {"mode without value", more + " mode", "keyword mode is missing ... directed or rotating"},
      {"rotating without axis", more + " mode rotating",
       "keyword axis is missing with mode rotating ... axis x y z"},
      {"axis along the force", more + " mode rotating axis 0 0 1",
       "keyword axis ... cosine ... right angles"},
      {"axis without rotation", more + " axis 0 1 0",
       "keyword mode is 'directed', with keyword axis ... mode rotating"},
      {"travel without value", more + " travel", "keyword travel is missing ... the ID of a fix drum/travel"},
      {"unknown roller", more + " travel gravity",
       "keyword travel is 'gravity' ... the ID of a fix drum/travel", on_two_ranks},
      {"place a word", more + " place left", "keyword place is 'left' ... a finite number"},
      {"place on a drum that does not tilt", more + " place 0.1",
       "keyword place is '0.1 m' ... 0, or the group of a fix clump with keyword tilt", on_two_ranks},
      {"unknown keyword", more + " amplitud 5", "keyword is 'amplitud' ... amplitude ... axis"},
      {"empty group", "fix excite nobody drum/excite amplitude 1 omega 100",
       "group is 'nobody', which is empty ... at least one ball", on_two_ranks},
      {"no direction and no gravity", "unfix gravity\n" + more,
       "keyword direction is missing ... direction x y z"},
      {"unknown group", "fix excite nogroup drum/excite amplitude 1 omega 100", "Could not find fix group ID",
       in_engine_words},
      {"no style", "fix excite drum", "Illegal fix command", in_engine_words},
  });
}

BadGroup drum_travel() {
  const std::string more = "@ from 0 to 1 speed 1";
  const std::string rolls =
      "fix body roller clump\nfix travel roller drum/travel from 0 to 1 speed 1 rotation driven radius 1";
  return Table{"DrumTravel", "fix drum/travel: ", "fix travel drum drum/travel"}.of({
      {"nothing", "@", "keyword from is missing ... from S", on_two_ranks},
      {"no end", "@ from 0 speed 1", "keyword to is missing ... to S"},
      {"no speed", "@ from 0 to 1", "keyword speed is missing ... speed V"},
      {"from without value", "@ from", "keyword from is missing ... a finite number"},
      {"to a word", "@ from 0 to end speed 1", "keyword to is 'end' ... a finite number"},
      {"to infinite", "@ from 0 to inf speed 1", "keyword to is 'inf' ... a finite number"},
      {"no way", "@ from 1 to 1 speed 1", "way is '0 m' long ... more than 0"},
      {"speed zero", "@ from 0 to 1 speed 0", "keyword speed is '0' ... > 0"},
      {"speed negative", "@ from 1 to 0 speed -1", "keyword speed is '-1' ... > 0"},
      {"speed NaN", "@ from 0 to 1 speed nan", "keyword speed is 'nan' ... > 0"},
      {"ramp negative", more + " ramp -0.1", "keyword ramp is '-0.1' ... >= 0"},
      {"ramps longer than the way", more + " ramp 1.5",
       "way is '1 m' long ... at least 1.5 m, which the two ramps take", on_two_ranks},
      {"pause negative", more + " pause -1", "keyword pause is '-1' ... >= 0"},
      {"no passes", more + " passes 0", "keyword passes is '0' ... a whole number from 1", on_two_ranks},
      {"half a pass", more + " passes 1.5", "keyword passes is '1.5' ... a whole number from 1"},
      {"unknown direction", more + " direction back", "keyword direction is 'back' ... both or one"},
      {"unknown axis", more + " axis s", "keyword axis is 's' ... x, y or z"},
      {"unknown rotation", more + " rotation yes", "keyword rotation is 'yes' ... none, driven or towed"},
      {"a drum without radius", more + " rotation driven radius 0", "keyword radius is '0' ... > 0"},
      {"radius of a drum that does not roll", more + " radius 1",
       "keyword radius is '1' ... rotation driven only"},
      {"no inertia", more + " rotation towed inertia 0", "keyword inertia is '0' ... > 0"},
      {"inertia of a drum that does not turn", more + " inertia 5",
       "keyword inertia is '5' ... rotation driven or towed only"},
      {"drum of several balls", "fix travel roller drum/travel from 0 to 1 speed 1 rotation driven",
       "keyword drum is 'roller', a group of 2 balls, of which 2 drive ... one ball that drives, the group "
       "of a fix clump that drives, or rotation none",
       on_two_ranks},
      {"a clump that is not the drum",
       "fix body drum clump\nfix travel roller drum/travel from 0 to 1 speed 1 rotation towed",
       "keyword drum is 'roller', a group of 2 balls, of which 2 drive"},
      {"a clump of which a part drives",
       "fix body roller clump\nfix travel frame drum/travel from 0 to 1 speed 1 rotation towed drum roller",
       "keyword drum is 'roller', a group of 2 balls, of which 1 drive", on_two_ranks},
      {"a clump without radius",
       "fix body roller clump\nfix travel roller drum/travel from 0 to 1 speed 1 rotation driven",
       "keyword radius is missing, and drum is 'roller', a clump ... radius R", on_two_ranks},
      {"a clump with a ball moved between two runs",
       rolls + "\nrun 5\ndisplace_atoms frame move 0.01 0 0 units box",
       "keyword drum is 'roller', a clump with balls that are 0.01 m and ... as the run before has left them",
       on_two_ranks},
      {"a clump with another velocity in a second run",
       rolls + "\nrun 5\nvelocity frame set 2 0 0 units box sum yes",
       "keyword drum is 'roller', a clump with balls that are ... m and 2 m/s away from where it rolls"},
      {"a clump with another ball in a second run",
       rolls + "\nrun 5\ngroup roller union drum soil\nunfix soil",
       "keyword drum is 'roller', a clump of 3 balls, of which 2 are among the 2 that rolled"},
      {"a clump too long for a periodic box",
       "change_box all boundary f p f\ndisplace_atoms frame move 0 1.9 -1.2 units box\nfix body roller "
       "clump\nfix travel roller drum/travel from 0 to 1 speed 1 axis y rotation driven radius 2 up 0 0 1",
       "keyword drum is 'roller', a clump of which a ball is ... m away from the middle ... a quarter of the "
       "periodic box along y, 1 m",
       on_two_ranks},
      {"drum that does not drive",
       "fix travel frame drum/travel from 0 to 1 speed 1 rotation towed drum drum",
       "keyword drum is 'drum', a group of 1 balls, of which 0 drive ... one ball that drives"},
      {"unknown drum", more + " drum nogroup", "keyword drum is 'nogroup' ... the name of a group"},
      {"no direction up", "unfix gravity\n" + more + " rotation driven",
       "keyword rotation is 'driven', and there is neither gravity nor a keyword up ... with a direction up"},
      {"up along the way", more + " rotation towed up 1 0 0",
       "keyword rotation is 'towed', and keyword up has no part across the way"},
      {"up of no length", more + " up 0 0 0", "keyword up is '0 0 0' ... a length"},
      {"unknown keyword", more + " velocity 5", "keyword is 'velocity' ... from, to, speed"},
      {"before the integration", "unfix integrate\n" + more + "\nfix integrate roller nve/sphere",
       "group is 'drum', of which 1 balls are moved by fix integrate (nve/sphere) behind it ... behind all "
       "fixes",
       on_two_ranks},
      {"two for a ball", more + "\nfix again roller drum/travel from 0 to 1 speed 1",
       "group is 'drum', of which 1 balls are moved by fix ... (drum/travel) ... one fix drum/travel for a "
       "ball"},
      {"beyond the box", "@ from 0 to 5 speed 1",
       "way is '0 to 5 m' along x for the centres of the balls ... inside of the box, -2 to 2 m",
       on_two_ranks},
      {"empty group", "fix travel nobody drum/travel from 0 to 1 speed 1",
       "group is 'nobody', which is empty ... balls that drive", on_two_ranks},
  });
}

BadGroup contact_way() {
  // A way from 0 to 2 m, made by the deck.
  const std::string file = "print \"s (m),k (N/m),D (-)\" file out/way.csv screen no\n"
                           "print \"0,1e7,0.2\" append out/way.csv screen no\n"
                           "print \"2,1e7,0.2\" append out/way.csv screen no\n";
  const std::string travel = "fix travel drum drum/travel from 0 to 1 speed 1\n";
  const std::string more = file + travel + "@ file out/way.csv travel travel between soil drum";
  return Table{"ContactWay", "fix contact/way: ", "fix way all contact/way"}.of({
      {"nothing", "@", "keyword file is missing ... file NAME travel ID between GROUP GROUP"},
      {"no roller", file + "@ file out/way.csv between soil drum",
       "keyword travel is missing ... fix drum/travel"},
      {"no groups", file + "@ file out/way.csv travel travel",
       "keyword between is missing ... soil and drum"},
      {"one group", file + "@ file out/way.csv travel travel between soil",
       "keyword between is missing ... the name of a group"},
      {"unknown group", file + "@ file out/way.csv travel travel between soil stone",
       "keyword between is 'stone' ... the name of a group"},
      {"no file", "@ file out/none.csv travel travel between soil drum",
       "way is 'out/none.csv' ... a file that can be read, with the columns s (m),k (N/m),D (-)",
       on_two_ranks},
      {"another file", "@ file lines travel travel between soil drum",
       "header in line 1 of 'lines' is ... s (m),k (N/m),D (-)"},
      {"a soft side",
       "print \"s (m),k_left (N/m),k_right (N/m),D (-)\" file out/side.csv screen no\n"
       "print \"0,1e7,2e7,0.2\" append out/side.csv screen no\n" +
           travel + "@ file out/side.csv travel travel between soil drum",
       "k_left in line 2 of 'out/side.csv' is '1e+07' ... k_right, 2e+07: a drum on one contact has no sides",
       on_two_ranks},
      {"unknown roller", file + "@ file out/way.csv travel gravity between soil drum",
       "keyword travel is 'gravity' ... the ID of a fix drum/travel", on_two_ranks},
      {"a way too short",
       file + "fix travel drum drum/travel from 0 to 2.5 speed 1 axis z up 1 0 0\n@ file out/way.csv travel "
              "travel between soil drum",
       "way of 'out/way.csv' is '0 to 2 m' ... one that has the places 0 to 2.5 m of fix travel",
       on_two_ranks},
      {"groups of several types", file + travel + "@ file out/way.csv travel travel between soil roller",
       "keyword between is 'roller', a group of several types ... all balls of one type", on_two_ranks},
      {"a group without balls", file + travel + "@ file out/way.csv travel travel between nobody drum",
       "keyword between is 'nobody', a group without balls ... all balls of one type"},
      {"unknown keyword", more + " damping 1", "keyword is 'damping' ... file, travel or between"},
  });
}

BadGroup bond_spring() {
  BadGroup group = Table{"BondSpring", "fix bond/spring: ", "fix bond all bond/spring"}.of({
      {"nothing", "@", "ball i is missing ... a whole number from 1"},
      {"one ball", "@ 2", "ball j is missing ... a whole number from 1"},
      {"no stiffness", "@ 2 3", "stiffness k is missing ... > 0"},
      {"no damping", "@ 2 3 1e6", "damping c is missing ... >= 0"},
      {"ball zero", "@ 0 3 1e6 1e4", "ball i is '0' ... a whole number from 1"},
      {"a fraction of a ball", "@ 2 2.5 1e6 1e4", "ball j is '2.5' ... a whole number from 1"},
      {"ball by name", "@ drum 3 1e6 1e4", "ball i is 'drum' ... a whole number from 1"},
      {"to itself", "@ 2 2 1e6 1e4", "ball j is '2', the same as ball i ... another ball", on_two_ranks},
      {"missing ball", "@ 2 99 1e6 1e4", "ball is '99', which is not in the box ... the ID of a ball",
       on_two_ranks},
      {"stiffness zero", "@ 2 3 0 1e4", "stiffness k is '0' ... > 0"},
      {"stiffness negative", "@ 2 3 -1e6 1e4", "stiffness k is '-1e6' ... > 0", on_two_ranks},
      {"stiffness NaN", "@ 2 3 nan 1e4", "stiffness k is 'nan' ... > 0"},
      {"stiffness infinite", "@ 2 3 inf 1e4", "stiffness k is 'inf' ... > 0"},
      {"damping negative", "@ 2 3 1e6 -1", "damping c is '-1' ... >= 0"},
      {"damping a word", "@ 2 3 1e6 none", "damping c is 'none' ... >= 0"},
      {"strength without value", "@ 2 3 1e6 1e4 strength", "keyword strength is missing ... > 0"},
      {"strength zero", "@ 2 3 1e6 1e4 strength 0", "keyword strength is '0' ... > 0"},
      {"strength negative", "@ 2 3 1e6 1e4 strength -5", "keyword strength is '-5' ... > 0"},
      {"strength NaN", "@ 2 3 1e6 1e4 strength nan", "keyword strength is 'nan' ... > 0"},
      {"length without value", "@ 2 3 1e6 1e4 length", "keyword length ... is missing ... > 0"},
      {"length a word", "@ 2 3 1e6 1e4 length now",
       "keyword length is 'now' ... current or a finite number > 0"},
      {"length negative", "@ 2 3 1e6 1e4 length -1", "keyword length ... is '-1' ... > 0"},
      {"unknown keyword", "@ 2 3 1e6 1e4 1e5", "keyword is '1e5' ... length or strength"},
      {"a ball gets lost", "@ 2 3 1e6 1e4\nvelocity frame set 0 0 -1e6",
       "ball is '3', which was lost at step 1 ... both balls in the box", on_two_ranks | in_the_run},
      {"a damping of far less than a time step", "@ 2 3 1e6 1e14",
       "damping c is '1e+14 N s/m', with the time constant m_eff/c of 6.67e-12 s ... at least 1e-09 s",
       in_the_run},
  });
  // Without history of contacts, which the pair style would refuse.
  group.inputs.push_back(
      {"balls that get other IDs",
       with_other_ids("fix bond all bond/spring 2 4 1e6 1e4"),
       {"fix bond/spring: balls are '2' and '4', IDs that other balls may have now",
        "delete_atoms with compress no"},
       on_two_ranks,
       {},
       "pair_style gran model hooke/transition stepping stock\npair_coeff * *\n" + host_properties()});
  return group;
}

BadGroup boundary_absorb() {
  const std::string more = "@ normal 0 0 -1 area 1 density 1800 speeds 300 170";
  return Table{"BoundaryAbsorb", "fix boundary/absorb: ", "fix floor soil boundary/absorb"}.of({
      {"nothing", "@", "keyword normal is missing ... normal x y z"},
      {"no area", "@ normal 0 0 -1", "keyword area is missing ... area A"},
      {"no density", "@ normal 0 0 -1 area 1", "keyword density is missing ... density rho"},
      {"no speeds", "@ normal 0 0 -1 area 1 density 1800", "keyword speeds is missing ... speeds cp cs"},
      {"normal of no length", "@ normal 0 0 0", "keyword normal is '0 0 0' ... a vector with a length"},
      {"area zero", "@ normal 0 0 -1 area 0", "keyword area is '0' ... > 0"},
      {"density negative", "@ density -1800", "keyword density is '-1800' ... > 0"},
      {"density NaN", "@ density nan", "keyword density is 'nan' ... > 0"},
      {"one speed", "@ speeds 300", "keyword speeds, of shear waves is missing ... >= 0"},
      {"speed zero", "@ speeds 0 0", "keyword speeds, of compression waves is '0' ... > 0"},
      {"shear waves that are faster", "@ normal 0 0 -1 area 1 density 1800 speeds 300 301",
       "speed of shear waves is '301 m/s' ... at most ... 300 m/s", on_two_ranks},
      {"depth zero", more + " depth 0", "keyword depth is '0' ... > 0"},
      {"depth without value", more + " depth", "keyword depth is missing ... > 0"},
      {"static a word", more + " static maybe", "keyword static is 'maybe' ... yes or no"},
      {"unknown keyword", more + " stiffness 5",
       "keyword is 'stiffness' ... normal, area, density, speeds, depth or static"},
      {"empty group", "fix floor nobody boundary/absorb normal 0 0 -1 area 1 density 1800 speeds 300 170",
       "group is 'nobody', which is empty ... the boundary's balls", on_two_ranks},
      {"static behind the integration", "fix early soil nve/sphere\n" + more + " static yes",
       "keyword static is 'yes' behind fix ... which integrates ... before all fixes that integrate balls "
       "of the boundary"},
  });
}

BadGroup clump() {
  return Table{"Clump", "fix clump: ", ""}.of({
      {"a word too many", "fix body drum clump rigid", "argument is 'rigid' ... fix ID group clump"},
      {"tilt about nothing", "fix body drum clump tilt", "keyword tilt, x is missing ... a finite number"},
      {"tilt without axle", "fix body drum clump tilt 1 0 0",
       "word behind the axis of keyword tilt is missing ... axle"},
      {"an axle along the axis", "fix body drum clump tilt 1 0 0 axle 1 1 0",
       "keyword tilt, axle is '0.707107 0.707107 0', not at right angles ... (cosine 0.707107) ... an axle "
       "at right angles",
       on_two_ranks},
      {"tilt of one ball", "fix body drum clump tilt 1 0 0 axle 0 1 0",
       "keyword tilt has the group 'drum', whose balls have the inertia '0 kg m2' ... different places",
       on_two_ranks},
      {"a large tilt",
       "displace_atoms frame move 0 0.5 0 units box\nfix body roller clump tilt 1 0 0 axle 0 1 0",
       "tilt of group roller is ' ... rad' at step 0 ... at most 0.1 rad"},
      {"balls beside the axle",
       "group three union soil roller\ndisplace_atoms drum move 0 0.5 0 units box\n"
       "fix body three clump tilt 1 0 0 axle 0 1 0",
       "keyword tilt has the group 'three', of which a ball is ' ... off the plane ... balls on one axle"},
      {"a tilt of what drives",
       "fix travel roller drum/travel from 0 to 1 speed 1\nfix body roller clump tilt 0 1 0 axle 0 0 1",
       "keyword tilt has the group 'roller', which fix travel (drum/travel) drives ... does not drive",
       on_two_ranks},
      {"links of no type", "fix body drum clump links 9 1", "keyword links, type is '9' ... 1 to 3"},
      {"links of no number", "fix body drum clump links 2 0",
       "keyword links, number of contacts or bonds is '0' ... from 1"},
      {"group all", "fix body all clump", "group is 'all' ... the balls of the body"},
      {"empty group", "fix body nobody clump", "group is 'nobody', which is empty ... balls of the body",
       on_two_ranks},
      {"a ball in two", "fix one drum clump\nfix two roller clump",
       "group is 'drum', of which 1 balls are in the clump ' ... each ball in one clump only", on_two_ranks},
      {"a force fix after it", "fix body drum clump\nfix bond all bond/spring 2 3 1e6 1e4",
       "group is 'drum', on which the later fix bond (bond/spring) exerts forces ... after all fixes"},
      {"unequal velocities", "velocity drum set 0 0 -1 units box\nfix body roller clump",
       "velocity of the balls of group roller along z is '-1 to 0 m/s' ... one velocity for all balls of a "
       "body",
       on_two_ranks},
      {"unequal velocities in a second run",
       "fix body roller clump\nrun 5\nvelocity frame set 2 0 0 units box sum yes",
       "velocity of the balls of group roller along x is '0 to 2 m/s' ... one velocity for all balls of a "
       "body",
       in_the_run},
  });
}

BadGroup contact_events() {
  return Table{"ContactEvents", "fix contact/events: ", "fix events all contact/events"}.of({
      {"nothing", "@", "keyword file is missing ... file NAME"},
      {"file not first", "@ types 1 2 file out/x.csv", "keyword file is missing ... as the first keyword"},
      {"file without name", "@ file", "keyword file is missing ... a folder that exists"},
      {"file in no folder", "@ file nowhere/x.csv",
       "keyword file is 'nowhere/x.csv', which cannot be written ... a file in a folder that exists",
       on_two_ranks},
      {"a folder as file", "@ file out",
       "keyword file is 'out', which cannot be written ... a file in a folder that exists"},
      {"one type", "@ file out/x.csv types 1", "keyword types is missing ... a whole number from 1 to 3"},
      {"type 0", "@ file out/x.csv types 0 1", "keyword types is '0' ... a whole number from 1 to 3"},
      {"type 4", "@ file out/x.csv types 1 4", "keyword types is '4' ... a whole number from 1 to 3"},
      {"types by star", "@ file out/x.csv types * 2", "keyword types is '*' ... a whole number from 1 to 3"},
      {"append without value", "@ file out/x.csv append", "keyword append is missing ... yes or no"},
      {"append a number", "@ file out/x.csv append 1", "keyword append is '1' ... yes or no"},
      {"unknown keyword", "@ file out/x.csv every 10", "keyword is 'every' ... types, between or append"},
      {"between one group", "@ file out/x.csv between soil",
       "keyword between is missing ... the name of a group"},
      {"between an unknown group", "@ file out/x.csv between soil rock",
       "keyword between is 'rock' ... the name of a group", on_two_ranks},
  });
}

BadGroup contact_local() {
  return Table{"ContactLocal", "fix contact/local: ", "fix contacts all contact/local"}.of({
      {"nothing", "@", "keyword is missing ... every"},
      {"no number", "@ every", "keyword every is missing ... a whole number from 1"},
      {"every zero", "@ every 0", "keyword every is '0' ... a whole number from 1"},
      {"every a fraction", "@ every 0.5", "keyword every is '0.5' ... a whole number from 1"},
      {"another keyword", "@ file out/x.csv", "keyword is 'file' ... every", on_two_ranks},
      {"a word too many", "@ every 10 append yes", "argument is 'append' ... every N"},
  });
}

BadGroup contact_energy() {
  return Table{"ContactEnergy", "fix contact/energy: ", ""}.of({
      {"a word too many", "fix energy all contact/energy every 10",
       "argument is 'every' ... fix ID group contact/energy", on_two_ranks},
  });
}

BadInput with_the_stock_law(const std::string &lines, const std::string &command,
                            unsigned kind = on_one_rank) {
  return {"the stock law, " + command,
          lines,
          {command + ": pair_style is '", "pair_style gran model hooke/transition"},
          kind,
          {},
          "pair_style gran model hooke/stiffness\npair_coeff * *\n" + property("kn", "1e7") +
              property("kt", "1e7") + property("gamman", "1") + property("gammat", "1")};
}

BadGroup roller_history() {
  const std::string more = "@ file out/x.csv every 10";
  BadGroup group = Table{"RollerHistory", "fix roller/history: ", "fix history drum roller/history"}.of({
      {"nothing", "@", "keyword file is missing ... file NAME every N"},
      {"no interval", "@ file out/x.csv", "keyword every is missing ... file NAME every N"},
      {"file without name", "@ every 10 file", "keyword file is missing ... a folder that exists"},
      {"every without value", "@ file out/x.csv every", "keyword every is missing ... a whole number from 1"},
      {"every zero", "@ file out/x.csv every 0", "keyword every is '0' ... a whole number from 1"},
      {"every negative", "@ file out/x.csv every -10", "keyword every is '-10' ... a whole number from 1"},
      {"every a fraction", "@ file out/x.csv every 0.5", "keyword every is '0.5' ... a whole number from 1"},
      {"every beyond an int", "@ file out/x.csv every 3000000000",
       "keyword every is '3000000000' ... 2147483647"},
      {"file in no folder", "@ file nowhere/x.csv every 10",
       "keyword file is 'nowhere/x.csv', which cannot be written ... a file in a folder that exists",
       on_two_ranks},
      {"file in no folder, after a good one",
       "fix events all contact/events file out/events.csv\n@ file nowhere/x.csv every 10",
       "keyword file is 'nowhere/x.csv', which cannot be written"},
      {"a folder as cycles file", more + " cycles out 10",
       "keyword cycles is 'out', which cannot be written ... a folder that exists"},
      {"cycles without steps", more + " cycles out/y.csv",
       "keyword cycles, steps per cycle is missing ... from 1"},
      {"cycles of no steps", more + " cycles out/y.csv 0",
       "keyword cycles, steps per cycle is '0' ... from 1"},
      {"unknown frame group", more + " frame top", "keyword frame is 'top' ... the name of a group"},
      {"frame without group", more + " frame", "keyword frame is missing ... the name of a group"},
      {"empty frame group", more + " frame nobody",
       "keyword frame is 'nobody', which is empty ... frame's balls"},
      {"unknown soil group", more + " soil mud", "keyword soil is 'mud' ... the name of a group"},
      {"soil without group", more + " soil", "keyword soil is missing ... the name of a group"},
      {"soil without cycles", more + " frame frame soil soil",
       "keyword frame or cycles is missing with keyword soil ... all three"},
      {"empty soil group", more + " frame frame soil nobody cycles out/y.csv 10",
       "keyword soil is a group that is empty ... the soil balls"},
      {"unknown excite", more + " excite motor", "keyword excite is 'motor' ... ID of a fix drum/excite",
       on_two_ranks},
      {"excite of another style", more + " excite gravity",
       "keyword excite is 'gravity' ... ID of a fix drum/excite"},
      {"excite without ID", more + " excite", "keyword excite is missing ... ID of a fix drum/excite"},
      {"unknown roller that drives", more + " travel excite",
       "keyword travel is 'excite' ... the ID of a fix drum/travel"},
      {"travel without ID", more + " travel", "keyword travel is missing ... ID of a fix drum/travel"},
      {"unknown bond", more + " bond spring", "keyword bond is 'spring' ... ID of a fix bond/spring"},
      {"bond without ID", more + " bond", "keyword bond is missing ... ID of a fix bond/spring"},
      {"axis with two", more + " axis 0 1", "keyword axis, z is missing ... a finite number"},
      {"axis of no length", more + " axis 0 0 0", "keyword axis is '0 0 0' ... a length"},
      {"ends of a drum that does not tilt", more + " frame frame ends 0.5",
       "keyword ends is '0.5 m' ... drum and frame that a fix clump each tilts", on_two_ranks},
      {"ends without frame", more + " ends 0.5", "keyword frame is missing with keyword ends ... both"},
      {"ends negative", more + " frame frame ends -1", "keyword ends is '-1' ... >= 0"},
      {"origin with one", more + " origin 0.75",
       "keyword origin, of the frame is missing ... a finite number"},
      {"append a word", more + " append always", "keyword append is 'always' ... yes or no"},
      {"unknown keyword", more + " types 1 2", "keyword is 'types' ... file, every ... append"},
      {"empty group", "fix history nobody roller/history file out/x.csv every 10",
       "group is 'nobody', which is empty ... the drum's balls"},
      {"no axis and no gravity", "unfix gravity\n" + more, "keyword axis is missing ... axis x y z"},
      {"cycles and a time step that varies", "fix dt all dt/reset 1 1e-6 1e-4 1e-5 units box",
       "keyword cycles is '10' steps per cycle, and fix dt (dt/reset) changes the time step ... one time "
       "step as long as the fix is defined, or no keyword cycles",
       on_two_ranks},
      {"cycles and two time steps", more + " cycles out/c.csv 10\nrun 5\ntimestep 2e-5",
       "keyword cycles is '10' steps per cycle, and the time step has changed from 1e-05 to 2e-05 s ... one "
       "time step as long as the fix is defined, or no keyword cycles",
       in_the_run},
  });
  for (const BadInput &input :
       {with_the_stock_law("fix history drum roller/history file out/x.csv every 10", "fix roller/history"),
        with_the_stock_law("fix events all contact/events file out/x.csv", "fix contact/events",
                           on_two_ranks),
        with_the_stock_law("fix contacts all contact/local every 10", "fix contact/local"),
        with_the_stock_law("fix energy all contact/energy", "fix contact/energy")})
    group.inputs.push_back(input);
  return group;
}

BadGroup guard() {
  // No formula of the engine makes a NaN from words; an overflow does.
  const std::string undefined = "variable undefined equal (1e300*1e300)*0\n";
  const std::string addforce = undefined + "fix wrong drum addforce 0 0 v_undefined\n";
  BadGroup group = Table{"Guard", "fix guard: ", "fix guard all guard"}.of({
      {"every zero", "@ every 0", "keyword every is '0' ... a whole number from 1"},
      {"every without value", "@ every", "keyword every is missing ... a whole number from 1"},
      {"watch of version 0.1.0", "@ watch off", "keyword is 'watch' ... every, links, step or overlap"},
      {"unknown keyword", "@ on", "keyword is 'on' ... every, links, step or overlap"},
      {"links zero", "@ links 0", "keyword links is '0' ... a whole number from 1"},
      {"step without value", "@ step", "keyword step is missing ... a finite number > 0"},
      {"step zero", "@ step 0", "keyword step is '0' ... a finite number > 0"},
      {"overlap is no number", "@ overlap half", "keyword overlap is 'half' ... a finite number > 0"},
      {"step beyond the critical one", "fix bond all bond/spring 2 3 1e15 0\n@",
       "time step is '1e-05 s' at step 0, where ball 3 has the critical step 1.531e-06 s (mostly because of "
       "the link of balls 2 and 3) ... at most 1.531e-06 s",
       on_two_ranks | in_the_run},
      {"a ball in a ball", "displace_atoms drum move 0 0 -0.6 units box\n@",
       "overlap of balls ... is '1.2' of the smaller radius at step 0 ... at most 0.5",
       on_two_ranks | in_the_run},
      {"NaN at the start", addforce + "@", "ball 2 is ' ... at step 0; allowed: finite numbers",
       on_two_ranks | in_the_run},
      {"NaN in the run",
       "@\n" + undefined +
           "fix wrong drum addforce 0 0 0\nrun 5\nunfix wrong\nfix wrong drum addforce 0 0 v_undefined",
       "ball 2 is ' ... m/s, 0 0 ... at step 6; allowed: finite numbers", on_two_ranks | in_the_run},
      {"infinite velocity",
       "@\nvelocity drum set 0 0 1e308 units box\nvelocity drum set 0 0 1e308 sum yes units box",
       "ball 2 is ' ... m, 0 0 inf m/s, ... at step 0; allowed: ", in_the_run},
  });
  group.inputs.push_back({"NaN seen by the history",
                          "fix guard all guard every 7\n" + addforce,
                          {"fix roller/history: drum is '", " at step 1", "finite position and velocity"},
                          in_the_run});
  return group;
}

BadGroup check() {
  return Table{"Check", "drumlin/check: ", "drumlin/check"}.of({
      {"nothing", "@", "the variable's name is missing"},
      {"no value", "@ k", "the value of variable k is missing"},
      {"no rule", "@ k 1", "the rule for variable k is missing ... one_of"},
      {"unknown rule", "@ k 1 small", "rule for variable k is 'small' ... multiple_of", on_two_ranks},
      {"no choice", "@ k 1 one_of", "word of rule one_of for variable k is missing"},
      {"another choice", "@ k z one_of x y", "variable k is 'z' ... x or y"},
      {"words left over", "@ k 1 positive 2",
       "argument behind the rule for variable k is '2' ... one value and one rule"},
      {"not positive", "@ k 0 positive", "variable k is '0' ... a finite number > 0"},
      {"not non-negative", "@ k -1e-9 non_negative", "variable k is '-1e-9' ... a finite number >= 0"},
      {"not finite", "@ k inf finite", "variable k is 'inf' ... a finite number"},
      {"not a number", "@ k 0x10 finite", "variable k is '0x10' ... a finite number"},
      {"integer without range", "@ k 1 integer", "rule integer, lowest is missing"},
      {"integer without end", "@ k 1 integer 1", "rule integer, highest is missing"},
      {"out of range", "@ k 11 integer 1 10", "variable k is '11' ... a whole number from 1 to 10"},
      {"a fraction", "@ k 2.5 integer 1 10", "variable k is '2.5' ... a whole number from 1 to 10"},
      {"no limit", "@ k 1 below", "rule below, the limit is missing"},
      {"not below", "@ k 2 below 2 which is twice m",
       "variable k is '2'; allowed: a finite number below 2, which is twice m"},
      {"not above", "@ k 2 above 2", "variable k is '2'; allowed: a finite number above 2"},
      {"more than at most", "@ k 2.5 at_most 2", "variable k is '2.5'; allowed: a finite number at most 2"},
      {"less than at least", "@ k 0.5 at_least 1",
       "variable k is '0.5'; allowed: a finite number at least 1"},
      {"a limit for a word", "@ k nan below 2", "variable k is 'nan' ... below 2"},
      {"multiple of nothing", "@ k 1 multiple_of", "rule multiple_of, the other variable's name is missing"},
      {"no multiple", "@ k 10 multiple_of n 4", "variable k is '10' ... a multiple of n, which is 4"},
      {"multiple of zero", "@ k 10 multiple_of n 0", "variable k is '10' ... a multiple of n, which is 0"},
      {"no restart file", "@ start nowhere restart stage ten",
       "variable start is 'nowhere' ... a restart file of drumlin/write or drumlin/run", on_two_ranks},
      {"note without value", "@ start nowhere restart stage", "the value of note stage is missing"},
      {"no data file", "@ balls nowhere data_file", "variable balls is 'nowhere' ... a data file with atoms"},
      {"no name of a restart file", "@ bed nowhere/x restart_name",
       "variable bed is 'nowhere/x' ... a file in a folder that exists", on_two_ranks},
      {"a file as folder", "@ out pair/x directory",
       "variable out is 'pair/x' ... a folder that can be made or written", on_two_ranks},
      {"unknown command", "drumlin/chek k 1 positive", "Unknown command: drumlin/chek", in_engine_words},
  });
}

BadGroup record() {
  return Table{"Record", "drumlin/record: ", "drumlin/record"}.of({
      {"nothing", "@", "file is missing ... a file in a folder that exists"},
      {"name without value", "@ out/x.csv k", "the value of k is missing"},
      {"file in no folder", "@ nowhere/x.csv k 1",
       "file is 'nowhere/x.csv', which cannot be written ... a file in a folder that exists", on_two_ranks},
  });
}

BadGroup run() {
  return Table{"Run", "drumlin/run: ", "drumlin/run"}.of({
      {"nothing", "@", "the last step is missing ... a whole number from 0"},
      {"last step a word", "@ soon every 10", "the last step is 'soon' ... a whole number from 0"},
      {"last step in the past", "run 20\n@ 10 every 10",
       "the last step is '10' ... at least 20, the present step"},
      {"every zero", "@ 10 every 0", "keyword every is '0' ... a whole number from 1"},
      {"limit zero", "@ 10 every 10 limit 0", "keyword limit is '0' ... > 0"},
      {"limit without restart", "@ 10 every 10 limit 60",
       "keyword restart is missing with keyword limit ... limit SECONDS restart FILE"},
      {"restart without file", "@ 10 every 10 restart",
       "keyword restart is missing ... a file in a folder that exists"},
      {"restart in no folder", "@ 10 every 10 limit 60 restart nowhere/x",
       "keyword restart is 'nowhere/x', which cannot be written ... a file in a folder that exists",
       on_two_ranks},
      {"unknown keyword", "@ 10 every 10 for 3", "keyword is 'for' ... every, limit or restart"},
  });
}

BadGroup write() {
  return Table{"Write", "drumlin/write: ", "drumlin/write"}.of({
      {"nothing", "@", "kind of file is missing ... restart, data or both"},
      {"unknown kind", "@ dump out/x", "kind of file is 'dump' ... restart, data or both"},
      {"no file", "@ restart", "file is missing ... a file in a folder that exists"},
      {"name without value", "@ restart out/x bed", "the value of note bed is missing"},
      {"name with a star", "@ restart out/x.*",
       "file is 'out/x.*', which cannot be written ... without * and %"},
      {"restart file in no folder", "@ restart nowhere/x bed soil",
       "file is 'nowhere/x', which cannot be written ... a file in a folder that exists", on_two_ranks},
      {"data file in no folder", "@ data nowhere/x bed soil",
       "file is 'nowhere/x', which cannot be written ... a file in a folder that exists", on_two_ranks},
      {"both in no folder", "@ both nowhere/x", "file is 'nowhere/x', which cannot be written"},
      {"unknown variable", "@ data out/x values_of depth",
       "keyword values_of is 'depth' ... the names of variables"},
      {"a variable of two words", "variable law index \"a b\"\n@ data out/x values_of law",
       "keyword values_of is 'law' ... variables that are one word"},
      {"a group without variables", "@ both out/x stage ten groups soil",
       "keyword groups is 'soil' ... a group of variables of drumlin/variable", on_two_ranks},
      {"no box", "clear\n@ restart out/x", "simulation box is missing ... create_box"},
  });
}

BadGroup outputs() {
  return Table{"Outputs", "drumlin/outputs: ", "drumlin/outputs"}.of({
      {"unknown keyword", "@ empty out",
       "keyword is 'empty' ... folder, subfolder, continue, files, restart or numbered"},
      {"folder without path", "@ folder", "keyword folder is missing ... a folder"},
      {"continue without time", "@ continue 5", "keyword continue, time is missing ... >= 0"},
      {"numbered without suffix", "@ numbered out/dump balls_", "keyword numbered, suffix is missing"},
      {"a file as folder", "@ folder out/chain.csv files x.csv",
       "folder is 'out/chain.csv' ... one that can be made", on_two_ranks},
      {"a folder as file", "@ files out",
       "file is 'out', which cannot be written ... a file in a folder that exists", on_two_ranks},
      {"a file that was read", "@ folder out files chain.csv inputs ./out/chain.csv",
       "file is 'out/chain.csv' ... another file than './out/chain.csv', which the run has read",
       on_two_ranks},
      {"a folder with other files", "@ numbered out balls_ .vtp",
       "folder is 'out' with the file ' ... a folder with nothing but dumps", on_two_ranks},
  });
}

BadGroup surface() {
  return Table{"Surface", "drumlin/surface: ", "drumlin/surface"}.of({
      {"no variable", "@", "variable is missing ... the name of a variable"},
      {"no group", "@ h", "group is missing ... the name of a group"},
      {"unknown group", "@ h rock spacing 0.1", "group is 'rock' ... the name of a group"},
      {"no spacing", "@ h soil", "keyword spacing is missing ... > 0"},
      {"spacing zero", "@ h soil spacing 0", "keyword spacing is '0' ... > 0"},
      {"spacing tiny", "@ h soil spacing 1e-9", "keyword spacing is '1e-09' ... at most 1e+07 lines"},
      {"beyond without x", "@ h soil spacing 0.1 beyond 1",
       "keyword beyond, x is missing ... a finite number"},
      {"beyond negative", "@ h soil spacing 0.1 beyond -1 0", "keyword beyond, distance is '-1' ... >= 0"},
      {"unknown keyword", "@ h soil width 0.1", "keyword is 'width' ... spacing or beyond"},
      {"nothing there", "@ h soil spacing 0.1 beyond 1.9 0",
       "group is 'soil' ... one with a ball that a vertical line meets", on_two_ranks},
  });
}

BadGroup ends() {
  return Table{"Ends", "drumlin/ends: ", "drumlin/ends"}.of({
      {"nothing", "@", "what is given is missing ... machine or laws"},
      {"a machine without values", "@ machine 2 none", "m2 is missing ... >= 0"},
      {"laws of words", "@ laws big 0.1", "stiffnesses is 'big' ... > 0", on_two_ranks},
      {"fewer ratios", "@ laws 1e7,1e7 0.1",
       "number of damping ratios is '1' ... 2, that of the stiffnesses"},
      {"more contacts than types", "@ laws 1e7,1e7,1e7 0,0,0",
       "number of contacts is '3' ... fewer than the types of balls", on_two_ranks},
  });
}

BadGroup layers() {
  return Table{"Layers", "drumlin/layers: ", "drumlin/layers"}.of({
      {"nothing", "@", "keyword is missing ... k"},
      {"keywords in another order", "@ D 0.1", "keyword is 'D' ... k"},
      {"no list", "@ k", "keyword k is missing ... a number for each layer"},
      {"k zero", "@ k 0", "keyword k is '0' ... > 0"},
      {"a word in a list", "@ k 1e8,soft", "keyword k is '1e8,soft' ... > 0"},
      {"an empty entry", "@ k 1e8,", "keyword k is '1e8,' ... > 0"},
      {"more layers than types", "@ k 1e8,1e9",
       "keyword k is '1e8,1e9' ... one number, since the bed has one layer", on_two_ranks},
      {"k too stiff for the time step", "timestep 1e-3\n@ k 1e18 D 0 friction 0 rolling off 0",
       "keyword k is '1e18', with which two of the lightest balls of layer 1 have the critical step ... "
       "with the time step 0.001 s",
       on_two_ranks},
      {"D too large for the time step",
       "timestep 1e-6\npair_style gran model hooke/transition damping ratio stepping stock\n@ k 1e8 D 1e9 "
       "friction 0 rolling off 0",
       "keyword D is '1e9', with which two of the lightest balls of layer 1 have the critical step ... with "
       "the time step 1e-06 s",
       on_two_ranks},
      {"a list that has a variable", "@ k 0 D 0 friction 0 rolling off 0 variables pour_k D f r",
       "variable pour_k is '0' ... > 0"},
      {"a list whose variable follows another",
       "variable k index 0\n@ k 0 D 0 friction 0 rolling off 0 variables pour_k/k D f r",
       "variable k is '0' ... > 0"},
      {"D negative", "@ k 1e8 D -0.1", "keyword D is '-0.1' ... >= 0"},
      {"friction negative", "@ k 1e8 D 0 friction -1", "keyword friction is '-1' ... >= 0"},
      {"no model of rolling", "@ k 1e8 D 0 friction 0.5 rolling 0.1",
       "keyword rolling, model is '0.1' ... off or epsd2"},
      {"rolling negative", "@ k 1e8 D 0 friction 0.5 rolling off -1", "keyword rolling is '-1' ... >= 0"},
      {"yield below 1", "@ k 1e8 D 0 friction 0.5 rolling off 0 yield 0.9",
       "keyword yield, stiffness of unloading over that of first loading is '0.9' ... a finite number >= 1",
       on_two_ranks},
      {"k2 too stiff for the time step", "timestep 1e-3\n@ k 1e8 D 0 friction 0 rolling off 0 yield 1e10",
       "keyword k is '1e8', with which two of the lightest balls of layer 1 have the critical step"},
      {"suction negative", "@ k 1e8 D 0 friction 0.5 rolling off 0 suction -1",
       "keyword suction is '-1' ... >= 0"},
      {"a word too many", "@ k 1e8 D 0 friction 0.5 rolling off 0 all",
       "argument is 'all' ... k LIST D LIST"},
  });
}

BadGroup suction() {
  return Table{"Suction", "drumlin/suction: ", "drumlin/suction"}.of({
      {"nothing", "@", "variable is missing ... the name of a variable"},
      {"no group", "@ F sand strength 1e3 solid 0.8 contacts 4", "group is 'sand' ... the name of a group"},
      {"strength negative", "@ F all strength -1 solid 0.8 contacts 4", "keyword strength is '-1' ... >= 0"},
      {"solid above 1", "@ F all strength 1e3 solid 1.1 contacts 4", "keyword solid is '1.1' ... <= 1"},
      {"no contacts", "@ F all strength 1e3 solid 0.8 contacts 0", "keyword contacts is '0' ... > 0"},
      {"a word too many", "@ F all strength 1e3 solid 0.8 contacts 4 5", "argument is '5' ... NAME GROUP"},
      {"no balls", "group none id 99999\n@ F none strength 1e3 solid 0.8 contacts 4",
       "the group has '0' balls ... a group with balls", on_two_ranks},
  });
}

BadGroup pick() {
  return Table{"Pick", "drumlin/pick: ", "drumlin/pick"}.of({
      {"nothing", "@", "variable is missing ... the name of a variable"},
      {"not which", "@ x", "which is missing ... largest, or the place"},
      {"a place between", "@ x 1.5 1,2", "which is '1.5' ... from 1"},
      {"a place too high", "@ x 3 1,2", "which is '3' ... at most 2"},
      {"no list", "@ x 1", "list is missing ... separated by commas"},
      {"a word", "@ x largest 1,soft", "list is '1,soft' ... finite numbers"},
      {"a word too many", "@ x 1 1 2", "argument is '2' ... a variable, which number, and a list"},
  });
}

BadGroup roller() {
  return Table{"Roller", "drumlin/roller: ", "drumlin/roller"}.of({
      {"nothing", "@", "roller is missing ... a roller file"},
      {"not of what", "@ none", "what the values are of is missing ... whole or per_metre"},
      {"per foot", "@ none per_foot", "what the values are of is 'per_foot' ... whole or per_metre"},
      {"a word too many", "@ none whole setting none high",
       "argument is 'high' ... FILE, whole or per_metre"},
      {"no name of a setting", "@ none whole setting", "setting is missing"},
      {"a setting of no roller", "@ none whole setting high", "setting is 'high' ... none, since no roller"},
      {"no file", "@ nofile whole", "roller is 'nofile' ... a file that can be read", on_two_ranks},
      {"a folder", "@ out whole", "roller is 'out' ... a file that can be read"},
      {"another kind of file", "@ out/chain.csv whole", "name in line 1 of 'out/chain.csv' is ",
       on_two_ranks},
  });
}

BadGroup take() {
  return Table{"Take", "drumlin/take: ", "drumlin/take"}.of({
      {"nothing", "@", "file is missing"},
      {"no decks", "@ out/x", "the list of decks is missing"},
      {"no list of changes", "@ out/x in.settle", "the variables that may change is missing"},
      {"unknown keyword", "@ out/chain.csv in.settle none if_noted soil",
       "keyword is 'if_noted' ... fixed, free, except, only, default or later"},
      {"no file", "@ nofile in.settle none fixed soil", "file is 'nofile'; allowed: a file that can be read",
       on_two_ranks},
      {"a folder", "@ out in.settle none free soil", "file is 'out'; allowed: a file that can be read"},
      {"no notes", "@ out/chain.csv in.settle none fixed soil",
       "file is 'out/chain.csv', which notes no values; allowed: a file that in.settle", on_two_ranks},
  });
}

/// The value is wrong, or not that of a file with which it was made: refused by the closing command.
BadGroup variable() {
  const std::string made = "drumlin/write data own.data k 1 m 2\n";
  const std::string rest = "@ k 1 positive N/m soil \"stiffness\"\ndrumlin/variables";
  return Table{"Variable", "drumlin/variable: ", "drumlin/variable"}.of({
      {"nothing", "@", "name is missing ... the variable's name"},
      {"no default", "@ k", "default value of variable k is missing"},
      {"no rule", "@ k 1", "rule of variable k is missing ... a rule of drumlin/check, any, words or noted"},
      {"no unit", "@ k 1 any", "unit of variable k is missing ... a unit, or -"},
      {"no group", "@ k 1 any -", "group of variable k is missing ... a word"},
      {"no meaning", "@ k 1 any - soil", "meaning of variable k is missing ... a text in quotes"},
      {"a meaning without quotes", "@ k 1 any - soil of all contacts",
       "argument is 'all' ... NAME DEFAULT RULE UNIT"},
      {"unknown rule", "@ k 1 small - soil \"stiffness\"", "rule for variable k is 'small' ... multiple_of",
       on_two_ranks},
      {"a rule without its words", "@ k 1 \"integer 1\" - soil \"number\"",
       "rule integer, highest is missing"},
      {"a rule of too many words", "@ k 1 \"positive 2\" - soil \"number\"",
       "argument behind the rule for variable k is '2' ... one value and one rule"},
      {"a default that breaks the rule", "@ k 0 positive N/m soil \"stiffness\"\ndrumlin/variables",
       "variable k is '0' ... a finite number > 0"},
      {"an earlier line that breaks the rule", "variable k index -1\n" + rest,
       "variable k is '-1' ... a finite number > 0", on_two_ranks},
      {"a word of a list",
       "variable kinds index \"sand silt\"\n@ soil mud \"one_of ${kinds}\" - soil \"kind\"\n"
       "drumlin/variables",
       "variable soil is 'mud' ... sand or silt"},
      {"the first of two faults", "@ g -1 non_negative m/s2 run \"gravity\"\nvariable k index -1\n" + rest,
       "variable g is '-1'"},
      {"a check before the end of declarations",
       "@ n 3 \"integer 1 9\" - run \"number\"\ndrumlin/check n 3 one_of 4\nvariable k index -1\n@ k 1 "
       "positive - soil \"stiffness\"\ndrumlin/variables",
       "drumlin/check: variable n is '3' ... 4", in_engine_words},
      {"a record of a fault", "@ k 0 positive N/m soil \"stiffness\"\ndrumlin/record out/parameters.csv",
       "variable k is '0' ... a finite number > 0", on_two_ranks},
      {"a file without its note",
       "drumlin/write data own.data m 2\ndrumlin/take own.data in.settle none fixed soil\n" + rest,
       "variable k is '1' ... a file that notes its value, which 'own.data' does not: one that in.settle",
       on_two_ranks},
      {"not the value of a file, fixed",
       made + "variable k index 3\ndrumlin/take own.data in.settle k fixed soil\n" + rest,
       "variable k is '3'; allowed: 1, with which 'own.data' was made; for another value run in.settle again",
       on_two_ranks},
      {"not the value of a file, free",
       made + "variable k index 3\ndrumlin/take own.data in.settle none free soil\n" + rest,
       "variable k is '3'; allowed: 1, with ... or change it on purpose by -var allow_change k"},
      {"not the value of a file, in no group",
       made + "variable k index 3\ndrumlin/take own.data in.settle none\n" + rest,
       "variable k is '3'; allowed: 1, with ... for another value begin a new run"},
      {"the value of a file breaks the rule",
       "drumlin/write data own.data k -1\ndrumlin/take own.data in.settle none free soil\n" + rest,
       "variable k is '-1' ... a finite number > 0"},
  });
}

BadGroup variables() {
  return Table{"Variables", "drumlin/variables: ", "drumlin/variables"}.of({
      {"nothing", "@", "the names are missing"},
      {"names behind declarations", "drumlin/variable k 1 positive - soil \"k\"\n@ D",
       "name is 'D' ... no names behind drumlin/variable, which declares each"},
      {"an unknown group",
       "drumlin/write data own.data k 1\ndrumlin/take own.data in.settle none fixed soil\n"
       "drumlin/variable k 1 positive - roller \"k\"\n@",
       "group of drumlin/take is 'soil' ... a group of variables of drumlin/variable"},
      {"a change that is not free",
       "drumlin/write data own.data k 1 m 2\ndrumlin/take own.data in.settle m free soil fixed roller\n"
       "drumlin/variable k 1 positive - soil \"k\"\ndrumlin/variable m 2 positive - roller \"m\"\n@",
       "variable allow_change is 'm' ... none, or names between commas out of k", on_two_ranks},
  });
}

BadGroup settle() {
  return Table{"Settle", "drumlin/settle: ", "drumlin/settle"}.of({
      {"ratio without value", "@ ratio", "keyword ratio is missing ... > 0"},
      {"ratio zero", "@ ratio 0", "keyword ratio is '0' ... > 0"},
      {"ratio a word", "@ ratio small", "keyword ratio is 'small' ... > 0"},
      {"every zero", "@ every 0", "keyword every is '0' ... a whole number from 1"},
      {"limit negative", "@ limit -1", "keyword limit is '-1' ... a whole number from 0"},
      {"fixed without group", "@ fixed", "keyword fixed is missing ... the name of a group"},
      {"unknown fixed group", "@ fixed rock", "keyword fixed is 'rock' ... the name of a group"},
      {"unknown keyword", "@ steps 10", "keyword is 'steps' ... ratio, every, limit, force, loose or fixed"},
      {"loose negative", "@ loose -1 100", "keyword loose, share is '-1' ... >= 0"},
      {"loose without steps", "@ loose 0.1", "keyword loose, steps is missing ... a whole number from 1"},
      {"more than the loose balls", "@ limit 10 every 1 loose 1e-3 5 fixed soil",
       "unbalanced ratio is ' ... after 10 steps"},
      {"force zero", "@ force 0", "keyword force is '0' ... > 0"},
      {"force without value", "@ force", "keyword force is missing ... > 0"},
      {"limit too short", "@ limit 10 fixed soil",
       "unbalanced ratio is ' ... after 10 steps ... at most 1e-10 within 10 steps", on_two_ranks},
  });
}

/// What decks have besides the plugin.
BadGroup other_styles() {
  BadGroup group = Table{"OtherStyles", "pair_style gran model hooke/transition: ", ""}.of({
      {"", "run_style respa 2 2", "run_style is 'respa' ... verlet", on_two_ranks},
      {"", "neighbor 0.25 multi",
       "neighbor style is 'multi', with which this engine finds no contact ... bin or nsq", on_two_ranks},
      {"", "fix slow all momentum 10 linear 1 1 1",
       "stepping is 'second' and fix slow (momentum) changes velocities ... stepping stock", on_two_ranks},
      {"", "unfix integrate\nfix slow all nve/limit absolute 0.1",
       "stepping is 'second' and fix slow (nve/limit) changes velocities ... stepping stock"},
  });
  group.inputs.push_back(
      {"another time step without a set-up",
       "run 5\ntimestep 2e-5\nrun 5 pre no",
       {"stepping second: time step is '2e-05' at step 6, changed from 1e-05 s within a run",
        "no keyword pre no"},
       in_the_run});
  return group;
}

BadGroup other_styles_in_lammps() {
  return Table{"OtherStylesInLammps", "pair_style gran/hooke/transition: ",
               "pair_style gran/hooke/transition\npair_coeff * * 1e5 0.2", true}
      .of({
          {"", "@\nrun_style respa 2 2", "run_style is 'respa' ... verlet", on_two_ranks},
          {"", "@\nminimize 1e-6 1e-6 10 10",
           "command is 'minimize', which does not move balls in time ... allowed: run", on_two_ranks},
          {"", "@\nmin_style quickmin\nminimize 1e-6 1e-6 10 10",
           "command is 'minimize', which does not move balls in time ... allowed: run"},
          {"",
           "@\nfix move all nve/sphere\ndump d all custom 5 out/all.dump id type x y z vx vy vz\nrun "
           "10\nundump d\nrerun out/all.dump dump x y z vx vy vz",
           "command is 'rerun', which does not move balls in time ... allowed: run"},
          {"", "@\nfix cool all temp/berendsen 1 1 0.1",
           "stepping is 'second' and fix cool (temp/berendsen) changes velocities ... stepping stock",
           on_two_ranks},
          {"", "@\nfix move all nve/limit 0.01",
           "stepping is 'second' and fix move (nve/limit) changes velocities ... stepping stock"},
          {"", "@\nfix back all wall/reflect zlo -1.9",
           "stepping is 'second' and fix back (wall/reflect) changes velocities ... stepping stock"},
          {"",
           "variable half equal 0.5\npair_style hybrid/scaled v_half gran/hooke/transition 1.0 lj/cut "
           "0.1\npair_coeff * * lj/cut 0 1\npair_coeff * * gran/hooke/transition 1e5 0.2",
           "pair_style is 'hybrid/scaled' ... hybrid or hybrid/overlay"},
      });
}

BadGroup fixes_in_lammps() {
  const std::string more =
      "@\nfix ground all boundary/absorb normal 0 0 -1 area 1 density 1800 speeds 300 170";
  return Table{"FixesInLammps", "", "pair_style gran/hooke/transition\npair_coeff * * 1e5 0.2", true}.of({
      {"", "@\nfix guard all guard every 0", "fix guard ... keyword every is '0'"},
      {"", "@\nfix excite all drum/excite amplitude 1 omega -1", "fix drum/excite ... keyword omega is '-1'"},
      {"", "@\nfix ground all boundary/absorb",
       "fix boundary/absorb ... keyword normal is missing ... normal x y z"},
      {"", "@\nfix ground all boundary/absorb normal 0 0 0",
       "fix boundary/absorb ... keyword normal is '0 0 0' ... a vector with a length"},
      {"", "@\nfix ground all boundary/absorb density nan",
       "fix boundary/absorb ... keyword density is 'nan' ... > 0"},
      {"", "@\nfix ground all boundary/absorb speeds 300",
       "fix boundary/absorb ... keyword speeds, of shear waves is missing ... >= 0"},
      {"", "@\nfix ground all boundary/absorb normal 0 0 -1 area 1 density 1800 speeds 300 301",
       "fix boundary/absorb ... speed of shear waves is '301 m/s' ... at most ... 300 m/s"},
      {"", more + " depth", "fix boundary/absorb ... keyword depth is missing ... > 0"},
      {"", more + " static maybe", "fix boundary/absorb ... keyword static is 'maybe' ... yes or no"},
      {"", more + " stiffness 5",
       "fix boundary/absorb ... keyword is 'stiffness' ... normal, area, density, speeds, depth or static"},
      {"",
       "@\ngroup nobody id 1000\nfix ground nobody boundary/absorb normal 0 0 -1 area 1 density 1800 speeds "
       "300 170",
       "fix boundary/absorb ... group is 'nobody', which is empty ... the boundary's balls"},
      {"",
       "@\nfix early all nve/sphere\nfix ground all boundary/absorb normal 0 0 -1 area 1 density 1800 speeds "
       "300 170 static yes",
       "fix boundary/absorb ... keyword static is 'yes' behind fix early (nve/sphere), which integrates ... "
       "before all fixes that integrate balls of the boundary"},
      {"", "drumlin/check k 0 positive", "drumlin/check ... variable k is '0' ... a finite number > 0"},
  });
}

} // namespace

std::vector<BadGroup> bad_lines() {
  return {drum_excite(),
          drum_travel(),
          contact_way(),
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
          write(),
          outputs(),
          take(),
          variables(),
          variable(),
          ends(),
          layers(),
          suction(),
          pick(),
          roller(),
          other_styles(),
          other_styles_in_lammps(),
          fixes_in_lammps()};
}

} // namespace drumlin::test
