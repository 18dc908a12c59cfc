// The finished points of a study, after an interruption or an error: complete rows are kept, the others are
// measured again.
#include "studies/study.h"

#include "support/files.h"
#include "support/usage_error.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using namespace drumlin::post;

struct Point {
  double D = 0.0, limit = 0.0;
  std::string command;
};
const CsvSchema<Point> &columns() {
  static const CsvSchema<Point> schema({csv_column("D", &Point::D), csv_column("limit", &Point::limit),
                                        csv_column("command", &Point::command)},
                                       1);
  return schema;
}

class Results : public ::testing::Test {
protected:
  Results() : file(fs::temp_directory_path() / fmt::format("drumlin-results-{}.csv", ::getpid())) {}
  ~Results() override {
    std::error_code ignored;
    fs::remove(file, ignored);
  }
  StudyResults open(const std::string &rows) const {
    std::ofstream(file, std::ios::binary) << "D,limit,command\n" << rows;
    return {file, columns()};
  }

  fs::path file;
};

TEST_F(Results, ForgetRowsWithoutANumber) {
  const StudyResults results =
      open("1,nan,x\n2,-nan,x\n3,NaN,x\n4,inf,x\n5,1.5,Fw nan\n6,nan(0x1),x\n8,2\n7,2,x");
  EXPECT_EQ(read_text(file), "D,limit,command\n4,inf,x\n5,1.5,Fw nan\n");
  for (const char *key : {"1", "2", "3", "6", "7", "8"})
    EXPECT_FALSE(results.has({key})) << key;
  for (const char *key : {"4", "5"})
    EXPECT_TRUE(results.has({key})) << key;
  const std::vector<Point> points = read_points(file, columns());
  ASSERT_EQ(points.size(), 2u);
  EXPECT_TRUE(std::isinf(points[0].limit));
  EXPECT_EQ(points[1].limit, 1.5);
  EXPECT_EQ(points[1].command, "Fw nan");
}

TEST_F(Results, ComeBackAsTheyWereAdded) {
  StudyResults results = open("");
  const Point point{0.1, 1.0 / 3.0, "a, \"b\""};
  results.add(columns().cells(point));
  EXPECT_TRUE(results.has({number_text(0.1)}));
  EXPECT_FALSE(results.has({"0.2"}));
  EXPECT_EQ(read_text(file), "D,limit,command\n0.10000000000000001,0.33333333333333331,\"a, \"\"b\"\"\"\n");
  const std::vector<Point> points = read_points(file, columns());
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].limit, point.limit);
  EXPECT_EQ(points[0].command, point.command);
  EXPECT_THROW(results.add({"1"}), std::logic_error);
}

TEST_F(Results, RefuseOtherColumns) {
  std::ofstream(file, std::ios::binary) << "D,command\n1,x\n";
  EXPECT_THROW((StudyResults{file, columns()}), UsageError);
  EXPECT_EQ(read_text(file), "D,command\n1,x\n");
}

TEST_F(Results, RefuseWordsForANumber) {
  for (const std::string word : {"much", "1.5e"}) {
    const StudyResults results = open("1," + word + ",x\n");
    try {
      read_points(file, columns());
      FAIL() << word;
    } catch (const std::runtime_error &error) {
      EXPECT_NE(std::string(error.what()).find("line 2, column 'limit' is '" + word + "'; allowed: a number"),
                std::string::npos)
          << error.what();
    }
  }
}

} // namespace
