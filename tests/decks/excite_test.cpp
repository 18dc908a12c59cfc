// Free balls under fix drum/excite: velocity and position against fine quadrature of the force that the
// documentation gives, computed here independently.
#include "tests/support/balls_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <ostream>
#include <string>

namespace drumlin::test {
namespace {

using Vector = std::array<double, 3>;

struct Drive {
  const char *name;
  std::string words;
  std::function<Vector(double)> force; // N, at time t in s
};

void PrintTo(const Drive &value, std::ostream *out) { *out << value.words; }

constexpr double Fw = 5e4, w = 150.0;

Vector along(const Vector &n, double F) { return {n[0] * F, n[1] * F, n[2] * F}; }
constexpr Vector up{0, 0, 1};

/// Linear growth from w to w2 within T: angle, frequency.
double swept_angle(double w2, double T, double s) {
  return s < T ? w * s + (w2 - w) * s * s / (2 * T) : (w + w2) / 2 * T + w2 * (s - T);
}
double swept_frequency(double w2, double T, double s) { return s < T ? w + (w2 - w) * s / T : w2; }

const Drive drives[] = {
    {"directed", "amplitude 5e4 omega 150 direction 0 0 1",
     [](double t) { return along(up, Fw * std::sin(w * t)); }},
    {"gravity", "amplitude 5e4 omega 150", [](double t) { return along(up, -Fw * std::sin(w * t)); }},
    {"oblique", "amplitude 5e4 omega 150 direction 3 0 -4",
     [](double t) {
       return along({0.6, 0, -0.8}, Fw * std::sin(w * t));
     }},
    {"frequency", "amplitude 5e4 frequency 23.873241463784300 direction 0 0 1",
     [](double t) { return along(up, Fw * std::sin(w * t)); }},
    {"phase", "phase 0.7 amplitude 5e4 omega 150 direction 0 0 1",
     [](double t) { return along(up, Fw * std::sin(w * t + 0.7)); }},
    {"start", "amplitude 5e4 omega 150 start 0.02 direction 0 0 1",
     [](double t) { return along(up, t < 0.02 ? 0 : Fw * std::sin(w * (t - 0.02))); }},
    {"ramp", "amplitude 5e4 omega 150 ramp 0.05 phase 1 direction 0 0 1",
     [](double t) { return along(up, std::min(1.0, t / 0.05) * Fw * std::sin(w * t + 1)); }},
    {"sweep", "amplitude 5e4 omega 150 sweep 400 0.08 direction 0 0 1",
     [](double t) { return along(up, Fw * std::sin(swept_angle(400, 0.08, t))); }},
    {"eccentric", "eccentric 2.5 0.04 omega 150 direction 0 0 1",
     [](double t) { return along(up, 2.5 * 0.04 * w * w * std::sin(w * t)); }},
    {"eccentric_sweep", "eccentric 2.5 0.04 omega 150 sweep 50 0.06 start 0.01 ramp 0.02 direction 0 0 1",
     [](double t) {
       const double s = std::max(0.0, t - 0.01);
       const double v = swept_frequency(50, 0.06, s);
       return along(up, std::min(1.0, s / 0.02) * 2.5 * 0.04 * v * v * std::sin(swept_angle(50, 0.06, s)));
     }},
    {"rotating", "amplitude 5e4 omega 150 direction 0 0 -1 mode rotating axis 0 1 0",
     // Axis x direction is (0,1,0) x (0,0,-1) = (-1,0,0).
     [](double t) {
       return Vector{-Fw * std::cos(w * t), 0, -Fw * std::sin(w * t)};
     }},
};

class Excitation : public ::testing::TestWithParam<Drive> {};

TEST_P(Excitation, MovesAFreeBallByItsIntegral) {
  constexpr double dt = 2e-5, mass = 2000, g = 9.81;
  constexpr int steps = 6000; // nearly three cycles
  const bool falls = std::string(GetParam().name) == "gravity";
  const BallsRun run = run_balls({{"obstacle", "plane"},
                                  {"gap", "0.5"},
                                  {"fixed", "3"},
                                  {"g", falls ? "9.81" : "0"},
                                  {"excitation", GetParam().words},
                                  {"dt", number(dt)},
                                  {"steps", std::to_string(steps)},
                                  {"every", "10"}});
  ASSERT_EQ(run.frames.size(), steps / 10 + 1u);
  // v by Simpson's rule over fine panels, x by the same of v: x(t + h) = x + h v + integral of (h - s) a(s).
  constexpr int panels = 20; // within ten steps
  const double h = 10 * dt / panels;
  Vector v{}, x{}, largest_v{}, largest_x{}, error_v{}, error_x{}, error_f{};
  const Ball start = run.frames.front().balls.at(1);
  for (std::size_t n = 0; n < run.frames.size(); ++n) {
    const double t = 10 * dt * static_cast<double>(n);
    const Ball &ball = run.frames[n].balls.at(1);
    const Vector exact_force = GetParam().force(t);
    for (std::size_t a = 0; a < 3; ++a) {
      error_v[a] = std::max(error_v[a], std::fabs(ball.v[a] - v[a]));
      error_x[a] = std::max(error_x[a], std::fabs(ball.x[a] - start.x[a] - x[a]));
      const double weight = falls && a == 2 ? -mass * g : 0;
      error_f[a] = std::max(error_f[a], std::fabs(ball.f[a] - exact_force[a] - weight));
      largest_v[a] = std::max(largest_v[a], std::fabs(v[a]));
      largest_x[a] = std::max(largest_x[a], std::fabs(x[a]));
    }
    for (int panel = 0; panel < panels; ++panel) {
      const double begin = t + panel * h;
      const Vector f0 = GetParam().force(begin), f1 = GetParam().force(begin + h / 2),
                   f2 = GetParam().force(begin + h);
      for (std::size_t a = 0; a < 3; ++a) {
        const double weight = falls && a == 2 ? -mass * g : 0;
        x[a] += h * v[a] + h * h / 6 * (f0[a] + 2 * f1[a] + 3 * weight) / mass;
        v[a] += h / 6 * (f0[a] + 4 * f1[a] + f2[a] + 6 * weight) / mass;
      }
    }
  }
  // The engine's own quadrature is the trapezoid rule: (w dt)^2 / 12 of the force, less where the force has a
  // kink.
  const double scale_v = std::max({largest_v[0], largest_v[1], largest_v[2]});
  const double scale_x = std::max({largest_x[0], largest_x[1], largest_x[2]});
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_LT(error_f[a], 1e-9 * Fw) << "axis " << a;
    EXPECT_LT(error_v[a], 2e-5 * scale_v) << "axis " << a;
    EXPECT_LT(error_x[a], 2e-5 * scale_x) << "axis " << a;
  }
}

INSTANTIATE_TEST_SUITE_P(Words, Excitation, ::testing::ValuesIn(drives),
                         [](const auto &test) { return std::string(test.param.name); });

TEST(ExcitationOfAGroup, IsSharedByMass) {
  constexpr double m1 = 300, m2 = 4700;
  const BallsRun run =
      run_balls({{"gap", "0.5"},
                 {"fixed", "3"},
                 {"driven", "1 2"},
                 {"m1", number(m1)},
                 {"m2", number(m2)},
                 {"excitation", "amplitude 5e4 omega 150 direction 1 0 1 mode rotating axis 0 1 0"},
                 {"dt", "1e-4"},
                 {"steps", "500"}});
  double largest = 0;
  for (const Frame &frame : run.frames) {
    const Ball &one = frame.balls.at(1), &two = frame.balls.at(2);
    double size = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      ASSERT_NEAR(one.f[a] / m1, two.f[a] / m2, 1e-12 * Fw / (m1 + m2));
      ASSERT_NEAR(one.v[a], two.v[a], 1e-12);
      size += (one.f[a] + two.f[a]) * (one.f[a] + two.f[a]);
      largest = std::max(largest, std::fabs(one.v[a]));
    }
    ASSERT_NEAR(std::sqrt(size), Fw, 1e-9 * Fw) << "a rotating force has one size";
  }
  EXPECT_GT(largest, Fw / (m1 + m2) / w);
}

} // namespace
} // namespace drumlin::test
