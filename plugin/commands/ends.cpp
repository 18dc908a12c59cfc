#include "commands/commands.h"

#include "commands/deck_variables.h"
#include "physics/files/axle_links.h"
#include "physics/laws/contact_mixing.h"
#include "support/arguments.h"

#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;

/// Numbers of the run that the command needs.
struct Values {
  double m2, m3, k23, c23, k, D, g;
};

/// The contacts that are asked for by their number or by a file. Throws std::invalid_argument.
std::vector<AxleLink> asked_contacts(const std::string &asked, double width, const Values &values) {
  const double count = parse_number(asked);
  if (std::isnan(count)) {
    for (const GivenVariable &given : given_variables())
      if (given.name == "k" || given.name == "D")
        throw std::invalid_argument(given.shown() + "; allowed: none with a file of contacts, which has k "
                                                    "and c of each");
    return read_contacts(asked, width);
  }
  if (!(count >= 1.0 && count <= most_contacts && count == std::floor(count)))
    throw std::invalid_argument(contacts_refusal(asked));
  return equal_contacts(static_cast<int>(count), width, values.k,
                        2.0 * values.D * std::sqrt(values.m2 * values.k));
}

/// The bonds for fix bond/spring: a spring and a dashpot at the same place are one. The fix needs a
/// stiffness: a dashpot alone gets one that cannot be noticed.
std::vector<AxleLink> bonds_of(const std::vector<AxleLink> &links, double k23) {
  const double hardly = 1e-12 * k23;
  std::vector<AxleLink> bonds;
  for (std::size_t side = 0; side < 2; ++side) {
    const AxleLink &spring = links[side], &dashpot = links[side + 2];
    const bool together = spring.y == dashpot.y;
    bonds.push_back({spring.y, std::max(hardly, spring.k), together ? dashpot.c : 0.0});
    if (!together) bonds.push_back({dashpot.y, hardly, dashpot.c});
  }
  return bonds;
}

/// A column of links as a list for drumlin/pick.
template <class Number>
std::string list_of(const std::vector<AxleLink> &links, const Number &number) {
  std::string list;
  for (const AxleLink &link : links)
    list += fmt::format("{}{:.17g}", list.empty() ? "" : ",", number(link));
  return list;
}

/// The variables of the deck, as names and values. Throws std::invalid_argument.
std::vector<std::pair<std::string, std::string>>
variables_of(const std::string &asked, const std::string &roller_name, const Values &v) {
  const Roller roller = roller_name == "none" ? Roller() : read_roller(roller_text(roller_name), roller_name);
  if (roller_name != "none" && !roller.width)
    throw std::invalid_argument("width of '" + roller_name +
                                "' is missing; allowed: the width of the drum, in which the contacts lie");
  const AxleMachine machine = axle_machine(roller, v.m2, v.m3, v.k23, v.c23);
  const std::vector<AxleLink> contacts = asked_contacts(asked, machine.width, v),
                              bonds = bonds_of(machine.bonds, v.k23);
  if (v.g > 0.0)
    if (const std::string fault = axle_fault(contacts, bonds); !fault.empty())
      throw std::invalid_argument(fault);
  const AxlePositions rest = at_rest(contacts, bonds, -v.m2 * v.g, -v.m3 * v.g);
  const double share = v.m2 / static_cast<double>(contacts.size()); // kg, of fix clump with keyword links
  std::string bond_words, bond_rows; // for fix roller/history and drumlin/record
  for (std::size_t n = 1; n <= bonds.size(); ++n) {
    const char *between = n == 1 ? "" : " ";
    const AxleLink &bond = bonds[n - 1];
    bond_words += fmt::format("{}bond bond{}", between, n);
    bond_rows += fmt::format("{}bond_{} \"y {:.17g} m, k {:.17g} N/m, c {:.17g} N s/m\"", between, n, bond.y,
                             bond.k, bond.c);
  }
  const auto y = [](const AxleLink &link) { return link.y; };
  const auto k = [](const AxleLink &link) { return link.k; };
  const double reach = std::accumulate(bonds.begin(), bonds.end(), 0.0, [](double sum, const AxleLink &bond) {
    return sum + std::fabs(bond.y);
  });
  std::vector<std::pair<std::string, std::string>> variables = {
      {"contact_count", fmt::format("{}", contacts.size())},
      {"contact_y", list_of(contacts, y)},
      {"contact_k", list_of(contacts, k)},
      {"contact_D",
       list_of(contacts, [&](const AxleLink &link) { return link.c / (2.0 * std::sqrt(share * link.k)); })},
      {"bond_count", fmt::format("{}", bonds.size())},
      {"bond_words", bond_words},
      {"bond_rows", bond_rows},
      {"bond_y", list_of(bonds, y)},
      {"bond_k", list_of(bonds, k)},
      {"bond_c", list_of(bonds, [](const AxleLink &link) { return link.c; })}};
  const std::pair<const char *, double> numbers[] = {{"drum_width", machine.width},
                                                     {"drum_inertia", machine.drum_inertia},
                                                     {"frame_inertia", machine.frame_inertia},
                                                     {"exciter_place", machine.exciter},
                                                     {"sensor_distance", machine.sensor},
                                                     {"bond_reach", reach},
                                                     {"drum_rest", rest[0]},
                                                     {"frame_rest", rest[1]},
                                                     {"drum_rest_tilt", rest[2]},
                                                     {"frame_rest_tilt", rest[3]}};
  for (const auto &[name, value] : numbers)
    variables.emplace_back(name, fmt::format("{:.17g}", value));
  return variables;
}

/// Gives contact j, of a soil ball of type j, its stiffness and damping ratio.
void give_laws(LAMMPS *lmp, Arguments &in) {
  const auto read = [&in](const std::string &name, const Range &range) {
    return list_numbers(in, name, in.word(name, "a number for each contact, separated by commas"), range);
  };
  const std::vector<double> stiffnesses = read("stiffnesses", Range::positive);
  const std::vector<double> ratios = read("damping ratios", Range::non_negative);
  in.expect_end("laws STIFFNESSES RATIOS");
  const std::size_t count = stiffnesses.size();
  if (ratios.size() != count)
    in.fail(fmt::format("number of damping ratios is '{}'; allowed: {}, that of the stiffnesses",
                        ratios.size(), count));
  if (lmp->domain->box_exist == 0 || static_cast<std::size_t>(lmp->atom->ntypes) <= count)
    in.fail(
        fmt::format("number of contacts is '{}'; allowed: fewer than the types of balls in the box", count));
  const auto types = static_cast<std::size_t>(lmp->atom->ntypes);
  std::vector<physics::ContactValues> table;
  for (std::size_t a = 0; a < types; ++a)
    for (std::size_t b = 0; b < types; ++b) {
      const std::size_t contact = std::min({a, b, count - 1});
      table.push_back({stiffnesses[contact], ratios[contact]});
    }
  engine::set_contacts(lmp, table, false, false, {});
}

} // namespace

void ends_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/ends", narg, arg);
  if (in.choice("what is given", {"machine", "laws"}) == 1) return give_laws(lmp, in);
  const std::string contacts =
      in.word("contacts", "a number of contacts, or a file with the columns " + std::string(contact_columns));
  const std::string roller = in.word("roller", "a roller file, or none");
  Values values{};
  const std::pair<const char *, double Values::*> numbers[] = {
      {"m2", &Values::m2}, {"m3", &Values::m3}, {"k23", &Values::k23}, {"c23", &Values::c23},
      {"k", &Values::k},   {"D", &Values::D},   {"g", &Values::g}};
  for (const auto &[name, value] : numbers)
    values.*value = in.number(name, Range::non_negative);
  in.expect_end("machine CONTACTS ROLLER m2 m3 k23 c23 k D g");
  // Rank 0 reads the files, and the others get what follows from them: only one rank needs to see them.
  std::string text, fault;
  if (lmp->comm->me == 0) try {
      for (const auto &[name, value] : variables_of(contacts, roller, values))
        text += fmt::format("{} {}\n", name, value);
    } catch (const std::invalid_argument &error) {
      fault = error.what();
    }
  fault = engine::from_rank_0(lmp, fault);
  text = engine::from_rank_0(lmp, text);
  if (!fault.empty()) DeckVariables::refuse(lmp, "drumlin/ends: " + fault);
  DeckVariables variables(lmp);
  std::istringstream lines(text);
  for (std::string name, value; lines >> name && std::getline(lines >> std::ws, value);)
    variables.set(name, value);
}

} // namespace drumlin
