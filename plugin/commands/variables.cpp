#include "commands/commands.h"

#include "commands/deck_variables.h"
#include "support/arguments.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <numeric>

namespace drumlin {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Levenshtein distance: the number of letters that have to be inserted, deleted or changed.
std::size_t edits(const std::string &from, const std::string &to) {
  std::vector<std::size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < to.size(); ++j) {
      const std::size_t changed = diagonal + (from[i] == to[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

std::string nearest(const std::string &name, const std::vector<std::string> &known) {
  const auto distance = [&name](const std::string &other) { return edits(lower(name), lower(other)); };
  return *std::min_element(known.begin(), known.end(), [&](const std::string &a, const std::string &b) {
    return distance(a) < distance(b);
  });
}

} // namespace

void variables_command(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/variables", narg, arg);
  std::vector<std::string> known;
  std::vector<std::string> of_words;
  for (bool words = false; !in.empty();) {
    const std::string name = in.word("name");
    if (name == "of_words") {
      words = true;
      continue;
    }
    known.push_back(name);
    if (words) of_words.push_back(name);
  }
  DeckVariables variables(lmp);
  variables.close();
  const std::vector<DeclaredVariable> declared = variables.declared();
  if (!declared.empty() && !known.empty())
    in.fail("name", known.front(), "no names behind drumlin/variable, which declares each");
  for (const DeclaredVariable &variable : declared) {
    if (variable.given) known.push_back(variable.name);
    if (variable.words) of_words.push_back(variable.name);
  }
  if (known.empty() && declared.empty())
    in.fail("the names are missing; allowed: the names of the deck's variables");
  // Every rank was started with the same command line, so that all find the same fault.
  const std::vector<GivenVariable> all_given = given_variables();
  for (const GivenVariable &given : all_given)
    if (!of_front_script(given.name) && !is_in(known, given.name))
      in.fail(fmt::format("-var {}, a variable that this deck does not have; allowed: {}, the nearest of {}",
                          given.shown().substr(std::string("variable ").size()), nearest(given.name, known),
                          joined(known, ", ")));
  for (const GivenVariable &given : all_given)
    if (const std::string allowed = value_fault(given, is_in(of_words, given.name));
        is_in(known, given.name) && !allowed.empty())
      in.fail(given.shown() + "; allowed: " + allowed);
  DeckVariables::stop_on_fault(lmp);
  const TakenNotes taken = variables.taken();
  // Notes that were read after a declaration, or a value that the deck has changed since, also count.
  for (const DeclaredVariable &variable : declared) {
    const std::string value = variables.value(variable.name).value_or("");
    if (const std::string allowed = variables.note_fault(variable, value); !allowed.empty())
      in.fail("variable " + variable.name, value, allowed);
  }
  for (const auto *groups : {&taken.fixed, &taken.free})
    for (const std::string &group : *groups)
      if (std::none_of(declared.begin(), declared.end(),
                       [&group](const DeclaredVariable &variable) { return variable.group == group; }))
        in.fail("group of drumlin/take", group, "a group of variables of drumlin/variable");
  std::vector<std::string> may_change;
  for (const DeclaredVariable &variable : declared)
    if (is_in(taken.free, variable.group)) may_change.push_back(variable.name);
  for (const std::string &name : taken.change)
    if (!is_in(may_change, name))
      in.fail("variable allow_change", joined(taken.change, ","),
              "none, or names between commas out of " + joined(may_change, ","));
  variables.forget_notes(); // of a next scene in this run they say nothing
}

} // namespace drumlin
