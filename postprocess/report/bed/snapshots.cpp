#include "report/bed/snapshots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "bed/coarse_graining.h"
#include "bed/dump_readers.h"
#include "pages/figure.h"
#include "report/bed/figures.h"

namespace drumlin::post {

namespace {

/// The bed at one instant.
struct Instant {
  double time = 0.0;  ///< s
  double force = 0.0; ///< on the drum, N, of the nearest row of bed.csv
  bool has_contacts = false;
  std::vector<Ball> balls;
  BedContacts contacts;
};

/// The instants that the pictures show, in order.
enum Which : std::size_t { settled, peak, least, instants };

/// A run's instants; those that its dumps do not have are empty.
struct Views {
  const BedResult *result = nullptr;
  std::array<std::optional<Instant>, instants> views;
  std::vector<Ball> last; ///< at the last dump; empty with a single one
};

constexpr double bright_share = 0.98; ///< share of soil balls whose speed is within the scale of colours
constexpr int force_classes = 5; ///< classes of contact forces, each up to twice the force of the class below
constexpr double widest = 6.0;   ///< line width of the largest force, pt
constexpr double layer = 2.0;    ///< height of a layer of the profile, in mean diameters of the soil balls
constexpr double peak_weight = 10.0; ///< the page opens with the bed under the largest force

/// Row of bed.csv nearest to a time.
std::size_t row_near(const ChainHistory &history, double time) {
  const auto next = std::lower_bound(history.time.begin(), history.time.end(), time);
  auto row = static_cast<std::size_t>(next - history.time.begin());
  if (row == history.size() || (row > 0 && time - history.time[row - 1] < history.time[row] - time)) --row;
  return row;
}

Instant read_instant(const BedResult &result, long step, const StepDump &dump) {
  Instant instant;
  instant.time = static_cast<double>(step) * result.run.timestep;
  instant.force = result.run.history.F_contact[row_near(result.run.history, instant.time)];
  instant.has_contacts = !dump.contacts.empty();
  instant.balls = read_ball_dump(dump.balls);
  if (instant.has_contacts) instant.contacts = read_contact_dump(dump.contacts, instant.balls);
  return instant;
}

/// The first dump is the bed at rest. Of the later dumps, `peak` has the largest and `least` the smallest
/// force on the drum. Nothing if the run has no dumps.
std::optional<Views> read_views(const BedResult &result) {
  const std::map<long, StepDump> steps = dumped_steps(result.run.folder / "dump");
  if (steps.empty()) return std::nullopt;
  if (!(result.run.timestep > 0.0))
    throw std::runtime_error(
        fmt::format("{}: timestep is missing or not above 0; the time of a dump follows from it",
                    (result.run.folder / "parameters.csv").string()));
  Views out;
  out.result = &result;
  out.views[settled] = read_instant(result, steps.begin()->first, steps.begin()->second);
  if (steps.size() == 1) return out;
  const ChainHistory &h = result.run.history;
  const auto force = [&](const std::pair<const long, StepDump> &step) {
    return h.F_contact[row_near(h, static_cast<double>(step.first) * result.run.timestep)];
  };
  const auto [low, high] =
      std::minmax_element(std::next(steps.begin()), steps.end(),
                          [&](const auto &a, const auto &b) { return force(a) < force(b); });
  out.views[peak] = read_instant(result, high->first, high->second);
  if (low != high) out.views[least] = read_instant(result, low->first, low->second);
  out.last = read_ball_dump(std::prev(steps.end())->second.balls);
  return out;
}

double speed(const Ball &ball) { return std::hypot(ball.velocity[0], ball.velocity[1], ball.velocity[2]); }

/// Scales that all pictures of a group share, so that they can be compared.
struct Scales {
  Bounds bounds;
  double fastest = 0.0;   ///< end of the scale of colours, m/s
  double strongest = 0.0; ///< largest normal force of a contact, N
  bool flat = true;       ///< two dimensions
  int layers = 1;         ///< of soil, and behind them the spots of the lowest
  int spots = 0;          ///< of these, spots

  /// Height z of the section through a bed in three dimensions, m.
  double middle() const { return 0.5 * (bounds.low[2] + bounds.high[2]); }
  /// Radius of a ball's circle in the picture, m: in three dimensions that of the section through the ball, 0
  /// if the section misses it.
  double shown_radius(const Ball &ball) const {
    const double off = flat ? 0.0 : ball.position[2] - middle();
    return std::sqrt(std::max(0.0, ball.radius * ball.radius - off * off));
  }
};

Scales scales_of(const std::vector<Views> &all) {
  Scales scales;
  std::vector<double> speeds;
  for (const Views &views : all) {
    const std::string spots = views.result->run.text("spots", "none");
    if (spots != "none")
      scales.spots =
          std::max(scales.spots, 1 + static_cast<int>(std::count(spots.begin(), spots.end(), ',')));
    for (const std::optional<Instant> &instant : views.views) {
      if (!instant) continue;
      scales.flat = scales.flat && in_a_plane(instant->balls);
      for (const Ball &ball : instant->balls) {
        scales.bounds.add(ball);
        scales.layers = std::max(scales.layers, layer_of(ball.type));
        if (is_soil(ball.type) && &instant != &views.views[settled]) speeds.push_back(speed(ball));
      }
      for (const BallContact &contact : instant->contacts.balls)
        scales.strongest = std::max(scales.strongest, force_parts(contact).normal);
      for (const WallContact &contact : instant->contacts.walls)
        scales.strongest = std::max(scales.strongest, force_parts(contact).normal);
    }
  }
  if (!speeds.empty()) {
    const auto place =
        speeds.begin() + static_cast<std::ptrdiff_t>(bright_share * static_cast<double>(speeds.size() - 1));
    std::nth_element(speeds.begin(), place, speeds.end());
    scales.fastest = *place;
  }
  // Rounded up to two digits, for the labels of the scale.
  for (double *value : {&scales.fastest, &scales.strongest})
    if (*value > 0.0) {
      const double unit = std::pow(10.0, std::floor(std::log10(*value)) - 1.0);
      *value = std::ceil(*value / unit) * unit;
    }
  return scales;
}

/// The name of the curve of a layer's balls, counted from 1, the lowest.
std::string soil_curve(int layer_number, const Scales &scales) {
  return scales.layers == 1 ? " soil" : fmt::format(" soil {}", layer_number);
}

void put_instant(CurveTable &table, const std::string &label, const Instant &instant, const Scales &scales) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const std::vector<int> counts = coordination(instant.balls.size(), instant.contacts.balls);
  for (std::size_t b = 0; b < instant.balls.size(); ++b) {
    const Ball &ball = instant.balls[b];
    const double radius = scales.shown_radius(ball);
    if (radius == 0.0) continue;
    table.row(label + (is_soil(ball.type) ? soil_curve(layer_of(ball.type), scales) : " roller"),
              {ball.position[0], ball.position[1], radius, speed(ball),
               instant.has_contacts ? static_cast<double>(counts[b]) : none, none, none, none});
  }
  const auto put_line = [&](const Vector &to, const Vector &l, double force) {
    table.row(label + " contact", {to[0] - l[0], to[1] - l[1], none, none, none, l[0], l[1], force});
  };
  const auto shown = [&](std::size_t ball) { return scales.shown_radius(instant.balls[ball]) > 0.0; };
  for (const BallContact &contact : instant.contacts.balls)
    if (shown(contact.i) && shown(contact.j))
      put_line(instant.balls[contact.i].position, contact.branch, force_parts(contact).normal);
  for (const WallContact &contact : instant.contacts.walls) {
    if (!shown(contact.i)) continue;
    const Ball &ball = instant.balls[contact.i];
    const Vector from = foot(ball, contact);
    put_line(ball.position, {ball.position[0] - from[0], ball.position[1] - from[1], 0.0},
             force_parts(contact).normal);
  }
}

Panel instant_panel(const std::string &figure, const std::string &label, const Instant &instant,
                    const Scales &scales, bool by_contacts, const char *per) {
  Panel panel{
      fmt::format("{}: {:.4g} s, {:.1f} kN{} on the drum", label, instant.time, instant.force * 1e-3, per),
      "x (m)",
      "y (m)",
      {}};
  panel.equal_scales = true;
  const double margin = 0.02 * (scales.bounds.high[0] - scales.bounds.low[0]);
  const auto range = [&](std::size_t axis) {
    return axis_range(scales.bounds.low[axis] - margin, scales.bounds.high[axis] + margin);
  };
  panel.x_range = range(0);
  panel.y_range = range(1);
  if (by_contacts) {
    panel.color_label = "contacts of a ball (-)";
    panel.color_range = "[-0.5:6.5]";
    panel.color_whole = true;
  } else {
    panel.color_label = "speed of a ball (m/s)";
    panel.color_range = axis_range(0.0, std::max(scales.fastest, 1.0e-9));
  }
  const auto add = [&](const std::string &what, const std::string &x, const std::string &y,
                       CurveStyle style) { panel.add(curve(figure, label + what, x, y, style), ""); };
  constexpr std::array<CurveStyle, 4> edges = {CurveStyle::discs_1, CurveStyle::discs_2, CurveStyle::discs_3,
                                               CurveStyle::discs_4};
  for (int n = 1; n <= scales.layers; ++n) {
    const CurveStyle edge = edges[static_cast<std::size_t>(n - 1) % edges.size()];
    add(soil_curve(n, scales), "$2", by_contacts ? "3:4:6" : "3:4:5",
        scales.layers == 1 ? CurveStyle::discs : edge);
    const int spot = n - (scales.layers - scales.spots);
    if (scales.layers > 1)
      panel.curves.back().title = spot > 0 ? fmt::format("spot {}", spot) : fmt::format("layer {}", n);
  }
  for (int i = 0; i < force_classes && scales.strongest > 0.0; ++i) {
    const double high = scales.strongest / std::pow(2.0, force_classes - 1 - i);
    add(" contact", fmt::format("($9 > {:.6g} && $9 <= {:.6g} ? $2 : NaN)", 0.5 * high, high), "3:7:8",
        CurveStyle::segments);
    panel.curves.back().width = widest * 0.75 * high / scales.strongest; // of the middle of the class
    panel.curves.back().title =
        fmt::format("{} to {} kN{}", two_digits(0.5e-3 * high), two_digits(1e-3 * high), per);
  }
  add(" roller", "$2", "3:4", CurveStyle::circles);
  return panel;
}

std::string picture_caption(Which which, const Scales &scales, bool by_contacts) {
  std::string words;
  switch (which) {
  case settled:
    words = "The bed at rest, before the excitation (first dump)";
    break;
  case peak:
    words = "The bed at the dump with the largest force on the drum";
    break;
  default:
    words = "The bed at the dump with the smallest force on the drum";
  }
  words += by_contacts ? "; colours: contacts of each soil ball with other balls"
                       : "; colours: speed of the soil balls (the fastest 2 % exceed the scale)";
  if (scales.strongest > 0.0)
    words += ". Black lines are the force chains: they join the centres of two balls in contact, or a ball "
             "and a wall, and their width grows with the normal force. Forces below the smallest class of "
             "the legend are not drawn";
  if (scales.layers > 1)
    words += ". The edges of the balls have the colours of their layers, of which the lowest is layer 1";
  if (!scales.flat)
    words += fmt::format(". The picture is the section z = {:.3g} m of the bed: the circles in which it cuts "
                         "the balls, and the contacts between balls that it cuts",
                         scales.middle());
  return words + ". Open circles: the drum and, above it, the frame, which has a mass but touches no soil.";
}

/// The soil of some instants of a run: where it lies, and the mean diameter of its balls [m].
struct Soil {
  Bounds bounds;
  double diameter = 0.0;
};

Soil soil_of(const std::vector<const std::vector<Ball> *> &states) {
  Soil soil;
  double balls = 0.0;
  for (const std::vector<Ball> *state : states)
    for (const Ball &ball : *state) {
      if (!is_soil(ball.type)) continue;
      soil.bounds.add(ball);
      soil.diameter += 2.0 * ball.radius;
      balls += 1.0;
    }
  soil.diameter /= balls;
  return soil;
}

/// Where the drum lies, one ball or a clump of many.
Bounds drum_of(const std::vector<Ball> &balls) {
  Bounds drum;
  for (const Ball &ball : balls)
    if (ball.type == drum_type) drum.add(ball);
  return drum;
}

/// A zone from side to side, m.
struct Zone {
  double low, high;
};

/// Layers of soil in a zone, the lowest first.
FieldGrid layers_of(const Soil &soil, Zone zone, bool flat) {
  FieldGrid grid;
  grid.flat = flat;
  const Bounds &in = soil.bounds;
  const double depth = in.high[1] - in.low[1];
  grid.cells[1] = static_cast<std::size_t>(std::max(1.0, std::round(depth / (layer * soil.diameter))));
  grid.origin = {zone.low, in.low[1], flat ? 0.0 : in.low[2]};
  grid.sides = {zone.high - zone.low, depth / static_cast<double>(grid.cells[1]),
                flat ? 1.0 : in.high[2] - in.low[2]};
  return grid;
}

/// A field over the depth below the highest ball, the uppermost layer first: beds of other depths have their
/// surfaces in common. \param value of a cell of the grid
template <class Value>
Rows<2> over_depth(const FieldGrid &grid, const Value &value) {
  Rows<2> rows;
  for (std::size_t c = grid.cells[1]; c-- > 0;)
    rows.push_back({(static_cast<double>(grid.cells[1] - 1 - c) + 0.5) * grid.sides[1], value(c)});
  return rows;
}

/// The solid fraction of the soil over the depth, the mean of some zones of the same width.
Rows<2> solid_fraction_of(const std::vector<Ball> &balls, const Soil &soil, const std::vector<Zone> &zones) {
  Rows<2> rows;
  for (const Zone &zone : zones) {
    const FieldGrid grid = layers_of(soil, zone, in_a_plane(balls));
    const BedFields fields = coarse_grained(balls, {}, grid);
    const Rows<2> one = over_depth(grid, [&fields](std::size_t c) { return fields.solid_fraction[c]; });
    if (rows.empty()) rows.assign(one.size(), {0.0, 0.0});
    for (std::size_t i = 0; i < one.size(); ++i)
      for (std::size_t j = 0; j < 2; ++j)
        rows[i][j] += one[i][j] / static_cast<double>(zones.size());
  }
  return rows;
}

/// Below the drum, and beside it to both sides over half of its width; nothing where the box has no space.
std::vector<Zone> zones_below(const Bounds &drum) { return {{drum.low[0], drum.high[0]}}; }
std::vector<Zone> zones_beside(const Bounds &drum, const Bounds &soil) {
  const double width = 0.5 * (drum.high[0] - drum.low[0]);
  if (drum.low[0] - width < soil.low[0] || drum.high[0] + width > soil.high[0]) return {};
  return {{drum.low[0] - width, drum.low[0]}, {drum.high[0], drum.high[0] + width}};
}

/// The views of each condition, B first.
std::vector<std::vector<const Views *>> by_condition(const std::vector<Views> &all) {
  std::vector<std::vector<const Views *>> found;
  for (const Transition transition : {Transition::B, Transition::A}) {
    std::vector<const Views *> under;
    for (const Views &views : all)
      if (views.result->run.transition() == transition) under.push_back(&views);
    if (!under.empty()) found.push_back(under);
  }
  return found;
}

std::string name_of(const Views &views) { return transition_name(views.result->run.transition()); }

/// What a caption says where several beds are drawn together.
std::string beds_words(std::size_t most) {
  return most < 2 ? ""
                  : fmt::format(" Means over up to {} beds of a condition, and thin the least and the "
                                "largest of them.",
                                most);
}

void plan_profile(const std::vector<Views> &all, const std::string &stem, const std::string &section,
                  FigurePlan &plan) {
  const std::string name = stem + "profile";
  CurveTable table("depth (m),solid fraction (-)");
  const char *axis = "solid fraction (-)", *depth = "depth below the highest ball (m)";
  struct Place {
    const char *name;
    Panel panel;
  };
  std::array<Place, 3> places = {{{"whole", {"across the whole box", axis, depth, {}}},
                                  {"below", {"below the drum", axis, depth, {}}},
                                  {"beside", {"beside the drum", axis, depth, {}}}}};
  double densest = 0.0;
  std::size_t most = 0;
  for (const std::vector<const Views *> &under : by_condition(all)) {
    const std::string label = name_of(*under.front());
    const bool a = label == transition_name(Transition::A);
    for (const bool after : {false, true})
      for (Place &place : places) {
        std::vector<Rows<2>> beds;
        for (const Views *views : under) {
          if (views->last.empty()) continue;
          const std::vector<Ball> &before = views->views[settled]->balls;
          const std::vector<Ball> &state = after ? views->last : before;
          const Soil soil = soil_of({&before, &views->last});
          if (soil.bounds.empty()) continue;
          const Bounds drum = drum_of(state);
          const std::string where = place.name;
          std::vector<Zone> zones = {{soil.bounds.low[0], soil.bounds.high[0]}};
          if (where != "whole" && drum.empty()) continue;
          if (where == "below") zones = zones_below(drum);
          if (where == "beside") zones = zones_beside(drum, soil.bounds);
          if (!zones.empty()) beds.push_back(solid_fraction_of(state, soil, zones));
        }
        if (beds.empty()) continue;
        const std::string when = after ? "after" : "before";
        const std::string row = fmt::format("{} {} {}", label, when, place.name);
        for (const std::array<double, 2> &one : put_beds(table, row, beds, 1))
          densest = std::max(densest, one[1]);
        most = std::max(most, beds.size());
        const CurveStyle style = after ? (a ? CurveStyle::series_2 : CurveStyle::series_1)
                                       : (a ? CurveStyle::series_5 : CurveStyle::series_3);
        add_beds(place.panel, name, row, beds.size(), "$3", "2", style, fmt::format("{} {}", label, when));
      }
  }
  if (most == 0) return;
  PageFigure figure{section, "", "", {}, table.text()};
  figure.figure = {name, "Solid fraction over the depth", {}, 2};
  for (Place &place : places) {
    if (place.panel.curves.empty()) continue;
    place.panel.y_range = "[*:*] reverse";
    place.panel.x_range = axis_range(0.8 * densest, 1.03 * densest); // the changes are small
    figure.figure.panels.push_back(place.panel);
  }
  figure.caption =
      fmt::format("Solid fraction: area (in three dimensions volume) of the soil balls over that of the "
                  "layer, at the first dump (before) and at the last (after), in layers of about {:g} mean "
                  "diameters: across the whole box, below the drum, and, where the box has space, beside it "
                  "over half of its width on both sides. Layers that hold air or a part of the drum lie "
                  "outside of the scale; the CSV file has them.{}",
                  layer, beds_words(most));
  plan.figures.push_back(std::move(figure));
}

/// The vertical stress below the drum over the depth, at the largest force; nothing without contacts.
Rows<2> stress_below(const Views &views) {
  if (!views.views[peak] || !views.views[peak]->has_contacts) return {};
  const Instant &instant = *views.views[peak];
  const Soil soil = soil_of({&instant.balls});
  const Bounds drum = drum_of(instant.balls);
  if (soil.bounds.empty() || drum.empty()) return {};
  const FieldGrid grid = layers_of(soil, zones_below(drum).front(), in_a_plane(instant.balls));
  if (grid.cells[1] < 2) return {};
  const BedFields fields = coarse_grained(instant.balls, instant.contacts.balls, grid);
  constexpr std::size_t vertical = 4; // yy
  return over_depth(grid, [&fields](std::size_t c) { return fields.stress[c][vertical]; });
}

void plan_stress(const std::vector<Views> &all, const std::string &stem, const std::string &section,
                 FigurePlan &plan) {
  const std::string name = stem + "stress";
  CurveTable table("depth (m),vertical stress (Pa)");
  Panel panel{"Stress below the drum", "vertical stress (kPa)", "depth below the highest ball (m)", {}};
  std::size_t most = 0;
  for (const std::vector<const Views *> &under : by_condition(all)) {
    std::vector<Rows<2>> beds;
    for (const Views *views : under)
      if (Rows<2> rows = stress_below(*views); !rows.empty()) beds.push_back(std::move(rows));
    if (beds.empty()) continue;
    const std::string label = name_of(*under.front());
    put_beds(table, label, beds, 1);
    most = std::max(most, beds.size());
    add_beds(panel, name, label, beds.size(), "($3*1e-3)", "2",
             label == transition_name(Transition::A) ? CurveStyle::series_2 : CurveStyle::series_1,
             "condition " + label);
  }
  if (panel.curves.empty()) return;
  panel.x_range = "[0:*]";
  panel.y_range = "[*:*] reverse";
  PageFigure figure{
      section,
      "",
      fmt::format("Vertical stress in the soil over the width of the drum, at the dump with the largest "
                  "force on it, in layers of about {:g} mean diameters: force and branch of the contacts "
                  "between balls over the volume. The contacts of the drum and of the walls do not count, "
                  "so that the outermost layers have too little.{}",
                  layer, most < 2 ? " It is that of one bed at one instant." : beds_words(most)),
      {},
      table.text()};
  figure.figure = {name, panel.title, {panel}, 1};
  plan.figures.push_back(std::move(figure));
}

/// How many soil balls touch the drum, and how far the outermost of their contacts are apart [m].
std::pair<int, double> drum_contact(const Instant &instant) {
  int count = 0;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const BallContact &contact : instant.contacts.balls) {
    const Ball &i = instant.balls[contact.i], &j = instant.balls[contact.j];
    if (!(i.type == drum_type && is_soil(j.type)) && !(j.type == drum_type && is_soil(i.type))) continue;
    const double x = i.position[0] - contact.branch[0] * i.radius / (i.radius + j.radius);
    low = std::min(low, x);
    high = std::max(high, x);
    ++count;
  }
  return {count, count > 0 ? high - low : 0.0};
}

/// Number and width of the drum's contacts in the last cycles that have dumps: time [s], number, width [m].
Rows<3> drum_contacts(const BedResult &result) {
  constexpr double cycles = 2.0;
  const Run &run = result.run;
  const std::map<long, StepDump> steps = dumped_steps(run.folder / "dump");
  const double from =
      static_cast<double>(steps.rbegin()->first) * run.timestep - (cycles + 1e-6) * run.chain.period();
  Rows<3> rows;
  for (const auto &[step, dump] : steps) {
    if (static_cast<double>(step) * run.timestep < from || dump.contacts.empty()) continue;
    const Instant instant = read_instant(result, step, dump);
    const auto [balls, apart] = drum_contact(instant);
    rows.push_back({instant.time, static_cast<double>(balls), apart});
  }
  return rows;
}

void plan_drum_contact(const std::vector<Views> &all, const std::string &stem, const std::string &section,
                       FigurePlan &plan) {
  const std::string name = stem + "contact";
  CurveTable table("time (s),touching balls (-),contact width (m)");
  Panel count{"balls that touch the drum", "time (s)", "balls that touch the drum (-)", {}};
  Panel width{"contact width", "time (s)", "width of the contact (mm)", {}};
  std::size_t most = 0;
  for (const std::vector<const Views *> &under : by_condition(all)) {
    std::vector<Rows<3>> beds;
    for (const Views *views : under)
      if (Rows<3> rows = drum_contacts(*views->result); !rows.empty()) beds.push_back(std::move(rows));
    if (beds.empty()) continue;
    const std::string label = name_of(*under.front());
    put_beds(table, label, beds, 1);
    most = std::max(most, beds.size());
    const CurveStyle style =
        label == transition_name(Transition::A) ? CurveStyle::series_2 : CurveStyle::series_1;
    add_beds(count, name, label, beds.size(), "$2", "3", style, "condition " + label);
    add_beds(width, name, label, beds.size(), "$2", "($4*1e3)", style, "condition " + label);
  }
  if (count.curves.empty()) return;
  count.y_range = width.y_range = "[0:*]";
  PageFigure figure{
      section,
      "",
      "How many soil balls touch the drum, and the distance between the outermost contacts, in the "
      "dumps of the last two cycles that have any. With one ball the width is 0: a drum stands on few "
      "stones, which is why its force scatters from bed to bed." +
          beds_words(most),
      {},
      table.text()};
  figure.figure = {name, "Contact of drum and soil", {count, width}, 2};
  plan.figures.push_back(std::move(figure));
}

} // namespace

void plan_bed_pictures(const BedGroup &group, const std::string &stem, const std::string &section,
                       FigurePlan &plan) {
  std::vector<Views> every; // bed
  for (const BedResult *result : group.runs) {
    if (std::optional<Views> views = read_views(*result))
      every.push_back(std::move(*views));
    else if (result == group.under(result->run.transition()).front())
      plan.absent.push_back({section, "The picture of " + result->run.name,
                             "the run has no dumps; run it with -var dumps_per_cycle 10 to get them"});
  }
  if (every.empty()) return;
  std::vector<Views> all; // that have a picture: one bed of each condition
  for (const std::vector<const Views *> &under : by_condition(every))
    all.push_back(*under.front());
  const Scales scales = scales_of(all);
  constexpr std::array<std::pair<const char *, const char *>, instants> names = {
      {{"settled", "The bed at rest"},
       {"peak", "The bed at the largest force on the drum"},
       {"least", "The bed at the smallest force on the drum"}}};
  for (const Which which : {settled, peak, least}) {
    const std::string name = stem + names[which].first;
    CurveTable table("x (m),y (m),radius (m),speed (m/s),contacts (-),dx (m),dy (m),normal force (N)");
    std::vector<Panel> panels;
    // At rest there is no speed to show.
    const bool by_contacts = which == settled && std::all_of(all.begin(), all.end(), [](const Views &views) {
                               return views.views[settled]->has_contacts;
                             });
    for (const Views &views : all) {
      const std::optional<Instant> &instant = views.views[which];
      if (!instant) continue;
      const std::string label = transition_name(views.result->run.transition());
      put_instant(table, label, *instant, scales);
      panels.push_back(
          instant_panel(name, label, *instant, scales, by_contacts, per_metre_words(views.result->run)));
    }
    if (panels.empty()) continue;
    PageFigure figure{section, "", picture_caption(which, scales, by_contacts), {}, table.text()};
    figure.figure = {name, names[which].second, panels, 2};
    figure.figure.only_png = true;
    if (which == peak) figure.weight = peak_weight;
    plan.figures.push_back(std::move(figure));
  }
  plan_profile(every, stem, section, plan);
  plan_stress(every, stem, section, plan);
  plan_drum_contact(every, stem, section, plan);
}

} // namespace drumlin::post
