#include "report/soil/pages.h"

#include "bed/element_results.h"
#include "report/soil/strength_test.h"
#include "support/units.h"

#include <cmath>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

using ShearRun = ElementRun<ShearRow>;

const StrengthTest<ShearRow> shear_test = {
    "shear",
    "normal",
    &ShearRow::shear_stress,
    &ShearRow::normal_stress,
    [](double shear, double normal) { return degrees_per_radian * std::atan(shear / normal); },
    "Samples sheared under a constant normal stress",
    "shear strain",
    "Mobilised friction on the plane of shear",
    "angle",
    "atan(shear stress/normal stress)"};

/// Angles over the seeds of a soil, for each normal stress and for all.
PageTable seed_table(const std::vector<SoilGroup> &soils, const std::vector<ShearRun> &runs,
                     const std::vector<ShearStrength> &strengths) {
  PageTable table("shear_angles", "Angles over the seeds",
                  "soil | normal stress (kPa) | runs | peak friction on the plane of shear (°) | dilatancy "
                  "angle at the peak (°) | peak friction angle after Davis (°) | critical friction on the "
                  "plane of shear (°) | critical friction angle after Davis (°)");
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
  table.notes = {"Mean and half of its 95 % confidence interval over the seeds; runs of one seed count once. "
                 "Peak: the largest ratio of the stresses averaged over a thirtieth of the strain, within "
                 "the first third. Critical: over the last third, if the strain reaches 20 %. Dilatancy: tan "
                 "ψ = -(volumetric strain)/(shear strain), over three thirtieths. On the plane of shear: the "
                 "angle whose tangent is shear over normal stress. After Davis: sin φ = t/(cos ψ + t sin ψ) "
                 "with t that ratio, the friction angle of a soil in which stress and strain increment have "
                 "the same directions, to be compared with that of a biaxial test. At the peak the "
                 "directions may differ: the angle is then too small (inputs/study/strength)."};
  return table;
}

PageTable run_table(const std::vector<ShearRun> &runs, const std::vector<ShearStrength> &strengths) {
  PageTable table = element_run_table(
      "shear_runs", "normal stress (kPa) | void ratio at the start (-) | peak friction (°) | strain at the "
                    "peak (%) | dilatancy angle (°) | critical friction (°) | void ratio at the end (-)");
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
  table.notes = {"Friction: on the plane of shear. Inertial number: shear rate times diameter "
                 "sqrt(density/normal stress); below 1e-3 a test is quasi-static. Energy error: stored "
                 "energy + heat - work of the platen, over the largest work so far."};
  return table;
}

} // namespace

PageWriter read_shear_page(const std::vector<fs::path> &folders) {
  return [runs = read_element_runs(folders, "shear.csv", read_shear)](const fs::path &out) {
    std::vector<ShearStrength> strengths;
    strengths.reserve(runs.size());
    for (const ShearRun &run : runs)
      strengths.push_back(shear_strength_of(run.rows));
    const std::vector<SoilGroup> soils = soils_of(runs, {shear_test.confining});
    Page page(out, shear_title, Drawing::shear);
    page.answer("Samples of soil between two rough plates, periodic sideways, sheared by the upper one under "
                "a constant normal stress. The ratio of the stresses is the friction on the plane of shear.");
    answer_quality(page, runs, strength_quality<ShearRow>);
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
