/// Values that are not allowed, each with its message: the name, the value, what is allowed.

#include "physics/bodies/absorbing_boundary.h"
#include "physics/bodies/bond_law.h"
#include "physics/bodies/excitation.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace {

using namespace drumlin::physics;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// The message for a good set of parameters in which one is changed.
template <class Parameters>
std::string fault(Parameters set, double Parameters::*member, double value) {
  EXPECT_EQ(set.invalid(), "");
  set.*member = value;
  return set.invalid();
}

TEST(ParameterChecks, OfABond) {
  const Bond bond{1e6, 1e4, 0.5};
  EXPECT_EQ(fault(bond, &Bond::stiffness, 0.0), "stiffness is '0 N/m'; allowed: finite and > 0");
  EXPECT_EQ(fault(bond, &Bond::stiffness, infinity), "stiffness is 'inf N/m'; allowed: finite and > 0");
  EXPECT_EQ(fault(bond, &Bond::damping, -0.1), "damping is '-0.1 N s/m'; allowed: finite and >= 0");
  EXPECT_EQ(fault(bond, &Bond::length, -nan_value), "length is 'nan m'; allowed: finite and >= 0");
  EXPECT_EQ(fault(bond, &Bond::strength, 0.0), "strength is '0 N'; allowed: > 0, may be infinite");
  EXPECT_EQ(fault(bond, &Bond::damping, 0.0), "");
  EXPECT_EQ(fault(bond, &Bond::strength, 1e-300), "");
}

TEST(ParameterChecks, OfAnExcitationLeaveOutWhatIsNotUsed) {
  Excitation e;
  EXPECT_EQ(fault(e, &Excitation::amplitude, -1.0), "amplitude is '-1 N'; allowed: finite and >= 0");
  EXPECT_EQ(fault(e, &Excitation::angular_frequency, infinity),
            "angular frequency is 'inf rad/s'; allowed: finite and >= 0");
  EXPECT_EQ(fault(e, &Excitation::phase, -infinity), "phase is '-inf rad'; allowed: finite");
  EXPECT_EQ(fault(e, &Excitation::start, nan_value), "start is 'nan s'; allowed: finite");
  EXPECT_EQ(fault(e, &Excitation::start, -5.0), "");
  EXPECT_EQ(fault(e, &Excitation::ramp, -1.0), "ramp is '-1 s'; allowed: finite and >= 0");
  EXPECT_EQ(fault(e, &Excitation::sweep_duration, -1.0),
            "sweep duration is '-1 s'; allowed: finite and >= 0");
  EXPECT_EQ(fault(e, &Excitation::sweep_frequency, -1.0), "");
  EXPECT_EQ(fault(e, &Excitation::eccentric_mass, -1.0), "");
  e.sweep_duration = 2.0;
  EXPECT_EQ(fault(e, &Excitation::sweep_frequency, -1.0),
            "sweep frequency is '-1 rad/s'; allowed: finite and >= 0");
  e.eccentric = true;
  e.eccentric_mass = e.eccentric_radius = 1.0;
  EXPECT_EQ(fault(e, &Excitation::amplitude, nan_value), "");
  EXPECT_EQ(fault(e, &Excitation::eccentric_mass, 0.0), "eccentric mass is '0 kg'; allowed: finite and > 0");
  EXPECT_EQ(fault(e, &Excitation::eccentric_radius, 0.0),
            "eccentric radius is '0 m'; allowed: finite and > 0");
}

TEST(ParameterChecks, OfAnAbsorbingBoundary) {
  const Ground ground{1800.0, 300.0, 170.0, 2.5, 0.4};
  EXPECT_EQ(fault(ground, &Ground::density, 0.0), "density is '0 kg/m3'; allowed: finite and > 0");
  EXPECT_EQ(fault(ground, &Ground::p_speed, -1.0),
            "speed of compression waves is '-1 m/s'; allowed: finite and > 0");
  EXPECT_EQ(fault(ground, &Ground::s_speed, -1.0),
            "speed of shear waves is '-1 m/s'; allowed: finite and >= 0");
  EXPECT_EQ(fault(ground, &Ground::s_speed, 301.0),
            "speed of shear waves is '301 m/s'; allowed: at most that of compression waves, 300 m/s");
  EXPECT_EQ(fault(ground, &Ground::depth, 0.0), "depth is '0 m'; allowed: > 0, may be infinite");
  EXPECT_EQ(fault(ground, &Ground::area, nan_value), "area is 'nan m2'; allowed: finite and > 0");
}

TEST(ParameterChecks, OfARange) {
  for (const double value : {nan_value, infinity, -infinity})
    EXPECT_FALSE(Range::any.contains(value));
  EXPECT_TRUE(Range::any.contains(-1e300));
  EXPECT_FALSE(Range::positive.contains(0.0));
  EXPECT_TRUE(Range::non_negative.contains(0.0));
  EXPECT_FALSE(Range::non_negative.contains(-1e-300));
  const Range share{-1.0, true, 0.5};
  EXPECT_TRUE(share.contains(0.5));
  EXPECT_FALSE(share.contains(-1.0));
  EXPECT_EQ(detail::text_of(share), "a finite number > -1 and <= 0.5");
  EXPECT_EQ(detail::text_of(Range::any), "a finite number");
}

} // namespace
