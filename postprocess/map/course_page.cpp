#include "map/figures.h"
#include "map/course.h"
#include "pages/figure.h"
#include "pages/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace drumlin::post {

namespace {

/// Marks of the regimes in regime_names, which tell them apart in print and without colour vision.
constexpr std::array<CurveStyle, regime_count> regime_styles = {
    CurveStyle::measured_a,  CurveStyle::measured_b, CurveStyle::direct_b,
    CurveStyle::run_differs, CurveStyle::direct_a,   CurveStyle::mark_2};

using Points = std::vector<CoursePoint>;

const char *regime_of(const CoursePoint &point) {
  return regime_names[static_cast<std::size_t>(point.motion.regime)];
}

Points points_of(const Points &all, const std::string &roller) {
  Points points;
  for (const CoursePoint &point : all)
    if (point.roller == roller) points.push_back(point);
  return points;
}

std::string number_in(const ShownAxis &axis, double value) {
  return fmt::format("{:.3g}", axis.scale * value);
}

/// The unit of an axis as it is shown.
std::string unit_of(const ShownAxis &axis) {
  const std::size_t open = axis.label.find('[');
  return axis.label.substr(open + 1, axis.label.size() - open - 2);
}

/// So many changes are told one by one.
constexpr std::ptrdiff_t most_changes = 5;

/// "rises to 53, falls to 103, rises".
std::string words_of(const Course &course, const ShownAxis &axis) {
  if (course.values.empty()) return no_value;
  if (course.first == 0) return "constant";
  std::string words;
  bool up = course.first > 0;
  for (const std::size_t turn : course.turns) {
    if (&turn - course.turns.data() == most_changes)
      return words + fmt::format("and turns {} times more", course.turns.size() - most_changes);
    words += fmt::format("{} to {}, ", up ? "rises" : "falls", number_in(axis, course.points[turn].value));
    up = !up;
  }
  return words + (up ? "rises" : "falls");
}

/// "continuous contact to 9.3, partial uplift to 65, period 2".
std::string regimes_of(const Points &points, const ShownAxis &axis) {
  std::vector<std::size_t> changes;
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    if (points[i].motion.regime != points[i + 1].motion.regime) changes.push_back(i);
  std::string words;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (i == most_changes) return words + fmt::format("and {} changes more", changes.size() - most_changes);
    words +=
        fmt::format("{} to {}, ", regime_of(points[changes[i]]), number_in(axis, points[changes[i]].value));
  }
  return words + regime_of(points.back());
}

/// A column for each value, a row for each roller.
PageTable course_table(const std::vector<CourseRoller> &rollers, const MapAxis &axis, const Points &points) {
  const ShownAxis shown = shown_axis(axis);
  PageTable table("courses", fmt::format("Where the values rise and fall with growing {}", shown.label),
                  "roller | regimes", course_values.size() + 2);
  for (const CourseValue &value : course_values)
    table.header.emplace_back(value.title);
  for (const CourseRoller &roller : rollers) {
    const Points own = points_of(points, roller.name);
    std::vector<std::string> row = {roller.title, regimes_of(own, shown)};
    for (const CourseValue &value : course_values)
      row.push_back(words_of(course_of(own, value), shown));
    table.add(std::move(row));
  }
  table.notes = {
      "Changes of less than 2 % of the value's range do not count, nor those of CMV, RMV and CCV of "
      "less than 0.5. A regime ends at the last point that was computed with it.",
      "E_vib needs radius and width of the drum."};
  return table;
}

/// A curve's name in the data of its figure.
struct CurveNames {
  std::string figure; ///< whose data has the curve
  std::string prefix; ///< what tells its panel from others of the figure
};

/// Curves of one roller: the course, where a value is met several times, and a mark for each point by its
/// regime.
Panel value_panel(const CourseValue &shown, const std::string &title, const MapAxis &axis,
                  const Course &course, const CurveNames &names, bool legend, CurveTable &table) {
  const ShownAxis across = shown_axis(axis);
  Panel panel{title, across.label, shown.label, {}};
  panel.log_x = axis.log;
  panel.x_range = axis_range(across.scale * axis.from, across.scale * axis.to);
  if (*std::max_element(course.values.begin(), course.values.end()) < shown.least)
    panel.y_range = "[-0.1:1]"; // zero, but for rounding
  const auto add = [&](const std::string &name, const char *text, CurveStyle style) {
    panel.add(curve(names.figure, name, "$2", "3", style), legend ? text : "");
  };
  const std::size_t count = course.values.size();
  const auto row = [&](const std::string &name, std::size_t i) {
    table.row(name, {across.scale * course.points[i].value, course.values[i]});
  };
  if (shown.stiffness) {
    const std::string truth = names.prefix + " k";
    const double most = *std::max_element(course.values.begin(), course.values.end());
    for (const CoursePoint &point : course.points)
      if (1e-6 * point.k < 1.1 * most) table.row(truth, {across.scale * point.value, 1e-6 * point.k});
    add(truth, "k", CurveStyle::limit);
  }
  const std::string all = names.prefix + " course";
  for (std::size_t i = 0; i < count; ++i)
    row(all, i);
  add(all, "", CurveStyle::direct_line);
  int runs = 0; // of neighbours whose values are met several times, each a curve
  for (std::size_t i = 0; i < count; ++i) {
    if (course.same[i] < 2) continue;
    if (i == 0 || course.same[i - 1] < 2) {
      ++runs;
      add(fmt::format("{} several {}", names.prefix, runs), runs == 1 ? "several with this value" : "",
          CurveStyle::plain);
    }
    row(fmt::format("{} several {}", names.prefix, runs), i);
  }
  for (std::size_t regime = 0; regime < regime_count; ++regime) {
    const std::string name = fmt::format("{} {}", names.prefix, regime_names[regime]);
    bool seen = false;
    constexpr std::size_t most_marks = 50; // more hide the line
    for (std::size_t i = 0; i < count; i += count / most_marks + 1)
      if (static_cast<std::size_t>(course.points[i].motion.regime) == regime) {
        row(name, i);
        seen = true;
      }
    if (seen) add(name, regime_names[regime], regime_styles[regime]);
  }
  return panel;
}

/// The label of a value as text.
std::string plain_label(const CourseValue &value) {
  std::string label = value.label;
  label.erase(std::remove_if(label.begin(), label.end(), [](char c) { return c == '{' || c == '}'; }),
              label.end());
  return label;
}

/// A panel for each roller.
PageFigure value_figure(const std::vector<CourseRoller> &rollers, const MapAxis &axis, const Points &points,
                        const CourseValue &shown, int number) {
  PageFigure figure = page_figure(
      fmt::format("Fig. {}", number),
      fmt::format("{} over the stiffness k of the soil, condition B, D = 0.5. Marks are regimes; a "
                  "solid line is where several k have the same value.{}",
                  shown.title, shown.stiffness ? " The dash-dotted line is k itself." : ""),
      {shown.name, fmt::format("{} over the stiffness of the soil", shown.title), {}, 3});
  CurveTable table(shown_axis(axis).label + "," + plain_label(shown));
  for (const CourseRoller &roller : rollers) {
    const Course course = course_of(points_of(points, roller.name), shown);
    if (!course.values.empty())
      figure.figure.panels.push_back(
          value_panel(shown, roller.title, axis, course, {shown.name, roller.name}, true, table));
  }
  figure.csv = table.text();
  return figure;
}

/// What identification finds in the records of a roller.
struct Found {
  std::size_t records = 0, exact = 0, measured = 0, inside = 0;
  double exact_error = 0.0, measured_error = 0.0; // largest |k found / k - 1|
  void add(const CoursePoint &point) {
    if (!point.identified) return;
    ++records;
    if (std::isfinite(point.exact.k)) {
      ++exact;
      exact_error = std::max(exact_error, std::fabs(point.exact.k / point.k - 1.0));
    }
    if (std::isfinite(point.measured.k)) {
      ++measured;
      measured_error = std::max(measured_error, std::fabs(point.measured.k / point.k - 1.0));
      if (std::fabs(point.measured.k - point.k) <= point.measured.k_half_width) ++inside;
    }
  }
};

Found found_in(const Points &points) {
  Found found;
  for (const CoursePoint &point : points)
    found.add(point);
  return found;
}

constexpr const char *what_records_are =
    "Records of 40 cycles, 250 samples in each. Exact: positions, velocities and accelerations without "
    "noise. Noisy accelerations, as a real roller has them: those of drum and frame alone, with white noise "
    "of 1 % of their standard deviation; the phase of the exciter is off by 0.5 degrees and known within 1 "
    "degree. Intervals are of 95 %.";

PageTable found_table(const std::vector<CourseRoller> &rollers, const Points &points) {
  PageTable table("identified_k", "What identify finds in records of this motion",
                  "roller | records | exact: no identification | largest error of k (-) | noisy "
                  "accelerations: no identification | largest error of k (-) | k in its 95 % interval");
  for (const CourseRoller &roller : rollers) {
    const Found found = found_in(points_of(points, roller.name));
    table.add({roller.title, std::to_string(found.records), std::to_string(found.records - found.exact),
               fmt::format("{:.1e}", found.exact_error), std::to_string(found.records - found.measured),
               fmt::format("{:.1e}", found.measured_error),
               fmt::format("{} of {}", found.inside, found.measured)});
  }
  table.notes = {what_records_are};
  return table;
}

/// What identification finds over the axis; without a record no panel.
PageFigure found_figure(const std::vector<CourseRoller> &rollers, const MapAxis &axis, const Points &points,
                        int number) {
  const std::string name = "identified";
  PageFigure figure =
      page_figure(fmt::format("Fig. {}", number),
                  "k that identify finds over the true k, in records of the motion of the "
                  "figures above, with 95 % confidence intervals. Crosses: no identification.",
                  {name, "k identified over true k", {}, rollers.size() > 1 ? 3 : 1}, 0.9);
  const ShownAxis across = shown_axis(axis);
  CurveTable table(across.label + ",found over true [-],lower end [-],upper end [-]");
  for (const CourseRoller &roller : rollers) {
    Panel panel{roller.title, across.label, "k identified / k [-]", {}};
    panel.log_x = axis.log;
    panel.x_range = axis_range(across.scale * axis.from, across.scale * axis.to);
    panel.y_range = "[0.7:1.3]";
    const std::string measured = fmt::format("{} noisy accelerations", roller.name);
    const std::string exact = fmt::format("{} exact record", roller.name);
    const std::string none = fmt::format("{} no identification", roller.name);
    bool missing = false;
    const auto rows = [&](const std::string &curve, FoundLaw CoursePoint::*part) {
      for (const CoursePoint &point : points) {
        if (point.roller != roller.name || !point.identified) continue;
        const double place = across.scale * point.value;
        const FoundLaw &found = point.*part;
        if (std::isfinite(found.k))
          table.row(curve, {place, found.k / point.k, (found.k - found.k_half_width) / point.k,
                            (found.k + found.k_half_width) / point.k});
        else
          table.row(none, {place, 1.0});
        missing = missing || !std::isfinite(found.k);
      }
    };
    rows(measured, &CoursePoint::measured);
    rows(exact, &CoursePoint::exact);
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
  std::string roller;
  double high = 0.0, low = 0.0; // CMV
  double from = 0.0, to = 0.0;  // value of the axis at these
  double same = 0.0;            // smaller one with the lower CMV
};

std::optional<Fall> deepest_fall(const std::vector<CourseRoller> &rollers, const Points &points) {
  std::optional<Fall> deepest;
  for (const CourseRoller &roller : rollers) {
    const Course course = course_of(points_of(points, roller.name), course_values[0]);
    for (std::size_t i = 0; i < course.turns.size(); ++i) {
      const std::size_t high = course.turns[i];
      const std::size_t low = i + 1 < course.turns.size() ? course.turns[i + 1] : course.values.size() - 1;
      const double depth = course.values[high] - course.values[low];
      if (depth <= (deepest ? deepest->high - deepest->low : 0.0)) continue;
      Fall fall = {roller.title, course.values[high], course.values[low], course.points[high].value,
                   course.points[low].value};
      std::size_t same = 0;
      while (course.values[same] < fall.low)
        ++same;
      fall.same = course.points[same].value;
      deepest = fall;
    }
  }
  return deepest;
}

/// How well noisy accelerations give k, where the contact lasts long and where not.
std::string limits_of(const Points &points) {
  constexpr double long_contact = 0.8; // share of time: shorter flights hardly tell the phase
  Points held;
  Points nearly;
  Points lost;
  for (const CoursePoint &point : points) {
    if (!std::isfinite(point.measured.k)) continue;
    const bool longer = point.motion.meter.contact_share > long_contact;
    (point.motion.regime == Regime::continuous_contact ? held : longer ? nearly : lost).push_back(point);
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
  return limits;
}

/// What identification finds, as a sentence.
std::string identification_words(const Points &points) {
  const Found all = found_in(points);
  if (all.records == 0) return {};
  std::string words = fmt::format("Identification finds k in {} of {} exact records, with errors of at most "
                                  "{:.1e}.",
                                  all.exact, all.records, all.exact_error);
  if (const std::string limits = limits_of(points); !limits.empty())
    words += fmt::format(" Noisy accelerations alone, with the phase of the exciter within 1 degree, give k "
                         "{}. In continuous contact an error of the phase acts on the force as the "
                         "stiffness does; this limit is worst on soft soil, where the force on the drum is "
                         "mostly its inertia.",
                         limits);
  return words;
}

constexpr const char *what_stiffnesses_are =
    "k_B, k_1 and c_1 are stiffness and damping at the excitation frequency. k_B is computed from the mass "
    "of the drum alone and contains the force of the frame on it; k_1 and c_1 are without the frame and are "
    "the soil's in continuous contact. In other regimes all are apparent values. The page on meters has the "
    "formula and the source of each value.";

} // namespace

void write_soil_page(const std::filesystem::path &out, const std::vector<CourseRoller> &rollers,
                     const MapAxis &axis, const Points &points) {
  Page page(out, "What the meter says of the soil", Drawing::chain);
  page.answer("Rollers on a spring and a dashpot of known stiffness k, computed in closed form: what a "
              "compaction meter shows of their motion, and what identification finds in records of it.");
  std::size_t falling = 0;
  for (const CourseRoller &roller : rollers)
    falling += course_of(points_of(points, roller.name), course_values[0]).turns.empty() ? 0 : 1;
  page.answer(fmt::format("With growing k the motion goes from continuous contact to partial uplift, where "
                          "CMV begins to grow, and for {} of {} rollers to double jump or beyond, where CMV "
                          "falls and rises again, so that one CMV belongs to several k.",
                          falling, rollers.size()));
  const ShownAxis shown = shown_axis(axis);
  if (const std::optional<Fall> fall = deepest_fall(rollers, points))
    page.answer(fmt::format("The deepest fall is that of {}, from {:.0f} at {} MN/m to {:.0f} at {} "
                            "MN/m, a value that it also has near {} MN/m.",
                            fall->roller, fall->high, number_in(shown, fall->from), fall->low,
                            number_in(shown, fall->to), number_in(shown, fall->same)));
  page.answer(identification_words(points));
  page.section("Where a value may mean several stiffnesses");
  page.paragraph(what_stiffnesses_are);
  page.table(course_table(rollers, axis, points));
  page.section("Meter values over the stiffness of the soil");
  int number = 0;
  const std::size_t key = rollers.size() > 4 ? 4 : 0;
  for (const CourseValue &value : course_values) {
    PageFigure figure = value_figure(rollers, axis, points, value, ++number);
    if (number == 1) {
      figure.weight = 1.0;
      figure.key_panel = key;
    }
    page.figure(figure);
  }
  page.section("What identification finds");
  page.table(found_table(rollers, points));
  PageFigure found = found_figure(rollers, axis, points, ++number);
  found.key_panel = key;
  page.figure(found);
  page.write();
}

namespace {

/// The values of one roller but CMV, in panels; or that alone.
PageFigure values_figure(const MapAxis &axis, const Points &points, bool cmv_alone) {
  const std::string name = cmv_alone ? course_values[0].name : "values";
  const std::string over = fmt::format("over {}", axis.name);
  PageFigure figure =
      cmv_alone
          ? page_figure("Fig. 1",
                        fmt::format("CMV {}. Marks are regimes; a solid line is where several {} have the "
                                    "same value.",
                                    over, axis.name),
                        {name, "CMV " + over, {}, 1})
          : page_figure("Fig. 2",
                        fmt::format("The other values {}, with marks and lines as in Fig. 1. The dash-dotted "
                                    "line is k of the soil.",
                                    over),
                        {name, "Meter values " + over, {}, 2});
  CurveTable table(shown_axis(axis).label + ",value");
  for (const CourseValue &value : course_values) {
    const Course course = course_of(points, value);
    if (!course.values.empty() && (&value == &course_values[0]) == cmv_alone)
      figure.figure.panels.push_back(value_panel(value, cmv_alone ? "" : value.title, axis, course,
                                                 {name, value.name}, cmv_alone, table));
  }
  figure.csv = table.text();
  return figure;
}

/// Where regimes change.
PageTable boundary_table(const MapAxis &axis, const std::vector<BoundaryPoint> &boundaries) {
  const ShownAxis shown = shown_axis(axis);
  PageTable table("changes", "Where the motion changes", fmt::format("change | {}", shown.label));
  for (const BoundaryPoint &boundary : boundaries)
    table.add({boundary_title(boundary.kind), fmt::format("{:.8g}", shown.scale * boundary.x)});
  return table;
}

/// How each value goes.
PageTable turn_table(const MapAxis &axis, const Points &points) {
  const ShownAxis shown = shown_axis(axis);
  PageTable table(
      "courses", "Where the values rise and fall",
      fmt::format("value | with growing {} | points whose value is met several times", shown.label), 2);
  for (const CourseValue &value : course_values) {
    const Course course = course_of(points, value);
    const auto several =
        std::count_if(course.same.begin(), course.same.end(), [](std::size_t same) { return same > 1; });
    table.add(
        {value.title, words_of(course, shown), course.values.empty() ? no_value : std::to_string(several)});
  }
  table.notes = {
      "Changes of less than 2 % of the value's range do not count, nor those of CMV, RMV and CCV of "
      "less than 0.5. E_vib needs radius and width of the drum."};
  return table;
}

/// k and D that identification finds, point by point.
PageTable law_table(const MapAxis &axis, const Points &points) {
  const ShownAxis shown = shown_axis(axis);
  PageTable table(
      "identified_k", "What identify finds in records of this motion",
      fmt::format("{} | regime | exact record: k (MN/m) | D (-) | noisy accelerations: k (MN/m) | D "
                  "(-)",
                  shown.label),
      2);
  const auto text = [](double value, double half_width, double scale, bool interval) -> std::string {
    if (!std::isfinite(value)) return no_value;
    return interval ? fmt::format("{:.4g} ± {:.2g}", scale * value, scale * half_width)
                    : fmt::format("{:.6g}", scale * value);
  };
  for (const CoursePoint &point : points)
    if (point.identified)
      table.add({number_in(shown, point.value), regime_of(point), text(point.exact.k, 0.0, 1e-6, false),
                 text(point.exact.D, 0.0, 1.0, false),
                 text(point.measured.k, point.measured.k_half_width, 1e-6, true),
                 text(point.measured.D, point.measured.D_half_width, 1.0, true)});
  table.notes = {what_records_are};
  return table;
}

/// At which values of the axis round CMV are met.
PageTable meaning_table(const MapAxis &axis, const Course &course) {
  const ShownAxis shown = shown_axis(axis);
  PageTable table("meaning", fmt::format("What a CMV may mean: {}", shown.label),
                  fmt::format("CMV (-) | {} with this CMV | number of them, at least", axis.name), 2);
  const double highest = *std::max_element(course.values.begin(), course.values.end());
  constexpr double rows = 12.0;
  const double exponent = std::floor(std::log10(std::max(highest, 1.0) / rows));
  double step = std::pow(10.0, exponent);
  for (const double factor : {2.0, 5.0, 10.0})
    if (highest / step > rows) step = factor * std::pow(10.0, exponent);
  const auto count = static_cast<int>(std::ceil(highest / step));
  for (int i = 1; i < count; ++i) {
    const double cmv = step * i;
    const std::vector<double> places = course.met_at(cmv);
    std::string words;
    constexpr std::size_t most = 8;
    for (std::size_t place = 0; place < places.size() && place < most; ++place)
      words += (place == 0 ? "" : ", ") + number_in(shown, places[place]);
    if (places.size() > most) words += fmt::format(" and {} more", places.size() - most);
    table.add({fmt::format("{:g}", cmv), words.empty() ? no_value : words, std::to_string(places.size())});
  }
  table.notes = {
      "Interpolated between the points: a finer axis may show more. Ups and downs of less than 2 % of the "
      "range do not count."};
  return table;
}

} // namespace

void write_course_page(const std::filesystem::path &out, const std::string &conditions, const MapAxis &axis,
                       const Points &points, const std::vector<BoundaryPoint> &boundaries) {
  const ShownAxis shown = shown_axis(axis);
  Page page(out, "What will the meter of this roller show?", Drawing::chain);
  page.answer(fmt::format("{} values of {} from {} to {} {}. {}.", points.size(), axis.name,
                          number_in(shown, axis.from), number_in(shown, axis.to), unit_of(shown),
                          conditions));
  page.answer(fmt::format("With growing {}: {}.", axis.name, regimes_of(points, shown)));
  const Course cmv = course_of(points, course_values[0]);
  const auto several = static_cast<std::size_t>(
      std::count_if(cmv.same.begin(), cmv.same.end(), [](std::size_t count) { return count > 1; }));
  page.answer(several == 0 ? fmt::format("Each CMV belongs to one {}.", axis.name)
                           : fmt::format("At {} of {} points the CMV belongs to several {}.", several,
                                         points.size(), axis.name));
  const std::string found = identification_words(points);
  if (!found.empty()) page.answer(found);
  page.section("Meter values");
  page.paragraph(what_stiffnesses_are);
  page.figure(values_figure(axis, points, true));
  if (const PageTable meaning = meaning_table(axis, cmv); !meaning.rows.empty()) page.table(meaning);
  page.figure(values_figure(axis, points, false));
  if (!boundaries.empty()) page.table(boundary_table(axis, boundaries));
  page.table(turn_table(axis, points));
  if (!found.empty()) {
    page.section("What identification finds");
    page.table(law_table(axis, points));
    PageFigure figure = found_figure({{points.front().roller, ""}}, axis, points, 3);
    figure.weight = 0.0;
    page.figure(figure);
  }
  page.write();
}

} // namespace drumlin::post
