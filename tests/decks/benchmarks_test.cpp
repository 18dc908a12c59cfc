// Published tests of one or two spheres (inputs/benchmarks): a point of each case in both engines against
// closed forms and the reference solution of `drumlin study benchmarks`, and LAMMPS against LIGGGHTS.
#include "tests/support/engine_runs.h"

#include "lab/benchmarks/checks.h"
#include "lab/benchmarks/runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <vector>

namespace drumlin::test {
namespace {

using post::BenchmarkCheck;

struct Point : post::BenchmarkPoint {};
void PrintTo(const Point &point, std::ostream *out) { *out << point.test; }

class Benchmarks : public ::testing::TestWithParam<Point> {};

TEST_P(Benchmarks, AreMetInBothEngines) {
  const Point &point = GetParam();
  const std::vector<BenchmarkCheck> here = post::benchmark_checks(post::run_benchmark(point, "liggghts"));
  ASSERT_FALSE(here.empty());
  for (const BenchmarkCheck &check : here)
    EXPECT_LE(check.error(), check.tolerance)
        << check.quantity << ": " << check.computed << ", not " << check.expected;
  if (!post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
  const std::vector<BenchmarkCheck> there = post::benchmark_checks(post::run_benchmark(point, "lammps"));
  ASSERT_EQ(there.size(), here.size());
  for (std::size_t i = 0; i < here.size(); ++i)
    EXPECT_LE(std::fabs(there[i].computed - here[i].computed) / here[i].scale, 1e-9) << here[i].quantity;
}

const Variables fine = {{"steps_per_contact", "4000"}};
const Point points[] = {{{"chung_ooi_1", "limestone", "vn", 10}},
                        {{"chung_ooi_2", "magnesium", "vn", 0.2}},
                        {{"chung_ooi_3", "cast_iron", "e", 0.3}},
                        {{"chung_ooi_4", "aluminium_alloy", "angle", 27}},
                        {{"chung_ooi_5", "polyethylene", "vt", 12, fine}},
                        {{"chung_ooi_6", "nylon", "spin", 2.5, fine}},
                        {{"chung_ooi_7", "copper", "spin", 7}},
                        {{"chung_ooi_8", "aluminium_alloy", "spin", 15, fine}},
                        {{"restitution", "", "e", 0.35}},
                        {{"oblique_pair", "", "vt", 4}},
                        {{"slip", "", "duration", 0.4}},
                        {{"rolling_decay", "", "duration", 0.1}},
                        {{"incline", "", "mu_r", 0.03}},
                        {{"pure_rolling", "", "duration", 0.1}},
                        {{"stack", "", "duration", 1e-3}},
                        {{"rest", "", "e", 0.3}}};
INSTANTIATE_TEST_SUITE_P(Cases, Benchmarks, ::testing::ValuesIn(points),
                         [](const auto &test) { return test.param.test; });

} // namespace
} // namespace drumlin::test
