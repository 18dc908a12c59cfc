#include "report/shear_page.h"

#include "report/strength_test.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

using ShearRun = ElementRun<ShearRow>;

constexpr double degree = 180.0 / 3.14159265358979323846;
constexpr double strain_of_critical_state = 0.1999; // a run that was asked for 0.2 may end just before

/// Mean ratio and dilatancy between two strains, `around` being the interval of the latter.
ShearFailure failure_between(const std::vector<ShearRow> &rows, double from, double to, double around) {
  ShearFailure failure;
  failure.ratio = mean_between(rows, &ShearRow::strain, from, to, &ShearRow::shear_stress) /
                  mean_between(rows, &ShearRow::strain, from, to, &ShearRow::normal_stress);
  const double first = number_at(rows, &ShearRow::strain, from - around, &ShearRow::volumetric_strain);
  const double last = number_at(rows, &ShearRow::strain, to + around, &ShearRow::volumetric_strain);
  failure.dilatancy = degree * std::atan((first - last) / (to - from + 2 * around));
  return failure;
}

const StrengthTest<ShearRow> shear_test = {
    "shear",
    "normal",
    &ShearRow::shear_stress,
    &ShearRow::normal_stress,
    [](double shear, double normal) { return degree * std::atan(shear / normal); },
    "Samples sheared under a constant normal stress",
    "shear strain",
    "Mobilised friction on the plane of shear",
    "angle",
    "atan(shear stress/normal stress)"};

/// Angles over the seeds of a soil, for each normal stress and for all.
PageTable seed_table(const std::vector<Soil> &soils, const std::vector<ShearRun> &runs,
                     const std::vector<ShearStrength> &strengths) {
  PageTable table;
  table.name = "shear_angles";
  table.title = "Angles over the seeds";
  table.header = {"soil",
                  "normal stress (kPa)",
                  "runs",
                  "peak friction on the plane of shear (°)",
                  "dilatancy angle at the peak (°)",
                  "peak friction angle after Davis (°)",
                  "critical friction on the plane of shear (°)",
                  "critical friction angle after Davis (°)"};
  add_soils(table, shear_test, soils, runs, [&](const std::vector<std::size_t> &members) {
    SeedValues peak, dilatancy, peak_davis, critical, critical_davis;
    for (const std::size_t n : members) {
      const std::string seed = runs[n].run.text("seed");
      peak.add(seed, strengths[n].peak.angle());
      dilatancy.add(seed, strengths[n].peak.dilatancy);
      peak_davis.add(seed, strengths[n].peak.davis_angle());
      if (!strengths[n].is_critical) continue;
      critical.add(seed, strengths[n].critical.angle());
      critical_davis.add(seed, strengths[n].critical.davis_angle());
    }
    return std::vector<std::string>{peak.mean_text(), dilatancy.mean_text(), peak_davis.mean_text(),
                                    critical.mean_text(), critical_davis.mean_text()};
  });
  table.notes = {
      "Mean and half of its 95 % confidence interval over the seeds; runs of one seed count once. Peak: the "
      "largest ratio of the stresses averaged over a thirtieth of the strain, within the first third. "
      "Critical: over the last third, if the strain reaches 20 %. Dilatancy: tan ψ = -(volumetric "
      "strain)/(shear strain), over three "
      "thirtieths. On the plane of shear: the angle whose tangent is shear over normal stress. After Davis: "
      "sin φ = t/(cos ψ + t sin ψ) with t that ratio, the friction angle of a soil in which stress and "
      "strain increment have the same directions, to be compared with that of a biaxial test. At the peak "
      "the directions may differ: the angle is then too small (inputs/study/strength)."};
  return table;
}

PageTable run_table(const std::vector<ShearRun> &runs, const std::vector<ShearStrength> &strengths) {
  PageTable table =
      element_run_table("shear_runs", {"normal stress (kPa)", "void ratio at the start (-)",
                                       "peak friction (°)", "strain at the peak (%)", "dilatancy angle (°)",
                                       "critical friction (°)", "void ratio at the end (-)"});
  for (std::size_t n = 0; n < runs.size(); ++n) {
    const ShearRun &run = runs[n];
    const ShearStrength &strength = strengths[n];
    add_element_run(table, run.run,
                    {run.run.text("normal"), number_cell(run.rows.front().void_ratio),
                     number_cell(strength.peak.angle()), number_cell(100 * strength.strain, 3),
                     number_cell(strength.peak.dilatancy, 3),
                     strength.is_critical ? number_cell(strength.critical.angle()) : no_value,
                     number_cell(run.rows.back().void_ratio)},
                    strength_quality(run));
  }
  table.criterion += " and reached the strain asked for";
  table.notes = {
      "Friction: on the plane of shear. Inertial number: shear rate times diameter sqrt(density/normal "
      "stress); below 1e-3 a test is quasi-static. Energy error: stored energy + heat - work of the platen, "
      "over the largest work so far."};
  return table;
}

} // namespace

double ShearFailure::angle() const { return degree * std::atan(ratio); }

double ShearFailure::davis_angle() const {
  const double psi = dilatancy / degree;
  return degree * std::asin(ratio / (std::cos(psi) + ratio * std::sin(psi)));
}

ShearStrength shear_strength_of(const std::vector<ShearRow> &rows) {
  const double end = rows.back().strain;
  ShearStrength strength;
  for (const ShearRow &row : rows) {
    if (row.strain > end / 3.0) break;
    const ShearFailure here =
        failure_between(rows, row.strain - end / 60.0, row.strain + end / 60.0, end / 30.0);
    if (here.ratio <= strength.peak.ratio) continue;
    strength.peak = here;
    strength.strain = row.strain;
  }
  strength.critical = failure_between(rows, end / 1.5, end, 0.0);
  strength.is_critical = end >= strain_of_critical_state;
  return strength;
}

std::vector<ShearRow> read_shear(const fs::path &file) {
  const Table table = read_element_table(file);
  std::vector<ShearRow> rows = rows_of<ShearRow>(table, {{"shear_strain", &ShearRow::strain},
                                                         {"shear_stress_kPa", &ShearRow::shear_stress},
                                                         {"normal_stress_kPa", &ShearRow::normal_stress},
                                                         {"volumetric_strain", &ShearRow::volumetric_strain},
                                                         {"void_ratio", &ShearRow::void_ratio},
                                                         {"inertial_number", &ShearRow::inertial_number},
                                                         {"energy_error", &ShearRow::energy_error}});
  for (std::size_t n = 0; n < rows.size(); ++n)
    if (rows[n].normal_stress <= 0.0 || (n > 0 && rows[n].strain <= rows[n - 1].strain))
      throw std::runtime_error(
          fmt::format("{}, line {}: strain {:g} at a normal stress of {:g} kPa; allowed are "
                      "strains that grow, at normal stresses above 0",
                      file.string(), table.line(n), rows[n].strain, rows[n].normal_stress));
  return rows;
}

PageWriter read_shear_page(const std::vector<fs::path> &folders) {
  return [runs = read_element_runs(folders, "shear.csv", read_shear)](const fs::path &out) {
    std::vector<ShearStrength> strengths;
    strengths.reserve(runs.size());
    for (const ShearRun &run : runs)
      strengths.push_back(shear_strength_of(run.rows));
    const std::vector<Soil> soils = soils_of(runs, {shear_test.confining});
    Page page(out, shear_title, Scene::shear);
    page.answer(
        "Samples of soil between two rough plates, periodic sideways, sheared by the upper one under a "
        "constant normal stress. The ratio of the stresses is the friction on the plane of shear.");
    answer_strength_quality(page, runs);
    page.section("Friction and volume");
    page.figure(strength_figure(shear_test, soils, runs));
    page.section("Friction angle");
    page.table(seed_table(soils, runs, strengths));
    page.section("Numbers");
    page.table(run_table(runs, strengths));
    page.write();
  };
}

} // namespace drumlin::post
