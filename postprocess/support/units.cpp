#include "support/units.h"

#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace {

constexpr double g = 9.80665; // m/s2, standard gravity

constexpr std::array<Unit, 31> units = {{{"s", UnitKind::time, 1.0},
                                         {"ms", UnitKind::time, 1e-3},
                                         {"us", UnitKind::time, 1e-6},
                                         {"min", UnitKind::time, 60.0},
                                         {"m", UnitKind::length, 1.0},
                                         {"cm", UnitKind::length, 1e-2},
                                         {"mm", UnitKind::length, 1e-3},
                                         {"um", UnitKind::length, 1e-6},
                                         {"m/s", UnitKind::velocity, 1.0},
                                         {"cm/s", UnitKind::velocity, 1e-2},
                                         {"mm/s", UnitKind::velocity, 1e-3},
                                         {"um/s", UnitKind::velocity, 1e-6},
                                         {"m/s2", UnitKind::acceleration, 1.0},
                                         {"cm/s2", UnitKind::acceleration, 1e-2},
                                         {"mm/s2", UnitKind::acceleration, 1e-3},
                                         {"um/s2", UnitKind::acceleration, 1e-6},
                                         {"g", UnitKind::acceleration, g},
                                         {"mg", UnitKind::acceleration, 1e-3 * g},
                                         {"N", UnitKind::force, 1.0},
                                         {"kN", UnitKind::force, 1e3},
                                         {"MN", UnitKind::force, 1e6},
                                         {"%", UnitKind::share, 1e-2},
                                         {"V", UnitKind::other, 1.0},
                                         {"mV", UnitKind::other, 1e-3},
                                         {"Hz", UnitKind::other, 1.0},
                                         {"rpm", UnitKind::other, 1.0},
                                         {"deg", UnitKind::other, 1.0},
                                         {"km/h", UnitKind::other, 1.0},
                                         {"degC", UnitKind::other, 1.0},
                                         {"kPa", UnitKind::other, 1e3},
                                         {"-", UnitKind::other, 1.0}}};

/// A unit's text with one spelling for each unit.
std::string spelling(std::string_view text) {
  std::string word(text);
  constexpr std::array<std::pair<const char *, const char *>, 9> same = {{{" ", ""},
                                                                          {"^", ""},
                                                                          {"**", ""},
                                                                          {"\xC2\xB2", "2"}, // superscript 2
                                                                          {"\xC2\xB5", "u"}, // micro sign
                                                                          {"\xCE\xBC", "u"}, // Greek mu
                                                                          {"\xC2\xB0", "deg"}, // degree sign
                                                                          {"\xC2\xB7", ""},    // middle dot
                                                                          {"*", ""}}};
  for (const auto &[from, to] : same)
    boost::replace_all(word, from, to);
  boost::to_lower(word);
  constexpr std::array<std::pair<const char *, const char *>, 12> long_words = {{{"sec", "s"},
                                                                                 {"second", "s"},
                                                                                 {"seconds", "s"},
                                                                                 {"msec", "ms"},
                                                                                 {"usec", "us"},
                                                                                 {"ms-1", "m/s"},
                                                                                 {"ms-2", "m/s2"},
                                                                                 {"m/s/s", "m/s2"},
                                                                                 {"m/sec", "m/s"},
                                                                                 {"m/sec2", "m/s2"},
                                                                                 {"gn", "g"},
                                                                                 {"percent", "%"}}};
  for (const auto &[from, to] : long_words)
    if (word == from) return to;
  return word;
}

} // namespace

std::optional<Unit> unit_from_text(std::string_view text) {
  const std::string word = spelling(text);
  const auto found =
      std::find_if(units.begin(), units.end(), [&](const Unit &unit) { return spelling(unit.name) == word; });
  return found == units.end() ? std::nullopt : std::optional(*found);
}

std::string unit_names(UnitKind quantity) {
  std::vector<const char *> names;
  for (const Unit &unit : units)
    if (unit.quantity == quantity) names.push_back(unit.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

bool Range::holds(double value) const {
  if (zero_too && value == 0.0) return true;
  return (above ? value > least : value >= least) && (below ? value < most : value <= most);
}

std::string Range::words() const {
  std::string text = zero_too ? "0, or " : "";
  text += fmt::format("a number {} {:g} {} {:g}", above ? "above" : "from", least,
                      below ? "and below" : (above ? "up to" : "to"), most);
  if (*unit != '\0') text += fmt::format(" [{}]", unit);
  return text;
}

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 200;
  std::string shown(text.substr(0, longest));
  for (char &letter : shown)
    if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f) letter = '?';
  if (text.size() > longest) shown += fmt::format("... ({} characters)", text.size());
  return shown;
}

std::string refusal(std::string_view name, std::string_view value, std::string_view allowed) {
  return fmt::format("{} is '{}'; allowed: {}", name, shown(value), allowed);
}

std::string refusal(std::string_view name, double value, std::string_view allowed) {
  return refusal(name, fmt::format("{}", value), allowed);
}

} // namespace drumlin::post
