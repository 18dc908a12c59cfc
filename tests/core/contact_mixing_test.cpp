// Contacts of two materials: the series of two springs as the state of least energy, found by a library, and
// the limits of the rule.
#include "physics/laws/contact_mixing.h"

#include <boost/math/tools/minima.hpp>
#include <gtest/gtest.h>

namespace drumlin::test {
namespace {

using physics::ContactValues;
using physics::mixed;

/// Force, N, of two springs in series that are compressed by 1 m together: the compression of the first one
/// is that of least energy.
double force_of_series(double first, double second) {
  const auto energy = [&](double x) { return 0.5 * first * x * x + 0.5 * second * (1.0 - x) * (1.0 - x); };
  const double x = boost::math::tools::brent_find_minima(energy, 0.0, 1.0, 60).first;
  return first * x;
}

TEST(ContactMixing, StiffnessIsThatOfTheSpringsOfBothBallsInSeries) {
  for (const double a : {1e6, 3e7, 1e9})
    for (const double b : {1e6, 2e8}) {
      // A contact with itself is two springs in series, too: each is twice as stiff.
      const double k = mixed({a, 0.0, 0.0, 0.0}, {b, 0.0, 0.0, 0.0}).stiffness;
      EXPECT_NEAR(k, force_of_series(2.0 * a, 2.0 * b), 1e-6 * k) << a << ", " << b;
    }
  EXPECT_NEAR(mixed({1e8, 0.0, 0.0, 0.0}, {1e300, 0.0, 0.0, 0.0}).stiffness, 2e8, 1e-4); // on a rigid ball
}

TEST(ContactMixing, TakesTheLesserFrictionAndTheMeanDampingInEitherOrder) {
  const ContactValues rough = {1e9, 0.3, 0.8, 0.1}, smooth = {1e8, 0.1, 0.5, 0.45};
  for (const ContactValues &values : {mixed(rough, smooth), mixed(smooth, rough)}) {
    EXPECT_EQ(values.friction, 0.5);
    EXPECT_EQ(values.rolling, 0.1);
    EXPECT_NEAR(values.damping_ratio, 0.2, 1e-15);
  }
}

TEST(ContactMixing, OfOneMaterialIsTheMaterial) {
  const ContactValues values = mixed({3e8, 0.3, 0.7, 0.2}, {3e8, 0.3, 0.7, 0.2});
  EXPECT_NEAR(values.stiffness, 3e8, 1e-7);
  EXPECT_NEAR(values.damping_ratio, 0.3, 1e-16);
  EXPECT_EQ(values.friction, 0.7);
  EXPECT_EQ(values.rolling, 0.2);
}

} // namespace
} // namespace drumlin::test
