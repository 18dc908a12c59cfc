#include "map/course.h"

#include "identify/identified_record.h"
#include "record/chain_record.h"
#include "support/parallel.h"
#include "support/units.h"
#include "support/progress.h"
#include "support/resumed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <stdexcept>

namespace drumlin::post {

namespace {

template <double MeterValues::*part>
double of_meter(const CoursePoint &point) {
  return point.motion.meter.*part;
}

} // namespace

const std::array<CourseValue, 10> course_values = {
    {{"cmv", "CMV", "CMV [-]", "CMV [-]", of_meter<&MeterValues::cmv>, 1.0, 0.5},
     {"rmv", "RMV", "RMV [-]", "RMV [-]", of_meter<&MeterValues::rmv>, 1.0, 0.5},
     {"ccv", "CCV", "CCV [-]", "CCV [-]", of_meter<&MeterValues::ccv>, 1.0, 0.5},
     {"k_B", "k_B, soil and frame", "k_B [MN/m]", "k_B [N/m]", of_meter<&MeterValues::k_B>, 1e-6, 0.0, true},
     {"k_1", "k_1, without the frame", "k_1 [MN/m]", "k_1 [N/m]", of_meter<&MeterValues::k_1>, 1e-6, 0.0,
      true},
     {"c_1", "c_1, without the frame", "c_1 [kN s/m]", "c_1 [N s/m]", of_meter<&MeterValues::c_1>, 1e-3, 0.0},
     {"E_vib", "E_vib", "E_{vib} [MPa]", "E_vib [Pa]", [](const CoursePoint &point) { return point.E_vib; },
      1e-6, 0.0},
     {"energy", "Energy in two cycles", "energy in two cycles [J]", "energy_two_cycles [J]",
      of_meter<&MeterValues::energy>, 1.0, 0.0},
     {"peak_force", "Peak force", "peak force [kN]", "peak_force [N]", of_meter<&MeterValues::peak_force>,
      1e-3, 0.0},
     {"contact_share", "Share of contact", "share of contact [-]", "contact_share [-]",
      of_meter<&MeterValues::contact_share>, 1.0, 0.0}}};

CsvSchema<CoursePoint> course_columns(const MapAxis &axis, bool rollers) {
  constexpr int digits = 12;
  const auto meter = [](const char *name, double MeterValues::*part) {
    return csv_column_of<CoursePoint, double>(
        name, [part](auto &point) -> auto & { return point.motion.meter.*part; }, digits);
  };
  std::vector<CsvColumn<CoursePoint>> columns;
  if (rollers) columns.push_back(csv_column("roller", &CoursePoint::roller));
  columns.push_back(csv_column(axis.label(), &CoursePoint::value));
  if (axis.name != "k") columns.push_back(csv_column("k [N/m]", &CoursePoint::k));
  columns.push_back(
      {"regime",
       [](const CoursePoint &point) {
         return std::string(regime_names[static_cast<std::size_t>(point.motion.regime)]);
       },
       [](CoursePoint &point, const std::string &cell) { point.motion.regime = regime_from_name(cell); }});
  columns.push_back(csv_column("period [cycles]", &CoursePoint::motion, &RegimePoint::period));
  for (const auto &[name, part] : {std::pair{"CMV [-]", &MeterValues::cmv},
                                   {"RMV [-]", &MeterValues::rmv},
                                   {"CCV [-]", &MeterValues::ccv},
                                   {"k_B [N/m]", &MeterValues::k_B},
                                   {"k_1 [N/m]", &MeterValues::k_1},
                                   {"c_1 [N s/m]", &MeterValues::c_1}})
    columns.push_back(meter(name, part));
  columns.push_back(csv_column("E_vib [Pa]", &CoursePoint::E_vib, digits));
  for (const auto &[name, part] : {std::pair{"energy_two_cycles [J]", &MeterValues::energy},
                                   {"peak_force [N]", &MeterValues::peak_force},
                                   {"contact_share [-]", &MeterValues::contact_share}})
    columns.push_back(meter(name, part));
  for (const auto &[name, found] :
       {std::pair{std::string("identified"), &CoursePoint::exact}, {"measured", &CoursePoint::measured}}) {
    columns.push_back(csv_column("k_" + name + " [N/m]", found, &FoundLaw::k, digits));
    columns.push_back(csv_column("k_" + name + "_half_width [N/m]", found, &FoundLaw::k_half_width, digits));
    columns.push_back(csv_column("D_" + name + " [-]", found, &FoundLaw::D, digits));
    columns.push_back(csv_column("D_" + name + "_half_width [-]", found, &FoundLaw::D_half_width, digits));
  }
  columns.push_back(
      {"identification",
       [](const CoursePoint &point) { return std::string(point.identified ? "tried" : "not tried"); },
       [](CoursePoint &point, const std::string &cell) { point.identified = cell == "tried"; }});
  std::size_t keys = rollers ? 2 : 1;
  return CsvSchema<CoursePoint>(std::move(columns), keys);
}

namespace {

/// Adds what a real roller's record has: noise, and a phase of the exciter that is not exact.
Record measured_record(Record record, std::uint64_t seed) {
  constexpr double share = 0.01;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (std::vector<double> *signal : {&record.a_drum, &record.a_frame}) {
    const auto n = static_cast<double>(signal->size());
    double mean = 0.0;
    double square = 0.0;
    for (const double value : *signal)
      mean += value / n;
    for (const double value : *signal)
      square += (value - mean) * (value - mean) / n;
    for (double &value : *signal)
      value += share * std::sqrt(square) * normal(random);
  }
  for (std::size_t i = 0; i < record.size(); ++i)
    record.F_excitation[i] = *record.Fw * std::sin(*record.omega * record.time[i] + 0.5 * pi / 180.0);
  return record;
}

FoundLaw found_in(const Record &record, const RecordSetting &setting) {
  try {
    const LawEstimate law = identify_record(record, setting).whole.law;
    return {law.k.mean, law.k.half_width, law.D.mean, law.D.half_width};
  } catch (const std::runtime_error &) {
    return {};
  }
}

} // namespace

CoursePoint course_point(const ChainParameters &chain, const CourseSetting &setting) {
  CoursePoint point;
  point.k = chain.k;
  point.motion = judge_regime(chain, setting.cycles);
  const std::vector<double> &deflections = point.motion.meter.deflections;
  if (setting.drum) {
    double sum = 0.0;
    int count = 0;
    for (const double deflection : deflections)
      if (const auto modulus = lundberg_modulus(chain.k * deflection, deflection, *setting.drum)) {
        sum += *modulus;
        ++count;
      }
    if (count > 0) point.E_vib = sum / count;
  }
  if (!setting.identify) return point;
  point.identified = true;
  constexpr int cycles = 40;
  constexpr int samples_per_cycle = 250;
  const Record record =
      chain_record(chain, solve_chain(chain, cycles, samples_per_cycle, setting.cycles).history, 1);
  RecordSetting as;
  as.window = cycles;
  point.exact = found_in(record, as);
  as.accelerations_only = true;
  as.phase_within = pi / 180.0;
  point.measured = found_in(measured_record(record, setting.seed), as);
  return point;
}

std::vector<CoursePoint> course_points(const std::filesystem::path &file, const MapAxis &axis,
                                       const std::vector<CourseChain> &rollers, int threads) {
  const CsvSchema<CoursePoint> columns = course_columns(axis, !rollers.front().roller.empty());
  ResumedTable table(file, columns);
  std::vector<CoursePoint> points;
  std::vector<std::size_t> missing;
  for (const CourseChain &roller : rollers)
    for (int i = 0; i < axis.count; ++i) {
      CoursePoint point;
      point.roller = roller.roller;
      point.value = axis.value(i);
      point.k = roller.chain(point.value).k;
      if (!table.has(columns.key(point))) missing.push_back(points.size());
      points.push_back(point);
    }
  table.finish(); // before the work, for rows that belong to no point
  if (missing.size() < points.size())
    fmt::print("{} of {} points are there already\n", points.size() - missing.size(), points.size());
  const auto count = static_cast<std::size_t>(axis.count);
  const std::size_t at_once = 4 * static_cast<std::size_t>(threads);
  TimedProgress progress;
  for (std::size_t first = 0; first < missing.size(); first += at_once) {
    const std::size_t more = std::min(at_once, missing.size() - first);
    in_parallel(more, threads, [&](std::size_t i) {
      const std::size_t number = missing[first + i];
      const CourseChain &roller = rollers[number / count];
      const std::size_t place = number % count;
      CourseSetting setting = roller.setting;
      const auto every = static_cast<std::size_t>(roller.identify_every);
      setting.identify = every > 0 && (place % every == 0 || place + 1 == count);
      setting.seed = number + 1;
      CoursePoint point = course_point(roller.chain(points[number].value), setting);
      point.roller = points[number].roller;
      point.value = points[number].value;
      points[number] = point;
    });
    std::vector<ResumedTable::Row> rows;
    for (std::size_t i = first; i < first + more; ++i)
      rows.push_back(columns.cells(points[missing[i]]));
    table.add(rows);
    progress.tell("{} of {} points", points.size() - missing.size() + first + more, points.size());
  }
  table.finish();
  // With the digits of the file: an interrupted call gives the same.
  const std::vector<CoursePoint> written = read_points(table.file(), columns);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CoursePoint asked = points[i];
    points[i] = written.at(i);
    points[i].roller = asked.roller;
    points[i].value = asked.value;
    points[i].k = asked.k;
  }
  return points;
}

std::vector<std::size_t> turning_points(const std::vector<double> &values, double least) {
  std::vector<std::size_t> turns;
  std::size_t low = 0; // lowest and highest value since the last turn
  std::size_t high = 0;
  int direction = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] < values[low]) low = i;
    if (values[i] > values[high]) high = i;
    const bool falls = direction >= 0 && values[high] - values[i] > least;
    const bool rises = direction <= 0 && values[i] - values[low] > least;
    if (!falls && !rises) continue;
    if (direction != 0) turns.push_back(falls ? high : low);
    direction = falls ? -1 : 1;
    low = high = i;
  }
  return turns;
}

std::vector<double> Course::met_at(double value) const {
  std::vector<double> places;
  std::size_t from = 0;
  for (std::size_t stretch = 0; stretch <= turns.size(); ++stretch) {
    const std::size_t to = stretch < turns.size() ? turns[stretch] : values.size() - 1;
    for (std::size_t i = from; i < to; ++i) {
      if ((values[i] < value) == (values[i + 1] < value)) continue;
      const double share = (value - values[i]) / (values[i + 1] - values[i]);
      places.push_back(points[i].value + share * (points[i + 1].value - points[i].value));
      break;
    }
    from = to;
  }
  return places;
}

namespace {

/// At how many places of its course each value is met. Neighbours of the same value but for rounding count
/// each.
std::vector<std::size_t> counts_of(const Course &course, double range) {
  const std::vector<double> &values = course.values;
  const double rounding = 1e-6 * range;
  std::vector<std::size_t> borders = course.turns;
  borders.insert(borders.begin(), 0);
  borders.push_back(values.size() - 1);
  std::vector<std::size_t> counts;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::size_t count = 0;
    for (std::size_t s = 0; s + 1 < borders.size(); ++s) {
      if (borders[s] <= i && i <= borders[s + 1]) continue; // its own stretch
      const auto [low, high] = std::minmax(values[borders[s]], values[borders[s + 1]]);
      if (low < values[i] && values[i] < high) ++count;
    }
    const auto same = [&](std::size_t j) { return std::abs(values[j] - values[i]) <= rounding; };
    std::size_t first = i, last = i;
    while (first > 0 && same(first - 1))
      --first;
    while (last + 1 < values.size() && same(last + 1))
      ++last;
    counts.push_back(count + last - first + 1);
  }
  return counts;
}

} // namespace

Course course_of(const std::vector<CoursePoint> &points, const CourseValue &value) {
  Course course;
  for (const CoursePoint &point : points)
    if (std::isfinite(value.value(point))) {
      course.points.push_back(point);
      course.values.push_back(value.scale * value.value(point));
    }
  const std::vector<double> &values = course.values;
  if (values.empty()) return course;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  constexpr double share = 0.02;
  const double least = std::max(value.least, share * (*high - *low));
  course.turns = turning_points(values, least);
  const double change = values[course.turns.empty() ? values.size() - 1 : course.turns[0]] - values[0];
  course.first = !(std::fabs(change) > least) ? 0 : change > 0.0 ? 1 : -1;
  course.same = counts_of(course, std::max(*high - *low, value.least));
  return course;
}

std::string course_csv(const MapAxis &axis, const std::vector<CoursePoint> &points) {
  const CsvSchema<CoursePoint> columns = course_columns(axis, false);
  std::vector<std::string> header = columns.header();
  std::vector<std::vector<std::string>> rows;
  rows.reserve(points.size());
  for (const CoursePoint &point : points)
    rows.push_back(columns.cells(point));
  for (const CourseValue &value : course_values) {
    header.push_back(std::string("same_") + value.name + " [-]");
    const Course course = course_of(points, value);
    std::size_t next = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      rows[i].push_back(std::isfinite(value.value(points[i])) ? std::to_string(course.same[next++]) : "");
  }
  std::string text = csv_line(header);
  for (const std::vector<std::string> &row : rows)
    text += csv_line(row);
  return text;
}

} // namespace drumlin::post
