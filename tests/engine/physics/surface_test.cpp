// drumlin/surface against closed forms of the mean height of spheres and discs.
#include "tests/support/host_deck.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace drumlin::test {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double soil_radius = 0.5, drum_radius = 0.75; // m, of in.host, whose centres have y = 0

/// The number behind "height " in an output.
double printed_height(const Outcome &outcome) {
  EXPECT_TRUE(outcome.ok()) << outcome.output;
  const std::string mark = "\nheight ";
  const std::size_t at = outcome.output.rfind(mark);
  EXPECT_NE(at, std::string::npos) << outcome.output;
  return at == std::string::npos ? NAN : std::stod(outcome.output.substr(at + mark.size()));
}

double height_in_host(const std::string &arguments, int ranks) {
  const Scratch scratch;
  return printed_height(run_host(host_pair_style() + host_properties(),
                                 "drumlin/surface h " + arguments + "\nprint \"height ${h}\"\n",
                                 scratch.path(), ranks));
}

/// Mean height of the part of a sphere's upper half with |x| > d: volume over area.
double mean_of_sphere(double r, double d) {
  const double volume = pi * (r * r * (r - d) - (r * r * r - d * d * d) / 3.0);
  const double area = 2.0 * (r * r * std::acos(d / r) - d * std::sqrt(r * r - d * d));
  return volume / area;
}

TEST(Surface, OfSpheresIsTheirVolumeOverTheirAreaOnRanksOneAndTwo) {
  EXPECT_NEAR(mean_of_sphere(soil_radius, 0.0), 2.0 / 3.0 * soil_radius, 1e-15);
  for (const int ranks : {1, 2}) {
    EXPECT_NEAR(height_in_host("soil spacing 0.005", ranks), mean_of_sphere(soil_radius, 0.0), 2e-4);
    EXPECT_NEAR(height_in_host("drum spacing 0.005", ranks), mean_of_sphere(drum_radius, 0.0), 2e-4);
    EXPECT_NEAR(height_in_host("drum spacing 0.005 beyond 0.4 0", ranks), mean_of_sphere(drum_radius, 0.4),
                2e-4);
    // Only the right half is far enough from a line on the left.
    EXPECT_NEAR(height_in_host("drum spacing 0.005 beyond 1 -0.6", ranks), mean_of_sphere(drum_radius, 0.4),
                2e-4);
  }
}

/// Area under the circle of radius r from u to its right end.
double area_from(double u, double r) {
  return 0.5 * (r * r * std::acos(u / r) - u * std::sqrt(r * r - u * u));
}

// A disc across the periodic side, and a lower one near this side, of which only a part is seen from above.
TEST(Surface, ReachesAcrossAPeriodicSide) {
  const double r = 0.3, low = 0.85, seen = 1.0 - r; // m: the higher disc covers x > 0.7 and x < -0.7
  const double expected =
      (2.0 * (r * 1.0 + area_from(0.0, r)) + area_from(low - seen, r)) / (2.0 * r + seen - (low - r));
  const Scratch scratch;
  write_text(scratch / "discs.in", "units si\natom_style granular\natom_modify map array\nnewton off\n"
                                   "communicate single vel yes\ndimension 2\nboundary p f p\n"
                                   "region box block -1 1 -1 3 -0.1 0.1 units box\ncreate_box 2 box\n"
                                   "create_atoms 1 single -1 1 0\ncreate_atoms 1 single 0.85 0 0\n"
                                   "set group all diameter 0.6\n"
                                   "drumlin/surface h all spacing 0.001\nprint \"height ${h}\"\n");
  EXPECT_NEAR(printed_height(run_engine(scratch / "discs.in", {}, scratch.path(), 1)), expected, 2e-4);
}

} // namespace
} // namespace drumlin::test
