#include "tests/support/damaged_files.h"
#include "tests/support/lines.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

namespace drumlin::test {
namespace {

std::string joined(const std::vector<std::string> &lines) {
  std::string text;
  for (const std::string &line : lines)
    text += line + '\n';
  return text;
}

/// Begin and length of a word of the text, as commas, blanks, line ends and angle brackets part them.
std::pair<std::size_t, std::size_t> some_word(const std::string &text, Choice &choice) {
  constexpr const char *parting = ", \t\n<>\"=";
  const std::size_t begin = std::min(text.find_first_not_of(parting, choice.below(text.size())), text.size());
  return {begin, std::min(text.find_first_of(parting, begin), text.size()) - begin};
}

using Damage = std::function<std::string(std::string, Choice &)>;

std::string with_absurd_number(std::string text, Choice &choice) {
  static const std::vector<std::string> absurd = {"nan",
                                                  "-nan",
                                                  "NAN(1)",
                                                  "inf",
                                                  "-inf",
                                                  "1e308",
                                                  "-1e308",
                                                  "1e-308",
                                                  "5e-324",
                                                  "1e999",
                                                  "9.2e18",
                                                  "9223372036854775807",
                                                  "-9223372036854775808",
                                                  "18446744073709551616",
                                                  "1e18",
                                                  "1e9",
                                                  "2147483648",
                                                  "-1",
                                                  "0",
                                                  "-0",
                                                  "",
                                                  "0x10",
                                                  "1,5",
                                                  "1e",
                                                  "--1",
                                                  "\"",
                                                  "word",
                                                  "100%",
                                                  "{}",
                                                  "\xff\xfe",
                                                  std::string(5000, '9')};
  const auto [begin, length] = some_word(text, choice);
  return text.replace(begin, length, choice.of(absurd));
}

std::string with_words_swapped(std::string text, Choice &choice) {
  auto one = some_word(text, choice);
  auto other = some_word(text, choice);
  if (one.first > other.first) std::swap(one, other);
  if (one.first + one.second > other.first) return text; // the same word
  const std::string first = text.substr(one.first, one.second);
  const std::string second = text.substr(other.first, other.second);
  return text.replace(other.first, other.second, first).replace(one.first, one.second, second);
}

std::string with_bytes_changed(std::string text, Choice &choice) {
  for (std::size_t n = 1 + choice.below(8); n > 0 && !text.empty(); --n)
    text[choice.below(text.size())] = static_cast<char>(choice.below(256));
  return text;
}

std::string shuffled(const std::string &text, Choice &choice) {
  std::vector<std::string> lines = lines_of(text);
  for (std::size_t n = lines.size(); n > 1; --n) // the first line, a header, keeps its place half of the time
    std::swap(lines[n - 1], lines[choice.below(n)]);
  return joined(lines);
}

std::string with_rows_moved(const std::string &text, Choice &choice) {
  std::vector<std::string> lines = lines_of(text);
  if (lines.size() < 3) return text;
  const auto at = [&] {
    return lines.begin() + static_cast<std::ptrdiff_t>(1 + choice.below(lines.size() - 1));
  };
  switch (choice.below(4)) {
  case 0:
    lines.erase(at());
    break;
  case 1: {
    const std::string line = *at();
    lines.insert(at(), line);
    break;
  }
  case 2:
    std::iter_swap(at(), at());
    break;
  default:
    lines.insert(at(), "");
  }
  return joined(lines);
}

const std::vector<Damage> &ways_to_damage() {
  static const std::vector<Damage> ways = {
      with_absurd_number, // five times as often as the others: it gets farthest
      with_absurd_number,
      with_absurd_number,
      with_absurd_number,
      with_absurd_number,
      with_words_swapped,
      with_bytes_changed,
      shuffled,
      with_rows_moved,
      [](const std::string &text, Choice &choice) { return text.substr(0, choice.below(text.size())); },
      [](const std::string &text, Choice &choice) { return text.substr(choice.below(text.size())); },
      [](const std::string &text, Choice &) { return text + text; },
      [](const std::string &text, Choice &) {
        std::string other;
        for (const char c : text)
          other += c == '\n' ? std::string("\r\n") : std::string(1, c);
        return other;
      },
  };
  return ways;
}

} // namespace

std::string damaged(const std::string &text, Choice &choice) {
  return choice.of(ways_to_damage())(text, choice);
}

} // namespace drumlin::test
