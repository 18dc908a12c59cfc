#include "map/ends.h"

#include "chain/linear_algebra.h"

#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace drumlin::post {

const std::array<const char *, ends_mode_count> ends_mode_names = {
    "continuous contact", "uplift of one end", "uplift of both ends", "double jump", "rocking",
    "combined",           "higher period",     "aperiodic",           "undecided"};

EndsCycles::Passage EndsCycles::pass(const TwoEndsState &state, int cycles, bool with_jacobian) const {
  Passage passage;
  TwoEndsMotion motion = solver.start_at(state);
  for (int cycle = 0; cycle < cycles; ++cycle)
    if (with_jacobian)
      passage.jacobian = (solver.monodromy(motion) * passage.jacobian).eval();
    else
      solver.finish_cycle(motion);
  passage.end = motion.state;
  return passage;
}

TwoEndsState EndsCycles::scale() const {
  const TwoEnds &machine = solver.machine();
  const ChainParameters &p = machine.chain;
  double speed = std::max(p.Fw / p.m2, p.g) / p.omega;
  if (speed <= 0.0) speed = 1.0;
  Eigen::Vector4d of_speed(speed, speed, speed * std::sqrt(p.m2 / machine.drum_inertia),
                           speed * std::sqrt(p.m3 / machine.frame_inertia));
  TwoEndsState scale;
  scale << of_speed / p.omega, of_speed;
  return scale;
}

void EndsCycles::advance(TwoEndsMotion &motion, TwoEndsState *tangent) const {
  if (tangent == nullptr)
    solver.finish_cycle(motion);
  else
    *tangent = (solver.monodromy(motion) * *tangent).eval();
}

namespace {

/// Range of the tilt and time in contact of both halves.
class HalfSums : public TwoEndsObserver {
public:
  explicit HalfSums(const TwoEnds &machine) {
    for (std::size_t j = 0; j < machine.contacts.size(); ++j) {
      const double y = machine.contacts[j].y;
      if (y <= 0.0) halves_[0] |= 1U << j;
      if (y >= 0.0) halves_[1] |= 1U << j;
    }
  }
  void piece(const ContactSet::Piece &piece, const ContactSet & /*set*/, std::uint32_t acting) override {
    constexpr int parts = 8;
    for (int part = 0; part <= parts; ++part) {
      const double tilt = piece.state(piece.end * part / parts)[2];
      least_ = std::min(least_, tilt);
      most_ = std::max(most_, tilt);
    }
    for (std::size_t half = 0; half < 2; ++half) {
      if ((acting & halves_[half]) != 0) time_[half] += piece.length * piece.end;
      lost_[half] = lost_[half] || (acting & halves_[half]) != halves_[half];
    }
  }
  void change(const ContactChange & /*change*/) override {}

  bool lost(std::size_t half) const { return lost_[half]; }
  void take(EndsPoint &point, double time) const {
    point.tilt = 0.5 * (most_ - least_);
    for (std::size_t half = 0; half < 2; ++half)
      point.contact_share[half] = std::min(1.0, time_[half] / time);
  }

private:
  std::array<std::uint32_t, 2> halves_{};
  std::array<double, 2> time_{};
  std::array<bool, 2> lost_{};
  double least_ = std::numeric_limits<double>::infinity(), most_ = -least_;
};

/// The mode of a motion of two cycles by what differs between them.
EndsMode mode_of_two(const EndsCycles &system, const TwoEndsState &state) {
  const TwoEndsState apart = (system.pass(state, 1, false).end - state).cwiseQuotient(system.scale());
  const double height = std::hypot(apart[0], apart[4]), tilt = std::hypot(apart[2], apart[6]);
  constexpr double mostly = 3.0;
  return tilt < height / mostly   ? EndsMode::double_jump
         : tilt > mostly * height ? EndsMode::rocking
                                  : EndsMode::combined;
}

} // namespace

EndsPoint judge_ends_from(const TwoEndsSolver &solver, TwoEndsMotion &motion, int cycles) {
  const EndsCycles system{solver};
  const auto settled = settle(system, motion, cycles);
  EndsPoint point;
  constexpr int window = 64;
  int counted = window;
  TwoEndsState state = settled.state;
  if (settled.orbit) {
    state = settled.orbit->state;
    counted = point.period = settled.orbit->period;
    point.multiplier = std::abs(settled.orbit->multipliers[0]);
    constexpr double forgotten = -1e3; // a multiplier of zero has no logarithm
    const double rate = point.multiplier > 0.0 ? std::log(point.multiplier) / point.period : forgotten;
    point.exponent = {rate, rate, rate};
  } else {
    point.exponent = settled.exponent;
    if (settled.aperiodic) point.mode = EndsMode::aperiodic;
  }
  HalfSums sums(solver.machine());
  motion = solver.start_at(state);
  for (int cycle = 0; cycle < counted; ++cycle)
    solver.finish_cycle(motion, &sums);
  sums.take(point, counted * solver.machine().chain.period());
  if (point.period == 1)
    point.mode = sums.lost(0) && sums.lost(1)   ? EndsMode::uplift_of_both_ends
                 : sums.lost(0) || sums.lost(1) ? EndsMode::uplift_of_one_end
                                                : EndsMode::continuous_contact;
  else if (point.period == 2)
    point.mode = mode_of_two(system, state);
  else if (point.period > 2)
    point.mode = EndsMode::higher_period;
  return point;
}

EndsPoint judge_ends(const TwoEnds &machine, int cycles) {
  const TwoEndsSolver solver(machine);
  TwoEndsMotion motion = solver.start();
  return judge_ends_from(solver, motion, cycles);
}

double ends_margin(const TwoEnds &machine) {
  using Complex = std::complex<double>;
  const ChainParameters &p = machine.chain;
  Eigen::Matrix4cd dynamic = Eigen::Matrix4cd::Zero();
  Eigen::Matrix4d spring = Eigen::Matrix4d::Zero();
  dynamic.diagonal() =
      -p.omega * p.omega * Eigen::Vector4cd(p.m2, p.m3, machine.drum_inertia, machine.frame_inertia);
  const auto add = [&](const AxleLink &link, const Eigen::Vector4d &way) {
    const Eigen::Matrix4d square = way * way.transpose();
    dynamic += Complex(link.k, p.omega * link.c) * square.cast<Complex>();
    spring += link.k * square;
  };
  for (const AxleLink &link : machine.contacts)
    add(link, {1.0, 0.0, link.y, 0.0});
  for (const AxleLink &link : machine.bonds)
    add(link, {1.0, -1.0, link.y, -link.y});
  const Eigen::Vector4d push(-p.Fw, 0.0, -machine.exciter * p.Fw, 0.0),
      weight(-p.m2 * p.g, -p.m3 * p.g, 0.0, 0.0);
  const Eigen::Vector4cd amplitude = dynamic.fullPivLu().solve(push.cast<Complex>());
  const Eigen::Vector4d mean = solution_of(spring, weight);
  double least = std::numeric_limits<double>::infinity();
  for (const AxleLink &link : machine.contacts) {
    const double c = p.transition == Transition::B ? link.c : 0.0;
    const double swing = std::abs((amplitude[0] + link.y * amplitude[2]) * Complex(link.k, p.omega * c));
    least = std::min(least, -link.k * (mean[0] + link.y * mean[2]) - swing);
  }
  return least;
}

TwoEnds EndsFamily::at(const std::vector<std::pair<std::string, double>> &values) const {
  constexpr double small = 1e-5; // rad
  const ChainParameters parameters = chain.with(values);
  TwoEnds machine = two_ends(parameters, roller);
  machine.contacts = equal_contacts(contacts, drum_width(roller), parameters.k, parameters.damping());
  machine.tilt = small;
  for (const auto &[name, value] : values)
    if (name == ratio_name) set_ratio(machine.contacts, value);
  return machine;
}

namespace {

TwoEnds machine_at(const EndsFamily &family, const MapGrid &grid, double x, double y) {
  return family.at({{grid.x.name, x}, {grid.y.name, y}});
}

} // namespace

EndsPoint judged(const EndsFamily &family, const MapGrid &grid, std::size_t point) {
  return judge_ends(machine_at(family, grid, grid.x_of(point), grid.y_of(point)), grid.cycles);
}

std::vector<BoundaryPoint> ends_boundaries(const EndsFamily &family, const MapGrid &grid,
                                           const std::vector<EndsPoint> &points, int threads,
                                           const std::function<void(double)> &progress) {
  return boundaries_on_edges(
      grid, threads, progress,
      [&](double x, double y) { return ends_margin(machine_at(family, grid, x, y)); },
      [&](std::size_t point) { return points[point].period; },
      [&](const GridEdge &edge, double from, double to, int period) -> std::optional<OrbitChange> {
        const auto solver_at = [&](double value) {
          const auto [x, y] = edge.at(value);
          return TwoEndsSolver(machine_at(family, grid, x, y));
        };
        const TwoEndsSolver solver = solver_at(from);
        TwoEndsMotion motion = solver.start();
        for (int cycle = 0; cycle < grid.cycles; ++cycle)
          solver.finish_cycle(motion);
        const auto orbit = newton_orbit(EndsCycles{solver}, motion.state, period);
        if (!orbit || !orbit->stable()) return std::nullopt;
        return located_doubling<EndsCycles>(solver_at, from, to, *orbit);
      });
}

std::vector<EndsSample> sweep_ends(const EndsFamily &family, const MapAxis &axis, int cycles,
                                   const std::function<void(double)> &progress) {
  constexpr double kick = 1e-6; // rad
  std::vector<EndsSample> samples;
  std::optional<TwoEndsState> state;
  for (const bool up : {true, false})
    for (int i = 0; i < axis.count; ++i) {
      const double value = axis.value(up ? i : axis.count - 1 - i);
      const TwoEndsSolver solver(family.at({{axis.name, value}}));
      if (state) (*state)[2] += kick;
      TwoEndsMotion motion = state ? solver.start_at(*state) : solver.start();
      samples.push_back({up, value, judge_ends_from(solver, motion, cycles)});
      state = motion.state;
      progress((up ? 0.0 : 0.5) + 0.5 * (i + 1) / axis.count);
    }
  return samples;
}

MapFigures ends_figures(const MapGrid &grid, const std::vector<EndsPoint> &points,
                        const std::vector<BoundaryPoint> &boundaries) {
  MapFigures result;
  std::array<bool, ends_mode_count> seen{};
  std::string cells = "x,y,left,right,low,high,mode,tilt_mrad,contact_left,contact_right\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto mode = static_cast<std::size_t>(points[i].mode);
    seen[mode] = true;
    cells += fmt::format("{},{},{:.6g},{:.6g},{:.6g}\n", point_cells(grid, i), mode, 1e3 * points[i].tilt,
                         points[i].contact_share[0], points[i].contact_share[1]);
  }
  const BoundaryMarks marks = boundary_marks(grid, boundaries);
  result.data = {{"plot_ends.csv", cells}, {"plot_boundaries.csv", marks.rows}};
  const std::string given = conditions(grid.chain, {grid.x.parameter(), grid.y.parameter()});
  const auto add = [&](const std::string &name, const std::string &title, Panel panel) {
    panel.curves.insert(panel.curves.end(), marks.curves.begin(), marks.curves.end());
    Figure figure;
    figure.name = name;
    figure.title = title;
    figure.only_png = true;
    figure.panels = {std::move(panel)};
    result.figures.push_back(figure);
  };
  constexpr std::array<CurveStyle, ends_mode_count> styles = {
      CurveStyle::area_1, CurveStyle::area_2, CurveStyle::area_4, CurveStyle::area_3, CurveStyle::area_7,
      CurveStyle::area_8, CurveStyle::area_9, CurveStyle::area_5, CurveStyle::area_6};
  Panel modes = map_panel(grid, given);
  for (std::size_t i = 0; i < ends_mode_count; ++i)
    if (seen[i])
      modes.curves.push_back(
          {"plot_ends.csv", fmt::format("($7=={}?$1:NaN)", i), "2:3:4:5:6", ends_mode_names[i], styles[i]});
  add("modes", "Motion of both ends", modes);
  struct Layer {
    const char *name, *title, *label;
    int column;
  };
  for (const Layer &layer :
       {Layer{"tilt", "Tilt of the drum", "half the range of the tilt [mrad]", 8},
        {"contact_left", "Contact of the left half", "share of time in contact", 9},
        {"contact_right", "Contact of the right half", "share of time in contact", 10}}) {
    Panel panel = map_panel(grid, given);
    panel.color_label = layer.label;
    panel.curves.push_back(
        {"plot_ends.csv", "1", fmt::format("2:3:4:5:6:{}", layer.column), "", CurveStyle::cells});
    add(layer.name, layer.title, panel);
  }
  return result;
}

MapFigures ends_sweep_figures(const MapChain &chain, const MapAxis &axis,
                              const std::vector<EndsSample> &samples) {
  MapFigures result;
  const ShownAxis shown = shown_axis(axis);
  std::string rows = "up,value,tilt_mrad\n";
  for (const EndsSample &sample : samples)
    rows +=
        fmt::format("{:d},{:.10g},{:.8g}\n", sample.up, shown.scale * sample.value, 1e3 * sample.point.tilt);
  result.data = {{"plot_samples.csv", rows}};
  Figure figure;
  figure.name = "sweep";
  figure.title = "Tilt of the drum";
  figure.only_png = true;
  Panel panel{conditions(chain, {axis.parameter()}), shown.label, "half the range of the tilt [mrad]", {}};
  panel.log_x = axis.log;
  panel.x_range = axis_range(shown.scale * axis.from, shown.scale * axis.to);
  panel.curves.push_back({"plot_samples.csv", "($1==0?$2:NaN)", "3", "downwards", CurveStyle::measured_a});
  panel.curves.push_back({"plot_samples.csv", "($1==1?$2:NaN)", "3", "upwards", CurveStyle::mark_1});
  figure.panels = {panel};
  result.figures = {figure};
  return result;
}

} // namespace drumlin::post
