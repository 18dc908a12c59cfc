#include "commands/commands.h"

#include "physics/contact_mixing.h"
#include "physics/time_step.h"
#include "support/arguments.h"

#include <algorithm>
#include <fmt/format.h>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;
using physics::ContactValues;

/// Types of a bed: 1 is the lowest layer, 2 the drum, 3 the frame and the walls, 4 the second layer, and so on.
constexpr int types_without_layer = 2;

/// Number of the layer, from 0, of a type; -1 for a type that is no layer.
int layer_of(int type) { return type == 1 ? 0 : type > 3 ? type - 3 : -1; }
int type_of(int layer) { return layer == 0 ? 1 : layer + 3; }

/// The values of one keyword, one for each layer.
std::vector<double> values(Arguments &in, const std::string &keyword, Range range, int layers) {
  const std::string text = in.word("keyword " + keyword, "a number for each layer, separated by commas");
  std::vector<double> numbers;
  for (const std::string &entry : list_entries(text)) {
    numbers.push_back(parse_number(entry));
    if (!in_range(numbers.back(), range)) in.fail("keyword " + keyword, text, allowed_text(range));
  }
  if (numbers.size() == 1) numbers.resize(static_cast<std::size_t>(layers), numbers[0]);
  if (numbers.size() != static_cast<std::size_t>(layers))
    in.fail("keyword " + keyword, text,
            layers == 1
                ? "one number, since the bed has one layer"
                : fmt::format("one number, or {} separated by commas, one for each layer, the lowest first",
                              layers));
  return numbers;
}

/// The contact of balls of two types. That of a layer with the drum or a wall is the layer's own; drum and frame
/// have no contacts with each other.
ContactValues contact(const std::vector<ContactValues> &layers, int type_a, int type_b) {
  const int a = layer_of(type_a), b = layer_of(type_b);
  if (a == b || b < 0) return layers[static_cast<std::size_t>(std::max(a, 0))];
  if (a < 0) return layers[static_cast<std::size_t>(b)];
  return physics::mixed(layers[static_cast<std::size_t>(a)], layers[static_cast<std::size_t>(b)]);
}

/// Number of balls of each layer on all ranks. Collective.
std::vector<int> ball_counts(const LAMMPS *lmp, int layers) {
  std::vector<int> counts(static_cast<std::size_t>(layers));
  for (int i = 0; i < lmp->atom->nlocal; ++i)
    if (const int layer = layer_of(lmp->atom->type[i]); layer >= 0) ++counts[static_cast<std::size_t>(layer)];
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), layers, MPI_INT, MPI_SUM, lmp->world);
  return counts;
}

/// Mass of the lightest ball of each layer on all ranks, kg; infinity without balls. Collective.
std::vector<double> least_masses(const LAMMPS *lmp, int layers) {
  std::vector<double> masses(static_cast<std::size_t>(layers), std::numeric_limits<double>::infinity());
  for (int i = 0; i < lmp->atom->nlocal; ++i)
    if (const int layer = layer_of(lmp->atom->type[i]); layer >= 0) {
      double &least = masses[static_cast<std::size_t>(layer)];
      least = std::min(least, lmp->atom->rmass[i]);
    }
  MPI_Allreduce(MPI_IN_PLACE, masses.data(), layers, MPI_DOUBLE, MPI_MIN, lmp->world);
  return masses;
}

/// Refuses a stiffness with which two balls of a layer have a critical step below the time step: the first of their contacts would
/// throw them out of the box before fix guard sees it. Collective.
void check_stiffnesses(const LAMMPS *lmp, const Arguments &in, const std::string &given,
                       const std::vector<ContactValues> &laws) {
  const std::vector<double> masses = least_masses(lmp, static_cast<int>(laws.size()));
  const double dt = lmp->update->dt;
  for (std::size_t layer = 0; layer < laws.size(); ++layer) {
    const double m_eff = 0.5 * masses[layer], k = laws[layer].stiffness;
    if (const double critical = physics::critical_step_stock(k, 0.0, m_eff); dt > critical)
      in.fail(fmt::format("keyword k is '{}', with which two of the lightest balls of layer {} have the "
                          "critical step {:.3g} s; "
                          "allowed: at most {:.3g} N/m with the time step {:.3g} s",
                          given, layer + 1, critical, 4.0 * m_eff / (dt * dt), dt));
  }
}

} // namespace

void layers_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/layers", narg, arg);
  if (lmp->domain->box_exist == 0)
    in.fail("simulation box is missing; allowed: the command after create_box, read_data or read_restart");
  const int types = lmp->atom->ntypes;
  if (types <= types_without_layer)
    in.fail(fmt::format(
        "the number of types is '{}'; allowed: at least 3: lowest layer, drum, frame and walls", types));
  const int layers = types - types_without_layer;
  std::vector<ContactValues> laws(static_cast<std::size_t>(layers));
  const auto read = [&](const std::string &keyword, double ContactValues::*value, Range range) {
    const std::vector<double> numbers = values(in, keyword, range, layers);
    for (std::size_t layer = 0; layer < laws.size(); ++layer)
      laws[layer].*value = numbers[layer];
  };
  in.choice("keyword", {"k"});
  const std::string stiffnesses = in.empty() ? "" : in.peek();
  read("k", &ContactValues::stiffness, Range::positive);
  in.choice("keyword", {"D"});
  read("D", &ContactValues::damping_ratio, Range::non_negative);
  in.choice("keyword", {"friction"});
  read("friction", &ContactValues::friction, Range::non_negative);
  in.choice("keyword", {"rolling"});
  const bool rolling = in.choice("keyword rolling, model", {"off", "epsd2"}) == 1;
  read("rolling", &ContactValues::rolling, Range::non_negative);
  in.expect_end("k LIST D LIST friction LIST rolling off|epsd2 LIST");
  const std::vector<int> counts = ball_counts(lmp, layers);
  if (const auto none = std::find(counts.begin(), counts.end(), 0); layers > 1 && none != counts.end()) {
    const auto layer = static_cast<int>(none - counts.begin());
    in.fail(fmt::format("layer {} has '0' balls; allowed: at least one ball of type {}", layer + 1,
                        type_of(layer)));
  }
  check_stiffnesses(lmp, in, stiffnesses, laws);
  std::vector<ContactValues> table;
  for (int a = 1; a <= types; ++a)
    for (int b = 1; b <= types; ++b)
      table.push_back(contact(laws, a, b));
  engine::set_contacts(lmp, table, rolling);
}

} // namespace drumlin
