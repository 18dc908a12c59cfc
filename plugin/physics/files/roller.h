#pragma once
// The machine of a roller file: lines of `name value unit` with # comments, as inputs/rollers has them.
// Plugin and tools share this reader.
//
//     Fw = m_e r_e omega^2                  amplitude of the exciter's force, N
//     A  = m_e r_e / m2                     nominal amplitude, m: of the drum alone, on no soil
//     f3 = sqrt(k23/m3) / (2 pi)            frequency of the frame on its bond, Hz
//     zeta3 = c23 / (2 sqrt(k23 m3))        its damping ratio
//
// with m2 the mass of the drum (all that vibrates with it), m3 the rest of the load on the drum.

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace drumlin {

/// One setting of a roller's exciter.
struct RollerSetting {
  std::string name;       ///< empty: the only one of a file that names none
  double frequency = 0.0; ///< [Hz]
  double me_re = 0.0;     ///< eccentric moment m_e r_e [kg m]
};

/// One drum of a roller with the part of the machine that rests on it.
struct Roller {
  double m2 = 0.0;                      ///< mass of the drum [kg]
  double m3 = 0.0;                      ///< mass of the frame: the rest of the load on the drum [kg]
  double k23 = 0.0;                     ///< stiffness of the bond between them [N/m]
  double c23 = 0.0;                     ///< damping coefficient of the bond [N s/m]
  std::optional<double> width;          ///< of the drum [m]
  std::optional<double> diameter;       ///< of the drum [m]
  std::optional<double> operating_mass; ///< of the whole machine [kg]
  double m2_tolerance = 0.0;            ///< relative tolerance of m2
  double m3_tolerance = 0.0;            ///< of m3
  double me_re_tolerance = 0.0;         ///< of m_e r_e
  std::optional<double> bond_tolerance; ///< of k23 and c23
  bool bond_assumed = false;            ///< no bond in the file: the default is taken
  // What tilts about the way of travel. Places count from the middle of the drum, positive to the right.
  std::optional<double> drum_inertia;  ///< [kg m2]
  std::optional<double> frame_inertia; ///< [kg m2]
  double exciter_place = 0.0;          ///< [m]
  double exciter_tolerance = 0.0;      ///< by which the exciter may stand elsewhere [m]
  std::optional<double> sensor_place;  ///< of the one on the drum [m]
  /// Springs and dashpots of the bond: distances of those left and right from the middle [m], and the share
  /// of k23 or c23 that is left.
  struct Sides {
    std::optional<double> left, right;
    double share_left = 0.5;
  };
  Sides springs, dashpots;
  std::vector<RollerSetting> settings; ///< at least one, in the order of the file
  std::vector<std::string> warnings;   ///< of numbers outside of what rollers have: a wrong unit, perhaps
};

/// A value that follows from a roller file: its name in parameters.csv, and its unit.
struct DerivedValue {
  std::string name;
  double value;
  std::string unit;
};

namespace roller_file {

constexpr double gravity = 9.81; // m/s2, with which a load in newtons becomes a mass
constexpr double pi = 3.14159265358979323846;
/// The bond of a roller whose file does not have it: that of inputs/rollers/Axas2020.
constexpr double assumed_frame_frequency = 4.82; // Hz
constexpr double assumed_frame_damping = 0.151;
/// The same of a roller whose file does not say how it tilts: radii of gyration, and distance of the bond
/// from the middle, over the width of the drum.
constexpr double assumed_drum_gyration = 0.345;
constexpr double assumed_frame_gyration = 0.401;
constexpr double assumed_bond_distance = 0.334;
/// Values that say the same thing twice may differ by this, since data sheets round.
constexpr double agreement = 0.1;

struct Unit {
  const char *name;
  double factor;
};
using Units = std::vector<Unit>;

/// What a line may begin with.
struct Quantity {
  const char *name;
  Units units;
  /// What rollers have, in SI units, widely: from walk-behind rollers to the heaviest ones that are towed. A
  /// value outside, other than 0, is warned of. Negative values count by their size.
  double usual_from, usual_to;
  double largest; ///< in SI units; the value is positive, or zero as well where the lowest is 0
  bool zero_allowed;
  bool of_setting;
  bool either_side = false; ///< negative values are allowed, too
};

inline std::vector<Quantity> quantities() {
  const Units mass = {{"kg", 1.0}, {"t", 1e3}};
  const Units load = {{"kg", 1.0}, {"t", 1e3}, {"kN", 1e3 / gravity}, {"N", 1.0 / gravity}};
  const Units linear = {{"kg/cm", 100.0}, {"kg/m", 1.0}, {"kN/m", 1e3 / gravity}, {"N/mm", 1e3 / gravity}};
  const Units length = {{"m", 1.0}, {"mm", 1e-3}, {"cm", 1e-2}};
  const Units frequency = {{"Hz", 1.0}, {"1/min", 1.0 / 60.0}, {"vpm", 1.0 / 60.0}};
  const Units percent = {{"%", 0.01}};
  const Units stiffness = {{"N/m", 1.0}, {"kN/m", 1e3}, {"MN/m", 1e6}};
  const Units damping = {{"N s/m", 1.0}, {"kN s/m", 1e3}};
  return {{"operating_mass", mass, 200, 1e5, 1e6, false, false},
          {"drum_load", load, 100, 5e4, 1e6, false, false},
          {"linear_load", linear, 200, 2e4, 1e6, false, false},
          {"drum_mass", mass, 50, 3e4, 1e6, false, false},
          {"frame_mass", mass, 20, 5e4, 1e6, false, false},
          {"width", length, 0.2, 4, 100.0, false, false},
          {"diameter", length, 0.2, 3, 100.0, false, false},
          {"bond_stiffness", stiffness, 1e4, 1e9, 1e12, false, false},
          {"bond_damping", damping, 100, 1e7, 1e9, true, false},
          {"bond_stiffness_left", stiffness, 1e3, 1e9, 1e12, false, false},
          {"bond_damping_left", damping, 10, 1e7, 1e9, true, false},
          {"bond_left", length, 0.01, 2, 100.0, true, false},
          {"bond_right", length, 0.01, 2, 100.0, true, false},
          {"damper_left", length, 0.01, 2, 100.0, true, false},
          {"damper_right", length, 0.01, 2, 100.0, true, false},
          {"drum_inertia", {{"kg m2", 1.0}}, 1, 1e5, 1e9, false, false},
          {"frame_inertia", {{"kg m2", 1.0}}, 1, 1e5, 1e9, false, false},
          {"exciter_place", length, 0, 2, 100.0, true, false, true},
          {"exciter_place_tolerance", length, 0, 0.5, 100.0, true, false},
          {"sensor_place", length, 0, 4, 100.0, true, false, true},
          {"frame_frequency", frequency, 0.5, 30, 1e3, false, false},
          {"frame_damping", {{"-", 1.0}, {"%", 0.01}}, 0.01, 2, 100.0, true, false},
          {"drum_mass_tolerance", percent, 0, 0.5, 0.5, true, false},
          {"frame_mass_tolerance", percent, 0, 0.5, 0.5, true, false},
          {"eccentric_moment_tolerance", percent, 0, 0.5, 0.5, true, false},
          {"bond_tolerance", percent, 0, 1, 1.0, true, false},
          {"frequency", frequency, 5, 150, 1e4, false, true},
          {"eccentric_moment", {{"kg m", 1.0}, {"kgm", 1.0}, {"kg mm", 1e-3}}, 0.01, 100, 1e6, false, true},
          {"force", {{"N", 1.0}, {"kN", 1e3}}, 1e3, 2e6, 1e9, false, true},
          {"amplitude", {{"mm", 1e-3}, {"m", 1.0}}, 1e-4, 1e-2, 1.0, false, true}};
}

/// "a, b or c" of the names of `list`.
template <class List>
std::string names_of(const List &list) {
  std::string text;
  for (auto one = list.begin(); one != list.end(); ++one)
    text += (one == list.begin() ? "" : one + 1 == list.end() ? " or " : ", ") + std::string(one->name);
  return text;
}

/// Text of a file for an error: without control characters, at most 60 characters.
inline std::string shown(std::string text) {
  for (char &c : text)
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = '?';
  return text.size() <= 60 ? text : text.substr(0, 60) + "...";
}

/// A number with the digits that a reader wants.
inline std::string number_text(double value) {
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

/// The number of a text that is a whole decimal number, blanks behind it allowed; nothing of every other
/// text, also of hexadecimal numbers, nan and inf.
inline std::optional<double> decimal(const std::string &text) {
  char *end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || std::string(end).find_first_not_of(" \t") != std::string::npos ||
      text.find_first_of("xXnN") != std::string::npos)
    return std::nullopt;
  return value;
}

/// Whether a text is a group of three digits, as they stand between signs for thousands.
inline bool is_group(const std::string &text) {
  return text.size() == 3 && text.find_first_not_of("0123456789") == std::string::npos;
}

/// A number that has a comma, with a point as decimal sign. The comma is the decimal sign, or, before three
/// digits, may separate thousands: then that reading counts which rollers have. Nothing if they may have both
/// or have neither.
inline std::optional<std::string> without_comma(const std::string &number, const Quantity &known,
                                                double factor) {
  const std::size_t comma = number.find(',');
  if (number.find_first_of(".,", comma + 1) != std::string::npos || number.find('.') < comma)
    return std::nullopt;
  std::string point = number, whole = number;
  point[comma] = '.';
  whole.erase(comma, 1);
  if (!is_group(number.substr(comma + 1))) return point;
  const auto usual = [&](const std::string &text) {
    const double size = std::fabs(decimal(text).value_or(0.0)) * factor;
    return size != 0.0 && size >= known.usual_from && size <= known.usual_to;
  };
  if (usual(point) == usual(whole)) return std::nullopt;
  return usual(whole) ? whole : point;
}

/// Half a unit of the last digit of a decimal number.
inline double rounding_of(const std::string &number) {
  const std::size_t exponent = std::min(number.find_first_of("eE"), number.size());
  const std::size_t point = std::min(number.find('.'), exponent);
  const double power = exponent < number.size() ? std::strtod(number.c_str() + exponent + 1, nullptr) : 0.0;
  const auto decimals = static_cast<double>(exponent - std::min(exponent, point + 1));
  return 0.5 * std::pow(10.0, power - decimals);
}

/// Of each name, and with " rounding" behind it by how much the value may have been rounded.
using Values = std::map<std::string, double>;

/// What the lines of a roller file say, in SI units.
struct Lines {
  std::string file;
  Values machine;
  std::vector<std::pair<std::string, Values>> settings;
  std::vector<std::string> warnings;

  [[noreturn]] void fail(const std::string &what, const std::string &value,
                         const std::string &allowed) const {
    throw std::invalid_argument(what + " of '" + file + "' is '" + shown(value) + "'; allowed: " + allowed);
  }
  [[noreturn]] void missing(const std::string &what, const std::string &allowed) const {
    throw std::invalid_argument(what + " of '" + file + "' is missing; allowed: " + allowed);
  }

  std::optional<double> of(const std::string &name) const {
    const auto found = machine.find(name);
    return found == machine.end() ? std::nullopt : std::optional(found->second);
  }

  void add(const std::string &text, const std::string &where);
  void read(const std::string &text, const std::string &name);
};

/// Reads a line without its comment. \param where "line 7"
inline void Lines::add(const std::string &text, const std::string &where) {
  std::istringstream words(text);
  std::string name, number, unit;
  if (!(words >> name)) return;
  words >> number;
  std::string written = number;
  for (std::string word; words >> word;)
    if (unit.empty() && is_group(word) && decimal(number)) { // thousands apart: 12 540
      number += word;
      written += " " + word;
    } else {
      unit += (unit.empty() ? "" : " ") + word;
    }
  if (name == "setting") {
    if (number.empty() || !unit.empty())
      fail("setting in " + where, (number + " " + unit), "one word, the name of the setting");
    for (const auto &[other, values] : settings)
      if (other == number) fail("setting in " + where, number, "a name that no other setting has");
    if (!settings.empty() && settings.front().first.empty())
      fail("setting in " + where, number, "settings before the first frequency, force and amplitude");
    settings.push_back({number, {}});
    return;
  }
  const std::vector<Quantity> list = quantities();
  const auto known =
      std::find_if(list.begin(), list.end(), [&](const Quantity &one) { return one.name == name; });
  if (known == list.end()) fail("name in " + where, name, "setting, " + names_of(list));
  const auto unit_of = std::find_if(known->units.begin(), known->units.end(),
                                    [&](const Unit &one) { return one.name == unit; });
  const std::string both = written + (unit.empty() ? "" : " ") + unit;
  if (number.find(',') != std::string::npos && unit_of != known->units.end()) {
    const std::optional<std::string> read = without_comma(number, *known, unit_of->factor);
    if (!read) fail(name + " in " + where, both, "a number whose decimal sign is a point");
    number = *read;
    warnings.push_back(name + " in " + where + " of '" + file + "' is '" + both + "', read as " + number +
                       (unit.empty() ? "" : " ") + unit);
  }
  const std::optional<double> value = decimal(number);
  if (!value || unit_of == known->units.end())
    fail(name + " in " + where, both, "a number and its unit, " + names_of(known->units));
  const double in_si = *value * unit_of->factor;
  constexpr double smallest = 1e-9;
  if (known->either_side) {
    const std::string limit = number_text(known->largest / unit_of->factor);
    if (!(std::fabs(in_si) <= known->largest))
      fail(name + " in " + where, both, "a number from -" + limit + " to " + limit + " " + unit);
  } else if (!(in_si <= known->largest) || !(in_si >= smallest || (known->zero_allowed && in_si == 0.0)))
    fail(name + " in " + where, both,
         (known->zero_allowed ? "0 or a positive number" : "a positive number") + std::string(" up to ") +
             number_text(known->largest / unit_of->factor) + " " + unit);
  if (const double size = std::fabs(in_si);
      size != 0.0 && !(size >= known->usual_from && size <= known->usual_to))
    warnings.push_back(name + " in " + where + " of '" + file + "' is '" + both + "'; rollers have " +
                       number_text(known->usual_from / unit_of->factor) + " to " +
                       number_text(known->usual_to / unit_of->factor) + (unit.empty() ? "" : " ") + unit);
  if (known->of_setting && settings.empty()) settings.push_back({"", {}});
  if (!known->of_setting && !settings.empty() && !settings.front().first.empty())
    fail(name + " in " + where, both, "values of the machine before its settings");
  Values &values = known->of_setting ? settings.back().second : machine;
  values.emplace(name + " rounding", rounding_of(number) * unit_of->factor);
  if (!values.emplace(name, in_si).second) fail(name + " in " + where, both, "one line for each name");
}

inline void Lines::read(const std::string &text, const std::string &name) {
  file = name;
  std::istringstream lines(text);
  int count = 0;
  for (std::string line; std::getline(lines, line);)
    add(line.substr(0, line.find('#')), "line " + std::to_string(++count));
}

} // namespace roller_file

/// The text of a roller file. Throws std::invalid_argument if it cannot be read, or is none.
inline std::string roller_text(const std::string &file) {
  std::error_code code;
  std::ifstream in;
  if (std::filesystem::is_regular_file(file, code)) in.open(file); // a pipe could block for ever
  constexpr std::size_t largest = 100000;                          // characters
  std::string text(largest, '\0');
  in.read(text.data(), static_cast<std::streamsize>(largest));
  const auto size = static_cast<std::size_t>(in.gcount());
  if (!in.is_open() || size == 0 || size == largest)
    throw std::invalid_argument(
        "roller is '" + roller_file::shown(file) +
        "'; allowed: a file that can be read, of lines of a name, a number and its unit");
  text.resize(size);
  const std::string byte_order_mark = "\xEF\xBB\xBF";
  return text.compare(0, 3, byte_order_mark) == 0 ? text.substr(3) : text;
}

/// The roller of a file with that text. Throws std::invalid_argument with one line, "WHAT of 'FILE' is
/// 'VALUE'; allowed: ...", if a line cannot be read, a value is missing or two contradict each other.
/// \param file its name, for the error
inline Roller read_roller(const std::string &text, const std::string &file) {
  using namespace roller_file;
  Lines lines;
  lines.read(text, file);
  Roller roller;
  roller.warnings = lines.warnings;
  roller.width = lines.of("width");
  roller.diameter = lines.of("diameter");
  roller.operating_mass = lines.of("operating_mass");
  roller.m2_tolerance = lines.of("drum_mass_tolerance").value_or(0.0);
  roller.m3_tolerance = lines.of("frame_mass_tolerance").value_or(0.0);
  roller.me_re_tolerance = lines.of("eccentric_moment_tolerance").value_or(0.0);
  roller.bond_tolerance = lines.of("bond_tolerance");

  const auto apart = [](double a, double b) { return std::fabs(a - b) > agreement * std::max(a, b); };
  const auto contradict = [&](const std::string &what, double value, const std::string &unit,
                              const std::string &other, double expected) {
    lines.fail(what, number_text(value) + " " + unit,
               number_text(expected) + " " + unit + " within 10 %, which follows from " + other);
  };

  // The load on the drum.
  std::optional<double> load = lines.of("drum_load");
  if (const std::optional<double> linear = lines.of("linear_load")) {
    if (!roller.width) lines.missing("width", "the width of the drum, which linear_load needs");
    const double from_linear = *linear * *roller.width;
    if (load && apart(*load, from_linear))
      contradict("drum_load", *load, "kg", "linear_load and width", from_linear);
    if (!load) load = from_linear;
  }
  const std::optional<double> frame = lines.of("frame_mass");

  // The eccentric moment of each setting: as given, else F / omega^2, else (below) A m2.
  if (lines.settings.empty())
    lines.missing("frequency", "a frequency and a force, eccentric_moment or amplitude");
  std::optional<double> m2 = lines.of("drum_mass");
  std::vector<std::pair<std::string, double>> masses; // name and m_e r_e / A of settings that have both
  for (const auto &[name, values] : lines.settings) {
    const std::string of_setting = name.empty() ? "" : " of setting " + name;
    const auto value = [&values = values](const char *key) {
      const auto found = values.find(key);
      return found == values.end() ? 0.0 : found->second;
    };
    const double frequency = value("frequency");
    if (frequency == 0.0) lines.missing("frequency" + of_setting, "a number and its unit, Hz, 1/min or vpm");
    const double omega = 2.0 * pi * frequency;
    const double of_force = value("force") / (omega * omega);
    const double me_re = value("eccentric_moment") > 0.0 ? value("eccentric_moment") : of_force;
    if (of_force > 0.0 && apart(me_re, of_force))
      contradict("force" + of_setting, value("force"), "N", "frequency and eccentric_moment",
                 me_re * omega * omega);
    if (me_re == 0.0 && value("amplitude") == 0.0)
      lines.missing("force" + of_setting, "force, eccentric_moment or amplitude");
    if (me_re > 0.0 && value("amplitude") > 0.0) masses.emplace_back(of_setting, me_re / value("amplitude"));
    roller.settings.push_back({name, frequency, me_re});
  }
  if (!m2 && frame && load && *load > *frame) m2 = *load - *frame;
  const bool from_amplitudes = !m2 && !masses.empty();
  if (from_amplitudes) { // their mean
    m2 = 0.0;
    for (const auto &[of_setting, mass] : masses) {
      if (apart(mass, masses.front().second)) {
        std::ostringstream fault;
        fault << "force, frequency and amplitude" << of_setting << " of '" << file << "' give a drum of "
              << mass << " kg, those" << masses.front().first << " one of " << masses.front().second
              << " kg; allowed: the same within 10 %";
        throw std::invalid_argument(fault.str());
      }
      *m2 += mass / static_cast<double>(masses.size());
    }
  }
  if (!m2)
    lines.missing("drum_mass",
                  "drum_mass, or a setting with an amplitude and a force or eccentric_moment, from "
                  "which it follows");
  double squares = 0.0; // of the amplitudes' roundings
  for (std::size_t n = 0; n < roller.settings.size(); ++n) {
    const auto &[name, values] = lines.settings[n];
    const auto amplitude = values.find("amplitude");
    if (amplitude == values.end()) continue;
    const double rounding = values.at("amplitude rounding") / amplitude->second;
    double &me_re = roller.settings[n].me_re;
    if (me_re > 0.0) {
      squares += rounding * rounding;
    } else { // a tolerance that is not said is that of the rounding
      me_re = amplitude->second * *m2;
      if (!lines.of("eccentric_moment_tolerance"))
        roller.me_re_tolerance = std::max(roller.me_re_tolerance, rounding);
    }
    if (apart(me_re / *m2, amplitude->second))
      contradict("amplitude" + (name.empty() ? "" : " of setting " + name), amplitude->second * 1e3, "mm",
                 "its eccentric moment, or force and frequency, and a drum of " + number_text(*m2) +
                     " kg (what vibrates, not the load on the drum): one of these is wrong",
                 me_re / *m2 * 1e3);
  }
  roller.m2 = *m2;

  // The rest of the load on the drum is the frame.
  if (!frame && !load) lines.missing("drum_load", "drum_load, linear_load or frame_mass");
  if (frame && load && apart(*load, roller.m2 + *frame))
    contradict("drum_load", *load, "kg", "the masses of drum and frame", roller.m2 + *frame);
  roller.m3 = frame ? *frame : *load - roller.m2;
  if (roller.m3 <= 0.0)
    lines.fail(lines.of("drum_load") ? "drum_load" : "linear_load times width", number_text(*load) + " kg",
               "more than the mass of the drum, " + number_text(roller.m2) + " kg");
  if (roller.operating_mass && roller.m2 + roller.m3 > *roller.operating_mass * (1.0 + 1e-9))
    lines.fail("operating_mass", number_text(*roller.operating_mass) + " kg",
               "at least the load on the drum, " + number_text(roller.m2 + roller.m3) + " kg");

  if (from_amplitudes) {
    const double rounding = std::sqrt(squares) / static_cast<double>(masses.size());
    if (!lines.of("drum_mass_tolerance")) roller.m2_tolerance = rounding;
    if (!frame && !lines.of("frame_mass_tolerance")) roller.m3_tolerance = rounding * roller.m2 / roller.m3;
  }

  // The bond.
  const std::optional<double> k23 = lines.of("bond_stiffness");
  const std::optional<double> f3 = lines.of("frame_frequency");
  if (k23 && f3)
    lines.fail("frame_frequency", number_text(*f3) + " Hz", "bond_stiffness or frame_frequency, not both");
  const std::optional<double> c23 = lines.of("bond_damping");
  const std::optional<double> zeta3 = lines.of("frame_damping");
  if (c23 && zeta3)
    lines.fail("frame_damping", number_text(*zeta3), "bond_damping or frame_damping, not both");
  const double omega3 = 2.0 * pi * f3.value_or(assumed_frame_frequency);
  roller.k23 = k23.value_or(roller.m3 * omega3 * omega3);
  roller.c23 = c23.value_or(2.0 * zeta3.value_or(assumed_frame_damping) * std::sqrt(roller.k23 * roller.m3));
  roller.bond_assumed = !k23 && !f3;

  // What tilts.
  roller.drum_inertia = lines.of("drum_inertia");
  roller.frame_inertia = lines.of("frame_inertia");
  roller.exciter_place = lines.of("exciter_place").value_or(0.0);
  roller.exciter_tolerance = lines.of("exciter_place_tolerance").value_or(0.0);
  roller.sensor_place = lines.of("sensor_place");
  if (roller.width && std::fabs(roller.exciter_place) > 0.5 * *roller.width)
    lines.fail("exciter_place", number_text(roller.exciter_place) + " m",
               "a place within the width of the drum, " + number_text(*roller.width) + " m");
  if (roller.width && std::fabs(roller.sensor_place.value_or(0.0)) > *roller.width)
    lines.fail("sensor_place", number_text(*roller.sensor_place) + " m",
               "a place at most the width of the drum, " + number_text(*roller.width) +
                   " m, from its middle");
  const auto sides = [&lines](const std::string &of, const std::string &places, double whole,
                              const std::string &unit) {
    Roller::Sides found = {lines.of(places + "_left"), lines.of(places + "_right"), 0.5};
    const std::string name = "bond_" + of + "_left";
    if (const std::optional<double> left = lines.of(name)) {
      if (!(*left <= whole))
        lines.fail(name, number_text(*left) + " " + unit,
                   "at most the " + of + " of the whole bond, " + number_text(whole) + " " + unit);
      if (whole > 0.0) found.share_left = *left / whole;
    }
    if (found.left.has_value() != found.right.has_value())
      lines.missing(places + (found.left ? "_right" : "_left"),
                    "the distances of both sides from the middle, or none");
    return found;
  };
  roller.springs = sides("stiffness", "bond", roller.k23, "N/m");
  roller.dashpots = sides("damping", "damper", roller.c23, "N s/m");
  return roller;
}

inline Roller read_roller(const std::string &file) { return read_roller(roller_text(file), file); }

/// The setting of that name. Throws std::invalid_argument if the roller has none. \param name empty: the
/// only one
inline const RollerSetting &setting_of(const Roller &roller, const std::string &name,
                                       const std::string &file) {
  const auto found = std::find_if(roller.settings.begin(), roller.settings.end(),
                                  [&name](const RollerSetting &one) { return one.name == name; });
  if (found != roller.settings.end()) return *found;
  if (name.empty() && roller.settings.size() == 1) return roller.settings.front();
  const bool none = roller.settings.front().name.empty();
  throw std::invalid_argument(
      "setting" + (name.empty() ? " is missing" : " is '" + roller_file::shown(name) + "'") +
      "; allowed: " + (none ? "none" : roller_file::names_of(roller.settings)) + ", of '" + file + "'");
}

/// What follows from a roller and a setting: printed before a run and stored with it. \param setting none:
/// what does not depend on it \param omega [rad/s] \param g gravity [m/s2]
inline std::vector<DerivedValue> derived_values(const Roller &roller, const RollerSetting *setting,
                                                double omega, double g = roller_file::gravity) {
  const double load = (roller.m2 + roller.m3) * g;
  std::vector<DerivedValue> values;
  if (roller.width) values.push_back({"width", *roller.width, "m"});
  const auto per_metre = [&](const std::string &name, double value) {
    values.push_back({name, value, "N"});
    if (roller.width) values.push_back({name + "_per_metre", value / *roller.width, "N/m"});
  };
  if (setting != nullptr) {
    values.push_back({"frequency", omega / (2.0 * roller_file::pi), "Hz"});
    values.push_back({"eccentric_moment", setting->me_re, "kg m"});
    per_metre("exciter_force", setting->me_re * omega * omega);
    values.push_back({"nominal_amplitude", setting->me_re / roller.m2, "m"});
  }
  per_metre("static_load", load);
  values.push_back({"frame_frequency", std::sqrt(roller.k23 / roller.m3) / (2.0 * roller_file::pi), "Hz"});
  values.push_back({"frame_damping_ratio", roller.c23 / (2.0 * std::sqrt(roller.k23 * roller.m3)), "-"});
  return values;
}

} // namespace drumlin
