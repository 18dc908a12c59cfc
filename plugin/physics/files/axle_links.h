#pragma once
// A roller whose drum and frame tilt about the way of travel: its contacts with the soil and its bonds at
// places along the axle, and where they hold it at rest. Contacts are equal, or a table with the columns y
// (m), k (N/m) and c (N s/m).

#include "roller.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace drumlin {

/// A spring and a dashpot at a place along the axle: a contact of drum and soil, or a bond of drum and frame.
struct AxleLink {
  double y = 0.0; ///< from the middle of the drum, positive to the right [m]
  double k = 0.0; ///< [N/m]
  double c = 0.0; ///< [N s/m]
};

constexpr int most_contacts = 32;
constexpr const char *contact_columns = "y (m),k (N/m),c (N s/m)";

/// Sums of a number over links: itself, times y, times y^2.
struct AxleMoments {
  double all = 0.0, first = 0.0, second = 0.0;

  template <class Counts>
  AxleMoments(const std::vector<AxleLink> &links, double AxleLink::*value, const Counts &counts) {
    double size = 0.0;
    for (std::size_t i = 0; i < links.size(); ++i) {
      if (!counts(i)) continue;
      const AxleLink &link = links[i];
      all += link.*value;
      first += link.*value * link.y;
      second += link.*value * link.y * link.y;
      size += std::fabs(link.*value * link.y);
    }
    // Halves that are equal but for rounding do not couple bounce and tilt.
    if (std::fabs(first) <= 1e-14 * size) first = 0.0;
  }

  /// Whether springs can hold a force in the middle in equilibrium, its moment included.
  bool carries() const { return first == 0.0 || determinant() > 1e-13 * all * second; }
  /// Place and tilt at which springs carry a force [N] in the middle; of springs that cannot carry its
  /// moment, the place alone.
  std::array<double, 2> carrying(double force) const {
    if (all <= 0.0) return {0.0, 0.0};
    if (first == 0.0 || !carries()) return {force / all, 0.0};
    return {second * force / determinant(), -first * force / determinant()};
  }

private:
  double determinant() const { return all * second - first * first; }
};

/// Positions of drum and frame [m] and their tilts [rad].
using AxlePositions = std::array<double, 4>;

/// Where the springs of those contacts for which `acts` is true, and of the bonds, carry the weights [N, down
/// below 0] of drum and frame; what they cannot carry is left over.
inline AxlePositions held_by(const AxleMoments &contacts, const AxleMoments &bonds, double drum,
                             double frame) {
  const std::array<double, 2> drums = contacts.carrying(drum + frame), bond = bonds.carrying(frame);
  return {drums[0], drums[0] + bond[0], drums[1], drums[1] + bond[1]};
}

/// Static equilibrium. Contacts that the drum does not reach carry nothing.
inline AxlePositions at_rest(const std::vector<AxleLink> &contacts, const std::vector<AxleLink> &bonds,
                             double drum, double frame) {
  const AxleMoments of_bonds(bonds, &AxleLink::k, [](std::size_t) { return true; });
  std::uint32_t pressed = ~0U;
  AxlePositions rest{};
  for (int pass = 0; pass < 2 * most_contacts; ++pass) {
    const auto acts = [&pressed](std::size_t contact) { return ((pressed >> contact) & 1U) != 0; };
    rest = held_by(AxleMoments(contacts, &AxleLink::k, acts), of_bonds, drum, frame);
    std::uint32_t found = 0;
    for (std::size_t j = 0; j < contacts.size(); ++j)
      if (rest[0] + contacts[j].y * rest[2] < 0.0) found |= 1U << j;
    if (found == pressed) break;
    pressed = found;
  }
  return rest;
}

/// Empty if contacts and bonds can hold a machine with a weight; else one line that names which of them
/// cannot, and what is allowed.
inline std::string axle_fault(const std::vector<AxleLink> &contacts, const std::vector<AxleLink> &bonds) {
  const auto refusal = [](const std::string &name, const std::string &value, const std::string &allowed) {
    return name + " is '" + value + "'; allowed: " + allowed;
  };
  const auto [left, right] = std::minmax_element(
      contacts.begin(), contacts.end(), [](const AxleLink &a, const AxleLink &b) { return a.y < b.y; });
  if (left->y != right->y ? left->y >= 0.0 || right->y <= 0.0 : left->y != 0.0)
    return refusal("contacts",
                   "at " + roller_file::number_text(left->y) + " to " + roller_file::number_text(right->y) +
                       " m",
                   "on both sides of the drum's middle, or all in it: else it has nothing to rest on");
  const auto every = [](std::size_t) { return true; };
  const AxleMoments k(contacts, &AxleLink::k, every), k_bonds(bonds, &AxleLink::k, every);
  if (k_bonds.all <= 0.0) return refusal("bonds", "without stiffness", "a stiffness above 0 [N/m], or g = 0");
  for (const auto &[name, springs] : {std::pair("contacts", k), {"bonds", k_bonds}})
    if (!springs.carries())
      return refusal(name, "almost a single one beside the middle", "stiffness on both sides of it");
  return {};
}

/// Drum and frame of a roller that may tilt. Values that its file does not have are those of Axas2020.
struct AxleMachine {
  double width = 0.0;          ///< of the drum [m]
  double drum_inertia = 0.0;   ///< about the way of travel [kg m2]
  double frame_inertia = 0.0;  ///< [kg m2]
  double exciter = 0.0;        ///< place of the exciter's force [m]
  double sensor = 0.0;         ///< distance from the middle at which a_left and a_right are taken [m]
  std::vector<AxleLink> bonds; ///< springs left and right, then dashpots left and right
};

/// \param roller of which masses and bond have no effect; those of the run are given instead
inline AxleMachine axle_machine(const Roller &roller, double m2, double m3, double k23, double c23) {
  constexpr double width_of_axas = 2.13; // m, of a roller of the 12 t class
  AxleMachine machine;
  const double width = machine.width = roller.width.value_or(width_of_axas);
  const auto inertia = [width](double mass, double gyration) {
    return mass * (gyration * width) * (gyration * width);
  };
  machine.drum_inertia = roller.drum_inertia.value_or(inertia(m2, roller_file::assumed_drum_gyration));
  machine.frame_inertia = roller.frame_inertia.value_or(inertia(m3, roller_file::assumed_frame_gyration));
  machine.exciter = roller.exciter_place;
  machine.sensor = std::fabs(roller.sensor_place.value_or(0.5 * width));
  const double distance = roller_file::assumed_bond_distance * width;
  const double left = roller.springs.left.value_or(distance), right = roller.springs.right.value_or(distance);
  const double k_left = roller.springs.share_left, c_left = roller.dashpots.share_left;
  machine.bonds = {{-left, k23 * k_left, 0.0},
                   {right, k23 * (1.0 - k_left), 0.0},
                   {-roller.dashpots.left.value_or(left), 0.0, c23 * c_left},
                   {roller.dashpots.right.value_or(right), 0.0, c23 * (1.0 - c_left)}};
  return machine;
}

/// `count` equal contacts that share k [N/m] and c [N s/m], at y_j = (j - (count + 1)/2) width/sqrt(count^2 -
/// 1), which have the rocking stiffness k width^2/12 of a line of springs whatever their number; a single one
/// in the middle.
inline std::vector<AxleLink> equal_contacts(int count, double width, double k, double c) {
  std::vector<AxleLink> contacts;
  for (int j = 1; j <= count; ++j) {
    const double place = j - 0.5 * (count + 1);
    contacts.push_back(
        {count == 1 ? 0.0 : place * (width / std::sqrt(double(count) * count - 1.0)), k / count, c / count});
  }
  return contacts;
}

namespace axle_file {

[[noreturn]] inline void fail(const std::string &what, const std::string &file, const std::string &value,
                              const std::string &allowed) {
  throw std::invalid_argument(what + " of '" + roller_file::shown(file) + "' is '" +
                              roller_file::shown(value) + "'; allowed: " + allowed);
}

/// A contact from its line. \param width of the drum [m]
inline AxleLink contact(const std::string &text, std::size_t line, const std::string &file, double width) {
  struct Column {
    const char *name;
    double AxleLink::*value;
    double least, most;
    const char *unit;
    bool zero_too;
    const char *where;
  };
  const std::array<Column, 3> columns = {
      {{"y", &AxleLink::y, -0.5 * width, 0.5 * width, "m", false, ", within the width of the drum"},
       {"k", &AxleLink::k, 1e-6, 1e15, "N/m", false, ""},
       {"c", &AxleLink::c, 1e-9, 1e15, "N s/m", true, ""}}};
  const std::string in_line = " in line " + std::to_string(line);
  AxleLink result;
  std::istringstream cells(text);
  for (const Column &column : columns) {
    std::string cell;
    std::getline(cells, cell, ',');
    const std::optional<double> value = roller_file::decimal(cell);
    if (!value || !((*value >= column.least && *value <= column.most) || (column.zero_too && *value == 0.0)))
      fail(column.name + in_line, file, cell,
           (column.zero_too ? "0, or a number from " : "a number from ") +
               roller_file::number_text(column.least) + " to " + roller_file::number_text(column.most) +
               " [" + column.unit + "]" + column.where);
    result.*column.value = *value;
  }
  if (std::string more; std::getline(cells, more, ','))
    fail("row" + in_line, file, text, std::string("three numbers, ") + contact_columns);
  return result;
}

} // namespace axle_file

/// What is said of contacts that are asked for by neither a number nor a file.
inline std::string contacts_refusal(const std::string &asked) {
  return "contacts is '" + roller_file::shown(asked) + "'; allowed: a whole number from 1 to " +
         std::to_string(most_contacts) + ", or a file that can be read, with the columns " + contact_columns;
}

/// Contacts from a table with the columns of contact_columns. Throws std::invalid_argument with one line if
/// it cannot be used. \param width of the drum, in which the contacts must lie [m]
inline std::vector<AxleLink> read_contacts(const std::string &file, double width) {
  std::error_code code;
  std::ifstream in;
  if (std::filesystem::is_regular_file(file, code)) in.open(file); // a pipe could block for ever
  if (!in.is_open()) throw std::invalid_argument(contacts_refusal(file));
  std::vector<AxleLink> contacts;
  std::size_t line = 0, rows = 0;
  for (std::string text; std::getline(in, text);) {
    ++line;
    if (line == 1 && text.compare(0, 3, "\xEF\xBB\xBF") == 0) text.erase(0, 3); // byte order mark
    if (!text.empty() && text.back() == '\r') text.pop_back();
    if (line == 1) {
      if (text != contact_columns) axle_file::fail("header", file, text, contact_columns);
      continue;
    }
    if (text.find_first_not_of(" \t") == std::string::npos) continue;
    if (++rows <= most_contacts) contacts.push_back(axle_file::contact(text, line, file, width));
  }
  if (line == 0) axle_file::fail("header", file, "", contact_columns);
  if (rows < 1 || rows > most_contacts)
    axle_file::fail("number of rows", file, std::to_string(rows), "1 to " + std::to_string(most_contacts));
  return contacts;
}

} // namespace drumlin
