#include "commands/command.h"

#include "support/options.h"

#include <CLI/CLI.hpp>

#include <utility>

namespace drumlin::post {

Command::Command(CLI::App &app, const Session &session, const char *name, const std::string &summary,
                 const std::string &footer)
    : app_(app.add_subcommand(name, summary)), session_(&session) {
  if (!footer.empty()) app_->footer(footer); // else that of the app
}

void Command::runs(std::function<void()> run) { app_->callback(std::move(run)); }

void Command::judge() {
  for (const Rule &rule : rules_)
    if (rule.of->given() && rule.other->given() != rule.with) throw rule.of->refused(rule.allowed);
  for (Option *option : options_)
    if (*option) option->judge();
}

void Options::add_to_group(CLI::Option *option) const {
  if (group_ != nullptr) option->group(group_);
}

Option::Option(const Options &of, std::string name, const char *type, const std::string &help,
               const Default &usual)
    : name_(std::move(name)), text_(usual.text) {
  const auto take = [this](const std::string &given) {
    text_ = given;
    given_ = true;
  };
  CLI::Option *option = of.app().add_option_function<std::string>(name_, take, help);
  option->type_name(type)->required(usual.required);
  if (!usual.text.empty()) option->default_str(usual.text);
  of.add_to_group(option);
  of.judge_later(this);
}

Flag::Flag(const Options &of, const char *name, const std::string &help) : Option(name) {
  const auto take = [this] {
    text_ = "given";
    given_ = true;
  };
  of.add_to_group(of.app().add_flag_callback(name_, take, help));
}

Texts::Texts(const Options &of, const char *name, const char *type, const std::string &help, bool in_a_row,
             bool must)
    : Option(name) {
  const auto take = [this](const std::vector<std::string> &given) {
    texts_ = given;
    text_ = given.front();
    given_ = true;
  };
  CLI::Option *option = of.app().add_option_function<std::vector<std::string>>(name_, take, help);
  option->type_name(type)->required(must);
  if (!in_a_row) option->expected(1)->take_all();
  of.add_to_group(option);
}

Number Options::number(const std::string &name, const Range &range, const std::string &help,
                       const Default &usual) const {
  return Number(*this, name, "NUMBER", help, usual, [range](const char *option, const std::string &text) {
    return number_option(option, text, range);
  });
}

Count Options::count(const char *name, int least, int most, const std::string &help, const Default &usual,
                     const char *type) const {
  return Count(*this, name, type, help, usual, [least, most](const char *option, const std::string &text) {
    return count_option(option, text, least, most);
  });
}

Seed Options::random_seed(const char *name, const std::string &help, const Default &usual) const {
  return Seed(*this, name, "COUNT", help, usual, seed_option);
}

Text Options::text(const char *name, const char *type, const std::string &help, const Default &usual) const {
  return Text(*this, name, type, help, usual,
              [](const char * /*option*/, const std::string &text) { return text; });
}

ResultPath Options::result_folder(const char *name, const std::string &help, const Default &usual) const {
  return ResultPath(*this, name, "DIR", help, usual, output_folder_option);
}

ResultPath Options::result_file(const char *name, const std::string &help, const Default &usual) const {
  return ResultPath(*this, name, "FILE", help, usual, output_file_option);
}

Flag Options::flag(const char *name, const std::string &help) const { return Flag(*this, name, help); }

Texts Options::texts(const char *name, const char *type, const std::string &help) const {
  return Texts(*this, name, type, help, false, false);
}

Texts Options::texts_in_a_row(const char *name, const char *type, const std::string &help) const {
  return Texts(*this, name, type, help, true, false);
}

Texts Options::words(const char *name, const char *type, const std::string &help) const {
  return Texts(*this, name, type, help, true, true);
}

void Options::only_with(const Option &other, std::initializer_list<const Option *> options,
                        const std::string &allowed) const {
  for (const Option *option : options)
    command_->rules_.push_back(
        {option, &other, true, allowed.empty() ? "only with " + other.name() : allowed});
}

void Options::not_with(const Option &other, std::initializer_list<const Option *> options,
                       const std::string &allowed) const {
  for (const Option *option : options)
    command_->rules_.push_back(
        {option, &other, false, allowed.empty() ? "without " + other.name() : allowed});
}

} // namespace drumlin::post
