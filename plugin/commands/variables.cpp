#include "commands/commands.h"

#include "commands/deck_variables.h"
#include "physics/files/variable_table.h"
#include "support/arguments.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <numeric>
#include <stdexcept>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;

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

/// A text with the values of ${NAME} and $(FORMULA) in it, as the engine has them in a line of a deck.
std::string evaluated(LAMMPS *lmp, const std::string &text) {
  if (text.find('$') == std::string::npos) return text;
  int size = static_cast<int>(text.size()) + 1, copy_size = 0;
  char *words = static_cast<char *>(lmp->memory->smalloc(size, "drumlin:words")), *copy = nullptr;
  std::copy_n(text.c_str(), size, words);
  lmp->input->substitute(words, copy, size, copy_size, 0);
  std::string value = words;
  lmp->memory->sfree(words);
  lmp->memory->sfree(copy);
  return value;
}

/// A name in ${NAME} or v_NAME of a formula that is no variable; empty: none.
std::string unknown_in(const DeckVariables &variables, const std::string &text) {
  const auto in_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (std::size_t at = 0; at + 2 < text.size(); ++at) {
    const std::string two = text.substr(at, 2);
    if (two != "${" && (two != "v_" || (at > 0 && in_name(text[at - 1])))) continue;
    const auto begin = text.begin() + static_cast<std::ptrdiff_t>(at) + 2;
    std::string name(begin, std::find_if_not(begin, text.end(), in_name));
    if (!variables.value(name)) return name;
  }
  return "";
}

/// \param standard the default value \param command for the error of a rule that does not exist
void declare(LAMMPS *lmp, const VariableLine &line, const std::string &standard, const std::string &command) {
  DeckVariables variables(lmp);
  std::vector<std::string> rule = words_of(evaluated(lmp, line.rule));
  rule.resize(std::max<std::size_t>(rule.size(), 1)); // an empty rule is refused below
  const std::string &name = line.name;
  DeclaredVariable variable{name, line.group, rule[0] != "noted", rule[0] == "words"};
  const std::vector<GivenVariable> all_given = given_variables();
  // Remove the variables of the command line that are not declared: -var must not change what a deck uses
  // internally.
  if (!variables.open())
    for (const GivenVariable &given : all_given)
      if (!of_front_script(given.name) && !variables.is_declared(given.name)) variables.remove(given.name);
  const auto given = std::find_if(all_given.begin(), all_given.end(),
                                  [&](const GivenVariable &one) { return one.name == name; });
  TakenNotes taken = variables.taken();
  const bool is_noted = std::any_of(taken.notes.begin(), taken.notes.end(),
                                    [&](const auto &note) { return note.first == name; });
  variable.chosen = (variable.given && given != all_given.end()) || is_noted;
  if (!taken.notes.empty() && is_in(taken.later, name) && !is_noted) {
    taken.notes.emplace_back(name, standard);
    variables.take(taken);
  }
  variables.declare(variable);
  if (variable.given && given != all_given.end()) variables.set(name, joined(given->values, " "));
  variables.set_default(name, standard);
  // With a fault the deck continues with the default, so that drumlin/variables can first name a variable
  // that the deck does not have.
  const auto refuse = [&](const std::string &fault) {
    variables.add_fault("drumlin/variable: " + fault);
    variables.set(name, standard);
  };
  if (variable.given && given != all_given.end())
    if (const std::string allowed = value_fault(*given, variable.words); !allowed.empty()) {
      refuse(given->shown() + "; allowed: " + allowed);
      return;
    }
  const std::string value = variables.value(name).value_or("");
  const std::string is = fmt::format("variable {} is '{}'", name, value);
  if (const std::string allowed = variables.note_fault(variable, value); !allowed.empty()) {
    refuse(is + "; allowed: " + allowed);
    return;
  }
  if (rule[0] == "any" || rule[0] == "words" || rule[0] == "noted") return;
  std::replace(rule.begin(), rule.end(), std::string("%"), value);
  if (const std::string fault = rule_fault(lmp, command, name, value, rule); !fault.empty())
    refuse(is + fault);
}

/// Declares the variables of a table that are not declared yet.
void declare_table(LAMMPS *lmp, const std::string &file, const std::vector<std::string> &groups) {
  std::string text, fault;
  if (lmp->comm->me == 0) try {
      text = variable_table_text(file);
      read_variable_table(text, file, groups);
    } catch (const std::invalid_argument &error) {
      fault = error.what();
    }
  engine::stop_on_fault(lmp, "drumlin/variables", fault);
  const DeckVariables variables(lmp);
  for (const VariableLine &line : read_variable_table(engine::from_rank_0(lmp, text), file, groups)) {
    if (variables.is_declared(line.name)) continue;
    const std::string where = fmt::format("drumlin/variables: line {} of '{}'", line.line, file);
    for (const std::string &formula : {line.standard, line.rule})
      if (const std::string unknown = unknown_in(variables, formula); !unknown.empty())
        engine::stop(lmp, fmt::format("{}: formula is '{}', of an unknown variable {}; allowed: variables "
                                      "above it, or of the deck",
                                      where, formula, unknown));
    declare(lmp, line, evaluated(lmp, line.standard), where);
  }
}

} // namespace

void variable_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/variable", narg, arg);
  VariableLine line;
  line.name = in.word("name", "the variable's name");
  const std::string of = " of variable " + line.name;
  line.standard = in.word("default value" + of);
  line.rule = in.word("rule" + of, "a rule of drumlin/check, any, words or noted");
  line.unit = in.word("unit" + of, "a unit, or -");
  line.group = in.word("group" + of, "a word");
  line.meaning = in.word("meaning" + of, "a text in quotes");
  in.expect_end("NAME DEFAULT RULE UNIT GROUP MEANING");
  declare(lmp, line, line.standard, "drumlin/variable");
}

void variables_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/variables", narg, arg);
  if (!in.empty()) {
    const std::string file = in.word("table");
    std::vector<std::string> groups;
    while (!in.empty())
      groups.push_back(in.word("group"));
    return declare_table(lmp, file, groups);
  }
  DeckVariables variables(lmp);
  variables.close();
  const std::vector<DeclaredVariable> declared = variables.declared();
  if (declared.empty())
    in.fail("table is missing; allowed: a table of variables, or lines drumlin/variable before");
  std::vector<std::string> known, of_words;
  for (const DeclaredVariable &variable : declared) {
    if (variable.given) known.push_back(variable.name);
    if (variable.words) of_words.push_back(variable.name);
  }
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
