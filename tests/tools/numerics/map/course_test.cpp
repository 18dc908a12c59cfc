// The meter along one number of the chain: its values against exact piecewise solutions, where values return,
// and the command as a user runs it.
#include "map/course.h"
#include "support/csv.h"
#include "support/files.h"
#include "support/process.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"
#include "tests/support/page.h"
#include "tests/support/piecewise_oracle.h"
#include "tests/support/tool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;
using namespace post;

constexpr double pi = 3.14159265358979323846;

/// A roller of the 12 t class.
ChainParameters roller(double k, double D = 0.2) {
  ChainParameters p;
  p.m2 = 6000.0;
  p.m3 = 3500.0;
  p.omega = 60.0 * pi;
  p.Fw = 11.4 * p.omega * p.omega;
  p.k23 = 3.1e6;
  p.c23 = 31e3;
  p.k = k;
  p.D = D;
  return p;
}

TEST(Course, TurningPointsAreThoseOfASequence) {
  using Turns = std::vector<std::size_t>;
  EXPECT_EQ(turning_points({0, 1, 2, 3}, 0.5), Turns{});
  EXPECT_EQ(turning_points({0, 1, 5, 3, 2, 4, 9}, 0.5), (Turns{2, 4}));
  EXPECT_EQ(turning_points({5, 3, 1, 2, 0, 4}, 2.5), Turns{4}) << "an up of 1 does not count";
  EXPECT_EQ(turning_points({0, 0.1, 0, 0.1}, 0.5), Turns{});
  EXPECT_EQ(turning_points({}, 0.5), Turns{});
}

TEST(Course, CountsTheValuesOfTheAxisThatHaveAValue) {
  std::vector<CoursePoint> points;
  for (const double cmv : {0.0, 0.0, 0.0, 10.0, 20.0, 30.0, 20.0, 10.0, 15.0, 40.0}) {
    CoursePoint point;
    point.value = static_cast<double>(points.size() + 1);
    point.motion.meter.cmv = cmv;
    points.push_back(point);
  }
  const Course course = course_of(points, course_values[0]);
  EXPECT_EQ(course.turns, (std::vector<std::size_t>{5, 7}));
  EXPECT_EQ(course.same, (std::vector<std::size_t>{3, 3, 3, 1, 3, 2, 3, 2, 3, 1}));
  const std::vector<double> met = course.met_at(18.0);
  ASSERT_EQ(met.size(), 3U);
  EXPECT_NEAR(met[0], 4.8, 1e-12);
  EXPECT_NEAR(met[1], 7.2, 1e-12);
  EXPECT_NEAR(met[2], 9.12, 1e-12);
  EXPECT_EQ(course.met_at(35.0).size(), 1U);
  EXPECT_TRUE(course.met_at(50.0).empty());
}

/// Values of the last two cycles of an exact solution, from its samples.
struct Sampled {
  std::array<double, 6> amplitude{};
  double k_B = 0.0, k_1 = 0.0, c_1 = 0.0, energy = 0.0, low = 0.0;
};

Sampled sampled(const ChainParameters &p, int cycles, int samples) {
  const OracleResult exact = exact_pieces(p, cycles, samples);
  const std::size_t last = exact.time.size() - 1;
  const std::size_t first = last - 2 * static_cast<std::size_t>(samples);
  const auto harmonic = [&](const std::vector<double> &v, double order) {
    std::complex<double> sum;
    for (std::size_t i = first; i < last; ++i)
      sum +=
          (v[i + 1] - v[i]) * std::polar(1.0, -order * p.omega * 0.5 * (exact.time[i] + exact.time[i + 1]));
    return sum * p.omega / (2.0 * pi);
  };
  Sampled result;
  for (std::size_t j = 0; j < result.amplitude.size(); ++j)
    result.amplitude[j] = std::abs(harmonic(exact.v_drum, 0.5 * static_cast<double>(j + 1)));
  const std::complex<double> drum = harmonic(exact.v_drum, 1.0), frame = harmonic(exact.v_frame, 1.0);
  const std::complex<double> x = -drum / (p.omega * p.omega);
  const std::complex<double> from_drum = p.m2 * drum + std::complex<double>(0.0, -p.Fw);
  result.k_B = -(from_drum / x).real();
  result.k_1 = -((from_drum + p.m3 * frame) / x).real();
  result.c_1 = -((from_drum + p.m3 * frame) / x).imag() / p.omega;
  for (std::size_t i = first; i < last; ++i)
    result.energy -=
        0.5 * (exact.F_contact[i] + exact.F_contact[i + 1]) * (exact.x_drum[i + 1] - exact.x_drum[i]);
  for (std::size_t i = first; i < last; ++i)
    result.low = std::min(result.low, exact.x_drum[i]);
  return result;
}

// In contact, in partial uplift and in double jump, under both conditions.
TEST(Course, ValuesAreThoseOfAnExactSolution) {
  for (const Transition transition : {Transition::A, Transition::B})
    for (const double k : {15e6, 45e6, 80e6}) {
      SCOPED_TRACE(transition_name(transition) + " " + std::to_string(k));
      ChainParameters p = roller(k, k > 50e6 ? 0.3 : 0.2);
      p.transition = transition;
      CourseSetting setting;
      setting.drum = LineContact{0.76, 2.1, 0.35};
      const CoursePoint point = course_point(p, setting);
      ASSERT_LE(point.motion.period, 2);
      const Sampled exact = sampled(p, 400, 4000);
      const std::array<double, 6> &a = exact.amplitude;
      const MeterValues &meter = point.motion.meter;
      EXPECT_NEAR(meter.cmv, 300.0 * a[3] / a[1], 1e-2);
      EXPECT_NEAR(meter.rmv, 100.0 * a[0] / a[1], 1e-2);
      EXPECT_NEAR(meter.ccv, 100.0 * (a[0] + a[2] + a[3] + a[4] + a[5]) / (a[0] + a[1]), 1e-2);
      EXPECT_NEAR(meter.k_B, exact.k_B, 1e-4 * k);
      EXPECT_NEAR(meter.k_1, exact.k_1, 1e-4 * k);
      EXPECT_NEAR(meter.c_1, exact.c_1, 1e-4 * p.damping());
      EXPECT_NEAR(meter.energy, exact.energy, 1e-2 * exact.energy);
      EXPECT_NEAR(*std::max_element(meter.deflections.begin(), meter.deflections.end()), -exact.low,
                  1e-5 * -exact.low);
      EXPECT_GT(point.E_vib, 0.0);
      if (meter.contact_share == 1.0) {
        EXPECT_NEAR(meter.k_1, k, 1e-9 * k);
        EXPECT_NEAR(meter.c_1, p.damping(), 1e-9 * p.damping());
        // k_B contains the frame: its dynamic stiffness in closed form.
        const std::complex<double> bond(p.k23, p.omega * p.c23);
        const double inertia = p.m3 * p.omega * p.omega;
        EXPECT_NEAR(meter.k_B - k, (-bond * inertia / (bond - inertia)).real(), 1e-9 * k);
      }
    }
}

TEST(Course, IdentificationFindsTheSoil) {
  CourseSetting setting;
  setting.identify = true;
  const CoursePoint point = course_point(roller(50e6), setting);
  EXPECT_NEAR(point.exact.k, 50e6, 50.0);
  EXPECT_NEAR(point.exact.D, 0.2, 1e-6);
  EXPECT_NEAR(point.measured.k, 50e6, 1e6);
  EXPECT_TRUE(std::isnan(point.E_vib)) << "the drum's size is not known";
}

class CourseCommand : public Tool {
protected:
  Outcome map(const std::vector<std::string> &words) const { return drumlin("map", words); }
  std::vector<std::string> few() const {
    return {"--x",           "k:20e6:70e6:11", "--m2",         "6000",      "--m3",       "3500",
            "--me-re",       "11.4",           "--omega",      "188.49556", "--k23",      "3.1e6",
            "--c23",         "31e3",           "--D",          "0.2",       "--identify", "5",
            "--drum-radius", "0.76",           "--drum-width", "2.1",       "--out",      "m"};
  }
};

TEST_F(CourseCommand, WritesValuesMarksAndAPage) {
  draw();
  const Outcome outcome = well(map(few()));
  const Table table = read_table(folder_ / "m/meter.csv");
  ASSERT_EQ(table.rows(), 11U);
  for (const char *column :
       {"CMV [-]", "RMV [-]", "CCV [-]", "k_B [N/m]", "k_1 [N/m]", "c_1 [N s/m]", "E_vib [Pa]",
        "energy_two_cycles [J]", "peak_force [N]", "contact_share [-]", "period [cycles]", "same_cmv [-]"})
    EXPECT_EQ(table.numbers(column).size(), 11U) << column;
  const std::vector<double> k = table.numbers("k [N/m]"), k_1 = table.numbers("k_1 [N/m]");
  EXPECT_EQ(table.text("regime")[0], "continuous contact");
  EXPECT_EQ(table.text("regime")[10], "period 2");
  EXPECT_NEAR(k_1[0], k[0], 1e-6 * k[0]);
  std::size_t identified = 0;
  for (const std::string &cell : table.text("k_identified [N/m]"))
    identified += cell.empty() ? 0 : 1;
  EXPECT_EQ(identified, 3U);
  // Where contact is lost and where the period doubles, from an independent solution.
  const Table changes = read_table(folder_ / "m/boundaries.csv");
  ASSERT_GE(changes.rows(), 2U);
  EXPECT_NEAR(changes.numbers("k [N/m]")[0], 28.8593e6, 100.0);
  EXPECT_NEAR(changes.numbers("k [N/m]")[1], 64.2151e6, 100.0);
  expect_sound_page(folder_ / "m", 3);
  EXPECT_TRUE(printed(outcome, "points have a CMV that belongs to several k"));

  // A call that was interrupted gives the same.
  const std::string rows = read_text(folder_ / "m/regimes.csv"), meter = read_text(folder_ / "m/meter.csv");
  std::size_t end = 0;
  for (int line = 0; line < 5; ++line)
    end = rows.find('\n', end) + 1;
  write_files({{folder_ / "m/regimes.csv", rows.substr(0, end + 9)}});
  EXPECT_TRUE(printed(well(map(few())), "4 of 11 points are there already"));
  EXPECT_EQ(read_text(folder_ / "m/regimes.csv"), rows);
  EXPECT_EQ(read_text(folder_ / "m/meter.csv"), meter);
}

// Any number may be the axis; without a drum's size there is no E_vib.
TEST_F(CourseCommand, AlongOtherNumbers) {
  draw();
  well(map({"--x", "frequency:18:30:4", "--me-re", "4", "--identify", "0", "--out", "f"}));
  const Table table = read_table(folder_ / "f/meter.csv");
  EXPECT_EQ(table.numbers("frequency [Hz]").back(), 30.0);
  EXPECT_EQ(table.numbers("k [N/m]").back(), 1e8);
  EXPECT_TRUE(table.text("E_vib [Pa]").front().empty());
  EXPECT_TRUE(table.text("k_identified [N/m]").front().empty());
  expect_sound_page(folder_ / "f", 2);
  well(map({"--x", "me_re:1:4:4", "--k", "2e7", "--identify", "0", "--out", "e"}));
  EXPECT_GT(read_table(folder_ / "e/meter.csv").numbers("peak_force [N]").back(),
            read_table(folder_ / "e/meter.csv").numbers("peak_force [N]").front());
}

} // namespace
} // namespace drumlin::test
