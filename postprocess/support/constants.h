#pragma once

#include <limits>

namespace drumlin::post {

constexpr double pi = 3.14159265358979323846;
constexpr double degree = pi / 180.0; ///< [rad]
constexpr double degrees_per_radian = 180.0 / pi;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

} // namespace drumlin::post
