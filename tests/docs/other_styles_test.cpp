// The page on other styles of the engines against the plugin's lists, and both against the engines that are
// installed.
#include "support/other_styles.h"

#include "tests/support/host_deck.h"
#include "tests/support/lines.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::test {
namespace {

using Verdicts =
    std::map<std::string, std::pair<std::string, std::string>>; // of `second` and `stock`, by fix

std::string word_of(Verdict verdict) {
  return verdict == Verdict::right ? "right" : verdict == Verdict::refused ? "refused" : "untried";
}

Verdicts of_the_plugin() {
  Verdicts all;
  for (const OtherFixes &fixes : other_fixes)
    for (const std::string &name : words_of(std::string(fixes.names)))
      EXPECT_TRUE(all.emplace(name, std::pair(word_of(fixes.second), word_of(fixes.stock))).second)
          << name << " twice";
  return all;
}

/// Names in the block below a heading.
std::vector<std::string> block(const std::string &page, const std::string &heading) {
  const std::size_t begin = page.find("```text\n", page.find("\n### " + heading + "\n"));
  return words_of(page.substr(begin + 8, page.find("```", begin + 8) - begin - 8));
}

/// Of the fixes that the page names; all others have not been tried.
Verdicts of_the_page() {
  const std::string page =
      read_text(std::filesystem::path(DRUMLIN_SOURCE_DIR) / "plugin/doc/with_other_styles.md");
  const std::vector<std::pair<std::string, Verdicts::mapped_type>> lists = {
      {"Right with both schemes", {"right", "right"}},
      {"Fixes that compute, store or write", {"right", "right"}},
      {"Fixes of the plugin", {"right", "right"}},
      {"Refused with second, right with stock", {"refused", "right"}},
      {"Refused with second, not tried with stock", {"refused", "untried"}},
      {"Refused with both schemes", {"refused", "refused"}}};
  Verdicts all;
  for (const auto &[heading, verdicts] : lists)
    for (const std::string &name : block(page, heading))
      EXPECT_TRUE(all.emplace(name, verdicts).second) << name << " twice";
  return all;
}

TEST(PageOnOtherStyles, HasTheListsOfThePlugin) {
  const Verdicts page = of_the_page(), plugin = of_the_plugin();
  const Verdicts::mapped_type untried = {"untried", "untried"};
  EXPECT_GT(page.size(), 100u);
  EXPECT_GT(plugin.size(), 300u);
  for (const auto &[name, verdicts] : plugin)
    EXPECT_EQ(page.count(name) == 0 ? untried : page.at(name), verdicts) << name;
  for (const auto &[name, verdicts] : page)
    EXPECT_EQ(plugin.count(name), 1u) << name;
}

/// The fixes that an engine lists when it is asked for help.
std::vector<std::string> fixes_of(const std::vector<std::string> &command) {
  const Scratch folder;
  const Outcome help = run_program(command, mpi_environment(folder.path()), folder.path(), 60.0);
  std::size_t begin = help.output.find("* Fix styles");
  EXPECT_NE(begin, std::string::npos) << help.output;
  begin = help.output.find('\n', begin);
  return words_of(help.output.substr(begin, help.output.find("* Compute styles", begin) - begin));
}

TEST(PageOnOtherStyles, HasTheFixesOfTheEngines) {
  std::vector<std::vector<std::string>> engines = {{"liggghts", "-h"}};
  if (post::has_lammps()) engines.push_back({LAMMPS_PROGRAM, "-h"});
  for (const std::vector<std::string> &engine : engines) {
    const std::vector<std::string> fixes = fixes_of(engine);
    EXPECT_GT(fixes.size(), 50u);
    for (const std::string &name : fixes)
      EXPECT_NE(other_fixes_with(name), nullptr) << engine.front() << ": " << name;
  }
}

} // namespace
} // namespace drumlin::test
