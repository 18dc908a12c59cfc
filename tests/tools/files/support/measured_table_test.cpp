// Tables as loggers write them: the same numbers come back from every way of writing them, and what cannot be
// read is refused with the line and its cells.
#include "support/measured_table.h"

#include "support/files.h"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;
using post::MeasuredTable;

class MeasuredTables : public ::testing::Test {
protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("drumlin-table-" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path put(const std::string &text) const {
    post::write_files({{folder_ / "t.csv", text}});
    return folder_ / "t.csv";
  }
  std::string message(const std::string &text) const {
    try {
      const MeasuredTable table(put(text));
      table.numbers(table.columns().size() - 1);
    } catch (const std::exception &error) {
      return error.what();
    }
    return "not refused";
  }

  fs::path folder_;
};

/// The values of the tests: column and row, some of them whole numbers, none with more than six digits.
double value(std::size_t row, std::size_t column) {
  const double turned = 0.37 * static_cast<double>(row + 1) * static_cast<double>(column + 1);
  return column == 0 ? 0.001 * static_cast<double>(row) : std::round(1e3 * std::sin(turned)) / 64.0;
}

std::string number(double number, char decimal) {
  std::string text = fmt::format("{}", number);
  for (char &letter : text)
    if (letter == '.') letter = decimal;
  return text;
}

std::string utf16(const std::string &text, bool low_first, bool mark) {
  std::string bytes = mark ? (low_first ? "\xFF\xFE" : "\xFE\xFF") : "";
  for (std::size_t i = 0; i < text.size(); ++i) { // ASCII, and one letter of two bytes
    unsigned code = static_cast<unsigned char>(text[i]);
    if (code >= 0xC0) code = ((code & 0x1F) << 6) | (static_cast<unsigned char>(text[++i]) & 0x3F);
    const char low = static_cast<char>(code & 0xFF), high = static_cast<char>(code >> 8);
    bytes += low_first ? std::string{low, high} : std::string{high, low};
  }
  return bytes;
}

enum class Units { none, in_header, below };

// Every separator with every decimal sign, line end, place of the units, encoding, and what stands around.
TEST_F(MeasuredTables, GiveTheSameNumbersHoweverTheyAreWritten) {
  constexpr std::size_t rows = 30, columns = 3;
  int tried = 0;
  for (const char separator : {',', ';', '\t', '|', ' '})
    for (const char decimal : {'.', ','})
      for (const char *ending : {"\n", "\r\n", "\r"})
        for (const Units units : {Units::none, Units::in_header, Units::below})
          for (const int around : {0, 1, 2, 3}) {
            if (separator == decimal) continue;
            const bool blanks = separator == ' '; // then a name has no blank
            const std::vector<std::string> names = {"Zeit", blanks ? "Acc_Z" : "Acc Z", "a\xC3\xA4"};
            const std::vector<std::string> of_units = {"ms", "m/s2", "g"};
            std::string text;
            const auto line = [&](const std::vector<std::string> &cells, bool trailing) {
              for (std::size_t i = 0; i < cells.size(); ++i)
                text += (i > 0 ? std::string(1, separator) : "") + cells[i];
              if (trailing) text += separator;
              text += ending;
            };
            if (around == 1) {
              line({"Logger", "7", ""}, true);
              line({"Rate [Hz]", "1000"}, false);
              text += ending;
            }
            if (around == 2) text += std::string("# measured on 26.11.2026, 1 of 3") + ending;
            std::vector<std::string> header = names;
            if (units == Units::in_header)
              for (std::size_t i = 0; i < columns; ++i)
                header[i] += (blanks ? "[" : " [") + of_units[i] + "]";
            line(header, false);
            if (units == Units::below) line(of_units, false);
            for (std::size_t row = 0; row < rows; ++row) {
              std::vector<std::string> cells;
              for (std::size_t column = 0; column < columns; ++column)
                cells.push_back(number(value(row, column), decimal));
              if (around == 3) cells[1] = '"' + cells[1] + '"';
              line(cells, around == 1 && !blanks);
            }
            for (const int encoding : {0, 1, 2, 3, 4}) {
              SCOPED_TRACE(fmt::format("'{}' '{}' units {} around {} encoding {}\n{}", separator, decimal,
                                       static_cast<int>(units), around, encoding, text));
              const std::string bytes = encoding == 0   ? text
                                        : encoding == 1 ? "\xEF\xBB\xBF" + text
                                                        : utf16(text, encoding != 3, encoding != 4);
              const MeasuredTable table(put(bytes));
              ASSERT_EQ(table.rows(), rows);
              for (std::size_t column = 0; column < columns; ++column) {
                ASSERT_EQ(table.find(names[column]), column) << table.words();
                ASSERT_EQ(table.columns()[column].unit, units == Units::none ? "" : of_units[column]);
                ASSERT_EQ(table.find(std::to_string(column + 1)), column);
                const std::vector<double> numbers = table.numbers(column);
                for (std::size_t row = 0; row < rows; ++row)
                  ASSERT_EQ(numbers[row], value(row, column));
              }
              ++tried;
            }
          }
  EXPECT_EQ(tried, 9 * 3 * 3 * 4 * 5);
}

TEST_F(MeasuredTables, ClockTimesGrowOverMidnightAndDays) {
  const auto times = [this](const std::vector<std::string> &cells) {
    std::string text = "t;a\n";
    for (const std::string &cell : cells)
      text += cell + ";1\n";
    const MeasuredTable table(put(text));
    EXPECT_TRUE(table.has_clock_times(0));
    post::ClockDays day;
    return table.clock_times(0, day);
  };
  const std::vector<double> over_midnight = {86399.5, 86400.25};
  EXPECT_EQ(times({"23:59:59.5", "00:00:00.25"}), over_midnight);
  EXPECT_EQ(times({"23:59:59,5", "0:00:00,25"}), over_midnight);
  EXPECT_EQ(times({"11:59:59.5 PM", "12:00:00.25 AM"}), over_midnight);
  for (const auto &[first, second] :
       {std::pair{"2024-02-29", "2024-03-01"}, std::pair{"31.12.2025", "01.01.2026"},
        std::pair{"2026/Nov/30", "2026/Dec/01"}})
    EXPECT_EQ(times({fmt::format("{} 23:59:59.5", first), fmt::format("{}T00:00:00.25", second)}),
              over_midnight);
}

TEST_F(MeasuredTables, BlankCellsAreNoNumbers) {
  const MeasuredTable table(put("t,a\n1,2\n2,\n3,NaN\n4,-\n5,-1"));
  const std::vector<double> a = table.numbers(1);
  ASSERT_EQ(a.size(), 5u);
  EXPECT_EQ(a.front(), 2.0);
  for (const std::size_t row : {1U, 2U, 3U})
    EXPECT_TRUE(std::isnan(a[row]));
  EXPECT_EQ(a.back(), -1.0);
}

// Names over empty cells at the end of all rows, and a unit that is not known.
TEST_F(MeasuredTables, HaveTheirHeaderWithAnEmptyLastColumn) {
  const MeasuredTable table(put("t,a,p,Comment\ns,g,bar,\n1,2,3,\n2,3,4,\n"));
  EXPECT_EQ(table.find("a"), 1U);
  EXPECT_EQ(table.columns().size(), 3U);
  EXPECT_EQ(table.columns()[1].unit, "g");
  EXPECT_EQ(table.columns()[2].unit, "bar");
  EXPECT_EQ(MeasuredTable(put("t,a (ft/s2)\n1,2\n2,3\n")).columns()[1].unit, "ft/s2");
}

TEST_F(MeasuredTables, LinesAtTheEndThatAreCutOrTextAreLeftOut) {
  EXPECT_EQ(MeasuredTable(put("t,a,b\n1,2,3\n2,3,4\n3,")).rows(), 2u);
  EXPECT_EQ(MeasuredTable(put("t,a,b\n1,2,3\n2,3,4\n\nEnd of file\nchecked, yes\n")).rows(), 2u);
  EXPECT_NE(message("t,a,b\n1,2,3\npause\n2,3,4\n").find("line 3: the number of cells is '1'"),
            std::string::npos);
  EXPECT_NE(message("t,a,b\n1,2,3\n2,3\n3,4,5\n").find("line 3: the number of cells is '2'; allowed: 3"),
            std::string::npos);
}

// Names, units and names of sensors below one another, in each order, over numbers of each kind.
TEST_F(MeasuredTables, HaveHeadersOfSeveralRows) {
  std::vector<std::string> rows = {"Zeit;Bandage;Rahmen", "ms;g;m/s2", "DAQ;10423;10424"};
  std::sort(rows.begin(), rows.end());
  do
    for (const char *above : {"", "Logger 7\n\n", "Logger;7;x\n"}) {
      const std::string text =
          fmt::format("{}{}\n{}\n{}\n1,5;2,5;-3,5\n2,5;3,5;4,5\n3,5;1,5;0,5\n4,5;-1,5;1,5\n", above, rows[0],
                      rows[1], rows[2]);
      SCOPED_TRACE(text);
      const MeasuredTable table(put(text));
      ASSERT_EQ(table.rows(), 4U);
      for (const auto &[name, place] :
           {std::pair{"Zeit", 0U}, std::pair{"Bandage", 1U}, std::pair{"Rahmen", 2U}, std::pair{"DAQ", 0U},
            std::pair{"10424", 2U}, std::pair{"2", 1U}})
        EXPECT_EQ(table.find(name), place) << name;
      EXPECT_EQ(table.columns()[0].unit, "ms");
      EXPECT_EQ(table.columns()[1].unit, "g");
      EXPECT_EQ(table.columns()[2].unit, "m/s2");
    }
  while (std::next_permutation(rows.begin(), rows.end()));
  // Numbers of sensors alone, below names with units.
  const MeasuredTable table(put("t [ms],a [g],b [g]\n1,2,3\n0.5,0.1,0.2\n1.0,0.3,0.1\n"));
  EXPECT_EQ(table.rows(), 2U);
  EXPECT_EQ(table.columns()[2].unit, "g");
  EXPECT_EQ(MeasuredTable(put("t,a,b\n1,2,3\n2,0.1,0.2\n3,0.3,0.1\n")).rows(), 3U); // no sensors
  // A row of units alone, which must not be lost.
  const MeasuredTable nameless(put("ms;g\n1;2\n2;3\n"));
  EXPECT_EQ(nameless.columns()[nameless.find("1").value()].unit, "ms");
  EXPECT_EQ(nameless.columns()[1].unit, "g");
}

TEST_F(MeasuredTables, FindNamesInAnyCaseUnlessTwoDifferInIt) {
  const MeasuredTable table(put("TIME;a_Drum [g]\n1;2\n2;3\n"));
  EXPECT_EQ(table.find("time"), 0U);
  EXPECT_EQ(table.find("a_drum"), 1U);
  const MeasuredTable two(put("a;A;B;b\n1;2;3;4\n2;3;4;5\n"));
  EXPECT_EQ(two.find("A"), 1U);
  EXPECT_EQ(MeasuredTable(put("Time;TIME\n1;2\n2;3\n")).find("time"), std::nullopt);
}

TEST_F(MeasuredTables, ReadNumbersAsOfficeProgramsWriteThem) {
  const std::vector<double> numbers = {1.25, 1234.5, -1234567.0, 0.125, 999.0};
  for (const char *text : {"t,a\n1,\"1,25\"\n2,\"1234,5\"\n3,\"-1234567,0\"\n4,\"0,125\"\n5,\"999,0\"\n",
                           "\"t\",\"a\"\r\n\"1,0\",\"1,25\"\r\n\"2,0\",\"1.234,5\"\r\n\"3,0\",\"-1.234."
                           "567\"\r\n\"4,0\",\"0,125\"\r\n"
                           "\"5,0\",\"999\"\r\n",
                           "t,a\n1,1.25\n2,\"1,234.5\"\n3,\"-1,234,567\"\n4,0.125\n5,999\n",
                           "t;a\n1;1.25\n2;1,234.5\n3;-1,234,567.00\n4;.125\n5;999\n",
                           "t;a\n1;1,25\n2;1.234,5\n3;-1.234.567\n4;0,125\n5;999\n",
                           "t\ta\n1\t1,25\n2\t1 234,5\n3\t-1 234 567\n4\t0,125\n5\t999\n",
                           "t;a\n1;1.25\n2;1'234.5\n3;-1'234'567\n4;0.125\n5;+999\n",
                           "t;a\n1;1,25\n2;1\xC2\xA0"
                           "234,5\n3;\xE2\x88\x92"
                           "1\xE2\x80\xAF"
                           "234\xE2\x80\xAF"
                           "567\n4;0,125\n5;999\xC2\xA0\n",
                           "t;a\n1;1,25E0\n2;12345E-1\n3;-1,234567e+06\n4;0,125\n5;999\n"}) {
    const MeasuredTable table(put(text));
    const std::size_t place = table.find("a").value();
    EXPECT_EQ(table.numbers(place), numbers) << text << table.words();
    EXPECT_EQ(table.numbers(0), (std::vector<double>{1, 2, 3, 4, 5})) << text;
  }
  for (const char *cell : {"1,2345.5", "12,34.5", "1,234'567.5", "0,234.5", "1,234,56.5", ",234.5"}) {
    const std::string text = fmt::format("t;a\n1;1.5\n2;{}\n3;2.5\n", cell);
    EXPECT_NE(message(text).find("line 3, column 'a' is"), std::string::npos) << message(text);
  }
  // 1250 or 1.25?
  for (const char *text : {"t;a\n1;750\n2;1.250\n3;2.500\n", "t;a\n1;750\n2;1,250\n3;2,500\n"})
    EXPECT_NE(message(text).find("line 3, column 'a' is '1"), std::string::npos) << message(text);
  EXPECT_EQ(message("t;a\n1;750,000\n2;1,250\n3;2,500\n"), "not refused");
  EXPECT_EQ(MeasuredTable(put("t;a\n1;750\n2;1,250\n"), {std::nullopt, ','}).numbers(1).back(), 1.25);
}

TEST_F(MeasuredTables, ClockTimesMayNameTheirZone) {
  const auto seconds = [this](const std::string &first, const std::string &second) {
    const MeasuredTable table(put(fmt::format("t;a\n{};1,5\n{};2,5\n", first, second)));
    EXPECT_TRUE(table.has_clock_times(0)) << first;
    post::ClockDays day;
    const std::vector<double> times = table.clock_times(0, day);
    return times.back() - times.front();
  };
  const std::string day = "2026-11-26";
  for (const char *zone : {"", "Z", "+01:00", "-0530", "+01", " UTC", " +0100"})
    EXPECT_EQ(seconds(day + "T14:03:07.25" + zone, day + "T14:03:08.50" + zone), 1.25) << zone;
  EXPECT_EQ(seconds("14:03:07.25Z", "14:03:08.50Z"), 1.25);
  EXPECT_EQ(seconds("23:59:59.5+01:00", "00:00:00.75+01:00"), 1.25);
  EXPECT_EQ(seconds(day + "T23:59:59.5-02:00", "2026-11-27T00:00:00,75-02:00"), 1.25);
  EXPECT_EQ(seconds(day + "T02:59:59.5+02:00", day + "T02:00:00.75+01:00"), 1.25); // the clocks go back
  EXPECT_EQ(seconds("14:03:07:250", "14:03:08:500"), 1.25);
  EXPECT_EQ(seconds("11/26/2026 14:03:07.25", "11/26/2026 14:03:08.5"), 1.25);
  EXPECT_EQ(seconds("26 Nov 2026 14:03:07.25", "26 Nov 2026 14:03:08.5"), 1.25);
  const MeasuredTable mixed(put("t;a\n14:03:07Z;1\n14:03:08;2\n14:03:09Z;3\n"));
  post::ClockDays first;
  EXPECT_THROW(mixed.clock_times(0, first), std::runtime_error);
}

TEST_F(MeasuredTables, ShowWhatTheyCannotRead) {
  const std::vector<std::pair<std::string, std::string>> table = {
      {"", "t.csv: the file is empty; allowed: a table of numbers"},
      {"name,place\nx,y\n", "no line has numbers; allowed: a table of numbers"},
      {"t;a\n1;2\n2;x\n3;4\n",
       "line 3, column 'a' is 'x'; allowed: a finite number with '.' as decimal sign, "
       "or no text; with ';' between cells the line '2;x' has the cells '2' 'x'"},
      {"t;a\n1;2\n2;inf\n3;4\n", "line 3, column 'a' is 'inf'; allowed: a finite number"},
      {"t;a\n1;2\n2;3;4\n3;4\n", "line 3: the number of cells is '3'; allowed: 2 as in line 2"},
      {"t;a\n1;2,5\n2;3.5\n3;4,5\n4;5,5\n", "line 3, column 'a' is '3.5'; allowed: a finite number with ','"},
  };
  for (const auto &[text, says] : table)
    EXPECT_NE(message(text).find(says), std::string::npos) << says << "\n" << message(text);
}

} // namespace
} // namespace drumlin::test
