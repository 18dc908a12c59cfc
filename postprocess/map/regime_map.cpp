#include "map/regime_map.h"

#include "support/csv.h"
#include "support/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>

namespace drumlin::post {

namespace {

constexpr double pi = 3.14159265358979323846;
const Range me_re_range = {1e-9, 1e12, "kg m"};
const Range frequency_in_hertz = {1e-6, 1e8, "Hz"};
const Range ratio_range = {1e-3, 1e3, ""};

const ChainNumber *number_named(const std::string &name) {
  const auto *const found = std::find_if(chain_numbers.begin(), chain_numbers.end(),
                                         [&](const ChainNumber &number) { return name == number.name; });
  return found == chain_numbers.end() || name == "g" ? nullptr : found;
}

const Range &range_of(const std::string &name) {
  const ChainNumber *number = number_named(name);
  return number != nullptr     ? number->range
         : name == "frequency" ? frequency_in_hertz
         : name == ratio_name  ? ratio_range
                               : me_re_range;
}

} // namespace

double MapAxis::value(double place) const {
  const double share = count > 1 ? place / (count - 1) : 0.0;
  if (share == 1.0) return to;
  return log ? from * std::pow(to / from, share) : from + (to - from) * share;
}

std::string MapAxis::parameter() const { return name == "frequency" ? "omega" : name; }

std::string MapAxis::unit() const {
  const std::string unit = range_of(name).unit;
  return unit.empty() ? "-" : unit;
}

std::string MapAxis::label() const { return fmt::format("{} [{}]", name, unit()); }

MapAxis axis_from_text(const std::string &option, const std::string &text, int most_values) {
  const auto fail = [&](const std::string &allowed) {
    throw std::invalid_argument(refusal(option, text, allowed));
  };
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ':')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  MapAxis axis;
  axis.name = parts[0];
  if (parts.size() < 4 || parts.size() > 5 || (parts.size() == 5 && parts[4] != "log"))
    fail("NAME:FROM:TO:COUNT or NAME:FROM:TO:COUNT:log, e.g. k:1e6:200e6:100:log");
  if (number_named(axis.name) == nullptr && axis.name != "frequency" && axis.name != "me_re" &&
      axis.name != ratio_name)
    fail("a NAME of k, D, omega, frequency, Fw, me_re, m2, m3, k23, c23, and with --contacts ratio");
  axis.log = parts.size() == 5;
  double count = 0.0;
  try {
    axis.from = number_from_text(parts[1]);
    axis.to = number_from_text(parts[2]);
    count = number_from_text(parts[3]);
  } catch (const std::invalid_argument &) {
    fail("numbers for FROM, TO and COUNT");
  }
  const Range &range = range_of(axis.name);
  if (!range.holds(axis.from) || !range.holds(axis.to))
    fail(fmt::format("FROM and TO for {}: {}", axis.name, range.words()));
  if (!(axis.from < axis.to)) fail("FROM smaller than TO");
  if (axis.log && axis.from <= 0.0) fail("FROM above 0 with log");
  if (!(count >= 2 && count <= most_values && count == std::floor(count)))
    fail(fmt::format("a whole number for COUNT from 2 to {}", most_values));
  axis.count = static_cast<int>(count);
  return axis;
}

ChainParameters MapChain::with(const std::vector<std::pair<std::string, double>> &values) const {
  ChainParameters parameters = base;
  std::optional<double> moment = me_re;
  for (const auto &[name, value] : values) {
    if (name == ratio_name) continue;
    if (const ChainNumber *number = number_named(name))
      parameters.*number->value = value;
    else if (name == "frequency")
      parameters.omega = 2.0 * pi * value;
    else
      moment = value;
  }
  if (moment) parameters.Fw = *moment * parameters.omega * parameters.omega;
  return parameters;
}

double MapGrid::x_of(std::size_t point) const {
  return x.value(static_cast<double>(point % static_cast<std::size_t>(x.count)));
}
double MapGrid::y_of(std::size_t point) const {
  const std::size_t row = point / static_cast<std::size_t>(x.count);
  return y.value(static_cast<double>(row));
}
ChainParameters MapGrid::at(double x_value, double y_value) const {
  return y.name.empty() ? chain.with({{x.name, x_value}})
                        : chain.with({{x.name, x_value}, {y.name, y_value}});
}

void judge_points(const MapGrid &grid, const std::vector<std::size_t> &numbers, int threads,
                  const std::function<void(std::size_t, const std::vector<RegimePoint> &)> &done) {
  constexpr std::size_t at_once = 200;
  for (std::size_t first = 0; first < numbers.size(); first += at_once) {
    std::vector<RegimePoint> points(std::min(at_once, numbers.size() - first));
    in_parallel(points.size(), threads, [&](std::size_t i) {
      const std::size_t number = numbers[first + i];
      points[i] = judge_regime(grid.at(grid.x_of(number), grid.y_of(number)), grid.cycles);
    });
    done(first, points);
  }
}

namespace {

// The line between two neighbours of the grid.
struct Edge {
  std::size_t a = 0, b = 0;
};

// The stable orbit that a chain reaches from rest within some cycles.
std::optional<PeriodicOrbit> settled_orbit(const ChainParameters &parameters, int cycles, int period) {
  const ChainSolver solver(parameters);
  ChainMotion motion = solver.start();
  for (int cycle = 0; cycle < cycles; ++cycle)
    solver.finish_cycle(motion);
  std::optional<PeriodicOrbit> orbit = find_orbit(solver, motion.state, period);
  // Near an aperiodic motion, which settles later, Newton's method finds unstable orbits.
  return orbit && orbit->stable() ? orbit : std::nullopt;
}

// The value between two at which contact begins to be lost, by bisection to rounding: the margin of contact
// has one sign at `from`, the other at `to`.
double loss_of_contact(const ChainFamily &family, double from, double to) {
  const bool held = contact_margin(family(from)) > 0.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (from + to);
    ((contact_margin(family(middle)) > 0.0) == held ? from : to) = middle;
  }
  return 0.5 * (from + to);
}

} // namespace

std::vector<BoundaryPoint> find_boundaries(const MapGrid &grid, const std::vector<RegimePoint> &points,
                                           int threads, const std::function<void(double)> &progress) {
  std::vector<Edge> edges;
  const auto width = static_cast<std::size_t>(grid.x.count);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % width + 1 < width) edges.push_back({i, i + 1});
    if (i + width < points.size()) edges.push_back({i, i + width});
  }
  std::vector<double> margin(points.size());
  in_parallel(points.size(), threads,
              [&](std::size_t i) { margin[i] = contact_margin(grid.at(grid.x_of(i), grid.y_of(i))); });

  std::vector<std::vector<BoundaryPoint>> found(edges.size());
  std::atomic<std::size_t> done = 0;
  std::mutex guard;
  in_parallel(edges.size(), threads, [&](std::size_t e) {
    const auto [a, b] = edges[e];
    const bool along_x = b == a + 1;
    const MapAxis &axis = along_x ? grid.x : grid.y;
    const auto place_of = [&](std::size_t point) {
      const std::size_t place = along_x ? point % width : point / width;
      return static_cast<double>(place);
    };
    const double fixed = along_x ? grid.y_of(a) : grid.x_of(a);
    const ChainFamily family = [&](double value) {
      return along_x ? grid.at(value, fixed) : grid.at(fixed, value);
    };
    const auto take = [&](const char *kind, double value) {
      found[e].push_back({kind, along_x ? value : fixed, along_x ? fixed : value});
    };
    if ((margin[a] > 0.0) != (margin[b] > 0.0))
      take("loss of contact", loss_of_contact(family, axis.value(place_of(a)), axis.value(place_of(b))));
    // From an orbit of some period to one of another, or to none: does a multiplier of it pass -1?
    const int period_a = points[a].period;
    const int period_b = points[b].period;
    if (period_a != period_b) {
      const bool from_a = period_a != 0 && (period_b == 0 || period_a < period_b);
      const std::size_t start = from_a ? a : b;
      const std::size_t end = from_a ? b : a;
      const int period = points[start].period;
      const double from = axis.value(place_of(start));
      if (period > 0) {
        if (const auto orbit = settled_orbit(family(from), grid.cycles, period))
          if (const auto change = locate_doubling(family, from, axis.value(place_of(end)), *orbit))
            take(change->smooth ? "period doubling" : "border", change->value);
      }
    }
    ++done;
    if (progress) {
      const std::lock_guard<std::mutex> lock(guard);
      progress(static_cast<double>(done) / static_cast<double>(edges.size()));
    }
  });
  std::vector<BoundaryPoint> all;
  for (const std::vector<BoundaryPoint> &some : found)
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

Sweep sweep(const MapChain &chain, const MapAxis &axis, int cycles, int kept,
            const std::function<void(double)> &progress) {
  const ChainFamily family = [&](double value) { return chain.with({{axis.name, value}}); };
  Sweep result;
  ChainState state = ChainSolver(family(axis.from)).start().state;
  for (const bool up : {true, false})
    for (int i = 0; i < axis.count; ++i) {
      const double value = axis.value(up ? i : axis.count - 1 - i);
      const ChainSolver solver(family(value));
      ChainMotion motion = solver.start_at(state);
      for (int cycle = 0; cycle < cycles; ++cycle) {
        if (cycle >= cycles - kept) result.samples.push_back({up, value, motion.state[0], motion.state[1]});
        solver.finish_cycle(motion);
      }
      state = motion.state;
      if (progress) progress((up ? 0.0 : 0.5) + 0.5 * (i + 1) / axis.count);
    }
  for (int i = 0; i + 1 < axis.count; ++i) {
    double from = axis.value(i);
    double to = axis.value(i + 1);
    const bool lasts = contact_margin(family(from)) > 0.0;
    if (lasts != (contact_margin(family(to)) > 0.0)) {
      for (int pass = 0; pass < 60; ++pass) {
        const double middle = 0.5 * (from + to);
        ((contact_margin(family(middle)) > 0.0) == lasts ? from : to) = middle;
      }
      result.boundaries.push_back({"loss of contact", 0.5 * (from + to), 0.0});
    }
  }
  // Along the orbit of period 1 from the first value, as far as it can be followed.
  std::optional<PeriodicOrbit> orbit = settled_orbit(family(axis.from), cycles, 1);
  for (int i = 0; orbit && i + 1 < axis.count; ++i) {
    const double from = axis.value(i);
    const double to = axis.value(i + 1);
    if (const auto change = locate_doubling(family, from, to, *orbit))
      result.boundaries.push_back({change->smooth ? "period doubling" : "border", change->value, 0.0});
    const std::vector<BranchPoint> branch = continue_orbit(family, from, to, 1, *orbit);
    if (branch.empty() || branch.back().value != to) break;
    orbit = branch.back().orbit;
  }
  return result;
}

} // namespace drumlin::post
