// The verdicts on a stability map, and the page of made-up results.
#include "lab/stability/boundary.h"
#include "lab/stability/page.h"
#include "support/files.h"
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"
#include "tests/support/page.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace drumlin::test {
namespace {

namespace fs = std::filesystem;
using post::MapPoint;

/// A map that meets every acceptance criterion.
std::vector<MapPoint> good_map() {
  std::vector<MapPoint> map;
  for (const post::HeldScene &scene : post::held_scenes())
    for (const double D : {0.0, 2.0, 1e4})
      for (const char *stepping : {"second", "stock"}) {
        const double limit = stepping == std::string("stock") ? post::stock_stability_limit(scene.contacts, D)
                                                              : post::spring_stability_limit(scene.contacts);
        map.push_back({&scene, stepping, D, 0.999 * limit, 1.001 * limit, limit});
      }
  return map;
}

MapPoint &point(std::vector<MapPoint> &map, const char *scene, const char *stepping, double D) {
  for (MapPoint &p : map)
    if (std::string(p.scene->name) == scene && p.stepping == stepping && p.D == D) return p;
  throw std::logic_error("no such point");
}

std::vector<bool> verdicts(const std::vector<MapPoint> &map) {
  std::vector<bool> holds;
  for (const post::Acceptance &verdict : post::judge_stability_map(map))
    holds.push_back(verdict.holds);
  return holds;
}

TEST(StabilityMap, EachCriterionFailsByItsOwnPoint) {
  EXPECT_EQ(verdicts(good_map()), (std::vector<bool>{true, true, true}));
  std::vector<MapPoint> map = good_map();
  MapPoint &stock = point(map, "four", "stock", 1e4);
  stock.stable = stock.unstable = 1.011 * stock.limit;
  EXPECT_EQ(verdicts(map), (std::vector<bool>{false, true, true}));
  map = good_map();
  point(map, "one", "second", 1e4).stable = 1.94;
  EXPECT_EQ(verdicts(map), (std::vector<bool>{true, false, true}));
  map = good_map();
  point(map, "two", "second", 2.0).stable = 1.39;
  EXPECT_EQ(verdicts(map), (std::vector<bool>{true, true, false}));
}

TEST(StabilityMap, WithoutItsPointsIsNotJudged) {
  EXPECT_THROW(post::judge_stability_map({}), std::logic_error);
}

TEST(StabilityPage, ShowsVerdicts) {
  const Scratch scratch;
  post::write_stability_page(scratch.path(), good_map());
  expect_sound_page(scratch.path(), 1);
  EXPECT_TRUE(contains(post::read_text(scratch.path() / "index.html"), "3 of 3 acceptance criteria hold"));
}

} // namespace
} // namespace drumlin::test
