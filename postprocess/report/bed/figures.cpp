#include "report/bed/figures.h"

#include <algorithm>

#include <fmt/format.h>

#include "pages/figure_data.h"
#include "report/bed/snapshots.h"

namespace drumlin::post {

namespace {

constexpr int shown_cycles = 3;
constexpr int loop_cycles = 2;
// The page opens with the picture of the bed under load, then the settlement; without dumps also the motion.
constexpr double settlement_weight = 5.0;
constexpr double motion_weight = 4.0;

std::string label(const BedResult &result) { return transition_name(result.run.transition()); }

/// The name in the legend, with the word "condition": gnuplot places single letters so close to each other
/// that the next line sample covers them.
std::string legend(const BedResult &result) { return "condition " + label(result); }

bool is_a(const BedResult &result) { return result.run.transition() == Transition::A; }

CurveStyle line_style(const BedResult &result) {
  return is_a(result) ? CurveStyle::condition_a : CurveStyle::condition_b;
}

/// The last complete cycles, the rows at both ends included.
TimeWindow last_cycles(const BedResult &result, int count) {
  const double period = result.run.chain.period();
  TimeWindow window = last_cycles_window(result.run.complete, count, period);
  window.end += 1.0e-6 * period;
  window.begin -= 1.0e-6 * period;
  return window;
}

/// Calls visit(row) for the rows of a window.
template <class Visit>
void for_rows(const BedResult &result, TimeWindow window, const Visit &visit) {
  const std::vector<double> &time = result.run.history.time;
  for (std::size_t i = 0; i < time.size(); ++i)
    if (time[i] >= window.begin && time[i] <= window.end) visit(i);
}

/// Plans the figures of one group of runs.
class Group {
public:
  Group(const BedGroup &group, std::size_t number, FigurePlan &plan)
      : group_(group), section_(bed_section(number)), stem_(fmt::format("bed{}_", number + 1)), plan_(plan) {}

  void plan() {
    motion();
    loop();
    settlement();
    state();
    energies();
    walls();
    plan_bed_pictures(group_, stem_, section_, plan_);
  }

private:
  const std::vector<const BedResult *> &runs() const { return group_.runs; }

  void add(const std::string &name, const std::string &title, const std::vector<Panel> &panels,
           const CurveTable &table, const std::string &caption, int columns, double weight = 0.0) {
    PageFigure figure{section_, "", caption, {}, table.text(), weight};
    figure.figure = {stem_ + name, title, panels, columns};
    plan_.figures.push_back(std::move(figure));
  }

  /// One curve for each run.
  void curves(Panel &panel, const std::string &name, const std::string &x, const std::string &y) const {
    for (const BedResult *run : runs())
      panel.add(curve(stem_ + name, label(*run), x, y, line_style(*run)), legend(*run));
  }

  /// Whether every run has a complete cycle. If not, notes the figure as absent.
  bool has_cycles(const std::string &what) {
    for (const BedResult *run : runs())
      if (run->measures.cycles < 1) {
        plan_.absent.push_back(
            {section_, what, fmt::format("{} ends before its first complete cycle", run->run.name)});
        return false;
      }
    return true;
  }

  /// The words for captions and axes that say how many cycles at the end of the runs a figure shows, which
  /// are at most `most`.
  std::string last(int most) const {
    std::vector<int> counts;
    for (const BedResult *run : runs())
      counts.push_back(std::min(most, run->run.complete));
    return last_cycles_words(counts);
  }

  void motion() {
    if (!has_cycles("Motion")) return;
    CurveTable table("time (s),time in window (s),drum acceleration (m/s2),contact force (N)");
    for (const BedResult *run : runs()) {
      const ChainHistory &h = run->run.history;
      const TimeWindow window = last_cycles(*run, shown_cycles);
      for_rows(*run, window, [&](std::size_t i) {
        table.row(label(*run), {h.time[i], h.time[i] - window.begin, h.a_drum[i], h.F_contact[i]});
      });
    }
    const std::string time = fmt::format("time in {} (ms)", last(shown_cycles));
    Panel acceleration{"drum acceleration", time, "drum acceleration (m/s²)", {}};
    Panel force{"contact force", time, "contact force on the drum (kN)", {}};
    acceleration.tight_x = force.tight_x = true;
    curves(acceleration, "motion", "$3*1e3", "4");
    curves(force, "motion", "$3*1e3", "($5*1e-3)");
    add("motion", "Drum acceleration and contact force", {acceleration, force}, table,
        fmt::format("Acceleration of the drum, and force of the soil on the drum, over {}. The force is the "
                    "vertical sum over all balls in contact with the drum. It includes their friction, so it "
                    "can be tensile under condition B, too.",
                    last(shown_cycles)),
        2, motion_weight);
  }

  void loop() {
    if (!has_cycles("The force loop")) return;
    CurveTable table("time (s),drum position (m),contact force (N)");
    Panel panel{"Contact force against drum position",
                "drum position (mm), 0 at the start",
                "contact force on the drum (kN)",
                {}};
    for (const BedResult *run : runs()) {
      const ChainHistory &h = run->run.history;
      for_rows(*run, last_cycles(*run, loop_cycles), [&](std::size_t i) {
        table.row(label(*run), {h.time[i], h.x_drum[i], h.F_contact[i]});
      });
    }
    curves(panel, "loop", "$3*1e3", "($4*1e-3)");
    add("loop", panel.title, {panel}, table,
        fmt::format("Contact force against the height of the drum over {}. The area within a loop is the "
                    "energy that the drum gives to the bed in one cycle.",
                    last(loop_cycles)),
        1);
  }

  void settlement() {
    if (!has_cycles("Settlement")) return;
    CurveTable table("cycle (-),settlement (m),largest drum acceleration (m/s2),largest contact force (N)");
    Panel panel{"Settlement", "cycle (-)", "settlement (mm)", {}};
    panel.x_range = "[0:*]";
    for (const BedResult *run : runs()) {
      const CycleColumns &c = *run->run.cycles;
      for (std::size_t i = 0; i < c.rows; ++i)
        table.row(label(*run), {static_cast<double>(i), c.at("settlement")[i], c.at("a_drum_max")[i],
                                c.at("F_contact_max")[i]});
      panel.add(curve(stem_ + "settlement", label(*run), "$2", "($3*1e3)",
                      is_a(*run) ? CurveStyle::series_2 : CurveStyle::series_1),
                legend(*run));
    }
    add("settlement", panel.title, {panel}, table,
        "Settlement of the drum: how far its mean position over a cycle lies below its position at rest "
        "before the excitation. Where the drum jumps, the mean contains the height of the jumps, which "
        "differs from cycle to cycle, and can lie above the position at rest (negative settlement).",
        1, settlement_weight);
  }

  void state() {
    CurveTable table("time (s),coordination (-),void ratio (-)");
    for (const BedResult *run : runs())
      for (std::size_t i = 0; i < run->run.history.size(); ++i)
        table.row(label(*run), {run->run.history.time[i], run->bed.coordination[i], run->bed.void_ratio[i]});
    Panel coordination{"contacts per soil ball", "time (s)", "coordination (-)", {}};
    Panel voids{"void ratio", "time (s)", "void ratio (-)", {}};
    coordination.tight_x = voids.tight_x = true;
    curves(coordination, "state", "$2", "3");
    curves(voids, "state", "$2", "4");
    add("state", "Coordination and void ratio", {coordination, voids}, table,
        "Coordination: mean number of contacts of a soil ball. Void ratio: volume of the voids over volume "
        "of the balls, in the part of the bed below the height of the soil's centre of mass at the start.",
        2);
  }

  void energies() {
    CurveTable table("time (s),work of the exciter (J),dissipated (J),potential (J),kinetic (J),elastic "
                     "(J),imbalance (J)");
    const std::string name = stem_ + "energy";
    std::vector<Panel> sums;
    std::vector<Panel> stores;
    for (const BedResult *run : runs()) {
      const BedHistory &b = run->bed;
      const std::vector<double> imbalance = energy_imbalance(b);
      for (std::size_t i = 0; i < run->run.history.size(); ++i)
        table.row(label(*run), {run->run.history.time[i], b.work_excitation[i], b.dissipated[i],
                                b.potential[i], b.kinetic[i], b.elastic[i], imbalance[i]});
      Panel sum{fmt::format("{}: since the start", label(*run)), "time (s)", "energy (J)", {}};
      Panel store{fmt::format("{}: stored", label(*run)), "time (s)", "energy (J)", {}};
      const auto line = [&](Panel &panel, const std::string &y, const char *title, CurveStyle style) {
        panel.add(curve(name, label(*run), "$2", y, style), title);
      };
      line(sum, "3", "work of the exciter", CurveStyle::line_1);
      line(sum, "4", "dissipated", CurveStyle::line_2);
      line(sum, "5", "potential", CurveStyle::line_3);
      line(sum, "8", "energy error", CurveStyle::line_5);
      line(store, "7", "elastic", CurveStyle::line_4);
      line(store, "6", "kinetic", CurveStyle::line_5);
      sum.tight_x = store.tight_x = true;
      sums.push_back(sum);
      stores.push_back(store);
    }
    sums.insert(sums.end(), stores.begin(), stores.end());
    add("energy", "Energies", sums, table,
        "Energies of drum, frame and bed. Energy error: kinetic + potential + elastic + dissipated energy - "
        "work of the exciter, less its value at the start. It would be 0 without any numerical error. While "
        "the drum sinks, its potential energy drives the bed in addition to the exciter.",
        2);
  }

  void walls() {
    if (!has_cycles("Forces of the walls")) return;
    CurveTable table(
        "time (s),time in window (s),floor (N),friction of the sides (N),thrust of the sides (N)");
    const std::string name = stem_ + "walls";
    std::vector<Panel> panels;
    for (const BedResult *run : runs()) {
      const BedHistory &b = run->bed;
      const std::vector<double> &time = run->run.history.time;
      const TimeWindow window = last_cycles(*run, shown_cycles);
      for_rows(*run, window, [&](std::size_t i) {
        table.row(label(*run), {time[i], time[i] - window.begin, b.F_floor[i], b.F_sides[i], b.F_thrust[i]});
      });
      Panel panel{label(*run), fmt::format("time in {} (ms)", last(shown_cycles)), "force (kN)", {}};
      panel.tight_x = true;
      for (const auto &[y, title, style] : {std::tuple{"($4*1e-3)", "floor", CurveStyle::line_1},
                                            {"($6*1e-3)", "side thrust", CurveStyle::line_3},
                                            {"($5*1e-3)", "side friction", CurveStyle::line_2}}) {
        panel.add(curve(name, label(*run), "$3*1e3", y, style), title);
      }
      panels.push_back(panel);
    }
    add("walls", "Forces of the walls", panels, table,
        "Forces of floor and side walls on the balls: the part of the roller's load that reaches the "
        "boundaries of the bed. Side thrust is the sum of the normal forces of both side walls; side "
        "friction is positive where it acts upwards on the balls.",
        2);
  }

  const BedGroup &group_;
  std::string section_;
  std::string stem_;
  FigurePlan &plan_;
};

} // namespace

std::string bed_section(std::size_t group) { return fmt::format("bed-{}", group + 1); }

FigurePlan plan_bed_figures(const std::vector<BedGroup> &groups) {
  FigurePlan plan;
  for (std::size_t i = 0; i < groups.size(); ++i)
    Group(groups[i], i, plan).plan();
  int number = 0;
  for (PageFigure &figure : plan.figures)
    figure.label = fmt::format("Fig. {}", ++number);
  return plan;
}

} // namespace drumlin::post
