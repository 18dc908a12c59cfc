#include "tests/support/chain_by_cvode.h"
#include "tests/support/changing_roller.h"
#include "tests/support/engine_runs.h"
#include "chain/exact_solution.h"
#include "record/record.h"
#include "record/stretches.h"

namespace drumlin::test {
namespace {

// Measured records, and sensors at the end of their range.
// Records of runs and of measurements: what is read, in SI, and what is refused in one line.
namespace records {

namespace fs = std::filesystem;
using namespace drumlin::post;

constexpr double omega = 125.66370614359172;

class RecordFiles : public ::testing::Test {
protected:
  void SetUp() override {
    ExactOptions options;
    options.cycles = 6;
    options.samples_per_cycle = 100;
    history_ = drumlin::test::solve_by_cvode(table1_case("II", Transition::B), options).history;
  }

  fs::path put(const std::string &name, const std::string &text) const {
    write_files({{folder_ / name, text}});
    return folder_ / name;
  }
  /// The folder of the run of `history_`.
  fs::path put_run() const {
    put("chain.csv", chain_text(history_));
    put("parameters.csv", parameters_text(parameter_values(table1_case("II", Transition::B))));
    return folder_;
  }
  /// The message with which the run is refused after a change of its history.
  std::string refused(const std::function<void(ChainHistory &)> &change) {
    change(history_);
    return error_of<std::exception>([&] { read_record(put_run()); });
  }

  const Scratch scratch_;
  const fs::path folder_ = scratch_.path();
  ChainHistory history_;
};

void scale(std::vector<double> &values, double factor) {
  for (double &value : values)
    value *= factor;
}

TEST_F(RecordFiles, RunComesBackBitForBit) {
  const Record record = read_record(put_run());
  EXPECT_EQ(record.time, history_.time);
  EXPECT_EQ(record.x_drum, history_.x_drum);
  EXPECT_EQ(record.a_drum, history_.a_drum);
  EXPECT_EQ(record.a_frame, history_.a_frame);
  EXPECT_EQ(record.F_contact, history_.F_contact);
  EXPECT_EQ(record.F_excitation, history_.F_excitation);
  EXPECT_DOUBLE_EQ(record.interval, 0.0005);
  EXPECT_EQ(record.omega, omega);
  EXPECT_EQ(record.phase, 0.0);
  EXPECT_TRUE(record.known_origin);
  EXPECT_EQ(record.m2, 2000.0);
  EXPECT_EQ(record.m3, 1000.0);
  EXPECT_NEAR(record.cycles(), 6.0, 1e-9);
  EXPECT_TRUE(record.cycles_file.empty());
  put("cycles.csv", "cycle\n1\n");
  EXPECT_EQ(read_record(folder_).cycles_file, folder_ / "cycles.csv");
  EXPECT_TRUE(read_record(folder_ / "chain.csv").cycles_file.empty());
  EXPECT_TRUE(read_record(folder_ / "cycles.csv").time.empty());
}

TEST_F(RecordFiles, MeasuredColumnsAreConverted) {
  std::string text = "Time/ms,\"Acc, up\",Acc frame\n";
  for (std::size_t i = 0; i < history_.size(); ++i)
    text += csv_line({number_text(1e3 * history_.time[i]), number_text(-history_.a_drum[i] / 9.80665),
                      number_text(history_.a_frame[i])});
  RecordOptions options;
  options.columns.insert(column_from_text("time=Time/ms:ms"));
  options.columns.insert(column_from_text("a_drum=Acc, up:-g"));
  options.columns.insert(column_from_text("a_frame=Acc frame"));
  options.omega = omega;
  options.phase = 0.0;
  options.me_re = 58.8e3 / (omega * omega);
  const Record record = read_record(put("measured.csv", text), options);
  ASSERT_EQ(record.a_drum.size(), history_.size());
  EXPECT_TRUE(record.x_drum.empty());
  for (std::size_t i = 0; i < history_.size(); ++i) {
    EXPECT_NEAR(record.time[i], history_.time[i], 1e-12);
    EXPECT_NEAR(record.a_drum[i], history_.a_drum[i], 1e-12);
    EXPECT_EQ(record.a_frame[i], history_.a_frame[i]);
    EXPECT_NEAR(record.F_excitation[i], history_.F_excitation[i], 1e-6);
  }
}

TEST_F(RecordFiles, SamplingRateReplacesTimesOfFewDigits) {
  std::string text = "time,a_drum\n";
  for (std::size_t i = 0; i < history_.size(); ++i)
    text += csv_line({number_text(history_.time[i], 2), number_text(history_.a_drum[i])});
  const fs::path file = put("measured.csv", text);
  RecordOptions options;
  EXPECT_TRUE(contains(error_of<std::exception>([&] { read_record(file, options); }), "line"));
  std::string untimed = "a_drum\n";
  for (const double a : history_.a_drum)
    untimed += number_text(a) + "\n";
  const fs::path bare = put("bare.csv", untimed);
  EXPECT_TRUE(contains(error_of<std::exception>([&] { read_record(bare, options); }), "time"));
  options.sampling_rate = 2000.0;
  EXPECT_DOUBLE_EQ(read_record(bare, options).time[40], 0.02);
}

// The unit of the header counts where the command line gives none, and that of the command line before it.
TEST_F(RecordFiles, UnitsOfTheHeaderCount) {
  std::string text = "Messung;;;\nt;Acc;Rahmen;Text\nms;g;mm/s\xC2\xB2;\n";
  for (std::size_t i = 0; i < history_.size(); ++i)
    text += number_text(1e3 * history_.time[i]) + ";" + number_text(history_.a_drum[i] / 9.80665) + ";" +
            number_text(1e3 * history_.a_frame[i]) + ";ok\n";
  RecordOptions options;
  options.columns = {{"time", {"t"}}, {"a_drum", {"2"}}, {"a_frame", {"Rahmen"}}};
  const Record record = read_record(put("logger.csv", text), options);
  ASSERT_EQ(record.size(), history_.size());
  for (std::size_t i = 0; i < history_.size(); ++i) {
    EXPECT_NEAR(record.time[i], history_.time[i], 1e-12);
    EXPECT_NEAR(record.a_drum[i], history_.a_drum[i], 1e-12);
    EXPECT_NEAR(record.a_frame[i], history_.a_frame[i], 1e-12);
  }
  options.columns["a_drum"] = column_from_text("a_drum=Acc:-m/s2").second;
  EXPECT_NEAR(read_record(folder_ / "logger.csv", options).a_drum[7], -history_.a_drum[7] / 9.80665, 1e-12);
  options.columns["a_drum"] = {"Rahmen"};
  EXPECT_TRUE(contains(error_of<std::exception>([&] { read_record(folder_ / "logger.csv", options); }),
                       "column 'Rahmen': its use for a_frame is 'Rahmen'; allowed: a column of its own"));
  options.columns.erase("a_frame");
  options.columns.erase("time");
  options.sampling_rate = 2000.0;
  options.columns["a_drum"] = {"t"};
  EXPECT_TRUE(contains(error_of<std::exception>([&] { read_record(folder_ / "logger.csv", options); }),
                       "column 't': its unit is 'ms'; allowed: m/s2, "));
}

TEST_F(RecordFiles, SeveralFilesAreOneRecordAndGapsDivideIt) {
  const auto rows = [this](std::size_t first, std::size_t end, std::size_t blank) {
    std::string text = "time [s]\ta_drum [m/s2]\n";
    for (std::size_t i = first; i < end; ++i)
      text +=
          number_text(history_.time[i]) + "\t" + (i == blank ? "" : number_text(history_.a_drum[i])) + "\n";
    return text;
  };
  const std::size_t none = history_.size();
  const std::vector<fs::path> halves = {put("1.txt", rows(0, 300, none)),
                                        put("2.txt", rows(300, none, none))};
  const Record whole = read_record(halves);
  EXPECT_EQ(whole.time, history_.time);
  EXPECT_EQ(whole.a_drum, history_.a_drum);
  EXPECT_EQ(whole.pieces.size(), 1u);

  const std::vector<fs::path> divided = {put("1.txt", rows(0, 300, 200)),
                                         put("2.txt", rows(350, none, none))};
  const auto part = [this](const Record &record, std::size_t first, std::size_t end) {
    EXPECT_EQ(record.a_drum, std::vector<double>(history_.a_drum.begin() + static_cast<std::ptrdiff_t>(first),
                                                 history_.a_drum.begin() + static_cast<std::ptrdiff_t>(end)));
    EXPECT_EQ(record.time.front(), history_.time[first]);
    EXPECT_EQ(record.pieces.size(), 3u);
  };
  RecordOptions options;
  part(read_record(divided, options), 350, none); // the longest
  options.piece = 1;
  part(read_record(divided, options), 0, 200);
  options.piece = 2;
  part(read_record(divided, options), 201, 300);
  options.piece = 4;
  EXPECT_TRUE(contains(error_of<std::exception>([&] { read_record(divided, options); }),
                       "the piece is '4'; allowed: "));
  EXPECT_TRUE(contains(error_of<std::exception>([&] {
                         read_record({halves[1], halves[0]});
                       }),
                       "1.txt, line 2, column 'time [s]' is '0'"));
  put("2.txt", "time\tv_drum\n1\t2\n");
  EXPECT_TRUE(contains(error_of<std::exception>([&] { read_record(halves); }),
                       "2.txt: has not the same columns as "));
}

// A clock with the resolution of a second, and one with all digits that passes midnight.
TEST_F(RecordFiles, ClockTimesCountFromTheFirstRow) {
  const auto clock = [this](int digits) {
    std::string text = "time,a_drum\n";
    for (std::size_t i = 0; i < history_.size(); ++i) {
      const double t = 59.9 + history_.time[i];
      const double seconds =
          std::floor(std::fmod(t, 60.0) * std::pow(10.0, digits) + 1e-6) / std::pow(10.0, digits);
      text += fmt::format("{}:{:0{}.{}f},{}\n", t < 60.0 ? "23:59" : "00:00", seconds,
                          digits > 0 ? digits + 3 : 2, digits, number_text(history_.a_drum[i]));
    }
    return text;
  };
  const Record exact = read_record(put("clock.csv", clock(7)));
  EXPECT_NEAR(exact.interval, 0.0005, 1e-9);
  EXPECT_EQ(exact.time.front(), 0.0);
  EXPECT_EQ(exact.a_drum, history_.a_drum);
  // The logger begins a new file at midnight.
  const std::string all = clock(7);
  EXPECT_EQ(read_record(put("unit.csv", "time [hh:mm:ss]" + all.substr(all.find(',')))).time, exact.time);
  const std::size_t midnight = all.find("00:00:");
  const std::vector<fs::path> days = {put("first.csv", all.substr(0, midnight)),
                                      put("second.csv", "time,a_drum\n" + all.substr(midnight))};
  EXPECT_EQ(read_record(days).time, exact.time);
  EXPECT_EQ(read_record(days).a_drum, exact.a_drum);
  EXPECT_TRUE(
      contains(error_of<std::exception>([&] {
                 read_record({days[0], days[0]});
               }),
               {"first.csv, line 2, column 'time' is '23:59:59.9", "a later time than in the row before"}));
  RecordOptions options;
  EXPECT_TRUE(
      contains(error_of<std::exception>([&] { read_record(put("clock.csv", clock(0))); }), "sampling rate"));
  options.sampling_rate = 2000.0;
  EXPECT_EQ(read_record(put("clock.csv", clock(0)), options).a_drum, history_.a_drum);
}

// Of a file whose exciter changes the longest stretch is read, another one by its number, and the rest is
// told.
TEST_F(RecordFiles, AChangeOfTheExciterDividesIt) {
  ChangingRoller roller;
  roller.me_re = [](double t) { return t < 1.0 || t > 11.0 ? 0.0 : t < 7.0 ? 7.38 : 3.95; };
  const SeenMotion seen = seen_motion(roller, 1000.0, 12.0, 0.1, 1);
  std::string text = "time,a_drum\n";
  for (std::size_t i = 0; i < seen.time.size(); ++i)
    text += csv_line({number_text(seen.time[i]), number_text(seen.a_drum[i])});
  const fs::path file = put("pass.csv", text);
  RecordOptions options;
  options.omega = 62.0 * M_PI;
  const Record longest = read_record(file, options);
  ASSERT_EQ(longest.pieces.size(), 2u);
  EXPECT_NEAR(longest.time.front(), 1.0, 0.3);
  EXPECT_NEAR(longest.time.back(), 7.0, 0.3);
  EXPECT_NEAR(longest.pieces[0].frequency, 31.0, 0.05);
  EXPECT_TRUE(contains(longest.part_read, {"it is piece 1 of 2", "--piece takes another: 2, "}));
  EXPECT_EQ(longest.notes.back(), longest.part_read);
  options.piece = 2;
  EXPECT_NEAR(read_record(file, options).time.front(), 7.0, 0.5);
  options.omega.reset(); // nothing says what to look for
  options.piece.reset();
  EXPECT_EQ(read_record(file, options).size(), seen.time.size());
  std::string off = "time,a_drum\n";
  for (std::size_t i = 0; i < 900; ++i)
    off += csv_line({number_text(seen.time[i]), number_text(seen.a_drum[i])});
  options.omega = 62.0 * M_PI;
  EXPECT_TRUE(contains(error_of<std::exception>([&] { read_record(put("off.csv", off), options); }),
                       "the line of the exciter is 'nowhere a part of the motion near 31 Hz'"));
}

// Stamps that scatter around equally spaced samples, as those of loggers do.
TEST_F(RecordFiles, TimesMayScatter) {
  const auto read = [this](double scatter) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0.0, scatter);
    std::string text = "time,a_drum\n";
    for (std::size_t i = 0; i < history_.size(); ++i)
      text +=
          fmt::format("{:.12f},{:.12g}\n", history_.time[i] + 0.0005 * normal(random), history_.a_drum[i]);
    return read_record(put("logger.csv", text));
  };
  EXPECT_TRUE(contains(read(0.001).notes.back(), "in SI units"));
  const Record record = read(0.005);
  EXPECT_TRUE(contains(record.notes.back(), "the times scatter by 0.5"));
  EXPECT_NEAR(record.interval, 0.0005, 1e-5 * 0.0005);
  ASSERT_EQ(record.size(), history_.size());
  for (std::size_t i = 0; i < record.size(); ++i)
    EXPECT_NEAR(record.time[i], history_.time[i], 1e-3 * 0.0005);
  EXPECT_EQ(record.a_drum.size(), record.size());
  EXPECT_TRUE(contains(error_of<std::exception>([&] { read(0.1); }), "equal steps of "));
}

TEST_F(RecordFiles, RefusesTimes) {
  EXPECT_TRUE(contains(refused([](ChainHistory &h) { h.time[7] = h.time[6]; }),
                       "chain.csv, line 9, column 'time' is "));
  SetUp();
  const std::string gap = refused([](ChainHistory &h) {
    for (std::size_t i = 50; i < h.time.size(); ++i)
      h.time[i] += 0.01;
  });
  EXPECT_TRUE(contains(gap, {"line 52", "without a gap"}));
  SetUp();
  const std::string unequal = refused([](ChainHistory &h) { h.time[9] += 0.2 * 0.0005; });
  EXPECT_TRUE(contains(unequal, "equal steps"));
}

TEST_F(RecordFiles, RefusesUnitsAndSigns) {
  const auto names = [this](const char *column, const std::function<void(ChainHistory &)> &change) {
    SetUp();
    const std::string text = refused(change);
    return text.find(std::string("column '") + column + "' is '") != std::string::npos &&
           text.find("; allowed: ") != std::string::npos;
  };
  EXPECT_TRUE(names("v_drum", [](ChainHistory &h) { scale(h.x_drum, 1e3); }));
  EXPECT_TRUE(names("v_drum", [](ChainHistory &h) { scale(h.v_drum, -1.0); }));
  EXPECT_TRUE(names("a_drum", [](ChainHistory &h) { scale(h.a_drum, 1.0 / 9.81); }));
  EXPECT_TRUE(names("a_frame", [](ChainHistory &h) { scale(h.a_frame, -1.0); }));
  EXPECT_TRUE(names("F_contact", [](ChainHistory &h) { scale(h.F_contact, 1e-3); }));
  EXPECT_TRUE(names("F_contact", [](ChainHistory &h) { scale(h.F_contact, -1.0); }));
  EXPECT_TRUE(names("F_contact", [](ChainHistory &h) { scale(h.F_contact, 0.0); }));
  EXPECT_TRUE(names("a_drum", [](ChainHistory &h) {
    for (auto *values : {&h.x_drum, &h.v_drum, &h.a_drum})
      scale(*values, -1.0);
  }));
}

TEST_F(RecordFiles, RefusesShortAndCoarseRecords) {
  const std::string text = refused([](ChainHistory &h) {
    for (auto *values : {&h.time, &h.x_drum, &h.v_drum, &h.a_drum, &h.x_frame, &h.v_frame, &h.a_frame,
                         &h.F_contact, &h.F_excitation, &h.F_bond})
      values->resize(400);
  });
  EXPECT_TRUE(contains(text, "the number of cycles is '3.99'"));
  RecordOptions options;
  options.omega = 20 * omega;
  SetUp();
  const std::string coarse = error_of<std::exception>([&] { read_record(put_run(), options); });
  EXPECT_TRUE(contains(coarse, "samples per cycle is '5'"));
}

TEST_F(RecordFiles, RefusesColumns) {
  const fs::path file = put("other.csv", "time,b\n0,1\n1,2\n2,3\n");
  EXPECT_TRUE(contains(error_of<std::exception>([&] { read_record(file); }), "no column of motion or force"));
  EXPECT_TRUE(contains(error_of<std::exception>([&] { read_record(folder_); }), "the record is '"));
  RecordOptions options;
  options.columns.insert(column_from_text("a_drum=c"));
  EXPECT_TRUE(contains(error_of<std::exception>([&] { read_record(file, options); }), "'c'"));
  for (const char *text : {"a_drum", "a=b", "a_drum=", "a_drum=b:kN", "time=b:-s", "a_drum=b:"})
    EXPECT_THROW(column_from_text(text), std::invalid_argument) << text;
}

TEST(Record, KeepsTheSameSamplesOfAllThatItHas) {
  std::vector<std::vector<double> Record::*> columns = {&Record::wander, &Record::pulse, &Record::logged_drum,
                                                        &Record::logged_frame};
  for (const HistoryColumn &column : history_columns)
    if (column.values != &ChainHistory::F_bond) columns.emplace_back(column.values);
  Record record;
  for (const auto column : columns)
    record.*column = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0};
  keep_samples(record, 2, 5);
  for (const auto column : columns)
    EXPECT_EQ(record.*column, (std::vector<double>{2.0, 3.0, 4.0}));
  EXPECT_TRUE(record.F_bond.empty());
}

// What comes late is moved back, the drum's samples as they are, with the times.
TEST_F(RecordFiles, UndoesDelays) {
  constexpr double dt = 1e-3, late_drum = 1.3e-3, late_frame = 4.15e-3, w = 180.0;
  std::string text = "time,a_drum,a_frame\n";
  for (int i = 0; i < 400; ++i)
    text += fmt::format("{:.6f},{:.9f},{:.9f}\n", i * dt, std::sin(w * (i * dt - late_drum)),
                        std::sin(w * (i * dt - late_frame) + 1.0));
  const fs::path file = put("late.csv", text);
  RecordOptions options;
  options.delays.insert(delay_from_text("a_drum=1.3ms"));
  options.delays.insert(delay_from_text("a_frame=0.00415"));
  const Record record = read_record(file, options);
  EXPECT_GT(record.size(), 390U);
  for (std::size_t i = 0; i < record.size(); ++i) {
    ASSERT_NEAR(record.a_drum[i], std::sin(w * record.time[i]), 1e-8);
    ASSERT_NEAR(record.a_frame[i], std::sin(w * record.time[i] + 1.0), 1e-4);
  }
  options.delays = {{"x_frame", 1e-3}};
  EXPECT_TRUE(
      contains(error_of<std::exception>([&] { read_record(file, options); }), "the delay of x_frame"));
  for (const char *wrong : {"a_drum", "a_drum=", "b=1", "time=1ms", "a_drum=1m", "a_drum=2", "a_drum=nan"})
    EXPECT_THROW(delay_from_text(wrong), std::invalid_argument) << wrong;
}

// The closed form of a filter of first order: amplitude, phase, and what is left of a constant that it was
// switched on with.
TEST(HighPass, IsUndone) {
  constexpr double dt = 5e-4, w = 184.0;
  for (const double corner : {0.5, 3.0, 10.0}) {
    const double c = 2.0 * M_PI * corner, gain = w / std::hypot(w, c), lead = std::atan2(c, w);
    std::vector<double> values;
    values.reserve(8000);
    for (int i = 0; i < 8000; ++i)
      values.push_back(gain * std::sin(w * i * dt + lead) + 9.81 * std::exp(-c * i * dt));
    const std::vector<double> whole = without_high_pass(values, dt, corner, w);
    for (std::size_t i = 0; i < whole.size(); ++i)
      ASSERT_NEAR(whole[i], std::sin(w * static_cast<double>(i) * dt), 0.01) << corner << ' ' << i;
  }
}

TEST(LowPass, HalvesAtTheCutOffAndKeepsPhase) {
  // Forward and back, the gain is that of the analogue filter at the frequency that the bilinear transform
  // puts in its place, squared.
  const double interval = 1e-3;
  const double cutoff = 50.0;
  for (const double frequency : {5.0, 20.0, 50.0, 120.0}) {
    std::vector<double> values;
    values.reserve(4000);
    for (int i = 0; i < 4000; ++i)
      values.push_back(std::sin(2.0 * M_PI * frequency * i * interval));
    const std::vector<double> filtered = low_passed(values, interval, cutoff);
    const double ratio = std::tan(M_PI * frequency * interval) / std::tan(M_PI * cutoff * interval);
    const double gain = 1.0 / (1.0 + std::pow(ratio, 4));
    EXPECT_DOUBLE_EQ(low_pass_gain(frequency, interval, cutoff), gain);
    for (int i = 1000; i < 3000; ++i)
      ASSERT_NEAR(filtered[static_cast<std::size_t>(i)], gain * values[static_cast<std::size_t>(i)], 1e-9);
  }
}

} // namespace records

// Sensors that reach the end of their range, found by how their values are distributed.
namespace ranges {

using namespace post;

std::vector<double> with_noise(std::vector<double> values, double level) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, level);
  for (double &value : values)
    value += normal(random);
  return values;
}

/// In the steps of a sensor.
std::vector<double> in_steps(std::vector<double> values, double step) {
  for (double &value : values)
    value = step * std::round(value / step);
  return values;
}

SeenMotion motion(double k, double rate) {
  ChangingRoller roller;
  roller.k = [k](double) { return k; };
  roller.frequency = [](double) { return 30.7; };
  return seen_motion(roller, rate, 5.0, 0.0, 1);
}

// A share of the samples beyond the limit, at both ends or at one, with noise before or behind it.
TEST(SensorRange, IsReached) {
  for (const double rate : {500.0, 1000.0, 5000.0})
    for (const double k : {20e6, 45e6, 130e6}) {
      const std::vector<double> a = motion(k, rate).a_drum;
      std::vector<double> sorted = a, sizes;
      std::sort(sorted.begin(), sorted.end());
      for (const double value : a)
        sizes.push_back(std::fabs(value));
      std::sort(sizes.begin(), sizes.end());
      for (const double share : {0.1, 0.3, 0.5}) {
        SCOPED_TRACE("rate " + std::to_string(rate) + ", k " + std::to_string(k) + ", share " +
                     std::to_string(share));
        const auto place = static_cast<std::size_t>((1.0 - share) * static_cast<double>(a.size()));
        const auto cut = [](std::vector<double> values, double low, double high) {
          for (double &value : values)
            value = std::clamp(value, low, high);
          return values;
        };
        const double both = sizes[place], one = sorted[place];
        for (const auto &values :
             {cut(with_noise(a, 0.1), -both, both), in_steps(with_noise(cut(a, -both, both), 0.05), 0.02)}) {
          const AtLimit at = share_at_limit(values);
          EXPECT_NEAR(at.high + at.low, share, 0.35 * share);
        }
        const AtLimit at = share_at_limit(with_noise(cut(a, -1e9, one), 0.05));
        EXPECT_NEAR(at.high, share, 0.35 * share);
        EXPECT_EQ(at.low, 0.0);
      }
    }
}

// Samples that repeat with each cycle, without noise: few different values, far apart.
TEST(SensorRange, IsReachedWhereSamplesRepeat) {
  for (const double share : {0.6, 0.8}) {
    std::vector<double> wave;
    for (int i = 0; i < 3400; ++i)
      wave.push_back(std::clamp(std::sin(2.0 * M_PI * (i % 34) / 34.0 + 0.1), -share, share));
    const AtLimit at = share_at_limit(wave);
    EXPECT_GT(at.high, 0.1);
    EXPECT_GT(at.low, 0.1);
  }
}

// Waves, drums that lose contact, the frame, in fine and coarse steps, with and without noise.
TEST(SensorRange, IsNotReachedBySmoothSignals) {
  for (const double rate : {500.0, 1000.0, 30.7 * 34.0, 30.7 * 36.0, 30.7 * 40.0, 5000.0})
    for (const double k : {14e6, 30e6, 60e6, 110e6, 180e6}) {
      SeenMotion seen = motion(k, rate);
      std::vector<double> wave;
      for (const double t : seen.time)
        wave.push_back(80.0 * std::sin(2.0 * M_PI * 30.7 * t + 1e-7 * k));
      for (const std::vector<double> *signal : {&seen.a_drum, &seen.a_frame, &wave})
        for (const double noise : {0.0, 0.1, 1.0})
          for (const double step : {1e-4, 0.05, 0.6, 5.0}) {
            const AtLimit at = share_at_limit(in_steps(with_noise(*signal, noise), step));
            EXPECT_EQ(at.high + at.low, 0.0) << rate << " " << k << " " << noise << " " << step;
          }
    }
}

} // namespace ranges

// Where the exciter changes while a roller is recorded, and where it does not: records of an integrator that
// shares no code with the tools.
namespace stretches {

using namespace post;

/// From one value to another between two times.
double ramp(double t, double begin, double end, double from, double to) {
  return t <= begin ? from : t >= end ? to : from + (to - from) * (t - begin) / (end - begin);
}

struct Found {
  std::vector<Stretch> stretches;
  double interval;
  std::size_t samples;
};
Found found(const ChangingRoller &roller, double rate = 1054.0, double length = 12.0) {
  const SeenMotion seen = seen_motion(roller, rate, length, 0.3, 1);
  return {stretches_of(seen.a_drum, seen.interval, 2.0 * M_PI * 30.5), seen.interval, seen.a_drum.size()};
}

// Every change of the exciter lies between two stretches, of which little is lost.
TEST(Stretches, EndWhereTheExciterChanges) {
  struct Case {
    const char *name;
    ChangingRoller::OfTime ChangingRoller::*of;
    ChangingRoller::OfTime value;
    double begin, end;            // of the change
    std::vector<double> settings; // frequency of each stretch [Hz]
  };
  const std::vector<Case> cases = {
      {"280 kN, then 150",
       &ChangingRoller::me_re,
       [](double t) { return t < 6.0 ? 7.38 : 3.95; },
       6,
       6,
       {31, 31}},
      {"150 kN, then 220",
       &ChangingRoller::me_re,
       [](double t) { return t < 6.0 ? 3.95 : 5.8; },
       6,
       6,
       {31, 31}},
      {"slower", &ChangingRoller::me_re, [](double t) { return ramp(t, 5, 7, 7.38, 3.95); }, 5, 7, {31, 31}},
      {"far slower",
       &ChangingRoller::me_re,
       [](double t) { return ramp(t, 4, 8, 7.38, 3.95); },
       4,
       8,
       {31, 31}},
      {"31, then 34 Hz",
       &ChangingRoller::frequency,
       [](double t) { return t < 6.0 ? 31.0 : 34.0; },
       6,
       6,
       {31, 34}},
      {"31, then 31.4 Hz",
       &ChangingRoller::frequency,
       [](double t) { return t < 6.0 ? 31.0 : 31.4; },
       6,
       6,
       {31, 31.4}},
      {"slowly", &ChangingRoller::frequency, [](double t) { return ramp(t, 5, 7, 31, 30); }, 5, 7, {31, 30}},
      {"another phase", &ChangingRoller::jump, [](double t) { return t < 6.0 ? 0.0 : 2.0; }, 6, 6, {31, 31}},
      {"begun again",
       &ChangingRoller::me_re,
       [](double t) { return t < 5 || t > 6 ? 7.38 : 0.0; },
       5,
       6,
       {31, 31}},
      {"off before", &ChangingRoller::me_re, [](double t) { return t < 3.0 ? 0.0 : 7.38; }, 0, 3, {31}},
      {"running up",
       &ChangingRoller::frequency,
       [](double t) { return ramp(t, 1, 4, 0.01, 31); },
       0,
       4,
       {31}},
      {"fading", &ChangingRoller::frequency, [](double t) { return ramp(t, 8, 12, 31, 0.01); }, 8, 12, {31}}};
  for (const Case &one : cases) {
    SCOPED_TRACE(one.name);
    ChangingRoller roller;
    roller.*one.of = one.value;
    const auto [stretches, interval, samples] = found(roller);
    ASSERT_EQ(stretches.size(), one.settings.size());
    constexpr double in_the_change = 0.2, lost = 1.0; // s
    double kept = 0.0;
    for (std::size_t n = 0; n < stretches.size(); ++n) {
      const double begin = interval * static_cast<double>(stretches[n].first),
                   end = interval * static_cast<double>(stretches[n].end);
      kept += end - begin;
      EXPECT_NEAR(stretches[n].omega / (2.0 * M_PI), one.settings[n], 0.05);
      if (begin < one.begin)
        EXPECT_LT(end, one.begin + in_the_change);
      else
        EXPECT_GT(begin, one.end - in_the_change);
    }
    EXPECT_GT(kept, interval * static_cast<double>(samples) - (one.end - one.begin) - lost);
  }
  ChangingRoller standing;
  standing.me_re = [](double) { return 0.0; };
  EXPECT_TRUE(found(standing).stretches.empty());
}

// Steady motion, soil that changes along the way, and a short record. Of aperiodic motion, on hard soil, one
// in some twenty is cut.
TEST(Stretches, DoNotCutASteadyExciter) {
  const auto is_whole = [](const ChangingRoller &roller, double rate, double length) {
    const auto [stretches, interval, samples] = found(roller, rate, length);
    return stretches.size() == 1 && stretches[0].first == 0 && stretches[0].end == samples &&
           std::fabs(stretches[0].omega / (2.0 * M_PI) - 31.0) < (length > 1.0 ? 0.05 : 0.3);
  };
  ChangingRoller roller;
  for (const double k : {12e6, 25e6, 40e6, 60e6}) {
    roller.k = [k](double) { return k; };
    EXPECT_TRUE(is_whole(roller, 1054.0, 12.0)) << k;
    EXPECT_TRUE(is_whole(roller, 500.0, 6.0)) << k;
    EXPECT_TRUE(is_whole(roller, 1000.0, 0.3)) << k;
  }
  for (const double seconds : {4.0, 11.0}) {
    roller.k = [seconds](double t) { return ramp(t, 0.5, 0.5 + seconds, 20e6, 80e6); };
    EXPECT_TRUE(is_whole(roller, 1000.0, 12.0)) << seconds;
  }
  int whole = 0, made = 0;
  for (const double k : {70e6, 80e6, 100e6, 120e6, 140e6, 170e6, 200e6})
    for (const double length : {8.0, 16.0}) {
      roller.k = [k](double) { return k; };
      whole += is_whole(roller, 1000.0, length) ? 1 : 0;
      ++made;
    }
  EXPECT_GE(whole, made - 3);
}

} // namespace stretches

} // namespace
} // namespace drumlin::test
