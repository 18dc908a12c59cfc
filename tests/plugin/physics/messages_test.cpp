/// Error messages for values that are not allowed: they have the name, the value and what is allowed.

#include "physics/bodies/bond_law.h"
#include "physics/bodies/excitation.h"
#include "physics/parameter_checks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace {

using namespace drumlin::physics;

constexpr double infinity = std::numeric_limits<double>::infinity();
const double nan_value = std::nan("");

enum Allowed { finite, not_negative, positive, positive_or_infinite };

/// Sets one member of a good parameter set to every kind of bad and good value and reads the message.
template <typename Parameters>
void expect_judged(const Parameters &good, double Parameters::*member, const std::string &name,
                   const std::string &unit, Allowed range) {
  ASSERT_EQ(good.invalid(), "");
  const std::string allowed = range == finite         ? "finite"
                              : range == not_negative ? "finite and >= 0"
                              : range == positive     ? "finite and > 0"
                                                      : "> 0, may be infinite";
  const auto judge = [&](double value, const std::string &text, bool accepted) {
    Parameters changed = good;
    changed.*member = value;
    std::string expected;
    if (!accepted) {
      expected.append(name).append(" is '").append(text);
      if (!unit.empty()) expected.append(" ").append(unit);
      expected.append("'; allowed: ").append(allowed);
    }
    EXPECT_EQ(changed.invalid(), expected);
  };
  judge(nan_value, "nan", false);
  judge(-nan_value, "nan", false);
  judge(infinity, "inf", range == positive_or_infinite);
  judge(-infinity, "-inf", false);
  judge(-5.0, "-5", range == finite);
  judge(-0.1, "-0.1", range == finite);
  judge(0.0, "0", range == finite || range == not_negative);
  judge(1e-300, "1e-300", true);
  judge(12.5, "12.5", true);
}

TEST(Messages, OfRanges) {
  EXPECT_EQ(detail::text_of(Range::any), "a finite number");
  EXPECT_EQ(detail::text_of(Range::positive), "a finite number > 0");
  EXPECT_EQ(detail::text_of(Range::non_negative), "a finite number >= 0");
  EXPECT_EQ(detail::text_of({-1.0, true, 0.5}), "a finite number > -1 and <= 0.5");
  for (const double value : {nan_value, infinity, -infinity})
    EXPECT_FALSE(Range::any.contains(value));
  EXPECT_TRUE(Range::any.contains(-1e300));
  EXPECT_FALSE(Range::positive.contains(0.0));
  EXPECT_TRUE(Range::positive.contains(1e-300));
  EXPECT_TRUE(Range::non_negative.contains(0.0));
  EXPECT_FALSE(Range::non_negative.contains(-1e-300));
  EXPECT_TRUE((Range{-1.0, true, 0.5}).contains(0.5));
  EXPECT_FALSE((Range{-1.0, true, 0.5}).contains(-1.0));
}

TEST(Messages, OfABond) {
  const Bond bond{1e6, 1e4, 0.5, 1e5};
  expect_judged(bond, &Bond::stiffness, "stiffness", "N/m", positive);
  expect_judged(bond, &Bond::damping, "damping", "N s/m", not_negative);
  expect_judged(bond, &Bond::length, "length", "m", not_negative);
  expect_judged(bond, &Bond::strength, "strength", "N", positive_or_infinite);
  EXPECT_EQ((Bond{1e6, 1e4, 0.5}).invalid(), "");
}

TEST(Messages, OfAnExcitation) {
  Excitation plain;
  plain.amplitude = 58.8e3;
  plain.angular_frequency = 125.7;
  expect_judged(plain, &Excitation::amplitude, "amplitude", "N", not_negative);
  expect_judged(plain, &Excitation::angular_frequency, "angular frequency", "rad/s", not_negative);
  expect_judged(plain, &Excitation::phase, "phase", "rad", finite);
  expect_judged(plain, &Excitation::start, "start", "s", finite);
  expect_judged(plain, &Excitation::ramp, "ramp", "s", not_negative);
  expect_judged(plain, &Excitation::sweep_duration, "sweep duration", "s", not_negative);
  Excitation sweep = plain;
  sweep.sweep_duration = 2.0;
  expect_judged(sweep, &Excitation::sweep_frequency, "sweep frequency", "rad/s", not_negative);
  Excitation eccentric = plain;
  eccentric.eccentric = true;
  eccentric.eccentric_mass = 50.0;
  eccentric.eccentric_radius = 0.1;
  expect_judged(eccentric, &Excitation::eccentric_mass, "eccentric mass", "kg", positive);
  expect_judged(eccentric, &Excitation::eccentric_radius, "eccentric radius", "m", positive);
}

TEST(Messages, OfAnExcitationLeaveOutWhatIsNotUsed) {
  Excitation e;
  e.eccentric_mass = -1.0;
  e.sweep_frequency = nan_value;
  EXPECT_EQ(e.invalid(), "");
  e.eccentric = true;
  e.amplitude = nan_value;
  e.eccentric_mass = e.eccentric_radius = 1.0;
  EXPECT_EQ(e.invalid(), "");
}

TEST(Messages, RefuseParametersThatAreNotSet) { EXPECT_NE(Bond{}.invalid(), ""); }

} // namespace
