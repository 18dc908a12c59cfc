#include "identify/two_sided.h"

#include "record/both_ends.h"
#include "record/excitation.h"
#include "support/csv.h"
#include "support/units.h"
#include "support/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace {

/// Single contacts of each half.
std::array<HalfStart, 2> single_contacts(const Record &record, const RecordSetting &setting,
                                         const DrumSignals &whole, double phase_within) {
  constexpr double usual_share = 0.2; // soil that a drum just touches is softer
  IdentificationSetting law;
  law.m2 = 0.5 * *record.m2;
  law.known_origin = false;
  law.phase_within = phase_within;
  law.least_force = setting.least_force.value_or(usual_share);
  std::array<HalfSignals, 2> halves = half_signals(record);
  std::array<HalfStart, 2> found;
  for (std::size_t half = 0; half < halves.size(); ++half) {
    DrumSignals signals;
    signals.dt = whole.dt;
    signals.per_cycle = whole.per_cycle;
    signals.a_drum = halves[half].acceleration;
    signals.force = std::move(halves[half].force);
    for (const auto values : {&DrumSignals::excitation, &DrumSignals::quadrature})
      for (const double force : whole.*values)
        (signals.*values).push_back(halves[half].of_exciter * force);
    try {
      found[half].contact = identify(signals, law);
    } catch (const std::runtime_error &error) {
      csv_fault(record.file, 0, {}, fmt::format("{} half: {}", half_names[half], error.what()));
    }
    found[half].acceleration = std::move(halves[half].acceleration);
  }
  return found;
}

/// Forces of the exciter over that which is said from which the motion is followed: a force that is not
/// well known has more than one valley, and the deepest counts.
std::vector<double> forces_to_start_from(const Record &record, const RecordSetting &setting) {
  constexpr double well_known = 0.01;
  const double within = record.tolerances.me_re;
  if (setting.force) return {*setting.force};
  if (within < well_known || record.excitation_read) return {1.0};
  return {1.0, 1.0 - within, 1.0 + within};
}

[[noreturn]] void refuse(const Record &record, const std::string &what, const std::string &found,
                         const std::string &allowed) {
  csv_fault(record.file, 0, {}, refusal(what, found, allowed));
}

constexpr const char *causes =
    "masses, inertia, places of bonds and sensors, eccentric moment, phase, a sign or a unit of an "
    "acceleration";

void check(const Record &record, const TwoSidedRecord &found) {
  for (std::size_t half = 0; half < half_names.size(); ++half) {
    const HalfLaw &law = found.halves[half];
    if (!(law.k.half_width < law.k.mean))
      refuse(record, fmt::format("k of the {} half", half_names[half]),
             fmt::format("{:.4g} +- {:.2g} N/m", law.k.mean, law.k.half_width),
             fmt::format("an interval that says something; to be checked: {}", causes));
    if (law.c.mean + law.c.half_width < 0.0)
      refuse(record, fmt::format("c of the {} half", half_names[half]),
             fmt::format("{:.4g} +- {:.2g} N s/m", law.c.mean, law.c.half_width),
             fmt::format("0 or more: no soil drives the drum; to be checked: {}", causes));
  }
}

} // namespace

TwoSidedRecord identify_two_sided(const Record &record, const RecordSetting &setting,
                                  const std::function<void(const std::string &)> &progress) {
  if (const std::string missing = missing_for_halves(record); !missing.empty())
    csv_fault(record.file, 0, {}, missing);
  if (record.F_excitation.empty()) refuse_drift(record);
  TwoSidedRecord result;
  result.file = record.file;
  result.cycles = record.cycles();
  result.frame_computed = record.frame_computed;
  MotionSetting known;
  const double phase_within =
      std::max({setting.phase_within, record.phase_within, 1.5 * record.phase_half_width});
  if (record.phase_half_width == 0.0) known.phase_within = phase_within;
  known.force_within = record.tolerances.me_re;
  known.search = setting.search;
  std::optional<MotionFit> motion;
  std::array<HalfStart, 2> contacts;
  for (const double force : forces_to_start_from(record, setting)) {
    if (progress) progress("the contacts of each half");
    Record other = record; // single contacts take the force as it is said
    if (force != 1.0) {
      *other.Fw *= force;
      compute_excitation(other);
    }
    std::array<HalfStart, 2> starts = single_contacts(other, setting, signals_of(other, true), phase_within);
    known.force = force;
    if (progress) progress("the motion from contact to contact");
    std::optional<MotionFit> fit = fit_motion(record, starts, known);
    if (motion && !(fit && fit->is_noise >= motion->is_noise && fit->cost < motion->cost)) continue;
    motion = std::move(fit);
    contacts = std::move(starts);
  }
  constexpr double as_noise = 1e-4; // of the drum's acceleration
  const double left = motion ? motion->residual / rms(record.a_left) : 1.0;
  if (!motion || !motion->follows(left)) refuse_doubtful(record);
  if (!motion || (!motion->is_noise && left > MotionFit::close))
    refuse(record, "what the equations of motion of drum, frame, bond and a soil below each half leave",
           motion ? fmt::format("{:.3g} % of the drum's acceleration", 100.0 * left) : std::string("all"),
           fmt::format("up to {:g} %; to be checked: {}", 100.0 * MotionFit::close, causes));
  result.motion = *motion;
  result.left = left;
  result.frequency = motion->omega.mean / (2.0 * 3.14159265358979323846);
  // If more than noise is left, the interval contains what single contacts say, too.
  const auto taken = [&](const MeanInterval &of_motion, const MeanInterval &of_contacts) {
    const bool noise = (motion->is_noise && motion->is_long()) || left < as_noise;
    return MeanInterval{of_motion.mean,
                        std::hypot(of_motion.half_width, noise ? 0.0 : of_contacts.mean - of_motion.mean)};
  };
  for (std::size_t half = 0; half < result.halves.size(); ++half) {
    HalfLaw &law = result.halves[half];
    const ContactFit &fit = motion->contacts[half];
    law.contact = contacts[half].contact;
    const std::vector<double> &force = law.contact.force;
    constexpr double touching = 0.02; // of the largest force
    const double least = touching * *std::max_element(force.begin(), force.end());
    law.contact_share = static_cast<double>(std::count_if(force.begin(), force.end(),
                                                          [least](double f) { return f > least; })) /
                        static_cast<double>(force.size());
    law.k = taken(fit.k, law.contact.law.k);
    law.c = taken(fit.c, law.contact.law.c);
    const double to_D = 1.0 / (2.0 * std::sqrt(0.5 * *record.m2 * law.k.mean));
    const double of_k = 0.5 * law.c.mean / law.k.mean * law.k.half_width;
    law.D = {law.c.mean * to_D,
             to_D * std::sqrt(std::max(0.0, law.c.half_width * law.c.half_width + of_k * of_k -
                                                2.0 * fit.correlation * of_k * law.c.half_width))};
  }
  const MeanInterval &k_left = result.halves[0].k, &k_right = result.halves[1].k;
  const auto together = [&](double of_left, double of_right) {
    const double l = of_left * k_left.half_width, r = of_right * k_right.half_width;
    return std::sqrt(std::max(0.0, l * l + r * r + 2.0 * motion->k_together * l * r));
  };
  result.k = {k_left.mean + k_right.mean, together(1.0, 1.0)};
  result.ratio = {k_left.mean / k_right.mean,
                  together(1.0 / k_right.mean, -k_left.mean / (k_right.mean * k_right.mean))};
  check(record, result);
  return result;
}

} // namespace drumlin::post
