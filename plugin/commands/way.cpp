#include "commands/commands.h"

#include "commands/deck_variables.h"
#include "physics/files/way.h"
#include "support/arguments.h"

#include <fmt/format.h>
#include <stdexcept>

namespace drumlin {

void way_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/way", narg, arg);
  const std::string file = in.word("way", "a file with the columns " + std::string(way_file::header));
  in.expect_end("FILE");
  DeckVariables variables(lmp);
  variables.set("drives", file == "none" ? "0" : "1");
  if (file == "none" || !variables.fault().empty()) return;
  // Rank 0 reads the file, and the others get what they need: only one rank needs to see it.
  std::string fault;
  std::array<double, 4> values{1.0, 0.0, 0.0, 1.0}; // k and D at the start of the way, and its ends, m
  if (lmp->comm->me == 0) try {
      const Way way = read_way(file);
      values = {way.front().k, way.front().D, way.front().s, way.back().s};
    } catch (const std::invalid_argument &error) {
      fault = error.what();
    }
  MPI_Bcast(values.data(), 4, MPI_DOUBLE, 0, lmp->world);
  auto length = static_cast<int>(fault.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, lmp->world);
  fault.resize(static_cast<std::size_t>(length));
  MPI_Bcast(fault.data(), length, MPI_CHAR, 0, lmp->world);
  for (const GivenVariable &given : given_variables())
    if (fault.empty() && (given.name == "k" || given.name == "D"))
      fault = given.shown() + "; allowed: none with a way, which has it of each place";
  if (!fault.empty()) DeckVariables::refuse(lmp, "drumlin/way: " + fault);
  const char *names[] = {"k", "D", "way_begin", "way_end"};
  for (std::size_t n = 0; n < 4; ++n)
    variables.set_default(names[n], fmt::format("{:.17g}", values[n]));
}

} // namespace drumlin
