// Published tests of one or two spheres (inputs/benchmarks): the first scene of each family of the study's
// plan in both engines meets its known values; result.csv is what the dump of the spheres gives.
#include "tests/support/checks.h"
#include "tests/support/engine_runs.h"

#include "bed/dump_readers.h"
#include "engine/deck_run.h"
#include "experiment/plan.h"
#include "experiment/results.h"
#include "experiment/scene_run.h"
#include "runs/parameter_file.h"
#include "support/csv.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace drumlin::test {
namespace {

class Benchmarks : public ::testing::TestWithParam<const char *> {};

TEST_P(Benchmarks, MeetTheirKnownValuesInBothEngines) {
  post::Plan plan = post::read_plan(post::input_file("study/benchmarks/plan"));
  std::vector<post::Result> rows;
  std::set<std::string> engines;
  for (const post::Scene &scene : plan.scenes) {
    if (post::value_of(scene, "case") != GetParam() || !engines.insert(scene.twin).second) continue;
    const std::unique_ptr<post::DeckRun> run = post::run_scene(scene, 1, {}, post::Soil::kept);
    const std::vector<double> values = post::measured(plan.quantities, run->file(""), 1.0);
    for (std::size_t i = 0; i < values.size(); ++i)
      rows.push_back({scene.name, 1, plan.quantities[i].name, plan.quantities[i].unit, values[i], 0.0});
    if (engines.size() > 1) break;
  }
  const std::vector<post::Judged> judged = post::judged(plan, post::Results(rows));
  ASSERT_FALSE(judged.empty());
  for (const post::Judged &one : judged)
    EXPECT_TRUE(one.holds) << one.scene->name << ": " << one.expected->quantity << " is " << one.found
                           << ", not " << one.expected->value << "; other engine: " << one.difference;
  if (!post::has_lammps()) GTEST_SKIP() << "SKIPPED: LAMMPS is not set up (./drumlin setup lammps)";
}

INSTANTIATE_TEST_SUITE_P(Cases, Benchmarks,
                         ::testing::Values("chung_ooi_1", "chung_ooi_2", "chung_ooi_3", "chung_ooi_4",
                                           "chung_ooi_5", "chung_ooi_6", "chung_ooi_7", "chung_ooi_8",
                                           "restitution", "oblique_pair", "slip", "rolling_decay", "incline",
                                           "pure_rolling", "stack", "rest"),
                         [](const auto &test) { return test.param; });

/// What a run's dump says of the two spheres at its end.
struct Ends {
  double x, z, vx, vz, w;
};

// Two spheres on a floor that strike each other: momenta and energy change, so that no formula is zero.
TEST(BenchmarksDeck, SaysInItsTableWhatItsDumpGives) {
  const Scratch scratch;
  well(run_deck(post::input_file("benchmarks/in.spheres"),
                {{"case", "oblique_pair"},
                 {"k", "1e8"},
                 {"r2", "0.007"},
                 {"density2", "4000"},
                 {"floor", "1"},
                 {"z1", "0.0189"},
                 {"z2", "0.00695"},
                 {"spin", "30"},
                 {"spin_ratio", "-0.4"},
                 {"velocity_ratio", "-0.3"},
                 {"g", "3"},
                 {"contacts", "1.7"},
                 {"out", "out"}},
                scratch.path()));
  std::map<std::string, double> p;
  for (const auto &[name, text] : post::read_parameters(scratch / "out/parameters.csv"))
    if (const auto value = post::any_number_from_text(text)) p[name] = *value;
  const std::vector<post::TextDump> dumps = post::read_text_dumps(scratch / "out/balls.txt");
  const auto end_of = [&](std::size_t ball) {
    const post::TextDump &last = dumps.back();
    const auto of = [&](const char *name) { return last.rows[ball][last.column(name)]; };
    return Ends{of("x"), of("z"), of("vx"), of("vz"), of("omegay")};
  };
  const Ends a = end_of(0), b = end_of(1);
  double force = -1e300, overlap = -1e300;
  for (const post::TextDump &dump : dumps) {
    if (&dump == &dumps.front()) continue;
    force = std::max(force, dump.rows[0][dump.column("fz")]);
    overlap = std::max(overlap,
                       p["r1"] + p["r2"] - (dump.rows[0][dump.column("z")] - dump.rows[1][dump.column("z")]));
  }
  const post::Table result = post::read_table(scratch / "out/result.csv"),
                    contact = post::read_table(scratch / "out/contact.csv");
  const auto says = [&](const char *column, double value) {
    EXPECT_NEAR(result.numbers(column)[0], value, 1e-10 * std::fabs(value)) << column;
    EXPECT_GT(std::fabs(value), 1e-9) << column;
  };
  const double vx2 = p["velocity_ratio"] * p["vt"], vz2 = -p["velocity_ratio"] * p["vn"],
               w2 = p["spin_ratio"] * p["spin"], m1 = p["m1"], m2 = p["m2"], r1 = p["r1"], r2 = p["r2"];
  const auto energy = [](double m, double r, const Ends &of) {
    return 0.5 * m * (of.vx * of.vx + of.vz * of.vz) + 0.2 * m * r * r * of.w * of.w;
  };
  const auto turning = [](double m, double r, const Ends &of) {
    return m * (of.z * of.vx - of.x * of.vz) + 0.4 * m * r * r * of.w;
  };
  const Ends a0{0.0, p["z1"], p["vt"], -p["vn"], p["spin"]}, b0{0.0, p["z2"], vx2, vz2, w2};
  const double unit = m1 * std::hypot(p["vn"], p["vt"]), slip = a.vx - r1 * a.w - b.vx - r2 * b.w;
  const double before = energy(m1, r1, a0) + energy(m2, r2, b0),
               after = energy(m1, r1, a) + energy(m2, r2, b);
  says("x_m", a.x);
  says("vx [m/s]", a.vx);
  says("spin [rad/s]", a.w);
  says("restitution", (a.vz - b.vz) / (p["vn"] * (1.0 - p["velocity_ratio"])));
  says("energy_ratio", after / before);
  EXPECT_NEAR(result.numbers("energy_gain")[0], std::max(0.0, after / before - 1.0), 1e-12);
  says("momentum_normal", (m1 * (a.vz - a0.vz) + m2 * (b.vz - b0.vz)) / unit);
  says("momentum_tangential", (m1 * (a.vx - a0.vx) + m2 * (b.vx - b0.vx)) / unit);
  says("angular_momentum",
       (turning(m1, r1, a) + turning(m2, r2, b) - turning(m1, r1, a0) - turning(m2, r2, b0)) / (r1 * unit));
  says("tangential_restitution", a.vx / a0.vx);
  says("rebound_angle [degrees]", std::atan(slip / (a.vz - b.vz)) * 180.0 / M_PI);
  says("recoil", slip / (a.vz - b.vz));
  says("recoil_mu", slip / (p["mu"] * (a.vz - b.vz)));
  says("spin_mu", r1 * a.w / (p["mu"] * p["vn"]));
  says("floor_overlap_m", r1 - a.z);
  says("sphere_overlap_m", r1 + r2 - (b.z - a.z));
  const auto largest = [&contact](const char *column) {
    const std::vector<double> values = contact.numbers(column);
    return *std::max_element(values.begin(), values.end());
  };
  EXPECT_NEAR(largest("force_N"), force, 1e-12 * force);
  EXPECT_NEAR(largest("overlap_m"), overlap, 1e-12);
}

} // namespace
} // namespace drumlin::test
