#include "report/soil/pages.h"

#include "bed/element_results.h"
#include "pages/figure.h"
#include "pages/page.h"
#include "report/soil/strength_test.h"
#include "support/units.h"
#include "support/csv.h"
#include "support/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

using CompressionRun = ElementRun<CompressionRow>;
using CompressionTest = StrengthTest<CompressionRow>;

/// A test named as its CSV file.
CompressionTest compression_test(const std::string &name) {
  return {name,
          "side",
          &CompressionRow::axial_stress,
          &CompressionRow::side_stress,
          [](double axial, double side) {
            return Failure{axial, side}.angle();
          },
          "Samples sheared under a constant side stress",
          "axial strain",
          "Mobilised friction angle",
          "friction angle",
          "asin((axial - side)/(axial + side stress))"};
}

/// Angles over the seeds of a soil, for each side stress and for all.
PageTable seed_table(const CompressionTest &test, const std::vector<SoilGroup> &soils,
                     const std::vector<CompressionRun> &runs, const std::vector<Strength> &strengths) {
  PageTable table(test.name + "_angles", "Angles over the seeds",
                  "soil | side stress (kPa) | runs | peak friction angle (°) | smallest to largest (°) | "
                  "dilatancy angle at the peak (°) | critical friction angle (°) | smallest to largest (°)");
  add_soils(table, test, soils, runs, [&](const std::vector<std::size_t> &members) {
    SeedValues peak, dilatancy, critical;
    for (const std::size_t n : members) {
      const std::string seed = runs[n].run.text("seed");
      peak.add(seed, strengths[n].peak.angle());
      dilatancy.add(seed, strengths[n].dilatancy);
      if (strengths[n].is_critical) critical.add(seed, strengths[n].critical.angle());
    }
    return std::vector<std::string>{peak.mean_text(), peak.range_text(), dilatancy.mean_text(),
                                    critical.mean_text(), critical.range_text()};
  });
  table.notes = {
      "Mean and half of its 95 % confidence interval over the seeds; runs of one seed count once. sin φ = "
      "(axial - side stress)/(axial + side stress). Peak: the largest value of the stresses averaged over a "
      "thirtieth of the strain, within the first third of the strain: later a single force chain from platen "
      "to platen can carry more for a moment. Critical: stresses averaged over the last third, if the strain "
      "reaches 10 %. Dilatancy: sin ψ = -(volumetric strain)/(2 axial - volumetric strain) over a fifteenth "
      "of the strain around the peak."};
  return table;
}

/// Failures of the runs of a soil; `critical`: at large strains instead of the peak.
std::vector<Failure> failures_of(const SoilGroup &soil, const std::vector<Strength> &strengths,
                                 bool critical) {
  std::vector<Failure> failures;
  for (const std::size_t n : soil.runs)
    if (!critical || strengths[n].is_critical)
      failures.push_back(critical ? strengths[n].critical : strengths[n].peak);
  return failures;
}

bool have_line(const std::vector<Failure> &failures,
               const std::map<double, std::vector<std::size_t>> &sides) {
  return sides.size() > 1 && failures.size() > 2;
}

/// The line through all failures of a soil, at the peak and at large strains.
PageTable line_table(const CompressionTest &test, const std::vector<SoilGroup> &soils,
                     const std::vector<CompressionRun> &runs, const std::vector<Strength> &strengths) {
  PageTable table(
      test.name + "_lines", "Mohr-Coulomb lines",
      "soil | failure | runs | side stresses | friction angle (°) | 95 % interval (°) | cohesion (kPa)", 2);
  for (const SoilGroup &soil : soils)
    for (const bool critical : {false, true}) {
      const std::vector<Failure> failures = failures_of(soil, strengths, critical);
      const auto sides = grouped_by(confining_stresses(test, runs), soil);
      if (!have_line(failures, sides)) continue;
      const MohrCoulomb line = fit_mohr_coulomb(failures);
      table.add({soil.name, critical ? "critical" : "peak", std::to_string(failures.size()),
                 std::to_string(sides.size()), fmt::format("{:.1f}", line.angle),
                 fmt::format("{:.1f} to {:.1f}", line.lowest_angle, line.highest_angle),
                 fmt::format("{:.1f} ± {:.1f}", line.cohesion, line.half_width)});
    }
  table.notes = {
      "Half the difference of the stresses at failure is a line over half their sum: the slope is sin φ, the "
      "intercept c cos φ. Least squares of their ratio, since its scatter is the same at all stresses. A "
      "soil without cohesion has an interval of c that contains zero. The intervals take all runs as "
      "independent: those of one seed are not, so that they are somewhat too narrow."};
  return table;
}

PageTable run_table(const CompressionTest &test, const std::vector<CompressionRun> &runs,
                    const std::vector<Strength> &strengths) {
  PageTable table = element_run_table(
      test.name + "_runs",
      "side stress (kPa) | void ratio at the start (-) | E50 (MPa) | peak friction angle (°) | strain at the "
      "peak (%) | dilatancy angle (°) | critical friction angle (°) | void ratio at the end (-)");
  for (std::size_t n = 0; n < runs.size(); ++n) {
    const CompressionRun &run = runs[n];
    const Strength &strength = strengths[n];
    add_element_run(table, run.run,
                    {run.run.text("side"), number_cell(run.rows.front().void_ratio),
                     number_cell(strength.secant_modulus, 3), number_cell(strength.peak.angle()),
                     number_cell(100 * strength.strain, 3), number_cell(strength.dilatancy, 3),
                     strength.is_critical ? number_cell(strength.critical.angle()) : no_value,
                     number_cell(run.rows.back().void_ratio)},
                    strength_quality(run));
  }
  table.criterion += " and reached the strain asked for";
  table.notes = {"E50: half of the axial minus the side stress at the peak, over the strain at which it is "
                 "reached. Inertial number: strain rate times diameter sqrt(density/side stress); below 1e-3 "
                 "a test is quasi-static. Energy error: stored energy + heat - work of the platens, over the "
                 "largest work so far."};
  return table;
}

/// Failures of all runs and the lines through them.
PageFigure line_figure(const CompressionTest &test, const std::vector<SoilGroup> &soils,
                       const std::vector<CompressionRun> &runs, const std::vector<Strength> &strengths) {
  const std::string name = "mohr_coulomb";
  Panel panel{"", "half the sum of the stresses (kPa)", "half their difference (kPa)", {}};
  panel.tight_x = true;
  CurveTable table("half the sum of the stresses (kPa),half their difference (kPa)");
  std::size_t lines = 0;
  for (const bool critical : {false, true}) {
    const std::string points = critical ? "critical" : "peak";
    for (const SoilGroup &soil : soils) {
      const std::vector<Failure> failures = failures_of(soil, strengths, critical);
      double end = 0.0;
      for (const Failure &failure : failures) {
        table.row(points, {failure.half_sum(), failure.half_difference()});
        end = std::max(end, failure.half_sum());
      }
      if (!have_line(failures, grouped_by(confining_stresses(test, runs), soil))) continue;
      const MohrCoulomb line = fit_mohr_coulomb(failures);
      const std::string key = fmt::format("{}; {}: {:.1f}°", soil.short_name(), points, line.angle);
      for (const double sum : {0.0, 1.05 * end})
        table.row(key, {sum, line.cohesion * std::cos(line.angle / degrees_per_radian) +
                                 sum * std::sin(line.angle / degrees_per_radian)});
      panel.curves.push_back(curve(name, key, "$2", "3", line_style(lines++)));
    }
    panel.curves.push_back(
        curve(name, points, "$2", "3", critical ? CurveStyle::measured_a : CurveStyle::measured_b));
  }
  PageFigure figure = page_figure(
      "Fig. 2",
      "Half the difference over half the sum of axial and side stress of each run at failure, and the "
      "Mohr-Coulomb lines through them, whose slopes are the sines of the friction angles.",
      {name, "", {panel}, 1});
  figure.csv = table.text();
  return figure;
}

/// Reads the runs of a test for their page; `answer` tells what the test is.
PageWriter read_page(const CompressionTest &test, const std::string &title, Drawing drawing,
                     const std::string &answer, const std::vector<fs::path> &folders) {
  return [=, runs = read_element_runs(folders, test.name + ".csv", read_compression)](const fs::path &out) {
    std::vector<Strength> strengths;
    strengths.reserve(runs.size());
    for (const CompressionRun &run : runs)
      strengths.push_back(strength_of(run.rows));
    const std::vector<SoilGroup> soils = soils_of(runs, {test.confining});
    Page page(out, title, drawing);
    page.answer(answer);
    answer_quality(page, runs, strength_quality<CompressionRow>);
    page.section("Friction and volume");
    page.figure(strength_figure(test, soils, runs));
    page.section("Friction angle");
    page.table(seed_table(test, soils, runs, strengths));
    const PageTable lines = line_table(test, soils, runs, strengths);
    if (!lines.rows.empty()) {
      page.table(lines);
      page.figure(line_figure(test, soils, runs, strengths));
    }
    page.section("Numbers");
    page.table(run_table(test, runs, strengths));
    page.write();
  };
}

} // namespace

PageWriter read_biaxial_page(const std::vector<fs::path> &folders) {
  return read_page(
      compression_test("biaxial"), biaxial_title, Drawing::biaxial,
      "Samples of soil between four smooth plates, sheared by the upper one under a constant stress of the "
      "side platen. The ratio of the stresses at failure is the friction angle of the soil.",
      folders);
}

PageWriter read_triaxial_page(const std::vector<fs::path> &folders) {
  return read_page(
      compression_test("triaxial"), triaxial_title, Drawing::triaxial,
      "Samples of soil between six smooth plates, sheared by the upper one under the same constant stress of "
      "both side platens. The ratio of the stresses at failure is the friction angle of the soil.",
      folders);
}

} // namespace drumlin::post
