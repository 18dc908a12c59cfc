#include "report/shear_page.h"

#include "pages/figure_data.h"
#include "report/element_test.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

using ShearRun = ElementRun<ShearRow>;

constexpr double degree = 180.0 / 3.14159265358979323846;

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

/// The normal stress of each run, kPa.
std::vector<double> normal_stresses(const std::vector<ShearRun> &runs) {
  std::vector<double> stresses;
  stresses.reserve(runs.size());
  for (const ShearRun &run : runs)
    stresses.push_back(run.run.number("normal").value_or(std::round(run.rows.front().normal_stress)));
  return stresses;
}

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
  const auto add = [&](const Soil &soil, const std::string &stress, const std::vector<std::size_t> &members) {
    SeedValues peak, dilatancy, peak_davis, critical, critical_davis;
    for (const std::size_t n : members) {
      const std::string seed = runs[n].run.text("seed");
      peak.add(seed, strengths[n].peak.angle());
      dilatancy.add(seed, strengths[n].peak.dilatancy);
      peak_davis.add(seed, strengths[n].peak.davis_angle());
      critical.add(seed, strengths[n].critical.angle());
      critical_davis.add(seed, strengths[n].critical.davis_angle());
    }
    table.add({soil.name, stress, std::to_string(members.size()), peak.mean_text(), dilatancy.mean_text(),
               peak_davis.mean_text(), critical.mean_text(), critical_davis.mean_text()});
  };
  for (const Soil &soil : soils) {
    const auto groups = grouped_by(normal_stresses(runs), soil);
    for (const auto &[stress, members] : groups)
      add(soil, number_cell(stress), members);
    if (groups.size() > 1) add(soil, "all", soil.runs);
  }
  table.notes = {
      "Mean and half of its 95 % confidence interval over the seeds; runs of one seed count once. Peak: the "
      "largest ratio of the stresses averaged over a thirtieth of the strain, within the first third. "
      "Critical: over the last third. Dilatancy: tan ψ = -(volumetric strain)/(shear strain), over three "
      "thirtieths. On the plane of shear: the angle whose tangent is shear over normal stress. After Davis: "
      "sin φ = t/(cos ψ + t sin ψ) with t that ratio, the friction angle of a soil in which stress and "
      "strain increment have the same directions; it compares with that of a biaxial test."};
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
                     number_cell(strength.peak.dilatancy, 3), number_cell(strength.critical.angle()),
                     number_cell(run.rows.back().void_ratio)},
                    quality_of(run.rows));
  }
  table.notes = {
      "Friction: on the plane of shear. Inertial number: shear rate times diameter sqrt(density/normal "
      "stress); below 1e-3 a test is quasi-static. Energy error: stored energy + heat - work of the platen, "
      "over the largest work so far."};
  return table;
}

/// Mobilised friction and volumetric strain over shear strain, means over the seeds.
PageFigure strain_figure(const std::vector<Soil> &soils, const std::vector<ShearRun> &runs) {
  const std::string name = "shear";
  Panel friction{"Mobilised friction on the plane of shear", "shear strain (%)", "angle (°)", {}};
  Panel volume{"Volume", "shear strain (%)", "increase of the volume (%)", {}};
  friction.tight_x = volume.tight_x = true;
  friction.y_range = "[0:*]";
  volume.y_range = "[*:*]";
  CurveTable table("shear strain (%),angle (°),increase of the volume (%)");
  std::size_t curves = 0;
  for (const Soil &soil : soils)
    for (const auto &[stress, members] : grouped_by(normal_stresses(runs), soil)) {
      const std::string key =
          members.size() > 1 ? fmt::format("{}; {:g} kPa; {} runs", soil.short_name(), stress, members.size())
                             : curve_text(runs[members.front()].run.name);
      double end = std::numeric_limits<double>::infinity();
      for (const std::size_t n : members)
        end = std::min(end, runs[n].rows.back().strain);
      constexpr int points = 60;
      for (int point = 0; point <= points; ++point) {
        const double strain = end * point / points;
        double shear = 0.0, normal = 0.0, volumetric = 0.0;
        for (const std::size_t n : members) {
          shear += number_at(runs[n].rows, &ShearRow::strain, strain, &ShearRow::shear_stress);
          normal += number_at(runs[n].rows, &ShearRow::strain, strain, &ShearRow::normal_stress);
          volumetric += number_at(runs[n].rows, &ShearRow::strain, strain, &ShearRow::volumetric_strain) /
                        static_cast<double>(members.size());
        }
        table.row(key, {100 * strain, degree * std::atan(shear / normal), -100 * volumetric});
      }
      const CurveStyle style = line_style(curves++);
      friction.curves.push_back(curve(name, key, "$2", "3", style));
      volume.curves.push_back(curve(name, key, "$2", "4", style));
    }
  PageFigure figure;
  figure.label = "Fig. 1";
  figure.caption =
      "Mobilised friction, atan(shear stress/normal stress), and increase of the volume over shear "
      "strain. Runs that differ only in the seed are averaged.";
  figure.weight = 1.0;
  figure.figure = {name, "Samples sheared under a constant normal stress", {friction, volume}, 1};
  figure.csv = table.text();
  return figure;
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
    const std::vector<Soil> soils = soils_of(runs, {"normal"});
    Page page(out, shear_title, Scene::shear);
    page.answer(
        "Samples of soil between two rough plates, periodic sideways, sheared by the upper one under a "
        "constant normal stress. The ratio of the stresses is the friction on the plane of shear.");
    answer_quality(page, runs);
    page.section("Friction and volume");
    page.figure(strain_figure(soils, runs));
    page.section("Friction angle");
    page.table(seed_table(soils, runs, strengths));
    page.section("Numbers");
    page.table(run_table(runs, strengths));
    page.write();
  };
}

} // namespace drumlin::post
