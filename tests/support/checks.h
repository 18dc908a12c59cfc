// What tests ask of the output of programs and of texts, and how they put together the variables of a deck.
#pragma once

#include "engine/engine_run.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin::test {

/// The outcome of a program that has ended well. Of one that has not it throws the output, and where it was
/// called, which fails the test.
inline post::Outcome well(post::Outcome outcome, const char *file = __builtin_FILE(),
                          int line = __builtin_LINE()) {
  if (!outcome.ok())
    throw std::runtime_error(fmt::format("{}:{}: status {}\n{}", file, line, outcome.status, outcome.output));
  return outcome;
}

/// One text, or several in braces.
struct Texts : std::vector<std::string> {
  Texts(const char *text) : vector{text} {}
  Texts(const std::string &text) : vector{text} {}
  Texts(std::initializer_list<std::string> texts) : vector(texts) {}
  Texts(const std::vector<std::string> &texts) : vector(texts) {}
};

/// Whether a text has all of these parts.
inline ::testing::AssertionResult contains(const std::string &text, const Texts &parts) {
  for (const std::string &part : parts)
    if (text.find(part) == std::string::npos)
      return ::testing::AssertionFailure() << "no '" << part << "' in\n" << text;
  return ::testing::AssertionSuccess() << "all of it is in\n" << text;
}

/// Whether a program has printed all of these texts.
inline ::testing::AssertionResult printed(const post::Outcome &outcome, const Texts &texts) {
  return contains(outcome.output, texts);
}

/// Whether a program has ended with status 1, and has printed all of these texts.
inline ::testing::AssertionResult fails_with(const post::Outcome &outcome, const Texts &texts) {
  if (outcome.status == 1) return printed(outcome, texts);
  return ::testing::AssertionFailure() << "status " << outcome.status << "\n" << outcome.output;
}

/// The message of an exception that a call throws; "no error" if it throws none.
template <class Error = std::runtime_error, class Call>
std::string error_of(const Call &call) {
  try {
    call();
  } catch (const Error &error) {
    return error.what();
  }
  return "no error";
}

/// Variables and further ones; engines take the first of a name.
inline post::Variables with(post::Variables variables, const post::Variables &more) {
  variables.insert(variables.end(), more.begin(), more.end());
  return variables;
}

} // namespace drumlin::test
