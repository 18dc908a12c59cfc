#include "identify/identified_record.h"

#include "meter/values.h"
#include "support/csv.h"
#include "support/range.h"

#include <Eigen/QR>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace drumlin::post {

namespace {

constexpr double pi = 3.14159265358979323846;

void need(const Record &record, bool there, const char *name, const char *allowed) {
  if (!there) csv_fault(record.file, 0, {}, refusal(name, "", allowed));
}

// Fw cos(omega t + phase) of an excitation F_e = Fw sin(omega t + phase), whose phase and amplitude are those
// of the record's F_e by least squares.
std::vector<double> quadrature_of(const std::vector<double> &excitation, const Record &record) {
  const auto n = static_cast<Eigen::Index>(excitation.size());
  Eigen::MatrixXd waves(n, 2);
  Eigen::VectorXd force(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double angle = *record.omega * record.time[static_cast<std::size_t>(i)];
    waves(i, 0) = std::sin(angle);
    waves(i, 1) = std::cos(angle);
    force[i] = excitation[static_cast<std::size_t>(i)];
  }
  const Eigen::Vector2d parts = waves.colPivHouseholderQr().solve(force);
  std::vector<double> quadrature(excitation.size());
  for (Eigen::Index i = 0; i < n; ++i)
    quadrature[static_cast<std::size_t>(i)] = parts[0] * waves(i, 1) - parts[1] * waves(i, 0);
  return quadrature;
}

double force_difference(const std::vector<double> &computed, const std::vector<double> &recorded) {
  if (recorded.empty()) return -1.0;
  double squares = 0.0;
  double differences = 0.0;
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    squares += recorded[i] * recorded[i];
    differences += std::pow(computed[i] - recorded[i], 2);
  }
  return std::sqrt(differences / squares);
}

std::vector<LawWindow> windows_of(const DrumSignals &signals, const IdentificationSetting &setting,
                                  const IdentifiedRecord &record, int length,
                                  const std::function<void(const std::string &)> &progress) {
  std::vector<LawWindow> windows;
  constexpr double rounding = 1e-6;
  const int all = static_cast<int>(std::floor(record.cycles + rounding));
  const int cycles = std::min(length, all);
  for (int first = 0; first + cycles <= all; first += cycles) {
    const auto sample = [&](int cycle) {
      return std::min(signals.size(),
                      static_cast<std::size_t>(std::lround(static_cast<double>(cycle) * signals.per_cycle)));
    };
    LawWindow window;
    window.first_cycle = first + 1;
    window.begin = record.time.front() + first / record.frequency;
    window.end = record.time.front() + (first + cycles) / record.frequency;
    try {
      window.law = identify_window(signals, setting, record.whole, {sample(first), sample(first + cycles)});
    } catch (const std::runtime_error &error) {
      window.why_not = error.what();
    }
    windows.push_back(std::move(window));
    if (progress) progress(fmt::format("windows: cycle {} of {}", first + cycles, all));
  }
  return windows;
}

// The meter's stiffness over the whole record; none if the record does not give it.
void add_meter_values(const Record &record, IdentifiedRecord &result) {
  const MeterRecord meter = meter_cycles(record);
  MeterOptions options;
  options.window = static_cast<int>(meter.cycles.size() / 2 * 2);
  const std::vector<MeterWindow> windows = meter_windows(meter, options);
  if (windows.empty()) return;
  result.k_B = windows.front().k_B;
  result.k_1 = windows.front().k_1;
}

} // namespace

DrumSignals signals_of(const Record &record, bool accelerations_only) {
  need(record, !record.time.empty(), "the table of samples", "a record with samples, not cycles.csv alone");
  need(record, !record.a_drum.empty(), "the column a_drum", "the acceleration of the drum");
  need(record, record.m2.has_value(), "m2", "the mass of the drum in parameters.csv, or --m2");
  need(record, record.m3.has_value(), "m3", "the mass of the frame in parameters.csv, or --m3");
  need(
      record, !record.F_excitation.empty(), "the excitation force",
      "a column F_excitation, or --frequency with --Fw or --me-re, and --phase, which no flights of the drum "
      "tell here");
  constexpr double usual_gravity = 9.81;
  const double weight = (*record.m2 + *record.m3) * record.g.value_or(usual_gravity);
  DrumSignals signals;
  signals.dt = record.interval;
  signals.per_cycle = record.period() / record.interval;
  signals.a_drum = record.a_drum;
  signals.excitation = record.F_excitation;
  signals.quadrature = quadrature_of(record.F_excitation, record);
  signals.force.resize(record.size());
  for (std::size_t i = 0; i < record.size(); ++i)
    signals.force[i] = weight + *record.m2 * record.a_drum[i] +
                       (record.a_frame.empty() ? 0.0 : *record.m3 * record.a_frame[i]) +
                       record.F_excitation[i];
  if (!accelerations_only) {
    signals.x_drum = record.x_drum;
    signals.v_drum = record.v_drum;
  }
  return signals;
}

std::optional<std::string> contradiction(const IdentifiedRecord &record) {
  const LawEstimate &law = record.whole.law;
  constexpr const char *causes =
      "masses, eccentric moment, phase, a sign or a unit of an acceleration, a sensor at "
      "its limit, a filter";
  const auto negative = [](const MeanInterval &value) { return value.mean + value.half_width < 0.0; };
  if (!(law.k.mean > 0.0))
    return fmt::format("k is {:.4g} N/m, and no soil has a negative stiffness; to be checked: {}", law.k.mean,
                       causes);
  if (law.k.half_width > law.k.mean)
    return fmt::format("k is {:.4g} +- {:.2g} N/m, which says nothing; to be checked: {}", law.k.mean,
                       law.k.half_width, causes);
  if (negative(law.c))
    return fmt::format("c is {:.4g} +- {:.2g} N s/m, and no soil drives the drum; to be checked: {}",
                       law.c.mean, law.c.half_width, causes);
  constexpr double poor = 0.9; // R2 of a law that does not follow the tension that it is said to have
  if (record.whole.pull == Pull::pulls && law.r2 < poor)
    return fmt::format(
        "a tension of {:.4g} N is seen, but the law explains only {:.0f} % of the force; to be "
        "checked: {}",
        record.whole.tension, 100.0 * law.r2, causes);
  return std::nullopt;
}

IdentifiedRecord identify_record(const Record &record, const RecordSetting &setting,
                                 const std::function<void(const std::string &)> &progress) {
  const DrumSignals signals = signals_of(record, setting.accelerations_only);
  IdentifiedRecord result;
  result.file = record.file;
  result.frequency = *record.omega / (2.0 * pi);
  result.cycles = record.cycles();
  const bool of_chain = record.file.filename() == "chain.csv";
  constexpr double usual_share = 0.2; // soil that a drum just touches is softer
  result.known_origin = setting.known_origin.value_or(of_chain);
  // An interval of 95 % is exceeded by errors of half its size more now and then.
  const double phase_within = std::max(setting.phase_within, 1.5 * record.phase_half_width);
  result.phase_known = phase_within == 0.0;
  result.positions = !signals.x_drum.empty() || !signals.v_drum.empty();
  result.frame = !record.a_frame.empty();
  result.force_difference = force_difference(signals.force, record.F_contact);
  result.time = record.time;
  result.per_cycle = signals.per_cycle;
  const IdentificationSetting law = {*record.m2, result.known_origin, phase_within,
                                     setting.least_force.value_or(of_chain ? 0.0 : usual_share)};
  try {
    result.whole = identify(signals, law, [&progress](double share) {
      if (progress) progress(fmt::format("the whole record: {:.0f} %", 100.0 * share));
    });
  } catch (const std::runtime_error &error) {
    csv_fault(record.file, 0, {}, error.what());
  }
  add_meter_values(record, result);
  result.windows = windows_of(signals, law, result, setting.window, progress);
  return result;
}

} // namespace drumlin::post
