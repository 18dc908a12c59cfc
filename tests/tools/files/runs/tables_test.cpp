// Readers of tables: the files of the chain, deck variables, measured records.
#include "tests/support/engine_runs.h"
#include "engine/deck_variables.h"
#include "support/measured_table.h"
#include "support/units.h"

#include <unistd.h>

namespace drumlin::test {
namespace {

// The CSV files: a file that is read back has the same bits; errors in a file are reported with file, line
// and column.
namespace chain_files {

namespace fs = std::filesystem;
using namespace drumlin::post;

class ChainCsv : public ::testing::Test {
protected:
  fs::path file(const std::string &name) const { return folder_ / name; }

  fs::path put(const std::string &text, const std::string &name = "file.csv") const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }

  static std::string get(const fs::path &path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  const Scratch scratch_;
  const fs::path folder_ = scratch_.path();
};

ChainHistory awkward_history() {
  const std::vector<double> awkward = {1.0 / 3.0, -0.0, 5e-324, 1.7976931348623157e308, -1e-300, 0.1};
  ChainHistory history;
  history.time = {0.0, 0.1, 0.2, 0.30000000000000004, 1e3, 1e300};
  history.x_drum = history.v_drum = history.a_drum = history.x_frame = history.v_frame = awkward;
  history.a_frame = history.F_contact = history.F_excitation = history.F_bond = awkward;
  history.v_drum[0] = 2.0 / 3.0;
  history.F_bond[0] = std::nextafter(1.0, 2.0);
  return history;
}

TEST_F(ChainCsv, HistoryComesBackBitForBit) {
  const ChainHistory written = awkward_history();
  write_files({{file("chain.csv"), chain_text(written)}});
  const ChainHistory read = read_chain(file("chain.csv"));
  for (const auto column :
       {&ChainHistory::time, &ChainHistory::x_drum, &ChainHistory::v_drum, &ChainHistory::a_drum,
        &ChainHistory::x_frame, &ChainHistory::v_frame, &ChainHistory::a_frame, &ChainHistory::F_contact,
        &ChainHistory::F_excitation, &ChainHistory::F_bond})
    EXPECT_EQ(read.*column, written.*column);
  EXPECT_TRUE(read.has_frame());
  EXPECT_EQ(files(), 1U);
}

TEST_F(ChainCsv, HeadersAreThoseThatScriptsUse) {
  const auto first_line = [](const std::string &text) { return text.substr(0, text.find('\n')); };
  EXPECT_EQ(first_line(chain_text(awkward_history())),
            "time,x_drum,v_drum,a_drum,x_frame,v_frame,a_frame,F_contact,F_excitation,F_bond");
  EXPECT_EQ(first_line(events_text({})), "time,event,overlap,overlap_rate,force,id_i,id_j");
  EXPECT_EQ(first_line(cycles_text({}))
                .rfind("cycle,time,a_drum_min,a_drum_max,F_contact_min,F_contact_max,contact_share", 0),
            0U);
  EXPECT_EQ(first_line(parameters_text({})), "name,value");
}

TEST_F(ChainCsv, ColumnsOfBothEndsStandAtTheEndAndComeBackAllTogether) {
  ChainHistory written = awkward_history();
  for (const HistoryColumn &column : history_columns)
    if (column.group == ColumnGroup::ends) written.*column.values = written.x_drum;
  written.a_left[1] = 3.0;
  const std::string text = chain_text(written);
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "time,x_drum,v_drum,a_drum,x_frame,v_frame,a_frame,F_contact,F_excitation,F_bond,theta_drum,"
            "omega_drum,theta_frame,omega_frame,a_left,a_right,F_left,F_right");
  const ChainHistory read = read_chain(put(text));
  EXPECT_TRUE(read.has(ColumnGroup::ends));
  EXPECT_EQ(read.a_left, written.a_left);
  EXPECT_EQ(read.F_right, written.F_right);
  EXPECT_EQ(error_of([&] {
              read_chain(put("time,x_drum,v_drum,a_drum,F_contact,a_left\n0,1,2,3,4,5\n"));
            }).find("theta_drum") != std::string::npos,
            true);
}

TEST_F(ChainCsv, EventsAndCyclesComeBack) {
  const std::vector<ContactEvent> events = {{1.0 / 3.0, true, 0.0, 0.5, 2e5, 1, 2},
                                            {0.5, false, 1e-3, -0.2, 0, 17, 4000000000}};
  write_files({{file("events.csv"), events_text(events)}});
  const std::vector<ContactEvent> read = read_events(file("events.csv"));
  ASSERT_EQ(read.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].time, events[i].time);
    EXPECT_EQ(read[i].make, events[i].make);
    EXPECT_EQ(read[i].overlap, events[i].overlap);
    EXPECT_EQ(read[i].overlap_rate, events[i].overlap_rate);
    EXPECT_EQ(read[i].force, events[i].force);
    EXPECT_EQ(read[i].id_i, events[i].id_i);
    EXPECT_EQ(read[i].id_j, events[i].id_j);
  }
  const std::vector<CycleSummary> cycles = {{1, 0.0, -1.0 / 3.0, 2, 0, 4, 0.5, 1, 2}};
  write_files({{file("cycles.csv"), cycles_text(cycles)}});
  const Table back = read_table(file("cycles.csv"));
  ASSERT_EQ(back.rows(), 1U);
  EXPECT_EQ(back.header(),
            (std::vector<std::string>{"cycle", "time", "a_drum_min", "a_drum_max", "F_contact_min",
                                      "F_contact_max", "contact_share", "makes", "breaks"}));
  EXPECT_EQ(back.numbers("cycle")[0], 1);
  EXPECT_EQ(back.numbers("a_drum_min")[0], -1.0 / 3.0);
  EXPECT_EQ(back.numbers("contact_share")[0], 0.5);
  EXPECT_EQ(back.text("makes")[0], "1");
  EXPECT_EQ(back.text("breaks")[0], "2");
  EXPECT_EQ(read_cycle_columns(file("cycles.csv")).at("a_drum_min")[0], -1.0 / 3.0);
}

TEST_F(ChainCsv, ParametersKeepAnyText) {
  const std::vector<std::pair<std::string, std::string>> written = {
      {"k", "1e8"},
      {"command", "drumlin exact --out \"a, b\""},
      {"note", "two\nlines, \"quoted\""},
      {"blank", ""},
      {"spaced", " x "}};
  write_files({{file("parameters.csv"), parameters_text(written)}});
  const auto read = read_parameters(file("parameters.csv"));
  ASSERT_EQ(read.size(), written.size());
  for (const auto &[name, value] : written)
    EXPECT_EQ(read.at(name), value);
}

TEST_F(ChainCsv, ColumnsAreFoundByName) {
  const ChainHistory history = read_chain(
      put("F_contact,extra,time, x_drum ,v_drum,a_drum\r\n10,word,0,+1,2,3\r\n\r\n11,\"a,b\",1,1e-3,2,3"));
  ASSERT_EQ(history.size(), 2U);
  EXPECT_EQ(history.F_contact, (std::vector<double>{10, 11}));
  EXPECT_EQ(history.x_drum, (std::vector<double>{1, 1e-3}));
  EXPECT_EQ(history.F_excitation, (std::vector<double>{0, 0}));
  EXPECT_FALSE(history.has_frame());
  EXPECT_TRUE(history.a_frame.empty());
  write_files({{file("again.csv"), chain_text(history)}});
  EXPECT_EQ(read_chain(file("again.csv")).x_drum, history.x_drum);
}

TEST_F(ChainCsv, MalformedFilesAreNamedWithLineAndColumn) {
  struct Malformed {
    std::string text;
    std::function<void(const fs::path &)> read;
    std::vector<std::string> said;
  };
  const auto chain = [](const fs::path &path) { read_chain(path); };
  const auto events = [](const fs::path &path) { read_events(path); };
  const auto cycles = [](const fs::path &path) { read_cycle_columns(path); };
  const auto parameters = [](const fs::path &path) { read_parameters(path); };
  const auto table = [](const fs::path &path) { read_table(path); };
  const std::string head = "time,x_drum,v_drum,a_drum,F_contact\n";
  const std::string event_head = "time,event,overlap,overlap_rate,force,id_i,id_j\n";
  const std::vector<Malformed> cases = {
      {"", chain, {"line 1", "empty"}},
      {"time,x_drum\n0,1\n", chain, {"line 1", "'v_drum'", "the header is 'time,x_drum'; allowed: "}},
      {"time,x_drum,v_drum,a_drum,F_contact,x_frame\n", chain, {"line 1", "'v_frame'"}},
      {head + "0,1,2,3,4\n1,1,word,3,4\n", chain, {"line 3", "'v_drum'", "'word'", "finite number"}},
      {head + "0,1,2,3,\n", chain, {"line 2", "'F_contact'", "'F_contact' is ''; allowed: a finite number"}},
      {head + "0,1,2,3,nan\n", chain, {"line 2", "'F_contact'", "'nan'"}},
      {head + "0,1,2,3,1e999\n", chain, {"line 2", "'1e999'"}},
      {head + "0,1,2,3,4x\n", chain, {"line 2", "'4x'"}},
      {head + "0,1,2,3\n", chain, {"line 2", "the number of cells is '4'; allowed: 5"}},
      {head + "0,1,2,3,4\n0,1,2,3,4\n", chain, {"line 3", "'time'", "is '0'; allowed: more than 0"}},
      {"time,time\n", table, {"line 1", "'time'", "twice"}},
      {"time,,x\n", table, {"line 1", "column 2", "no name"}},
      {"a,b\n1,\"open\n2,3\n", table, {"line 2", "never closed"}},
      {"a,b\n1,\"x\"y\n", table, {"line 2", "closing quote is 'y'; allowed: "}},
      {event_head + "0,made,0,0,0,1,2\n", events, {"line 2", "'event'", "'made'", "make, break"}},
      {event_head + "0,make,0,0,0,1.5,2\n", events, {"line 2", "'id_i'", "'1.5'", "whole number"}},
      {"cycle,a_drum_min\n1,0\n2,word\n", cycles, {"line 3", "'a_drum_min'", "'word'", "finite number"}},
      {"name,value\nk,1\nD,2\nk,3\n", parameters, {"line 4", "'name'", "is 'k'; allowed: each name once"}},
      {"nome,value\n", parameters, {"line 1", "'name'"}},
  };
  for (const Malformed &malformed : cases) {
    const fs::path path = put(malformed.text);
    const std::string what = error_of([&] { malformed.read(path); });
    EXPECT_EQ(what.rfind(path.string(), 0), 0U) << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    EXPECT_TRUE(contains(what, malformed.said));
  }
  EXPECT_THROW(read_chain(file("nowhere.csv")), std::runtime_error);
  EXPECT_THROW(read_chain(folder_), std::runtime_error);
}

TEST_F(ChainCsv, WritingIsAllOrNone) {
  put("old", "first.csv");
  fs::create_directory(file("second.csv")); // cannot be replaced by a file
  EXPECT_THROW(write_files({{file("first.csv"), "new"}, {file("second.csv"), "new"}}), std::runtime_error);
  EXPECT_EQ(get(file("first.csv")), "old");
  EXPECT_EQ(files(), 2U);
  EXPECT_THROW(write_files({{folder_ / "missing" / "events.csv", events_text({})}}), std::runtime_error);
  ChainHistory ragged = awkward_history();
  ragged.v_frame.pop_back();
  EXPECT_THROW(write_files({{file("first.csv"), chain_text(ragged)}}), std::invalid_argument);
  EXPECT_EQ(get(file("first.csv")), "old");
}

TEST_F(ChainCsv, NumbersAreWholeAndFinite) {
  EXPECT_EQ(number_from_text(" -1.5e3 "), -1500.0);
  EXPECT_EQ(number_from_text("+2"), 2.0);
  EXPECT_EQ(number_from_text("1."), 1.0);
  for (const char *text : {"", " ", "+", "+-1", "1,5", "0x10", "inf", "-nan", "1e400", "1 2", "ten"})
    EXPECT_THROW(number_from_text(text), std::invalid_argument) << text;
  EXPECT_EQ(number_from_text(number_text(0.1)), 0.1);
}

} // namespace chain_files

// The variables of a deck, read without the engine.
namespace deck_variables {

class DeckHelp : public ::testing::Test {
protected:
  void write(const char *name, const std::string &text) const { std::ofstream(scratch_ / name) << text; }
  std::string text(const std::map<std::string, std::string> &given = {}) const {
    return post::variables_text(post::deck_variables(scratch_ / "in.deck", given), 100);
  }
  /// "DEFAULT UNIT (RANGE)" of a variable, with one blank between words; empty: not listed.
  std::string line(const std::string &name, const std::map<std::string, std::string> &given = {}) const {
    std::istringstream lines(text(given));
    for (std::string one; std::getline(lines, one);) {
      std::istringstream words(one);
      std::string word, rest;
      if (one.rfind("  ", 0) != 0 || one.rfind("   ", 0) == 0 || !(words >> word) || word != name) continue;
      for (; words >> word;)
        rest += (rest.empty() ? "" : " ") + word;
      return rest;
    }
    return "";
  }
  const Scratch scratch_;
};

TEST_F(DeckHelp, ReadsDeclarationsWhereverTheyStand) {
  write("in.deck", "variable k index 2e8 # its own default\n"
                   "include ${here}/shared\n"
                   "drumlin/variable out results/v_2/rev_1 output_folder - run \"where # it goes\"\n"
                   "drumlin/variable note none noted - run \"of a file\"\n"
                   "drumlin/variable n $(2*v_k) \"integer 1 &\n  9\" - run \"a count &\n   of things\"\n");
  write("shared", "drumlin/variable k 1e8 positive N/m soil 'stiffness'\n"
                  "drumlin/variable case one \"suffix_of ${here}/case.\" - soil \"a case\"\n"
                  "include ${here}/case.${case}\n"
                  "drumlin/variable D 0.5 \"each non_negative\" 1 soil \"damping\"\n");
  write("case.one", "variable D index 0.1\n");
  write("case.two", "variable D index 0.2\n");
  EXPECT_EQ(line("k"), "2e8 N/m (> 0)");
  EXPECT_EQ(line("out"), "results/v_2/rev_1 (a folder)");
  EXPECT_EQ(line("note"), "");
  EXPECT_EQ(line("n"), "2*k (1 to 9)");
  EXPECT_EQ(line("case"), "one (one, two)");
  EXPECT_EQ(line("D"), "0.1 (>= 0, or a list)");
  EXPECT_EQ(line("D", {{"case", "two"}}), "0.2 (>= 0, or a list)");
  EXPECT_NE(text().find("where # it goes"), std::string::npos);
  EXPECT_NE(text().find("a count of things"), std::string::npos);
  EXPECT_LT(text().find("soil:"), text().find("run:")); // what every deck has stands last
}

TEST_F(DeckHelp, ReadsTables) {
  write("in.deck", "drumlin/variables ${here}/table scene\ninclude ${here}/case.${case}\n"
                   "drumlin/variables ${here}/table soil\ndrumlin/variables\n");
  write("table",
        "# name default unit rule group meaning\ncase one - \"suffix_of ${here}/case.\" scene a case\n"
        "k 1e8 N/m positive soil stiffness\nkt $(2/7*v_k) N/m positive soil of tangential springs\n"
        "speed 1 m/s positive way of another deck\n");
  write("case.one", "variable k index 2e8\n");
  EXPECT_EQ(line("case"), "one (one)");
  EXPECT_EQ(line("k"), "2e8 N/m (> 0)");
  EXPECT_EQ(line("kt"), "2/7*k N/m (> 0)");
  EXPECT_EQ(line("speed"), "");
}

TEST_F(DeckHelp, FollowsConditionsThatItKnows) {
  write("in.deck", "drumlin/variable dimension 2 \"one_of 2 3\" - run \"of the scene\"\n"
                   "if \"${dimension} == 3\" then \"variable k index 4e6\" else \"variable k index 5e6\"\n"
                   "variable with equal 0\n"
                   "variable same equal v_with\n"
                   "if \"${same} == 0\" then \"jump SELF behind\"\n"
                   "drumlin/variable hidden 1 any - run \"not declared\"\n"
                   "label behind\n"
                   "if \"$(step) > 0\" then \"jump SELF nowhere\"\n"
                   "drumlin/variable k 1e8 positive N/m run \"stiffness\"\n"
                   "label nowhere\n");
  EXPECT_EQ(line("k"), "5e6 N/m (> 0)");
  EXPECT_EQ(line("k", {{"dimension", "3"}}), "4e6 N/m (> 0)");
  EXPECT_EQ(line("hidden"), "");
}

TEST_F(DeckHelp, EndsWhenAFileIncludesItself) {
  write("in.deck", "include ${here}/in.deck\ninclude ${here}/in.deck\ninclude ${here}/missing\n"
                   "drumlin/variable k 1e8 positive N/m run \"stiffness\"\ndrumlin/variable too few words\n");
  EXPECT_EQ(line("k"), "1e8 N/m (> 0)");
}

} // namespace deck_variables

// Tables as loggers write them: the same numbers come back from every way of writing them, and what cannot be
// read is refused with the line and its cells.
namespace measured_table {

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

// A factor is that of the prefix times that of the unit.
TEST(Units, HaveTheFactorsOfTheirPrefixes) {
  int known = 0;
  for (const auto &[prefix, factor] : {std::pair("", 1.0), std::pair("u", 1e-6), std::pair("m", 1e-3),
                                       std::pair("c", 1e-2), std::pair("k", 1e3)})
    for (const auto &[name, of_unit] :
         {std::pair("s", 1.0), std::pair("m", 1.0), std::pair("m/s", 1.0), std::pair("m/s2", 1.0),
          std::pair("N", 1.0), std::pair("g", 9.80665)}) {
      const std::optional<post::Unit> unit = post::unit_from_text(prefix + std::string(name));
      if (!unit || std::string(unit->name) != prefix + std::string(name)) continue;
      EXPECT_NEAR(unit->factor, factor * of_unit, 1e-12 * factor) << unit->name;
      ++known;
    }
  EXPECT_EQ(known, 19);
  EXPECT_EQ(post::unit_from_text("MN")->factor, 1e6);
  EXPECT_EQ(post::unit_from_text("min")->factor, 60.0);
  EXPECT_EQ(post::unit_from_text("%")->factor, 0.01);
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
  // A first row of units without names: the columns keep their units.
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

} // namespace measured_table

} // namespace
} // namespace drumlin::test
