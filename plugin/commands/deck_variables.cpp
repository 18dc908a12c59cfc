#include "commands/deck_variables.h"

#include "support/arguments.h"
#include "support/command_line.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <iterator>
#include <sstream>

namespace drumlin {
namespace {

constexpr const char *of_declarations = "drumlin_declared";
constexpr const char *of_notes = "drumlin_notes";
constexpr const char *of_fault = "drumlin_fault";
constexpr const char *of_open = "drumlin_open";

} // namespace

std::vector<std::string> words_of(const std::string &text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

bool is_in(const std::vector<std::string> &names, const std::string &name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::optional<std::string> DeckVariables::value(const std::string &name) const {
  std::string word = name;
  if (variables_.find(word.data()) < 0) return std::nullopt;
  const char *text = variables_.retrieve(word.data());
  return text == nullptr ? std::nullopt : std::optional<std::string>(text);
}

void DeckVariables::remove(const std::string &name) {
  std::string words[] = {name, "delete"};
  char *pointers[] = {words[0].data(), words[1].data()};
  if (variables_.find(words[0].data()) >= 0) variables_.set(2, pointers);
}

void DeckVariables::set(const std::string &name, const std::string &value) {
  remove(name);
  set_default(name, value);
}

void DeckVariables::set_default(const std::string &name, const std::string &value) {
  std::string words[] = {name, "index", value};
  char *pointers[] = {words[0].data(), words[1].data(), words[2].data()};
  if (variables_.find(words[0].data()) < 0) variables_.set(3, pointers);
}

std::vector<std::string> DeckVariables::lines(const std::string &name) const {
  std::vector<std::string> found;
  std::istringstream in(value(name).value_or(""));
  for (std::string line; std::getline(in, line);)
    found.push_back(line);
  return found;
}

void DeckVariables::keep(const std::string &name, const std::vector<std::string> &lines) {
  set(name, joined(lines, "\n"));
}

std::vector<DeclaredVariable> DeckVariables::declared() const {
  std::vector<DeclaredVariable> all;
  for (const std::string &line : lines(of_declarations)) {
    const std::vector<std::string> words = words_of(line);
    all.push_back({words[0], words[1], words[2] == "given", words[3] == "words", words[4] == "chosen"});
  }
  return all;
}

void DeckVariables::declare(const DeclaredVariable &variable) {
  std::vector<std::string> all;
  const auto add = [&all](const DeclaredVariable &one) {
    all.push_back(fmt::format("{} {} {} {} {}", one.name, one.group, one.given ? "given" : "noted",
                              one.words ? "words" : "word", one.chosen ? "chosen" : "default"));
  };
  for (const DeclaredVariable &other : declared()) // a deck that begins again declares again
    if (other.name != variable.name) add(other);
  add(variable);
  keep(of_declarations, all);
  set(of_open, "yes");
}

TakenNotes DeckVariables::taken() const {
  std::vector<std::string> all = lines(of_notes);
  TakenNotes taken;
  if (all.empty()) return taken;
  constexpr std::size_t lists = 7;
  all.resize(std::max(all.size(), lists)); // the last lists may be empty
  taken = {all[0],           all[1],           words_of(all[2]), words_of(all[3]),
           words_of(all[4]), words_of(all[5]), words_of(all[6]), {}};
  for (std::size_t n = lists; n < all.size(); ++n) {
    const std::size_t blank = all[n].find(' ');
    taken.notes.emplace_back(all[n].substr(0, blank), all[n].substr(blank + 1));
  }
  return taken;
}

bool DeckVariables::is_declared(const std::string &name) const {
  const std::vector<DeclaredVariable> all = declared();
  return std::any_of(all.begin(), all.end(), [&](const DeclaredVariable &one) { return one.name == name; });
}

std::string DeckVariables::note_fault(const DeclaredVariable &variable, const std::string &value) const {
  const TakenNotes taken = this->taken();
  if (taken.file.empty() || is_in(taken.standard, variable.name)) return "";
  const auto note = std::find_if(taken.notes.begin(), taken.notes.end(),
                                 [&](const auto &one) { return one.first == variable.name; });
  const bool free = is_in(taken.free, variable.group);
  if (note == taken.notes.end())
    return free || is_in(taken.fixed, variable.group)
               ? fmt::format("a file that notes its value, which '{}' does not: one that {} of this version "
                             "have made",
                             taken.file, taken.decks)
               : "";
  if (same_value(value, note->second) || (free && is_in(taken.change, variable.name))) return "";
  return fmt::format("{}, with which '{}' was made; for another value {}{}", note->second, taken.file,
                     free || is_in(taken.fixed, variable.group) ? "run " + taken.decks + " again"
                                                                : "begin a new run",
                     free ? ", or change it on purpose by -var allow_change " + variable.name : "");
}

void DeckVariables::take(const TakenNotes &notes) {
  std::vector<std::string> all = {notes.file,
                                  notes.decks,
                                  joined(notes.fixed, " "),
                                  joined(notes.free, " "),
                                  joined(notes.change, " "),
                                  joined(notes.standard, " "),
                                  joined(notes.later, " ")};
  for (const auto &[name, value] : notes.notes)
    all.push_back(fmt::format("{} {}", name, value));
  keep(of_notes, all);
}

void DeckVariables::forget_notes() { remove(of_notes); }

bool engine::continues(LAMMPS_NS::LAMMPS *lmp) { return DeckVariables(lmp).value("continues") == "1"; }

bool DeckVariables::open() const { return value(of_open).value_or("") == "yes"; }

void DeckVariables::close() { set(of_open, "no"); }

std::string DeckVariables::fault() const { return value(of_fault).value_or(""); }

void DeckVariables::add_fault(const std::string &fault) { set_default(of_fault, fault); }

void DeckVariables::refuse(LAMMPS_NS::LAMMPS *lmp, const std::string &fault) {
  DeckVariables variables(lmp);
  if (!variables.open()) engine::stop(lmp, fault);
  variables.add_fault(fault);
}

void DeckVariables::stop_on_fault(LAMMPS_NS::LAMMPS *lmp) {
  // Every rank has the same variables.
  const DeckVariables variables(lmp);
  if (const std::string fault = variables.fault(); !fault.empty()) engine::stop(lmp, fault);
  if (variables.open())
    engine::stop(lmp, "drumlin/variable: command drumlin/variables is missing; allowed: behind the last "
                      "drumlin/variable, before the deck records, settles or runs");
}

std::vector<double> list_numbers(const Arguments &in, const std::string &what, const std::string &list,
                                 const Range &range) {
  std::vector<double> numbers;
  for (const std::string &entry : list_entries(list)) {
    numbers.push_back(parse_number(entry));
    if (!in_range(numbers.back(), range)) in.fail(what, list, allowed_text(range));
  }
  return numbers;
}

bool same_value(const std::string &a, const std::string &b) {
  const std::vector<std::string> of_a = list_entries(a);
  const std::vector<std::string> of_b = list_entries(b);
  return std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                    [](const std::string &one, const std::string &other) {
                      const double x = parse_number(one);
                      const double y = parse_number(other);
                      constexpr double rounding = 1e-12;
                      return one == other || std::fabs(x - y) <= rounding * std::fabs(x);
                    });
}

std::string GivenVariable::shown() const {
  std::string value = joined(values, " ");
  for (char &c : value)
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = '?';
  constexpr std::size_t longest_shown = 60;
  if (value.size() > longest_shown) value = value.substr(0, longest_shown) + "...";
  return fmt::format("variable {} is '{}'", name, value);
}

bool of_front_script(const std::string &name) { return name == "here" || name == "plugin"; }

std::vector<GivenVariable> given_variables() {
  const std::vector<std::string> words = command_line_arguments();
  std::vector<GivenVariable> given;
  for (std::size_t n = 1; n + 2 < words.size(); ++n) {
    if (words[n] != "-var" && words[n] != "-v") continue;
    GivenVariable variable{words[++n], {}};
    // The first word after the name is a value, even if it begins with a minus sign; the words after it are
    // values up to the next word that begins with one.
    do
      variable.values.push_back(words[++n]);
    while (n + 1 < words.size() && (words[n + 1].empty() || words[n + 1][0] != '-'));
    given.push_back(std::move(variable));
  }
  return given;
}

std::string value_fault(const GivenVariable &variable, bool of_words) {
  constexpr std::size_t longest_value = 1000;
  const std::vector<std::string> &values = variable.values;
  if (values.size() != 1 || values[0].empty()) return "one value that is not empty";
  const std::string &value = values[0];
  if (value.size() > longest_value) return fmt::format("a value of at most {} characters", longest_value);
  const bool unprintable =
      std::any_of(value.begin(), value.end(), [](unsigned char c) { return std::iscntrl(c) != 0; });
  if (unprintable || value.find_first_of("\"'$#\\") != std::string::npos ||
      (!of_words && value.find(' ') != std::string::npos) || value.back() == '&')
    return "a value without blanks, quotes, backslashes, control characters, $, # and a & at its end, which "
           "the engine's parser takes for something else";
  return "";
}

} // namespace drumlin
