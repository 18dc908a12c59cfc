#include "tests/support/page.h"
#include "tests/support/checks.h"
#include "support/files.h"

#include <expat.h>

namespace drumlin::test {

Parsed parse(const std::string &text) {
  Parsed out;
  XML_Parser parser = XML_ParserCreate("UTF-8");
  XML_SetUserData(parser, &out);
  XML_SetStartElementHandler(parser, [](void *data, const XML_Char *name, const XML_Char **attributes) {
    Parsed &page = *static_cast<Parsed *>(data);
    const std::string element = page.last_element = name;
    if (element == "script") ++page.scripts;
    if (element == "svg") ++page.drawings;
    if (element == "nav") page.in_nav = true;
    for (; *attributes != nullptr; attributes += 2) {
      const std::string attribute = attributes[0];
      const std::string value = attributes[1];
      if (attribute == "id" && !page.ids.insert(value).second) ++page.doubled_ids;
      if (element == "img" && attribute == "src")
        page.images.push_back(value);
      else if (element == "a" && attribute == "href")
        (page.in_nav ? page.contents : page.links).push_back(value);
      else if (attribute == "src" || attribute == "srcset" || attribute == "href" || attribute == "data")
        page.resources.push_back(value);
    }
  });
  XML_SetEndElementHandler(parser, [](void *data, const XML_Char *name) {
    if (std::string(name) == "nav") static_cast<Parsed *>(data)->in_nav = false;
  });
  out.well_formed = XML_Parse(parser, text.data(), static_cast<int>(text.size()), XML_TRUE) == XML_STATUS_OK;
  if (!out.well_formed)
    out.error =
        fmt::format("in or after '{}': {}", out.last_element, XML_ErrorString(XML_GetErrorCode(parser)));
  XML_ParserFree(parser);
  return out;
}

std::string prose_of(const std::string &text) {
  struct Prose {
    int inside = 0, left_out = 0; // elements
    std::string paragraph, all;
  } prose;
  static const auto is_block = [](const std::string &element) {
    static const std::set<std::string> blocks = {"h1", "h2", "h3", "p", "li", "figcaption"};
    return blocks.count(element) == 1;
  };
  static const auto is_left_out = [](const std::string &element) {
    static const std::set<std::string> all = {"nav", "table", "svg", "pre", "style"};
    return all.count(element) == 1;
  };
  XML_Parser parser = XML_ParserCreate("UTF-8");
  XML_SetUserData(parser, &prose);
  XML_SetStartElementHandler(parser, [](void *data, const XML_Char *name, const XML_Char **) {
    Prose &page = *static_cast<Prose *>(data);
    page.inside += is_block(name) ? 1 : 0;
    page.left_out += is_left_out(name) ? 1 : 0;
  });
  XML_SetCharacterDataHandler(parser, [](void *data, const XML_Char *letters, int count) {
    Prose &page = *static_cast<Prose *>(data);
    if (page.inside > 0 && page.left_out == 0)
      page.paragraph.append(letters, static_cast<std::size_t>(count));
  });
  XML_SetEndElementHandler(parser, [](void *data, const XML_Char *name) {
    Prose &page = *static_cast<Prose *>(data);
    page.left_out -= is_left_out(name) ? 1 : 0;
    if (!is_block(name)) return;
    --page.inside;
    static const std::regex number("[0-9]+([.][0-9]+)*(e[-+]?[0-9]+)?");
    std::string line;
    std::size_t column = 0;
    for (const std::string &word : words_of(std::regex_replace(page.paragraph, number, "#"))) {
      constexpr std::size_t longest = 110;
      const bool fits = column + 1 + word.size() <= longest;
      column = (fits ? column + 1 : 0) + word.size();
      line += (line.empty() ? "" : fits ? " " : "\n") + word;
    }
    if (!line.empty()) page.all += (page.all.empty() ? "" : "\n") + line + "\n";
    page.paragraph.clear();
  });
  EXPECT_EQ(XML_Parse(parser, text.data(), static_cast<int>(text.size()), XML_TRUE), XML_STATUS_OK);
  XML_ParserFree(parser);
  return prose.all;
}

std::string file_of(const std::string &link) {
  std::string file;
  for (std::size_t i = 0; i < link.size() && link[i] != '#' && link[i] != '?'; ++i) {
    const bool coded = link[i] == '%' && i + 2 < link.size();
    file += coded ? static_cast<char>(std::stoi(link.substr(i + 1, 2), nullptr, 16)) : link[i];
    if (coded) i += 2;
  }
  return file;
}

Parsed expect_sound_page(const std::filesystem::path &out, std::size_t images, const std::string &file,
                         std::size_t drawings) {
  Parsed page = parse(post::read_text(out / file));
  EXPECT_TRUE(page.well_formed) << page.error;
  EXPECT_EQ(page.doubled_ids, 0u);
  EXPECT_EQ(page.scripts, 0u);
  EXPECT_TRUE(page.resources.empty());
  EXPECT_GE(page.images.size(), images);
  EXPECT_EQ(page.drawings, drawings);
  EXPECT_GT(page.contents.size(), 1u);
  for (const std::vector<std::string> *links : {&page.images, &page.links, &page.contents})
    for (const std::string &link : *links)
      EXPECT_TRUE(link.front() == '#' ? page.ids.count(link.substr(1)) != 0
                                      : std::filesystem::is_regular_file(out / file_of(link)))
          << link;
  return page;
}

} // namespace drumlin::test
