// The CSV files: a file that is read back has the same bits; errors in a file are reported with file, line
// and column.
#include "runs/chain_files.h"
#include "support/files.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

namespace drumlin::test {

namespace {

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

} // namespace

} // namespace drumlin::test
