// Text from outside, such as names of folders and values of parameters.csv, converted for pages, shells and
// links.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace drumlin::post {

/// The text as valid UTF-8 without the code points that XML forbids: any other byte becomes U+FFFD, the
/// replacement character. Control characters stay.
std::string valid_utf8(const std::string &text);

/// The text without blanks, tabs and carriage returns at its ends.
std::string_view trimmed(std::string_view text);

/// The text with at most `letters` letters (5 or more): of a longer one the middle is replaced by an
/// ellipsis. Text in UTF-8.
std::string shortened(const std::string &text, std::size_t letters);

/// The text as one word of a shell's command line: unchanged if it has no character that a shell interprets,
/// else in single quotes.
std::string shell_word(const std::string &text);

/// A relative path as a link in a page: all but letters, digits, '/', '-', '_', '.' and '~' as %XX.
std::string link_to(const std::string &path);

} // namespace drumlin::post
