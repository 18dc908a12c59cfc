// Sensors that reach the end of their range.
#pragma once

#include "record/record.h"

#include <vector>

namespace drumlin::post {

/// Share of the values that are at a limit of the sensor, at the highest of them or at the lowest. Where a
/// signal turns, values lie close together, too, but not this close: within a narrow range at its end there
/// are about three times as many as in the next one. Noise behind the limit, and steps of the sensor, are
/// allowed for.
struct AtLimit {
  double high = 0.0, low = 0.0;
};
AtLimit share_at_limit(const std::vector<double> &values);

/// Refuses a measured record with an acceleration that stands still or is at the limit of its sensor;
/// std::runtime_error of one line.
void check_sensors(const Record &record);

} // namespace drumlin::post
