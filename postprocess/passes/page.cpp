#include "passes/page.h"

#include "bed/relative_density.h"
#include "pages/figure.h"
#include "pages/page.h"
#include "passes/map_figures.h"
#include "passes/values.h"
#include "support/csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

namespace drumlin::post {

namespace {

using Results = std::vector<PassesResult>;
using Value = std::function<double(const PassValues &)>;

bool several(const Results &results) { return results.size() > 1; }

/// Passes that all runs have finished, which the answer is about.
std::size_t passes_of_all(const Results &results) {
  std::size_t least = results.front().passes.size() - 1;
  for (const PassesResult &result : results)
    least = std::min(least, result.passes.size() - 1);
  return least;
}

MeanInterval mean_after(const Results &results, std::size_t pass, const Value &value) {
  const std::vector<double> values = values_after(results, pass, value);
  return values.empty() ? MeanInterval{NAN, NAN} : mean_interval(values);
}

Value solid_fraction_of(std::size_t layer) {
  return [layer](const PassValues &pass) { return pass.soil.solid_fraction[layer]; };
}

/// The change of the lift's solid fraction and its 95 % interval: over the runs, or of one run along the way.
MeanInterval gain_of(const Results &results, std::size_t layer) {
  if (!several(results)) return gain_along_the_way(results.front(), layer);
  std::vector<double> gains;
  for (const PassesResult &result : results)
    gains.push_back(result.passes[passes_of_all(results)].soil.solid_fraction[layer] -
                    result.passes.front().soil.solid_fraction[layer]);
  return mean_interval(gains);
}

std::string count_words(std::size_t count, const char *one, const char *more) {
  return fmt::format("{} {}", count, count == 1 ? one : more);
}

/// After how many passes the gain per pass is small, if there is a gain at all.
std::string level_words(const Results &results, std::size_t layer, bool gains) {
  if (!gains) return "that is no more than scatter, so that it does not tell how many passes are enough";
  std::vector<double> means;
  const std::size_t passes = passes_of_all(results);
  for (std::size_t pass = 0; pass <= passes; ++pass)
    means.push_back(mean_after(results, pass, solid_fraction_of(layer)).mean);
  if (passes == 1) return "one pass does not tell when the gain falls below 5 % of the total";
  const std::optional<int> level = passes_until_level(means);
  if (level)
    return fmt::format("after {} the gain per pass is below 5 % of the total",
                       count_words(static_cast<std::size_t>(*level), "pass", "passes"));
  return fmt::format("the gain per pass is not yet below 5 % of the total (the last one: {:.0f} %)",
                     100.0 * (means.back() - means[passes - 1]) / (means.back() - means.front()));
}

std::string pass_name(std::size_t pass) { return pass == 0 ? "before" : fmt::format("after pass {}", pass); }

/// A value over passes with its scatter along the way, or with the 95 % interval of several runs.
struct PassCurve {
  std::string title, label;
  double scale;
  Value value, scatter;
  const char *second; ///< name of `of_second`, without bars; nullptr: there is none
  Value of_second;
};

/// Behind the unit of a force, stiffness or energy: in a plane they are those of 1 m of the drum's width.
const char *per_metre(const Results &results) { return results.front().flat ? " per m of width" : ""; }

/// Of the drum [m], by which what is per metre of width is that of the whole drum; NaN if it is not known, or
/// nothing is per metre.
double width_of(const Results &results) {
  const PassesResult &one = results.front();
  const auto width = one.parameters.find("roller_width");
  return one.flat && width != one.parameters.end() ? number_from_text(width->second) : NAN;
}

PageFigure compaction_figure(const Results &results) {
  const std::string name = "compaction";
  const bool many = several(results);
  PageFigure figure = page_figure(
      "Fig. 1",
      fmt::format(
          "The compaction curve. Bars: {}.",
          many ? "95 % intervals of the mean over the runs; pale: from the least to the largest run"
               : "standard deviations of the cells along the way, which are no errors of the mean; of k "
                 "its 95 % interval"),
      {name, "Compaction curve", {}, 2}, 1.0);
  std::vector<PassCurve> curves;
  const std::size_t layers = results.front().layers();
  for (std::size_t layer = layers; layer-- > 0;)
    curves.push_back({layer + 1 == layers ? "The lift" : fmt::format("Layer {}", layer + 1),
                      "solid fraction [-]", 1.0, solid_fraction_of(layer),
                      [layer](const PassValues &pass) { return pass.solid_scatter[layer]; }, "inside",
                      [layer](const PassValues &pass) { return pass.soil.inner_solid_fraction(layer); }});
  curves.push_back({"Settlement", "settlement of the surface [mm]", 1e3,
                    [](const PassValues &pass) { return pass.settlement; },
                    [](const PassValues &pass) { return pass.settlement_scatter; }, "of it compaction",
                    [](const PassValues &pass) { return pass.compaction; }});
  curves.push_back({"Meter",
                    "CMV [-]",
                    1.0,
                    [](const PassValues &pass) { return pass.cmv; },
                    [](const PassValues &pass) { return pass.cmv_scatter; },
                    nullptr,
                    {}});
  const std::string stiffness = fmt::format("stiffness [MN/m{}]", per_metre(results));
  curves.push_back({"Stiffness", stiffness, 1e-6, [](const PassValues &pass) { return pass.k; },
                    [](const PassValues &pass) { return pass.k_half_width; }, "k_B of the meter",
                    [](const PassValues &pass) { return pass.k_B; }});
  curves.erase(std::remove_if(curves.begin(), curves.end(),
                              [&](const PassCurve &one) {
                                for (std::size_t pass = 0; pass <= most_passes(results); ++pass)
                                  if (!values_after(results, pass, one.value).empty()) return false;
                                return true;
                              }),
               curves.end());
  CurveTable table("pass,mean,low,high,second,least,largest");
  for (const PassCurve &one : curves) {
    const std::string key = one.title;
    // The axis of each panel is given: gnuplot would count the bars of all of them.
    double least = INFINITY, most = -INFINITY;
    for (std::size_t pass = 0; pass <= most_passes(results); ++pass) {
      const MeanInterval mean = mean_after(results, pass, one.value);
      if (!std::isfinite(mean.mean)) continue;
      double half = many ? mean.half_width : one.scatter(results.front().passes[pass]);
      if (!std::isfinite(half)) half = 0.0;
      const double second = one.second ? mean_after(results, pass, one.of_second).mean : NAN;
      const std::vector<double> all = values_after(results, pass, one.value);
      const auto [low, high] = std::minmax_element(all.begin(), all.end());
      for (const double end : {mean.mean - half, mean.mean + half, second})
        if (std::isfinite(end)) {
          least = std::min(least, one.scale * end);
          most = std::max(most, one.scale * end);
        }
      table.row(key,
                {static_cast<double>(pass), one.scale * mean.mean, one.scale * (mean.mean - half),
                 one.scale * (mean.mean + half), one.scale * second, one.scale * *low, one.scale * *high});
    }
    Panel panel{one.title, "passes", one.label, {}};
    if (many) panel.add(curve(name, key, "$2", "7:8", CurveStyle::band), "");
    panel.add(curve(name, key, "$2", "3", CurveStyle::series_1), !one.second           ? ""
                                                                 : key == "Settlement" ? "settlement"
                                                                 : key == "Stiffness"
                                                                     ? "k identified"
                                                                     : "between its surfaces");
    panel.add(curve(name, key, "$2", "3:4:5", CurveStyle::spread), "");
    if (one.second) panel.add(curve(name, key, "$2", "6", CurveStyle::series_2), one.second);
    panel.x_range = fmt::format("[-0.3:{}.3]", most_passes(results));
    panel.whole_x = most_passes(results) <= 12;
    const double margin = 0.05 * (most - least);
    panel.y_range = axis_range(least - margin, most + margin);
    figure.figure.panels.push_back(std::move(panel));
  }
  figure.csv = table.text();
  return figure;
}

PageFigure surface_figure(const PassesResult &result) {
  const std::string name = "surface";
  const double length = 0.25 * result.cell;
  PageFigure figure = page_figure(
      "Fig. 3",
      fmt::format("Height of the surface along the way, means over {:.3g} m; measured is between {:g} and "
                  "{:g} m. surface.csv has all lines.",
                  length, result.measured.from, result.measured.to),
      {name, "Surface along the way", {}, 1}, 0.9);
  CurveTable table("s [m],height [m]");
  Panel panel{"", "place along the way [m]", "height above the floor [m]", {}};
  panel.tight_x = true;
  const double end = result.lines.low + static_cast<double>(result.lines.count) * result.lines.spacing;
  const std::vector<std::size_t> passes = shown_passes(result.passes.size() - 1);
  for (std::size_t n = 0; n < passes.size(); ++n) {
    const std::string key = pass_name(passes[n]);
    for (double from = result.lines.low; from + length <= end + 1e-9; from += length)
      table.row(key, {from + 0.5 * length,
                      mean_over(result.surfaces[passes[n]], result.lines, {from, from + length})});
    panel.curves.push_back(curve(name, key, "$2", "3", pass_line(n)));
  }
  figure.csv = table.text();
  figure.figure.panels = {panel};
  return figure;
}

/// What of the profile a panel shows.
struct DepthValue {
  const char *label;
  double scale;
  std::optional<double> (*value)(const DepthRow &);
};

PageFigure depth_figure(const PassesResult &result) {
  const std::string name = "depth";
  const bool passing = std::any_of(result.depth.begin(), result.depth.end(),
                                   [](const PassDepth &one) { return one.passing > 0; });
  constexpr std::array<DepthValue, 4> values = {
      {{"solid fraction [-]", 1.0, [](const DepthRow &row) { return std::optional(row.solid_fraction); }},
       {"coordination [-]", 1.0, [](const DepthRow &row) { return row.coordination; }},
       {"largest vertical stress [kPa]", 1e-3, [](const DepthRow &row) { return row.largest_vertical; }},
       {"largest horizontal stress [kPa]", 1e-3,
        [](const DepthRow &row) { return row.largest_horizontal; }}}};
  PageFigure figure = page_figure(
      "Fig. 5",
      fmt::format("Profiles over the depth below the surface before the first pass: means over the measured "
                  "way, and the largest stress of a cell of it{}.",
                  passing ? " in the dumps under the passing drum"
                          : " after the pass, the roller standing outside of it"),
      {name, "Profile over depth", {}, 2});
  CurveTable table("depth [m],solid fraction [-],coordination [-],vertical [kPa],horizontal [kPa]");
  const std::vector<std::size_t> passes = shown_passes(result.passes.size() - 1);
  const double surface = result.passes.front().soil.surface;
  std::array<bool, values.size()> known{};
  for (const PassDepth &one : result.depth) {
    const auto pass = static_cast<std::size_t>(one.pass);
    if (std::find(passes.begin(), passes.end(), pass) == passes.end()) continue;
    std::array<double, values.size()> cells{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::optional<double> value = values[i].value(one.row);
      known[i] = known[i] || value;
      cells[i] = values[i].scale * value.value_or(NAN);
    }
    table.row(pass_name(pass), {surface - one.row.height, cells[0], cells[1], cells[2], cells[3]});
  }
  figure.csv = table.text();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!known[i]) continue;
    Panel panel{"", values[i].label, "depth [m]", {}};
    panel.y_range = "[*:*] reverse";
    for (std::size_t n = 0; n < passes.size(); ++n) {
      const std::string key = pass_name(passes[n]);
      panel.curves.push_back(curve(name, key, fmt::format("${}", i + 3), "2", pass_line(n)));
    }
    figure.figure.panels.push_back(std::move(panel));
  }
  return figure;
}

PageTable pass_table(const Results &results) {
  struct Shown {
    std::string header;
    int decimals;
    double scale;
    Value value;
  };
  constexpr double milli = 1e3, kilo = 1e-3, mega = 1e-6;
  const char *const per = per_metre(results);
  const auto with_unit = [per](const char *name, const char *unit) {
    return fmt::format("{} ({}{})", name, unit, per);
  };
  std::vector<Shown> shown = {
      {"settlement (mm)", 1, milli, [](const PassValues &pass) { return pass.settlement; }},
      {"of it compaction (mm)", 1, milli, [](const PassValues &pass) { return pass.compaction; }},
      {"pushed along (mm)", 1, milli, [](const PassValues &pass) { return pass.pushed(); }},
      {"heave outside (mm)", 1, milli, [](const PassValues &pass) { return pass.heave; }}};
  for (std::size_t layer = results.front().layers(); layer-- > 0;) {
    const auto of_layer = [layer](const char *what) { return fmt::format("{}, layer {}", what, layer + 1); };
    shown.push_back({of_layer("solid fraction"), 4, 1.0, solid_fraction_of(layer)});
    shown.push_back({of_layer("inside"), 4, 1.0,
                     [layer](const PassValues &pass) { return pass.soil.inner_solid_fraction(layer); }});
    shown.push_back({of_layer("degree of compaction (%)"), 1, 100.0,
                     [layer](const PassValues &pass) { return pass.degree[layer]; }});
    shown.push_back({of_layer("relative density (%)"), 0, 100.0,
                     [layer](const PassValues &pass) { return pass.relative_density[layer]; }});
  }
  shown.insert(
      shown.end(),
      {{"CMV", 1, 1.0, [](const PassValues &pass) { return pass.cmv; }},
       {"RMV", 1, 1.0, [](const PassValues &pass) { return pass.rmv; }},
       {"CCV", 1, 1.0, [](const PassValues &pass) { return pass.ccv; }},
       {with_unit("k_B", "MN/m"), 1, mega, [](const PassValues &pass) { return pass.k_B; }},
       {"E_vib (MPa)", 1, mega, [](const PassValues &pass) { return pass.E_vib; }},
       {with_unit("k", "MN/m"), 1, mega, [](const PassValues &pass) { return pass.k; }},
       {"half width of the interval of k", 1, mega, [](const PassValues &pass) { return pass.k_half_width; }},
       {"k of the whole drum (MN/m)", 1, mega * width_of(results),
        [](const PassValues &pass) { return pass.k; }},
       {"D", 2, 1.0, [](const PassValues &pass) { return pass.D; }},
       {"half width of the interval of D", 2, 1.0, [](const PassValues &pass) { return pass.D_half_width; }},
       {"contact", 2, 1.0, [](const PassValues &pass) { return pass.contact_share; }},
       {with_unit("peak force", "kN"), 0, kilo, [](const PassValues &pass) { return pass.peak_force; }},
       {with_unit("traction", "kN"), 2, kilo, [](const PassValues &pass) { return pass.traction; }},
       {with_unit("exciter, per m driven", "kJ/m"), 2, kilo,
        [](const PassValues &pass) { return pass.energy_exciter; }},
       {with_unit("traction, per m driven", "kJ/m"), 2, kilo,
        [](const PassValues &pass) { return pass.energy_traction; }}});
  const bool many = several(results);
  PageTable table("passes_table",
                  many ? "Means over the runs with 95 % intervals" : "What each pass has left", "quantity",
                  1);
  for (std::size_t pass = 0; pass <= most_passes(results); ++pass)
    table.header.push_back(pass == 0 ? "before" : fmt::format("pass {}", pass));
  for (const Shown &one : shown) {
    std::vector<std::string> cells = {one.header};
    bool known = false;
    for (std::size_t pass = 0; pass <= most_passes(results); ++pass) {
      const MeanInterval mean = mean_after(results, pass, one.value);
      known = known || std::isfinite(one.scale * mean.mean);
      cells.emplace_back(no_value);
      if (!std::isfinite(one.scale * mean.mean)) continue;
      cells.back() = fmt::format("{:.{}f}", one.scale * mean.mean, one.decimals);
      if (std::isfinite(mean.half_width))
        cells.back() += fmt::format(" ± {:.{}f}", one.scale * mean.half_width, one.decimals);
    }
    if (known) table.add(std::move(cells));
  }
  std::vector<std::string> modes = {"mode of most cells"};
  for (std::size_t pass = 0; pass <= most_passes(results); ++pass) {
    const std::string mode = mode_in(results, pass);
    modes.push_back(mode.empty() ? no_value : mode);
  }
  table.add(std::move(modes));
  table.notes = {
      "Settlement, compaction and heave count from before the first pass. Compaction: the sum of h0 (1 - "
      "phi0/phi1) over the layers, of thickness h and solid fraction phi; the rest of the settlement is soil "
      "that was pushed along or aside, out of the measured part. Heave: the largest rise of the surface "
      "outside of the measured part, means over a cell.",
      "The solid fraction of a layer is that between its surfaces, each the highest point of its balls and "
      "of those below on vertical lines, so that pores above its topmost balls do not count; the inside of a "
      "layer, of which are relative density and degree of compaction, begins two mean diameters, at most a "
      "quarter of the thickness, away from them, as in.density measures. Meter values are means "
      "of cells, each of an even number of whole cycles; k and D are identified from each pass."};
  return table;
}

std::string source_words(const PassesResult &result) {
  return result.source == HarmonicSource::every_step
             ? "CMV and RMV are sums over every time step (cycles.csv), CCV is from changes of velocity "
               "between samples (bed.csv)."
             : "Harmonics are from changes of velocity between samples (bed.csv).";
}

} // namespace

std::string answer_of(const Results &results) {
  const std::size_t passes = passes_of_all(results), layer = results.front().layers() - 1;
  const auto first = [&](const Value &value) { return mean_after(results, 0, value).mean; };
  const auto last = [&](const Value &value) { return mean_after(results, passes, value).mean; };
  const MeanInterval gain = gain_of(results, layer);
  const Value phi = solid_fraction_of(layer);
  const bool gains = !std::isfinite(gain.half_width) || gain.significant();
  const std::string verb = !gains ? "change" : last(phi) < first(phi) ? "loosen" : "compact";
  std::string text = fmt::format(
      "{} {}{} the lift, {:.2f} m thick at first, from a solid fraction of {:.3f} to {:.3f} between its "
      "surfaces",
      count_words(passes, "pass", "passes"), verb, passes == 1 ? "s" : "",
      first([layer](const PassValues &pass) { return pass.soil.thickness[layer]; }), first(phi), last(phi));
  const double degree_inside = last([layer](const PassValues &pass) { return pass.degree[layer]; });
  if (std::isfinite(degree_inside)) {
    const double relative = last([layer](const PassValues &pass) { return pass.relative_density[layer]; });
    text += fmt::format(" and inside to a degree of compaction of {:.1f} % (relative density {:.0f} %{})",
                        100.0 * degree_inside, 100.0 * relative,
                        relative < 0.0 ? ", looser than the loosest packing of dry soil" : "");
  }
  text += "; " + level_words(results, layer, gains);
  const double settlement = last([](const PassValues &pass) { return pass.settlement; });
  const double compaction = last([](const PassValues &pass) { return pass.compaction; });
  const double pushed = settlement - compaction;
  text += fmt::format("; the surface {} by {:.1f} mm: all layers together {} by {:.1f} mm, and soil that is "
                      "pushed {} the measured part makes {:.1f} mm",
                      settlement < 0.0 ? "rises" : "sinks", 1e3 * std::fabs(settlement),
                      compaction < 0.0 ? "loosen" : "compact", 1e3 * std::fabs(compaction),
                      pushed < 0.0 ? "into" : "out of", 1e3 * std::fabs(pushed));
  const std::string from = several(results)
                               ? fmt::format("over {} beds", results.size())
                               : fmt::format("over {} cells of one bed, which is one sample",
                                             results.front().cells.size() / results.front().passes.size());
  if (std::isfinite(gain.half_width))
    text += fmt::format("; the gain in solid fraction is {:.4f} ± {:.4f} (95 %, {}{})", gain.mean,
                        gain.half_width, from, gain.significant() ? "" : ": not significant");
  else
    text += "; how sure that is one cell does not tell";
  return text + ".";
}

/// That moist soil loosens where the same soil dry does not; empty for dry soil (inputs/study/loosening).
std::string moist_words(const PassesResult &one) {
  for (const char *name : {"tensile_strength", "suction"}) {
    const auto noted = one.parameters.find(name);
    if (noted != one.parameters.end() && noted->second != "0" && noted->second != "unknown")
      return fmt::format(
          " The soil is moist ({} {}): in the model suction holds what has loosened; a lift of "
          "the same soil without it gains more.",
          name, noted->second);
  }
  return {};
}

/// What the densities are worth, told before them.
std::string worth_of(const Results &results) {
  std::vector<std::string> loosened;
  std::string conditions = moist_words(results.front());
  const std::size_t layers = results.front().layers();
  for (std::size_t layer = layers; layer-- > 0;) {
    const std::string name = layer + 1 == layers ? "the lift" : fmt::format("layer {}", layer + 1);
    if (const MeanInterval gain = gain_of(results, layer); gain.significant() && gain.mean < 0.0)
      loosened.push_back(name);
    const double before = mean_after(results, 0, [layer](const PassValues &pass) {
                            return pass.soil.inner_solid_fraction(layer);
                          }).mean;
    const double shaken = densest_by_shaking(results.front().parameters, layer, results.front().flat);
    if (before > shaken)
      conditions +=
          fmt::format(" Inside, {} began at a solid fraction of {:.3f}; shaking leaves at most {:.3f} "
                      "of such soil, so that it can only loosen: disregard how its density changes.",
                      name, before, shaken);
  }
  if (loosened.empty())
    return "What the densities are worth: they may be compared with those of other runs, not with a site. "
           "Dense "
           "soil of this model loosens under a roller, which that of a site does not." +
           conditions;
  return fmt::format("This result contradicts experience: {} loosened under the roller. Disregard solid "
                     "fractions, degrees of compaction and settlement; forces and meter values are those on "
                     "soil of such a density.{}",
                     fmt::join(loosened, " and "), conditions);
}

void write_passes_page(const std::filesystem::path &folder, const Results &results, const JudgedMap &judged) {
  const PassesResult &one = results.front();
  Page page(folder, "What the passes of a roller leave", Drawing::drive);
  page.answer(worth_of(results));
  page.answer(answer_of(results));
  page.answer(answer_of(judged.map, judged.rows, judged.rule));
  for (const std::string &answer : answers_on_spots(judged.map))
    page.answer(answer);
  page.answer(criteria_of(judged));
  const bool known = std::isfinite(one.passes.back().degree.back());
  if (!known)
    page.answer("The degree of compaction is not known: the run does not note e_loosest and e_shaken of its "
                "layers (beds of a wanted density do).");
  page.answer(fmt::format("The roller drove at {:.3g} m/s and shook at {:.3g} Hz; a cell of {:g} m holds "
                          "{:.3g} cycles, of which an even whole number counts. {}",
                          one.speed, one.frequency, one.cell, one.cell * one.frequency / one.speed,
                          source_words(one)));
  for (const PassesResult &result : results)
    for (const std::string &note : result.notes)
      page.answer(several(results) ? fmt::format("{}: {}", result.folder.string(), note) : note);
  page.section("The compaction curve");
  page.figure(compaction_figure(results));
  page.table(pass_table(results));
  if (several(results)) {
    PageTable runs("runs", "The runs", "folder | passes | answer of this run alone", 1);
    for (const PassesResult &result : results)
      runs.add({result.folder.string(), std::to_string(result.passes.size() - 1), answer_of({result})});
    page.table(std::move(runs));
  }
  page.section("Rules of acceptance");
  if (several(results))
    page.paragraph(fmt::format("The cells of all {} runs count together.", results.size()));
  if (judged.rows.empty()) page.paragraph(answer_of(judged.map, judged.rows, judged.rule));
  if (!judged.rows.empty()) {
    if (const auto rules = rule_figure("Fig. 2", judged, judged.map.meter != "CMV")) page.figure(*rules);
    page.table(map_table(judged));
  }
  if (const std::vector<Acceptance> criteria = criteria_of(judged); !criteria.empty())
    page.table(acceptance_table(criteria));
  page.section("Along the way");
  if (several(results))
    page.paragraph(
        fmt::format("Surface, meter, profile and animation are those of {}.", one.folder.string()));
  page.figure(surface_figure(one));
  if (!judged.rows.empty()) page.figure(map_figure("Fig. 4", judged));
  page.section("Over depth");
  page.figure(depth_figure(one));
  const bool standing = std::any_of(one.depth.begin(), one.depth.end(), [](const PassDepth &slice) {
    return slice.pass > 0 && slice.passing == 0 && slice.row.vertical;
  });
  if (standing)
    page.paragraph(
        "The run has no dumps with the roller on the measured part: the stresses are those that "
        "stay in the soil when the roller stands outside of it, not those under the passing drum.");
  if (one.animated.pass > 0) {
    page.section("A pass in motion");
    page.figure(animation_of("Fig. 6", one));
  } else {
    page.paragraph("An animation of a pass, and stresses under the passing drum, need more dumps: -var "
                   "dumps_per_pass 25.");
  }
  page.write();
}

} // namespace drumlin::post
