// What survives an interruption: complete rows of a table are kept, the others are measured again, and what
// is no table of the call is refused and left as it is. A folder of results takes one call at a time, and the
// same settings.
#include "support/resumed.h"

#include "support/usage_error.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using namespace drumlin::post;
using namespace drumlin::test;

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
  void write(const std::string &text) const { std::ofstream(file, std::ios::binary) << text; }
  ResumedTable open(const std::string &rows) const {
    write("D,limit,command\n" + rows);
    return {file, columns()};
  }

  drumlin::test::Scratch scratch;
  fs::path file = scratch / "results.csv";
};

TEST_F(Results, ForgetRowsWithoutANumber) {
  ResumedTable results = open("1,nan,x\n2,-nan,x\n3,NaN,x\n4,inf,x\n5,1.5,Fw nan\n6,nan(0x1),x\n7,2,x");
  EXPECT_EQ(read_text(file), "D,limit,command\n4,inf,x\n5,1.5,Fw nan\n");
  for (const char *key : {"1", "2", "3", "6", "7"})
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
  ResumedTable results = open("");
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

TEST_F(Results, RefuseWhatNoCallHasWritten) {
  for (const auto &[text, message] : std::vector<std::pair<std::string, std::string>>{
           {"D,command\n1,x\n", "the header of "},
           {"speed", "the header of "},
           {"D,limit,command\n1,2,x\n2,2\n3,2,x\n", "line 3: the number of cells is '2'; allowed: 3"},
           {"D,limit,command\n1,2,x,y\n", "line 2: the number of cells is '4'; allowed: 3"},
           {"D,limit,command\n1,2,x\n2,2,x\n1,2,x\n",
            "line 4, column 'D' is '1'; allowed: each once, or --fresh"}}) {
    write(text);
    const std::string fault = error_of([this] { ResumedTable(file, columns()); });
    EXPECT_TRUE(contains(fault, {message, "'; allowed: "}));
    EXPECT_EQ(read_text(file), text);
  }
}

TEST_F(Results, RefuseDoubledPointsWhereTheyAreOnlyRead) {
  write("D,limit,command\n1,2,x\n2,2,x\n1,3,y\n");
  EXPECT_TRUE(contains(error_of([this] { read_points(file, columns()); }),
                       "line 4, column 'D' is '1'; allowed: each once"));
}

TEST_F(Results, BeginAnewWhereTheHeaderIsCut) {
  const std::string header = "D,limit,command\n";
  for (std::size_t length = 0; length < header.size(); ++length) {
    write(header.substr(0, length));
    EXPECT_TRUE(read_points(file, columns()).empty());
    ResumedTable results(file, columns());
    EXPECT_FALSE(results.has({"1"}));
    EXPECT_EQ(read_text(file), header);
  }
}

TEST_F(Results, GetTheOrderOfTheCall) {
  ResumedTable results = open("3,1,c\n1,1,a\n");
  for (const char *key : {"1", "2", "3", "4"})
    results.has({key});
  results.add({"4", "1", "d"});
  results.add({"2", "1", "b"});
  results.finish();
  EXPECT_EQ(read_text(file), "D,limit,command\n1,1,a\n2,1,b\n3,1,c\n4,1,d\n");
}

TEST_F(Results, RefuseRowsOfAnotherCall) {
  ResumedTable results = open("1,1,a\n7,1,a\n");
  results.has({"1"});
  const std::string fault = error_of([&] { results.finish(); });
  EXPECT_TRUE(contains(fault, "line 3, column 'D' is '7'; allowed: a row of this call, or --fresh"));
  EXPECT_EQ(read_text(file), "D,limit,command\n1,1,a\n7,1,a\n");
}

TEST_F(Results, RefuseWordsForANumber) {
  for (const std::string word : {"much", "1.5e"}) {
    const ResumedTable results = open("1," + word + ",x\n");
    EXPECT_TRUE(contains(error_of([this] { read_points(file, columns()); }),
                         "line 2, column 'limit' is '" + word + "'; allowed: a number"));
  }
}

class Folder : public ::testing::Test {
protected:
  std::string open(const std::string &settings = "steps 3\n", bool fresh = false) const {
    return error_of([&] { ResumedFolder(out, "study", settings, fresh); });
  }
  void put(const std::string &name) const { std::ofstream(out / name) << "text"; }

  drumlin::test::Scratch scratch;
  fs::path out = scratch / "out";
};

TEST_F(Folder, IsContinuedWithTheSameSettings) {
  EXPECT_EQ(open(), "no error");
  put("rows.csv");
  EXPECT_EQ(open(), "no error");
  const std::string fault = open("steps 4\n");
  EXPECT_EQ(
      fault.find("--out is '" + out.string() + "'; allowed: the folder of a study with the same settings"),
      0U)
      << fault;
  EXPECT_TRUE(contains(fault, "(its study.txt has 'steps 3', this call 'steps 4')"));
  EXPECT_TRUE(contains(open(""), "has 'steps 3', this call '')"));
  EXPECT_TRUE(contains(open("steps 3\nquick\n"), "has '', this call 'quick')"));
  EXPECT_TRUE(fs::exists(out / "rows.csv"));
  EXPECT_EQ(open("steps 4\n", true), "no error");
  EXPECT_FALSE(fs::exists(out / "rows.csv"));
  EXPECT_EQ(open("steps 4\n"), "no error");
}

TEST_F(Folder, WithOtherFilesIsRefused) {
  fs::create_directory(out);
  put("thesis.txt");
  for (const bool fresh : {false, true})
    EXPECT_TRUE(contains(open("", fresh), "allowed: a folder that is new, empty or of an earlier study"));
  EXPECT_TRUE(fs::exists(out / "thesis.txt"));
}

TEST_F(Folder, TakesOneCallAtATime) {
  const ResumedFolder first(out, "study", "", false);
  put("rows.csv");
  for (const bool fresh : {false, true})
    EXPECT_TRUE(contains(open("", fresh),
                         "--out is '" + out.string() + "', into which another call writes; allowed: "));
  EXPECT_TRUE(fs::exists(out / "rows.csv"));
}

// Killed while it wrote its settings or a page.
TEST_F(Folder, IsClearedOfHalfWrittenFiles) {
  fs::create_directories(out);
  put("study.txt.tmp.123.0");
  EXPECT_EQ(open(), "no error");
  fs::create_directories(out / "data");
  put("data/rows.csv.tmp.77.3");
  put("notes.tmp");
  EXPECT_EQ(open(), "no error");
  EXPECT_FALSE(fs::exists(out / "study.txt.tmp.123.0"));
  EXPECT_FALSE(fs::exists(out / "data/rows.csv.tmp.77.3"));
  EXPECT_TRUE(fs::exists(out / "notes.tmp"));
}

TEST(Fingerprint, IsAnotherForAnotherText) {
  EXPECT_EQ(fingerprint(""), "cbf29ce484222325"); // the offset and a test vector of FNV-1a
  EXPECT_EQ(fingerprint("foobar"), "85944171f73967e8");
}

} // namespace
