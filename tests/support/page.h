// Reads a page as strict XML.
#pragma once

#include "tests/support/prelude.h"

namespace drumlin::test {

/// What a strict parser finds in a page.
struct Parsed {
  bool well_formed = false;
  std::string error;
  std::string last_element; ///< the last element that began, where an error is looked for
  std::vector<std::string> images;
  std::vector<std::string> links;
  std::vector<std::string> resources; ///< every other src, and what link, script, iframe and object load
  std::set<std::string> ids;
  std::size_t doubled_ids = 0;
  std::size_t scripts = 0;
  std::vector<std::string> contents; ///< links within nav
  std::size_t drawings = 0;          ///< svg elements
  bool in_nav = false;
};

Parsed parse(const std::string &text);

/// The prose of a page: headings, paragraphs, items of lists and captions, with # for each number and lines
/// of at most 110 letters.
std::string prose_of(const std::string &text);

/// The file that a link of a page leads to: %XX decoded, a place within the file left out.
std::string file_of(const std::string &link);

/// Expects a page in `out` to be strict XML with at least so many images, so many drawings of models, and a
/// file or an anchor for every link and image.
Parsed expect_sound_page(const std::filesystem::path &out, std::size_t images,
                         const std::string &file = "index.html", std::size_t drawings = 1);

} // namespace drumlin::test
