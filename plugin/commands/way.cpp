#include "commands/commands.h"

#include "commands/deck_variables.h"
#include "physics/files/way.h"
#include "support/arguments.h"

#include <fmt/format.h>
#include <sstream>
#include <stdexcept>

namespace drumlin {

void way_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/way", narg, arg);
  const std::string file = in.word("way", "a file with the columns " + std::string(way_file::header));
  in.expect_end("FILE");
  DeckVariables variables(lmp);
  if (!variables.fault().empty()) return; // drumlin/variables will tell it
  std::string fault, values = "1 0 0 1";  // k and D at the start of the way, and its ends, m
  if (lmp->comm->me == 0) try {
      const Way way = read_way(file);
      values = fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}", way.front().k, way.front().D, way.front().s,
                           way.back().s);
    } catch (const std::invalid_argument &error) {
      fault = error.what();
    }
  fault = engine::from_rank_0(lmp, fault);
  for (const GivenVariable &given : given_variables())
    if (fault.empty() && (given.name == "k" || given.name == "D"))
      fault = given.shown() + "; allowed: none with a way, which has it of each place";
  if (!fault.empty()) DeckVariables::refuse(lmp, "drumlin/way: " + fault);
  std::istringstream numbers(engine::from_rank_0(lmp, values));
  for (const char *name : {"k", "D", "way_begin", "way_end"}) {
    std::string value;
    numbers >> value;
    variables.set_default(name, value);
  }
}

} // namespace drumlin
