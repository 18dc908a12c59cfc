#include "map/meter_study/results.h"

#include "meter/values.h"
#include "pages/figure_data.h"
#include "pages/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace drumlin::post {

namespace {

/// A meter value as the page shows it.
struct ShownValue {
  const char *name;
  const char *title;
  const char *label; ///< with unit, as gnuplot writes it
  double SoilPoint::*value;
  double scale;        ///< from SI to the label's unit
  double least;        ///< smaller changes are errors of the sampling [unit of the label]
  double share = 0.02; ///< or those of less than this share of the value's range
  bool stiffness = false;
};
constexpr std::array<ShownValue, 9> shown_values = {
    {{"cmv", "CMV", "CMV [-]", &SoilPoint::cmv, 1.0, 0.5},
     {"rmv", "RMV", "RMV [-]", &SoilPoint::rmv, 1.0, 0.5},
     {"k_B", "k_B", "k_B [MN/m]", &SoilPoint::k_B, 1e-6, 0.0, 0.02, true},
     {"k_1", "k_1", "k_1 [MN/m]", &SoilPoint::k_1, 1e-6, 0.0, 0.02, true},
     {"c_1", "c_1", "c_1 [kN s/m]", &SoilPoint::c_1, 1e-3, 0.0},
     {"E_vib", "E_vib", "E_{vib} [MPa]", &SoilPoint::E_vib, 1e-6, 0.0},
     {"energy", "Energy in two cycles", "energy in two cycles [J]", &SoilPoint::energy, 1.0, 0.0, 0.05},
     {"peak_force", "Peak force", "peak force [kN]", &SoilPoint::peak_force, 1e-3, 0.0},
     {"contact_share", "Share of contact", "share of contact [-]", &SoilPoint::contact_share, 1.0, 0.0}}};

/// Marks of the modes in mode_names, which tell them apart in print and without colour vision.
constexpr std::array<CurveStyle, mode_count> mode_styles = {CurveStyle::measured_a, CurveStyle::measured_b,
                                                            CurveStyle::direct_b, CurveStyle::run_differs,
                                                            CurveStyle::direct_a};

constexpr const char *k_range = "[0.9:222]"; // MN/m

using Points = std::vector<SoilPoint>;

/// The rollers that have points.
std::vector<SoilRoller> rollers_of(const Points &points) {
  std::vector<SoilRoller> rollers;
  for (const SoilRoller &roller : soil_rollers)
    if (std::any_of(points.begin(), points.end(),
                    [&](const SoilPoint &point) { return point.roller == roller.name; }))
      rollers.push_back(roller);
  return rollers;
}

/// The points of a roller that have a value.
Points points_of(const Points &all, const std::string &roller, const ShownValue &shown) {
  Points points;
  for (const SoilPoint &point : all)
    if (point.roller == roller && std::isfinite(point.*shown.value)) points.push_back(point);
  return points;
}

/// How a value goes as k grows.
struct Course {
  Points points;
  std::vector<double> values;     ///< in the unit of the label
  std::vector<std::size_t> turns; ///< indices of maxima and minima
  int first = 0;                  ///< 1: begins by rising, -1: by falling, 0: constant
};

Course course_of(const Points &all, const std::string &roller, const ShownValue &shown) {
  Course course;
  course.points = points_of(all, roller, shown);
  for (const SoilPoint &point : course.points)
    course.values.push_back(shown.scale * point.*shown.value);
  const std::vector<double> &values = course.values;
  if (values.empty()) return course;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double least = std::max(shown.least, shown.share * (*high - *low));
  course.turns = turning_points(values, least);
  const double change = values[course.turns.empty() ? values.size() - 1 : course.turns[0]] - values[0];
  course.first = !(std::fabs(change) > least) ? 0 : change > 0.0 ? 1 : -1;
  return course;
}

std::string k_text(const SoilPoint &point) { return fmt::format("{:.3g}", 1e-6 * point.k); }

/// "rises to 53, falls to 103, rises".
std::string words_of(const Course &course) {
  if (course.values.empty()) return no_value;
  if (course.first == 0) return "constant";
  std::string words;
  bool up = course.first > 0;
  for (const std::size_t turn : course.turns) {
    words += fmt::format("{} to {}, ", up ? "rises" : "falls", k_text(course.points[turn]));
    up = !up;
  }
  return words + (up ? "rises" : "falls");
}

/// "continuous contact to 9.3, partial uplift to 65, double jump".
std::string modes_of(const Points &points) {
  std::string words;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i + 1 == points.size())
      words += points[i].mode;
    else if (points[i].mode != points[i + 1].mode)
      words += fmt::format("{} to {}, ", points[i].mode, k_text(points[i]));
  }
  return words;
}

PageTable course_table(const Points &points) {
  PageTable table("courses", "Where the values rise and fall with growing k (MN/m)", "roller | modes",
                  shown_values.size() + 2);
  for (const ShownValue &shown : shown_values)
    table.header.emplace_back(shown.title);
  for (const SoilRoller &roller : rollers_of(points)) {
    std::vector<std::string> row = {roller.title, modes_of(points_of(points, roller.name, shown_values[0]))};
    for (const ShownValue &shown : shown_values)
      row.push_back(words_of(course_of(points, roller.name, shown)));
    table.add(std::move(row));
  }
  table.notes = {"Changes of less than 2 % of the value's range do not count, of the energy 5 %, since its "
                 "sum over samples may be off by that where the drum lands, nor those of CMV and RMV of less "
                 "than 0.5. Modes end at the last k that was computed with them.",
                 "E_vib needs radius and width of the drum, which are published for one roller only."};
  return table;
}

/// Curves of one roller: the course, its falls, and a mark for each point by its mode.
Panel value_panel(const ShownValue &shown, const SoilRoller &roller, const Course &course,
                  CurveTable &table) {
  Panel panel{roller.title, "k [MN/m]", shown.label, {}};
  panel.log_x = true;
  panel.x_range = k_range;
  if (*std::max_element(course.values.begin(), course.values.end()) < shown.least)
    panel.y_range = "[-0.1:1]"; // zero, but for rounding
  const auto add = [&](const std::string &name, const char *title, CurveStyle style) {
    panel.add(curve(shown.name, name, "$2", "3", style), title);
  };
  const std::size_t count = course.values.size();
  const auto row = [&](const std::string &name, std::size_t i) {
    table.row(name, {1e-6 * course.points[i].k, course.values[i]});
  };
  if (shown.stiffness) {
    const std::string truth = fmt::format("{} k", roller.name);
    const double most = *std::max_element(course.values.begin(), course.values.end());
    for (const SoilPoint &point : course.points)
      if (1e-6 * point.k < 1.1 * most) table.row(truth, {1e-6 * point.k, 1e-6 * point.k});
    add(truth, "k", CurveStyle::limit);
  }
  const std::string all = fmt::format("{} course", roller.name);
  for (std::size_t i = 0; i < count; ++i)
    row(all, i);
  add(all, "", CurveStyle::direct_line);
  std::vector<std::size_t> ends = course.turns;
  ends.insert(ends.begin(), 0);
  ends.push_back(count - 1);
  bool titled = false;
  for (std::size_t i = 0; course.first != 0 && !course.turns.empty() && i + 1 < ends.size(); ++i) {
    if ((i % 2 == 0) == (course.first > 0)) continue;
    const std::string name = fmt::format("{} falls {}", roller.name, i);
    for (std::size_t j = ends[i]; j <= ends[i + 1]; ++j)
      row(name, j);
    add(name, titled ? "" : "falls", CurveStyle::plain);
    titled = true;
  }
  for (std::size_t mode = 0; mode < mode_count; ++mode) {
    const std::string name = fmt::format("{} {}", roller.name, mode_names[mode]);
    bool seen = false;
    for (std::size_t i = 0; i < count; ++i)
      if (course.points[i].mode == mode_names[mode]) {
        row(name, i);
        seen = true;
      }
    if (seen) add(name, mode_names[mode], mode_styles[mode]);
  }
  return panel;
}

PageFigure value_figure(const Points &points, const ShownValue &shown, int number) {
  PageFigure figure = page_figure(
      fmt::format("Fig. {}", number),
      fmt::format("{} over the stiffness k of the soil, condition B, D = 0.5. Marks are operating modes; a "
                  "solid line is where a value that also rises falls with growing k.{}",
                  shown.title, shown.stiffness ? " The dash-dotted line is k itself." : ""),
      {shown.name, fmt::format("{} over the stiffness of the soil", shown.title), {}, 3});
  std::string header = shown.label;
  header.erase(std::remove_if(header.begin(), header.end(), [](char c) { return c == '{' || c == '}'; }),
               header.end());
  CurveTable table("k [MN/m]," + header);
  for (const SoilRoller &roller : rollers_of(points)) {
    const Course course = course_of(points, roller.name, shown);
    if (!course.values.empty()) figure.figure.panels.push_back(value_panel(shown, roller, course, table));
  }
  figure.csv = table.text();
  return figure;
}

/// What identification finds in the records of a roller.
struct Found {
  std::size_t records = 0, exact = 0, measured = 0, inside = 0;
  double exact_error = 0.0, measured_error = 0.0; // largest |k found / k - 1|
  void add(const SoilPoint &point) {
    ++records;
    if (std::isfinite(point.exact.k)) {
      ++exact;
      exact_error = std::max(exact_error, std::fabs(point.exact.k / point.k - 1.0));
    }
    if (std::isfinite(point.measured.k)) {
      ++measured;
      measured_error = std::max(measured_error, std::fabs(point.measured.k / point.k - 1.0));
      if (std::fabs(point.measured.k - point.k) <= point.measured.half_width) ++inside;
    }
  }
};

Found found_in(const Points &points, const std::string &roller = {}) {
  Found found;
  for (const SoilPoint &point : points)
    if (roller.empty() || point.roller == roller) found.add(point);
  return found;
}

PageTable found_table(const Points &points) {
  PageTable table("identified_k", "What identify finds from the same records",
                  "roller | records | exact: no identification | largest error of k (-) | noisy "
                  "accelerations: no identification | largest error of k (-) | k in its 95 % interval");
  for (const SoilRoller &roller : rollers_of(points)) {
    const Found found = found_in(points, roller.name);
    table.add({roller.title, std::to_string(found.records), std::to_string(found.records - found.exact),
               fmt::format("{:.1e}", found.exact_error), std::to_string(found.records - found.measured),
               fmt::format("{:.1e}", found.measured_error),
               fmt::format("{} of {}", found.inside, found.measured)});
  }
  table.notes = {"Every fourth sample of the records, 250 per cycle. Exact: positions, velocities and "
                 "accelerations without noise. Noisy accelerations, as a real roller has them: those of drum "
                 "and frame alone, with white noise of 1 % of their standard deviation; the phase of the "
                 "exciter is off by 0.5 degrees and known within 1 degree."};
  return table;
}

PageFigure found_figure(const Points &points, int number) {
  const std::string name = "identified";
  PageFigure figure = page_figure(fmt::format("Fig. {}", number),
                                  "k that identify finds over the true k, from the records of the figures "
                                  "above, with 95 % confidence intervals. Crosses: no identification.",
                                  {name, "k identified over true k", {}, 3}, 0.9);
  figure.key_panel = 4;
  CurveTable table("k [MN/m],found over true [-],lower end [-],upper end [-]");
  for (const SoilRoller &roller : rollers_of(points)) {
    Panel panel{roller.title, "k [MN/m]", "k identified / k [-]", {}};
    panel.log_x = true;
    panel.x_range = k_range;
    panel.y_range = "[0.7:1.3]";
    const std::string measured = fmt::format("{} noisy accelerations", roller.name);
    const std::string exact = fmt::format("{} exact record", roller.name);
    const std::string none = fmt::format("{} no identification", roller.name);
    bool missing = false;
    const auto rows = [&](const std::string &curve, FoundStiffness SoilPoint::*part) {
      for (const SoilPoint &point : points) {
        if (point.roller != roller.name) continue;
        const double k = 1e-6 * point.k;
        const FoundStiffness &found = point.*part;
        if (std::isfinite(found.k))
          table.row(curve, {k, found.k / point.k, (found.k - found.half_width) / point.k,
                            (found.k + found.half_width) / point.k});
        else
          table.row(none, {k, 1.0});
        missing = missing || !std::isfinite(found.k);
      }
    };
    rows(measured, &SoilPoint::measured);
    rows(exact, &SoilPoint::exact);
    const auto add = [&](const std::string &curve_name, const char *title, const char *y, CurveStyle style) {
      panel.add(curve(name, curve_name, "$2", y, style), title);
    };
    add(measured, "noisy accelerations", "3:4:5", CurveStyle::spread);
    add(exact, "exact record", "3", CurveStyle::condition_a);
    if (missing) add(none, "no identification", "3", CurveStyle::run_differs);
    figure.figure.panels.push_back(panel);
  }
  figure.csv = table.text();
  return figure;
}

/// The roller whose CMV falls farthest, and from which to which k; none if none falls.
struct Fall {
  const char *roller = "";
  double high = 0.0, low = 0.0; // CMV
  double from = 0.0, to = 0.0;  // k of these [N/m]
  double same = 0.0;            // smaller k with the lower CMV [N/m]
};

std::optional<Fall> deepest_fall(const Points &points) {
  std::optional<Fall> deepest;
  for (const SoilRoller &roller : rollers_of(points)) {
    const Course course = course_of(points, roller.name, shown_values[0]);
    for (std::size_t i = 0; i < course.turns.size(); ++i) {
      const std::size_t high = course.turns[i];
      const std::size_t low = i + 1 < course.turns.size() ? course.turns[i + 1] : course.values.size() - 1;
      const double depth = course.values[high] - course.values[low];
      if (depth <= (deepest ? deepest->high - deepest->low : 0.0)) continue;
      Fall fall = {roller.title, course.values[high], course.values[low], course.points[high].k,
                   course.points[low].k};
      std::size_t same = 0;
      while (course.values[same] < fall.low)
        ++same;
      fall.same = course.points[same].k;
      deepest = fall;
    }
  }
  return deepest;
}

void answer(Page &page, const Points &points) {
  page.answer("Records of rollers on a spring and a dashpot of known stiffness k, computed in closed form: "
              "what a compaction meter makes of them, and what identification finds.");
  std::size_t falling = 0;
  const std::vector<SoilRoller> rollers = rollers_of(points);
  for (const SoilRoller &roller : rollers)
    falling += course_of(points, roller.name, shown_values[0]).turns.empty() ? 0 : 1;
  page.answer(fmt::format("With growing k the motion goes from continuous contact to partial uplift, where "
                          "CMV begins to grow, and for {} of {} rollers to double jump or beyond, where CMV "
                          "falls and rises again, so that one CMV belongs to several k.",
                          falling, rollers.size()));
  if (const std::optional<Fall> fall = deepest_fall(points))
    page.answer(fmt::format("The deepest fall is that of {}, from {:.0f} at {:.3g} MN/m to {:.0f} at {:.3g} "
                            "MN/m, a value that it also has near {:.2g} MN/m.",
                            fall->roller, fall->high, 1e-6 * fall->from, fall->low, 1e-6 * fall->to,
                            1e-6 * fall->same));
  const Found all = found_in(points);
  constexpr double long_contact = 0.8; // share of time: shorter flights hardly tell the phase
  Points held;
  Points nearly;
  Points lost;
  for (const SoilPoint &point : points) {
    const bool longer = point.contact_share > long_contact;
    (point.mode == mode_names[0] ? held : longer ? nearly : lost).push_back(point);
  }
  std::string limits;
  const auto add = [&limits](const Points &some, const std::string &where) {
    if (some.empty()) return;
    const double error = 100.0 * found_in(some).measured_error;
    limits += fmt::format("{}within {:.2g} % {}", limits.empty() ? "" : ", ", error, where);
  };
  add(lost, fmt::format(
                "where the contact lasts for less than {:g} % of the time, since the flights tell the phase",
                100.0 * long_contact));
  add(nearly, "where it lasts longer");
  add(held, "in continuous contact");
  page.answer(
      fmt::format("Identification finds k in {} of {} exact records, with errors of at most {:.1e}. Noisy "
                  "accelerations alone, with the phase of the exciter within 1 degree, give k {}. In "
                  "continuous contact an error of the phase acts on the force as the stiffness does; this "
                  "limit is worst on soft soil, where the force on the drum is mostly its inertia.",
                  all.exact, all.records, all.exact_error, limits));
}

} // namespace

void write_soil_page(const std::filesystem::path &out, const std::vector<SoilPoint> &points) {
  Page page(out, "What the meter says of the soil", Drawing::chain);
  answer(page, points);
  page.section("Where a value may mean several stiffnesses");
  page.paragraph(
      "k_B, k_1 and c_1 are stiffness and damping at the excitation frequency, and are the soil's in "
      "continuous contact only; k_B also contains the force of the frame on the drum. In other modes they "
      "are apparent values. The tools' README has the formula and the source of each value.");
  page.table(course_table(points));
  page.section("Meter values over the stiffness of the soil");
  int number = 0;
  for (const ShownValue &shown : shown_values) {
    PageFigure figure = value_figure(points, shown, ++number);
    if (number == 1) {
      figure.weight = 1.0;
      figure.key_panel = 4;
    }
    page.figure(figure);
  }
  page.section("What identification finds");
  page.table(found_table(points));
  page.figure(found_figure(points, ++number));
  page.write();
}

} // namespace drumlin::post
