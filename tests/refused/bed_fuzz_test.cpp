// Damaged files given to the decks of the bed, as tests/tools/contracts/fuzz_test.cpp gives them to the
// tools: each deck ends within 20 s in a result or in one line of error, and leaves nothing half-written. The
// number of a mutant is the seed of its faults.
#include "tests/support/checks.h"
#include "tests/support/damaged_files.h"
#include "tests/support/host_deck.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;

struct BedFile {
  const char *name;
  const char *deck;
  const char *variable; ///< that names the file
  int mutants;
  Variables more;
};

void PrintTo(const BedFile &file, std::ostream *out) { *out << file.name; }

class BedFuzz : public ::testing::TestWithParam<BedFile> {
protected:
  static constexpr const char *result = "result.restart";

  static Outcome run(const char *deck, const char *variable, const fs::path &file, const Variables &more,
                     const fs::path &folder) {
    const Variables variables = with(more, {{variable, file.string()}});
    return post::run_deck(fs::path(DRUMLIN_SOURCE_DIR) / "inputs/bed" / deck, variables, folder, 1, 20.0);
  }

  /// A settled bed of 30 balls, its data file and the bed with its roller, by the names of BedFile.
  static void make(const Scratch &folder) {
    well(post::run_program({DRUMLIN_TOOLS, "bed", "--balls", "30", "--width", "0.3", "--out", "data"}, {},
                           folder.path(), 20.0));
    well(run("in.settle", "balls", folder / "data", {{"case", "loose"}, {"bed", "soil"}, {"ratio", "0.1"}},
             folder.path()));
    well(run("in.place", "bed", folder / "soil", placing(), folder.path()));
    fs::rename(folder / result, folder / "roller");
  }
  static Variables placing() {
    return {{"m2", "50"},   {"m3", "25"},   {"r2", "0.06"},    {"r3", "0.05"}, {"k23", "5e4"},
            {"c23", "500"}, {"ratio", "1"}, {"start", result}, {"sink", "0.1"}};
  }
};

TEST_P(BedFuzz, EndsInAResultOrInOneLine) {
  const Scratch sound;
  make(sound);
  const BedFile &file = GetParam();
  Variables more = file.more;
  if (std::string(file.deck) == "in.place") more = placing();
  int refused = 0;
  for (int mutant = 0; mutant < file.mutants; ++mutant) {
    const Scratch place;
    Choice choice(static_cast<unsigned>(mutant));
    write_text(place / file.name, damaged(read_text(sound / file.name), choice));
    const Outcome outcome = run(file.deck, file.variable, place / file.name, more, place.path());
    const std::vector<std::string> lines = lines_of(outcome.output);
    const auto errors = std::count_if(lines.begin(), lines.end(), [](const std::string &line) {
      return line.find("ERROR") != std::string::npos;
    });
    if (outcome.status != 0) ++refused;
    EXPECT_FALSE(outcome.timed_out) << mutant;
    EXPECT_TRUE(outcome.status == 0 || outcome.status == 1)
        << mutant << ": " << outcome.status << outcome.output;
    EXPECT_EQ(errors, outcome.status == 0 ? 0 : 1) << mutant << outcome.output;
    if (outcome.status == 0) continue;
    for (const auto &entry : fs::directory_iterator(place.path())) {
      const std::string name = entry.path().filename().string();
      EXPECT_TRUE(name == file.name || name == post::program_output_file) << mutant << " left " << name;
    }
  }
  EXPECT_GT(refused, file.mutants / 2);
}

INSTANTIATE_TEST_SUITE_P(
    Files, BedFuzz,
    ::testing::Values(
        BedFile{"data", "in.settle", "balls", 60, {{"bed", "result.restart"}, {"ratio", "1"}}},
        BedFile{"soil", "in.place", "bed", 12, {}},
        BedFile{"roller", "in.bed", "start", 12, {{"cycles", "1"}, {"Fw", "500"}, {"balance", "10"}}}),
    [](const ::testing::TestParamInfo<BedFile> &file) { return std::string(file.param.name); });

} // namespace
} // namespace drumlin::test
