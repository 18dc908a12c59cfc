#include "commands/commands.h"

#include "support/arguments.h"

#include <fmt/format.h>

namespace drumlin {

/// Rumpf's tensile strength of a packing of solid fraction P, in which each ball has Z contacts on average,
/// in all directions alike, and each contact can carry the tension F_a:
///   S = P Z F_a <d> / (pi <d^n>),   n = 2, 3: number of dimensions; <>: mean over the balls of the group;
/// in Pa, in two dimensions with F_a per metre of depth. Solved here for F_a.
void suction_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/suction", narg, arg);
  std::string name = in.word("variable", "the name of a variable");
  const int bit = engine::group_bit(in.group("group", lmp->group));
  in.choice("keyword", {"strength"});
  const double strength = in.number("keyword strength", Range::non_negative);
  in.choice("keyword", {"solid"});
  const double solid = in.number("keyword solid", {0.0, true, 1.0});
  in.choice("keyword", {"contacts"});
  const double contacts = in.number("keyword contacts", Range::positive);
  in.expect_end("NAME GROUP strength S solid P contacts Z");

  const LAMMPS_NS::Atom &atom = *lmp->atom;
  std::array<double, 2> sums{}; // of d and of d^n
  for (int i = 0; i < atom.nlocal; ++i) {
    if (!(atom.mask[i] & bit)) continue;
    const double d = 2.0 * atom.radius[i];
    sums[0] += d;
    sums[1] += lmp->domain->dimension == 2 ? d * d : d * d * d;
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, lmp->world);
  if (sums[0] == 0.0) in.fail("the group has '0' balls; allowed: a group with balls");
  constexpr double pi = 3.141592653589793;
  std::string words[] = {name, "string",
                         fmt::format("{:.17g}", strength * pi * sums[1] / (solid * contacts * sums[0]))};
  char *pointers[] = {words[0].data(), words[1].data(), words[2].data()};
  lmp->input->variable->set(3, pointers);
}

} // namespace drumlin
