// What samples say.
#pragma once

#include <vector>

namespace drumlin::post {

/// Middle value; of an even number the mean of the two in the middle. values not empty.
double median(std::vector<double> values);
/// Value below which a share (0 to 1) of the values lies, linear between neighbours: 0.25 gives the lower quartile. values not empty.
double quantile(std::vector<double> values, double share);

} // namespace drumlin::post
