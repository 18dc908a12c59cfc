// The finished points of a study, as an interruption or a fault leaves them: what is whole counts, the rest is measured again.
#include "studies/study.h"

#include "support/files.h"
#include "support/usage_error.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

namespace fs = std::filesystem;
using namespace drumlin::post;

class Results : public ::testing::Test {
protected:
  Results() : file(fs::temp_directory_path() / fmt::format("drumlin-results-{}.csv", ::getpid())) {}
  ~Results() override {
    std::error_code ignored;
    fs::remove(file, ignored);
  }
  StudyResults read(const std::string &rows) const {
    std::ofstream(file, std::ios::binary) << "D,limit,command\n" << rows;
    return {file, {"D", "limit", "command"}, 1};
  }

  fs::path file;
};

TEST_F(Results, ForgetRowsWithoutANumber) {
  const StudyResults results = read("1,nan,x\n2,-nan,x\n3,NaN,x\n4,inf,x\n5,1.5,Fw nan\n6,nan(0x1),x\n7,2");
  ASSERT_EQ(results.rows().size(), 2u);
  EXPECT_EQ(results.find({"1"}), nullptr);
  EXPECT_TRUE(std::isinf(results.number(*results.find({"4"}), "limit")));
  EXPECT_EQ(results.number(*results.find({"5"}), "limit"), 1.5);
  EXPECT_EQ(read_text(file), "D,limit,command\n4,inf,x\n5,1.5,Fw nan\n");
}

TEST_F(Results, RefuseWordsForANumber) {
  const StudyResults results = read("1,much,x\n2,1.5e,x\n");
  for (const StudyResults::Row &row : results.rows())
    try {
      results.number(row, "limit");
      FAIL() << row[1];
    } catch (const UsageError &error) {
      EXPECT_NE(std::string(error.what()).find("limit is '" + row[1] + "'; allowed: "), std::string::npos)
          << error.what();
    }
}

} // namespace
