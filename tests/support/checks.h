// What tests ask of the output of programs and of texts, their lines and words, and how they put together the
// variables of a deck.
#pragma once

#include "tests/support/prelude.h"
#include "engine/deck_run.h"
#include "support/csv.h"

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

inline std::string as_text(double value) { return post::number_text(value); }
inline std::string as_text(const std::filesystem::path &file) { return file.string(); }
template <class Value>
std::string as_text(const Value &value) {
  if constexpr (std::is_integral_v<Value>)
    return std::to_string(value);
  else
    return std::string(value);
}

/// The parts of a text with `between` between them.
inline std::vector<std::string> parts_of(const std::string &text, const std::string &between) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t at = text.find(between); at != std::string::npos; at = text.find(between, begin)) {
    parts.push_back(text.substr(begin, at - begin));
    begin = at + between.size();
  }
  parts.push_back(text.substr(begin));
  return parts;
}

inline std::string replaced(std::string text, const std::string &what, const std::string &by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

/// The number behind the last occurrence of a mark.
inline double number_behind(const std::string &output, const std::string &mark) {
  const std::size_t found = output.rfind(mark);
  if (found == std::string::npos) throw std::runtime_error("no '" + mark + "' in\n" + output);
  return std::stod(output.substr(found + mark.size()));
}

inline std::size_t errors_in(const std::string &output) { return parts_of(output, "ERROR").size() - 1; }

/// Variables as the tables of tests have them, "NAME VALUE, NAME VALUE"; a VALUE {} is the next of `values`.
template <class... Values>
post::Variables given(const std::string &text, const Values &...values) {
  const std::vector<std::string> texts = {as_text(values)...};
  post::Variables variables;
  std::size_t next = 0;
  for (const std::string &pair : parts_of(text, ", ")) {
    const std::size_t blank = pair.find(' ');
    if (blank == std::string::npos) throw std::logic_error("no value in '" + pair + "'");
    const std::string value = pair.substr(blank + 1);
    variables.emplace_back(pair.substr(0, blank), value == "{}" ? texts.at(next++) : value);
  }
  if (next != texts.size()) throw std::logic_error("more values than {} in '" + text + "'");
  return variables;
}

/// Variables and further ones; engines take the first of a name.
inline post::Variables with(post::Variables variables, const post::Variables &more) {
  variables.insert(variables.end(), more.begin(), more.end());
  return variables;
}

/// The lines of a text, without their line ends. An empty text has none.
inline std::vector<std::string> lines_of(const std::string &text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    lines.push_back(line);
  return lines;
}

/// The words of a text, with white space between them; a word {} is the next of `values`.
template <class... Values>
std::vector<std::string> words_of(const std::string &text, const Values &...values) {
  const std::vector<std::string> texts = {as_text(values)...};
  std::vector<std::string> words;
  std::size_t next = 0;
  std::istringstream in(text);
  for (std::string word; in >> word;)
    words.push_back(word == "{}" && !texts.empty() ? texts.at(next++) : word);
  return words;
}

/// A command line of the tools, in such words.
template <class... Values>
std::vector<std::string> tool_words(const std::string &text, const Values &...values) {
  std::vector<std::string> words = words_of(text, values...);
  words.insert(words.begin(), DRUMLIN_TOOLS);
  return words;
}

/// Expects that the last line that a program has printed is an error, "ERROR: " followed by `start` and more,
/// and that no line before it is an error. Lines of progress may stand before it: a program prints them when
/// it has run for two seconds, which it does on a slow machine.
inline void expect_one_error(const std::string &output, const std::string &start) {
  const std::vector<std::string> lines = lines_of(output);
  for (std::size_t n = 0; n < lines.size(); ++n)
    EXPECT_EQ(lines[n].rfind("ERROR: ", 0) == 0, n + 1 == lines.size()) << output;
  if (lines.empty())
    ADD_FAILURE() << "nothing was printed";
  else
    EXPECT_EQ(lines.back().rfind("ERROR: " + start, 0), 0u) << output;
}

} // namespace drumlin::test
