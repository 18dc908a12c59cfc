// What the pages on compression tests and on shear tests have in common: mobilised friction and volume over
// the strain.
#pragma once

#include "bed/element_results.h"
#include "pages/figure.h"
#include "report/soil/page_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace drumlin::post {

/// A kind of test of the strength of a soil. Row has the members strain and volumetric_strain, positive in
/// compression.
template <class Row>
struct StrengthTest {
  std::string name;              ///< of the figure and of the files of its data
  const char *confining;         ///< parameter of a run that holds the confining stress, kPa
  double Row::*shearing_stress;  ///< of the row: grows until the soil fails, kPa
  double Row::*confining_stress; ///< of the row: kept constant, kPa
  double (*angle)(double shearing, double confining); ///< mobilised friction angle of two stresses, degrees
  std::string title, strain_axis, angle_title, angle_axis, angle_formula; ///< words of the figure
};

/// Whether a test was slow enough and exact enough, and reached the strain that it was asked for.
template <class Row>
TestQuality strength_quality(const ElementRun<Row> &run) {
  TestQuality quality = quality_of(run.rows);
  if (const auto asked = run.run.number("strain")) quality.strain_reached = run.rows.back().strain / *asked;
  return quality;
}

/// The confining stress of each run, kPa: that asked for, else that of its first row in whole kPa.
template <class Row>
std::vector<double> confining_stresses(const StrengthTest<Row> &test,
                                       const std::vector<ElementRun<Row>> &runs) {
  std::vector<double> stresses;
  stresses.reserve(runs.size());
  for (const ElementRun<Row> &run : runs)
    stresses.push_back(
        run.run.number(test.confining).value_or(std::round(run.rows.front().*test.confining_stress)));
  return stresses;
}

/// Adds the rows of a table over the seeds, for each soil: one for each confining stress, and one for all if
/// there are several. `cells` gives the quantities of some runs of a soil, given as places in the list of
/// runs.
template <class Row, class Cells>
void add_soils(PageTable &table, const StrengthTest<Row> &test, const std::vector<SoilGroup> &soils,
               const std::vector<ElementRun<Row>> &runs, const Cells &cells) {
  const auto add = [&](const SoilGroup &soil, const std::string &stress,
                       const std::vector<std::size_t> &members) {
    std::vector<std::string> row = {soil.name, stress, std::to_string(members.size())};
    for (std::string &cell : cells(members))
      row.push_back(std::move(cell));
    table.add(row);
  };
  for (const SoilGroup &soil : soils) {
    const auto groups = grouped_by(confining_stresses(test, runs), soil);
    for (const auto &[stress, members] : groups)
      add(soil, number_cell(stress), members);
    if (groups.size() > 1) add(soil, "all", soil.runs);
  }
}

/// Adds the rows of one curve of strength_figure(): the means over runs that differ only in the seed.
template <class Row>
void add_means(CurveTable &table, const std::string &key, const StrengthTest<Row> &test,
               const std::vector<ElementRun<Row>> &runs, const std::vector<std::size_t> &members) {
  double end = std::numeric_limits<double>::infinity();
  for (const std::size_t n : members)
    end = std::min(end, runs[n].rows.back().strain);
  constexpr int points = 60;
  for (int point = 0; point <= points; ++point) {
    const double strain = end * point / points;
    double shearing = 0.0, confining = 0.0, volumetric = 0.0;
    for (const std::size_t n : members) {
      const std::vector<Row> &rows = runs[n].rows;
      shearing += number_at(rows, &Row::strain, strain, test.shearing_stress);
      confining += number_at(rows, &Row::strain, strain, test.confining_stress);
      volumetric += number_at(rows, &Row::strain, strain, &Row::volumetric_strain);
    }
    table.row(key, {100 * strain, test.angle(shearing, confining),
                    -100 * volumetric / static_cast<double>(members.size())});
  }
}

/// Mobilised friction angle and volumetric strain over the strain, means over the seeds.
template <class Row>
PageFigure strength_figure(const StrengthTest<Row> &test, const std::vector<SoilGroup> &soils,
                           const std::vector<ElementRun<Row>> &runs) {
  const std::string angle_axis = test.angle_axis + " (°)", strain_axis = test.strain_axis + " (%)";
  Panel friction{test.angle_title, strain_axis, angle_axis, {}};
  Panel volume{"Volume", strain_axis, "increase of the volume (%)", {}};
  friction.tight_x = volume.tight_x = true;
  friction.y_range = "[0:*]";
  volume.y_range = "[*:*]";
  CurveTable table(strain_axis + "," + angle_axis + ",increase of the volume (%)");
  std::size_t curves = 0;
  for (const SoilGroup &soil : soils)
    for (const auto &[stress, members] : grouped_by(confining_stresses(test, runs), soil)) {
      const std::string key =
          members.size() > 1 ? fmt::format("{}; {:g} kPa; {} runs", soil.short_name(), stress, members.size())
                             : curve_text(runs[members.front()].run.name);
      add_means(table, key, test, runs, members);
      const CurveStyle style = line_style(curves++);
      friction.curves.push_back(curve(test.name, key, "$2", "3", style));
      volume.curves.push_back(curve(test.name, key, "$2", "4", style));
    }
  PageFigure figure = page_figure("Fig. 1",
                                  fmt::format("Mobilised friction, {}, and increase of the volume over {}. "
                                              "Runs that differ only in the seed are averaged.",
                                              test.angle_formula, test.strain_axis),
                                  {test.name, test.title, {friction, volume}, 1}, 1.0);
  figure.csv = table.text();
  return figure;
}

} // namespace drumlin::post
