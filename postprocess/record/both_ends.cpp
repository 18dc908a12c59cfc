#include "record/both_ends.h"

#include "record/excitation.h"
#include "support/units.h"

#include <cmath>

namespace drumlin::post {

std::string missing_for_halves(const Record &record) {
  if (!record.two_sided())
    return refusal("a_left, a_right", "", "the accelerations of both ends of the drum");
  if (!record.ends)
    return refusal("drum_inertia", "",
                   "--roller with a file that has drum_inertia, frame_inertia and width, or the folder of a "
                   "run with both ends");
  if (!(record.ends->sensor > 0.0))
    return refusal("sensor_place", record.ends->sensor,
                   "a distance of the sensors from the middle above 0 m");
  if (!record.m2 || !record.m3) return refusal(record.m2 ? "m3" : "m2", "", "the masses of drum and frame");
  if (record.a_frame.empty())
    return refusal("a_frame", "", "the acceleration of the frame, or its bond, from --roller");
  if (record.F_excitation.empty() || !record.omega)
    return refusal("the excitation force", "",
                   "a column F_excitation, or --frequency with --Fw or --me-re, and --phase or --column "
                   "pulse, since the drum's ends do not fly together, which would tell the phase");
  return {};
}

std::vector<double> drum_tilt(const Record &record) {
  std::vector<double> tilt;
  for (std::size_t i = 0; i < record.size(); ++i)
    tilt.push_back((record.a_right[i] - record.a_left[i]) / (2.0 * record.ends->sensor));
  return tilt;
}

std::vector<double> frame_tilt(const Record &record) {
  const Eigen::Matrix2d per_mass =
      Eigen::Vector2d(1.0 / *record.m3, 1.0 / record.ends->frame_inertia).asDiagonal();
  const auto matrix = [&](double AxleLink::*value) {
    Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
    for (const AxleLink &bond : record.ends->bonds) {
      const Eigen::Vector2d place(1.0, bond.y);
      sum += bond.*value * place * place.transpose();
    }
    return Eigen::Matrix2d(per_mass * sum);
  };
  return through_bond(record, {record.a_drum, drum_tilt(record)}, matrix(&AxleLink::k),
                      matrix(&AxleLink::c))[1];
}

std::array<HalfSignals, 2> half_signals(const Record &record) {
  const TwoEnds &ends = *record.ends;
  constexpr double usual_gravity = 9.81;
  const double weight = (*record.m2 + *record.m3) * record.g.value_or(usual_gravity);
  const std::vector<double> of_drum = drum_tilt(record), of_frame = frame_tilt(record);
  std::array<HalfSignals, 2> halves;
  for (std::size_t half = 0; half < halves.size(); ++half) {
    const double y = ends.contacts[half].y, other = ends.contacts[1 - half].y;
    HalfSignals &signals = halves[half];
    signals.of_exciter = (ends.exciter - other) / (y - other);
    for (std::size_t i = 0; i < record.size(); ++i) {
      const double middle = 0.5 * (record.a_left[i] + record.a_right[i]);
      const double force =
          weight + *record.m2 * middle + *record.m3 * record.a_frame[i] + record.F_excitation[i];
      const double moment = ends.drum_inertia * of_drum[i] + ends.frame_inertia * of_frame[i] +
                            ends.exciter * record.F_excitation[i];
      signals.acceleration.push_back(middle + y * of_drum[i]);
      signals.force.push_back((moment - other * force) / (y - other));
    }
  }
  return halves;
}

} // namespace drumlin::post
