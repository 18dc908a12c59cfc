#include "report/soil/pages.h"

#include "engine/deck_run.h"
#include "pages/figure.h"
#include "report/soil/page_parts.h"
#include "support/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

using CyclicRun = ElementRun<LoopRow>;

constexpr double percent = 100.0;
const std::vector<std::string> varied_in_cycles = {"amplitude", "cycles", "samples_of_way"};

/// The amplitude asked for, in percent.
double amplitude_of(const CyclicRun &run) {
  return percent * run.run.number("amplitude").value_or(run.rows.front().amplitude);
}

std::vector<double> amplitudes_of(const std::vector<CyclicRun> &runs) {
  std::vector<double> amplitudes;
  amplitudes.reserve(runs.size());
  for (const CyclicRun &run : runs)
    amplitudes.push_back(amplitude_of(run));
  return amplitudes;
}

/// Of the rows of shear.csv from the first cycle on: before it the work may still be nothing, to which an
/// energy error is compared.
TestQuality quality_beside(const CyclicRun &run) {
  const Table rows = read_element_table(run.run.folder / "shear.csv");
  const std::vector<double> cycle = rows.numbers("cycle"), inertial = rows.numbers("inertial_number"),
                            error = rows.numbers("energy_error");
  TestQuality quality;
  for (std::size_t n = 0; n < cycle.size(); ++n) {
    if (cycle[n] < 1) continue;
    quality.inertial_number = std::max(quality.inertial_number, std::fabs(inertial[n]));
    quality.energy_error = std::max(quality.energy_error, std::fabs(error[n]));
  }
  return quality;
}

/// What runs that differ only in the seed have found at the end of their last common cycle.
struct AtAmplitude {
  std::size_t cycles = 0;
  std::vector<double> volumetric, ratio, damping;
  SeedValues volumetric_by_seed, modulus_by_seed, ratio_by_seed, damping_by_seed, heat_by_seed, void_by_seed;
};

double mean_of(const std::vector<double> &values) {
  double sum = 0.0;
  for (const double value : values)
    sum += value;
  return values.empty() ? not_a_number : sum / static_cast<double>(values.size());
}

/// The runs of a soil by their amplitude, in percent. A modulus is divided by that of the same seed at the
/// smallest amplitude of the soil.
std::map<double, AtAmplitude> by_amplitude(const std::vector<CyclicRun> &runs, const SoilGroup &soil) {
  const auto groups = grouped_by(amplitudes_of(runs), soil);
  std::map<std::string, double> largest; // by the seed
  if (groups.size() > 1)
    for (const std::size_t n : groups.begin()->second)
      largest[runs[n].run.text("seed")] = runs[n].rows.back().secant_modulus;
  std::map<double, AtAmplitude> found;
  for (const auto &[amplitude, members] : groups) {
    AtAmplitude &here = found[amplitude];
    here.cycles = std::numeric_limits<std::size_t>::max();
    for (const std::size_t n : members)
      here.cycles = std::min(here.cycles, runs[n].rows.size());
    for (const std::size_t n : members) {
      const LoopRow &row = runs[n].rows[here.cycles - 1];
      const std::string seed = runs[n].run.text("seed");
      const auto of_seed = largest.find(seed);
      const double ratio = of_seed == largest.end() ? not_a_number : row.secant_modulus / of_seed->second;
      here.volumetric.push_back(percent * row.volumetric_strain);
      here.damping.push_back(row.damping_ratio);
      if (std::isfinite(ratio)) here.ratio.push_back(ratio);
      here.volumetric_by_seed.add(seed, percent * row.volumetric_strain);
      here.modulus_by_seed.add(seed, row.secant_modulus);
      here.ratio_by_seed.add(seed, ratio);
      here.damping_by_seed.add(seed, row.damping_ratio);
      here.heat_by_seed.add(seed, row.damping_ratio_of_heat);
      here.void_by_seed.add(seed, row.void_ratio);
    }
  }
  return found;
}

PageTable soil_table(const std::vector<CyclicRun> &runs, const std::vector<SoilGroup> &soils) {
  PageTable table(
      "loops_soils", "Soils over the amplitude",
      "soil | amplitude (%) | runs | cycle | volumetric strain (%) | void ratio (-) | secant "
      "modulus (MPa) | over that of the smallest amplitude (-) | damping ratio (-) | damping ratio "
      "of the heat (-)");
  for (const SoilGroup &soil : soils)
    for (const auto &[amplitude, here] : by_amplitude(runs, soil))
      table.add({soil.name, number_cell(amplitude), std::to_string(here.volumetric.size()),
                 std::to_string(here.cycles), here.volumetric_by_seed.mean_text(3),
                 here.void_by_seed.mean_text(3), here.modulus_by_seed.mean_text(),
                 here.ratio_by_seed.mean_text(3), here.damping_by_seed.mean_text(3),
                 here.heat_by_seed.mean_text(3)});
  table.notes = {
      "Mean and half of its 95 % confidence interval over the seeds, at the last cycle that all runs "
      "have. Volumetric strain: positive where the sample contracts. The two damping ratios, from "
      "the area of the loop and from what the contacts dissipate, should agree."};
  return table;
}

PageTable run_table(const std::vector<CyclicRun> &runs, const std::vector<TestQuality> &qualities) {
  PageTable table = element_run_table(
      "loops_runs", "amplitude (%) | normal stress (kPa) | cycles | volumetric strain (%) | void "
                    "ratio at the end (-) | secant modulus (MPa) | damping ratio (-) | damping "
                    "ratio of the heat (-)");
  for (std::size_t n = 0; n < runs.size(); ++n) {
    const LoopRow &last = runs[n].rows.back();
    add_element_run(table, runs[n].run,
                    {number_cell(amplitude_of(runs[n])), runs[n].run.text("normal"),
                     fmt::format("{} of {}", runs[n].rows.size(), runs[n].run.text("cycles")),
                     number_cell(percent * last.volumetric_strain), number_cell(last.void_ratio),
                     number_cell(last.secant_modulus), number_cell(last.damping_ratio),
                     number_cell(last.damping_ratio_of_heat)},
                    qualities[n]);
  }
  table.notes = {
      "Of the last cycle. Inertial number: shear rate times diameter sqrt(density/normal stress); "
      "below 1e-3 a test is quasi-static. Energy error: stored energy + heat - work of the platen, "
      "over the largest work so far."};
  return table;
}

/// Volumetric strain, modulus ratio and damping ratio over the amplitude, beside published curves.
PageFigure amplitude_figure(const std::vector<CyclicRun> &runs, const std::vector<SoilGroup> &soils) {
  const std::string name = "loops_amplitude", axis = "amplitude of the shear strain (%)";
  Panel volume{"Volume", axis, "volumetric strain (%)", {}}, modulus{"Modulus", axis, "G/G_{max} (-)", {}},
      damping{"Damping", axis, "damping ratio (-)", {}};
  volume.log_x = modulus.log_x = damping.log_x = true;
  volume.y_range = "[*:*]";
  modulus.y_range = damping.y_range = "[0:*]";
  CurveTable table("amplitude (%),volumetric strain (%),G/Gmax (-),damping ratio (-)");
  for (std::size_t n = 0; n < soils.size(); ++n) {
    const std::string key = soils[n].short_name();
    const auto found = by_amplitude(runs, soils[n]);
    for (const auto &[amplitude, here] : found)
      table.row(key, {amplitude, mean_of(here.volumetric), mean_of(here.ratio), mean_of(here.damping)});
    volume.curves.push_back(curve(name, key, "$2", "3", series_style(n)));
    if (found.size() > 1) modulus.curves.push_back(curve(name, key, "$2", "4", series_style(n)));
    damping.curves.push_back(curve(name, key, "$2", "5", series_style(n)));
  }
  const Table published = read_table(input_file("soil/published_shear.csv"));
  const std::vector<std::string> curves = published.text("curve");
  const std::vector<double> amplitude = published.numbers("amplitude_percent"),
                            ratio = published.numbers("modulus_ratio"),
                            share = published.numbers("damping_ratio");
  for (std::size_t n = 0; n < curves.size(); ++n)
    table.row(curves[n], {amplitude[n], not_a_number, ratio[n], share[n]});
  std::size_t line = soils.size(); // other colours than those of the first soils
  for (const std::string &key : std::set<std::string>(curves.begin(), curves.end())) {
    modulus.curves.push_back(curve(name, key, "$2", "4", line_style(line)));
    damping.curves.push_back(curve(name, key, "$2", "5", line_style(line++)));
  }
  PageFigure figure =
      page_figure("Fig. 1",
                  "Volumetric strain, positive where the sample contracts, modulus over that of the smallest "
                  "amplitude of the "
                  "soil and damping ratio, at the last cycle, means over the seeds. Lines: published curves "
                  "of sand (Seed and "
                  "Idriss 1970) and gravel (Menq 2003); inputs/soil/cyclic_shear.md says how they were read.",
                  {name, "Samples sheared to and fro", {volume, modulus, damping}, 1}, 1.0);
  figure.csv = table.text();
  return figure;
}

/// Volumetric strain over the cycles.
PageFigure cycle_figure(const std::vector<CyclicRun> &runs, const std::vector<SoilGroup> &soils) {
  const std::string name = "loops_cycles";
  Panel panel{"Volume", "cycle", "volumetric strain (%)", {}};
  panel.y_range = "[*:*]";
  panel.whole_x = true;
  CurveTable table("cycle,volumetric strain (%)");
  std::size_t styles = 0;
  for (const SoilGroup &soil : soils)
    for (const auto &[amplitude, members] : grouped_by(amplitudes_of(runs), soil)) {
      const std::string key = fmt::format("{}; {:g} %", soil.short_name(), amplitude);
      std::size_t cycles = std::numeric_limits<std::size_t>::max();
      for (const std::size_t n : members)
        cycles = std::min(cycles, runs[n].rows.size());
      if (cycles < 3) continue;
      for (std::size_t cycle = 0; cycle < cycles; ++cycle) {
        std::vector<double> strains;
        strains.reserve(members.size());
        for (const std::size_t n : members)
          strains.push_back(percent * runs[n].rows[cycle].volumetric_strain);
        table.row(key, {static_cast<double>(cycle + 1), mean_of(strains)});
      }
      panel.curves.push_back(curve(name, key, "$2", "3", line_style(styles++)));
    }
  PageFigure figure = page_figure(
      "Fig. 2",
      "Volumetric strain over the cycles of tests of three or more. Runs that differ only in the seed "
      "are averaged.",
      {name, "", {panel}, 1}, 0.5);
  figure.csv = table.text();
  return figure;
}

} // namespace

PageWriter read_cyclic_shear_page(const std::vector<fs::path> &folders) {
  const std::vector<CyclicRun> runs = read_element_runs(folders, "loops.csv", read_loops);
  std::vector<TestQuality> qualities;
  qualities.reserve(runs.size());
  for (const CyclicRun &run : runs)
    qualities.push_back(quality_beside(run));
  return [=](const fs::path &out) {
    const std::vector<SoilGroup> soils = soils_of(runs, varied_in_cycles);
    Page page(out, cyclic_shear_title, Drawing::shear);
    page.answer(
        "Samples of soil between two rough plates, periodic sideways, sheared to and fro under a constant "
        "normal stress.");
    page.answer(quality_criteria(worst_of(qualities)));
    page.section("Volume, modulus and damping");
    page.figure(amplitude_figure(runs, soils));
    const PageFigure cycles = cycle_figure(runs, soils);
    if (!cycles.figure.panels.front().curves.empty()) page.figure(cycles);
    page.table(soil_table(runs, soils));
    page.section("Numbers");
    page.table(run_table(runs, qualities));
    page.write();
  };
}

} // namespace drumlin::post
