#include "record/record.h"

#include "runs/parameter_file.h"
#include "support/csv.h"
#include "support/range.h"
#include "support/statistics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr double pi = 3.14159265358979323846;

/// The signals that are read: all columns but `time` and F_bond, the first and the last.
constexpr auto record_signals = [] {
  std::array<HistoryColumn, history_columns.size() - 2> signals{};
  for (std::size_t i = 0; i < signals.size(); ++i)
    signals[i] = history_columns[i + 1];
  return signals;
}();

struct Unit {
  const char *name;
  double factor;
  int derivative;
};
constexpr std::array<Unit, 19> units = {{{"s", 1.0, time_column},
                                         {"ms", 1e-3, time_column},
                                         {"us", 1e-6, time_column},
                                         {"m", 1.0, 0},
                                         {"cm", 1e-2, 0},
                                         {"mm", 1e-3, 0},
                                         {"um", 1e-6, 0},
                                         {"m/s", 1.0, 1},
                                         {"cm/s", 1e-2, 1},
                                         {"mm/s", 1e-3, 1},
                                         {"um/s", 1e-6, 1},
                                         {"m/s2", 1.0, 2},
                                         {"cm/s2", 1e-2, 2},
                                         {"mm/s2", 1e-3, 2},
                                         {"um/s2", 1e-6, 2},
                                         {"g", 9.80665, 2},
                                         {"N", 1.0, force_column},
                                         {"kN", 1e3, force_column},
                                         {"MN", 1e6, force_column}}};

/// What its unit measures; nothing for a name that is neither `time` nor a signal.
std::optional<int> dimension_of(const std::string &name) {
  if (name == "time") return time_column;
  for (const HistoryColumn &signal : record_signals)
    if (name == signal.name) return signal.derivative;
  return std::nullopt;
}

std::string signal_names() {
  std::string names = "time";
  for (const HistoryColumn &signal : record_signals)
    names += fmt::format(", {}", signal.name);
  return names;
}

double factor_of(const std::string &unit, int dimension) {
  const bool negative = !unit.empty() && unit.front() == '-' && dimension != time_column;
  const std::string name = negative ? unit.substr(1) : unit;
  std::vector<const char *> allowed;
  for (const Unit &known : units) {
    if (known.derivative != dimension) continue;
    if (name == known.name) return negative ? -known.factor : known.factor;
    allowed.push_back(known.name);
  }
  throw std::invalid_argument(
      refusal("the unit", unit,
              fmt::format("{}{}", fmt::join(allowed, ", "),
                          dimension == time_column ? "" : ", with '-' before it to turn the sign")));
}

double rms(const std::vector<double> &values) {
  const double squares = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return values.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(values.size()));
}

double mean(const std::vector<double> &values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// A record being read, with what its messages name.
struct Reading {
  Record record;
  std::vector<std::size_t> lines;   ///< of the samples in the file
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
                                   "CSV file with a header line"));
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
  if (!is_of_run(record.file)) return;
  record.phase = 0.0;
  const fs::path file = record.file.parent_path() / "parameters.csv";
  if (!fs::is_regular_file(file)) return;
  record.parameters = read_parameters(file);
  for (const auto &[name, value] :
       {std::pair{"omega", &record.omega}, std::pair{"Fw", &record.Fw}, std::pair{"m2", &record.m2},
        std::pair{"m3", &record.m3}, std::pair{"g", &record.g}})
    take_number(record, file, name, *value);
  for (const auto &[name, value] : {std::pair{"omega", record.omega}, std::pair{"m2", record.m2}})
    if (value && !(*value > 0.0))
      throw std::runtime_error(
          fmt::format("{}: {}", file.string(), refusal(name, *value, "numbers above 0")));
}

void take_options(Record &record, const RecordOptions &options) {
  if (options.omega) record.omega = options.omega;
  if (options.phase) record.phase = options.phase;
  if (options.Fw) record.Fw = options.Fw;
  if (options.m2) record.m2 = options.m2;
  if (options.m3) record.m3 = options.m3;
  if (options.me_re && record.omega) record.Fw = *options.me_re * *record.omega * *record.omega;
}

/// A column that is read into a signal.
struct Taken {
  std::vector<double> *into;
  std::size_t place;
  double factor;
  std::string header;
};

/// The columns of the file that are read, `time` among them if it has one.
std::vector<Taken> columns_to_take(const CsvRows &rows, const RecordOptions &options, Reading &reading) {
  std::vector<Taken> taken;
  const auto find = [&](const std::string &name, std::vector<double> &into, bool own_name) {
    const auto given = options.columns.find(name);
    const bool named = given != options.columns.end();
    if (!named && !own_name) return std::string();
    const ColumnSource source = named ? given->second : ColumnSource{name, 1.0};
    const std::optional<std::size_t> place = rows.find(source.header);
    if (!place && named) rows.missing(source.header);
    if (place) taken.push_back({&into, *place, source.factor, source.header});
    return source.header;
  };
  const bool any_signal_named = options.columns.size() > options.columns.count("time");
  find("time", reading.record.time, true);
  const std::size_t of_time = taken.size();
  for (const HistoryColumn &signal : record_signals)
    reading.headers.push_back(find(signal.name, reading.record.*signal.values, !any_signal_named));
  if (taken.size() == of_time)
    csv_fault(reading.record.file, 0, {},
              fmt::format("has no column of motion or force; allowed: columns named {}, or others by "
                          "--column NAME=HEADER:UNIT",
                          signal_names()));
  if (of_time == 0 && !options.sampling_rate) rows.missing("time");
  return taken;
}

void read_samples(Reading &reading, const RecordOptions &options) {
  CsvRows rows(reading.record.file);
  const std::vector<Taken> taken = columns_to_take(rows, options, reading);
  std::vector<std::string> cells;
  while (rows.next(cells)) {
    for (const Taken &column : taken)
      column.into->push_back(
          column.factor * csv_number(reading.record.file, rows.line(), column.header, cells[column.place]));
    reading.lines.push_back(rows.line());
  }
}

/// Refuses times that do not grow, gaps, and steps that are not equal to 1 %; with a sampling rate given,
/// steps of less than half or more than one and a half of its interval, and a length that differs by 0.1 %.
void check_steps(const Reading &reading, double interval, bool rate_given) {
  const std::vector<double> &time = reading.record.time;
  const auto refuse = [&](std::size_t row, const std::string &allowed) {
    csv_refusal(reading.record.file, reading.lines[row], "time", fmt::format("{}", time[row]), allowed);
  };
  std::vector<double> steps;
  for (std::size_t row = 1; row < time.size(); ++row) {
    if (!(time[row] > time[row - 1]))
      refuse(row, fmt::format("more than {} of the row before", time[row - 1]));
    steps.push_back(time[row] - time[row - 1]);
  }
  const double usual = rate_given ? interval : median(steps);
  for (std::size_t row = 1; row < time.size(); ++row)
    if (steps[row - 1] > 1.5 * usual)
      refuse(row,
             fmt::format("times without a gap: at most 1.5 steps of {:g} s after the row before", usual));
  const double length = interval * static_cast<double>(steps.size());
  for (std::size_t row = 1; row < time.size(); ++row) {
    const double place = time.front() + interval * static_cast<double>(row);
    if (rate_given
            ? steps[row - 1] < 0.5 * interval || std::fabs(time[row] - place) > 1e-3 * length + interval
            : std::fabs(time[row] - place) > 0.01 * interval)
      refuse(row, rate_given ? fmt::format("{:g} to one sample, as the sampling rate says", place)
                             : fmt::format("equal steps: {} to 1 % of the step of {:g} s, or times with few "
                                           "digits together with the sampling rate",
                                           place, interval));
  }
}

/// Checks the times and sets the interval; without a column of time they count from 0.
void take_times(Reading &reading, const RecordOptions &options) {
  Record &record = reading.record;
  const std::size_t count = reading.lines.size();
  if (count < 3)
    csv_fault(record.file, 0, {}, refusal("the number of rows", fmt::format("{}", count), "3 or more"));
  const auto steps = static_cast<double>(count - 1);
  const bool stamped = !record.time.empty();
  record.interval = options.sampling_rate ? 1.0 / *options.sampling_rate
                                          : (record.time.back() - record.time.front()) / steps;
  if (stamped) check_steps(reading, record.interval, options.sampling_rate.has_value());
  if (stamped && !options.sampling_rate) return;
  const double start = stamped ? record.time.front() : 0.0;
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

void filter(Record &record, const RecordOptions &options) {
  if (!options.low_pass) return;
  const double most = 0.5 / record.interval;
  if (!(*options.low_pass > 0.0 && *options.low_pass < most))
    throw std::runtime_error(
        refusal("the cut-off frequency", *options.low_pass,
                fmt::format("numbers above 0 and below half the sampling rate, {:g} [Hz]", most)));
  for (const HistoryColumn &signal : record_signals)
    record.*signal.values = low_passed(record.*signal.values, record.interval, *options.low_pass);
}

void compute_excitation(Record &record) {
  if (!record.F_excitation.empty() || !record.omega || !record.phase || !record.Fw) return;
  std::transform(record.time.begin(), record.time.end(), std::back_inserter(record.F_excitation),
                 [&record](double t) { return *record.Fw * std::sin(*record.omega * t + *record.phase); });
}

} // namespace

double Record::period() const {
  if (!omega)
    csv_fault(file, 0, {},
              refusal("the frequency of the excitation", "",
                      "a number above 0 [Hz], which no parameters.csv gives"));
  return 2.0 * pi / *omega;
}

double Record::cycles() const {
  return size() < 2 ? 0.0 : interval * static_cast<double>(size() - 1) / period();
}

std::pair<std::string, ColumnSource> column_from_text(const std::string &text) {
  constexpr const char *form = "NAME=HEADER or NAME=HEADER:UNIT";
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw std::invalid_argument(form);
  const std::string name = text.substr(0, equals);
  const std::optional<int> dimension = dimension_of(name);
  if (!dimension) throw std::invalid_argument(fmt::format("{}, NAME one of {}", form, signal_names()));
  ColumnSource source{text.substr(equals + 1), 1.0};
  if (const std::size_t colon = source.header.rfind(':'); colon != std::string::npos) {
    source.factor = factor_of(source.header.substr(colon + 1), *dimension);
    source.header.erase(colon);
  }
  if (source.header.empty()) throw std::invalid_argument(form);
  return {name, source};
}

Record read_record(const fs::path &path, const RecordOptions &options) {
  Reading reading;
  Record &record = reading.record;
  record.file = sample_file(path, record.cycles_file);
  take_parameters(record);
  take_options(record, options);
  if (record.file == record.cycles_file) return record;
  read_samples(reading, options);
  take_times(reading, options);
  check_length(record);
  check_derivative(reading, &Record::x_drum, &Record::v_drum);
  check_derivative(reading, &Record::v_drum, &Record::a_drum);
  check_derivative(reading, &Record::x_frame, &Record::v_frame);
  check_derivative(reading, &Record::v_frame, &Record::a_frame);
  check_contact_force(reading);
  check_direction(reading);
  filter(record, options);
  compute_excitation(record);
  return record;
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
