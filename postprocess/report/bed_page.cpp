#include "report/bed_page.h"

#include <cmath>

#include <fmt/format.h>

#include "report/bed_figures.h"

namespace drumlin::post {

namespace {

const std::string dash = "–";

std::string fixed(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : dash;
}

/// "B: bed/B" or "B: bed/B and A: bed/A".
std::string title_of(const BedGroup &group) {
  std::string title;
  for (const BedResult *result : group.runs)
    title += fmt::format("{}{}: {}", title.empty() ? "" : " and ", transition_name(result->run.transition()),
                         result->run.name);
  return title;
}

std::string words_of(const BedGroup &group) {
  const Run &run = group.runs.front()->run;
  const double frequency = 1.0 / run.chain.period();
  return fmt::format("{} soil balls, friction {}, damping ratio {:g}; {:g} kN at {:g} Hz on a drum of {:g} "
                     "kg with a frame of "
                     "{:g} kg.",
                     run.text("balls", "?"), run.text("friction", "?"), run.chain.D, run.chain.Fw * 1e-3,
                     frequency, run.chain.m2, run.chain.m3);
}

} // namespace

std::vector<ReportTable> bed_tables(const std::vector<BedResult> &beds) {
  ReportTable motion;
  motion.section = "bed";
  motion.name = "bed_runs";
  motion.title = "Runs of the roller on a bed";
  motion.text_columns = 2;
  motion.header = {"run",
                   "transition",
                   "friction (-)",
                   "balls",
                   "frequency (Hz)",
                   "cycles (-)",
                   "steady cycles",
                   "largest drum acceleration (m/s²)",
                   "largest contact force (kN)",
                   "smallest contact force (kN)",
                   "share of time in contact (-)",
                   "CMV (-)",
                   "stepping",
                   "steps per cycle",
                   "ranks",
                   "command"};
  motion.shown_columns = motion.header.size() - 4;
  ReportTable state;
  state.section = "bed";
  state.name = "bed_states";
  state.title = "What the roller does to the bed";
  state.text_columns = 2;
  state.header = {"run",
                  "transition",
                  "settlement at the end (mm)",
                  "settlement per cycle (mm)",
                  "coordination at the start (-)",
                  "coordination at the end (-)",
                  "void ratio at the start (-)",
                  "void ratio at the end (-)",
                  "imbalance of energy (% of work)"};
  state.shown_columns = state.header.size();
  for (const BedResult &result : beds) {
    const Run &run = result.run;
    const BedMeasures &m = result.measures;
    const std::string transition = transition_name(run.transition());
    const bool any = m.cycles > 0;
    const auto steady = [any](double value, int decimals) { return any ? fixed(value, decimals) : dash; };
    motion.add({run.name, transition, run.text("friction", dash), run.text("balls", dash),
                fmt::format("{:g}", 1.0 / run.chain.period()), fmt::format("{}", m.cycles),
                any ? fmt::format("{} to {}", m.cycles - m.steady_count + 1, m.cycles) : dash,
                steady(m.extremes.acceleration.max, 2), steady(m.extremes.force.max * 1e-3, 2),
                steady(m.extremes.force.min * 1e-3, 2), steady(m.contact_share, 4),
                m.amplitudes ? fixed(compaction_meter_value(*m.amplitudes), 2) : dash,
                run.text("stepping", dash),
                run.steps_per_cycle > 0 ? fmt::format("{}", run.steps_per_cycle) : dash,
                run.text("ranks", dash), run.text("command", dash)});
    state.add({run.name, transition, steady(m.settlement * 1e3, 3), steady(m.settlement_per_cycle * 1e3, 3),
               fixed(m.coordination_start, 3), fixed(m.coordination_end, 3), fixed(m.void_ratio_start, 4),
               fixed(m.void_ratio_end, 4), fixed(m.imbalance_percent, 3)});
    if (!any) motion.notes.push_back(fmt::format("{}: ends before its first complete cycle.", run.name));
    for (const std::string &missing : run.missing)
      motion.notes.push_back(fmt::format("{}: {}", run.name, missing));
  }
  motion.notes.emplace_back("From acceleration to CMV: of the steady cycles, about the second half of the "
                            "run, an even number of them, "
                            "every step. CMV = 300 A2 / A1 of the drum's acceleration.");
  state.notes.emplace_back(
      "Settlement: mean of the drum's position over a cycle, below where it lay at rest; per cycle in the "
      "steady "
      "cycles. Coordination and void ratio at the end are means over the last cycle. Imbalance: kinetic + "
      "potential + elastic + dissipated energy - work of the exciter at the end, less its value at the "
      "start.");
  return {motion, state};
}

std::string bed_page(const std::vector<BedResult> &beds, const std::vector<BedGroup> &groups,
                     const std::vector<ReportTable> &tables, const FigurePlan &plan,
                     const ReportVersions &versions) {
  std::string s = "<nav>\n<p><a href=\"index.html\">Report of the runs</a></p>\n<ol>\n"
                  "<li><a href=\"#summary\">Summary</a></li>\n";
  for (std::size_t i = 0; i < groups.size(); ++i)
    s += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", bed_section(i), html_escaped(title_of(groups[i])));
  s += "</ol>\n</nav>\n<main>\n<section id=\"summary\">\n<h2>1. Summary</h2>\n"
       "<p>Drum and frame stand on a bed of balls in two dimensions and move up and down only; the exciter "
       "acts "
       "on the drum. Masses, forces and energies are per metre out of the picture. Condition A dashed, "
       "condition B solid.</p>\n";
  for (const ReportTable &table : tables)
    s += table_html(table);
  std::vector<std::pair<std::string, std::string>> commands;
  commands.reserve(beds.size());
  for (const BedResult &result : beds)
    commands.emplace_back(result.run.name, result.run.text("command"));
  s += commands_html(commands) + fmt::format("<p>Report by drumlin {}; figures by {}.</p>\n</section>\n",
                                             html_escaped(versions.drumlin), html_escaped(versions.gnuplot));
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const std::string id = bed_section(i);
    s += fmt::format("<section id=\"{}\">\n<h2>{}. {}</h2>\n<p>{}</p>\n", id, i + 2,
                     html_escaped(title_of(groups[i])), html_escaped(words_of(groups[i])));
    s += section_html(plan, id) + "</section>\n";
  }
  return html_page("Roller on a bed of balls", made_line(versions), s + "</main>\n");
}

} // namespace drumlin::post
