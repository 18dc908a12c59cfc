// The prose of one page of each kind, as it was read and approved: the texts beside this file, with # for
// each number. The numbers are tested by the CSV files beside the pages. DRUMLIN_REWRITE=1 writes the texts
// anew, and git shows what has changed.
#include "support/files.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"
#include "tests/support/lines.h"
#include "tests/support/page.h"
#include "tests/support/run_folders.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

/// A page, made by a command in a folder with runs of the chain, of impacts and of beds.
struct Page {
  const char *name, *words, *file;
};

void PrintTo(const Page &page, std::ostream *out) { *out << page.name; }

class Prose : public ::testing::TestWithParam<Page> {};

TEST_P(Prose, IsAsItWasApproved) {
  const auto &[name, words, file] = GetParam();
  const Scratch scratch;
  write_chain_run(scratch / "II-A", "II", post::Transition::A, 12);
  write_chain_run(scratch / "II-B", "II", post::Transition::B, 12);
  write_impact_run(scratch / "impact", post::Transition::B, 0.5);
  write_bed_run(scratch / "bed-A", post::Transition::A);
  write_bed_run(scratch / "bed-B", post::Transition::B);
  write_bed_dumps(scratch / "bed-B");
  std::vector<std::string> all = words_of(words);
  all.insert(all.begin(), DRUMLIN_TOOLS);
  well(run_program(all, {}, scratch.path()));
  std::string page = read_text(scratch / file);
  const std::string here = scratch.path().string();
  for (std::size_t at = page.find(here); at != std::string::npos; at = page.find(here, at))
    page.replace(at, here.size(), "FOLDER");
  const std::string prose = prose_of(page);
  const fs::path approved = fs::path(DRUMLIN_SOURCE_DIR) / "tests/pages" / (std::string(name) + ".txt");
  if (std::getenv("DRUMLIN_REWRITE") != nullptr)
    std::ofstream(approved) << prose;
  else
    EXPECT_EQ(prose, read_text(approved));
}

INSTANTIATE_TEST_SUITE_P(
    , Prose,
    ::testing::Values(Page{"report", "report II-A II-B impact --out out", "out/index.html"},
                      Page{"bed", "report bed-A bed-B --out out", "out/bed.html"},
                      Page{"meter", "meter II-B --out out", "out/index.html"},
                      Page{"identify", "identify II-B --out out", "out/index.html"},
                      Page{"map", "map --x k:5e6:40e6:4 --y D:0.1:0.5:3 --out out", "out/index.html"}),
    [](const ::testing::TestParamInfo<Page> &page) { return std::string(page.param.name); });

} // namespace
} // namespace drumlin::test
