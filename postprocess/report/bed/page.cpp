#include "report/bed/page.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "bed/relative_density.h"
#include "pages/drawing.h"
#include "report/answer.h"
#include "report/bed/figures.h"
#include "report/page.h"

namespace drumlin::post {

namespace {

std::string rounded(double value) { return std::isfinite(value) ? two_digits(value) : no_value; }

/// A size that the files of the bed note, as a multiple of a unit, or a list of those of the layers; a dash
/// in runs of beds of earlier versions.
std::string noted(const Run &run, const std::string &name, double per_unit) {
  const std::string text = run.text(name, "unknown");
  if (text == "unknown") return no_value;
  std::string sizes;
  for (std::size_t at = 0, end = 0; end != std::string::npos; at = end + 1) {
    end = text.find(',', at);
    Run part;
    part.folder = run.folder;
    part.parameters[name] = text.substr(at, end - at);
    sizes += fmt::format("{}{:.3g}", at == 0 ? "" : ", ", part.number(name).value_or(0.0) * per_unit);
  }
  return sizes;
}

/// "Run bed/B (condition B)", "Runs bed/B (condition B) and bed/A (condition A)" or "Runs on 3 beds under B".
std::string title_of(const BedGroup &group) {
  if (group.several()) {
    std::string title = "Runs on";
    for (const Transition transition : group.conditions())
      title += fmt::format("{} {} beds under {}", transition == group.conditions().front() ? "" : " and",
                           group.under(transition).size(), transition_name(transition));
    return title;
  }
  std::string title = group.runs.size() > 1 ? "Runs" : "Run";
  for (const BedResult *result : group.runs)
    title += fmt::format("{} {} (condition {})", result == group.runs.front() ? "" : " and", result->run.name,
                         transition_name(result->run.transition()));
  return title;
}

std::string words_of(const BedGroup &group) {
  const Run &run = group.runs.front()->run;
  const double frequency = 1.0 / run.chain.period();
  const char *per = per_metre_words(run);
  std::string words =
      fmt::format("{} soil balls, friction {}, damping ratio {:g}. The exciter's force is {:g} kN{} at {:g} "
                  "Hz, the mass of the drum {:g} kg{} and of the frame {:g} kg{}.",
                  run.text("balls", "?"), run.text("friction", "?"), run.chain.D, run.chain.Fw * 1e-3, per,
                  frequency, run.chain.m2, per, run.chain.m3, per);
  if (group.several())
    words += " Lines are means over the beds of a condition, thin lines the least and the largest of them; "
             "pictures show the first bed of each.";
  return words;
}

/// The unit of a column of forces, of runs in two and in three dimensions.
std::string force_unit(const std::vector<BedResult> &beds) {
  bool two = false, three = false;
  for (const BedResult &result : beds)
    (per_metre(result.run) ? two : three) = true;
  return two && three ? "kN/m, in three dimensions kN" : two ? "kN/m" : "kN";
}

PageTable motion_table(const std::vector<BedResult> &beds) {
  PageTable motion(
      "bed_runs", "Motion of the roller",
      fmt::format(
          "run | transition | friction (-) | balls | frequency (Hz) | cycles (-) | "
          "steady cycles | largest drum acceleration (m/s²) | largest contact force ({0}) | smallest contact "
          "force ({0}) | share of time in contact (-) | CMV (-) | stepping | steps per cycle | ranks | "
          "command",
          force_unit(beds)),
      2);
  motion.section = "bed";
  motion.shown_columns = motion.header.size() - 4;
  for (const BedResult &result : beds) {
    const Run &run = result.run;
    const BedMeasures &m = result.measures;
    const bool any = m.cycles > 0;
    const auto steady = [any](double value) { return any ? rounded(value) : no_value; };
    motion.add({run.name, transition_name(run.transition()), run.text("friction", no_value),
                run.text("balls", no_value), fmt::format("{:g}", 1.0 / run.chain.period()),
                fmt::format("{}", m.cycles),
                any ? fmt::format("{} to {}", m.cycles - m.steady_count + 1, m.cycles) : no_value,
                steady(m.extremes.acceleration.max), steady(m.extremes.force.max * 1e-3),
                steady(m.extremes.force.min * 1e-3), steady(m.contact_share),
                m.amplitudes ? rounded(compaction_meter_value(*m.amplitudes)) : no_value,
                run.text("stepping", no_value),
                run.steps_per_cycle > 0 ? fmt::format("{}", run.steps_per_cycle) : no_value,
                run.text("ranks", no_value), run.text("command", no_value)});
    if (!any) motion.notes.push_back(fmt::format("{}: ends before its first complete cycle.", run.name));
    for (const std::string &missing : run.missing)
      motion.notes.push_back(fmt::format("{}: {}", run.name, missing));
  }
  motion.notes.push_back(BedScatter::words() + " Two digits are given; cycles.csv of a run has all.");
  motion.notes.emplace_back(
      "Steady cycles: about the second half of the run, an even number of cycles; both of a run of two. "
      "Acceleration, forces, share of time in contact and CMV are of every time step in these cycles. "
      "Compaction meter value CMV = 300 A2 / A1, of the amplitudes of drum acceleration at twice and once "
      "the excitation frequency.");
  return motion;
}

/// Relative density of a void ratio, where the loosest and the shaken packing are known and one for all
/// layers.
std::string relative_density_of(const Run &run, double void_ratio) {
  std::vector<LayerPackings> layers;
  try {
    layers = noted_packings(run.parameters);
  } catch (const std::runtime_error &) {
    return no_value; // a file that no deck has written
  }
  const auto differs = [&layers](const LayerPackings &layer) {
    return layer.loosest != layers.front().loosest || layer.shaken != layers.front().shaken;
  };
  if (layers.empty() || !std::isfinite(void_ratio) || std::any_of(layers.begin(), layers.end(), differs))
    return no_value;
  return rounded(relative_density(void_ratio, layers.front().loosest, layers.front().shaken));
}

PageTable state_table(const std::vector<BedResult> &beds) {
  PageTable state(
      "bed_states", "State of the bed",
      "run | transition | settlement at the end (mm) | settlement per cycle (mm) | coordination at the start "
      "(-) | coordination at the end (-) | void ratio at the start (-) | change of the void ratio (-) | "
      "imbalance of energy (% of work) | drum at rest, depth below the surface (% of its diameter) | grading "
      "| smallest and largest ball (mm) | d50 (mm) | coefficient of uniformity Cu (-) | relative density at "
      "the start (-) | relative density at the end (-) | energy balanced",
      2);
  state.section = "bed";
  state.verdict = "energy balanced";
  state.criterion =
      "runs have an energy error of at most 1 % of the exciter's work, which checks the integration alone";
  for (const BedResult &result : beds) {
    const BedMeasures &m = result.measures;
    const bool any = m.cycles > 0;
    const auto steady = [any](double value) { return any ? rounded(value) : no_value; };
    const std::string smallest = noted(result.run, "r_min", 2e3), largest = noted(result.run, "r_max", 2e3);
    const std::string sizes = largest == no_value ? no_value : fmt::format("{} to {}", smallest, largest);
    const RowState judged = !std::isfinite(m.imbalance_percent) || !result.run.cut.empty() ? RowState::plain
                            : energy_is_good(m)                                            ? RowState::agrees
                                                : RowState::differs;
    state.add({result.run.name, transition_name(result.run.transition()), steady(m.settlement * 1e3),
               steady(m.settlement_per_cycle * 1e3), rounded(m.coordination_start),
               rounded(m.coordination_end), rounded(m.void_ratio_start),
               rounded(m.void_ratio_end - m.void_ratio_start), rounded(m.imbalance_percent),
               rounded(m.depth_percent), result.run.text("grading", no_value), sizes,
               noted(result.run, "d50", 1e3), noted(result.run, "C_u", 1.0),
               relative_density_of(result.run, m.void_ratio_start),
               relative_density_of(result.run, m.void_ratio_end),
               judged == RowState::plain    ? no_value
               : judged == RowState::agrees ? "yes"
                                            : "no"},
              judged);
  }
  state.notes.emplace_back(
      "Settlement: mean position of the drum over a cycle, below its position at rest, negative above it, as "
      "where the drum jumps; per cycle: mean over the steady cycles. Coordination: mean number of contacts "
      "of a soil ball. Coordination and void ratio at the end are means over the last cycle. Imbalance of "
      "energy is the energy error: kinetic + potential + elastic + dissipated energy - work of the exciter "
      "at the end, less the same at the start. Depth of the drum: of its lowest point before the excitation, "
      "below the mean surface that the soil had before the drum was placed, away from the drum; negative "
      "above. Grading, sizes (diameters), d50 and Cu = d60 / d10, by mass, are those of the balls that "
      "drumlin bed made; of layers of each, the lowest first. Relative density: of the void ratio, 0 for the "
      "loosest packing of the mix, by pouring, and 1 for the densest by shaking, of beds that were made with "
      "drumlin bed --relative-density.");
  return state;
}

} // namespace

std::vector<PageTable> bed_tables(const std::vector<BedResult> &beds) {
  return {motion_table(beds), state_table(beds)};
}

std::string bed_page(const ReportContent &content) {
  const bool drive = std::all_of(content.beds.begin(), content.beds.end(),
                                 [](const BedResult &result) { return drives(result.run.folder); });
  ReportPage page =
      page_beside(bed_answer(content.groups), drive ? Drawing::drive : Drawing::bed, content.bed_keys);
  std::string numbers = fmt::format(
      "<p>Drum and frame {}; the exciter acts on the drum. In two dimensions masses, forces and energies are "
      "per metre of the drum's width. Condition A dashed, condition B (no-tension limit) solid. Nothing here "
      "is compared with a measurement.</p>\n",
      drive ? "drive over a bed of balls" : "stand on a bed of balls and move up and down only");
  for (const PageTable &table : content.bed_tables)
    numbers += table_html(table);
  page.section("numbers", "Numbers", numbers);
  for (std::size_t i = 0; i < content.groups.size(); ++i)
    page.section(bed_section(i), title_of(content.groups[i]),
                 fmt::format("<p>{}</p>\n", html_escaped(words_of(content.groups[i]))) +
                     section_html(content.bed_figures, bed_section(i)));
  page.section("runs", "Commands and versions",
               commands_and_versions(content.beds, report_programs(content.versions)));
  return page.html("Roller on a bed of balls", content.versions);
}

} // namespace drumlin::post
