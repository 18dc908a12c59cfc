// Records of a roller's motion: one reader for those of runs (chain.csv, bed.csv) and for measured ones.
//
// A record is uniformly sampled, in SI units, x up. Errors are std::runtime_error with one line that names
// the file, the line or column, the value and what is allowed.
#pragma once

#include "chain/two_ends.h"
#include "runs/chain_files.h"
#include "support/measured_table.h"

#include <complex>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// Rows of a measured file without a gap, without blank cells, and with one setting of the exciter.
struct RecordPiece {
  double begin = 0.0; ///< time of the first row [s]
  double end = 0.0;   ///< of the last one [s]
  std::size_t samples = 0;
  double frequency = 0.0; ///< of the exciter there, to some per mille [Hz]; 0: not known
};

/// Tolerances of the data of a machine, relative but for the place; 0: exact.
struct MachineTolerances {
  double m2 = 0.0, m3 = 0.0; ///< of the masses of drum and frame
  double me_re = 0.0;        ///< of the eccentric moment, and so of Fw
  double exciter = 0.0;      ///< of the exciter's place along the axle [m]
};

/// The bond of drum and frame as known without the record.
struct KnownBond {
  double stiffness = 0.0; ///< [N/m]
  double damping = 0.0;   ///< [N s/m]
  double tolerance = 0.0; ///< relative, of both, 95 %; 0: exact
};

/// A Butterworth low-pass of the measuring chain, which delays what it passes.
struct LoggerFilter {
  double corner = 0.0; ///< where 1/sqrt(2) of an amplitude is left [Hz]
  int order = 1;       ///< 1 to 8

  /// Damping ratios of its sections of second order; an odd order has one of first order besides.
  std::vector<double> sections() const;
  /// What it makes of a wave [Hz].
  std::complex<double> response(double frequency) const;
  /// The time after which it has forgotten what was before, to 1e-6 [s].
  double memory() const;
};

/// A record. Signals that the file does not have are empty; F_bond is not read.
struct Record : ChainHistory {
  std::filesystem::path file; ///< that was read
  /// The table of sums over every time step of each cycle; empty without one. See read_record().
  std::filesystem::path cycles_file;
  std::map<std::string, std::string>
      parameters; ///< parameters.csv of the run as it stands, and the bond of a roller file; empty without

  bool of_run = false; ///< of the files of a run, not measured
  /// x_drum = 0 is where drum and soil just touch: of the run of a chain, whose parameters.csv has D or way.
  bool known_origin = false;

  double interval = 0.0; ///< between samples [s]

  std::vector<RecordPiece> pieces; ///< of a measured file, those that read_record() finds
  std::size_t piece = 0;           ///< the one that was read, counted from 0
  std::string part_read;           ///< says which part of the file was read; empty: all of it
  std::vector<std::string> notes;  ///< how a measured file was understood, line by line

  std::optional<double> omega; ///< angular frequency of the excitation [rad/s]
  /// F_e = Fw sin(omega time + phase) [rad]: 0 in a run; of a measured record only if it is given.
  std::optional<double> phase;
  double phase_half_width = 0.0; ///< of the phase, if flights have told it [rad]
  double phase_within = 0.0;     ///< half the 95 % interval of a phase from pulses, or that wanders [rad]
  /// What the angle of the exciter has besides omega time + phase, sample by sample, from pulses [rad];
  /// empty: 0.
  std::vector<double> wander;
  /// A signal that rises once in each revolution of the exciter, in any unit; empty without one.
  std::vector<double> pulse;
  /// Why the excitation may be another than was said, as a refusal: so it is unless the whole motion follows
  /// the record to its noise. Empty: nothing speaks against it.
  std::string doubt;
  double low_pass = 0.0;         ///< cut-off of the filter that all signals passed [Hz]; 0: none
  bool excitation_read = false;  ///< F_excitation is from the file
  std::optional<double> Fw;      ///< amplitude of the excitation force [N]
  std::optional<double> m2;      ///< mass of the drum [kg]
  std::optional<double> m3;      ///< mass of the frame [kg]
  std::optional<double> g;       ///< gravity [m/s2]
  MachineTolerances tolerances;  ///< of m2, m3 and Fw, as the roller's file has them
  std::optional<KnownBond> bond; ///< of the options
  /// The file has no acceleration of the frame: a_frame is what the bond makes of that of the drum.
  bool frame_computed = false;
  /// The filter of the logger. a_drum and a_frame then are restored, but for what is too fast; these are as
  /// logged.
  std::optional<LoggerFilter> logger_filter;
  std::vector<double> logged_drum, logged_frame;
  /// How the machine tilts, with a contact below each half of the drum, whose k and c are not known; not
  /// given: nothing says it.
  std::optional<TwoEnds> ends;

  /// Whether both ends of the drum were measured.
  bool two_sided() const { return !a_left.empty() && !a_right.empty(); }

  /// Time of one cycle of the excitation [s]; std::runtime_error if `omega` is not known.
  double period() const;
  /// The angle of the exciter at a sample, if its phase is known [rad].
  double angle(std::size_t sample) const {
    return *omega * time[sample] + *phase + (wander.empty() ? 0.0 : wander[sample]);
  }
  /// The exciter's force over Fw at a sample, which goes with the square of the frequency [-].
  double force_share(std::size_t sample) const;
  /// Number of cycles of the excitation in the samples (they last `size() - 1` intervals).
  double cycles() const;
};

/// Removes all samples before `first`, and `end` and those behind it, from every signal of a record.
void keep_samples(Record &record, std::size_t first, std::size_t end);

/// Where a signal stands in a measured file, and in which unit.
struct ColumnSource {
  std::string header; ///< name of the column in the file, or its number
  /// From the file's unit to SI, negative if the file counts it the other way; not given: the unit in the
  /// file's header, or SI.
  std::optional<double> factor{};
};

/// "NAME=HEADER" or "NAME=HEADER:UNIT", where a '-' before the unit turns the sign: "a_drum=Acc Z:-g". NAME
/// is `time`, a signal or `pulse`, which has no UNIT; HEADER as MeasuredTable::find() takes it.
/// std::invalid_argument says what is allowed. Units: those of support/units.h.
std::pair<std::string, ColumnSource> column_from_text(const std::string &text);

/// How a record is read. What is not given comes from the run's parameters.csv, if there is one.
struct RecordOptions {
  /// By `time` or the name of the signal. Others are looked for by their own names in SI; if any signal is
  /// named here, only those named here are read, and `time`.
  std::map<std::string, ColumnSource> columns;
  /// Columns without a known name are taken for what they may be; the notes say so.
  bool guess = false;
  TableFormat format;                   ///< of a measured file; what is not given is found
  std::optional<std::size_t> piece;     ///< counted from 1; not given: the longest, near omega if one is
  std::optional<double> sampling_rate;  ///< [Hz]; needed without a column `time`, or if its digits are few
  std::optional<double> omega;          ///< angular frequency of the excitation [rad/s]
  std::optional<double> phase;          ///< of the excitation at time 0 [rad]
  double pulse_angle = 0.0;             ///< angle of the exciter at which `pulse` rises [rad]
  std::optional<double> Fw;             ///< amplitude of the excitation force [N]
  std::optional<double> me_re;          ///< eccentric moment [kg m] instead: Fw = m_e r_e omega^2
  std::optional<double> m2;             ///< mass of the drum [kg]
  std::optional<double> m3;             ///< mass of the frame [kg]
  std::map<std::string, double> delays; ///< by which signals come late [s]
  /// Corner frequency of sensors that pass no constant, of first order, for accelerations [Hz].
  std::optional<double> corner;
  std::optional<double> low_pass; ///< cut-off frequency of low_passed(), for all signals [Hz]
  MachineTolerances tolerances;   ///< of m2, m3 and me_re
  std::optional<KnownBond> bond;  ///< of drum and frame
  std::optional<LoggerFilter> logger_filter;
  std::optional<TwoEnds> ends; ///< as Record has it; not given: what the run says
};

/// The least number of excitation cycles, and of samples per cycle, of a record that is read with `omega`
/// known.
constexpr int least_cycles = 4;
constexpr int least_samples = 8;

/// Reads a record from the folder of a run, one of its files chain.csv, bed.csv and cycles.csv, or a measured
/// file, which may be written in any way that MeasuredTable reads.
/// - Of a folder chain.csv is read, or bed.csv if there is no chain.csv; `cycles_file` is set if it has a
/// cycles.csv.
/// - Given a cycles.csv, `cycles_file` is set and the record has no samples: `time` is empty.
/// - parameters.csv in the same folder gives omega, Fw, m2, m3, g for files with those names.
/// - Several measured files are one record: each continues the one before it.
/// - A measured file is divided where cells are blank or times have a gap, and, if omega is known, where the
/// exciter is off or changes (stretches_of()); one piece is read. Clock times count from the first row.
/// - a_left and a_right are the accelerations at both ends of the drum; a_drum is their mean if the file has
/// none.
/// - If the file has no F_excitation but omega, phase and Fw are known, F_excitation is computed.
/// Refused are: values that are no finite numbers; of a run, gaps; a column of time that does not grow or has
/// unequal steps; a signal that is not the derivative of another by a factor of 2 or more or by its sign; a
/// contact force that is always zero, never positive, against the drum's acceleration, or whose mean is not
/// the weight of drum and frame; fewer cycles or samples per cycle than above.
Record read_record(const std::vector<std::filesystem::path> &files, const RecordOptions &options = {});
/// The same of one file or folder.
Record read_record(const std::filesystem::path &path, const RecordOptions &options = {});

/// F_excitation of a record that has none in its file, if omega, phase and Fw are known.
void compute_excitation(Record &record);

/// All signals without what is faster than `cutoff` [Hz], by low_passed(); std::runtime_error if it is not
/// below half the sampling rate.
void filter_signals(Record &record, double cutoff);

/// "NAME=TIME": by how much a signal comes late, as "a_frame=0.5ms"; in s without a unit.
/// std::invalid_argument says what is allowed.
std::pair<std::string, double> delay_from_text(const std::string &text);

/// What a sensor of first order that passes no constant has made of `values`, undone but for a polynomial of
/// third order over the whole record, which such a sensor does not tell; waves of half to three times omega
/// [rad/s] stay out of it.
std::vector<double> without_high_pass(const std::vector<double> &values, double interval, double corner,
                                      double omega);

/// "HZ,ORDER": a filter of the logger, as "200,4". std::invalid_argument says what is allowed.
LoggerFilter logger_filter_from_text(const std::string &text);

/// The highest frequency that restored() restores in full [Hz]; it fades out up to 1/0.7 of that, where a
/// fifth of an amplitude has passed the filter, or with half the sampling rate.
double restored_up_to(const LoggerFilter &filter, double interval);

/// Values as they were before a filter, size and phase, but for what is faster than restored_up_to().
std::vector<double> restored(const std::vector<double> &values, double interval, const LoggerFilter &filter);

/// Share of an amplitude that low_passed() leaves at a frequency [Hz].
double low_pass_gain(double frequency, double interval, double cutoff);

/// Values without what is faster than `cutoff` [Hz]: a Butterworth filter of second order, forward and then
/// backward, so that phases stay; it halves amplitudes at the cut-off. `interval` [s]; 0 < cutoff <
/// 0.5/interval.
std::vector<double> low_passed(const std::vector<double> &values, double interval, double cutoff);

} // namespace drumlin::post
