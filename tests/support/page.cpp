#include "tests/support/page.h"

#include "support/files.h"

#include <expat.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

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
