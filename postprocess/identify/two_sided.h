// Identification of a record of both ends of a drum: stiffness and damping of the soil below each half.
//
// What acts below each half follows from the equations of motion of drum and frame (record/both_ends.h), and
// single contacts of each half give a first k and c. From there the equations of motion follow the record
// from contact to contact, with both contacts and both tilts (identify/motion_fit.h).
#pragma once

#include "identify/identified_record.h"

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

constexpr std::array<const char *, 2> half_names = {"left", "right"};

/// The soil below a half of the drum. Intervals: 95 %.
struct HalfLaw {
  MeanInterval k{};                   ///< [N/m]
  MeanInterval c{};                   ///< [N s/m]
  MeanInterval D{};                   ///< c / (2 sqrt(m2/2 k)) [-]
  double contact_share = 0.0;         ///< share of the samples with more than 2 % of the largest force [-]
  Identification contact;             ///< what its single contacts say
  std::optional<MachinePart> machine; ///< if tolerances are given
};

/// What a record of both ends says.
struct TwoSidedRecord {
  std::filesystem::path file;
  double frequency = 0.0; ///< of the excitation [Hz]
  double cycles = 0.0;
  bool frame_computed = false;
  std::array<HalfLaw, 2> halves; ///< left, right
  MeanInterval k{};              ///< of both halves [N/m]
  MeanInterval ratio{};          ///< k of the left half over that of the right one [-]
  MotionFit motion;
  double left = 0.0; ///< share of the acceleration of the drum's left end that the motion leaves (RMS)
};

/// std::runtime_error with one line for what is missing, or if the equations of motion do not follow the
/// record. \param progress is called with what is being done
TwoSidedRecord identify_two_sided(const Record &record, const RecordSetting &setting,
                                  const std::function<void(const std::string &)> &progress = {});

} // namespace drumlin::post
