#include "report/bed/figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "pages/figure.h"
#include "report/bed/snapshots.h"
#include "support/units.h"

namespace drumlin::post {

namespace {

constexpr int loop_cycles = 2;
// The page opens with the picture of the bed under load, then the settlement; without dumps also the motion.
constexpr double settlement_weight = 5.0;
constexpr double motion_weight = 4.0;

/// The name in the legend, with the word "condition": gnuplot places single letters so close to each other
/// that the next line sample covers them.
std::string legend(Transition transition) { return "condition " + transition_name(transition); }

CurveStyle marked_style(Transition transition) {
  return transition == Transition::A ? CurveStyle::series_2 : CurveStyle::series_1;
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

/// Amplitudes of the drum's acceleration at multiples of the frequency of the window, up to six times that of
/// the excitation: frequency [Hz], amplitude [m/s2].
Rows<2> spectrum_of(const BedResult &result, const TimeWindow &window, int cycles) {
  constexpr int highest = 6;
  const ChainHistory &h = result.run.history;
  std::vector<std::size_t> rows;
  for_rows(result, window, [&rows](std::size_t i) { rows.push_back(i); });
  Rows<2> lines;
  if (cycles < 1 || rows.size() < 3) return lines;
  const double frequency = 1.0 / result.run.chain.period();
  const auto intervals = static_cast<double>(rows.size() - 1);
  for (int k = 1; k <= highest * cycles && k < intervals / 2.0; ++k) {
    const double order = static_cast<double>(k) / cycles;
    std::complex<double> sum;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const bool end = i == 0 || i + 1 == rows.size();
      sum += std::polar((end ? 0.5 : 1.0) * h.a_drum[rows[i]],
                        -2.0 * pi * order * frequency * (h.time[rows[i]] - h.time[rows.front()]));
    }
    lines.push_back({order * frequency, 2.0 / intervals * std::abs(sum)});
  }
  return lines;
}

/// Plans the figures of one group of runs.
class Group {
public:
  Group(const BedGroup &group, std::size_t number, FigurePlan &plan)
      : group_(group), section_(bed_section(number)), stem_(fmt::format("bed{}_", number + 1)), plan_(plan),
        per_(per_metre_words(group.runs.front()->run)),
        per_and_(per_metre_words(group.runs.front()->run, " per m")) {}

  void plan() {
    motion();
    loop();
    settlement();
    drum();
    spectrum();
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
    if (group_.several())
      figure.caption += " Means over several beds, and thin the least and the largest of them.";
    figure.figure = {stem_ + name, title, panels, columns};
    plan_.figures.push_back(std::move(figure));
  }

  /// Puts the rows of a condition's runs into a table, as put_beds() does.
  template <std::size_t N, class RowsOf>
  void put(CurveTable &table, Transition transition, std::size_t abscissas, const RowsOf &rows_of) const {
    const std::string label = transition_name(transition);
    std::vector<Rows<N>> beds;
    for (const BedResult *run : group_.under(transition))
      beds.push_back(rows_of(*run));
    put_beds(table, label, beds, abscissas);
  }
  template <std::size_t N, class RowsOf>
  void put(CurveTable &table, std::size_t abscissas, const RowsOf &rows_of) const {
    for (const Transition transition : group_.conditions())
      put<N>(table, transition, abscissas, rows_of);
  }

  /// A curve of a condition, and what is thin beside it.
  void line(Panel &panel, const std::string &name, Transition transition, const std::string &x,
            const std::string &y, CurveStyle style, const std::string &title) const {
    add_beds(panel, stem_ + name, transition_name(transition), group_.under(transition).size(), x, y, style,
             title);
  }
  /// One curve for each condition.
  void curves(Panel &panel, const std::string &name, const std::string &x, const std::string &y,
              bool marked = false) const {
    for (const Transition transition : group_.conditions())
      line(panel, name, transition, x, y, marked ? marked_style(transition) : line_style(transition),
           legend(transition));
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
    CurveTable table(
        fmt::format("time (s),time in window (s),drum acceleration (m/s2),contact force (N{})", per_));
    put<4>(table, 2, [](const BedResult &run) {
      const ChainHistory &h = run.run.history;
      const TimeWindow window = last_cycles(run, shown_cycles);
      Rows<4> rows;
      for_rows(run, window, [&](std::size_t i) {
        rows.push_back({h.time[i], h.time[i] - window.begin, h.a_drum[i], h.F_contact[i]});
      });
      return rows;
    });
    const std::string time = fmt::format("time in {} (ms)", last(shown_cycles));
    Panel acceleration{"drum acceleration", time, "drum acceleration (m/s²)", {}};
    Panel force{"contact force", time, fmt::format("contact force on the drum (kN{})", per_), {}};
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
    CurveTable table(fmt::format("time (s),drum position (m),contact force (N{})", per_));
    Panel panel{"Contact force against drum position",
                "drum position (mm), 0 at the start",
                fmt::format("contact force on the drum (kN{})", per_),
                {}};
    put<3>(table, 2, [](const BedResult &run) {
      const ChainHistory &h = run.run.history;
      Rows<3> rows;
      for_rows(run, last_cycles(run, loop_cycles), [&](std::size_t i) {
        rows.push_back({h.time[i], h.x_drum[i], h.F_contact[i]});
      });
      return rows;
    });
    curves(panel, "loop", "$3*1e3", "($4*1e-3)");
    add("loop", panel.title, {panel}, table,
        fmt::format("Contact force against the height of the drum over {}. The area within a loop is the "
                    "energy that the drum gives to the bed in one cycle.",
                    last(loop_cycles)),
        1);
  }

  void settlement() {
    if (!has_cycles("Settlement")) return;
    CurveTable table(fmt::format(
        "cycle (-),settlement (m),largest drum acceleration (m/s2),largest contact force (N{})", per_));
    Panel panel{"Settlement", "cycle (-)", "settlement (mm)", {}};
    panel.x_range = "[0:*]";
    put<4>(table, 1, [](const BedResult &run) {
      const CycleColumns &c = *run.run.cycles;
      Rows<4> rows;
      for (std::size_t i = 0; i < c.rows; ++i)
        rows.push_back(
            {static_cast<double>(i), c.at("settlement")[i], c.at("a_drum_max")[i], c.at("F_contact_max")[i]});
      return rows;
    });
    curves(panel, "settlement", "$2", "($3*1e3)", true);
    add("settlement", panel.title, {panel}, table,
        "Settlement of the drum: how far its mean position over a cycle lies below its position at rest "
        "before the excitation. Where the drum jumps, the mean contains the height of the jumps, which "
        "differs from cycle to cycle, and can lie above the position at rest (negative settlement).",
        1, settlement_weight);
  }

  /// Amplitude and phase of the drum's displacement at the frequency of the excitation.
  void drum() {
    if (!has_cycles("Amplitude and phase of the drum")) return;
    for (const BedResult *run : runs())
      if (cycle_harmonics(*run->run.cycles).fundamental.empty()) {
        plan_.absent.push_back({section_, "Amplitude and phase of the drum",
                                fmt::format("cycles.csv of {} has no column a1_cos", run->run.name)});
        return;
      }
    CurveTable table("cycle (-),amplitude (m),phase (degrees)");
    Panel amplitude{"amplitude", "cycle (-)", "amplitude of the drum (mm)", {}};
    Panel phase{"phase", "cycle (-)", "lag behind the exciter's force (degrees)", {}};
    put<3>(table, 1, [](const BedResult &run) {
      const auto harmonics = cycle_harmonics(*run.run.cycles).fundamental;
      const double omega = run.run.chain.omega;
      Rows<3> rows;
      for (std::size_t i = 1; i < harmonics.size(); ++i) { // row 0 is the start
        // The force down is sin(omega t), -i as a complex amplitude; the displacement down is a / omega^2.
        double lag = -90.0 - degrees_per_radian * std::arg(harmonics[i]);
        if (lag <= -90.0) lag += 360.0;
        rows.push_back({static_cast<double>(i), std::abs(harmonics[i]) / (omega * omega), lag});
      }
      return rows;
    });
    curves(amplitude, "drum", "$2", "($3*1e3)", true);
    curves(phase, "drum", "$2", "4", true);
    const ChainParameters &p = runs().front()->run.chain;
    add("drum", "Amplitude and phase of the drum", {amplitude, phase}, table,
        fmt::format(
            "Amplitude of the drum's displacement at the frequency of the excitation, and by how much it "
            "lags behind the exciter's force, in each cycle. A drum without soil and frame has {} mm and "
            "180 degrees; in resonance the lag is 90 degrees.",
            two_digits(1e3 * p.Fw / (p.m2 * p.omega * p.omega))),
        2);
  }

  void spectrum() {
    if (!has_cycles("The spectrum")) return;
    CurveTable table("frequency (Hz),amplitude (m/s2)");
    Panel panel{"Spectrum of the drum's acceleration", "frequency (Hz)", "amplitude (m/s²)", {}};
    int cycles = std::numeric_limits<int>::max();
    for (const BedResult *run : runs())
      cycles = std::min(cycles, run->measures.steady_count);
    put<2>(table, 1,
           [cycles](const BedResult &run) { return spectrum_of(run, last_cycles(run, cycles), cycles); });
    panel.tight_x = true;
    curves(panel, "spectrum", "$2", "3", true);
    add("spectrum", panel.title, {panel}, table,
        fmt::format(
            "Amplitudes of the drum's acceleration over {}, from the rows of bed.csv. The excitation has "
            "{:g} Hz; CMV compares twice this frequency with it, RMV half of it.",
            last(cycles), 1.0 / runs().front()->run.chain.period()),
        1);
  }

  void state() {
    CurveTable table("time (s),coordination (-),void ratio (-)");
    put<3>(table, 1, [](const BedResult &run) {
      Rows<3> rows;
      for (std::size_t i = 0; i < run.run.history.size(); ++i)
        rows.push_back({run.run.history.time[i], run.bed.coordination[i], run.bed.void_ratio[i]});
      return rows;
    });
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
    CurveTable table(
        fmt::format("time (s),work of the exciter (J{0}),dissipated (J{0}),potential (J{0}),kinetic "
                    "(J{0}),elastic (J{0}),imbalance (J{0})",
                    per_));
    put<7>(table, 1, [](const BedResult &run) {
      const BedHistory &b = run.bed;
      const std::vector<double> imbalance = energy_imbalance(b);
      Rows<7> rows;
      for (std::size_t i = 0; i < run.run.history.size(); ++i)
        rows.push_back({run.run.history.time[i], b.work_excitation[i], b.dissipated[i], b.potential[i],
                        b.kinetic[i], b.elastic[i], imbalance[i]});
      return rows;
    });
    std::vector<Panel> sums;
    std::vector<Panel> stores;
    const std::string unit = fmt::format("energy (J{})", per_);
    for (const Transition transition : group_.conditions()) {
      const std::string label = transition_name(transition);
      Panel sum{fmt::format("{}: since the start", label), "time (s)", unit, {}};
      Panel store{fmt::format("{}: stored", label), "time (s)", unit, {}};
      line(sum, "energy", transition, "$2", "3", CurveStyle::line_1, "work of the exciter");
      line(sum, "energy", transition, "$2", "4", CurveStyle::line_2, "dissipated");
      line(sum, "energy", transition, "$2", "5", CurveStyle::line_3, "potential");
      line(sum, "energy", transition, "$2", "8", CurveStyle::line_5, "energy error");
      line(store, "energy", transition, "$2", "7", CurveStyle::line_4, "elastic");
      line(store, "energy", transition, "$2", "6", CurveStyle::line_5, "kinetic");
      sum.tight_x = store.tight_x = true;
      sums.push_back(sum);
      stores.push_back(store);
    }
    sums.insert(sums.end(), stores.begin(), stores.end());
    add("energy", "Energies", sums, table,
        fmt::format(
            "Energies of drum, frame and bed{}. Energy error: kinetic + potential + elastic + dissipated "
            "energy - work of the exciter, less its value at the start. It would be 0 without any numerical "
            "error. While the drum sinks, its potential energy drives the bed in addition to the exciter.",
            per_and_),
        2);
  }

  void walls() {
    if (!has_cycles("Forces of the walls")) return;
    CurveTable table(
        fmt::format("time (s),time in window (s),floor (N{0}),friction of the sides (N{0}),thrust of "
                    "the sides (N{0})",
                    per_));
    put<5>(table, 2, [](const BedResult &run) {
      const BedHistory &b = run.bed;
      const std::vector<double> &time = run.run.history.time;
      const TimeWindow window = last_cycles(run, shown_cycles);
      Rows<5> rows;
      for_rows(run, window, [&](std::size_t i) {
        rows.push_back({time[i], time[i] - window.begin, b.F_floor[i], b.F_sides[i], b.F_thrust[i]});
      });
      return rows;
    });
    std::vector<Panel> panels;
    for (const Transition transition : group_.conditions()) {
      Panel panel{transition_name(transition),
                  fmt::format("time in {} (ms)", last(shown_cycles)),
                  fmt::format("force (kN{})", per_),
                  {}};
      panel.tight_x = true;
      line(panel, "walls", transition, "$3*1e3", "($4*1e-3)", CurveStyle::line_1, "floor");
      line(panel, "walls", transition, "$3*1e3", "($6*1e-3)", CurveStyle::line_3, "side thrust");
      line(panel, "walls", transition, "$3*1e3", "($5*1e-3)", CurveStyle::line_2, "side friction");
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
  std::string per_, per_and_; // behind units
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
