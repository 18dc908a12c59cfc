// Numbers from the command line: they stay text until one rule with one kind of message judges them.
#pragma once

#include <string>

namespace drumlin::post {

/// The finite number that an option's text holds; else UsageError naming option, text and what is allowed.
double number_option(const char *option, const std::string &text);

/// The same for a whole number from 1.
int count_option(const char *option, const std::string &text);

} // namespace drumlin::post
