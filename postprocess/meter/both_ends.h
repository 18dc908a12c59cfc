// What meters at both ends of a drum show, and what both together tell.
#pragma once

#include "meter/along_way.h"
#include "meter/values.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// Values of a record of both ends, by windows; left, then right.
struct BothEnds {
  std::array<std::vector<MeterWindow>, 2> at_end; ///< of a meter whose sensor is at that end
  /// Below each half: force of the soil over displacement there, k_1 and c_1. In unbroken contact these are
  /// stiffness and damping of that half of a linear soil. Empty if `missing` is not.
  std::array<std::vector<MeterWindow>, 2> halves;
  std::string missing; ///< what they need and the record does not give
};

/// Nothing of a record of one sensor. \param range the part of the way that counts
std::optional<BothEnds> both_ends(const Record &record, const MeterOptions &options,
                                  const WayRange &range = {});

/// The last window in lines: \param middle that of a meter in the middle
std::vector<std::string> answer_lines(const BothEnds &ends, const MeterWindow &middle);

} // namespace drumlin::post
