#include "support/range.h"

#include <fmt/format.h>

namespace drumlin::post {

bool Range::holds(double value) const {
  if (zero_too && value == 0.0) return true;
  return (above ? value > least : value >= least) && (below ? value < most : value <= most);
}

std::string Range::words() const {
  std::string text = zero_too ? "0, or " : "";
  text += fmt::format("a number {} {:g} {} {:g}", above ? "above" : "from", least,
                      below ? "and below" : (above ? "up to" : "to"), most);
  if (*unit != '\0') text += fmt::format(" [{}]", unit);
  return text;
}

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 200;
  std::string shown(text.substr(0, longest));
  for (char &letter : shown)
    if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f) letter = '?';
  if (text.size() > longest) shown += fmt::format("... ({} characters)", text.size());
  return shown;
}

std::string refusal(std::string_view name, std::string_view value, std::string_view allowed) {
  return fmt::format("{} is '{}'; allowed: {}", name, shown(value), allowed);
}

std::string refusal(std::string_view name, double value, std::string_view allowed) {
  return refusal(name, fmt::format("{}", value), allowed);
}

} // namespace drumlin::post
