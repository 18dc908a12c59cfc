// The report of the loosest and the densest packing: what it reads, refuses and shows.
#include "tests/support/element_report.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

namespace drumlin::test {
namespace {

const std::string header =
    "share,friction,rolling,void_ratio,solid_fraction,relative_density,compaction,coordination\n";
const std::string dense_row = "0,0,0,0.25,0.8,1,1,3.9\n";

class DensityReport : public ElementReport {};

// Two seeds of one soil: means of 0.50 and 0.25, and every packing in a table.
TEST_F(DensityReport, ShowsTheLoosestAndTheDensest) {
  for (const char *seed : {"1", "2"})
    write_run("runs/" + std::string(seed), "density.csv",
              fmt::format("{}{}{}0.5,0.4,0.225,0.4,0.7143,0.4,0.893,3.3\n", header,
                          seed[0] == '1' ? "1,0.8,0.45,0.48,0.6757,0,0.845,3.1\n"
                                         : "1,0.8,0.45,0.52,0.6579,0,0.822,3\n",
                          dense_row),
              "deck,density\nsample,random\nseed," + std::string(seed) + "\n");
  EXPECT_TRUE(contains(report("runs"), "density/index.html"));
  expect_sound_page(root / "report/density", 1, "index.html", 0);
  // Student's t of two values is 12.71, the standard deviation of the mean 0.02.
  EXPECT_TRUE(contains(data("density", "density_soils"), "0.500 ± 0.254"));
  EXPECT_TRUE(contains(data("density", "density_soils"), "0.250 ± 0.000"));
  EXPECT_TRUE(contains(data("density", "density_packings"), "0.225"));
}

TEST_F(DensityReport, RefusesDamagedFiles) {
  expect_refused("density.csv", header + dense_row, "1 rows");
  expect_refused("density.csv", header + dense_row + "1,0.8,0.45,much,0.7,0,0.9,3\n", "much");
}

} // namespace
} // namespace drumlin::test
