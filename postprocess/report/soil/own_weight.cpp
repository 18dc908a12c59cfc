#include "report/soil/pages.h"

#include "bed/element_results.h"
#include "pages/figure.h"
#include "report/soil/page_parts.h"
#include "support/units.h"
#include "support/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

using OwnWeightRun = ElementRun<OwnWeightRow>;

const std::vector<std::string> of_each_sample = {"weight", "width",
                                                 "height"}; // parameters of the sample, not the soil

/// A parameter of a run. Throws std::runtime_error if it is not recorded or below `least`.
double recorded(const Run &run, const std::string &name, double least) {
  const std::optional<double> value = run.number(name);
  if (!value || *value < least)
    throw std::runtime_error(fmt::format("{}: {} is '{}'; allowed: a number of at least {:g}",
                                         (run.folder / "parameters.csv").string(), name, run.text(name, ""),
                                         least));
  return *value;
}

RestingSoil soil_of(const Run &run) {
  constexpr double least = 1e-12; // above 0
  return {recorded(run, "weight", least), recorded(run, "width", least), recorded(run, "height", least)};
}

/// Key of a curve that stands for some runs.
std::string key_of(const SoilGroup &soil, const std::vector<OwnWeightRun> &runs) {
  return soil.runs.size() > 1 ? fmt::format("{}; {} runs", soil.short_name(), soil.runs.size())
                              : curve_text(runs[soil.runs.front()].run.name);
}

PageFigure one_panel(const std::string &name, const std::string &caption, const Panel &panel,
                     const CurveTable &table) {
  PageFigure figure = page_figure("Fig. 1", caption, {name, "", {panel}, 1}, 1.0);
  figure.csv = table.text();
  return figure;
}

// ---- A wall that moves outward

PageFigure wall_figure(const std::vector<OwnWeightRun> &runs) {
  const std::string name = "wall";
  Panel panel{
      "", "displacement of the wall over the height (%)", "force on the wall over the hydrostatic one", {}};
  panel.tight_x = true;
  panel.y_range = "[0:*]";
  CurveTable table("displacement over height (%),force over hydrostatic force");
  for (std::size_t n = 0; n < runs.size(); ++n) {
    const RestingSoil soil = soil_of(runs[n].run);
    const std::string key = curve_text(runs[n].run.name);
    for (const OwnWeightRow &row : runs[n].rows)
      table.row(key, {0.1 * row.displacement / soil.height,
                      0.5 * (row.left_force + row.side_force) / soil.hydrostatic_force()});
    panel.curves.push_back(curve(name, key, "$2", "3", line_style(n)));
  }
  return one_panel(name,
                   "Mean force on both smooth walls over that of a liquid with the soil's weight: its least "
                   "value is Rankine's coefficient K_a of active earth pressure.",
                   panel, table);
}

void write_wall_page(const std::vector<OwnWeightRun> &runs, const fs::path &out) {
  PageTable single =
      element_run_table("wall_runs", "height (m) | force at rest (N) | K at rest (-) | active force (N) | "
                                     "K_a (-) | friction angle by Rankine (°) | displacement (mm)");
  PageTable means("wall_soils", "Means over the seeds",
                  "soil | runs | 100 K at rest | 100 K_a | friction angle by Rankine (°)");
  for (const SoilGroup &group : soils_of(runs, of_each_sample)) {
    SeedValues at_rest, active, angle;
    for (const std::size_t n : group.runs) {
      const OwnWeightRun &run = runs[n];
      const RestingSoil soil = soil_of(run.run);
      const ActiveState state = active_state(run.rows, soil);
      const OwnWeightRow &first = run.rows.front();
      const double force = 0.5 * (first.left_force + first.side_force);
      const std::string seed = run.run.text("seed");
      at_rest.add(seed, 100 * force / soil.hydrostatic_force());
      active.add(seed, 100 * state.coefficient);
      angle.add(seed, state.angle());
      add_element_run(
          single, run.run,
          {number_cell(soil.height), number_cell(force), number_cell(force / soil.hydrostatic_force()),
           number_cell(state.coefficient * soil.hydrostatic_force()), number_cell(state.coefficient),
           number_cell(state.angle()), number_cell(state.displacement)},
          quality_of(run.rows));
    }
    means.add({group.name, std::to_string(group.runs.size()), at_rest.mean_text(), active.mean_text(),
               angle.mean_text()});
  }
  means.notes = {
      "Mean and half of its 95 % confidence interval over the seeds. K: force on a wall over the hydrostatic "
      "force, weight/width times half the height; the height is twice that of the centre of mass. K_a: the "
      "smallest mean over a thirtieth of the rows. Rankine: K_a = (1 - sin φ)/(1 + sin φ)."};
  Page page(out, wall_title, Drawing::wall);
  page.answer("Soil between two smooth walls on a smooth floor, of which the right wall moves outward "
              "slowly. When the soil fails, the force on the wall is that of the active state.");
  answer_quality(page, runs);
  page.section("Force on the wall");
  page.figure(wall_figure(runs));
  page.table(means);
  page.section("Numbers");
  page.table(single);
  page.write();
}

// ---- A silo

/// Janssen's theory with one coefficient for all runs of a soil.
struct SiloSoil {
  SoilGroup soil;
  double coefficient = 0.0;
};

PageFigure silo_figure(const std::vector<OwnWeightRun> &runs, const std::vector<SiloState> &states,
                       const std::vector<SiloSoil> &soils) {
  const std::string name = "silo";
  Panel panel{"", "height over width", "stress on the floor over γB", {}};
  panel.tight_x = true;
  panel.y_range = "[0:*]";
  CurveTable table("height over width,stress over weight density times width");
  for (std::size_t s = 0; s < soils.size(); ++s) {
    const SoilGroup &group = soils[s].soil;
    const std::string key = key_of(group, runs), theory = group.short_name() + "; Janssen";
    double highest = 0.0;
    for (const std::size_t n : group.runs) {
      const RestingSoil soil = soil_of(runs[n].run);
      highest = std::max(highest, soil.height / soil.width);
      table.row(key, {soil.height / soil.width, states[n].floor_share * soil.height / soil.width});
    }
    panel.curves.push_back(
        curve(name, key, "$2", "3", s % 2 == 0 ? CurveStyle::measured_b : CurveStyle::measured_a));
    const double friction = recorded(runs[group.runs.front()].run, "plate_friction", 0.0);
    constexpr int points = 40;
    for (int point = 0; point <= points; ++point) {
      const double height = highest * point / points;
      table.row(theory, {height, height * janssen(2 * friction * soils[s].coefficient * height)});
    }
    panel.curves.push_back(curve(name, theory, "$2", "3", line_style(s)));
  }
  return one_panel(name,
                   "Vertical stress on the floor, over weight per volume γ times width B, over the height of "
                   "the filling, and Janssen's stress with the mean of the coefficients that follow from the "
                   "normal forces on the walls.",
                   panel, table);
}

void write_silo_page(const std::vector<OwnWeightRun> &runs, const fs::path &out) {
  std::vector<SiloState> states;
  states.reserve(runs.size());
  for (const OwnWeightRun &run : runs)
    states.push_back(silo_state(run.rows, soil_of(run.run), recorded(run.run, "plate_friction", 0.0)));
  std::vector<SiloSoil> soils;
  std::vector<std::string> varied = of_each_sample;
  varied.insert(varied.end(), {"layers", "drag", "prepare_time"}); // the last two follow from the first
  PageTable table = element_run_table(
      "silo_runs",
      "height (m) | height over width (-) | floor force over weight (-) | the same after Janssen (-) | "
      "friction over normal force at the walls (-) | K of the run (-) | mean K (-)");
  for (const SoilGroup &group : soils_of(runs, varied)) {
    double sum = 0.0, count = 0.0;
    for (const std::size_t n : group.runs)
      if (std::isfinite(states[n].coefficient)) {
        sum += states[n].coefficient;
        count += 1.0;
      }
    const double coefficient = count > 0.0 ? sum / count : 0.0;
    soils.push_back({group, coefficient});
    for (const std::size_t n : group.runs) {
      const RestingSoil soil = soil_of(runs[n].run);
      const double friction = recorded(runs[n].run, "plate_friction", 0.0);
      add_element_run(table, runs[n].run,
                      {number_cell(soil.height), number_cell(soil.height / soil.width),
                       number_cell(states[n].floor_share),
                       number_cell(janssen(2 * friction * coefficient * soil.height / soil.width)),
                       number_cell(states[n].friction_ratio), number_cell(states[n].coefficient),
                       number_cell(coefficient)},
                      quality_of(runs[n].rows));
    }
  }
  table.notes = {"Means over the second half of the rows. K: horizontal over vertical stress, from the "
                 "normal force on both walls; the force on the floor is not used. Janssen: the force on the "
                 "floor over the weight is (1 - exp(-x))/x with x = 2 μ K height/width, the mean K of all "
                 "runs of the soil, and the friction μ between balls and walls. It holds if the friction of "
                 "the walls is fully mobilised: friction over normal force is μ then."};
  Page page(out, silo_title, Drawing::silo);
  page.answer("Soil between two rough walls. The floor has moved down by a small part of a ball, so that the "
              "walls carry a part of the weight by friction.");
  answer_quality(page, runs);
  page.section("Stress on the floor");
  page.figure(silo_figure(runs, states, soils));
  page.section("Numbers");
  page.table(table);
  page.write();
}

// ---- Angle of repose

struct Heap {
  std::vector<SurfacePoint> surface;
  Slope slope;
};

Heap read_heap(const OwnWeightRun &test) {
  const Run &run = test.run;
  const Table table = read_element_table(run.folder / "surface.csv");
  const std::vector<double> x = table.numbers("x_m"), height = table.numbers("height_m");
  Heap heap;
  for (std::size_t n = 0; n < x.size(); ++n)
    heap.surface.push_back({x[n], height[n]});
  heap.slope = slope_of(heap.surface, 2 * recorded(run, "radius", 1e-12), test.rows.back().side_force != 0.0);
  return heap;
}

PageFigure repose_figure(const std::vector<OwnWeightRun> &runs, const std::vector<Heap> &heaps) {
  const std::string name = "repose";
  Panel panel{"", "distance from the left wall (m)", "height (m)", {}};
  panel.tight_x = true;
  panel.y_range = "[0:*]";
  CurveTable table("distance (m),height (m)");
  for (std::size_t n = 0; n < runs.size(); ++n) {
    const std::string key = curve_text(runs[n].run.name), line = key + "; line";
    for (const SurfacePoint &point : heaps[n].surface)
      table.row(key, {point.x, point.height});
    panel.curves.push_back(curve(name, key, "$2", "3", line_style(n)));
    const Slope &slope = heaps[n].slope;
    for (const double x : {slope.from, slope.to})
      table.row(line, {x, slope.intercept - x * std::tan(slope.angle / degrees_per_radian)});
    panel.curves.push_back(curve(name, line, "$2", "3", CurveStyle::direct_line));
  }
  return one_panel(
      name, "Surface of the soil at rest, and the least-squares lines whose slope is the angle of repose.",
      panel, table);
}

void write_repose_page(const std::vector<OwnWeightRun> &runs, const std::vector<Heap> &heaps,
                       const fs::path &out) {
  PageTable single = element_run_table(
      "repose_runs", "friction (-) | rolling friction (-) | angle of repose (°) | 95 % interval (°) | force "
                     "on the wall at the end (N) | displacement of the wall (mm)");
  PageTable means(
      "repose_soils", "Means over the seeds",
      "soil | friction (-) | rolling friction (-) | runs | angle of repose (°) | smallest to largest (°)");
  for (const SoilGroup &group : soils_of(runs, of_each_sample)) {
    SeedValues angle;
    for (const std::size_t n : group.runs) {
      const Run &run = runs[n].run;
      const Slope &slope = heaps[n].slope;
      angle.add(run.text("seed"), slope.angle);
      add_element_run(single, run,
                      {run.text("friction"), run.text("rolling"), number_cell(slope.angle),
                       "± " + number_cell(slope.half_width, 2), number_cell(runs[n].rows.back().side_force),
                       number_cell(runs[n].rows.back().displacement)},
                      quality_of(runs[n].rows));
    }
    const Run &run = runs[group.runs.front()].run;
    means.add({group.name, run.text("friction"), run.text("rolling"), std::to_string(group.runs.size()),
               angle.mean_text(), angle.range_text()});
  }
  means.notes = {"Mean and half of its 95 % confidence interval over the seeds. The angle is the slope of a "
                 "least-squares line through the surface, from a diameter of a ball above the floor to 85 % "
                 "of the highest point; through all of it if the soil still touches the wall, as soil "
                 "without friction does on a smooth floor."};
  Page page(out, repose_title, Drawing::repose);
  page.answer("Soil on a rough floor between two smooth walls, of which the right one has moved outward "
              "slowly until the soil stood without it. The slope that is left is half a heap.");
  answer_quality(page, runs);
  page.section("Slope");
  page.figure(repose_figure(runs, heaps));
  page.table(means);
  page.section("Numbers");
  page.table(single);
  page.write();
}

} // namespace

PageWriter read_repose_page(const std::vector<fs::path> &folders) {
  const std::vector<OwnWeightRun> runs = read_element_runs(folders, "repose.csv", read_own_weight);
  std::vector<Heap> heaps;
  heaps.reserve(runs.size());
  for (const OwnWeightRun &run : runs)
    heaps.push_back(read_heap(run));
  return [runs, heaps](const fs::path &out) { write_repose_page(runs, heaps, out); };
}

PageWriter read_silo_page(const std::vector<fs::path> &folders) {
  return [runs = read_element_runs(folders, "silo.csv", read_own_weight)](const fs::path &out) {
    write_silo_page(runs, out);
  };
}

PageWriter read_wall_page(const std::vector<fs::path> &folders) {
  return [runs = read_element_runs(folders, "wall.csv", read_own_weight)](const fs::path &out) {
    write_wall_page(runs, out);
  };
}

} // namespace drumlin::post
