#include "meter/page.h"

#include "meter/along_way.h"
#include "pages/figure.h"
#include "pages/page.h"
#include "runs/parameter_file.h"
#include "support/csv.h"
#include "support/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace drumlin::post {

namespace {

/// A column of meter.csv, of the table on the page and of the terminal.
struct MeterColumn {
  const char *header; ///< with unit
  std::optional<double> (*value)(const MeterWindow &);
};

template <std::size_t order>
std::optional<double> amplitude(const MeterWindow &window) {
  return window.amplitude[order];
}

constexpr std::array<MeterColumn, 21> columns = {
    {{"begin [s]", [](const MeterWindow &w) { return std::optional(w.begin); }},
     {"end [s]", [](const MeterWindow &w) { return std::optional(w.end); }},
     {"A_0.5 [m/s2]", amplitude<0>},
     {"A_1 [m/s2]", amplitude<1>},
     {"A_1.5 [m/s2]", amplitude<2>},
     {"A_2 [m/s2]", amplitude<3>},
     {"A_2.5 [m/s2]", amplitude<4>},
     {"A_3 [m/s2]", amplitude<5>},
     {"CMV [-]", [](const MeterWindow &w) { return w.cmv; }},
     {"CMV_bound [-]",
      [](const MeterWindow &w) { return w.cmv ? std::optional(w.cmv_bound) : std::nullopt; }},
     {"RMV [-]", [](const MeterWindow &w) { return w.rmv; }},
     {"RMV_bound [-]",
      [](const MeterWindow &w) { return w.rmv ? std::optional(w.rmv_bound) : std::nullopt; }},
     {"CCV [-]", [](const MeterWindow &w) { return w.ccv; }},
     {"CCV_bound [-]",
      [](const MeterWindow &w) { return w.ccv ? std::optional(w.ccv_bound) : std::nullopt; }},
     {"contact_share [-]", [](const MeterWindow &w) { return w.contact_share; }},
     {"peak_force [N]", [](const MeterWindow &w) { return w.peak_force; }},
     {"energy_two_cycles [J]", [](const MeterWindow &w) { return w.energy; }},
     {"k_B [N/m]", [](const MeterWindow &w) { return w.k_B; }},
     {"k_1 [N/m]", [](const MeterWindow &w) { return w.k_1; }},
     {"c_1 [N s/m]", [](const MeterWindow &w) { return w.c_1; }},
     {"E_vib [Pa]", [](const MeterWindow &w) { return w.E_vib; }}}};

const char *mode_name(const MeterWindow &window) { return mode_names[static_cast<std::size_t>(window.mode)]; }

/// Whether stiffnesses of a window are the soil's; in other modes they are apparent.
bool stiffness_valid(const MeterWindow &window) { return window.mode == OperatingMode::continuous_contact; }

/// Whether a force is known that does not tell whether the drum loses contact.
bool just_touches(const MeterWindow &window) { return window.peak_force && !window.contact_share; }

/// What the stiffnesses of a window are of.
std::string stiffness_words(const MeterWindow &window) {
  if (!stiffness_valid(window)) return "apparent";
  return window.k_1 ? "k_1 of the soil, k_B of soil and frame" : "k_B of soil and frame";
}

constexpr const char *touching_words =
    "The drum just touches: accelerations do not tell whether its contact is just lost or just kept";

/// A value that sums over every step do not give is left out.
bool is_given(const MeterResult &result, std::size_t column) {
  constexpr std::array<std::size_t, 3> of_samples = {4, 6, 7}; // CCV has no value then
  return result.cycles.source != HarmonicSource::every_step ||
         std::find(of_samples.begin(), of_samples.end(), column) == of_samples.end();
}

std::string text_of(std::optional<double> value, const char *format, double scale = 1.0) {
  return value && std::isfinite(*value) ? fmt::format(fmt::runtime(format), scale * *value) : no_value;
}

PageTable value_table(const MeterResult &result) {
  PageTable table("windows", "Values over each window",
                  "mode | begin (s) | CMV (-) | off by at most (-) | RMV (-) | CCV (-) | share of contact "
                  "(-) | peak force (kN) | energy in two cycles (J) | k_B: soil and frame (MN/m) | k_1: "
                  "without the frame (MN/m) | c_1 (kN s/m) | E_vib (MPa)");
  for (const MeterWindow &w : result.windows)
    table.add({mode_name(w), fmt::format("{:.4g}", w.begin), text_of(w.cmv, "{:.2f}"),
               result.cycles.source == HarmonicSource::every_step ? no_value : text_of(w.cmv_bound, "{:.2g}"),
               text_of(w.rmv, "{:.2f}"), text_of(w.ccv, "{:.2f}"), text_of(w.contact_share, "{:.3f}"),
               text_of(w.peak_force, "{:.1f}", 1e-3), text_of(w.energy, "{:.1f}"),
               text_of(w.k_B, "{:.2f}", 1e-6), text_of(w.k_1, "{:.2f}", 1e-6), text_of(w.c_1, "{:.1f}", 1e-3),
               text_of(w.E_vib, "{:.1f}", 1e-6)});
  table.notes = {source_words(result),
                 "In continuous contact k_1 and c_1 are the soil's, and k_B contains "
                 "the force of the frame, too; in other modes they are apparent values. " +
                     std::string(no_value) + ": the record does not give it."};
  if (const std::string words = width_words(result); !words.empty()) table.notes.push_back(words);
  return table;
}

PageTable formula_table(const MeterResult &result) {
  PageTable table("formulas", "What the values are", "value | formula | valid for | source", 4);
  table.add({"A_n", "amplitude of the drum's acceleration at n times the excitation frequency",
             "whole cycles; an even number of them for half orders", "definition"});
  table.add({"CMV", "300 A_2 / A_1", "one roller at one setting; falls again when the drum double jumps",
             "Advances in Civil Engineering 2011, 783836"});
  table.add({"RMV", fmt::format("{:g} A_0.5 / A_1", result.options.rmv_constant),
             "shows double jump; sources have 100 or 300 as constant", "as CMV"});
  table.add({"CCV", "100 (A_0.5 + A_1.5 + A_2 + A_2.5 + A_3) / (A_0.5 + A_1)",
             "as CMV; rollers of Sakai; not from sums over every step",
             "NCHRP Report 676 (2010) as others quote it; not read"});
  table.add({"energy in two cycles", "-2 x mean of the integral of F dx over a cycle",
             "any mode; the quantity behind Omega, without the scale of that meter", "definition"});
  table.add({"k_B", "omega^2 (m_d + m_e r_e cos(phi) / A_z)",
             "continuous contact; contains the force of the frame", "equation of motion of the drum"});
  table.add(
      {"k_1, c_1",
       "-F/x at the excitation frequency, the frame's force counted: real part, imaginary part over omega",
       "continuous contact on a linear soil", "equations of motion of drum and frame"});
  table.add({"E_vib", "z = (1 - nu^2)/E F/L 2/pi (1.8864 + ln(L/B)), B = sqrt(16/pi R (1 - nu^2)/E F/L)",
             "a homogeneous half-space, contact longer than wide", "Lundberg's line contact"});
  table.add({"mode",
             fmt::format("harmonics of successive cycles equal to {:g} of their size", result.options.same),
             "rocking is not seen", "Adam 1996, in Acta Geotechnica 2024, 10.1007/s11440-024-02342-8"});
  return table;
}

/// A panel of values over time.
Panel value_panel(const std::string &name, const std::string &title, const std::string &label, int column) {
  Panel panel{title, "time [s]", label, {}};
  panel.y_range = "[0:*]";
  panel.tight_x = true;
  panel.curves = {curve(name, "window", "$2", fmt::format("{}", column), CurveStyle::series_1)};
  panel.curves.back().title.clear();
  return panel;
}

PageFigure values_figure(const MeterResult &result) {
  const std::string name = "values";
  PageFigure figure =
      page_figure("Fig. 1", "Values along the record, each point a window, drawn at its middle.",
                  {name, "Values along the record", {}, 2}, 1.0);
  CurveTable table("time [s],CMV [-],RMV [-],peak force [kN],energy in two cycles [J]");
  const double none = std::nan("");
  for (const MeterWindow &w : result.windows)
    table.row("window", {0.5 * (w.begin + w.end), w.cmv.value_or(none), w.rmv.value_or(none),
                         1e-3 * w.peak_force.value_or(none), w.energy.value_or(none)});
  figure.csv = table.text();
  const MeterWindow &last = result.windows.back();
  figure.figure.panels = {value_panel(name, "CMV", "CMV [-]", 3), value_panel(name, "RMV", "RMV [-]", 4)};
  if (last.peak_force)
    figure.figure.panels.push_back(value_panel(name, "Peak force", "contact force [kN]", 5));
  if (last.energy) figure.figure.panels.push_back(value_panel(name, "Energy", "energy in two cycles [J]", 6));
  return figure;
}

std::optional<PageFigure> spectrum_figure(const MeterResult &result) {
  const MeterWindow &last = result.windows.back();
  const std::vector<SpectrumLine> lines = spectrum(result.record, last.begin, last.end);
  if (lines.empty()) return std::nullopt;
  const std::string name = "spectrum";
  PageFigure figure;
  figure.label = "Fig. 2";
  figure.weight = 0.8;
  figure.caption =
      fmt::format("Amplitudes of the drum's acceleration in the last window. The excitation has {:.4g} Hz.",
                  1.0 / result.record.period());
  CurveTable table("frequency [Hz],amplitude [m/s2]");
  for (const SpectrumLine &line : lines) {
    table.row("spectrum", {line.frequency, 0.0});
    table.row("spectrum", {line.frequency, line.amplitude});
    table.row("spectrum", {line.frequency, 0.0});
  }
  figure.csv = table.text();
  Panel panel{
      "", "frequency [Hz]", "amplitude [m/s^2]", {curve(name, "spectrum", "$2", "3", CurveStyle::plain)}};
  panel.curves.back().title.clear();
  panel.tight_x = true;
  figure.figure = {name, "Spectrum", {panel}, 1};
  return figure;
}

std::optional<PageFigure> loop_figure(const MeterResult &result) {
  const std::vector<double> force = soil_force(result.record);
  const std::vector<double> &x = result.record.x_drum;
  if (force.empty() || x.empty()) return std::nullopt;
  const std::string name = "loop";
  PageFigure figure;
  figure.label = "Fig. 3";
  figure.weight = 0.9;
  figure.caption =
      "Contact force over the drum's displacement downwards in the last two cycles of the last window.";
  CurveTable table("displacement down [mm],contact force [kN]");
  const MeterWindow &last = result.windows.back();
  for (std::size_t i = 0; i < x.size(); ++i)
    if (result.record.time[i] >= last.end - 2.0 * result.record.period() && result.record.time[i] <= last.end)
      table.row("loop", {-1e3 * x[i], 1e-3 * force[i]});
  figure.csv = table.text();
  Panel panel{"",
              "displacement down [mm]",
              "contact force [kN]",
              {curve(name, "loop", "$2", "3", CurveStyle::condition_b)}};
  panel.curves.back().title.clear();
  figure.figure = {name, "Loop", {panel}, 1};
  return figure;
}

} // namespace

std::string meter_csv(const MeterResult &result) {
  std::vector<std::string> header;
  header.reserve(columns.size() + 2);
  for (const MeterColumn &column : columns)
    header.emplace_back(column.header);
  header.insert(header.end(), {"mode", "stiffness"});
  const bool drives = !result.record.s.empty();
  if (drives) header.insert(header.end(), {"s_begin [m]", "s_end [m]", "pass"});
  if (result.ends)
    header.insert(header.end(), {"k_1_left_end [N/m]", "k_1_right_end [N/m]", "k_1_left_half [N/m]",
                                 "k_1_right_half [N/m]", "c_1_left_half [N s/m]", "c_1_right_half [N s/m]"});
  std::string text = csv_line(header);
  for (std::size_t n = 0; n < result.windows.size(); ++n) {
    const MeterWindow &window = result.windows[n];
    std::vector<std::string> cells;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::optional<double> value = columns[i].value(window);
      cells.push_back(value && std::isfinite(*value) && is_given(result, i) ? number_text(*value) : "");
    }
    cells.insert(cells.end(), {mode_name(window), stiffness_words(window)});
    if (drives)
      cells.insert(cells.end(), {number_text(window.from.value_or(NAN)), number_text(window.to.value_or(NAN)),
                                 std::to_string(window.pass)});
    const auto add = [&cells, n](const auto &sides, std::optional<double> MeterWindow::*value) {
      for (const std::vector<MeterWindow> &side : sides) {
        const std::optional<double> found = n < side.size() ? side[n].*value : std::nullopt;
        cells.push_back(found ? number_text(*found) : std::string());
      }
    };
    if (result.ends) {
      add(result.ends->at_end, &MeterWindow::k_1);
      add(result.ends->halves, &MeterWindow::k_1);
      add(result.ends->halves, &MeterWindow::c_1);
    }
    text += csv_line(cells);
  }
  return text;
}

std::string source_words(const MeterResult &result) {
  const MeterWindow &last = result.windows.back();
  const std::string off =
      std::isfinite(last.cmv_bound)
          ? fmt::format("CMV of the last window may be off by {:.2g}, RMV by {:.2g}", last.cmv_bound,
                        last.rmv_bound)
          : std::string(result.cycles.filtered ? "how far they may be off is not known behind a filter"
                                               : "they have no bound with so few samples");
  switch (result.cycles.source) {
  case HarmonicSource::every_step:
    return "Harmonics are sums over every time step (cycles.csv).";
  case HarmonicSource::velocity:
    return fmt::format("Harmonics are from changes of velocity between samples: {}.", off);
  case HarmonicSource::acceleration:
    break;
  }
  return fmt::format(
      "Harmonics are from samples of acceleration; a jump may lie anywhere between two of them: {}.", off);
}

std::string averaging_words(const MeterResult &result) {
  const MeterWindow &last = result.windows.back();
  std::optional<std::pair<double, double>> soil;
  if (last.k_1 && last.c_1 && *last.k_1 > 0.0) soil.emplace(*last.k_1, *last.c_1);
  return averaging_words(result.record, last.begin, last.end, soil);
}

std::string width_words(const MeterResult &result) {
  const std::optional<double> thickness = result.cycles.thickness;
  const MeterOptions &options = result.options;
  const bool modulus = options.drum_radius && options.drum_width;
  if (!thickness)
    return modulus ? fmt::format("E_vib: the forces are those of the whole drum, {:g} m wide.",
                                 *options.drum_width)
                   : "";
  if (std::isnan(*thickness))
    return "The thickness of the bed is not noted: E_vib is left out; forces, energy and stiffnesses are "
           "those of the bed.";
  std::string words =
      fmt::format("Forces, energy and stiffnesses are those of {:g} m of the drum", *thickness);
  if (modulus)
    words += fmt::format("; for E_vib the force is that of the whole drum, {:g} m wide", *options.drum_width);
  return words + ".";
}

std::vector<std::string> reading_words(const Record &record) {
  std::vector<std::string> words = record.notes;
  for (std::size_t i = 0; i < record.pieces.size() && record.pieces.size() > 1; ++i)
    words.push_back(fmt::format("piece {}: {:.6g} to {:.6g} s, {} samples", i + 1, record.pieces[i].begin,
                                record.pieces[i].end, record.pieces[i].samples));
  if (!record.time.empty())
    words.push_back(fmt::format("{} samples, {:.6g} per second, {:.6g} s", record.size(),
                                1.0 / record.interval, record.time.back() - record.time.front()));
  return words;
}

void write_reading_page(const std::filesystem::path &folder, const Record &record) {
  Page page(folder, "What was read", std::nullopt);
  for (const std::string &line : reading_words(record))
    page.answer(line + ".");
  const std::string name = "first_second";
  PageFigure figure = page_figure("Fig. 1", "The first second of the signals that were read, in SI units.",
                                  {name, "First second", {}, 1}, 1.0);
  CurveTable table("time [s],value [SI]");
  for (const HistoryColumn &column : history_columns) {
    const std::vector<double> &values = record.*column.values;
    if (column.derivative <= time_column || values.empty()) continue; // neither a motion nor a force
    constexpr std::array<std::pair<const char *, const char *>, 3> of_motion = {
        {{"position", "m"}, {"velocity", "m/s"}, {"acceleration", "m/s^2"}}};
    const std::string part = std::string(column.name).substr(2); // x_drum: drum
    Panel panel;
    panel.x_label = "time [s]";
    if (column.derivative == force_column) {
      panel.y_label = part + " force [N]";
    } else {
      const auto &[word, unit] = of_motion[static_cast<std::size_t>(column.derivative)];
      panel.y_label = fmt::format("{} of the {} [{}]", word, part, unit);
    }
    panel.tight_x = true;
    panel.curves = {curve(name, column.name, "$2", "3", CurveStyle::plain)};
    panel.curves.back().title.clear();
    figure.figure.panels.push_back(panel);
    for (std::size_t i = 0; i < record.size() && record.time[i] <= record.time.front() + 1.0; ++i)
      table.row(column.name, {record.time[i], values[i]});
  }
  figure.csv = table.text();
  page.figure(figure);
  page.write();
}

std::string answer_line(const MeterResult &result) {
  const MeterWindow &w = result.windows.back();
  std::string text =
      fmt::format("{}, CMV {}, RMV {}", mode_name(w), text_of(w.cmv, "{:.2f}"), text_of(w.rmv, "{:.2f}"));
  if (w.ccv) text += fmt::format(", CCV {:.2f}", *w.ccv);
  const char *apparent = stiffness_valid(w) ? "" : "apparent ";
  if (w.k_B) text += fmt::format(", {}k_B {:.2f} MN/m (soil and frame)", apparent, 1e-6 * *w.k_B);
  if (w.k_1) text += fmt::format(", {}k_1 {:.2f} MN/m (without the frame)", apparent, 1e-6 * *w.k_1);
  if (w.E_vib) text += fmt::format(", E_vib {:.1f} MPa", 1e-6 * *w.E_vib);
  if (w.energy) text += fmt::format(", {:.1f} J in two cycles", *w.energy);
  if (just_touches(w)) text += ". " + std::string(touching_words);
  return text;
}

void write_meter_page(const std::filesystem::path &folder, const MeterResult &result) {
  const bool bed = result.record.file.filename() == "bed.csv";
  Page page(folder, "What the roller's meter shows", bed ? Drawing::bed : Drawing::chain);
  const MeterWindow &last = result.windows.back();
  page.answer(fmt::format("In the last {} cycles, at {:.4g} Hz: {}.", result.options.window,
                          result.cycles.omega / (2.0 * pi), answer_line(result)));
  if (!result.record.part_read.empty()) page.answer("Of the file " + result.record.part_read + ".");
  if (const std::string words = roller_words(result.record.parameters); !words.empty()) page.answer(words);
  page.answer(source_words(result));
  for (const std::string &words : {width_words(result), averaging_words(result)})
    if (!words.empty()) page.answer(words);
  if (result.ends)
    for (const std::string &line : answer_lines(*result.ends, result.windows.back()))
      page.answer(line);
  if (!stiffness_valid(last) && last.k_B && !just_touches(last))
    page.answer(
        "The drum does not stay in contact, or its contact is not known: the stiffnesses are apparent.");
  if (result.cycles.computed_force)
    page.answer("The contact force is computed from the accelerations of drum and frame.");
  page.section("Values along the record");
  page.figure(values_figure(result));
  page.table(value_table(result));
  page.section("The last window");
  if (const auto figure = spectrum_figure(result)) page.figure(*figure);
  if (const auto figure = loop_figure(result)) page.figure(*figure);
  page.section("Formulas");
  page.table(formula_table(result));
  page.write();
}

} // namespace drumlin::post
