// The examples of all pages run.
#include "tests/support/engine_runs.h"
#include "physics/laws/laws.h"
#include "support/other_styles.h"

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

// The examples of the documentation run. A fenced block whose first line says `run` after the language is an
// example: ```liggghts run: lines of a deck, run in the host deck in.host; a pair_style or a property in it
// replaces the host's. ```lammps run: the same in host.lammps; not run where LAMMPS is not set up.
// ```liggghts deck, ```lammps deck: a complete deck, run as it is. ```sh run: a command line, run in a folder
// that has `inputs` and `build/release/lib` as the project's own.
//
// Command lines in indented blocks take too long or need things that a test does not have. A paragraph of the
// page that begins with "Not run by a test:" says why. Of these, the decks and variables of `./drumlin run`
// are still checked with the engine.

const fs::path root = DRUMLIN_SOURCE_DIR;

struct Example {
  std::string language;
  std::string text;
  std::size_t line; ///< of the page, where it begins
  bool is_deck;     ///< a complete deck
};

std::vector<Example> examples_of(const std::string &page) {
  std::vector<Example> examples;
  bool inside = false;
  bool wanted = false;
  std::size_t number = 0;
  for (const std::string &line : lines_of(page)) {
    ++number;
    if (line.rfind("```", 0) == 0) {
      inside = !inside;
      const std::vector<std::string> kinds = {"```liggghts run", "```lammps run", "```sh run",
                                              "```liggghts deck", "```lammps deck"};
      wanted = inside && std::find(kinds.begin(), kinds.end(), line) != kinds.end();
      const std::string language = wanted ? line.substr(3, line.find(' ') - 3) : "";
      const bool deck = line.find(" deck") != std::string::npos;
      if (wanted) examples.push_back({language, "", number, deck});
    } else if (inside && wanted) {
      examples.back().text += line + "\n";
    }
  }
  return examples;
}

/// Text under a heading, up to the next one of the same level.
std::string section(const std::string &page, const std::string &heading) {
  const std::size_t begin = page.find("\n## " + heading + "\n");
  return begin == std::string::npos ? "" : page.substr(begin + 1, page.find("\n## ", begin + 1) - begin);
}

/// Files that an example names as output.
std::vector<std::string> outputs_of(const std::string &text) {
  static const std::regex keyword(R"re((?:[ \t](?:file|cycles)|drumlin/record)[ \t]+([^ \t\n]+))re");
  std::vector<std::string> files;
  for (std::sregex_iterator i(text.begin(), text.end(), keyword), end; i != end; ++i) {
    const std::string file = (*i)[1].str(), folder = "${out}/"; // which is the working folder
    files.push_back(file.rfind(folder, 0) == 0 ? file.substr(folder.size()) : file);
  }
  return files;
}

Outcome run_example(const Example &example, const fs::path &folder) {
  if (example.language == "sh") {
    fs::create_directories(folder / "build/release");
    fs::create_directory_symlink(fs::path(plugin_library()).parent_path(), folder / "build/release/lib");
    fs::create_directory_symlink(fs::path(DRUMLIN_TOOLS).parent_path(), folder / "build/release/bin");
    fs::create_directory_symlink(root / "inputs", folder / "inputs");
    return run_program({"/bin/sh", "-ec", example.text}, mpi_environment(folder), folder, 120.0);
  }
  if (example.is_deck) {
    const fs::path deck = folder / (example.language == "lammps" ? "own.lammps" : "own.in");
    write_text(deck, example.text);
    return run_deck(deck, {}, folder);
  }
  fs::create_directory(folder / "results");
  fs::create_directory_symlink(root / "inputs", folder / "inputs");
  if (example.language == "lammps") return run_lammps_host(example.text, folder, 1);
  const bool own_pair_style = example.text.find("pair_style") != std::string::npos;
  return run_host((own_pair_style ? "" : host_pair_style()) + host_properties(example.text), example.text,
                  folder, 1);
}

class DocExamplesTest : public ::testing::TestWithParam<std::string> {};

TEST_P(DocExamplesTest, Run) {
  const std::string page = read_text(root / GetParam());
  const std::vector<Example> examples = examples_of(page);
  EXPECT_FALSE(examples.empty()) << GetParam() << " has no example that runs";
  for (const Example &example : examples) {
    SCOPED_TRACE(GetParam() + ", line " + std::to_string(example.line));
    if (example.language == "lammps" && !post::has_lammps()) {
      std::puts("SKIPPED: LAMMPS is not set up (./drumlin setup lammps)");
      continue;
    }
    const Scratch scratch;
    const Outcome outcome = well(run_example(example, scratch.path()));
    EXPECT_FALSE(outcome.says("ERROR")) << outcome.output;
    if (example.language != "sh")
      for (const std::string &file : outputs_of(example.text)) {
        std::error_code none;
        EXPECT_GT(fs::file_size(scratch / file, none), 0U) << file;
        EXPECT_FALSE(none) << file;
      }
    if (!example.is_deck || !contains(example.text, "roller/history")) continue;
    // The force of the equations of motion, from what the deck records, is that of its contacts.
    const Outcome found = well(run_program({DRUMLIN_TOOLS, "identify", "."}, {}, scratch.path()));
    EXPECT_TRUE(found.says("e-16 of its RMS")) << found.output;
  }
}

/// Every engine command's page has its parts, and its section Examples an example that runs.
TEST_P(DocExamplesTest, HaveTheirPlace) {
  static const std::vector<std::string> others =
      words_of("contact_laws.md drum_on_a_bed.md in_your_own_deck.md roller_columns.md stepping.md "
               "with_other_styles.md");
  const fs::path file = GetParam();
  if (file.parent_path() != "plugin/doc" ||
      std::find(others.begin(), others.end(), file.filename()) != others.end())
    return; // no command's page
  const std::string page = read_text(root / GetParam());
  for (const char *part :
       {"Syntax", "Examples", "Description", "Restart and output", "Restrictions", "Default", "Verification"})
    EXPECT_FALSE(section(page, part).empty()) << GetParam() << " has no section " << part;
  EXPECT_FALSE(examples_of(section(page, "Examples")).empty()) << GetParam();
}

/// The state at the end of a deck of "In your own deck".
std::string last_state(const std::string &deck, const std::string &name) {
  const Scratch scratch;
  write_text(scratch / name, deck);
  well(run_deck(scratch / name, {}, scratch.path()));
  const std::string text = read_text(scratch / "end.txt");
  return text.substr(text.rfind("ITEM: ATOMS"));
}

// The ball rolls at 5/7 of the speed at which it slid; the engine's own law gives the same to the last bit.
TEST(InYourOwnDeck, RollsAndIsTheEnginesOwnLaw) {
  for (const Example &example : examples_of(read_text(root / "plugin/doc/in_your_own_deck.md"))) {
    const bool lammps = example.language == "lammps";
    if ((lammps && !post::has_lammps()) || !contains(example.text, "end.txt")) continue;
    const std::string state = last_state(example.text, lammps ? "own.lammps" : "own.in");
    std::istringstream numbers(state.substr(state.find('\n') + 1));
    double id = 0, x = 0, y = 0, z = 0, vx = 0;
    numbers >> id >> x >> y >> z >> vx;
    EXPECT_NEAR(vx, 5.0 / 7.0, 1e-3) << example.language;
    if (lammps) continue;
    const std::string own =
        replaced(replaced(example.text, "hooke/transition", "hooke/stiffness"),
                 "transition B damping coefficient stepping stock", "limitForce on absolute_damping on");
    EXPECT_EQ(last_state(own, "own.in"), state);
  }
}

/// All pages of the project.
std::vector<fs::path> all_pages() {
  std::vector<fs::path> files = {root / "README.md", root / "ARCHITECTURE.md", root / "CHANGELOG.md"};
  for (const char *folder : {"inputs", "plugin", "postprocess"})
    for (const fs::directory_entry &entry : fs::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ".md") files.push_back(entry.path());
  return files;
}

/// The names by which links reach the headings of a page: small letters, without punctuation, blanks as
/// hyphens.
std::set<std::string> anchors_of(const std::string &page) {
  std::set<std::string> anchors;
  bool fenced = false;
  for (const std::string &line : lines_of(page)) {
    if (line.rfind("```", 0) == 0) fenced = !fenced;
    const std::size_t begin = line.find_first_not_of('#');
    if (fenced || begin == 0 || begin == std::string::npos || line[begin] != ' ') continue;
    std::string name;
    for (const char letter : line.substr(begin + 1))
      if (const auto c = static_cast<unsigned char>(letter); c == ' ')
        name += '-';
      else if (std::isalnum(c) != 0 || c == '-' || c == '_')
        name += static_cast<char>(std::tolower(c));
    anchors.insert(name);
  }
  return anchors;
}

// Links and pictures of every page are there, and the headings that links name.
TEST(DocPages, LinkToWhatIsThere) {
  static const std::regex link(R"re(\]\(([^)#:]*)(?:#([^)]*))?\))re");
  std::size_t links = 0, headings = 0;
  for (const fs::path &file : all_pages()) {
    const std::string page = read_text(file);
    for (std::sregex_iterator i(page.begin(), page.end(), link), end; i != end; ++i, ++links) {
      const std::string name = (*i)[1], heading = (*i)[2];
      const fs::path target = name.empty() ? file : file.parent_path() / name;
      ASSERT_TRUE(fs::exists(target)) << file << ": " << name;
      if (heading.empty()) continue;
      EXPECT_EQ(anchors_of(read_text(target)).count(heading), 1U) << file << ": " << name << "#" << heading;
      ++headings;
    }
  }
  EXPECT_GT(links, 200U);
  EXPECT_GT(headings, 20U);
}

// A README is read in five minutes.
TEST(DocPages, OfAFolderHaveAtMost1200Words) {
  std::size_t readmes = 0;
  for (const fs::path &file : all_pages()) {
    if (file.filename() != "README.md") continue;
    std::istringstream words(read_text(file));
    EXPECT_LE(std::distance(std::istream_iterator<std::string>(words), {}), 1200) << file;
    ++readmes;
  }
  EXPECT_GT(readmes, 7U);
}

/// The command lines in indented blocks of a page; one that ends with a backslash continues in the next line.
std::vector<std::string> indented_commands(const std::string &whole_page) {
  static const std::regex continued(R"re( *\\\n +)re");
  const std::string page = std::regex_replace(whole_page, continued, " ");
  static const std::regex command(
      R"re( {4}((?:\./drumlin|cmake|mpirun|pvpython|mpicxx|LD_PRELOAD=)[^#]*).*)re");
  std::vector<std::string> commands;
  bool fenced = false;
  for (const std::string &line : lines_of(page)) {
    if (line.rfind("```", 0) == 0) fenced = !fenced;
    if (std::smatch match; !fenced && std::regex_match(line, match, command))
      commands.push_back(match[1].str());
  }
  return commands;
}

// The pages of the plugin and of the decks say why a command line is not run.
TEST(DocPages, SayWhyCommandLinesAreNotRun) {
  for (const fs::path &file : all_pages()) {
    const std::string name = fs::relative(file, root).string();
    if (name.rfind("plugin/doc", 0) != 0 && name.rfind("inputs", 0) != 0) continue;
    const std::string page = read_text(file);
    const bool marked = page.find("\nNot run by a test: ") != std::string::npos;
    EXPECT_EQ(marked, !indented_commands(page).empty()) << name;
  }
}

/// Deck and variables of `./drumlin run [-np N] DECK [-var NAME VALUE ...]`.
std::pair<std::string, Variables> deck_of(const std::string &command) {
  std::istringstream words(command);
  std::string word;
  words >> word >> word; // ./drumlin run
  std::pair<std::string, Variables> result;
  while (words >> word)
    if (word == "-np")
      words >> word;
    else if (word == "-var") {
      std::string name, value;
      words >> name >> value;
      result.second.emplace_back(name, value);
    } else
      result.first = word;
  return result;
}

// A variable that no deck has is refused as the first: the deck is there, and has all the variables of the
// command line.
TEST(DocPages, RunDecksThatHaveTheirVariables) {
  std::size_t runs = 0;
  for (const fs::path &file : all_pages())
    for (const std::string &command : indented_commands(read_text(file))) {
      if (command.rfind("./drumlin run ", 0) != 0) continue;
      auto [deck, variables] = deck_of(command);
      if (deck.rfind("inputs/", 0) != 0) continue; // DECK, or one of the user
      if (fs::path(deck).extension() == ".lammps" && !post::has_lammps()) continue;
      variables.emplace_back("no_such_variable", "1");
      const Scratch scratch;
      EXPECT_TRUE(printed(run_deck(root / deck, variables, scratch.path()),
                          "drumlin/variables: -var no_such_variable is '1'"))
          << file << ": " << command << "\n";
      ++runs;
    }
  EXPECT_GT(runs, 10U);
}

std::vector<std::string> pages() {
  std::vector<std::string> names;
  for (const fs::directory_entry &entry : fs::directory_iterator(root / "plugin/doc"))
    if (entry.path().extension() == ".md" && entry.path().stem() != "README")
      names.push_back("plugin/doc/" + entry.path().filename().string());
  std::sort(names.begin(), names.end());
  for (const char *name :
       {"README.md", "inputs/benchmarks/README.md", "inputs/chain/README.md", "inputs/soil/README.md",
        "inputs/study/observations/findings.md", "postprocess/README.md", "postprocess/both_ends.md",
        "postprocess/identify.md", "postprocess/map.md", "postprocess/meter.md", "postprocess/record.md"})
    names.emplace_back(name);
  return names;
}

std::string page_name(const ::testing::TestParamInfo<std::string> &info) {
  std::string name = fs::path(info.param).replace_extension().string();
  if (const std::string folder = "plugin/doc/"; name.rfind(folder, 0) == 0) name.erase(0, folder.size());
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Pages, DocExamplesTest, ::testing::ValuesIn(pages()), page_name);

/// Names of the styles that a header's list adds: add(..., "NAME", "description").
std::vector<std::string> listed_styles(const fs::path &header) {
  static const std::regex entry(R"re(add\([^"]*"([a-z_/]+)")re");
  const std::string text = read_text(root / header);
  std::vector<std::string> names;
  for (std::sregex_iterator i(text.begin(), text.end(), entry), end; i != end; ++i)
    names.push_back((*i)[1].str());
  return names;
}

// A page for every contact law, fix and command that the plugin adds, and for those styles that one engine
// alone has.
TEST(DocPages, AreThereForEveryCommand) {
  std::vector<std::string> names = {"fix_wall_gran_transition", "pair_gran_model_hooke_transition", "preload",
                                    "lammps"};
  for_each_law([&](auto law) { names.push_back(std::string("pair_gran_") + decltype(law)::type::name); });
  for (const std::string &fix : listed_styles("plugin/fixes/fixes.h"))
    names.push_back("fix_" + fix);
  for (const std::string &command : listed_styles("plugin/commands/commands.h"))
    names.push_back(command);
  EXPECT_GE(names.size(), 6u + 7u + 9u);
  for (std::string &name : names) {
    std::replace(name.begin(), name.end(), '/', '_');
    EXPECT_TRUE(fs::exists(root / "plugin/doc" / (name + ".md"))) << name;
  }
}

// The page on other styles of the engines against the plugin's lists, and both against the engines that are
// installed.

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
