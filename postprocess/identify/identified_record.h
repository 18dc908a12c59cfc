// Identification of a roller's record: the law of the whole record and of windows of cycles.
#pragma once

#include "identify/identification.h"
#include "identify/motion_fit.h"
#include "record/record.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// How a record is identified.
struct RecordSetting {
  bool accelerations_only = false; ///< positions and velocities of the record are not used
  /// Whether x_drum = 0 is where drum and soil just touch; not given: as the record says.
  std::optional<bool> known_origin;
  /// Largest error of the exciter's phase [rad], as in IdentificationSetting.
  double phase_within = 0.0;
  /// Share of the largest force as in IdentificationSetting; not given: 0 with a known origin, else 0.2.
  std::optional<double> least_force;
  int window = 10; ///< cycles, 4 or more; 0: no windows
  /// As in MotionSetting.
  bool search = true;
  /// Of both ends: the exciter's force over that which is said from which the motion is followed; not given:
  /// that which is said and, if it is known to 1 % or worse, both its limits.
  std::optional<double> force;
};

/// The law of a window of cycles.
struct LawWindow {
  int first_cycle = 1; ///< counted from 1
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]
  std::optional<LawEstimate> law;
  std::string why_not; ///< the reason if there is no law
};

/// k, c and D, or their half widths by the tolerances of the machine's data.
struct MachinePart {
  double k = 0.0; ///< [N/m]
  double c = 0.0; ///< [N s/m]
  double D = 0.0; ///< [-]
};

/// What a record says.
struct IdentifiedRecord {
  std::filesystem::path file;
  std::string part_read;  ///< as Record has it
  double frequency = 0.0; ///< of the excitation [Hz]
  double cycles = 0.0;
  bool known_origin = false;
  bool phase_known = true; ///< no error of the exciter's phase was allowed
  bool positions = false;  ///< whether a position or velocity of the drum was used
  bool frame = false;      ///< whether the frame's acceleration is in the record, or computed
  bool frame_computed = false;
  double force_difference =
      -1.0; ///< RMS of force minus F_contact of the record over RMS of that; -1: not there
  /// What a meter shows for the whole record, of its even number of cycles (meter_values.h) [N/m]; apparent
  /// where contact is lost.
  std::optional<double> k_B, k_1;
  std::vector<double> time; ///< [s]
  std::vector<double> s;    ///< place along the way of a roller that drives [m]; else empty
  double per_cycle = 0.0;   ///< samples per cycle
  Identification whole;
  std::vector<LawWindow> windows;
  /// Whose k and c `whole` has, if the equations of motion follow the record.
  std::optional<MotionFit> motion;
  std::optional<MachinePart> machine; ///< if tolerances are given
  /// Share of the drum's acceleration that these equations leave (RMS); not given if they were not tried.
  std::optional<double> left;
};

/// The signals of a record, from its accelerations, masses and excitation; the record's column F_contact is
/// not used. If the record has no acceleration of the frame, it is taken as zero. Gravity is 9.81 m/s2 if the
/// record does not give it. std::runtime_error with one line for what is missing.
DrumSignals signals_of(const Record &record, bool accelerations_only);

/// What in an identification contradicts itself, and what may be the cause; nothing if nothing does.
std::optional<std::string> contradiction(const IdentifiedRecord &record);

/// Identifies a record; std::runtime_error with one line if it cannot be done. `progress` is called with what
/// is being done.
IdentifiedRecord identify_record(const Record &record, const RecordSetting &setting,
                                 const std::function<void(const std::string &)> &progress = {});

} // namespace drumlin::post
