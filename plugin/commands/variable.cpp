#include "commands/commands.h"

#include "commands/deck_variables.h"
#include "support/arguments.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <sstream>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;

/// A quoted text with the values of the variables ${NAME} in it: the engines do not replace these in quotes.
std::string with_values(const DeckVariables &variables, std::string text) {
  for (std::size_t begin = 0; (begin = text.find("${", begin)) != std::string::npos;) {
    const std::size_t end = text.find('}', begin);
    if (end == std::string::npos) break;
    const std::string value = variables.value(text.substr(begin + 2, end - begin - 2)).value_or("");
    text.replace(begin, end + 1 - begin, value);
    begin += value.size();
  }
  return text;
}

} // namespace

void variable_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/variable", narg, arg);
  DeclaredVariable variable{in.word("name", "the variable's name"), "", true, false};
  const std::string of = " of variable " + variable.name;
  const std::string standard = in.word("default value" + of);
  DeckVariables variables(lmp);
  std::istringstream words(
      with_values(variables, in.word("rule" + of, "a rule of drumlin/check, any, words or noted")));
  std::vector<std::string> rule(std::istream_iterator<std::string>(words), {});
  in.word("unit" + of, "a unit, or -");
  variable.group = in.word("group" + of, "a word");
  in.word("meaning" + of, "a text in quotes");
  in.expect_end("NAME DEFAULT RULE UNIT GROUP MEANING");
  if (rule.empty()) in.fail("rule" + of, "", "a rule of drumlin/check, any, words or noted");
  variable.given = rule[0] != "noted";
  variable.words = rule[0] == "words";

  const std::vector<GivenVariable> all_given = given_variables();
  // Remove the variables of the command line that are not declared: -var must not change what a deck uses
  // internally.
  if (!variables.open())
    for (const GivenVariable &given : all_given)
      if (!of_front_script(given.name) && !variables.is_declared(given.name)) variables.remove(given.name);
  const auto given = std::find_if(all_given.begin(), all_given.end(),
                                  [&](const GivenVariable &one) { return one.name == variable.name; });
  TakenNotes taken = variables.taken();
  const RestartNotes notes = taken.notes;
  variable.chosen =
      (variable.given && given != all_given.end()) ||
      std::any_of(notes.begin(), notes.end(), [&](const auto &note) { return note.first == variable.name; });
  if (!notes.empty() && is_in(taken.later, variable.name) &&
      std::none_of(notes.begin(), notes.end(),
                   [&](const auto &note) { return note.first == variable.name; })) {
    taken.notes.emplace_back(variable.name, standard);
    variables.take(taken);
  }
  variables.declare(variable);
  if (variable.given && given != all_given.end()) variables.set(variable.name, joined(given->values, " "));
  variables.set_default(variable.name, standard);
  // With a fault the deck continues with the default, so that drumlin/variables can first name a variable
  // that the deck does not have.
  const auto refuse = [&](const std::string &fault) {
    variables.add_fault("drumlin/variable: " + fault);
    variables.set(variable.name, standard);
  };
  if (variable.given && given != all_given.end())
    if (const std::string allowed = value_fault(*given, variable.words); !allowed.empty()) {
      refuse(given->shown() + "; allowed: " + allowed);
      return;
    }
  const std::string value = variables.value(variable.name).value_or("");
  const std::string is = fmt::format("variable {} is '{}'", variable.name, value);
  if (const std::string allowed = variables.note_fault(variable, value); !allowed.empty()) {
    refuse(is + "; allowed: " + allowed);
    return;
  }
  if (rule[0] == "any" || rule[0] == "words" || rule[0] == "noted") return;
  std::replace(rule.begin(), rule.end(), std::string("%"), value);
  if (const std::string fault = rule_fault(lmp, "drumlin/variable", variable.name, value, rule);
      !fault.empty())
    refuse(is + fault);
}

} // namespace drumlin
