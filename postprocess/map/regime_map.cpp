#include "map/regime_map.h"

#include "support/csv.h"
#include "support/parallel.h"
#include "support/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <stdexcept>

namespace drumlin::post {

namespace {

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

/// The factor to SI of a unit with a k or M before that of SI, or of t; nothing of others.
std::optional<double> factor_of(const std::string &unit, const std::string &si) {
  if (si.empty()) return std::nullopt;
  if (unit == si) return 1.0;
  if (unit == "k" + si || (unit == "t" && si == "kg")) return 1e3;
  if (unit == "M" + si) return 1e6;
  return std::nullopt;
}

/// Below which a number without a unit was meant in another one; 0: any may be meant.
double least_without_unit(const std::string &name) {
  return name == "k" || name == "k23" ? 1e4 : name == "Fw" ? 1e3 : 0.0;
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
  if (parts.size() > 4 && parts.back() == "log") {
    axis.log = true;
    parts.pop_back();
  }
  if (parts.size() < 4 || parts.size() > 5)
    fail("NAME:FROM:TO:COUNT, with :UNIT or :log behind it or both, e.g. k:1:200:100:MN/m:log");
  if (number_named(axis.name) == nullptr && axis.name != "frequency" && axis.name != "me_re" &&
      axis.name != ratio_name)
    fail("a NAME of k, D, omega, frequency, Fw, me_re, m2, m3, k23, c23, and with --contacts ratio");
  double count = 0.0;
  try {
    axis.from = number_from_text(parts[1]);
    axis.to = number_from_text(parts[2]);
    count = number_from_text(parts[3]);
  } catch (const std::invalid_argument &) {
    fail("numbers for FROM, TO and COUNT");
  }
  const Range &range = range_of(axis.name);
  const std::string unit = range.unit;
  if (parts.size() == 5) {
    const std::optional<double> factor = factor_of(parts[4], unit);
    if (!factor) fail(unit.empty() ? "no unit" : fmt::format("the unit {0}, k{0} or M{0}", unit));
    axis.from *= *factor;
    axis.to *= *factor;
  }
  if (!range.holds(axis.from) || !range.holds(axis.to))
    fail(fmt::format("FROM and TO for {}: {}", axis.name, range.words()));
  if (parts.size() == 4 && axis.to < least_without_unit(axis.name))
    fail(fmt::format("{} in {}, {:g} or more, or with its unit: {}:M{}", axis.name, unit,
                     least_without_unit(axis.name), text, unit));
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

namespace {

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

std::vector<GridEdge> edges_of(const MapGrid &grid) {
  std::vector<GridEdge> edges;
  const auto width = static_cast<std::size_t>(grid.x.count);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (i % width + 1 < width)
      edges.push_back({i, i + 1, grid.x_of(i), grid.x_of(i + 1), grid.y_of(i), true});
    if (i + width < grid.size())
      edges.push_back({i, i + width, grid.y_of(i), grid.y_of(i + width), grid.x_of(i), false});
  }
  return edges;
}

} // namespace

std::vector<BoundaryPoint> boundaries_on_edges(
    const MapGrid &grid, int threads, const std::function<void(double)> &progress,
    const std::function<double(double x, double y)> &margin,
    const std::function<int(std::size_t point)> &period,
    const std::function<std::optional<OrbitChange>(const GridEdge &edge, double from, double to, int period)>
        &doubling) {
  const std::vector<GridEdge> edges = edges_of(grid);
  std::vector<double> margins(grid.size());
  in_parallel(grid.size(), threads, [&](std::size_t i) { margins[i] = margin(grid.x_of(i), grid.y_of(i)); });
  std::vector<std::vector<BoundaryPoint>> found(edges.size());
  std::atomic<std::size_t> done = 0;
  std::mutex guard;
  in_parallel(edges.size(), threads, [&](std::size_t e) {
    const GridEdge &edge = edges[e];
    const auto take = [&](const char *kind, double value) {
      const auto [x, y] = edge.at(value);
      found[e].push_back({kind, x, y});
    };
    const auto held = [&](double value) {
      const auto [x, y] = edge.at(value);
      return margin(x, y) > 0.0;
    };
    if (const bool at_a = margins[edge.a] > 0.0; at_a != (margins[edge.b] > 0.0))
      take("loss of contact",
           bisected(edge.from, edge.to, [&](double value) { return held(value) == at_a; }));
    // From an orbit of some period to one of another, or to none: does a multiplier of it pass -1?
    const int a = period(edge.a), b = period(edge.b);
    const bool from_a = a != 0 && (b == 0 || a < b);
    if (a != b)
      if (const auto change =
              doubling(edge, from_a ? edge.from : edge.to, from_a ? edge.to : edge.from, from_a ? a : b))
        take(change->smooth ? "period doubling" : "border", change->value);
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

std::vector<BoundaryPoint> find_boundaries(const MapGrid &grid, const std::vector<RegimePoint> &points,
                                           int threads, const std::function<void(double)> &progress) {
  return boundaries_on_edges(
      grid, threads, progress, [&](double x, double y) { return contact_margin(grid.at(x, y)); },
      [&](std::size_t point) { return points[point].period; },
      [&](const GridEdge &edge, double from, double to, int period) -> std::optional<OrbitChange> {
        const ChainFamily family = [&](double value) {
          const auto [x, y] = edge.at(value);
          return grid.at(x, y);
        };
        const auto orbit = settled_orbit(family(from), grid.cycles, period);
        return orbit ? locate_doubling(family, from, to, *orbit) : std::nullopt;
      });
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
    const auto lasts = [&](double value) { return contact_margin(family(value)) > 0.0; };
    const double from = axis.value(i), to = axis.value(i + 1);
    if (const bool at_from = lasts(from); at_from != lasts(to))
      result.boundaries.push_back({"loss of contact",
                                   bisected(from, to, [&](double value) { return lasts(value) == at_from; }),
                                   0.0});
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
