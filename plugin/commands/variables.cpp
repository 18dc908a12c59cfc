#include "commands/commands.h"

#include "support/arguments.h"
#include "support/command_line.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <numeric>

namespace drumlin {
namespace {

/// A variable of the command line and its values.
struct GivenVariable {
  std::string name;
  std::vector<std::string> values;
};

/// Variables that -var or -v give, read as the engines read them: the word behind the name is a value in any
/// case; further words are values up to the next that begins with a minus sign.
std::vector<GivenVariable> given_variables(const std::vector<std::string> &words) {
  std::vector<GivenVariable> given;
  for (std::size_t n = 1; n + 2 < words.size(); ++n) {
    if (words[n] != "-var" && words[n] != "-v") continue;
    GivenVariable variable{words[++n], {}};
    do
      variable.values.push_back(words[++n]);
    while (n + 1 < words.size() && (words[n + 1].empty() || words[n + 1][0] != '-'));
    given.push_back(std::move(variable));
  }
  return given;
}

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

bool is_in(const std::vector<std::string> &names, const std::string &name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// A value for an error text: control characters, such as line ends, replaced by '?', and at most 60
/// characters.
std::string printable(std::string value) {
  for (char &c : value)
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = '?';
  constexpr std::size_t longest_shown = 60;
  return value.size() <= longest_shown ? value : value.substr(0, longest_shown) + "...";
}

/// Empty if the engine's parser takes a value as it is; else what is allowed.
/// \param of_words whether the value may have blanks
std::string value_fault(const std::vector<std::string> &values, bool of_words) {
  constexpr std::size_t longest_value = 1000;
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
  if (known.empty()) in.fail("the names are missing; allowed: the names of the deck's variables");
  // Every rank was started with the same command line, so that all find the same fault.
  for (const GivenVariable &given : given_variables(command_line_arguments())) {
    const std::string shown = printable(joined(given.values, " "));
    const bool of_front_script = given.name == "here" || given.name == "plugin";
    if (of_front_script) continue;
    if (!is_in(known, given.name))
      in.fail(fmt::format(
          "-var {} is '{}', a variable that this deck does not have; allowed: {}, the nearest of {}",
          printable(given.name), shown, nearest(given.name, known), joined(known, ", ")));
    if (const std::string allowed = value_fault(given.values, is_in(of_words, given.name)); !allowed.empty())
      in.fail(fmt::format("variable {} is '{}'; allowed: {}", given.name, shown, allowed));
  }
}

} // namespace drumlin
