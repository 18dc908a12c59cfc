// A subcommand and its options. Each option is one member, declared with name, range and unit, help and
// default; it holds the value that the user gave. Values outside of their range are refused before the
// subcommand runs.
#pragma once

#include "support/units.h"
#include "support/usage_error.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class Option;
}

namespace drumlin::post {

class Options;

/// In place of a default: the option must be given.
struct Required {};
constexpr Required required;

/// A default, as a user would type it; empty: none.
struct Default {
  std::string text;
  bool required = false;
  Default(const char *words = "") : text(words) {}
  Default(std::string words) : text(std::move(words)) {}
  Default(Required /*unused*/) : required(true) {}
};

/// An option as given. A copy is a value of its own.
class Option {
public:
  virtual ~Option() = default;
  Option(const Option &) = default;
  Option &operator=(const Option &) = default;

  bool given() const { return given_; }                               ///< on the command line
  explicit operator bool() const { return given_ || !text_.empty(); } ///< given, or with a default
  const std::string &name() const { return name_; }
  const std::string &text() const { return text_; } ///< as given; else the default
  /// "NAME is 'TEXT'; allowed: WHAT"
  UsageError refused(const std::string &allowed) const { return UsageError(refusal(name_, text_, allowed)); }

protected:
  explicit Option(std::string name) : name_(std::move(name)) {}
  Option(const Options &of, std::string name, const char *type, const std::string &help,
         const Default &usual);
  std::string name_, text_;
  bool given_ = false;

private:
  friend class Command;
  virtual void judge() {} ///< takes the value from the text
};

/// A word without a value.
class Flag : public Option {
  friend class Options;
  Flag(const Options &of, const char *name, const std::string &help);
};

/// An option with one value; none where it is not given and has no default.
template <class Value>
class OptionOf : public Option {
public:
  const Value &operator*() const { return *value_; }
  const Value *operator->() const { return &*value_; }
  Value value_or(Value other) const { return value_.value_or(std::move(other)); }
  const std::optional<Value> &value() const { return value_; }
  /// Another value, as if it were given.
  void set(Value value) {
    value_ = std::move(value);
    given_ = true;
  }

private:
  friend class Options;
  using Judge = std::function<Value(const char *name, const std::string &text)>;
  OptionOf(const Options &of, std::string name, const char *type, const std::string &help,
           const Default &usual, Judge judge)
      : Option(of, std::move(name), type, help, usual), judge_(std::move(judge)) {}
  void judge() override { value_ = judge_(name_.c_str(), text_); }
  Judge judge_;
  std::optional<Value> value_;
};
using Number = OptionOf<double>;
using Count = OptionOf<int>;
using Seed = OptionOf<std::uint64_t>;
using Text = OptionOf<std::string>;                 ///< judged by the subcommand itself
using ResultPath = OptionOf<std::filesystem::path>; ///< a folder or file for results

/// Texts of an option that may be given several times, or of arguments without a name.
class Texts : public Option {
public:
  const std::vector<std::string> &operator*() const { return texts_; }
  const std::vector<std::string> *operator->() const { return &texts_; }
  std::vector<std::string>::const_iterator begin() const { return texts_.begin(); }
  std::vector<std::string>::const_iterator end() const { return texts_.end(); }
  /// A refusal of one of them.
  UsageError refused(const std::string &text, const std::string &allowed) const {
    return UsageError(refusal(name_, text, allowed));
  }

private:
  friend class Options;
  Texts(const Options &of, const char *name, const char *type, const std::string &help, bool in_a_row,
        bool must);
  std::vector<std::string> texts_;
};

/// A subcommand of an app.
class Command {
public:
  Command(CLI::App &app, const Session &session, const char *name, const std::string &summary,
          const std::string &footer);
  void runs(std::function<void()> run);
  /// Judges all options in the order of their declaration. Throws UsageError.
  void judge();

private:
  friend class Options;
  struct Rule {
    const Option *of, *other;
    bool with;
    std::string allowed;
  };
  CLI::App *app_;
  const Session *session_;
  std::vector<Option *> options_; ///< with one text each
  std::vector<Rule> rules_;
};

/// Options of a subcommand, or of several that have them in common: a struct with them as members derives
/// from it. The members stay where they are made as long as the app is there; copies are values alone.
class Options {
public:
  /// \param group of the help; none: the usual one
  explicit Options(Command &command, const char *group = nullptr) : command_(&command), group_(group) {}
  const Session &session() const { return *command_->session_; }

protected:
  Number number(const std::string &name, const Range &range, const std::string &help,
                const Default &usual = {}) const;
  Count count(const char *name, int least, int most, const std::string &help, const Default &usual = {},
              const char *type = "COUNT") const;
  Seed random_seed(const char *name, const std::string &help, const Default &usual) const;
  /// \param type word for the value in the help
  Text text(const char *name, const char *type, const std::string &help, const Default &usual = {}) const;
  ResultPath result_folder(const char *name, const std::string &help, const Default &usual = {}) const;
  ResultPath result_file(const char *name, const std::string &help, const Default &usual) const;
  Flag flag(const char *name, const std::string &help) const;
  /// Given several times, each with one text.
  Texts texts(const char *name, const char *type, const std::string &help) const;
  /// The same, or with several in a row.
  Texts texts_in_a_row(const char *name, const char *type, const std::string &help) const;
  /// Arguments without an option's name, one or more.
  Texts words(const char *name, const char *type, const std::string &help) const;

  /// Each of the options is refused without `other`.
  void only_with(const Option &other, std::initializer_list<const Option *> options,
                 const std::string &allowed = "") const;
  /// Each of the options is refused together with `other`.
  void not_with(const Option &other, std::initializer_list<const Option *> options,
                const std::string &allowed = "") const;
  Command &command() const { return *command_; }
  /// All options of the subcommand up to here that have a text each.
  const std::vector<Option *> &all_of_command() const { return command_->options_; }

private:
  friend class Option;
  friend class Flag;
  friend class Texts;
  CLI::App &app() const { return *command_->app_; }
  void add_to_group(CLI::Option *option) const;
  void judge_later(Option *option) const { command_->options_.push_back(option); }
  Command *command_;
  const char *group_;
};

/// Adds a subcommand. \param run gets the judged options
template <class Arguments>
void add_command(CLI::App &app, const Session &session, const char *name, const std::string &summary,
                 void (*run)(const Arguments &), const std::string &footer = "") {
  const auto command = std::make_shared<Command>(app, session, name, summary, footer);
  const auto arguments = std::make_shared<Arguments>(*command);
  command->runs([command, arguments, run] {
    command->judge();
    run(*arguments);
  });
}

} // namespace drumlin::post
