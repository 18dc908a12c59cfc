#include "engine/deck_variables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

namespace drumlin::post {
namespace {

namespace fs = std::filesystem;
using Values = std::map<std::string, std::string>;

/// The commands of a file: lines that end with & are continued.
std::vector<std::string> commands_of(const fs::path &file) {
  std::ifstream in(file);
  std::vector<std::string> commands;
  std::string command;
  for (std::string line; std::getline(in, line);) {
    line.erase(line.find_last_not_of(" \t\r") + 1);
    const bool continued = !line.empty() && line.back() == '&';
    if (continued) line.pop_back();
    command += line;
    if (continued) continue;
    commands.push_back(std::exchange(command, ""));
  }
  commands.push_back(command);
  return commands;
}

/// The words of a command, quoted ones as one, without the comment.
std::vector<std::string> words_of(const std::string &command) {
  std::vector<std::string> words;
  std::string word;
  char quote = 0;
  bool begun = false;
  const auto end = [&] {
    if (begun) words.push_back(std::exchange(word, ""));
    begun = false;
  };
  for (const char c : command) {
    if (quote == 0 && c == '#') break;
    if (quote == 0 && (c == ' ' || c == '\t')) {
      end();
    } else if (c == quote || (quote == 0 && (c == '"' || c == '\''))) {
      quote = quote == 0 ? c : 0;
      begun = true;
    } else {
      word += c;
      begun = true;
    }
  }
  end();
  return words;
}

/// A text with the values of its variables ${NAME}; those that have none stay.
std::string with_values(std::string text, const Values &values) {
  for (std::size_t begin = 0; (begin = text.find("${", begin)) != std::string::npos;) {
    const std::size_t end = text.find('}', begin);
    if (end == std::string::npos) break;
    const auto found = values.find(text.substr(begin + 2, end - begin - 2));
    if (found == values.end()) {
      begin = end;
      continue;
    }
    text.replace(begin, end + 1 - begin, found->second);
    begin += found->second.size();
  }
  return text;
}

class Reader {
public:
  explicit Reader(Values given) : values_(std::move(given)) {}

  void read(const fs::path &file) {
    constexpr int most_files = 200; // a file may include itself
    if (++files_ > most_files) return;
    std::string skipped_to; // a label
    for (const std::string &command : commands_of(file)) {
      const std::vector<std::string> words = words_of(command);
      if (skipped_to.empty())
        skipped_to = act(words);
      else if (words.size() == 2 && words[0] == "label" && words[1] == skipped_to)
        skipped_to.clear();
    }
  }

  std::vector<DeckVariable> variables;

private:
  /// Does what a command does to variables. Returns the label to which it jumps; empty: none.
  std::string act(const std::vector<std::string> &words) {
    if (words.size() >= 4 && words[0] == "if" && words[2] == "then") return choose(words);
    if (words.size() == 3 && words[0] == "jump") return words[2];
    if (words.size() == 2 && words[0] == "include") {
      const fs::path included = with_values(words[1], values_);
      std::error_code code;
      if (fs::is_regular_file(included, code)) read(included);
    } else if (words.size() == 3 && words[0] == "variable" && words[2] == "delete") {
      values_.erase(words[1]);
    } else if (words.size() == 4 && words[0] == "variable") {
      set(words[1], words[2], with_values(words[3], values_));
    } else if (words.size() == 7 && words[0] == "drumlin/variable") {
      declare({words[1], words[2], words[4], words[3], words[5], words[6]});
    } else if (words.size() > 1 && words[0] == "drumlin/variables") {
      const std::string file = with_values(words[1], values_);
      std::string groups;
      for (auto word = words.begin() + 2; word != words.end(); ++word)
        groups += with_values(*word, values_) + " ";
      for (const DeckVariable &line : read_variable_table(variable_table_text(file), file, words_of(groups)))
        declare(line);
    }
    return "";
  }

  /// \param style index keeps a value that the variable has; of equal only a number or another variable is
  /// known
  void set(const std::string &name, const std::string &style, const std::string &text) {
    if (style == "index") {
      values_.emplace(name, text);
    } else if (style == "string") {
      values_[name] = text;
    } else if (style == "equal") {
      const auto other = text.compare(0, 2, "v_") == 0 ? values_.find(text.substr(2)) : values_.end();
      if (other != values_.end())
        values_[name] = other->second;
      else if (!text.empty() && text.find_first_not_of("0123456789.") == std::string::npos)
        values_[name] = text;
    }
  }

  /// A line `if "CONDITION" then "COMMAND" ... else "COMMAND" ...`; one whose condition is not known here
  /// does nothing.
  std::string choose(const std::vector<std::string> &words) {
    const std::optional<bool> holds = condition(words_of(with_values(words[1], values_)));
    if (!holds) return "";
    const auto otherwise = std::find(words.begin(), words.end(), "else");
    const auto begin = *holds ? words.begin() + 3 : otherwise == words.end() ? otherwise : otherwise + 1;
    const auto end = *holds ? otherwise : words.end();
    std::string label;
    for (auto command = begin; command != end && label.empty(); ++command)
      label = act(words_of(*command));
    return label;
  }

  static std::optional<double> number(const std::string &text) {
    char *end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return text.empty() || *end != '\0' ? std::nullopt : std::optional(value);
  }

  /// "A", "A == B" and so on of numbers, or "A == B" of words; none if it is something else.
  static std::optional<bool> condition(const std::vector<std::string> &words) {
    if (words.empty() || (words.size() != 1 && words.size() != 3)) return std::nullopt;
    const std::optional<double> a = number(words[0]);
    if (words.size() == 1) return a ? std::optional(*a != 0.0) : std::nullopt;
    const std::optional<double> b = number(words[2]);
    const std::string &is = words[1];
    if (!a || !b)
      return is == "==" && words[0].find('$') == std::string::npos ? std::optional(words[0] == words[2])
                                                                   : std::nullopt;
    return is == "=="   ? *a == *b
           : is == "!=" ? *a != *b
           : is == ">"  ? *a > *b
           : is == "<"  ? *a < *b
           : is == ">=" ? *a >= *b
                        : *a <= *b;
  }

  void declare(DeckVariable line) {
    line.standard = values_.emplace(line.name, with_values(line.standard, values_)).first->second;
    line.rule = with_values(line.rule, values_);
    const auto same = std::find_if(variables.begin(), variables.end(),
                                   [&](const DeckVariable &other) { return other.name == line.name; });
    if (line.rule != "noted" && same == variables.end()) variables.push_back(line);
  }

  Values values_;
  int files_ = 0;
};

/// What a rule of drumlin/check allows, in a few words.
std::string range_of(const std::string &rule) {
  std::istringstream in(rule);
  std::string word, rest;
  in >> word;
  std::getline(in >> std::ws, rest);
  if (word == "each") return range_of(rest) + ", or a list";
  if (word == "positive") return "> 0";
  if (word == "non_negative") return ">= 0";
  if (word == "finite") return "a number";
  if (word == "one_of") {
    for (std::size_t at = 0; (at = rest.find(' ', at)) != std::string::npos; at += 2)
      rest.replace(at, 1, ", ");
    return rest;
  }
  if (word == "integer") {
    std::istringstream bounds(rest);
    std::string low, high;
    bounds >> low >> high;
    return low + " to " + high;
  }
  if (word == "suffix_of") {
    const fs::path begin = rest;
    std::vector<std::string> names;
    std::error_code code;
    for (const auto &entry : fs::directory_iterator(begin.parent_path(), code))
      if (const std::string name = entry.path().filename().string();
          name.rfind(begin.filename().string(), 0) == 0)
        names.push_back(name.substr(begin.filename().string().size()));
    std::sort(names.begin(), names.end());
    return fmt::format("{}", fmt::join(names, ", "));
  }
  if (word == "file" || word == "data_file" || word == "restart" || word == "restart_name") return "a file";
  if (word == "output_folder" || word == "directory") return "a folder";
  return "";
}

/// The default as a reader wants it: a formula $(40*PI) without its sign.
std::string default_of(std::string text) {
  if (text.size() < 4 || text.compare(0, 2, "$(") != 0 || text.find("$(", 2) != std::string::npos ||
      text.back() != ')')
    return text;
  text = text.substr(2, text.size() - 3);
  for (std::size_t at = 0; (at = text.find("v_", at)) != std::string::npos;)
    text.erase(at, 2);
  return text;
}

std::string wrapped(const std::string &text, std::size_t indent, std::size_t width) {
  std::istringstream in(text);
  std::string lines, line;
  for (std::string word; in >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > width) {
      lines += std::string(indent, ' ') + std::exchange(line, "") + "\n";
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return lines + std::string(indent, ' ') + line + "\n";
}

} // namespace

std::vector<DeckVariable> deck_variables(const fs::path &deck, Values given) {
  given.emplace("here", deck.has_parent_path() ? deck.parent_path().string() : ".");
  given.emplace("engine", deck.extension() == ".lammps" ? "lammps" : "liggghts");
  Reader reader(std::move(given));
  reader.read(deck);
  return reader.variables;
}

std::string variables_text(const std::vector<DeckVariable> &variables, std::size_t width) {
  std::vector<std::string> groups;
  for (const DeckVariable &variable : variables)
    if (std::find(groups.begin(), groups.end(), variable.group) == groups.end())
      groups.push_back(variable.group);
  // What every deck has stands last.
  std::stable_partition(groups.begin(), groups.end(),
                        [](const std::string &group) { return group != "run"; });
  std::string text;
  for (const std::string &group : groups) {
    std::string title = group;
    std::replace(title.begin(), title.end(), '_', ' ');
    text += "\n" + title + ":\n";
    for (const DeckVariable &variable : variables) {
      if (variable.group != group) continue;
      const std::string range = range_of(variable.rule);
      std::string line = fmt::format("  {:<18} {}", variable.name, default_of(variable.standard));
      if (variable.unit != "-" && variable.unit != "1") line += " " + variable.unit;
      if (!range.empty())
        line += fmt::format("{}({})", std::string(line.size() < 43 ? 44 - line.size() : 1, ' '), range);
      text += line + "\n" + wrapped(variable.meaning, 21, width - 21);
    }
  }
  return text;
}

} // namespace drumlin::post
