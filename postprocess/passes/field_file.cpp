#include "passes/field_file.h"

#include "support/csv.h"
#include "support/range.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double degree = 3.14159265358979323846 / 180.0;

/// Units as headers and cells of these files have them, with the factor to SI.
constexpr std::array<std::pair<const char *, double>, 9> units = {{{"km/h", 1.0 / 3.6},
                                                                   {"mph", 0.44704},
                                                                   {"m/s", 1.0},
                                                                   {"hz", 1.0},
                                                                   {"mm", 1e-3},
                                                                   {"ft", 0.3048},
                                                                   {"in", 0.0254},
                                                                   {"m", 1.0},
                                                                   {"vpm", 1.0 / 60.0}}};

std::string lower(const std::string &text) {
  std::string all = text;
  std::transform(all.begin(), all.end(), all.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return all;
}

/// A name of the header: what it is called, and the factor of its unit; 0: it has no unit.
struct FieldName {
  std::string name; ///< lower case, without Last and unit
  double factor = 0.0;
};

FieldName field_name(const std::string &header) {
  FieldName found{lower(header), 0.0};
  if (found.name.rfind("last", 0) == 0) found.name.erase(0, found.name.find_first_not_of("_ ", 4));
  const std::size_t mark = found.name.find_last_of("_ ([");
  if (mark == std::string::npos) return found;
  std::string unit = found.name.substr(mark + 1);
  if (!unit.empty() && (unit.back() == ')' || unit.back() == ']')) unit.pop_back();
  for (const auto &[name, factor] : units)
    if (unit == name) {
      found.name.erase(found.name.find_last_not_of("_ ([", mark) + 1);
      found.factor = factor;
    }
  return found;
}

/// Whether a cell says that its value is not known.
bool unknown(const std::string &cell) { return cell.empty() || cell == "?" || lower(cell) == "nan"; }

/// Reads the rows of one file.
class FieldReader {
public:
  FieldReader(const std::filesystem::path &file, const std::string &meter, double cell)
      : rows_(file, CutRows::last), meter_name_(meter) {
    field_.file = file;
    field_.cell = cell;
    for (const std::string &header : rows_.header())
      names_.push_back(field_name(header));
    // The header of this format has a comma within the name of its last column, LastTemp,_c.
    const std::string &end = rows_.header().back();
    fewer_ = end == "_c" || end == "_f" ? 1 : 0;
    find_columns();
  }

  FieldFile read() {
    std::vector<std::string> cells;
    while (rows_.next(cells, fewer_))
      take(cells);
    if (points_.empty())
      csv_fault(
          field_.file, 0, {},
          fmt::format("has no row of a cell with a valid position among {}; allowed: one or more", invalid_));
    place_cells();
    add_notes();
    return std::move(field_);
  }

private:
  struct Column {
    std::size_t place = 0;
    double factor = 1.0;
    bool given = false;
  };
  struct Point {
    double north, east; ///< m, or degrees
    FieldRow row;
    std::size_t line;
  };

  /// The first column of one of these names.
  Column find(std::initializer_list<const char *> names, double usual) {
    for (const char *name : names)
      for (std::size_t i = 0; i + fewer_ < names_.size(); ++i)
        if (names_[i].name == name) {
          if (names_[i].factor == 0.0 && usual == 1.0) without_unit_ = true;
          return {i, names_[i].factor > 0.0 ? names_[i].factor : usual, true};
        }
    return {};
  }

  void find_columns() {
    pass_ = find({"passnumber", "passcount", "pass", "passno"}, 0.0);
    if (!pass_.given) rows_.missing("PassNumber");
    without_unit_ = false;
    north_ = find({"celln", "northing", "north"}, 1.0);
    east_ = find({"celle", "easting", "east"}, 1.0);
    if (!north_.given || !east_.given) {
      north_ = find({"lat", "latitude"}, 0.0);
      east_ = find({"long", "lon", "longitude"}, 0.0);
      degrees_ = north_.given && east_.given;
      if (!degrees_) rows_.missing("CellN_m");
      north_.factor = east_.factor = 1.0;
    }
    elevation_ = find({"elevation", "elev", "height"}, 1.0);
    speed_ = find({"speed"}, 0.0);
    frequency_ = find({"freq", "frequency"}, 0.0);
    amplitude_ = find({"amp", "amplitude"}, 0.0);
    valid_ = find({"validpos"}, 0.0);
    vibration_ = find({"vibestate"}, 0.0);
    const FieldName wanted = field_name(meter_name_);
    meter_ = find({wanted.name.c_str()}, 0.0);
    if (!meter_.given) rows_.missing(meter_name_);
    field_.meter = rows_.header()[meter_.place];
    if (lower(field_.meter).rfind("last", 0) == 0) field_.meter.erase(0, 4);
    const bool ratio = wanted.name == "cmv" || wanted.name == "rmv" || wanted.name == "ccv";
    field_.unit = ratio ? "-" : "?";
  }

  /// A number of a cell, NaN if it is not known. Behind it may stand a unit.
  double number(const std::vector<std::string> &cells, const Column &column) const {
    if (!column.given || unknown(cells[column.place])) return none;
    const std::string &cell = cells[column.place];
    double factor = column.factor == 0.0 ? 1.0 : column.factor;
    std::string digits = cell;
    for (const auto &[unit, of_unit] : units) {
      const std::string ending = unit;
      if (digits.size() <= ending.size() || lower(digits.substr(digits.size() - ending.size())) != ending)
        continue;
      digits.erase(digits.size() - ending.size());
      factor = of_unit;
      break;
    }
    const std::optional<double> value = any_number_from_text(digits);
    constexpr double most = 1e12;
    if (!value || !(std::abs(*value) <= most))
      csv_refusal(field_.file, rows_.line(), rows_.header()[column.place], cell,
                  "a number of at most 1e12, with or without its unit, or ?");
    return factor * *value;
  }

  double known_number(const std::vector<std::string> &cells, const Column &column) const {
    const double value = number(cells, column);
    if (std::isnan(value))
      csv_refusal(field_.file, rows_.line(), rows_.header()[column.place], cells[column.place],
                  "a number, which every row with a valid position has");
    return value;
  }

  void take(const std::vector<std::string> &cells) {
    if (valid_.given && lower(cells[valid_.place]) == "no") {
      ++invalid_;
      return;
    }
    Point point{known_number(cells, north_), known_number(cells, east_), {}, rows_.line()};
    const double pass = known_number(cells, pass_);
    constexpr double most_passes = 65535.0;
    if (!(pass >= 1.0 && pass <= most_passes && pass == std::floor(pass)))
      csv_refusal(field_.file, rows_.line(), rows_.header()[pass_.place], cells[pass_.place],
                  "a whole number from 1 to 65535");
    if (degrees_ && !(std::abs(point.north) <= 90.0 && std::abs(point.east) <= 180.0))
      csv_refusal(field_.file, rows_.line(), rows_.header()[north_.place], cells[north_.place],
                  "latitudes of at most 90 and longitudes of at most 180 degrees");
    point.row.pass = static_cast<int>(pass);
    point.row.value = number(cells, meter_);
    if (vibration_.given && lower(cells[vibration_.place]) == "off" && !std::isnan(point.row.value)) {
      point.row.value = none;
      ++off_;
    }
    point.row.elevation = number(cells, elevation_);
    point.row.speed = number(cells, speed_);
    point.row.frequency = number(cells, frequency_);
    point.row.amplitude = number(cells, amplitude_);
    points_.push_back(point);
  }

  /// Gives each cell of the grid a place along the longest extent of all, and each place its rows.
  void place_cells() {
    const double north0 = points_.front().north, east0 = points_.front().east;
    constexpr double earth = 6371000.0; // m, mean radius
    const double to_north = degrees_ ? degree * earth : 1.0;
    const double to_east = degrees_ ? degree * earth * std::cos(degree * north0) : 1.0;
    std::map<std::pair<long, long>, std::size_t> places;
    std::vector<std::pair<double, double>> middles;
    std::map<std::pair<int, std::size_t>, FieldRow> rows;
    for (Point &point : points_) {
      const double north = to_north * (point.north - north0), east = to_east * (point.east - east0);
      constexpr double most = 1e5; // m: farther away the plane ends, and so does a site
      if (!(std::abs(north) <= most && std::abs(east) <= most))
        csv_refusal(field_.file, point.line, rows_.header()[north_.place],
                    fmt::format("{:.10g}", point.north),
                    "cells of one site, at most 100 km from the first row");
      const std::pair key(std::lround(north / field_.cell), std::lround(east / field_.cell));
      const auto [at, is_new] = places.emplace(key, middles.size());
      if (is_new) middles.emplace_back(north, east);
      point.row.place = at->second;
      if (!rows.insert_or_assign({point.row.pass, at->second}, point.row).second) ++replaced_;
    }
    const auto [c, s] = direction(middles);
    double least = std::numeric_limits<double>::infinity();
    for (const auto &[north, east] : middles) {
      field_.places.push_back({0, c * north + s * east, s * north - c * east, east, north});
      least = std::min(least, field_.places.back().along);
    }
    MapPlace corner{0, 0.0, 1e9, 1e9, 1e9};
    for (MapPlace &place : field_.places) {
      place.along -= least;
      corner.across = std::min(corner.across, place.across);
      corner.east = std::min(corner.east, place.east);
      corner.north = std::min(corner.north, place.north);
    }
    for (MapPlace &place : field_.places) {
      place.across -= corner.across;
      place.east -= corner.east;
      place.north -= corner.north;
    }
    for (const auto &[key, row] : rows)
      field_.rows.push_back(row);
  }

  /// Cosine and sine of the angle from north to the direction in which the cells reach farthest, by their
  /// second moments; north counts as forward, and of east and west east.
  std::pair<double, double> direction(const std::vector<std::pair<double, double>> &middles) {
    double n = 0.0, e = 0.0;
    const auto count = static_cast<double>(middles.size());
    for (const auto &[north, east] : middles) {
      n += north / count;
      e += east / count;
    }
    double nn = 0.0, ee = 0.0, ne = 0.0;
    for (const auto &[north, east] : middles) {
      nn += (north - n) * (north - n);
      ee += (east - e) * (east - e);
      ne += (north - n) * (east - e);
    }
    const double angle = 0.5 * std::atan2(2.0 * ne, nn - ee); // from -90 to 90 degrees
    bearing_ = angle / degree;
    return {std::cos(angle), std::sin(angle)};
  }

  void add_notes() {
    std::vector<std::string> &notes = field_.notes;
    notes.push_back(fmt::format(
        "{} rows, {} cells of {:g} m; the way is taken to lead along the longest extent of the cells, {:.0f} "
        "degrees from north to east.",
        points_.size() + invalid_, field_.places.size(), field_.cell,
        bearing_ < 0.0 ? bearing_ + 180.0 : bearing_));
    if (without_unit_ && !degrees_)
      notes.emplace_back("Coordinates or elevations have no unit in the header and are taken as metres.");
    if (field_.unit == "?")
      notes.push_back(fmt::format("The file does not tell the unit of {}.", field_.meter));
    if (invalid_ > 0) notes.push_back(fmt::format("Rows without a valid position, left out: {}.", invalid_));
    if (off_ > 0)
      notes.push_back(fmt::format("Values of the meter with the exciter off, left out: {}.", off_));
    if (replaced_ > 0)
      notes.push_back(fmt::format("Rows of a cell and pass that a later row has, too, of which the last one "
                                  "counts: {}.",
                                  replaced_));
  }

  CsvRows rows_;
  std::string meter_name_;
  FieldFile field_;
  std::vector<FieldName> names_;
  std::size_t fewer_ = 0;
  Column pass_, north_, east_, elevation_, speed_, frequency_, amplitude_, valid_, vibration_, meter_;
  bool degrees_ = false, without_unit_ = false;
  std::vector<Point> points_;
  std::size_t invalid_ = 0, off_ = 0, replaced_ = 0;
  double bearing_ = 0.0;
};

std::string cell_of(double value) { return std::isfinite(value) ? number_text(value) : ""; }

/// Mean of the values that are known; NaN without one.
class KnownMean {
public:
  void add(double value) {
    if (std::isnan(value)) return;
    sum_ += value;
    count_ += 1.0;
  }
  double mean() const { return count_ > 0.0 ? sum_ / count_ : none; }

private:
  double sum_ = 0.0, count_ = 0.0;
};

} // namespace

FieldFile read_field_file(const std::filesystem::path &file, const std::string &meter, double cell) {
  return FieldReader(file, meter, cell).read();
}

MeterMap meter_map(const FieldFile &field) {
  MeterMap map;
  map.meter = field.meter;
  map.unit = field.unit;
  map.cell = field.cell;
  map.places = field.places;
  for (const FieldRow &row : field.rows)
    if (!std::isnan(row.value)) map.values.push_back({row.pass, row.place, row.value});
  if (map.values.empty())
    csv_fault(field.file, 0, field.meter, "has no value; allowed: a meter that the file gives");
  return map;
}

std::string passes_csv(const FieldFile &field) {
  std::string text = csv_line({"pass", "cells [-]", "settlement [m]", "speed [m/s]", "frequency [Hz]",
                               "amplitude [m]", fmt::format("{} [{}]", field.meter, field.unit)});
  // Settlement: how much lower than in its first pass each cell is.
  std::vector<double> first(field.places.size(), none);
  for (auto row = field.rows.begin(); row != field.rows.end();) {
    KnownMean settlement, speed, frequency, amplitude, value;
    const int pass = row->pass;
    const auto begin = row;
    for (; row != field.rows.end() && row->pass == pass; ++row) {
      if (std::isnan(first[row->place])) first[row->place] = row->elevation;
      settlement.add(first[row->place] - row->elevation);
      speed.add(row->speed);
      frequency.add(row->frequency);
      amplitude.add(row->amplitude);
      value.add(row->value);
    }
    text += csv_line({std::to_string(pass), std::to_string(row - begin), cell_of(settlement.mean()),
                      cell_of(speed.mean()), cell_of(frequency.mean()), cell_of(amplitude.mean()),
                      cell_of(value.mean())});
  }
  return text;
}

std::string way_csv(const FieldFile &field) {
  std::string text = csv_line({"pass", "s [m]", "left [m]", "elevation [m]", "speed [m/s]", "frequency [Hz]",
                               "amplitude [m]", fmt::format("{} [{}]", field.meter, field.unit)});
  for (const FieldRow &row : field.rows)
    text += csv_line({std::to_string(row.pass), cell_of(field.places[row.place].along),
                      cell_of(field.places[row.place].across), cell_of(row.elevation), cell_of(row.speed),
                      cell_of(row.frequency), cell_of(row.amplitude), cell_of(row.value)});
  return text;
}

} // namespace drumlin::post
