// The results that the report derives from a run of the chain: functions of its history and events, which
// read and write no files. SI units throughout; times count from the start of the excitation; forces are
// positive in compression.
#pragma once

#include <complex>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "chain/parameters.h"
#include "runs/chain_files.h"
#include "support/statistics.h"

namespace drumlin::post {

/// An interval of time (s), which includes its start but not its end.
struct TimeWindow {
  double begin = 0.0; ///< s
  double end = 0.0;   ///< s
};

/// Smallest and largest value of a quantity.
struct Extremes {
  double min = 0.0;
  double max = 0.0;
};

/// Number of complete excitation cycles in a history that starts at time 0. last_time and period in s; a last
/// row within 1e-6 of a period counts as the full cycle.
int complete_cycles(double last_time, double period);

/// The last `count` of `complete` cycles as a window of time (all of them if there are fewer).
TimeWindow last_cycles_window(int complete, int count, double period);

/// Relative RMS difference sqrt(sum (a - b)^2 / sum b^2) over rows [first, last). NaN for an empty range;
/// `reference` and `values` must have `last` rows at least.
double relative_rms(const std::vector<double> &values, const std::vector<double> &reference,
                    std::size_t first, std::size_t last);

/// Share of the window spent in contact, computed from the times of the events. Whether there is contact at
/// the start of the window follows from the last event before it; without one, from the first event after it
/// (before a break there was contact); without any event there is contact throughout if `initially` is true.
double contact_share(const std::vector<ContactEvent> &events, TimeWindow window, bool initially);

/// Events with begin <= time < end.
std::vector<ContactEvent> events_in(const std::vector<ContactEvent> &events, TimeWindow window);

/// Amplitudes by integrating a piecewise linear record a(t) (m/s2 over s) exactly against cosine and sine
/// over the window. Two rows at one time are a jump. The window should be an even number of whole cycles, so
/// that it has whole periods of half the excitation frequency.
HarmonicAmplitudes harmonic_amplitudes(const std::vector<double> &time, const std::vector<double> &value,
                                       double omega, TimeWindow window);

/// Amplitudes from the per-cycle integrals a1_cos ... ah_sin (m/s2) of the last `count` rows; `count` is
/// reduced to an even number of rows that exist. No value if columns or rows are missing.
std::optional<HarmonicAmplitudes> harmonic_amplitudes(const CycleColumns &cycles, std::size_t count);

/// Harmonics over each cycle (m/s2) from the same columns, of orders 1, 2 and 1/2. Empty without these
/// columns.
struct CycleHarmonics {
  std::vector<std::complex<double>> fundamental;
  std::vector<std::complex<double>> second;
  std::vector<std::complex<double>> half;
};
CycleHarmonics cycle_harmonics(const CycleColumns &cycles);

/// Drum acceleration (m/s2) just before and just after an event. The contact force jumps there, while the sum
/// of the other forces on the drum, m2 a - F_contact, is continuous. If the history has the frame, this sum
/// is evaluated by the equation of motion at the event: position and velocity of the drum are those of the
/// event, those of the frame are interpolated between rows by cubic polynomials. Without the frame the sum is
/// interpolated linearly between two rows.
struct EventAcceleration {
  double before = 0.0;
  double after = 0.0;
};
EventAcceleration acceleration_at(const ContactEvent &event, const ChainHistory &history,
                                  const ChainParameters &parameters);

/// A history with two more rows at each event, the values just before and just after it, so that jumps are
/// vertical in a plot and exact in an integral.
struct EventSeries {
  std::vector<double> time;         ///< s; two rows at one time are an event
  std::vector<double> overlap;      ///< m
  std::vector<double> velocity;     ///< of the drum, m/s
  std::vector<double> force;        ///< contact force, N
  std::vector<double> acceleration; ///< of the drum, m/s2
  std::vector<char> event;          ///< 1 where the row was added at an event
};
EventSeries with_events(const ChainHistory &history, const std::vector<ContactEvent> &events,
                        const ChainParameters &parameters, TimeWindow window);

/// Extremes of the steady state. If `cycles` is given, they are those of the last `count` rows of cycles.csv,
/// which come from every time step; else those of the history's rows in the window. The values just before
/// and just after each event in the window are included.
struct SteadyExtremes {
  Extremes acceleration;   ///< drum, m/s2
  Extremes force;          ///< contact, N
  bool every_step = false; ///< from every time step rather than from the rows of the history
};
SteadyExtremes steady_extremes(const ChainHistory &history, const std::vector<ContactEvent> &events,
                               const std::optional<CycleColumns> &cycles, const ChainParameters &parameters,
                               TimeWindow window, std::size_t count);

/// Events of a run paired with those of the reference solution, in the order in which they occur.
struct EventMatch {
  std::size_t run_count = 0;
  std::size_t reference_count = 0;
  std::size_t matched = 0;       ///< pairs from the start up to the first that differ in kind (make or break)
  double largest_difference = 0; ///< largest difference of time within a pair, s
  double at_time = 0;            ///< time of that pair in the reference solution, s
};
/// Events at time 0 and before (contact made while the chain was set up) are left out.
EventMatch match_events(const std::vector<ContactEvent> &run, const std::vector<ContactEvent> &reference);

/// Energy balance between the ends of the first and the last cycle of cycles.csv (J).
struct EnergyBalance {
  double first_cycle = 0.0; ///< the balance extends from the end of this cycle
  double last_cycle = 0.0;  ///< to the end of this one
  double work_excitation = 0.0;
  double dissipated_contact = 0.0;
  double dissipated_bond = 0.0;
  double change_kinetic = 0.0;
  double change_potential = 0.0;
  double change_stored_contact = 0.0;
  double change_stored_bond = 0.0;
  /// Energy error: work of the excitation minus dissipated energies and changes of stored energies, J.
  double energy_error() const;
  /// The same in per cent of the work.
  double energy_error_percent() const;
};
/// No value if columns are missing (`missing` then names them) or there are fewer than two rows.
std::optional<EnergyBalance> energy_balance(const CycleColumns &cycles, std::string &missing);

/// Contact force as it is obtained from accelerometers on a roller, m2 a2 + m3 a3 + (m2 + m3) g + Fe,
/// compared with that of the contact law. The accelerations are second differences of the recorded positions:
/// those in the file are computed from the force of the contact law and would agree in any case.
struct RollerForce {
  std::vector<double> force;       ///< N, one per row; NaN where it cannot be computed
  std::size_t rows = 0;            ///< number of rows in which it can be computed
  double largest_difference = 0.0; ///< N
  double at_time = 0.0;            ///< s
  double largest_force = 0.0;      ///< largest |F_contact| of the law, N
};
/// Differences of fourth order over five rows; rows with an event, or a beginning or an end of contact
/// without a recorded event, among the five are left out. No value for a history without frame, of fewer than
/// five rows, or whose rows are not equally far apart.
std::optional<RollerForce> roller_force(const ChainHistory &history, const std::vector<ContactEvent> &events,
                                        const ChainParameters &parameters);

/// A single impact of a mass on the fixed ball, without gravity.
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

/// Results of a recorded impact.
struct ImpactMeasure {
  double speed_in = 0.0;            ///< m/s before the make
  double speed_out = 0.0;           ///< m/s after the break
  double make_time = 0.0;           ///< s
  std::optional<double> break_time; ///< s; located, if events were recorded
  bool hits = false;                ///< whether the record has a contact at all
  bool ended = false;               ///< whether the record ends without contact
  double restitution() const { return speed_out / speed_in; }
};
/// No value if the history is empty or the mass does not move towards the ball at its start.
std::optional<ImpactMeasure> measure_impact(const ChainHistory &history,
                                            const std::vector<ContactEvent> &events);

/// Share of the impact velocity that a single impact without gravity returns, closed form. transition "A" or
/// "B"; damping_ratio D >= 0. A with D >= 1 gives 0: no rebound.
double closed_form_restitution(const std::string &transition, double damping_ratio);

} // namespace drumlin::post
