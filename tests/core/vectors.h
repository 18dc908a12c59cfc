#pragma once
/// What tests of forces in space and of random parameters share.
#include "tests/support/prelude.h"
#include "physics/vec3.h"

namespace drumlin::test {

inline double length(const physics::Vec3 &a) { return std::sqrt(physics::dot(a, a)); }

/// 10^x with x uniform between the decades.
inline double decades(std::mt19937 &random, double lowest, double highest) {
  return std::pow(10.0, std::uniform_real_distribution<double>(lowest, highest)(random));
}

} // namespace drumlin::test
