#include "identify/identified_record.h"

#include "chain/linear_algebra.h"
#include "identify/motion_fit.h"
#include "meter/values.h"
#include "record/excitation.h"
#include "support/csv.h"
#include "support/units.h"
#include "support/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace drumlin::post {

namespace {

void need(const Record &record, bool there, const char *name, const char *allowed) {
  if (!there) csv_fault(record.file, 0, {}, refusal(name, "", allowed));
}

// Fw cos(omega t + phase) of an excitation F_e = Fw sin(omega t + phase), whose phase and amplitude are those
// of the record's F_e by least squares.
std::vector<double> quadrature_of(const std::vector<double> &excitation, const Record &record) {
  if (!record.wander.empty()) {
    std::vector<double> quadrature;
    for (std::size_t i = 0; i < record.size(); ++i)
      quadrature.push_back(*record.Fw * record.force_share(i) * std::cos(record.angle(i)));
    return quadrature;
  }
  const auto n = static_cast<Eigen::Index>(excitation.size());
  Eigen::MatrixXd waves(n, 2);
  Eigen::VectorXd force(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double angle = *record.omega * record.time[static_cast<std::size_t>(i)];
    waves(i, 0) = std::sin(angle);
    waves(i, 1) = std::cos(angle);
    force[i] = excitation[static_cast<std::size_t>(i)];
  }
  const Eigen::Vector2d parts = LeastSquares(waves).solution(force);
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
  if (record.F_excitation.empty() && record.omega) refuse_drift(record);
  need(
      record, !record.F_excitation.empty(), "the excitation force",
      "a column F_excitation, or --frequency with --Fw or --me-re, and --phase or --column pulse, since no "
      "flights of the drum tell the phase here; 'drumlin meter' needs none for harmonics, CMV, RMV and mode");
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
    return fmt::format("k is {:.4g} +- {:.2g} N/m, which says nothing, of {} contacts or cycles; to be "
                       "checked: whether the record is long enough, {}",
                       law.k.mean, law.k.half_width, law.blocks, causes);
  constexpr double much = 0.5; // of the drum's acceleration
  if (record.left && *record.left > much)
    return fmt::format(
        "drum, frame, bond and soil leave {:.3g} % of the drum's acceleration; to be checked: {}",
        100.0 * *record.left, causes);
  constexpr double rounding = -0.02; // of D, for a soil without damping
  if (negative(law.c) || law.D.mean < rounding)
    return fmt::format("c is {:.4g} +- {:.2g} N s/m, and no soil drives the drum; to be checked: {}",
                       law.c.mean, law.c.half_width, causes);
  constexpr double least_r2 = 0.5;
  if (!record.motion && law.r2 < least_r2)
    return fmt::format("R2 is {:.3f}: a spring and a dashpot explain too little of the force; to be checked: "
                       "{}, and --origin",
                       law.r2, causes);
  constexpr double poor = 0.9; // R2 of a law that does not follow the tension that it is said to have
  if (record.whole.pull == Pull::pulls && law.r2 < poor)
    return fmt::format(
        "a tension of {:.4g} N is seen, but the law explains only {:.0f} % of the force; to be "
        "checked: {}",
        record.whole.tension, 100.0 * law.r2, causes);
  return std::nullopt;
}

namespace {

/// Share of the drum's acceleration that may be left of a record behind the logger's filter.
constexpr double most_left_of_filtered = 0.003;

/// Whether the record has what the equations of motion of drum and frame need, and no positions beside it.
bool has_motion(const Record &record) {
  return !record.pieces.empty() && !record.excitation_read && record.omega && record.Fw && record.m2 &&
         record.m3 && !record.a_drum.empty() && !record.a_frame.empty() && record.low_pass == 0.0;
}

/// Sets the exciter's phase of a record whose flights do not tell it: of phases fifteen degrees apart that
/// from which the equations of motion follow some cycles best. Whether no phase makes them follow to the
/// noise.
bool find_phase(Record &record, const IdentificationSetting &law) {
  if (!has_motion(record)) return false;
  constexpr double cycles = 12.0;
  Record part = record;
  const auto size =
      std::min(record.size(), static_cast<std::size_t>(cycles * record.period() / record.interval) + 1);
  keep_samples(part, 0, size);
  for (std::vector<double> *values :
       {&part.x_drum, &part.v_drum, &part.x_frame, &part.v_frame, &part.F_contact})
    values->clear();
  const auto fit_from = [&](double phase, const MotionSetting &setting) -> std::optional<MotionFit> {
    part.phase = phase;
    compute_excitation(part);
    try {
      const Identification found = identify(signals_of(part, true), law);
      if (!(found.law.k.mean > 0.0 && found.law.c.mean > 0.0)) return std::nullopt;
      return fit_motion(part, found, setting);
    } catch (const std::runtime_error &) { // no contact with this phase
      return std::nullopt;
    }
  };
  const double in_all = rms(part.a_drum);
  const auto follows = [&](const MotionFit &fit) {
    return fit.is_noise || (record.logger_filter && fit.residual < most_left_of_filtered * in_all);
  };
  std::optional<MotionFit> best;
  constexpr int trials = 8;
  for (int trial = 0; trial < trials; ++trial) {
    const std::optional<MotionFit> fit = fit_from(2.0 * pi * trial / trials, {std::nullopt, 0.0, false});
    if (fit && follows(*fit) && (!best || fit->residual < best->residual)) best = fit;
  }
  // In unbroken contact a phase fits as well as another, up to that at which contact would just be lost.
  constexpr double most = 5.0 * degree;
  if (!best || best->phase.half_width > most) return false;
  const double as_good = (1.0 + 4.0 / std::sqrt(static_cast<double>(part.size()))) * best->residual;
  for (const double other : {-4.0, 4.0, -8.0, 8.0, -15.0, 15.0}) {
    constexpr double held = 1e-4;
    part.omega = best->omega.mean;
    const std::optional<MotionFit> fit = fit_from(best->phase.mean + other * degree, {held, 0.0, false});
    if (fit && fit->residual < as_good) return false;
  }
  record.phase = best->phase.mean;
  record.Fw = *record.Fw * std::pow(best->omega.mean / *record.omega, 2);
  record.omega = best->omega.mean;
  record.phase_half_width = best->phase.half_width;
  compute_excitation(record);
  return true;
}

/// Takes over what the whole motion says. If more than noise is left of the record, the interval contains
/// what single contacts say, too.
void take_motion(const MotionFit &motion, const Record &record, IdentifiedRecord &result) {
  LawEstimate &law = result.whole.law;
  const auto taken = [&](const MeanInterval &of_motion, const MeanInterval &of_contacts) {
    constexpr double wider = 3.0; // behind a filter single contacts say nothing of the error
    if (record.logger_filter && !motion.is_noise)
      return MeanInterval{of_motion.mean, wider * of_motion.half_width};
    const double off = motion.is_noise && motion.is_long() ? 0.0 : of_contacts.mean - of_motion.mean;
    return MeanInterval{of_motion.mean, std::hypot(of_motion.half_width, off)};
  };
  const ContactFit &contact = motion.contacts.front();
  law.k = taken(contact.k, law.k);
  law.c = taken(contact.c, law.c);
  const double to_D = 1.0 / (2.0 * std::sqrt(*record.m2 * law.k.mean));
  const double of_k = 0.5 * law.c.mean / law.k.mean * law.k.half_width;
  law.D = {law.c.mean * to_D,
           to_D * std::sqrt(std::max(0.0, law.c.half_width * law.c.half_width + of_k * of_k -
                                              2.0 * contact.correlation * of_k * law.c.half_width))};
  law.phase = {std::remainder(motion.phase.mean - *record.phase, 2.0 * pi), motion.phase.half_width};
  result.frequency = motion.omega.mean / (2.0 * pi);
  result.motion = motion;
  if (!motion.pull_is_clear) return;
  result.whole.pull = motion.pulls ? Pull::pulls : Pull::does_not_pull;
  result.whole.tension = motion.tension;
}

/// Identifies a record whose excitation is known.
IdentifiedRecord identify_with_phase(const Record &record, const RecordSetting &setting,
                                     IdentificationSetting law,
                                     const std::function<void(const std::string &)> &progress) {
  IdentifiedRecord result;
  result.file = record.file;
  result.part_read = record.part_read;
  result.known_origin = law.known_origin;
  const DrumSignals signals = signals_of(record, setting.accelerations_only);
  result.frequency = *record.omega / (2.0 * pi);
  result.cycles = record.cycles();
  // An interval of 95 % is exceeded by errors of half its size more now and then.
  const double phase_within =
      std::max({setting.phase_within, record.phase_within, 1.5 * record.phase_half_width});
  law.phase_within = phase_within;
  result.phase_known = phase_within == 0.0;
  if (record.a_frame.empty() || record.frame_computed) { // the frame's force, or what its bond makes of it
    double most = record.a_frame.empty() ? 0.5 * record.g.value_or(ChainParameters().g) : 0.0;
    for (const double a : record.a_frame)
      most = std::max(most, record.bond->tolerance * std::fabs(a));
    law.force_within = *record.m3 * most;
  }
  result.positions = !signals.x_drum.empty() || !signals.v_drum.empty();
  result.frame = !record.a_frame.empty();
  result.frame_computed = record.frame_computed;
  result.force_difference = force_difference(signals.force, record.F_contact);
  result.time = record.time;
  result.s = record.s;
  result.per_cycle = signals.per_cycle;
  try {
    result.whole = identify(signals, law, [&progress](double share) {
      if (progress) progress(fmt::format("the whole record: {:.0f} %", 100.0 * share));
    });
  } catch (const std::runtime_error &error) {
    csv_fault(record.file, 0, {}, error.what());
  }
  add_meter_values(record, result);
  if (!record.logger_filter && setting.window > 0) // of single contacts, whose landings a filter smooths
    result.windows = windows_of(signals, law, result, setting.window, progress);
  if (has_motion(record) && !result.positions) {
    MotionSetting known;
    if (record.phase_half_width == 0.0) known.phase_within = phase_within;
    known.force_within = record.tolerances.me_re;
    known.search = setting.search;
    if (progress) progress("the motion from contact to contact");
    if (const std::optional<MotionFit> motion = fit_motion(record, result.whole, known)) {
      const double close = record.logger_filter ? most_left_of_filtered : MotionFit::close;
      result.left = motion->residual / rms(record.a_drum);
      if (motion->is_noise || *result.left < close) {
        take_motion(*motion, record, result);
      } else { // both are wrong: by as much as they differ, or more
        LawEstimate &of_contacts = result.whole.law;
        const ContactFit &of_motion = motion->contacts.front();
        for (const auto &[value, other] :
             {std::pair{&of_contacts.k, of_motion.k}, std::pair{&of_contacts.c, of_motion.c}})
          value->half_width = std::hypot(value->half_width, value->mean - other.mean);
      }
    }
  }
  return result;
}

} // namespace

namespace {

/// Whether the whole motion of a record whose phase find_phase() took from some cycles tells it, too.
bool tells_phase(const IdentifiedRecord &found) {
  constexpr double most = 3.0 * pi / 180.0;
  const bool follows = found.motion && (found.motion->is_noise || *found.left < most_left_of_filtered);
  return follows && found.motion->phase.half_width < most;
}

IdentifiedRecord identify_from_any_phase(const Record &given, const RecordSetting &setting,
                                         const std::function<void(const std::string &)> &progress) {
  constexpr double usual_share = 0.2; // soil that a drum just touches is softer
  IdentificationSetting law;
  law.m2 = given.m2.value_or(0.0);
  law.known_origin = setting.known_origin.value_or(given.known_origin);
  law.least_force = setting.least_force.value_or(given.known_origin ? 0.0 : usual_share);
  if (given.F_excitation.empty()) {
    Record record = given;
    if (find_phase(record, law)) {
      IdentifiedRecord found = identify_with_phase(record, setting, law, progress);
      if (tells_phase(found)) return found;
    }
    refuse_doubtful(given);
    return identify_with_phase(given, setting, law, progress); // says what is missing
  }
  IdentifiedRecord found = identify_with_phase(given, setting, law, progress);
  if (!found.left || (found.motion && found.motion->is_noise)) return found;
  // What looked like flights may have been a contact of little force.
  Record other = given;
  if (given.phase_half_width == 0.0 || !find_phase(other, law)) return found;
  IdentifiedRecord again = identify_with_phase(other, setting, law, progress);
  return tells_phase(again) ? again : found;
}

} // namespace

IdentifiedRecord identify_record(const Record &record, const RecordSetting &setting,
                                 const std::function<void(const std::string &)> &progress) {
  IdentifiedRecord result = identify_from_any_phase(record, setting, progress);
  if (!result.motion || !result.motion->follows(*result.left)) refuse_doubtful(record);
  if (record.logger_filter && !result.motion)
    csv_fault(
        record.file, 0, {},
        refusal("what the equations of motion of drum, frame, bond and soil leave of the filtered record",
                result.left ? fmt::format("{:.3g} % of the drum's acceleration", 100.0 * *result.left)
                            : std::string("all"),
                fmt::format("up to {:g} %, since single contacts, whose landings a filter smooths, tell "
                            "too little; to be checked: corner frequency, order and kind of the filter, "
                            "masses, signs and units",
                            100.0 * most_left_of_filtered)));
  return result;
}

} // namespace drumlin::post
