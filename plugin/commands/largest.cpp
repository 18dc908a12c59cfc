#include "commands/commands.h"

#include "support/arguments.h"

#include <algorithm>
#include <fmt/format.h>

namespace drumlin {

void largest_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/largest", narg, arg);
  std::string name = in.word("variable", "the name of a variable");
  const std::string list = in.word("list", "numbers separated by commas");
  in.expect_end("a variable and a list");
  double largest = -std::numeric_limits<double>::infinity();
  for (const std::string &entry : list_entries(list)) {
    const double number = parse_number(entry);
    if (!std::isfinite(number)) in.fail("list", list, "finite numbers separated by commas");
    largest = std::max(largest, number);
  }
  std::string words[] = {name, "string", fmt::format("{:.17g}", largest)};
  char *pointers[] = {words[0].data(), words[1].data(), words[2].data()};
  lmp->input->variable->set(3, pointers);
}

} // namespace drumlin
