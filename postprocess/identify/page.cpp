#include "identify/page.h"

#include "pages/figure.h"
#include "pages/page.h"
#include "support/units.h"
#include "support/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace drumlin::post {

namespace {

// A value with its interval in a unit, with two digits of the half width, but not more decimals than anyone
// needs; the half width is then rounded up.
std::string with_interval(const MeanInterval &value, double unit) {
  if (!std::isfinite(value.mean)) return no_value;
  const double mean = value.mean / unit;
  const double half = value.half_width / unit;
  if (!(half > 0.0) || !std::isfinite(half)) return fmt::format("{:.6g} +- {:.2g}", mean, half);
  constexpr int most_decimals = 4, most_digits = 6;
  const auto power = [](double size) { return static_cast<int>(std::floor(std::log10(size))); };
  const int most = std::clamp(most_digits - 1 - power(std::max(std::fabs(mean), half)), 0, most_decimals);
  const int decimals = std::clamp(1 - power(half), 0, most);
  const double shown =
      1 - power(half) > most ? std::ceil(half * std::pow(10.0, most)) / std::pow(10.0, most) : half;
  return fmt::format("{:.{}f} +- {:.{}f}", mean, decimals, shown, decimals);
}

/// The same with the part of the machine's tolerances, if there are any.
std::string with_machine(const MeanInterval &value, const std::optional<MachinePart> &parts,
                         double MachinePart::*part, double unit, const char *unit_name) {
  std::string text = with_interval(value, unit) + unit_name;
  if (parts)
    text +=
        fmt::format(" by noise, +- {:.2g}{} by the machine's tolerances", (*parts).*part / unit, unit_name);
  return text;
}

bool has_flights(const Identification &found) {
  return std::any_of(found.pieces.begin(), found.pieces.end(),
                     [](const ContactPiece &piece) { return !piece.flight.empty(); });
}

std::string pull_sentence(const Identification &found) {
  const std::string tension = fmt::format("{:.3g} kN", found.tension / 1e3);
  if (found.pull == Pull::pulls)
    return fmt::format("The contact pulls (transition A): tension up to {} is measured.", tension);
  if (found.pull == Pull::does_not_pull)
    return fmt::format(
        "The contact does not pull (transition B): under A it would, with {} before each break.", tension);
  return has_flights(found) ? "Whether the contact can pull cannot be told: the tension under A would be too "
                              "small or too short to be seen."
                            : "Whether the contact can pull cannot be told: contact is not lost.";
}

// Whether nothing in the record tells the phase, so that its uncertainty decides over that of k and c.
bool phase_decides(const IdentifiedRecord &record) {
  return !record.phase_known && !has_flights(record.whole) && !(record.positions && record.known_origin);
}

std::string source_sentence(const IdentifiedRecord &record) {
  if (record.motion)
    return fmt::format(
        "From the whole motion of drum and frame: one that is computed with these values stays with the "
        "record for {:.4g} cycles, but for {:.2g} m/s2 (RMS) of the drum's acceleration, {}; the bond has "
        "{:.4g} MN/m and {:.4g} kN s/m{}.",
        record.motion->cycles, record.motion->residual,
        record.motion->is_noise ? "the noise of the sensor"
                                : "more than the noise of the sensor: soil or machine are not quite those of "
                                  "the equations, and the intervals are wider for it",
        record.motion->bond_stiffness / 1e6, record.motion->bond_damping / 1e3,
        record.frame_computed ? ", and the frame, which no sensor measures, follows from it" : "");
  std::string text = record.positions ? "From accelerations, position and velocity of the drum"
                                      : "From accelerations alone, integrated over each contact";
  if (record.positions)
    text += record.known_origin ? "; x_drum = 0 is where drum and soil just touch."
                                : "; where drum and soil just touch is unknown and found for each contact.";
  else
    text += ".";
  if (record.left)
    text += fmt::format(
        " Drum, frame, bond and a soil of constant k and c do not follow the whole motion: {:.2g} % "
        "of the drum's acceleration are left, which the intervals do not contain, but for what such a motion "
        "would say instead.",
        100.0 * *record.left);
  if (record.frame_computed)
    text += " The acceleration of the frame is computed from that of the drum through the bond.";
  else if (!record.frame)
    text += " No acceleration of the frame: it counts as zero.";
  return text;
}

/// Which k to report where windows say another one: they follow single contacts.
std::string report_sentence(const IdentifiedRecord &record) {
  double sum = 0.0, count = 0.0;
  for (const LawWindow &window : record.windows)
    if (window.law) {
      sum += window.law->k.mean;
      count += 1.0;
    }
  if (!record.motion || count == 0.0) return {};
  const double of_windows = sum / count, off = of_windows / record.whole.law.k.mean - 1.0;
  constexpr double told = 0.01;
  return "Report these values, of the whole record." +
         (std::fabs(off) < told
              ? std::string()
              : fmt::format(
                    " Its windows, which follow single contacts, have k = {:.4g} MN/m in the mean, {:+.1f} "
                    "%; a low-pass of the logger, even a mild one, makes such a difference "
                    "(--logger-low-pass).",
                    of_windows / 1e6, 100.0 * off));
}

struct Row {
  std::string name;
  double begin, end;
  const LawEstimate *law;
};

std::vector<Row> rows_of(const IdentifiedRecord &record) {
  std::vector<Row> rows = {{"all", record.time.front(), record.time.back(), &record.whole.law}};
  for (const LawWindow &window : record.windows)
    rows.push_back({fmt::format("{}", window.first_cycle), window.begin, window.end,
                    window.law ? &*window.law : nullptr});
  return rows;
}

PageTable window_table(const IdentifiedRecord &record) {
  PageTable table("windows", "Law of the contact, 95 % confidence intervals",
                  "from cycle | time (s) | k (MN/m) | c (kN s/m) | D (-) | R2 (-) | share in contact (-) | "
                  "contacts or cycles of them | phase error (degrees)");
  for (const Row &row : rows_of(record)) {
    const std::string time = fmt::format("{:.4g} to {:.4g}", row.begin, row.end);
    if (row.law == nullptr) {
      table.add({row.name, time, no_value, no_value, no_value, no_value, no_value, no_value, no_value});
      continue;
    }
    const LawEstimate &law = *row.law;
    table.add({row.name, time, with_interval(law.k, 1e6), with_interval(law.c, 1e3),
               with_interval(law.D, 1.0), fmt::format("{:.5f}", law.r2),
               fmt::format("{:.3f}", law.contact_share), fmt::format("{}", law.blocks),
               with_interval(law.phase, 1.0 / degrees_per_radian)});
  }
  for (const LawWindow &window : record.windows)
    if (!window.law)
      table.notes.push_back(fmt::format("From cycle {}: {}.", window.first_cycle, window.why_not));
  return table;
}

// The last cycles of the record.
SampleRun shown_samples(const IdentifiedRecord &record) {
  constexpr double cycles = 4.0;
  const auto count = std::min(record.time.size(), static_cast<std::size_t>(cycles * record.per_cycle));
  return {record.time.size() - count, record.time.size()};
}

PageFigure loop_figure(const IdentifiedRecord &record) {
  const std::string name = "loop";
  PageFigure figure;
  figure.label = "Fig. 1";
  figure.weight = 2.0;
  figure.caption =
      "Contact force over the position of the drum and over time in the last four cycles: force from the "
      "equations of motion, and law that was fitted to it. The position is the fitted motion.";
  if (!record.positions || !record.known_origin)
    figure.caption += " Its origin was found for each contact: the law has no force at rest there.";
  figure.figure = {name, "Contact force and fitted law", {}, 2};
  CurveTable table("time (s),drum position (mm),contact force (kN)");
  const Identification &found = record.whole;
  const SampleRun shown = shown_samples(record);
  for (std::size_t i = shown.first; i < shown.end; ++i)
    table.row("equations of motion", {record.time[i], 1e3 * found.x[i], found.force[i] / 1e3});
  for (std::size_t i = shown.first; i < shown.end; ++i) {
    if (std::isnan(found.fitted[i]))
      table.row("no contact", {record.time[i], 0.0, 0.0}); // a row of another curve ends the line
    else
      table.row("fitted law", {record.time[i], 1e3 * found.x[i], found.fitted[i] / 1e3});
  }
  Panel loop{"Loop",
             "drum position (mm)",
             "contact force (kN)",
             {curve(name, "fitted law", "$3", "4", CurveStyle::condition_a),
              curve(name, "equations of motion", "$3", "4", CurveStyle::dots_up)}};
  Panel history{"History", "time (s)", "contact force (kN)", {}};
  history.tight_x = true;
  history.curves = {curve(name, "fitted law", "$2", "4", CurveStyle::condition_a),
                    curve(name, "equations of motion", "$2", "4", CurveStyle::dots_up)};
  figure.figure.panels = {loop, history};
  figure.csv = table.text();
  return figure;
}

PageFigure residual_figure(const IdentifiedRecord &record) {
  const std::string name = "residuals";
  PageFigure figure =
      page_figure("Fig. 2",
                  "Force from the equations of motion minus that of the law, in contact, over the phase of "
                  "the excitation. A pattern means that the law does not describe the contact.",
                  {name, "Residuals", {}, 1});
  CurveTable table("cycles,residual (kN)");
  const Identification &found = record.whole;
  constexpr std::size_t most_points = 20000;
  const std::size_t stride = 1 + found.force.size() / most_points;
  for (std::size_t i = 0; i < found.force.size(); i += stride) {
    if (std::isnan(found.fitted[i])) continue;
    const double cycles = record.time[i] * record.frequency;
    table.row("residual", {cycles - std::floor(cycles), (found.force[i] - found.fitted[i]) / 1e3});
  }
  Panel panel{"",
              "time in the cycle over its length (-)",
              "residual (kN)",
              {curve(name, "residual", "$2", "3", CurveStyle::dots_up)}};
  panel.curves.back().title.clear();
  figure.figure.panels = {panel};
  figure.csv = table.text();
  return figure;
}

PageFigure window_figure(const IdentifiedRecord &record) {
  const std::string name = "along";
  PageFigure figure = page_figure(
      "Fig. 3",
      "Stiffness and damping ratio of the windows, with 95 % confidence intervals, along the record.",
      {name, "Along the record", {}, 2}, 1.0);
  CurveTable table("time (s),value,low,high");
  const auto add = [&](const char *curve_name, double time, const MeanInterval &value, double unit) {
    table.row(curve_name, {time, value.mean / unit, (value.mean - value.half_width) / unit,
                           (value.mean + value.half_width) / unit});
  };
  for (const LawWindow &window : record.windows)
    if (window.law) {
      const double time = 0.5 * (window.begin + window.end);
      add("k", time, window.law->k, 1e6);
      add("D", time, window.law->D, 1.0);
    }
  const auto panel = [&](const char *curve_name, const char *label, MeanInterval LawEstimate::*value,
                         double unit) {
    Panel one{"", "time (s)", label, {curve(name, curve_name, "$2", "3:4:5", CurveStyle::spread)}};
    one.curves.back().title.clear();
    double low = 0.0;
    double high = 0.0;
    for (const LawWindow &window : record.windows) {
      if (!window.law || !std::isfinite(((*window.law).*value).mean)) continue;
      const MeanInterval &shown = (*window.law).*value;
      low = std::min(low, (shown.mean - shown.half_width) / unit);
      high = std::max(high, (shown.mean + shown.half_width) / unit);
    }
    constexpr double margin = 1.1;
    one.y_range = axis_range(margin * low, margin * high);
    return one;
  };
  figure.figure.panels = {panel("k", "stiffness k (MN/m)", &LawEstimate::k, 1e6),
                          panel("D", "damping ratio D (-)", &LawEstimate::D, 1.0)};
  figure.csv = table.text();
  return figure;
}

} // namespace

std::vector<std::string> identification_answer(const IdentifiedRecord &record) {
  const LawEstimate &law = record.whole.law;
  const auto value = [&record](const char *name, const MeanInterval &interval, double unit,
                               double MachinePart::*machine, const char *unit_name) {
    return fmt::format("{} = {}", name, with_machine(interval, record.machine, machine, unit, unit_name));
  };
  std::vector<std::string> lines = {
      value("k", law.k, 1e6, &MachinePart::k, " MN/m"),
      value("c", law.c, 1e3, &MachinePart::c, " kN s/m"),
      value("D", law.D, 1.0, &MachinePart::D, ""),
      pull_sentence(record.whole),
      fmt::format("R2 = {:.6f}; RMS residual of the force {:.3g} kN; {} samples in contact, {:.1f} % of all; "
                  "{} contacts or cycles of them.",
                  law.r2, law.force_noise / 1e3, law.samples, 100.0 * law.contact_share, law.blocks),
      record.phase_known ? std::string("The exciter's phase counts as exact.")
                         : fmt::format("Error of the exciter's phase: {} degrees.",
                                       with_interval(law.phase, 1.0 / degrees_per_radian)),
      source_sentence(record)};
  if (const std::string report = report_sentence(record); !report.empty()) lines.push_back(report);
  if (phase_decides(record))
    lines.emplace_back(
        "Contact is not lost and no position from the point of first contact is known: an error of the phase "
        "acts on the force as k and c do, and makes most of their intervals. A phase known better, or "
        "stiffer soil, on which the drum lifts off, narrows them.");
  if (record.k_B && record.k_1)
    lines.push_back(fmt::format("A meter would show k_B = {:.4g} MN/m, without the frame's force {:.4g} "
                                "MN/m: the soil's stiffness in unbroken contact only.",
                                *record.k_B / 1e6, *record.k_1 / 1e6));
  if (record.force_difference >= 0.0)
    lines.push_back(fmt::format("The force differs from F_contact of the record by {:.1e} of its RMS.",
                                record.force_difference));
  return lines;
}

std::string identification_csv(const IdentifiedRecord &record) {
  std::vector<std::string> header = {"window",
                                     "begin [s]",
                                     "end [s]",
                                     "k [N/m]",
                                     "k_half_width [N/m]",
                                     "c [N s/m]",
                                     "c_half_width [N s/m]",
                                     "D [-]",
                                     "D_half_width [-]",
                                     "phase_error [rad]",
                                     "phase_half_width [rad]",
                                     "R2 [-]",
                                     "residual [N]",
                                     "contact_share [-]",
                                     "contacts",
                                     "samples",
                                     "pulls",
                                     "k_machine [N/m]",
                                     "c_machine [N s/m]",
                                     "D_machine [-]"};
  if (!record.s.empty()) header.insert(header.end(), {"s_begin [m]", "s_end [m]"});
  std::string text = csv_line(header);
  const auto cell = [](double value) { return std::isfinite(value) ? number_text(value) : std::string(); };
  for (const Row &row : rows_of(record)) {
    std::vector<std::string> cells = {row.name, cell(row.begin), cell(row.end)};
    if (row.law != nullptr) {
      const LawEstimate &law = *row.law;
      for (const MeanInterval &value : {law.k, law.c, law.D, law.phase}) {
        cells.push_back(cell(value.mean));
        cells.push_back(cell(value.half_width));
      }
      for (const double value : {law.r2, law.force_noise, law.contact_share})
        cells.push_back(cell(value));
      cells.push_back(fmt::format("{}", law.blocks));
      cells.push_back(fmt::format("{}", law.samples));
    } else {
      constexpr std::size_t missing = 13;
      cells.resize(cells.size() + missing);
    }
    const Pull pull = record.whole.pull;
    cells.emplace_back(row.name != "all"             ? ""
                       : pull == Pull::pulls         ? "yes"
                       : pull == Pull::does_not_pull ? "no"
                                                     : "cannot be told");
    for (const auto part : {&MachinePart::k, &MachinePart::c, &MachinePart::D})
      cells.push_back(row.name == "all" && record.machine ? cell((*record.machine).*part) : "");
    if (!record.s.empty())
      for (const double time : {row.begin, row.end}) {
        const double at = std::round((time - record.time.front()) * record.frequency * record.per_cycle);
        cells.push_back(cell(record.s[static_cast<std::size_t>(
            std::clamp(at, 0.0, static_cast<double>(record.s.size() - 1)))]));
      }
    text += csv_line(cells);
  }
  return text;
}

void write_identification_page(const std::filesystem::path &out, const IdentifiedRecord &record,
                               const LumpedComparison *compared, const std::string &roller) {
  const bool bed = record.file.filename() == "bed.csv";
  Page page(out, "What the record says of the soil", bed ? Drawing::bed : Drawing::chain);
  page.answer(
      fmt::format("{}, {:.4g} cycles at {:.4g} Hz.", record.file.string(), record.cycles, record.frequency));
  if (!record.part_read.empty()) page.answer("Of the file " + record.part_read + ".");
  if (!roller.empty()) page.answer(roller);
  for (const std::string &line : identification_answer(record))
    page.answer(line.back() == '.' ? line : line + ".");
  page.section("Law of the contact");
  page.table(window_table(record));
  page.figure(loop_figure(record));
  page.section("Residuals");
  page.figure(residual_figure(record));
  if (!record.windows.empty()) {
    page.section("Along the record");
    page.figure(window_figure(record));
  }
  if (compared != nullptr) {
    page.section("Chain and record");
    add_lumped_comparison(page, {*compared}, 4);
  }
  page.section("Method");
  page.paragraph(
      "The contact force follows from the equations of motion, F = m2 a2 + m3 a3 + (m2 + m3) g + Fe. While "
      "drum and soil touch, the law is F = -k x - c v, with x and v the integrals of the measured "
      "acceleration from the start of each contact and their two integration constants as unknowns. k, c, "
      "the phase of the exciter and these constants minimize the squared residuals of force, position and "
      "velocity together, each weighted by its own scatter. Confidence intervals allow any correlation of "
      "the residuals within a contact (or a cycle of one that lasts longer). They cover scatter and the "
      "phase, not what the law leaves out: a pattern in the residuals shows that. Where the equations of "
      "motion of drum, frame, bond and soil follow a measured record, k and c of all of it are those of this "
      "motion, with the intervals of its noise; windows, loop and residuals are those of single contacts.");
  page.write();
}

namespace {

PageTable half_table(const TwoSidedRecord &record) {
  PageTable table("halves", "Soil below each half of the drum, 95 % confidence intervals",
                  "half | k (MN/m) | c (kN s/m) | D (-) | share in contact (-)");
  for (std::size_t half = 0; half < half_names.size(); ++half) {
    const HalfLaw &law = record.halves[half];
    table.add({half_names[half], with_interval(law.k, 1e6), with_interval(law.c, 1e3),
               with_interval(law.D, 1.0), fmt::format("{:.3f}", law.contact_share)});
  }
  table.add({"both", with_interval(record.k, 1e6), no_value, no_value, no_value});
  table.add({"left over right (-)", with_interval(record.ratio, 1.0), no_value, no_value, no_value});
  return table;
}

PageFigure half_loops(const TwoSidedRecord &record) {
  const std::string name = "halves";
  PageFigure figure =
      page_figure("Fig. 1",
                  "Force of the soil on each half, from the equations of motion, over the position of the "
                  "drum there, in the contacts of the record's last part. The origin was found for each "
                  "contact.",
                  {name, "Force below each half", {}, 2}, 1.5);
  CurveTable table("drum position (mm),contact force (kN)");
  Panel panel{"", "drum position (mm)", "contact force (kN)", {}};
  for (std::size_t half = 0; half < half_names.size(); ++half) {
    const Identification &found = record.halves[half].contact;
    constexpr std::size_t most = 400;
    for (std::size_t i = found.x.size() - std::min(most, found.x.size()); i < found.x.size(); ++i)
      if (std::isfinite(found.x[i])) table.row(half_names[half], {1e3 * found.x[i], 1e-3 * found.force[i]});
    panel.curves.push_back(
        curve(name, half_names[half], "$2", "3", half == 0 ? CurveStyle::dots_up : CurveStyle::dots_down));
  }
  figure.figure.panels = {panel};
  figure.csv = table.text();
  return figure;
}

} // namespace

std::vector<std::string> identification_answer(const TwoSidedRecord &record) {
  std::vector<std::string> lines;
  for (std::size_t half = 0; half < half_names.size(); ++half) {
    const HalfLaw &law = record.halves[half];
    lines.push_back(
        fmt::format("{} half: k = {}, c = {}, D = {}, in contact {:.1f} % of the time", half_names[half],
                    with_machine(law.k, law.machine, &MachinePart::k, 1e6, " MN/m"),
                    with_machine(law.c, law.machine, &MachinePart::c, 1e3, " kN s/m"),
                    with_machine(law.D, law.machine, &MachinePart::D, 1.0, ""), 100.0 * law.contact_share));
  }
  lines.push_back(fmt::format("both: k = {} MN/m; left over right {}", with_interval(record.k, 1e6),
                              with_interval(record.ratio, 1.0)));
  const MotionFit &motion = record.motion;
  lines.push_back(fmt::format(
      "From the whole motion of drum and frame with their tilts: one that is computed with these values "
      "stays "
      "with the record for {:.4g} cycles, but for {:.2g} m/s2 (RMS) of the acceleration of the drum's left "
      "end, {}; condition {} {}; the bond has {:.4g} MN/m and {:.4g} kN s/m{}.",
      motion.cycles, motion.residual,
      motion.is_noise ? "the noise of the sensor" : fmt::format("{:.2g} % of it", 100.0 * record.left),
      motion.pulls ? "A" : "B", motion.pull_is_clear ? "fits better" : "is as good as the other one",
      motion.bond_stiffness / 1e6, motion.bond_damping / 1e3,
      record.frame_computed ? ", and the frame, which no sensor measures, follows from it" : ""));
  return lines;
}

std::string identification_csv(const TwoSidedRecord &record) {
  std::string text =
      csv_line({"half", "k [N/m]", "k_half_width [N/m]", "c [N s/m]", "c_half_width [N s/m]", "D [-]",
                "D_half_width [-]", "contact_share [-]", "left over right [-]",
                "left over right_half_width [-]", "k_machine [N/m]", "c_machine [N s/m]", "D_machine [-]"});
  for (std::size_t half = 0; half < half_names.size(); ++half) {
    const HalfLaw &law = record.halves[half];
    std::vector<std::string> cells = {half_names[half]};
    for (const MeanInterval &value : {law.k, law.c, law.D})
      cells.insert(cells.end(), {number_text(value.mean), number_text(value.half_width)});
    cells.insert(cells.end(), {number_text(law.contact_share), "", ""});
    for (const auto part : {&MachinePart::k, &MachinePart::c, &MachinePart::D})
      cells.push_back(law.machine ? number_text((*law.machine).*part) : "");
    text += csv_line(cells);
  }
  return text +
         csv_line({"both", number_text(record.k.mean), number_text(record.k.half_width), "", "", "", "", "",
                   number_text(record.ratio.mean), number_text(record.ratio.half_width), "", "", ""});
}

void write_identification_page(const std::filesystem::path &out, const TwoSidedRecord &record,
                               const std::string &roller) {
  Page page(out, "What the record says of the soil below both halves", Drawing::chain);
  page.answer(
      fmt::format("{}, {:.4g} cycles at {:.4g} Hz.", record.file.string(), record.cycles, record.frequency));
  if (!roller.empty()) page.answer(roller);
  for (const std::string &line : identification_answer(record))
    page.answer(line.back() == '.' ? line : line + ".");
  page.section("Soil below each half");
  page.table(half_table(record));
  page.figure(half_loops(record));
  page.section("Method");
  page.paragraph(
      "The forces below both halves follow from the equations of motion of drum and frame, of their heights "
      "and of their tilts, with a contact below each half at the width of the drum over the root of 12 from "
      "its middle. From k and c of single contacts these equations follow the record from contact to "
      "contact, through flights and landings of either end; k and c of both halves, the bond, phase and "
      "frequency of the exciter, offset and drift of each sensor and the state at the start of each stretch "
      "of cycles minimize the squared residuals. The tilt of the frame, which no sensor measures, follows "
      "from the bond. Intervals are those of the noise.");
  page.write();
}

} // namespace drumlin::post
