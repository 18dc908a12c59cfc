#include "support/files.h"
#include "tests/support/scratch_study.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <fstream>
#include <sstream>
#include <utility>

namespace drumlin::test {

namespace fs = std::filesystem;

ScratchStudy::ScratchStudy(std::string name)
    : name_(std::move(name)),
      folder_(fs::temp_directory_path() / fmt::format("drumlin-{}-{}", name_, ::getpid())) {
  fs::create_directories(folder_);
}

ScratchStudy::~ScratchStudy() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

post::Outcome ScratchStudy::run() const {
  return post::run_program({DRUMLIN_TOOLS, "study", name_, "--quick", "--out", "out"}, {}, folder_, 200);
}

fs::path made_file(const fs::path &folder, const std::string &begin, const std::string &end) {
  fs::path found;
  for (const fs::directory_entry &entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(begin, 0) != 0 || entry.path().extension() != end) continue;
    EXPECT_TRUE(found.empty()) << found << " and " << entry.path();
    found = entry.path();
  }
  EXPECT_FALSE(found.empty()) << begin;
  return found;
}

void interrupt(const fs::path &file) {
  std::istringstream in(post::read_text(file));
  std::string line, kept;
  for (int row = 0; std::getline(in, line); ++row)
    if (row == 0 || row % 2 == 1) kept += line + '\n';
  kept.resize(kept.size() - 3);
  std::ofstream(file) << kept;
}

} // namespace drumlin::test
