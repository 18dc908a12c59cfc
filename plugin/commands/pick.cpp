#include "commands/commands.h"

#include "support/arguments.h"

#include <algorithm>
#include <fmt/format.h>

namespace drumlin {

void pick_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/pick", narg, arg);
  constexpr const char *allowed = "largest, or the place of a number in the list, from 1";
  std::string name = in.word("variable", "the name of a variable");
  const std::string which = in.word("which", allowed), list = in.word("list", "numbers separated by commas");
  in.expect_end("a variable, which number, and a list");
  std::vector<double> numbers;
  for (const std::string &entry : list_entries(list)) {
    numbers.push_back(parse_number(entry));
    if (!std::isfinite(numbers.back())) in.fail("list", list, "finite numbers separated by commas");
  }
  double picked = numbers.front();
  if (which == "largest") {
    picked = *std::max_element(numbers.begin(), numbers.end());
  } else {
    const double place = parse_number(which);
    if (!(place >= 1.0) || place != std::floor(place)) in.fail("which", which, allowed);
    if (numbers.size() > 1) { // a list of one number holds for all layers
      if (place > static_cast<double>(numbers.size()))
        in.fail("which", which, fmt::format("at most {}, the length of the list", numbers.size()));
      picked = numbers[static_cast<std::size_t>(place) - 1];
    }
  }
  std::string words[] = {name, "string", fmt::format("{:.17g}", picked)};
  char *pointers[] = {words[0].data(), words[1].data(), words[2].data()};
  lmp->input->variable->set(3, pointers);
}

} // namespace drumlin
