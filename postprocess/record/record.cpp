#include "record/record.h"

#include "record/excitation.h"
#include "record/stretches.h"
#include "runs/parameter_file.h"
#include "support/csv.h"
#include "support/units.h"
#include "support/statistics.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <deque>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// The signals that are read: all columns from x_drum, the second, to F_excitation, and the sensors at both
/// ends of the drum.
constexpr auto record_signals = [] {
  constexpr std::size_t of_middle = 8;
  std::array<HistoryColumn, of_middle + 2> signals{};
  std::size_t count = 0;
  for (std::size_t i = 1; i < history_columns.size(); ++i)
    if (const auto values = history_columns[i].values;
        i <= of_middle || values == &ChainHistory::a_left || values == &ChainHistory::a_right)
      signals[count++] = history_columns[i];
  return signals;
}();

/// What the unit of `time` or of a signal measures; nothing for another name.
std::optional<UnitKind> quantity_of(const std::string &name) {
  if (name == "time") return UnitKind::time;
  for (const HistoryColumn &signal : record_signals) {
    constexpr std::array<UnitKind, 3> of_derivative = {UnitKind::length, UnitKind::velocity,
                                                       UnitKind::acceleration};
    if (name == signal.name)
      return signal.derivative == force_column ? UnitKind::force
                                               : of_derivative[static_cast<std::size_t>(signal.derivative)];
  }
  return std::nullopt;
}

constexpr const char *pulse_name = "pulse"; // a column that has no unit

std::string signal_names() {
  std::string names = "time, pulse";
  for (const HistoryColumn &signal : record_signals)
    names += fmt::format(", {}", signal.name);
  return names;
}

/// The words of the units in which a quantity may be given.
std::string allowed_units(UnitKind quantity) {
  return unit_names(quantity) + (quantity == UnitKind::time ? "" : ", with '-' before it to turn the sign");
}

double factor_of(const std::string &unit, UnitKind quantity) {
  const bool negative = !unit.empty() && unit.front() == '-' && quantity != UnitKind::time;
  const std::optional<Unit> known = unit_from_text(negative ? unit.substr(1) : unit);
  if (!known || known->quantity != quantity)
    throw std::invalid_argument(refusal("the unit", unit, allowed_units(quantity)));
  return negative ? -known->factor : known->factor;
}

double mean(const std::vector<double> &values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Rows from `first` to before `end`.
struct SampleRange {
  std::size_t first, end;
  double frequency = 0.0; ///< as in RecordPiece
};

/// A record being read, with what its messages name.
struct Reading {
  Record record;
  std::deque<MeasuredTable> tables; ///< the files, in their order
  std::vector<std::size_t> starts;  ///< the place of each file's first row among all rows
  std::size_t first = 0;            ///< place of the piece's first row among all rows
  std::string time_header;
  std::vector<std::string> headers; ///< by the place of the signal in record_signals

  std::string header_of(std::vector<double> ChainHistory::*values) const {
    for (std::size_t i = 0; i < record_signals.size(); ++i)
      if (record_signals[i].values == values) return headers[i];
    return {};
  }
  [[noreturn]] void refuse(std::vector<double> ChainHistory::*values, std::string_view found,
                           std::string_view allowed) const {
    csv_refusal(record.file, 0, header_of(values), found, allowed);
  }
  /// Refuses a time, as its file has it; `row` counts over all files.
  [[noreturn]] void refuse_time(std::size_t row, const std::string &allowed) const {
    const auto next = std::upper_bound(starts.begin(), starts.end(), row);
    const auto i = static_cast<std::size_t>(next - starts.begin() - 1);
    tables[i].refuse(row - starts[i], tables[i].find(time_header).value(), allowed);
  }
  std::vector<double> times; ///< of all rows [s]; empty without a column of time
};

/// Whether a file is one of those of a run, by its name.
bool is_of_run(const fs::path &file) {
  const std::string name = file.filename().string();
  return name == "chain.csv" || name == "bed.csv" || name == "cycles.csv";
}

/// The file that holds the samples; `cycles` is set to the table of cycles.
fs::path sample_file(const fs::path &path, fs::path &cycles) {
  if (!fs::is_directory(path)) {
    if (path.filename() == "cycles.csv") cycles = path;
    return path;
  }
  if (fs::is_regular_file(path / "cycles.csv")) cycles = path / "cycles.csv";
  for (const char *name : {"chain.csv", "bed.csv"})
    if (fs::is_regular_file(path / name)) return path / name;
  if (!cycles.empty()) return cycles;
  throw std::runtime_error(refusal("the record", path.string(),
                                   "a folder with chain.csv, bed.csv or cycles.csv, one of these files, or a "
                                   "measured file"));
}

void take_number(const Record &record, const fs::path &file, const char *name, std::optional<double> &value) {
  const auto found = record.parameters.find(name);
  if (found == record.parameters.end() || found->second.empty()) return;
  try {
    value = number_from_text(found->second);
  } catch (const std::invalid_argument &) {
    throw std::runtime_error(
        fmt::format("{}: {}", file.string(), refusal(name, found->second, "a finite number")));
  }
}

/// Takes over parameters.csv of the run, if there is one.
void take_parameters(Record &record) {
  record.of_run = is_of_run(record.file);
  if (!record.of_run) return;
  const fs::path file = record.file.parent_path() / "parameters.csv";
  if (!fs::is_regular_file(file)) return;
  record.phase = 0.0;
  record.parameters = read_parameters(file);
  record.known_origin = record.file.filename() == "chain.csv" &&
                        record.parameters.count("D") + record.parameters.count("way") > 0;
  for (const auto &[name, value] :
       {std::pair{"omega", &record.omega}, std::pair{"Fw", &record.Fw}, std::pair{"m2", &record.m2},
        std::pair{"m3", &record.m3}, std::pair{"g", &record.g}})
    take_number(record, file, name, *value);
  for (const auto &[name, value] : {std::pair{"omega", record.omega}, std::pair{"m2", record.m2}})
    if (value && !(*value > 0.0))
      throw std::runtime_error(
          fmt::format("{}: {}", file.string(), refusal(name, *value, "numbers above 0")));
}

/// How the drum of a run with both ends tilts, from its parameters.csv; nothing of others.
std::optional<TwoEnds> ends_of(const Record &record) {
  const fs::path file = record.file.parent_path() / "parameters.csv";
  TwoEnds ends;
  std::optional<double> width, drum_inertia, frame_inertia, exciter, sensor;
  for (const auto &[name, value] :
       {std::pair{"width", &width}, std::pair{"drum_inertia", &drum_inertia},
        std::pair{"frame_inertia", &frame_inertia}, std::pair{"exciter_place", &exciter},
        std::pair{"sensor_distance", &sensor}})
    take_number(record, file, name, *value);
  if (!width || !drum_inertia || !frame_inertia || !sensor) return std::nullopt;
  ends.drum_inertia = *drum_inertia;
  ends.frame_inertia = *frame_inertia;
  ends.exciter = exciter.value_or(0.0);
  ends.sensor = *sensor;
  ends.contacts = equal_contacts(2, *width, 0.0, 0.0);
  for (const auto &[name, value] : record.parameters) {
    AxleLink bond;
    if (name.rfind("bond_", 0) == 0 &&
        std::sscanf(value.c_str(), "y %lf m, k %lf N/m, c %lf N s/m", &bond.y, &bond.k, &bond.c) == 3)
      ends.bonds.push_back(bond);
  }
  return ends.bonds.empty() ? std::nullopt : std::optional(ends);
}

void take_options(Record &record, const RecordOptions &options) {
  record.ends = options.ends ? options.ends : ends_of(record);
  if (options.omega) record.omega = options.omega;
  if (options.phase) record.phase = options.phase;
  if (options.Fw) record.Fw = options.Fw;
  if (options.m2) record.m2 = options.m2;
  if (options.m3) record.m3 = options.m3;
  if (options.me_re && record.omega) record.Fw = *options.me_re * *record.omega * *record.omega;
  record.tolerances = options.tolerances;
  record.bond = options.bond;
}

/// A column of a file that is read into a signal.
struct Taken {
  std::vector<double> *into;
  std::size_t place;
  double factor;
};

/// The factor to SI of a column: that of the command line, or of the unit in the file, or 1.
double factor_of(const MeasuredTable &table, std::size_t place, const std::string &name,
                 const ColumnSource &source) {
  const MeasuredColumn &column = table.columns()[place];
  if (name == pulse_name) return 1.0;
  if (source.factor) return *source.factor;
  if (column.unit.empty()) return 1.0;
  const UnitKind quantity = *quantity_of(name);
  try {
    return factor_of(column.unit, quantity);
  } catch (const std::invalid_argument &) {
    csv_fault(table.file(), 0, column.header,
              refusal("its unit", column.unit,
                      fmt::format("{}; --column '{}={}:UNIT' gives another one", allowed_units(quantity),
                                  name, source.header)));
  }
}

/// What the columns of a file may be whose names say nothing: the time rises from row to row; of the
/// accelerations that of the drum varies the most, then that of the frame.
std::map<std::string, ColumnSource> guessed_columns(const MeasuredTable &table) {
  std::map<std::string, ColumnSource> guess;
  std::vector<std::pair<double, std::string>> signals; // how much they vary
  const bool has_time = table.find("time").has_value();
  for (std::size_t i = 0; i < table.columns().size(); ++i) {
    const MeasuredColumn &column = table.columns()[i];
    if (!table.is_numeric(i) || table.find("time") == i) continue;
    const std::string name = table.find(column.header) == i ? column.header : fmt::format("{}", i + 1);
    const bool clock = table.has_clock_times(i);
    const std::vector<double> values = clock ? std::vector<double>() : table.numbers(i);
    if (clock || std::is_sorted(values.begin(), values.end())) {
      if (!has_time) guess.emplace("time", ColumnSource{name});
      continue;
    }
    const std::optional<Unit> unit = unit_from_text(column.unit);
    if (!column.unit.empty() && (!unit || unit->quantity != UnitKind::acceleration)) continue;
    std::vector<double> all;
    std::copy_if(values.begin(), values.end(), std::back_inserter(all),
                 [](double value) { return !std::isnan(value); });
    const double middle = mean(all);
    for (double &value : all)
      value -= middle;
    signals.emplace_back((unit ? unit->factor : 1.0) * rms(all), name);
  }
  std::sort(signals.rbegin(), signals.rend());
  constexpr std::array<const char *, 2> names = {"a_drum", "a_frame"};
  for (std::size_t i = 0; i < std::min(names.size(), signals.size()); ++i)
    guess.emplace(names[i], ColumnSource{signals[i].second});
  return guess;
}

/// The columns of a file that are read, `time` first if it has one.
std::vector<Taken> columns_to_take(const MeasuredTable &table, const RecordOptions &options,
                                   Reading &reading) {
  std::vector<Taken> taken;
  const bool first_file = reading.headers.empty();
  std::string understood;
  const auto find = [&](const std::string &name, std::vector<double> &into, bool own_name) {
    const auto given = options.columns.find(name);
    const bool named = given != options.columns.end();
    if (!named && !own_name) return std::string();
    const ColumnSource source = named ? given->second : ColumnSource{name};
    const std::optional<std::size_t> place = table.find(source.header);
    if (!place && named) table.missing(source.header);
    if (!place) return source.header;
    const MeasuredColumn &column = table.columns()[*place];
    if (std::any_of(taken.begin(), taken.end(), [&](const Taken &other) { return other.place == *place; }))
      csv_fault(table.file(), 0, column.header,
                refusal("its use for " + name, source.header, "a column of its own for each signal"));
    const bool clock = name == "time" && table.has_clock_times(*place); // 'hh:mm:ss' is no unit
    taken.push_back({&into, *place, clock ? 1.0 : factor_of(table, *place, name, source)});
    const std::string unit = name == pulse_name    ? "which rises once per revolution"
                             : source.factor       ? fmt::format("times {:g}", *source.factor)
                             : column.unit.empty() ? "in SI units"
                                                   : "in " + column.unit;
    understood += fmt::format("{}{} is column {} '{}' {}", understood.empty() ? "" : ", ", name, *place + 1,
                              column.header, clock ? "with clock times" : unit);
    return column.header;
  };
  const bool any_signal_named =
      options.columns.size() > options.columns.count("time") + options.columns.count(pulse_name);
  const std::string time_header = find("time", reading.times, true);
  const std::size_t of_time = taken.size();
  std::vector<std::string> headers;
  headers.reserve(record_signals.size());
  for (const HistoryColumn &signal : record_signals)
    headers.push_back(find(signal.name, reading.record.*signal.values, !any_signal_named));
  const std::size_t of_motion = taken.size();
  find(pulse_name, reading.record.pulse, false);
  // Of runs, what no sensor measures: place and pass, and the forces below both ends of a drum.
  const std::array<std::pair<const char *, std::vector<double> *>, 4> of_run = {
      {{"s", &reading.record.s},
       {"pass", &reading.record.pass},
       {"F_left", &reading.record.F_left},
       {"F_right", &reading.record.F_right}}};
  for (std::size_t i = 0; i < of_run.size(); i += 2) // in pairs
    if (is_of_run(table.file()) && table.find(of_run[i].first) && table.find(of_run[i + 1].first))
      for (const auto &[name, into] : {of_run[i], of_run[i + 1]})
        taken.push_back({into, *table.find(name), 1.0});
  if (of_motion == of_time) {
    std::vector<std::string> names, words;
    names.reserve(table.columns().size());
    for (const MeasuredColumn &column : table.columns())
      names.push_back(fmt::format("{} '{}'", names.size() + 1, shown(column.header)));
    const std::map<std::string, ColumnSource> guess =
        any_signal_named ? std::map<std::string, ColumnSource>() : guessed_columns(table);
    for (const auto &[name, source] : guess)
      words.push_back(fmt::format("--column '{}={}'", name, source.header));
    const bool guessed = guess.count("a_drum") > 0;
    if (guessed && options.guess) {
      RecordOptions with = options;
      with.columns.insert(guess.begin(), guess.end());
      reading.record.notes.push_back(fmt::format(
          "No column has a name that is known. If what is shown is right, type: {}", fmt::join(words, " ")));
      return columns_to_take(table, with, reading);
    }
    csv_fault(table.file(), 0, {},
              fmt::format("has no column of motion or force among {}; allowed: columns named {}, or others "
                          "by --column NAME=HEADER:UNIT{}",
                          fmt::join(names, ", "), signal_names(),
                          guessed ? fmt::format(", perhaps {}", fmt::join(words, " ")) : std::string()));
  }
  if (of_time == 0 && !options.sampling_rate) table.missing("time");
  if (first_file) {
    reading.time_header = time_header;
    reading.headers = headers;
  }
  if (!is_of_run(table.file())) {
    reading.record.notes.push_back(fmt::format("{}: {}", table.file().string(), table.words()));
    reading.record.notes.push_back(understood);
  }
  return taken;
}

/// Reads all rows of all files; blank cells are NaN.
void read_samples(const std::vector<fs::path> &files, Reading &reading, const RecordOptions &options) {
  ClockDays days;
  std::size_t rows = 0;
  bool clocks = false;
  for (const fs::path &file : files) {
    const bool of_run = is_of_run(file);
    const MeasuredTable &table =
        reading.tables.emplace_back(file, of_run ? TableFormat{',', '.', true} : options.format);
    reading.starts.push_back(rows);
    for (const Taken &column : columns_to_take(table, options, reading)) {
      const bool clock = column.into == &reading.times && table.has_clock_times(column.place);
      const std::vector<double> values =
          clock ? table.clock_times(column.place, days) : table.numbers(column.place);
      clocks = clocks || clock;
      for (std::size_t row = 0; row < values.size(); ++row) {
        if (of_run && std::isnan(values[row])) table.refuse(row, column.place, "a finite number");
        column.into->push_back(clock ? values[row] : column.factor * values[row]);
      }
    }
    rows += table.rows();
    if (!reading.record.pulse.empty() && reading.record.pulse.size() != rows)
      csv_fault(file, 0, {},
                fmt::format("has not the same columns as {}; allowed: files of one record",
                            files.front().string()));
    for (const HistoryColumn &signal : record_signals) {
      const std::size_t size = (reading.record.*signal.values).size();
      if (size > 0 && size != rows)
        csv_fault(file, 0, {},
                  fmt::format("has not the same columns as {}; allowed: files of one record",
                              files.front().string()));
    }
  }
  if (!reading.times.empty() && reading.times.size() != rows)
    csv_fault(
        files.back(), 0, {},
        fmt::format("has not the same columns as {}; allowed: files of one record", files.front().string()));
  const auto first =
      std::find_if(reading.times.begin(), reading.times.end(), [](double t) { return !std::isnan(t); });
  if (clocks && first != reading.times.end()) {
    const double start = *first;
    for (double &time : reading.times)
      time -= start;
  }
}

/// The step between times that is usual [s], and from which step on there is a gap.
std::pair<double, double> usual_and_gap(const std::vector<double> &times, const RecordOptions &options) {
  std::vector<double> steps;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t row = 1; row < times.size(); ++row) {
    const double step = times[row] - times[row - 1];
    if (std::isnan(step)) continue;
    steps.push_back(step);
    if (step > 0.0) least = std::min(least, step);
  }
  const double usual = options.sampling_rate ? 1.0 / *options.sampling_rate
                       : steps.empty()       ? 0.0
                                             : median(steps);
  // Times of few digits grow by their last digit, or not at all.
  return {usual, options.sampling_rate && std::isfinite(least) ? std::max(1.5 * usual, least + 0.5 * usual)
                                                               : 1.5 * usual};
}

/// Divides the rows where cells are blank or times have a gap; the rows of a run have neither.
std::vector<SampleRange> pieces_of(const Reading &reading, const RecordOptions &options) {
  std::vector<const std::vector<double> *> columns;
  if (!reading.times.empty()) columns.push_back(&reading.times);
  for (const HistoryColumn &signal : record_signals)
    if (!(reading.record.*signal.values).empty()) columns.push_back(&(reading.record.*signal.values));
  if (!reading.record.pulse.empty()) columns.push_back(&reading.record.pulse);
  const std::size_t rows = columns.front()->size();
  const auto [usual, gap] = usual_and_gap(reading.times, options);
  std::vector<SampleRange> pieces;
  bool within = false;
  for (std::size_t row = 0; row < rows; ++row) {
    if (std::any_of(columns.begin(), columns.end(),
                    [row](const auto *column) { return std::isnan((*column)[row]); })) {
      within = false;
      continue;
    }
    if (within && !reading.times.empty()) {
      const double before = reading.times[row - 1], step = reading.times[row] - before;
      if (step < 0.0 || (step == 0.0 && !options.sampling_rate))
        reading.refuse_time(
            row, fmt::format("a later time than in the row before{}",
                             step < 0.0 ? "" : ", or equal times together with the sampling rate"));
      if (step > gap) {
        if (is_of_run(reading.record.file))
          reading.refuse_time(
              row,
              fmt::format("times without a gap: at most 1.5 steps of {:g} s after the row before", usual));
        within = false;
      }
    }
    if (!within) pieces.push_back({row, row});
    within = true;
    pieces.back().end = row + 1;
  }
  return pieces;
}

/// Divides pieces further where the exciter is off or changes. Its own force shows that, or else the drum.
std::vector<SampleRange> steady_pieces(const Reading &reading, const std::vector<SampleRange> &pieces,
                                       const RecordOptions &options) {
  const Record &record = reading.record;
  std::vector<double> ends; // the mean of sensors at both ends
  for (std::size_t row = 0; row < std::min(record.a_left.size(), record.a_right.size()); ++row)
    ends.push_back(0.5 * (record.a_left[row] + record.a_right[row]));
  using Signal = const std::vector<double> *;
  for (const Signal signal : std::array<Signal, 6>{&record.F_excitation, &record.a_drum, &ends,
                                                   &record.v_drum, &record.x_drum, &record.F_contact}) {
    if (signal->empty()) continue;
    std::vector<SampleRange> steady;
    for (const SampleRange &piece : pieces) {
      const std::size_t count = piece.end - piece.first;
      if (count < 2) continue;
      const double interval =
          options.sampling_rate
              ? 1.0 / *options.sampling_rate
              : (reading.times[piece.end - 1] - reading.times[piece.first]) / static_cast<double>(count - 1);
      const auto begin = signal->begin() + static_cast<std::ptrdiff_t>(piece.first);
      for (const Stretch &one :
           stretches_of({begin, begin + static_cast<std::ptrdiff_t>(count)}, interval, *record.omega))
        steady.push_back({piece.first + one.first, piece.first + one.end, one.omega / (2.0 * pi)});
    }
    if (steady.empty())
      csv_fault(
          record.file, 0, {},
          refusal("the line of the exciter",
                  fmt::format("nowhere a part of the motion near {:.6g} Hz", *record.omega / (2.0 * pi)),
                  "a record with the exciter on, and its frequency"));
    return steady;
  }
  return pieces;
}

std::string words_of_pieces(const Record &record) {
  const auto words = [&record](std::size_t n) {
    const auto &[begin, end, samples, frequency] = record.pieces[n];
    return fmt::format("{:.6g} to {:.6g} s{}", begin, end,
                       frequency > 0.0 ? fmt::format(" at {:.4g} Hz", frequency) : "");
  };
  const std::string cause =
      record.omega ? "the exciter is off or changes, or rows are missing" : "rows are missing";
  std::string text = "only " + words(record.piece) + " is read; ";
  if (record.pieces.size() == 1) return text + "in the rest of the file " + cause;
  text += fmt::format("it is piece {} of {}, between which {}; --piece takes another: ", record.piece + 1,
                      record.pieces.size(), cause);
  std::vector<std::string> others;
  constexpr std::size_t most = 6;
  for (std::size_t n = 0; n < record.pieces.size() && others.size() < most; ++n)
    if (n != record.piece) others.push_back(fmt::format("{}, {}", n + 1, words(n)));
  return text +
         fmt::format("{}{}", fmt::join(others, "; "), record.pieces.size() > most + 1 ? "; and so on" : "");
}

/// Keeps one of the pieces.
void take_piece(Reading &reading, const RecordOptions &options) {
  Record &record = reading.record;
  std::vector<SampleRange> pieces = pieces_of(reading, options);
  const std::vector<SampleRange> without_gaps = pieces;
  if (record.omega && !record.of_run) pieces = steady_pieces(reading, pieces, options);
  const auto size = [](const SampleRange &piece) { return piece.end - piece.first; };
  const auto near = [&record](const SampleRange &piece) {
    return record.omega && std::fabs(2.0 * pi * piece.frequency / *record.omega - 1.0) < frequency_range;
  };
  const auto longest =
      std::max_element(pieces.begin(), pieces.end(), [&](const SampleRange &a, const SampleRange &b) {
        return std::pair(near(a), size(a)) < std::pair(near(b), size(b));
      });
  constexpr std::size_t least = 3;
  if (pieces.empty() || size(*longest) < least)
    csv_fault(
        record.file, 0, {},
        refusal("the number of rows", fmt::format("{}", pieces.empty() ? 0 : size(*longest)), "3 or more"));
  record.piece = static_cast<std::size_t>(longest - pieces.begin());
  if (options.piece) {
    if (*options.piece > pieces.size() || size(pieces[*options.piece - 1]) < least)
      csv_fault(
          record.file, 0, {},
          refusal("the piece", fmt::format("{}", *options.piece),
                  fmt::format("the number of one of its {} pieces with 3 samples or more", pieces.size())));
    record.piece = *options.piece - 1;
  }
  for (const SampleRange &piece : pieces) {
    const auto time = [&](std::size_t row) {
      return reading.times.empty() ? static_cast<double>(row) / *options.sampling_rate : reading.times[row];
    };
    record.pieces.push_back({time(piece.first), time(piece.end - 1), size(piece), piece.frequency});
  }
  const SampleRange kept = pieces[record.piece];
  reading.first = kept.first;
  record.time = reading.times;
  keep_samples(record, kept.first, kept.end);
  if (without_gaps.size() > 1 || size(kept) < size(without_gaps.front()))
    record.notes.push_back(record.part_read = words_of_pieces(record));
}

/// Share of a step up to which times may lie beside equally spaced ones; of a measured file they may scatter
/// more, since loggers stamp their samples a little early or late.
constexpr double even_steps = 0.01, scattered_steps = 0.05;

/// Refuses steps that are not equal; with a sampling rate given, a length that differs by 0.1 %, or by a few
/// digits of the times if these are few.
void check_steps(const Reading &reading, double interval, bool rate_given) {
  const std::vector<double> &time = reading.record.time;
  const double tolerance = is_of_run(reading.record.file) ? even_steps : scattered_steps;
  const double length = interval * static_cast<double>(time.size() - 1);
  double digit = std::numeric_limits<double>::infinity();
  for (std::size_t row = 1; row < time.size(); ++row)
    if (time[row] > time[row - 1]) digit = std::min(digit, time[row] - time[row - 1]);
  for (std::size_t row = 1; row < time.size(); ++row) {
    const double place = time.front() + interval * static_cast<double>(row);
    if (std::fabs(time[row] - place) >
        (rate_given ? 1e-3 * length + std::max(interval, digit) : tolerance * interval))
      reading.refuse_time(
          reading.first + row,
          rate_given ? std::string("the time that follows from the sampling rate, to one sample")
                     : fmt::format("equal steps of {:g} s to {:g} % of it, or times with few digits together "
                                   "with the sampling rate",
                                   interval, 100.0 * tolerance));
  }
}

/// Puts times that scatter by more than 1 % of a step onto the straight line through them, and says so.
void even_out(Record &record) {
  std::vector<double> &time = record.time;
  const auto count = static_cast<double>(time.size());
  const double middle = 0.5 * (count - 1.0), centre = mean(time);
  double products = 0.0;
  for (std::size_t row = 0; row < time.size(); ++row)
    products += (static_cast<double>(row) - middle) * (time[row] - centre);
  const double interval = 12.0 * products / (count * (count * count - 1.0));
  double most = 0.0, squares = 0.0;
  std::vector<double> even;
  for (std::size_t row = 0; row < time.size(); ++row) {
    even.push_back(centre + interval * (static_cast<double>(row) - middle));
    const double off = (time[row] - even.back()) / interval;
    most = std::max(most, std::fabs(off));
    squares += off * off;
  }
  if (most <= even_steps) return;
  record.notes.push_back(
      fmt::format("the times scatter by {:.2g} % of a step, at most {:.2g} %: samples are taken as "
                  "equally spaced, {:.8g} per second",
                  100.0 * std::sqrt(squares / count), 100.0 * most, 1.0 / interval));
  time = std::move(even);
  record.interval = interval;
}

/// Checks the times and sets the interval; without a column of time they count from 0, and clock times from
/// the first row.
void take_times(Reading &reading, const RecordOptions &options) {
  Record &record = reading.record;
  const std::size_t count = record.pieces[record.piece].samples;
  const auto steps = static_cast<double>(count - 1);
  const bool stamped = !record.time.empty();
  record.interval = options.sampling_rate ? 1.0 / *options.sampling_rate
                                          : (record.time.back() - record.time.front()) / steps;
  if (stamped) check_steps(reading, record.interval, options.sampling_rate.has_value());
  if (stamped && !options.sampling_rate) {
    if (!is_of_run(record.file)) even_out(record);
    return;
  }
  const double start = record.pieces[record.piece].begin;
  record.time.resize(count);
  for (std::size_t row = 0; row < count; ++row)
    record.time[row] = start + record.interval * static_cast<double>(row);
}

/// Refuses a column that differs from the derivative of another by a factor of 2 or more, or by its sign.
void check_derivative(const Reading &reading, std::vector<double> ChainHistory::*of,
                      std::vector<double> ChainHistory::*rate) {
  const std::vector<double> &values = reading.record.*of;
  const std::vector<double> &rates = reading.record.*rate;
  if (values.empty() || rates.empty()) return;
  double products = 0.0;
  double squares = 0.0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double expected = 0.5 * (rates[i - 1] + rates[i]) * reading.record.interval;
    products += expected * (values[i] - values[i - 1]);
    squares += expected * expected;
  }
  if (!(squares > 0.0)) return; // at rest
  const double ratio = products / squares;
  if (ratio < 0.5 || ratio > 2.0)
    reading.refuse(rate, fmt::format("{:.3g} times the derivative of {}", 1.0 / ratio, reading.header_of(of)),
                   "the unit and the sign of that derivative");
}

/// Takes the mean of both ends for the middle of the drum if this has no sensor of its own.
void take_middle(const Reading &reading, Record &record) {
  if (record.a_left.empty() && record.a_right.empty()) return;
  for (const auto values : {&Record::a_left, &Record::a_right})
    if ((record.*values).empty())
      csv_fault(record.file, 0, {},
                refusal(values == &Record::a_left ? "a_left" : "a_right", "",
                        "sensors at both ends of the drum; a single one is a_drum"));
  if (!record.a_drum.empty()) return;
  for (std::size_t i = 0; i < record.size(); ++i)
    record.a_drum.push_back(0.5 * (record.a_left[i] + record.a_right[i]));
  check_derivative(reading, &Record::v_drum, &Record::a_drum);
}

/// Refuses a contact force without contact, or of another sign or unit.
void check_contact_force(const Reading &reading) {
  const Record &record = reading.record;
  const std::vector<double> &force = record.F_contact;
  if (force.empty()) return;
  const auto refuse = [&reading](const std::string &found, const std::string &allowed) {
    reading.refuse(&Record::F_contact, found, allowed);
  };
  const auto [least, most] = std::minmax_element(force.begin(), force.end());
  if (*least == 0.0 && *most == 0.0) refuse("0 in every row", "a record in which drum and soil touch");
  if (*most <= 0.0)
    refuse(fmt::format("never above {:g} N", *most), "forces that are positive in compression");
  if (record.omega && record.m2 && record.m3 && record.g && *record.g > 0.0) {
    const double weight = (*record.m2 + *record.m3) * *record.g;
    if (std::fabs(mean(force) - weight) > 0.5 * weight + 0.2 * rms(force))
      refuse(fmt::format("{:.4g} N in the mean", mean(force)),
             fmt::format("forces in N, positive in compression, which in the mean carry the weight of drum "
                         "and frame, {:.4g} N",
                         weight));
  }
}

/// Refuses accelerations that go against the contact force: a spring below the drum pushes it up while it is
/// low.
void check_direction(const Reading &reading) {
  const std::vector<double> &force = reading.record.F_contact;
  const std::vector<double> &a = reading.record.a_drum;
  if (force.empty() || a.empty()) return;
  const double of_force = mean(force);
  const double of_a = mean(a);
  double together = 0.0;
  double alone = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    together += (a[i] - of_a) * (force[i] - of_force);
    alone += (a[i] - of_a) * (a[i] - of_a);
  }
  if (together < -0.1 * std::sqrt(alone) * rms(force))
    reading.refuse(&Record::a_drum, "against the contact force", "accelerations that are positive upwards");
}

void check_length(const Record &record) {
  if (!record.omega) return;
  const auto refuse = [&record](const char *name, double found, int least) {
    csv_fault(record.file, 0, {},
              refusal(name, fmt::format("{:.4g}", found),
                      fmt::format("{} or more at {:.6g} Hz, the frequency of the excitation", least,
                                  1.0 / record.period())));
  };
  constexpr double rounding = 1e-6;
  if (record.cycles() < least_cycles - rounding)
    refuse("the number of cycles", record.cycles(), least_cycles);
  const double samples = record.period() / record.interval;
  if (samples < least_samples - rounding) refuse("the number of samples per cycle", samples, least_samples);
}

} // namespace

void filter_signals(Record &record, double cutoff) {
  const double most = 0.5 / record.interval;
  if (!(cutoff > 0.0 && cutoff < most))
    throw std::runtime_error(
        refusal("the cut-off frequency", cutoff,
                fmt::format("numbers above 0 and below half the sampling rate, {:g} [Hz]", most)));
  for (const HistoryColumn &signal : record_signals)
    record.*signal.values = low_passed(record.*signal.values, record.interval, cutoff);
  record.low_pass = cutoff;
}

void compute_excitation(Record &record) {
  if (record.excitation_read || !record.omega || !record.phase || !record.Fw) return;
  record.F_excitation.clear();
  for (std::size_t i = 0; i < record.size(); ++i)
    record.F_excitation.push_back(*record.Fw * record.force_share(i) * std::sin(record.angle(i)));
}

void keep_samples(Record &record, std::size_t first, std::size_t end) {
  const auto keep = [first, end](std::vector<double> &values) {
    if (values.empty()) return;
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(end), values.end());
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first));
  };
  for (const HistoryColumn &column : history_columns)
    keep(record.*column.values);
  for (std::vector<double> *values :
       {&record.wander, &record.pulse, &record.logged_drum, &record.logged_frame})
    keep(*values);
}

double Record::period() const {
  if (!omega)
    csv_fault(file, 0, {},
              refusal("the frequency of the excitation", "",
                      "a number above 0 [Hz], which no parameters.csv gives"));
  return 2.0 * pi / *omega;
}

double Record::force_share(std::size_t sample) const {
  if (wander.size() < 3) return 1.0;
  const std::size_t i = std::clamp<std::size_t>(sample, 1, wander.size() - 2);
  return std::pow(1.0 + 0.5 * (wander[i + 1] - wander[i - 1]) / interval / *omega, 2);
}

double Record::cycles() const {
  return size() < 2 ? 0.0 : interval * static_cast<double>(size() - 1) / period();
}

std::pair<std::string, ColumnSource> column_from_text(const std::string &text) {
  constexpr const char *form = "NAME=HEADER or NAME=HEADER:UNIT";
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw std::invalid_argument(form);
  const std::string name = text.substr(0, equals);
  if (name == pulse_name && equals + 1 < text.size()) return {name, {text.substr(equals + 1)}};
  const std::optional<UnitKind> quantity = quantity_of(name);
  if (!quantity) throw std::invalid_argument(fmt::format("{}, NAME one of {}", form, signal_names()));
  ColumnSource source{text.substr(equals + 1)};
  if (const std::size_t colon = source.header.rfind(':'); colon != std::string::npos) {
    source.factor = factor_of(source.header.substr(colon + 1), *quantity);
    source.header.erase(colon);
  }
  if (source.header.empty()) throw std::invalid_argument(form);
  return {name, source};
}

std::pair<std::string, double> delay_from_text(const std::string &text) {
  constexpr const char *form = "SIGNAL=TIME as a_frame=0.5ms, from -1 to 1 s";
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw std::invalid_argument(form);
  const std::string name = text.substr(0, equals), time = text.substr(equals + 1);
  if (name == "time" || !quantity_of(name)) throw std::invalid_argument(form);
  const std::size_t unit = time.find_first_not_of("+-.0123456789eE");
  double seconds = 0.0;
  try {
    seconds = number_from_text(time.substr(0, unit)) *
              (unit == std::string::npos ? 1.0 : factor_of(time.substr(unit), UnitKind::time));
  } catch (const std::invalid_argument &) {
    throw std::invalid_argument(form);
  }
  if (!(std::fabs(seconds) <= 1.0)) throw std::invalid_argument(form);
  return {name, seconds};
}

std::vector<double> without_high_pass(const std::vector<double> &values, double interval, double corner,
                                      double omega) {
  const auto count = static_cast<Eigen::Index>(values.size());
  constexpr Eigen::Index terms = 4, waves = 6;
  Eigen::VectorXd whole(count);
  Eigen::MatrixXd parts(count, terms + 2 * waves);
  double integral = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (at > 0) integral += 0.5 * interval * (values[at - 1] + values[at]);
    whole[i] = values[at] + 2.0 * pi * corner * integral;
    const double u = 2.0 * static_cast<double>(i) / static_cast<double>(count - 1) - 1.0;
    for (Eigen::Index n = 0; n < terms; ++n)
      parts(i, n) = std::cos(static_cast<double>(n) * std::acos(std::clamp(u, -1.0, 1.0)));
    for (Eigen::Index n = 0; n < waves; ++n) {
      const double angle = 0.5 * static_cast<double>(n + 1) * omega * interval * static_cast<double>(i);
      parts(i, terms + 2 * n) = std::sin(angle);
      parts(i, terms + 2 * n + 1) = std::cos(angle);
    }
  }
  const Eigen::VectorXd found = (parts.transpose() * parts).ldlt().solve(parts.transpose() * whole);
  whole -= parts.leftCols(terms) * found.head(terms);
  return {whole.data(), whole.data() + count};
}

namespace {

/// Moves signals that come late. The drum's acceleration, which jumps, is not interpolated: the others and
/// the times go with it.
void undo_delays(Record &record, const std::map<std::string, double> &delays) {
  const auto of_drum = delays.find("a_drum");
  const double own = of_drum == delays.end() ? 0.0 : of_drum->second;
  std::size_t first = 0, end = record.size();
  std::vector<std::pair<std::vector<double> *, double>> moved; // signals, and by how many samples
  for (const HistoryColumn &signal : record_signals) {
    std::vector<double> &values = record.*signal.values;
    const auto given = delays.find(signal.name);
    if (given != delays.end() && values.empty())
      csv_fault(record.file, 0, {},
                refusal("the delay of " + std::string(signal.name), given->second, "signals of the record"));
    const double samples = ((given == delays.end() ? 0.0 : given->second) - own) / record.interval;
    if (values.empty() || samples == 0.0) continue;
    moved.emplace_back(&values, samples);
    if (samples < 0.0) first = std::max(first, static_cast<std::size_t>(std::ceil(-samples)) + 1);
    if (samples > 0.0)
      end = std::min(end, record.size() -
                              std::min(record.size(), static_cast<std::size_t>(std::ceil(samples)) + 2));
  }
  if (end < first + 3)
    csv_fault(record.file, 0, {},
              refusal("the length", record.time.back() - record.time.front(), "more than delays"));
  for (const auto &[values, samples] : moved) {
    std::vector<double> at_own_time(*values);
    const auto whole = static_cast<std::ptrdiff_t>(std::floor(samples));
    const double u = samples - std::floor(samples);
    const auto value = [values = values](std::ptrdiff_t i) {
      const auto last = static_cast<std::ptrdiff_t>(values->size()) - 1;
      return (*values)[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, last))];
    };
    for (std::size_t i = first; i < end; ++i) { // the cubic through four neighbours
      const std::ptrdiff_t j = static_cast<std::ptrdiff_t>(i) + whole;
      at_own_time[i] = value(j - 1) * u * (u - 1.0) * (2.0 - u) / 6.0 +
                       value(j) * (1.0 + u) * (1.0 - u) * (2.0 - u) / 2.0 +
                       value(j + 1) * (1.0 + u) * u * (2.0 - u) / 2.0 +
                       value(j + 2) * (1.0 + u) * u * (u - 1.0) / 6.0;
    }
    *values = std::move(at_own_time);
  }
  keep_samples(record, first, end);
  for (double &time : record.time)
    time -= own;
}

} // namespace

Record read_record(const fs::path &path, const RecordOptions &options) {
  return read_record(std::vector<fs::path>{path}, options);
}

Record read_record(const std::vector<fs::path> &files, const RecordOptions &options) {
  Reading reading;
  Record &record = reading.record;
  record.file = sample_file(files.at(0), record.cycles_file);
  for (const fs::path &file : files)
    if (files.size() > 1 && (fs::is_directory(file) || is_of_run(file)))
      throw std::runtime_error(
          refusal("the record", file.string(), "a run alone, or several measured files"));
  take_parameters(record);
  take_options(record, options);
  if (record.file == record.cycles_file) return record;
  std::vector<fs::path> read = files;
  read.front() = record.file;
  read_samples(read, reading, options);
  take_piece(reading, options);
  take_times(reading, options);
  if (!options.delays.empty()) undo_delays(record, options.delays);
  take_middle(reading, record);
  check_length(record);
  check_derivative(reading, &Record::x_drum, &Record::v_drum);
  check_derivative(reading, &Record::v_drum, &Record::a_drum);
  check_derivative(reading, &Record::x_frame, &Record::v_frame);
  check_derivative(reading, &Record::v_frame, &Record::a_frame);
  check_contact_force(reading);
  check_direction(reading);
  record.excitation_read = !record.F_excitation.empty();
  if (options.low_pass) filter_signals(record, *options.low_pass);
  compute_excitation(record);
  return record;
}

std::vector<double> LoggerFilter::sections() const {
  std::vector<double> ratios;
  for (int n = 1; n <= order / 2; ++n)
    ratios.push_back(std::sin((2.0 * n - 1.0) * pi / (2.0 * order)));
  return ratios;
}

std::complex<double> LoggerFilter::response(double frequency) const {
  const std::complex<double> s(0.0, frequency / corner);
  std::complex<double> below = order % 2 == 1 ? 1.0 + s : 1.0;
  for (const double ratio : sections())
    below *= s * s + 2.0 * ratio * s + 1.0;
  return 1.0 / below;
}

double LoggerFilter::memory() const {
  constexpr double forgotten = 13.8; // exp(-13.8) is 1e-6
  return forgotten / (2.0 * pi * corner * (order == 1 ? 1.0 : std::sin(pi / (2.0 * order))));
}

LoggerFilter logger_filter_from_text(const std::string &text) {
  constexpr const char *form = "HZ,ORDER as 200,4: the corner frequency from 0.001 to 1e9 Hz and the order "
                               "from 1 to 8 of a Butterworth filter";
  const std::size_t comma = text.find(',');
  constexpr double most_order = 8.0, least_corner = 1e-3, most_corner = 1e9;
  LoggerFilter filter;
  try {
    filter.corner = number_from_text(text.substr(0, comma));
    const double order = comma == std::string::npos ? 0.0 : number_from_text(text.substr(comma + 1));
    if (!(order >= 1.0 && order <= most_order && order == std::floor(order)) ||
        !(filter.corner >= least_corner && filter.corner <= most_corner))
      throw std::invalid_argument(form);
    filter.order = static_cast<int>(order);
  } catch (const std::invalid_argument &) {
    throw std::invalid_argument(form);
  }
  return filter;
}

namespace {
constexpr double restored_share = 0.7; // of the frequencies up to where a fifth is left
}

double restored_up_to(const LoggerFilter &filter, double interval) {
  constexpr double of_power = 24.0, of_sampling = 0.45; // gain of 0.2
  const double fifth = filter.corner * std::pow(of_power, 0.5 / filter.order);
  return restored_share * std::min(fifth, of_sampling / interval);
}

std::vector<double> restored(const std::vector<double> &values, double interval, const LoggerFilter &filter) {
  if (values.empty()) return {};
  // Both ends are continued by their point reflections, and these are joined by a line.
  const auto margin = std::min(values.size() - 1, static_cast<std::size_t>(filter.memory() / interval) + 1);
  std::size_t length = 1;
  while (length < values.size() + 2 * margin + 2)
    length *= 2;
  std::vector<double> all;
  all.reserve(length);
  for (std::size_t i = margin; i > 0; --i)
    all.push_back(2.0 * values.front() - values[i]);
  all.insert(all.end(), values.begin(), values.end());
  for (std::size_t i = 1; i <= margin; ++i)
    all.push_back(2.0 * values.back() - values[values.size() - 1 - i]);
  const double from = all.back(), to = all.front();
  const auto gap = static_cast<double>(length - all.size() + 1);
  for (double n = 1.0; all.size() < length; n += 1.0)
    all.push_back(from + (to - from) * n / gap);
  std::vector<std::complex<double>> waves;
  Eigen::FFT<double> transform;
  transform.fwd(waves, all);
  const double whole = restored_up_to(filter, interval), none = whole / restored_share;
  for (std::size_t n = 0; n < length; ++n) {
    const bool upper = n > length / 2;
    const double frequency =
        static_cast<double>(upper ? length - n : n) / (static_cast<double>(length) * interval);
    const double fade = std::clamp((frequency - whole) / (none - whole), 0.0, 1.0);
    const std::complex<double> response = filter.response(frequency);
    waves[n] *= 0.5 * (1.0 + std::cos(pi * fade)) / (upper ? std::conj(response) : response);
  }
  transform.inv(all, waves);
  const auto first = all.begin() + static_cast<std::ptrdiff_t>(margin);
  return {first, first + static_cast<std::ptrdiff_t>(values.size())};
}

double low_pass_gain(double frequency, double interval, double cutoff) {
  // The filter's gain at the frequency that the bilinear transform puts in the place of an analogue one,
  // squared, since it passes the signal twice.
  const double ratio = std::tan(pi * frequency * interval) / std::tan(pi * cutoff * interval);
  return 1.0 / (1.0 + std::pow(ratio, 4));
}

std::vector<double> low_passed(const std::vector<double> &values, double interval, double cutoff) {
  if (values.empty()) return {};
  // The signal is continued beyond both ends by its point reflection there, so that the filter has settled at
  // them.
  const double samples_of_cutoff = 1.0 / (cutoff * interval);
  const std::size_t margin =
      std::min(values.size() - 1, static_cast<std::size_t>(std::min(1e9, 3.0 * samples_of_cutoff)));
  std::vector<double> all;
  all.reserve(values.size() + 2 * margin);
  for (std::size_t i = margin; i > 0; --i)
    all.push_back(2.0 * values.front() - values[i]);
  all.insert(all.end(), values.begin(), values.end());
  for (std::size_t i = 1; i <= margin; ++i)
    all.push_back(2.0 * values.back() - values[values.size() - 1 - i]);

  // Bilinear transform of 1 / (s^2 + sqrt(2) s + 1), which is 1/sqrt(2) at the cut-off, in one pass.
  const double K = std::tan(pi * cutoff * interval);
  const double scale = 1.0 / (1.0 + std::sqrt(2.0) * K + K * K);
  const double b = K * K * scale;
  const double a1 = 2.0 * (K * K - 1.0) * scale;
  const double a2 = (1.0 - std::sqrt(2.0) * K + K * K) * scale;
  const auto pass = [&](auto first, auto last) {
    double x1 = *first;
    double x2 = x1;
    double y1 = x1;
    double y2 = x1;
    for (; first != last; ++first) {
      const double x = *first;
      const double y = b * (x + 2.0 * x1 + x2) - a1 * y1 - a2 * y2;
      x2 = x1;
      x1 = x;
      y2 = y1;
      y1 = y;
      *first = y;
    }
  };
  pass(all.begin(), all.end());
  pass(all.rbegin(), all.rend());
  const auto first = all.begin() + static_cast<std::ptrdiff_t>(margin);
  return {first, first + static_cast<std::ptrdiff_t>(values.size())};
}

} // namespace drumlin::post
