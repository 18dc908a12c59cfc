#include "lab/benchmarks/page.h"

#include "engine/deck_run.h"
#include "experiment/study.h"
#include "lab/benchmarks/checks.h"
#include "lab/benchmarks/runs.h"
#include "pages/figure_data.h"
#include "pages/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

namespace {

/// Largest difference between the engines, relative to the scale of the quantity.
constexpr double between_engines = 1e-9;

/// What a test is, in words.
const std::vector<std::pair<std::string, std::string>> titles = {
    {"chung_ooi_1", "Chung and Ooi 1: two spheres, head on, elastic"},
    {"chung_ooi_2", "Chung and Ooi 2: sphere on a rigid plane, elastic"},
    {"chung_ooi_3", "Chung and Ooi 3: restitution on a rigid plane"},
    {"chung_ooi_4", "Chung and Ooi 4: oblique impact over the angle"},
    {"chung_ooi_5", "Chung and Ooi 5: oblique impact over the tangential velocity"},
    {"chung_ooi_6", "Chung and Ooi 6: spinning sphere on a rigid plane"},
    {"chung_ooi_7", "Chung and Ooi 7: two spheres with opposite spins"},
    {"chung_ooi_8", "Chung and Ooi 8: spinning sphere on a larger one"},
    {"restitution", "LAMMPS: restitution of two spheres"},
    {"oblique_pair", "LAMMPS: oblique impact of two spheres"},
    {"slip", "LAMMPS: sliding, then rolling"},
    {"rolling_decay", "LAMMPS: spin against rolling resistance"},
    {"incline", "LAMMPS: rolling down an incline against rolling resistance"},
    {"pure_rolling", "LAMMPS: rolling without resistance"},
    {"stack", "LAMMPS: energy of two spheres between walls"},
    {"rest", "LAMMPS: two spheres come to rest on each other"}};

std::string title_of(const std::string &test) {
  for (const auto &[name, title] : titles)
    if (name == test) return title;
  return test;
}

/// A check of a point in both engines.
struct Row {
  std::string test, material;
  double at;
  BenchmarkCheck liggghts;
  std::optional<BenchmarkCheck> lammps;

  double error() const { return std::max(liggghts.error(), lammps ? lammps->error() : 0.0); }
  double difference() const {
    return lammps ? std::fabs(lammps->computed - liggghts.computed) / liggghts.scale : 0.0;
  }
  /// False for numbers that are not finite, too.
  bool holds() const { return error() <= liggghts.tolerance && difference() <= between_engines; }
};

std::vector<Row> rows_of(const std::vector<BenchmarkRun> &runs) {
  std::vector<Row> rows;
  for (const BenchmarkRun &run : runs) {
    if (run.engine != "liggghts") continue;
    const std::vector<BenchmarkCheck> checks = benchmark_checks(run);
    std::vector<BenchmarkCheck> others;
    for (const BenchmarkRun &other : runs)
      if (other.engine == "lammps" && other.test == run.test && other.material == run.material &&
          other.at == run.at)
        others = benchmark_checks(other);
    for (std::size_t i = 0; i < checks.size(); ++i)
      rows.push_back({run.test, run.material, run.at, checks[i],
                      i < others.size() ? std::optional(others[i]) : std::nullopt});
  }
  return rows;
}

PageTable summary_table(const std::vector<Row> &rows) {
  PageTable table("summary", "Largest error of each quantity",
                  "test | quantity | compared with | points | largest relative error, LIGGGHTS | largest "
                  "relative error, LAMMPS | tolerance | LAMMPS - LIGGGHTS",
                  3);
  table.criterion = "quantities are within the tolerance, and equal in both engines to 1e-9";
  for (const auto &[name, title] : titles) {
    std::vector<std::pair<std::string, std::string>> seen;
    for (const Row &first : rows) {
      const std::pair key{first.liggghts.quantity, first.liggghts.oracle};
      if (first.test != name || std::find(seen.begin(), seen.end(), key) != seen.end()) continue;
      seen.push_back(key);
      int points = 0;
      bool holds = true, lammps = false;
      double here = 0.0, there = 0.0, apart = 0.0;
      for (const Row &row : rows) {
        if (row.test != name || row.liggghts.quantity != key.first || row.liggghts.oracle != key.second)
          continue;
        ++points;
        holds = holds && row.holds();
        here = std::max(here, row.liggghts.error());
        apart = std::max(apart, row.difference());
        if (row.lammps) lammps = true, there = std::max(there, row.lammps->error());
      }
      table.add({title, key.first, key.second, std::to_string(points), fmt::format("{:.1e}", here),
                 lammps ? fmt::format("{:.1e}", there) : no_value,
                 fmt::format("{:.0e}", first.liggghts.tolerance),
                 lammps ? fmt::format("{:.1e}", apart) : no_value},
                holds ? RowState::agrees : RowState::differs);
    }
  }
  table.notes = {
      "Errors are relative to the expected value, or to what the impact, friction or gravity changes in it.",
      "The tests of LAMMPS's unittest/granular allow 2e-2 in general."};
  return table;
}

PageTable value_table(const std::vector<Row> &rows) {
  PageTable table(
      "values", "All points",
      "test | material | at | quantity | compared with | expected | LIGGGHTS | LAMMPS | relative error", 5);
  table.criterion = "values are within the tolerance";
  for (const Row &row : rows)
    table.add({row.test, row.material, fmt::format("{:g}", row.at), row.liggghts.quantity,
               row.liggghts.oracle, fmt::format("{:.7g}", row.liggghts.expected),
               fmt::format("{:.7g}", row.liggghts.computed),
               row.lammps ? fmt::format("{:.7g}", row.lammps->computed) : no_value,
               fmt::format("{:.1e}", row.error())},
              row.holds() ? RowState::agrees : RowState::differs);
  table.notes = {"At: the value of the variable that is varied, in the unit of the deck's variable "
                 "(inputs/benchmarks)."};
  return table;
}

std::vector<Acceptance> criteria_of(const std::vector<Row> &rows) {
  std::vector<Acceptance> criteria;
  for (const auto &[name, title] : titles) {
    double share = 0.0;
    bool holds = true, any = false;
    for (const Row &row : rows)
      if (row.test == name) {
        any = true;
        holds = holds && row.holds();
        share = std::max(share, row.error() / row.liggghts.tolerance);
      }
    if (any)
      criteria.push_back(
          {title + ": every quantity within its tolerance", fmt::format("{:.2f} of it", share), holds});
  }
  return criteria;
}

std::string in_words(std::string material) {
  std::replace(material.begin(), material.end(), '_', ' ');
  return material;
}

/// A point of a published figure.
struct Published {
  std::string test, material, source, quantity;
  double at, value;
};

std::vector<Published> published_points() {
  static const CsvSchema<Published> schema(
      {csv_column("test", &Published::test), csv_column("material", &Published::material),
       csv_column("source", &Published::source), csv_column("quantity", &Published::quantity),
       csv_column("at", &Published::at), csv_column("value", &Published::value)});
  return schema.rows(read_table(input_file("benchmarks/published.csv")));
}

/// A quantity of the reference solution, by the beginning of its name.
double reference_value(BenchmarkRun run, const std::string &quantity) {
  const AfterImpact after = integrated_impact(run.setup);
  run.end.vx = after.vx, run.end.vz = after.vz, run.end.spin = after.spin;
  run.end.vx2 = after.vx2, run.end.vz2 = after.vz2, run.end.spin2 = after.spin2;
  for (const BenchmarkCheck &check : benchmark_checks(run))
    if (check.quantity.rfind(quantity, 0) == 0) return check.expected;
  throw std::logic_error("no quantity " + quantity);
}

/// The same impact at the abscissa of a published point.
SphereSetup at_abscissa(SphereSetup s, const std::string &test, double at) {
  if (test == "chung_ooi_4") {
    const double speed = std::hypot(s.vn, s.vt);
    s.vn = speed * std::cos(at * M_PI / 180.0), s.vt = speed * std::sin(at * M_PI / 180.0);
  } else if (test == "chung_ooi_5") {
    s.vt = at * s.mu * s.vn;
  } else {
    s.spin = at * s.vn / s.r1;
  }
  return s;
}

/// How far the reference solution is from the published points.
PageTable published_table(const std::vector<BenchmarkRun> &runs) {
  PageTable table("published", "Difference of the reference solution from published points",
                  "test | material | published by | quantity | points | largest of them | mean difference | "
                  "largest difference while sliding",
                  4);
  const std::vector<Published> points = published_points();
  for (std::size_t first = 0; first < points.size();) {
    const Published &group = points[first];
    const auto run = std::find_if(runs.begin(), runs.end(), [&](const BenchmarkRun &one) {
      return one.test == group.test && one.material == group.material;
    });
    int count = 0;
    double sum = 0.0, largest = 0.0, sliding = 0.0;
    for (; first < points.size() && points[first].test == group.test &&
           points[first].source == group.source && points[first].quantity == group.quantity;
         ++first, ++count) {
      if (run == runs.end()) continue;
      BenchmarkRun there = *run;
      there.setup = at_abscissa(run->setup, group.test, points[first].at);
      const double difference = std::fabs(reference_value(there, group.quantity) - points[first].value);
      sum += difference;
      largest = std::max(largest, std::fabs(points[first].value));
      if (slides_throughout(there.setup)) sliding = std::max(sliding, difference);
    }
    if (run == runs.end()) continue;
    table.add({title_of(group.test), in_words(group.material), group.source, group.quantity,
               std::to_string(count), fmt::format("{:.3g}", largest), fmt::format("{:.2g}", sum / count),
               fmt::format("{:.2g}", sliding)});
  }
  table.notes = {"In the units of the figures. Where the surfaces slide, the difference is the error of "
                 "reading a printed figure."};
  return table;
}

/// A panel of a quantity of a test over a variable.
struct PanelPlan {
  std::string title, x_label, y_label, test;
  std::vector<std::string> materials;
  std::string quantity;     ///< of the checks
  std::string of_published; ///< its name in published.csv; empty: none
  double x_scale;           ///< from `at` to the abscissa
  std::string x_range, y_range;
};

Panel panel_of(const PanelPlan &plan, const std::vector<Row> &rows, const std::string &figure,
               CurveTable &table) {
  Panel panel{plan.title, plan.x_label, plan.y_label, {}};
  const auto add = [&](const std::string &name, const std::string &legend, CurveStyle style) {
    panel.add(curve(figure, name, "$2", "3", style), legend);
  };
  constexpr CurveStyle lines[] = {CurveStyle::condition_b, CurveStyle::condition_a};
  constexpr CurveStyle marks[] = {CurveStyle::measured_b, CurveStyle::measured_a};
  for (std::size_t m = 0; m < plan.materials.size(); ++m) {
    const std::string &material = plan.materials[m];
    const std::string name = fmt::format("{} {} {}", plan.test, plan.y_label, in_words(material));
    for (const bool computed : {false, true}) // one after the other: a line ends at a row of another curve
      for (const Row &row : rows)
        if (row.test == plan.test && row.material == material && row.liggghts.quantity == plan.quantity)
          table.row(computed ? name : name + " reference",
                    {plan.x_scale * row.at, computed ? row.liggghts.computed : row.liggghts.expected});
    add(name + " reference", in_words(material) + ", reference solution", lines[m]);
    add(name, in_words(material) + ", LIGGGHTS", marks[m]);
  }
  for (const auto &[source, style] :
       {std::pair{"discrete elements", CurveStyle::direct_a}, {"finite elements", CurveStyle::direct_b}}) {
    const std::string name = fmt::format("{} {} {}", plan.test, plan.y_label, source);
    bool any = false;
    for (const Published &point : published_points())
      if (point.test == plan.test && point.quantity == plan.of_published && point.source == source) {
        table.row(name, {point.at, point.value});
        any = true;
      }
    if (any) add(name, fmt::format("published, {}, {}", in_words(plan.materials.front()), source), style);
  }
  panel.x_range = plan.x_range, panel.y_range = plan.y_range;
  return panel;
}

PageFigure figure_of(const std::string &name, const std::string &title, const std::string &caption,
                     const std::vector<PanelPlan> &plans, const std::vector<Row> &rows) {
  PageFigure figure;
  figure.caption = caption;
  figure.figure = {name, title, {}, 2};
  CurveTable table("abscissa,ordinate");
  for (const PanelPlan &plan : plans)
    figure.figure.panels.push_back(panel_of(plan, rows, name, table));
  figure.csv = table.text();
  return figure;
}

const std::string published_note =
    " Published points are digitised from the paper's figures. Those of discrete elements belong to other "
    "tangential laws, on which the result depends while the surfaces stick.";

PageFigure angle_figure(const std::vector<Row> &rows) {
  const std::vector<std::string> oxides = {"aluminium_oxide", "aluminium_alloy"};
  const std::string x = "angle of impact (degrees)";
  PageFigure figure = figure_of(
      "oblique", "Oblique impact on a rigid plane at 3.9 m/s",
      "Chung and Ooi, test 4. From about 33 degrees on the surfaces slide during the whole impact." +
          published_note,
      {{"Tangential restitution", x, "vx'/vx (-)", "chung_ooi_4", oxides, "tangential restitution vx'/vx (-)",
        "tangential restitution", 1.0, "[0:90]", ""},
       {"Rebound angle of the surface", x, "atan((vx' - r w')/vn') (degrees)", "chung_ooi_4", oxides,
        "rebound angle of the surface (degrees)", "rebound angle", 1.0, "[0:90]", ""},
       {"Spin", x, "spin after (rad/s)", "chung_ooi_4", oxides, "spin after (rad/s)", "spin", 1.0, "[0:90]",
        ""},
       {"Energy", x, "kinetic energy after over before (-)", "chung_ooi_4", oxides,
        "kinetic energy after over before (-)", "", 1.0, "[0:90]", ""}},
      rows);
  figure.label = "Fig. 1";
  figure.weight = 1.0;
  return figure;
}

PageFigure spin_figure(const std::vector<Row> &rows) {
  const std::vector<std::string> plastics = {"steel", "polyethylene"}, nylon = {"aluminium_alloy", "nylon"};
  constexpr double mu_vn = 0.3 * 5.0, r_over_vn = 0.1 / 0.2; // of tests 5; 6 and 8
  PageFigure figure = figure_of("spins", "Tests 5, 6 and 8",
                                "Chung and Ooi, test 5: oblique impact at a normal velocity of 5 m/s. Tests "
                                "6 and 8: a spinning sphere strikes a plane, or a larger sphere. Slip: "
                                "velocity of the surfaces across the normal, before and after." +
                                    published_note,
                                {{"Test 5", "vt/(mu vn) (-)", "slip'/(mu vn') (-)", "chung_ooi_5", plastics,
                                  "recoil slip'/(mu vn') (-)", "recoil", 1.0 / mu_vn, "[0:14]", ""},
                                 {"Test 5", "vt/(mu vn) (-)", "r w'/(mu vn) (-)", "chung_ooi_5", plastics,
                                  "spin r w'/(mu vn) (-)", "spin", 1.0 / mu_vn, "[0:14]", ""},
                                 {"Test 6", "r w/vn (-)", "slip'/vn' (-)", "chung_ooi_6", nylon,
                                  "recoil slip'/vn' (-)", "recoil", r_over_vn, "[0:6.5]", "[-2:10]"},
                                 {"Test 8", "r w/vn (-)", "slip'/vn' (-)", "chung_ooi_8", nylon,
                                  "recoil slip'/vn' (-)", "recoil", r_over_vn, "[0:6.5]", "[-2:10]"}},
                                rows);
  figure.label = "Fig. 2";
  figure.weight = 0.5;
  return figure;
}

const char *const sources =
    "Chung and Ooi (2011), Granular Matter 13, 643-656, doi 10.1007/s10035-011-0277-0. The paper itself was "
    "not at hand: parameters are those of the validation scripts of Yade (tests 1 to 4), PySPH (5, 7, which "
    "it numbers 6, and 8) and Kratos (4 to 8), which agree but for Young's modulus of aluminium alloy in "
    "test 7 (PySPH has ten times that of Kratos; the result does not depend on it). The published points are "
    "those in the tests of Kratos. Not confirmed: what its case B of test 8 is (here, as in case A, the "
    "large sphere has 1000 times Young's modulus of the small one), nylon and copper, which only PySPH has, "
    "and the tangential dashpot (here half of the normal one, the default of the law).";

const char *const lammps_sources =
    "The analytic cases of LAMMPS, unittest/granular, after Mohajeri et al. (2024), Powder Technology 447, "
    "120136. Parameters of slip and stack are those of LAMMPS; the others are this project's. Left out: "
    "twisting resistance and cohesion, which the plugin's laws do not have, and heat and drag. Rolling "
    "resistance (epsd2) needs the linear law, which the cases without impact use throughout; its spring has "
    "no dashpot.";

} // namespace

void write_benchmarks_page(const std::filesystem::path &out) {
  std::vector<BenchmarkRun> runs = read_points(out / "runs.csv", benchmark_runs());
  std::stable_sort(runs.begin(), runs.end(),
                   [](const BenchmarkRun &a, const BenchmarkRun &b) { return a.at < b.at; });
  const std::vector<Row> rows = rows_of(runs);
  Page page(out, "Benchmarks", Drawing::sphere);
  page.answer("Tests that others have published for programs of this kind: impacts of one or two spheres, "
              "sliding and rolling. Each is run by LIGGGHTS and, if it is set up, LAMMPS, with tangential "
              "coulomb, transition B and second stepping.");
  page.answer(criteria_of(rows));
  double energy = 0.0;
  for (const Row &row : rows)
    if (row.liggghts.quantity.rfind("kinetic energy", 0) == 0)
      energy = std::max(energy, row.liggghts.computed);
  page.answer(fmt::format("No impact ends with more kinetic energy than it began with: at most {:.6f} of it.",
                          energy));
  page.section("Acceptance criteria");
  page.table(acceptance_table(criteria_of(rows)));
  page.section("Oblique impacts");
  page.figure(angle_figure(rows));
  page.figure(spin_figure(rows));
  page.table(published_table(runs));
  page.section("Errors");
  page.table(summary_table(rows));
  page.paragraph(
      "The reference solution integrates the equations of motion of one impact with the same law, "
      "independently of the plugin, in steps of 5e-6 of its duration. It leaves out that the normal rotates "
      "during an impact of two spheres. Closed forms of sliding hold for impulses; the lever arm of friction "
      "is the radius less half of the overlap, for which the mean of an elastic impact is used.");
  page.section("Where the tests come from");
  page.paragraph(sources);
  page.paragraph(lammps_sources);
  page.section("All points");
  page.table(value_table(rows));
  page.write();
}

} // namespace drumlin::post
