// Records of both ends of a drum: what acts below each half of it.
//
// Drum and frame tilt about the way of travel. In the sum of their equations of motion the forces of the bond
// cancel, which leaves the forces of the soil on both halves, F_left and F_right (N, upwards), at the places
// y_left and y_right (m) along the axle:
//     F_left + F_right = m2 a2 + m3 a3 + (m2 + m3) g + F_e
//     y_left F_left + y_right F_right = I2 th2'' + I3 th3'' + y_e F_e
// Accelerations a2 (m/s2) and th2'' (rad/s2) of the drum follow from both sensors. No sensor measures the
// tilt of the frame: its acceleration follows from that of the drum through the bond.
#pragma once

#include "record/record.h"

#include <array>
#include <string>
#include <vector>

namespace drumlin::post {

/// Soil and drum at the contact below a half of the drum, of each sample.
struct HalfSignals {
  std::vector<double> acceleration; ///< of the drum at the contact, upwards [m/s2]
  std::vector<double> force;        ///< of the soil, positive in compression [N]
  double of_exciter = 0.5;          ///< share of the exciter's force that acts on this contact
};

/// What the forces of both halves need and the record does not give, as one line; empty if it gives all.
std::string missing_for_halves(const Record &record);

/// The left half and the right one, of a record that gives all of that.
std::array<HalfSignals, 2> half_signals(const Record &record);

/// Angular acceleration of the drum and of the frame, of each sample [rad/s2].
std::vector<double> drum_tilt(const Record &record);
std::vector<double> frame_tilt(const Record &record);

} // namespace drumlin::post
