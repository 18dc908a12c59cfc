#include "lab/benchmarks/runs.h"

#include "bed/dump_readers.h"
#include "engine/deck_run.h"
#include "runs/parameter_file.h"
#include "support/range.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

using SetupMember = std::pair<const char *, double SphereSetup::*>;
constexpr std::array<SetupMember, 22> setup_members = {{{"k", &SphereSetup::k},
                                                        {"kt", &SphereSetup::kt},
                                                        {"E_eff", &SphereSetup::E_eff},
                                                        {"G_eff", &SphereSetup::G_eff},
                                                        {"ct", &SphereSetup::ct},
                                                        {"e", &SphereSetup::e},
                                                        {"mu", &SphereSetup::mu},
                                                        {"mu_r", &SphereSetup::mu_r},
                                                        {"spheres", &SphereSetup::spheres},
                                                        {"r1", &SphereSetup::r1},
                                                        {"r2", &SphereSetup::r2},
                                                        {"m1", &SphereSetup::m1},
                                                        {"m2", &SphereSetup::m2},
                                                        {"vn", &SphereSetup::vn},
                                                        {"vt", &SphereSetup::vt},
                                                        {"spin", &SphereSetup::spin},
                                                        {"velocity_ratio", &SphereSetup::velocity_ratio},
                                                        {"spin_ratio", &SphereSetup::spin_ratio},
                                                        {"g", &SphereSetup::g},
                                                        {"slope", &SphereSetup::slope},
                                                        {"ceiling", &SphereSetup::ceiling},
                                                        {"steps", &SphereSetup::steps}}};

using EndMember = std::pair<const char *, double SphereEnd::*>;
constexpr std::array<EndMember, 14> end_members = {{{"x_end (m)", &SphereEnd::x},
                                                    {"z_end (m)", &SphereEnd::z},
                                                    {"vx_end (m/s)", &SphereEnd::vx},
                                                    {"vz_end (m/s)", &SphereEnd::vz},
                                                    {"spin_end (rad/s)", &SphereEnd::spin},
                                                    {"z2_end (m)", &SphereEnd::z2},
                                                    {"vx2_end (m/s)", &SphereEnd::vx2},
                                                    {"vz2_end (m/s)", &SphereEnd::vz2},
                                                    {"spin2_end (rad/s)", &SphereEnd::spin2},
                                                    {"z_start (m)", &SphereEnd::z_start},
                                                    {"z2_start (m)", &SphereEnd::z2_start},
                                                    {"peak_force (N)", &SphereEnd::peak_force},
                                                    {"peak_overlap (m)", &SphereEnd::peak_overlap},
                                                    {"x2_end (m)", &SphereEnd::x2}}};

/// Points of a case over a variable, for each material.
void add(std::vector<BenchmarkPoint> &points, const std::string &test,
         const std::vector<std::string> &materials, const std::string &variable,
         const std::vector<double> &values, const Variables &more = {}) {
  for (const std::string &material : materials)
    for (const double value : values)
      points.push_back({test, material, variable, value, more});
}

} // namespace

const CsvSchema<BenchmarkRun> &benchmark_runs() {
  static const CsvSchema<BenchmarkRun> schema = [] {
    std::vector<CsvColumn<BenchmarkRun>> columns = {
        csv_column("test", &BenchmarkRun::test), csv_column("material", &BenchmarkRun::material),
        csv_column("at", &BenchmarkRun::at), csv_column("engine", &BenchmarkRun::engine)};
    for (const auto &[name, member] : setup_members)
      columns.push_back(csv_column(name, &BenchmarkRun::setup, member));
    columns.push_back(csv_column("timestep", &BenchmarkRun::setup, &SphereSetup::timestep));
    for (const auto &[name, member] : end_members)
      columns.push_back(csv_column(name, &BenchmarkRun::end, member));
    return CsvSchema<BenchmarkRun>(std::move(columns), 4);
  }();
  return schema;
}

std::vector<BenchmarkPoint> benchmark_points(bool quick) {
  using Values = std::vector<double>;
  // The force of friction is of an order between 1 and 1.5 in the step.
  const Variables fine = {{"steps_per_contact", "4000"}};
  std::vector<BenchmarkPoint> points;
  if (quick) {
    add(points, "chung_ooi_1", {"glass"}, "vn", {10});
    add(points, "chung_ooi_4", {"aluminium_oxide"}, "angle", {20, 60}, fine);
    add(points, "slip", {""}, "duration", {0.9});
    return points;
  }
  Values angles;
  for (int angle = 5; angle <= 85; angle += 5)
    angles.push_back(angle);
  const Values spins = {0.175, 0.5, 1, 1.5, 2, 3, 4, 5, 7, 9, 12, 22};
  add(points, "chung_ooi_1", {"glass", "limestone"}, "vn", {10});
  add(points, "chung_ooi_2", {"aluminium", "magnesium"}, "vn", {0.2});
  add(points, "chung_ooi_3", {"aluminium_oxide", "cast_iron"}, "e", {0.2, 0.4, 0.6, 0.8, 1});
  add(points, "chung_ooi_4", {"aluminium_oxide", "aluminium_alloy"}, "angle", angles, fine);
  add(points, "chung_ooi_5", {"steel", "polyethylene"}, "vt", {0.5, 1, 2, 3, 4, 5, 6, 7.5, 10, 15, 20}, fine);
  add(points, "chung_ooi_6", {"aluminium_alloy", "nylon"}, "spin", spins, fine);
  add(points, "chung_ooi_7", {"aluminium_alloy", "copper"}, "spin", {0.175, 2, 22});
  add(points, "chung_ooi_8", {"aluminium_alloy", "nylon"}, "spin", spins, fine);
  add(points, "restitution", {""}, "e", {0.2, 0.5, 0.8});
  add(points, "oblique_pair", {""}, "vt", {3, 6});
  add(points, "slip", {""}, "duration", {0.4, 0.6, 0.9});
  add(points, "rolling_decay", {""}, "duration", {0.25, 0.5});
  add(points, "incline", {""}, "mu_r", {0.01, 0.05, 0.1, 0.2});
  add(points, "pure_rolling", {""}, "vt", {1});
  add(points, "stack", {""}, "duration", {5e-4, 1e-3, 2e-3});
  add(points, "rest", {""}, "e", {0.3});
  return points;
}

BenchmarkRun run_benchmark(const BenchmarkPoint &point, const std::string &engine) {
  Variables variables = point.more;
  variables.emplace_back("case", point.test);
  if (!point.material.empty()) variables.emplace_back("material", point.material);
  variables.emplace_back(point.variable, number_text(point.at, 15));
  const DeckRun run(engine == "lammps" ? "benchmarks/in.spheres.lammps" : "benchmarks/in.spheres", variables);
  run.must_succeed();
  return read_benchmark(point, engine, run.file(""));
}

BenchmarkRun read_benchmark(const BenchmarkPoint &point, const std::string &engine, const fs::path &folder) {
  BenchmarkRun run{point.test, point.material, point.at, engine, {}, {}};
  const std::map<std::string, std::string> parameters = read_parameters(folder / "parameters.csv");
  const auto take = [&](const char *name, double &value) {
    const auto found = parameters.find(name);
    const auto number = found == parameters.end() ? std::nullopt : any_number_from_text(found->second);
    if (!number) throw std::runtime_error(fmt::format("{}: no number '{}'", folder.string(), name));
    value = *number;
  };
  for (const auto &[name, member] : setup_members)
    take(name, run.setup.*member);
  take("timestep", run.setup.timestep);
  const std::vector<TextDump> dumps = read_text_dumps(folder / "balls.txt");
  const auto wanted = static_cast<std::size_t>(run.setup.spheres);
  if (dumps.empty()) throw std::runtime_error(folder.string() + ": balls.txt holds no step");
  const TextDump &last = dumps.back();
  const std::size_t x = last.column("x"), z = last.column("z"), vx = last.column("vx"),
                    vz = last.column("vz"), fz = last.column("fz"), spin = last.column("omegay");
  SphereEnd &end = run.end;
  for (const TextDump &dump : dumps) {
    if (dump.rows.size() != wanted) throw std::runtime_error(folder.string() + ": a sphere was lost");
    const double gap = wanted > 1 ? dump.rows[0][z] - dump.rows[1][z] - run.setup.r2 : dump.rows[0][z];
    end.peak_force = std::max(end.peak_force, dump.rows[0][fz]);
    end.peak_overlap = std::max(end.peak_overlap, run.setup.r1 - gap);
  }
  const std::vector<double> &one = last.rows[0];
  end.x = one[x], end.z = one[z], end.vx = one[vx], end.vz = one[vz], end.spin = one[spin];
  end.z_start = dumps.front().rows[0][z];
  if (wanted > 1) {
    const std::vector<double> &two = last.rows[1];
    end.x2 = two[x], end.z2 = two[z], end.vx2 = two[vx], end.vz2 = two[vz], end.spin2 = two[spin];
    end.z2_start = dumps.front().rows[1][z];
  }
  return run;
}

} // namespace drumlin::post
