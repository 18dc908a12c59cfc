// What the report measures in a run of the chain: pure functions from histories and events to numbers.
// SI units throughout; times count from the start of the excitation; forces are positive in compression.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "chain/parameters.h"
#include "chain/run_files.h"

namespace drumlin::post {

/// A stretch of time (s), begin included, end not.
struct TimeWindow {
  double begin = 0.0; ///< s
  double end = 0.0;   ///< s
};

/// Smallest and largest value of something.
struct Extremes {
  double min = 0.0;
  double max = 0.0;
};

/// Number of complete excitation cycles in a history that starts at time 0.
/// last_time and period in s; a last row within 1e-6 of a period counts as the full cycle.
int complete_cycles(double last_time, double period);

/// The last `count` of `complete` cycles as a window of time (all of them if there are fewer).
TimeWindow last_cycles_window(int complete, int count, double period);

/// Relative RMS difference sqrt(sum (a - b)^2 / sum b^2) over rows [first, last). NaN for an empty range;
/// `truth` and `values` must have `last` rows at least.
double relative_rms(const std::vector<double> &values, const std::vector<double> &truth, std::size_t first,
                    std::size_t last);

/// Share of the window spent in contact, exact from located events. The state at the window's start follows
/// from the last event before it; without one, from the first event after it (a break means: was in contact);
/// without any event, `initially` holds throughout.
double contact_share(const std::vector<ContactEvent> &events, TimeWindow window, bool initially);

/// Events with begin <= time < end.
std::vector<ContactEvent> events_in(const std::vector<ContactEvent> &events, TimeWindow window);

/// Amplitudes of drum acceleration (m/s2) at 1, 2 and 1/2 times the excitation frequency.
struct HarmonicAmplitudes {
  double fundamental = 0.0;
  double second = 0.0;
  double half = 0.0;
};

/// Compaction meter value CMV = 300 A_2 / A_1 (-).
double compaction_meter_value(const HarmonicAmplitudes &amplitudes);

/// Resonance meter value RMV = 100 A_0.5 / A_1 (-).
double resonance_meter_value(const HarmonicAmplitudes &amplitudes);

/// Amplitudes by integrating a piecewise linear record a(t) (m/s2 over s) exactly against cosine and sine
/// over the window. Two rows at one time are a jump. The window should span an even whole number of cycles.
HarmonicAmplitudes harmonic_amplitudes(const std::vector<double> &time, const std::vector<double> &value,
                                       double omega, TimeWindow window);

/// Amplitudes from the per-cycle integrals a1_cos ... ah_sin (m/s2) of the last `count` rows; `count` is
/// reduced to an even number of rows that exist. Nothing if columns or rows are missing.
std::optional<HarmonicAmplitudes> harmonic_amplitudes(const CycleColumns &cycles, std::size_t count);

/// Drum acceleration (m/s2) just before and just after an event. The force jumps there and the rest of the
/// drum's equation of motion is continuous: rest = m2 a - F_contact. Between two rows the rest is a straight
/// line up to a kink at the event; with the frame in the history it is evaluated from the equation of motion
/// at the event itself (positions and velocities by cubic interpolation, drum velocity = -overlap rate).
struct EventAcceleration {
  double before = 0.0;
  double after = 0.0;
};
EventAcceleration acceleration_at(const ContactEvent &event, const ChainHistory &history,
                                  const ChainParameters &parameters);

/// A history with the events' two sides put in, so that jumps are upright in a plot and exact in an integral.
struct EventSeries {
  std::vector<double> time;         ///< s; two rows at one time are an event
  std::vector<double> overlap;      ///< m
  std::vector<double> velocity;     ///< of the drum, m/s
  std::vector<double> force;        ///< contact force, N
  std::vector<double> acceleration; ///< of the drum, m/s2
  std::vector<char> event;          ///< 1 where the row is a side of an event
};
EventSeries with_events(const ChainHistory &history, const std::vector<ContactEvent> &events,
                        const ChainParameters &parameters, TimeWindow window);

/// Extremes of the steady state: per-cycle extremes of every step (last `count` rows of cycles.csv) if given,
/// else the rows of the history, merged with both sides of the window's located events.
struct SteadyExtremes {
  Extremes acceleration;   ///< drum, m/s2
  Extremes force;          ///< contact, N
  bool every_step = false; ///< taken from every step of the engine rather than from samples
};
SteadyExtremes steady_extremes(const ChainHistory &history, const std::vector<ContactEvent> &events,
                               const std::optional<CycleColumns> &cycles, const ChainParameters &parameters,
                               TimeWindow window, std::size_t count);

/// Events of a run paired with those of the truth, by order.
struct EventMatch {
  std::size_t run_count = 0;
  std::size_t truth_count = 0;
  std::size_t matched = 0;       ///< pairs of one kind from the start on
  double largest_difference = 0; ///< of time, s, over the pairs
  double at_time = 0;            ///< truth's time of that pair, s
};
/// Events at time 0 and before (contact made while the chain was set up) are left out.
EventMatch match_events(const std::vector<ContactEvent> &run, const std::vector<ContactEvent> &truth);

/// Where the exciter's work went, between the ends of the first and the last cycle of cycles.csv (J).
struct EnergyLedger {
  double first_cycle = 0.0; ///< the ledger runs from the end of this cycle
  double last_cycle = 0.0;  ///< to the end of this one
  double work_excitation = 0.0;
  double dissipated_contact = 0.0;
  double dissipated_bond = 0.0;
  double change_kinetic = 0.0;
  double change_potential = 0.0;
  double change_stored_contact = 0.0;
  double change_stored_bond = 0.0;
  /// Work minus everything that it went into, J.
  double closure() const;
  /// The same in per cent of the work.
  double closure_percent() const;
};
/// Nothing if columns are missing (named in `missing`) or there are fewer than two rows.
std::optional<EnergyLedger> energy_ledger(const CycleColumns &cycles, std::string &missing);

/// Contact force as a roller measures it, m2 a2 + m3 a3 + (m2 + m3) g + Fe, against the law's. The accelerations are differences of
/// the recorded positions, which the engine integrated, rather than its own accelerations, which it computes from the law's force.
struct RollerForce {
  std::vector<double> force;       ///< N, one per row; NaN where it cannot be measured
  std::size_t rows = 0;            ///< where it can
  double largest_difference = 0.0; ///< N
  double at_time = 0.0;            ///< s
  double largest_force = 0.0;      ///< largest |F_contact| of the law, N
};
/// Differences of fourth order over five rows; rows with an event, or a beginning or an end of contact without a recorded event,
/// among the five are left out. Nothing for a history without frame, of fewer than five rows, or whose rows are not equally far apart.
std::optional<RollerForce> roller_force(const ChainHistory &history, const std::vector<ContactEvent> &events,
                                        const ChainParameters &parameters);

/// A single impact of a mass without gravity on the fixed ball.
struct ImpactParameters {
  Transition transition = Transition::B;
  double mass = 2000.0;       ///< kg
  double stiffness = 1.0e8;   ///< N/m
  double damping_ratio = 0.5; ///< -
  double speed = 1.0;         ///< m/s, towards the ball
};
/// State of the impact at a time after the make.
struct ImpactState {
  double overlap = 0.0; ///< m
  double rate = 0.0;    ///< m/s
  double force = 0.0;   ///< N, 0 after the break
};
/// Closed form of the free contact (no break), at `time` s after the make.
ImpactState impact_state(const ImpactParameters &parameters, double time);
/// Time from make to break (s), closed form; infinite where A has no rebound.
double impact_duration(const ImpactParameters &parameters);

/// What a recorded impact shows.
struct ImpactMeasure {
  double speed_in = 0.0;            ///< m/s before the make
  double speed_out = 0.0;           ///< m/s after the break
  double make_time = 0.0;           ///< s
  std::optional<double> break_time; ///< s; located, if events were recorded
  bool hits = false;                ///< whether the record has a contact at all
  bool ended = false;               ///< whether the record ends without contact
  double restitution() const { return speed_out / speed_in; }
};
/// Nothing if the history is empty or the mass does not move towards the ball at its start.
std::optional<ImpactMeasure> measure_impact(const ChainHistory &history,
                                            const std::vector<ContactEvent> &events);

} // namespace drumlin::post
