#include "commands/commands.h"

#include "commands/deck_variables.h"
#include "contact/fix_stepping.h"
#include "physics/laws/contact_mixing.h"
#include "physics/scheme/stability_limit.h"
#include "support/arguments.h"

#include <algorithm>
#include <fmt/format.h>
#include <optional>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;
using physics::ContactValues;

/// Types of a bed: 1 is the lowest layer, 2 the drum, 3 the frame and the walls, 4 the second layer, and so
/// on.
constexpr int types_without_layer = 2;

/// Number of the layer, from 0, of a type; -1 for a type that is no layer.
int layer_of(int type) { return type == 1 ? 0 : type > 3 ? type - 3 : -1; }
int type_of(int layer) { return layer == 0 ? 1 : layer + 3; }

/// The values of one keyword, one for each layer. \param name of the keyword, or of the variable that gives
/// its values
std::vector<double> values(Arguments &in, const std::string &name, Range range, int layers) {
  const std::string text = in.word(name, "a number for each layer, separated by commas");
  std::vector<double> numbers = list_numbers(in, name, text, range);
  if (numbers.size() == 1) numbers.resize(static_cast<std::size_t>(layers), numbers[0]);
  if (numbers.size() != static_cast<std::size_t>(layers))
    in.fail(
        name, text,
        layers == 1
            ? "one number, since the bed has one layer"
            : fmt::format("one number, or {} separated by commas, one for each layer, the lowest first, and "
                          "then one for each spot",
                          layers));
  return numbers;
}

/// The contact of balls of two types. Drum and walls take the values of the layer that they touch, but for
/// suction: it is 0 there, since with suction the drum would stick to the soil. (Drum and frame do not
/// touch.)
ContactValues contact(const std::vector<ContactValues> &layers, int type_a, int type_b) {
  const int a = layer_of(type_a), b = layer_of(type_b);
  if (a < 0 || b < 0) {
    ContactValues one = layers[static_cast<std::size_t>(std::max({a, b, 0}))];
    one.suction = 0.0;
    return one;
  }
  if (a == b) return layers[static_cast<std::size_t>(a)];
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

/// A list of the command, for errors: what the user calls it, and its text.
struct Given {
  std::string name, text;
};

/// What the user calls a list whose variable is `name`: of `a/b` it is a, or b if that has the same value.
std::string variable_of(LAMMPS *lmp, const std::string &name, const std::string &value) {
  const std::size_t slash = name.find('/');
  if (slash == std::string::npos) return "variable " + name;
  std::string other = name.substr(slash + 1);
  auto &all = *lmp->input->variable;
  const char *followed = all.find(other.data()) >= 0 ? all.retrieve(other.data()) : nullptr;
  return "variable " + (followed != nullptr && value == followed ? other : name.substr(0, slash));
}

/// Refuses a stiffness, or a damping ratio, with which two balls of a layer have a critical step below the
/// time step: the first of their contacts would throw them out of the box before fix guard sees it.
/// Collective.
void check_stability(LAMMPS *lmp, const Arguments &in, const Given &k, const Given &D,
                     const std::vector<ContactValues> &laws, double yield) {
  const std::vector<double> masses = least_masses(lmp, static_cast<int>(laws.size()));
  const double dt = lmp->update->dt;
  for (std::size_t layer = 0; layer < laws.size(); ++layer) {
    const double m_eff = 0.5 * masses[layer], stiffness = yield * laws[layer].stiffness;
    const auto refuse = [&](const Given &given, double critical, double largest, const char *unit) {
      in.fail(fmt::format("{} is '{}', with which two of the lightest balls of layer {} have the critical "
                          "step {:.3g} s; allowed: at most {:.3g}{} with the time step {:.3g} s",
                          given.name, given.text, layer + 1, critical, largest, unit, dt));
    };
    if (const double critical = physics::critical_step_stock(stiffness, 0.0, m_eff); dt > critical)
      refuse(k, critical, 4.0 * m_eff / (dt * dt) / yield, " N/m");
    if (std::isinf(m_eff) || LAMMPS_NS::FixStepping::find(lmp) != nullptr)
      continue; // under `stepping second` the dashpots do not limit the step
    const double w = physics::angular_frequency(stiffness, m_eff), q = 0.5 * w * dt;
    const double c = 2.0 * laws[layer].damping_ratio * m_eff * w;
    if (const double critical = physics::critical_step_stock(stiffness, c, m_eff); dt > critical)
      refuse(D, critical, 0.5 * (1.0 - q * q) / q, "");
  }
}

} // namespace

void layers_command(LAMMPS *lmp, int narg, char **arg) {
  // The names of the variables come last: errors in what stands before them use them.
  constexpr int variables = 4;
  const bool named = narg > variables && std::string(arg[narg - variables - 1]) == "variables";
  Arguments in(lmp->error, "drumlin/layers", named ? narg - variables - 1 : narg, arg);
  if (lmp->domain->box_exist == 0)
    in.fail("simulation box is missing; allowed: the command after create_box, read_data or read_restart");
  const int types = lmp->atom->ntypes;
  if (types <= types_without_layer)
    in.fail(fmt::format(
        "the number of types is '{}'; allowed: at least 3: lowest layer, drum, frame and walls", types));
  const int layers = types - types_without_layer;
  std::vector<ContactValues> laws(static_cast<std::size_t>(layers));
  const auto read = [&](int n, const std::string &keyword, double ContactValues::*value, Range range) {
    const std::string text = in.empty() ? "" : in.peek();
    Given given{named && n < variables ? variable_of(lmp, arg[narg - variables + n], text)
                                       : "keyword " + keyword,
                text};
    const std::vector<double> numbers = values(in, given.name, range, layers);
    for (std::size_t layer = 0; layer < laws.size(); ++layer)
      laws[layer].*value = numbers[layer];
    return given;
  };
  in.choice("keyword", {"k"});
  const Given k = read(0, "k", &ContactValues::stiffness, Range::positive);
  in.choice("keyword", {"D"});
  const Given D = read(1, "D", &ContactValues::damping_ratio, Range::non_negative);
  in.choice("keyword", {"friction"});
  read(2, "friction", &ContactValues::friction, Range::non_negative);
  in.choice("keyword", {"rolling"});
  const bool rolling = in.choice("keyword rolling, model", {"off", "epsd2"}) == 1;
  read(3, "rolling", &ContactValues::rolling, Range::non_negative);
  if (!in.empty() && in.peek() == "suction") {
    in.word("keyword");
    read(variables, "suction", &ContactValues::suction, Range::non_negative);
  }
  std::optional<double> yield;
  if (!in.empty() && in.peek() == "yield") {
    in.word("keyword");
    const double ratio =
        in.number("keyword yield, stiffness of unloading over that of first loading", Range{1.0});
    if (ratio > 1.0) yield = ratio; // else the law is linear, and knows no ratio
  }
  in.expect_end(
      "k LIST D LIST friction LIST rolling off|epsd2 LIST [suction LIST] [yield RATIO] [variables NAME "
      "NAME NAME NAME]");
  const std::vector<int> counts = ball_counts(lmp, layers);
  if (const auto none = std::find(counts.begin(), counts.end(), 0); layers > 1 && none != counts.end()) {
    const auto layer = static_cast<int>(none - counts.begin());
    in.fail(fmt::format("layer {} has '0' balls; allowed: at least one ball of type {}", layer + 1,
                        type_of(layer)));
  }
  check_stability(lmp, in, k, D, laws, yield.value_or(1.0));
  std::vector<ContactValues> table;
  for (int a = 1; a <= types; ++a)
    for (int b = 1; b <= types; ++b)
      table.push_back(contact(laws, a, b));
  engine::set_contacts(lmp, table, true, rolling, yield);
}

void pick_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/pick", narg, arg);
  constexpr const char *allowed = "largest, or the place of a number in the list, from 1";
  const std::string name = in.word("variable", "the name of a variable");
  const std::string which = in.word("which", allowed), list = in.word("list", "numbers separated by commas");
  in.expect_end("a variable, which number, and a list");
  const std::vector<double> numbers = list_numbers(in, "list", list, Range::any);
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

/// Rumpf's tensile strength S of a packing with the solid fraction P. A ball has Z contacts on average, no
/// direction is preferred, and each contact can carry the tension F_a:
///   S = P Z F_a <d> / (pi <d^n>),   n = 2, 3: number of dimensions; <>: mean over the balls of the group;
/// in Pa, in two dimensions with F_a per metre of depth. Solved here for F_a.
void suction_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/suction", narg, arg);
  const std::string name = in.word("variable", "the name of a variable");
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
  if (strength == 0.0) return;
  const std::string value = fmt::format("{:.17g}", strength * pi * sums[1] / (solid * contacts * sums[0]));
  DeckVariables(lmp).set(name, value);
  engine::log_message(lmp, fmt::format("suction {} N for the tensile strength {} Pa\n", value, strength));
}

} // namespace drumlin
