#include "commands/commands.h"

#include "commands/bed_files.h"
#include "commands/deck_variables.h"
#include "support/arguments.h"
#include "support/whole_file.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

namespace drumlin {
namespace {

using LAMMPS_NS::LAMMPS;

/// Whether output files can be written into a folder that exists or can be made.
bool can_be_folder(const std::string &folder) {
  namespace fs = std::filesystem;
  if (folder.find_first_of("*%") != std::string::npos || !is_output_folder(folder)) return false;
  std::error_code code;
  fs::path existing = fs::absolute(folder, code);
  while (!fs::exists(existing, code) && existing.has_relative_path())
    existing = existing.parent_path();
  return fs::is_directory(existing, code) && access(existing.c_str(), W_OK | X_OK) == 0;
}

bool is_whole_number(const std::string &text, double &value) {
  value = parse_number(text);
  return std::isfinite(value) && value == std::floor(value) && std::fabs(value) < 1e15;
}

/// A value that breaks a rule. \param text what follows "variable NAME is 'VALUE'" in the error
struct Broken {
  std::string text;
};

/// The value of a variable and a rule, which is a member function of its name.
class Check {
public:
  /// \param in the arguments behind name and value
  Check(LAMMPS *lmp, Arguments &in, std::string name, std::string value)
      : lmp_(lmp), in_(in), name_(std::move(name)), value_(std::move(value)) {}

  /// Throws Broken if the value breaks the rule.
  void run() {
    using Rule = void (Check::*)();
    const std::vector<std::pair<std::string, Rule>> rules = {{"one_of", &Check::one_of},
                                                             {"same_as", &Check::same_as},
                                                             {"positive", &Check::positive},
                                                             {"non_negative", &Check::non_negative},
                                                             {"finite", &Check::finite},
                                                             {"each", &Check::each},
                                                             {"integer", &Check::integer},
                                                             {"multiple_of", &Check::multiple_of},
                                                             {"above", &Check::above},
                                                             {"below", &Check::below},
                                                             {"at_most", &Check::at_most},
                                                             {"at_least", &Check::at_least},
                                                             {"not_given", &Check::not_given},
                                                             {"directory", &Check::directory},
                                                             {"output_folder", &Check::output_folder},
                                                             {"file", &Check::file},
                                                             {"suffix_of", &Check::suffix_of},
                                                             {"data_file", &Check::data_file},
                                                             {"restart", &Check::restart},
                                                             {"restart_name", &Check::restart_name},
                                                             {"one_rank", &Check::one_rank}};
    std::vector<std::string> names;
    names.reserve(rules.size());
    for (const auto &rule : rules)
      names.push_back(rule.first);
    const std::string what = "rule for variable " + name_;
    (this->*rules[static_cast<std::size_t>(in_.choice(what, names))].second)();
    if (!in_.empty()) in_.fail("argument behind the " + what, in_.peek(), "one value and one rule");
  }

private:
  [[noreturn]] static void reject(const std::string &allowed) { throw Broken{"; allowed: " + allowed}; }

  /// Rejects the value on all ranks if rank 0 has found it bad. Collective.
  void reject_if(bool bad_on_rank_0, const std::string &allowed) const {
    stop_on(bad_on_rank_0 ? "; allowed: " + allowed : "");
  }
  bool is_rank_0() const { return lmp_->comm->me == 0; }

  void one_of() {
    std::vector<std::string> choices;
    while (!in_.empty())
      choices.push_back(in_.word("choice"));
    if (choices.empty())
      in_.fail("word of rule one_of for variable " + name_ + " is missing; allowed: at least one word");
    if (std::find(choices.begin(), choices.end(), value_) == choices.end()) reject(join_choices(choices));
  }

  /// What is not noted contradicts nothing.
  void same_as() {
    const std::string other = in_.word("rule same_as, the other value");
    const std::string of = in_.empty() ? "" : ", " + rest();
    if (other == "unknown") return;
    const std::vector<std::string> a = list_entries(value_), b = list_entries(other);
    bool same = a.size() == b.size() || a.size() == 1 || b.size() == 1;
    for (std::size_t i = 0; same && i < std::max(a.size(), b.size()); ++i)
      same = same_value(a[a.size() == 1 ? 0 : i], b[b.size() == 1 ? 0 : i]);
    if (!same) reject(other + of);
  }
  void positive() { in(value_, Range::positive, ""); }
  void non_negative() { in(value_, Range::non_negative, ""); }
  void finite() { in(value_, Range::any, ""); }
  void each() {
    const int rule = in_.choice("rule each, the rule of a number", {"finite", "positive", "non_negative"});
    const Range &range = rule == 0 ? Range::any : rule == 1 ? Range::positive : Range::non_negative;
    for (const std::string &entry : list_entries(value_))
      in(entry, range, ", or several, separated by commas");
  }
  /// \param number_word a number of the value
  void in(const std::string &number_word, const Range &range, const char *or_else) {
    // With numbers outside of these bounds products of quantities could overflow or underflow.
    constexpr double smallest = 1e-30;
    constexpr double largest = 1e30;
    const double number = parse_number(number_word);
    const double size = std::fabs(number);
    if (!in_range(number, range) || size > largest || (size != 0.0 && size < smallest))
      reject(allowed_text(range) +
             (std::isfinite(number) && in_range(number, range) ? ", between 1e-30 and 1e30 in size" : "") +
             or_else);
  }

  void integer() {
    const auto lowest = in_.integer("rule integer, lowest", INT_MIN);
    const auto highest = in_.integer("rule integer, highest", lowest);
    double number = 0.0;
    if (!is_whole_number(value_, number) || number < static_cast<double>(lowest) ||
        number > static_cast<double>(highest))
      reject(fmt::format("a whole number from {} to {}", lowest, highest));
  }

  void multiple_of() {
    const std::string other = in_.word("rule multiple_of, the other variable's name");
    const std::string other_value = in_.word("rule multiple_of, the other variable's value");
    double a = 0.0;
    double b = 0.0;
    if (!is_whole_number(value_, a) || !is_whole_number(other_value, b) || b <= 0.0 || a <= 0.0 ||
        std::fmod(a, b) != 0.0)
      reject(fmt::format("a multiple of {}, which is {}", other, other_value));
  }

  // The limit of a value is often a formula of other variables or of the scene: the words behind it name
  // these.
  void above() {
    against("above", [](double value, double limit) { return value > limit; });
  }
  void below() {
    against("below", [](double value, double limit) { return value < limit; });
  }
  void at_least() {
    against("at least", [](double value, double limit) { return value >= limit; });
  }
  void at_most() {
    against("at most", [](double value, double limit) { return value <= limit; });
  }
  /// For a variable that has no effect in a scene, and is none there unless the command line gives it.
  void not_given() {
    const std::string with = rest();
    if (value_ != "none") reject("not given " + with);
  }

  std::string rest() {
    std::string words;
    while (!in_.empty())
      words += (words.empty() ? "" : " ") + in_.word("word");
    return words;
  }
  template <class Holds>
  void against(const std::string &relation, const Holds &holds) {
    const double limit = in_.number("rule " + relation + ", the limit");
    const std::string of = in_.empty() ? "" : ", " + rest();
    if (const double number = parse_number(value_); !std::isfinite(number) || !holds(number, limit))
      reject(fmt::format("a finite number {} {:.6g}{}", relation, limit, of));
  }

  static constexpr const char *folder_allowed =
      "a folder that can be made or written, without * and % in its path, and not /, /dev, /proc or /sys";
  void output_folder() { reject_if(is_rank_0() && !can_be_folder(value_), folder_allowed); }
  void directory() {
    output_folder();
    std::error_code failed;
    reject_if(is_rank_0() && !std::filesystem::create_directories(value_, failed) &&
                  !std::filesystem::is_directory(value_),
              folder_allowed);
  }

  void file() {
    const std::string maker = rest();
    // The name that in.bed gives to the restart file of a run that was stopped.
    const bool stopped = std::filesystem::path(value_).filename() == "stopped.restart";
    reject_if(is_rank_0() && !can_be_read(value_),
              "a file that can be read" +
                  (stopped         ? ", which a run writes when it is stopped, and removes when it has ended"
                   : maker.empty() ? ""
                                   : ", which '" + maker + "' makes"));
  }

  /// For a variable that is the end of a file's name, such as a case.
  void suffix_of() {
    namespace fs = std::filesystem;
    const fs::path begin = in_.word("rule suffix_of, the begin of the files' names");
    if (!is_rank_0()) return stop_on("");
    std::vector<std::string> choices;
    std::error_code code;
    const std::string prefix = begin.filename().string();
    for (const auto &entry : fs::directory_iterator(begin.parent_path(), code))
      if (const std::string name = entry.path().filename().string(); name.rfind(prefix, 0) == 0)
        choices.push_back(name.substr(prefix.size()));
    std::sort(choices.begin(), choices.end());
    const bool known = std::find(choices.begin(), choices.end(), value_) != choices.end();
    stop_on(known ? "" : "; allowed: " + join_choices(choices));
  }

  void data_file() { stop_on(is_rank_0() ? data_file_fault(value_) : ""); }
  void restart() {
    const RestartNotes notes = read_notes(lmp_, in_);
    if (!is_rank_0()) return stop_on("");
    const std::string scene = scene_file(value_);
    if (scene == value_) return stop_on(restart_fault(value_, notes));
    const std::string fault = data_file_fault(scene);
    stop_on(fault.empty() ? "" : ", of which this engine reads '" + scene + "'" + fault);
  }
  /// \param fault text behind the value, "; allowed: ..." or more; empty: none
  void stop_on(const std::string &fault) const {
    if (const std::string shared = engine::from_rank_0(lmp_, fault); !shared.empty()) throw Broken{shared};
  }

  void restart_name() { reject_if(is_rank_0() && !is_restart_name(value_), restart_name_allowed); }

  void one_rank() {
    if (lmp_->comm->nprocs > 1)
      throw Broken{fmt::format(" on {} ranks; allowed: one rank", lmp_->comm->nprocs)};
  }

  LAMMPS *lmp_;
  Arguments &in_;
  std::string name_, value_;
};

} // namespace

std::string rule_fault(LAMMPS *lmp, const std::string &command, const std::string &name,
                       const std::string &value, const std::vector<std::string> &rule) {
  std::vector<std::string> words = rule;
  std::vector<char *> pointers(words.size());
  std::transform(words.begin(), words.end(), pointers.begin(), [](std::string &word) { return word.data(); });
  Arguments in(lmp->error, command, static_cast<int>(pointers.size()), pointers.data());
  try {
    Check(lmp, in, name, value).run();
  } catch (const Broken &broken) {
    return broken.text;
  }
  return "";
}

void check_command(LAMMPS *lmp, int narg, char **arg) {
  Arguments in(lmp->error, "drumlin/check", narg, arg);
  const std::string name = in.word("the variable's name");
  const std::string value = in.word("the value of variable " + name);
  const std::vector<std::string> words = // * stands for each word of the variable
      value == "*" ? words_of(DeckVariables(lmp).value(name).value_or("")) : std::vector{value};
  for (const std::string &word : words) {
    Arguments rule = in;
    try {
      Check(lmp, rule, name, word).run();
    } catch (const Broken &broken) {
      DeckVariables::refuse(lmp,
                            fmt::format("drumlin/check: variable {} is '{}'{}", name, word, broken.text));
    }
  }
}

} // namespace drumlin
