#include "support/text.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace drumlin::post {

namespace {

bool is_one_of(char c, std::string_view others) {
  const bool letter_or_digit = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  return letter_or_digit || others.find(c) != std::string_view::npos;
}

/// Whether a byte of UTF-8 belongs to the letter that an earlier byte began.
bool continues(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

} // namespace

std::string valid_utf8(const std::string &text) {
  using nlohmann::json;
  std::string valid =
      json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
  // U+FFFE and U+FFFF are no letters, and XML forbids them.
  for (const char *none : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"})
    for (std::size_t at = valid.find(none); at != std::string::npos; at = valid.find(none, at))
      valid.replace(at, 3, "\xEF\xBF\xBD");
  return valid;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string shortened(const std::string &text, std::size_t letters) {
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (!continues(text[i])) begins.push_back(i);
  if (begins.size() <= letters) return text;
  const std::size_t head = letters / 2;
  const std::size_t tail = letters - 1 - head;
  return text.substr(0, begins[head]) + "…" + text.substr(begins[begins.size() - tail]);
}

std::string shell_word(const std::string &text) {
  const auto plain = [](char c) { return is_one_of(c, "_./=:,+-@%"); };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
  std::string word = "'";
  for (const char c : text)
    word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::string link_to(const std::string &path) {
  std::string link;
  for (const char c : path)
    link += is_one_of(c, "/-_.~") ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return link;
}

} // namespace drumlin::post
