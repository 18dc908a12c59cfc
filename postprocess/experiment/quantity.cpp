#include "experiment/quantity.h"

#include "experiment/exact_quantities.h"
#include "record/record.h"
#include "identify/identified_record.h"
#include "meter/values.h"
#include "passes/drive.h"
#include "passes/values.h"
#include "support/csv.h"
#include "support/csv_schema.h"
#include "support/files.h"
#include "runs/parameter_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

/// The files of a run, each read and identified when a quantity first needs it.
class RunFiles {
public:
  RunFiles(std::filesystem::path folder, double width) : folder_(std::move(folder)), width_(width) {}

  double width() const { return width_; }
  const std::filesystem::path &folder() const { return folder_; }

  const Table &table(const std::string &name) {
    const auto found = tables_.find(name);
    if (found != tables_.end()) return found->second;
    if (!std::filesystem::exists(folder_ / name)) measure_passes_for(name);
    return tables_.emplace(name, read_table(folder_ / name, CutRows::last)).first->second;
  }

  double parameter(const std::string &name) {
    if (parameters_.empty()) parameters_ = read_parameters(folder_ / "parameters.csv");
    const auto found = parameters_.find(name);
    if (found == parameters_.end()) csv_fault(folder_ / "parameters.csv", 0, name, "is missing");
    return csv_value<double>(found->second);
  }

  const Record &record() {
    if (!record_) record_ = read_record(folder_);
    return *record_;
  }

  /// What `drumlin identify` finds in the whole record; nothing if the record does not determine a law, which
  /// is a result.
  const std::optional<IdentifiedRecord> &identified() {
    if (!tried_) {
      tried_ = true;
      const Record &all = record();
      try {
        identified_ = identify_record(all, {});
      } catch (const std::runtime_error &) { // there is no law
      }
    }
    return identified_;
  }

private:
  /// If `name` is a table of `drumlin passes`, measures the passes of this run and writes all these tables.
  void measure_passes_for(const std::string &name) const {
    constexpr std::array tables = {"passes.csv", "way.csv", "surface.csv", "depth.csv"};
    if (std::find(tables.begin(), tables.end(), name) == tables.end() ||
        !std::filesystem::is_directory(folder_ / "dump"))
      return;
    write_files(pass_tables(folder_, measure_passes(read_drive(folder_), {})));
  }

  std::filesystem::path folder_;
  double width_;
  std::map<std::string, Table> tables_;
  std::map<std::string, std::string> parameters_;
  std::optional<Record> record_;
  std::optional<IdentifiedRecord> identified_;
  bool tried_ = false;
};

namespace {

/// The first row that counts in means. The first row of cycles.csv is the start, no cycle.
std::ptrdiff_t second_half(const std::vector<double> &values) {
  return static_cast<std::ptrdiff_t>((values.size() + 1) / 2);
}

double mean_of(const std::vector<double> &values) {
  const auto begin = values.begin() + second_half(values);
  return std::accumulate(begin, values.end(), 0.0) / static_cast<double>(values.end() - begin);
}

/// The change over the second half of the rows.
double gain_of(const std::vector<double> &values) {
  return values.back() - values[static_cast<std::size_t>(second_half(values)) - 1];
}

double per_row_of(const std::vector<double> &values) {
  return gain_of(values) / static_cast<double>(values.end() - values.begin() - second_half(values));
}

/// How a column becomes one number.
struct ColumnWay {
  const char *name;
  std::size_t rows; ///< that it needs
  double (*value)(const std::vector<double> &);
};
const std::array<ColumnWay, 6> ways = {
    {{"last", 1, [](const std::vector<double> &values) { return values.back(); }},
     {"gain", 2, [](const std::vector<double> &values) { return values.back() - values.front(); }},
     {"mean", 2, &mean_of},
     {"largest", 1,
      [](const std::vector<double> &values) { return *std::max_element(values.begin(), values.end()); }},
     {"smallest", 1,
      [](const std::vector<double> &values) { return *std::min_element(values.begin(), values.end()); }},
     {"per_row", 2, &per_row_of}}};

/// The numbers of a column. Empty cells are left out: the value of that row is not known.
std::vector<double> known_numbers(const Table &table, const std::string &column) {
  const std::vector<std::string> cells = table.text(column);
  std::vector<double> numbers;
  for (std::size_t row = 0; row < cells.size(); ++row)
    if (!cells[row].empty()) numbers.push_back(csv_number(table.file(), table.line(row), column, cells[row]));
  return numbers;
}

/// \pre one of `ways` has the name
std::function<double(RunFiles &)> of_column(const std::string &file, const std::string &column,
                                            const std::string &name) {
  const ColumnWay way =
      *std::find_if(ways.begin(), ways.end(), [&](const ColumnWay &one) { return name == one.name; });
  return [file, column, way](RunFiles &run) {
    const Table &table = run.table(file);
    const std::vector<double> values = known_numbers(table, column);
    if (values.empty() && table.rows() > 0) return no_number;
    if (values.size() < way.rows)
      csv_fault(table.file(), 0, column,
                fmt::format("has {} rows; allowed: {} or more", values.size(), way.rows));
    return way.value(values);
  };
}

std::function<double(RunFiles &)> of_cycles(const std::string &column, const std::string &way) {
  return of_column("cycles.csv", column, way);
}

const Table &cycles_of(RunFiles &run) {
  const Table &table = run.table("cycles.csv");
  if (table.rows() < 2)
    csv_fault(table.file(), 0, "work_excitation",
              fmt::format("has {} rows; allowed: 2 or more", table.rows()));
  return table;
}

/// The sum of some energies of cycles.csv, row by row. A bed without yielding, or between rigid walls, has
/// fewer columns: what they would hold is zero.
template <std::size_t N>
std::vector<double> energy_of(const Table &cycles, const std::array<const char *, N> &columns) {
  std::vector<double> sum(cycles.rows(), 0.0);
  for (const char *column : columns) {
    if (!cycles.has(column)) continue;
    const std::vector<double> values = cycles.numbers(column);
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] += values[i];
  }
  return sum;
}

constexpr std::array stores = {"kinetic", "potential", "stored_contact", "stored_bond", "stored_ground"};
constexpr std::array heats = {"dissipated_contact", "dissipated_bond", "dissipated_friction",
                              "dissipated_ground", "dissipated_yield"};

/// The share of a heat in all heat of the second half of the cycles, waves that leave included. Nothing
/// where none arises.
std::function<double(RunFiles &)> share_of_heat(const char *column) {
  return [column](RunFiles &run) {
    const Table &cycles = cycles_of(run);
    const double all = gain_of(energy_of(cycles, heats));
    return all > 0.0 ? gain_of(energy_of(cycles, std::array{column})) / all : no_number;
  };
}

/// The energy that bed and roller lose in the second half of the cycles over the work of the exciter: where
/// the roller sinks, it drives the bed, too. Nothing of an exciter that does no work.
double released_of(RunFiles &run) {
  const Table &cycles = cycles_of(run);
  const double work = gain_of(cycles.numbers("work_excitation"));
  return work > 0.0 ? -gain_of(energy_of(cycles, stores)) / work : no_number;
}

/// Energy error since the start over the work of the exciter.
double energy_error_of(RunFiles &run) {
  const Table &cycles = cycles_of(run);
  const std::vector<double> work = cycles.numbers("work_excitation"), stored = energy_of(cycles, stores),
                            heat = energy_of(cycles, heats);
  const double done = work.back() - work.front();
  return done > 0.0 ? (stored.back() - stored.front() + heat.back() - heat.front()) / done - 1.0 : no_number;
}

/// A part of the law that identification finds.
template <class Part>
std::function<double(RunFiles &)> of_law(Part part) {
  return [part](RunFiles &run) {
    const std::optional<IdentifiedRecord> &found = run.identified();
    return found ? part(found->whole) : no_number;
  };
}

/// A value for each metre of the drum's width.
std::function<double(RunFiles &)> per_metre(std::function<double(RunFiles &)> value) {
  return [value = std::move(value)](RunFiles &run) { return value(run) / run.width(); };
}

double cmv_of(RunFiles &run) {
  MeterOptions options;
  options.window = 4; // the shortest
  return meter_windows(meter_cycles(run.record()), options).back().cmv.value_or(no_number);
}

constexpr double relative_tolerance = 0.1;

std::vector<Quantity> with_exact_quantities(std::vector<Quantity> all) {
  for (const ExactQuantity &one : exact_quantities())
    all.push_back({one.name, one.label, "-", "-", 1.0, relative_tolerance, false,
                   [value = one.value](RunFiles &run) { return value(run.folder()); }});
  return all;
}

constexpr double settlement_tolerance = 1e-3; // m
constexpr double share_tolerance = 0.05;

} // namespace

std::vector<const char *> column_ways() {
  std::vector<const char *> names;
  names.reserve(ways.size());
  for (const ColumnWay &way : ways)
    names.push_back(way.name);
  return names;
}

const std::vector<Quantity> &named_quantities() {
  const auto k = [](const Identification &whole) { return whole.law.k.mean; };
  const auto k_half_width = [](const Identification &whole) { return whole.law.k.half_width; };
  const auto D = [](const Identification &whole) { return whole.law.D.mean; };
  const auto D_half_width = [](const Identification &whole) { return whole.law.D.half_width; };
  const auto r2 = [](const Identification &whole) { return whole.law.r2; };
  const auto share = [](const char *name, const char *label, const char *column) {
    return Quantity{name, label, "-", "%", 100.0, share_tolerance, true, share_of_heat(column)};
  };
  static const std::vector<Quantity> all = with_exact_quantities(
      {{"acceleration", "peak drum acceleration", "m/s2", "m/s2", 1.0, relative_tolerance, false,
        of_cycles("a_drum_max", "mean")},
       {"force", "peak contact force", "N/m", "kN/m", 1e-3, relative_tolerance, false,
        per_metre(of_cycles("F_contact_max", "mean"))},
       {"settlement", "settlement per cycle", "m", "mm", 1e3, settlement_tolerance, true,
        of_cycles("settlement", "per_row")},
       {"total_settlement", "settlement after the last cycle", "m", "mm", 1e3, settlement_tolerance, true,
        of_cycles("settlement", "last")},
       {"contact", "share of time in contact", "-", "-", 1.0, relative_tolerance, false,
        of_cycles("contact_share", "mean")},
       {"depth", "depth of the drum at rest over its diameter", "-", "%", 100.0, 0.01, true,
        [](RunFiles &run) { return 0.5 * run.parameter("drum_depth") / run.parameter("r2"); }},
       {"CMV", "CMV", "-", "-", 1.0, relative_tolerance, false, &cmv_of},
       {"k", "stiffness k", "N/m per m", "MN/m per m", 1e-6, relative_tolerance, false, per_metre(of_law(k))},
       {"k_half_width", "half width of the interval of k in one record", "N/m per m", "MN/m per m", 1e-6,
        relative_tolerance, false, per_metre(of_law(k_half_width))},
       {"D", "damping ratio D", "-", "-", 1.0, relative_tolerance, false, of_law(D)},
       {"D_half_width", "half width of the interval of D in one record", "-", "-", 1.0, relative_tolerance,
        false, of_law(D_half_width)},
       {"R2", "R2 of the linear law", "-", "-", 1.0, relative_tolerance, false, of_law(r2)},
       {"work", "work of the exciter in a cycle", "J/m", "J/m", 1.0, relative_tolerance, false,
        per_metre(of_cycles("work_excitation", "per_row"))},
       share("radiation", "waves that leave, of all heat", "dissipated_ground"),
       share("friction", "friction and rolling, of all heat", "dissipated_friction"),
       share("dashpots", "dashpots, of all heat", "dissipated_contact"),
       share("yielding", "yielding, of all heat", "dissipated_yield"),
       share("bond", "bond, of all heat", "dissipated_bond"),
       {"released", "released over the work", "-", "%", 100.0, share_tolerance, true, &released_of},
       {"energy_error", "energy error over the work", "-", "-", 1.0, 1e-3, true, &energy_error_of}});
  return all;
}

const Quantity *named_quantity(const std::string &name) {
  const std::vector<Quantity> &all = named_quantities();
  const auto found =
      std::find_if(all.begin(), all.end(), [&name](const Quantity &one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::string column_unit(const std::string &file, const std::string &column) {
  if (const std::size_t open = column.rfind('['); open != std::string::npos && column.back() == ']')
    return column.substr(open + 1, column.size() - open - 2);
  using Units = std::vector<std::pair<std::string, const char *>>;
  for (const auto &[end, unit] :
       Units{{"_mm", "mm"}, {"_m", "m"}, {"_kPa", "kPa"}, {"_MPa", "MPa"}, {"_s", "s"}})
    if (column.size() > end.size() && column.compare(column.size() - end.size(), end.size(), end) == 0)
      return unit;
  const std::string name = std::filesystem::path(file).filename().string();
  if (name != "chain.csv" && name != "bed.csv" && name != "cycles.csv") return {};
  for (const auto &[begin, unit] : Units{{"time", "s"},
                                         {"x_", "m"},
                                         {"v_", "m/s"},
                                         {"a_", "m/s2"},
                                         {"a1_", "m/s2"},
                                         {"a2_", "m/s2"},
                                         {"ah_", "m/s2"},
                                         {"theta_", "rad"},
                                         {"omega_", "rad/s"},
                                         {"F_", "N"},
                                         {"traction", "N"},
                                         {"torque", "N m"},
                                         {"settlement", "m"},
                                         {"work_", "J"},
                                         {"dissipated", "J"},
                                         {"stored_", "J"},
                                         {"elastic", "J"},
                                         {"kinetic", "J"},
                                         {"potential", "J"}})
    if (column.rfind(begin, 0) == 0) return unit;
  return {};
}

Quantity column_quantity(const std::string &name, const std::string &unit, const std::string &way,
                         const std::string &file, const std::string &column) {
  const std::string label =
      unit == "-" || !column_unit(file, column).empty() ? name : name + ", unit as given";
  return {name, label, unit, unit, 1.0, relative_tolerance, false, of_column(file, column, way)};
}

std::vector<double> measured(const std::vector<Quantity> &quantities, const std::filesystem::path &folder,
                             double width) {
  RunFiles run(folder, width);
  std::vector<double> values;
  values.reserve(quantities.size());
  for (const Quantity &quantity : quantities)
    values.push_back(quantity.value(run));
  return values;
}

} // namespace drumlin::post
