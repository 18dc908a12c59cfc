// Options of commands whose texts are checked after all of them are known.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace drumlin::post {

/// An option; `text` holds its default. \param type word for its value in the help
inline CLI::Option *text_option(CLI::App *command, const std::string &name, const char *type,
                                std::string &text, const std::string &help) {
  return command->add_option(name, text, help)->type_name(type)->capture_default_str();
}

/// An option without a default.
inline CLI::Option *text_option(CLI::App *command, const std::string &name, const char *type,
                                std::optional<std::string> &text, const std::string &help) {
  return command
      ->add_option_function<std::string>(
          name, [&text](const std::string &given) { text = given; }, help)
      ->type_name(type);
}

} // namespace drumlin::post
