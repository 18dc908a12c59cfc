// What the subcommands of drumlin refuse: tables of command lines, a file for each subcommand, each with the
// one line that the program must print. Nothing is written, and the files of its folder stay as they are.
#include "tests/refused/refusals.h"
#include "tests/support/engine_runs.h"
#include "tests/support/run_folders.h"
#include "support/process.h"

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

void make(const fs::path &folder, const std::string &kind) {
  if (kind == "chain")
    write_chain_run(folder, "II", post::Transition::B, 12);
  else if (kind == "impact")
    write_impact_run(folder, post::Transition::B, 0.5);
  else if (kind == "bed")
    write_bed_run(folder, post::Transition::B);
  else
    throw std::runtime_error("made is '" + kind + "'; allowed: chain, impact or bed");
}

std::map<fs::path, std::string> content(const fs::path &folder) {
  std::map<fs::path, std::string> files;
  for (const fs::directory_entry &entry : fs::recursive_directory_iterator(folder))
    files[entry.path()] = entry.is_directory() ? "" : read_text(entry.path());
  return files;
}

/// Splits a command line into words, as a shell does: single quotes keep blanks together, '' is an empty
/// word.
std::vector<std::string> words_of_row(const std::string &row) {
  std::vector<std::string> all = {DRUMLIN_TOOLS, ""};
  bool quoted = false;
  for (const char letter : row)
    if (letter == '\'')
      quoted = !quoted;
    else if (letter == ' ' && !quoted)
      all.emplace_back();
    else
      all.back() += letter;
  return all;
}

class RefusedTools : public ::testing::TestWithParam<std::string> {};

TEST_P(RefusedTools, InOneLine) {
  const bool rewriting = std::getenv("DRUMLIN_REWRITE") != nullptr;
  std::vector<Refusal> table = read_refusals(GetParam());
  EXPECT_FALSE(table.empty());
  if (rewriting)
    std::reverse(table.begin(), table.end()); // lines above a row that changes stay in their places
  for (const Refusal &refusal : table) {
    SCOPED_TRACE(refusal.place);
    const Scratch scratch;
    const fs::path folder = scratch / "folder";
    fs::create_directory(folder);
    for (const auto &[name, kind] : refusal.made)
      make(folder / name, kind);
    for (const auto &[name, text] : refusal.files) {
      fs::create_directories((folder / name).parent_path());
      std::ofstream(folder / name) << text;
    }
    const auto before = content(folder);
    post::Program program;
    program.words = words_of_row(refusal.lines);
    program.folder = folder;
    program.output = scratch / "screen.txt";
    program.limit = 100.0;
    const Outcome outcome = run_program(program);
    EXPECT_FALSE(outcome.timed_out);
    EXPECT_TRUE(content(folder) == before) << "files have changed";
    const std::vector<std::string> lines = lines_of(outcome.output);
    ASSERT_FALSE(lines.empty()) << "nothing was printed";
    if (rewriting && !says_so(refusal, lines.back())) {
      rewrite(refusal, lines.back());
      continue;
    }
    EXPECT_EQ(outcome.status, refusal.status) << outcome.output;
    expect_one_error(outcome.output, refusal.says.front());
    EXPECT_TRUE(says_so(refusal, lines.back()));
  }
}

INSTANTIATE_TEST_SUITE_P(, RefusedTools, ::testing::ValuesIn(refusal_tables({"tools"})), name_of_table);

} // namespace
} // namespace drumlin::test
