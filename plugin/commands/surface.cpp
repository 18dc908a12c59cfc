#include "commands/commands.h"
#include "commands/deck_variables.h"
#include "commands/vertical_lines.h"

#include "support/arguments.h"

#include <fmt/format.h>

namespace drumlin {

using LAMMPS_NS::LAMMPS;

void surface_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/surface", narg, arg);
  const std::string name = in.word("variable", "the name of a variable");
  const int group = in.group("group", lmp->group);
  double spacing = 0.0, middle = 0.0, beyond = 0.0;
  while (!in.empty()) {
    const std::string keyword = in.word("keyword");
    if (keyword == "spacing")
      spacing = in.number("keyword spacing", Range::positive);
    else if (keyword == "beyond") {
      beyond = in.number("keyword beyond, distance", Range::non_negative);
      middle = in.number("keyword beyond, x");
    } else
      in.fail("keyword", keyword, "spacing or beyond");
  }
  if (spacing == 0.0) in.fail("keyword spacing is missing; allowed: a finite number > 0");
  if (lmp->domain->box_exist == 0)
    in.fail("simulation box is missing; allowed: the command after create_box or read_data");
  const int bit = engine::group_bit(group);
  const double height =
      VerticalLines(lmp, in, spacing)
          .mean_height([&](int i) { return (lmp->atom->mask[i] & bit) != 0; }, middle, beyond);
  if (std::isnan(height))
    in.fail("group", lmp->group->names[group], "one with a ball that a vertical line meets there");
  DeckVariables(lmp).set(name, fmt::format("{:.17g}", height));
  engine::log_message(lmp, fmt::format("drumlin/surface: {} at {:.4g} m\n", name, height));
}

} // namespace drumlin
