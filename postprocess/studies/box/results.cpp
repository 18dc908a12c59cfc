#include "studies/box/results.h"

#include "meter/values.h"
#include "studies/stiffness/results.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace drumlin::post {

namespace {

constexpr std::size_t settlement = 2; // index in box_quantities

MeanInterval related(const MeanInterval &change, const std::vector<double> &bases, std::size_t quantity) {
  const double scale = is_relative(quantity) ? std::fabs(mean_interval(bases).mean) : 1.0;
  return {change.mean / scale, change.half_width / scale};
}

/// Change over the pairs of runs on one bed that `is_pair` accepts: the second is what the first is compared with.
template <class IsPair>
std::optional<MeanInterval> change_over_pairs(const std::vector<BoxRun> &runs, std::size_t quantity,
                                              const IsPair &is_pair) {
  std::vector<double> changes, bases;
  for (const BoxRun &one : runs)
    for (const BoxRun &other : runs) {
      const double change = one.values[quantity] - other.values[quantity];
      const bool same_bed = one.seed == other.seed && one.width == other.width && one.depth == other.depth;
      if (!same_bed || !is_pair(one, other) || !std::isfinite(change)) continue;
      changes.push_back(change);
      bases.push_back(other.values[quantity]);
    }
  if (changes.size() < 2) return std::nullopt;
  return related(mean_interval(changes), bases, quantity);
}

} // namespace

const std::array<BoxQuantity, box_quantity_count> box_quantities = {
    {{"peak contact force", "peak_force [N/m]", "kN/m", 1e-3},
     {"peak drum acceleration", "peak_acceleration [m/s2]", "m/s2", 1.0},
     {"settlement", "settlement [m]", "mm", 1e3},
     {"share of time in contact", "contact_share [-]", "-", 1.0},
     {"CMV", "CMV [-]", "-", 1.0},
     {"stiffness k", "k [N/m per m]", "MN/m per m", 1e-6},
     {"damping ratio D", "D [-]", "-", 1.0}}};

const CsvSchema<BoxRun> &box_runs() {
  constexpr int digits =
      9; // significant digits. A column with a number of digits writes a missing value (NaN) as an empty cell.
  std::vector<CsvColumn<BoxRun>> columns = {csv_column("run", &BoxRun::run),
                                            csv_column("seed", &BoxRun::seed),
                                            csv_column("width [default widths]", &BoxRun::width),
                                            csv_column("depth [default depths]", &BoxRun::depth),
                                            csv_column("boundary", &BoxRun::boundary),
                                            csv_column("ground_depth [m]", &BoxRun::ground_depth)};
  for (std::size_t q = 0; q < box_quantities.size(); ++q)
    columns.push_back(csv_column_of<BoxRun, double>(
        box_quantities[q].column, [q](auto &run) -> auto & { return run.values[q]; }, digits));
  columns.push_back(csv_column("cpu [s]", &BoxRun::cpu_s, digits));
  static const CsvSchema<BoxRun> schema(columns, 2);
  return schema;
}

std::array<double, box_quantity_count> box_values(const std::filesystem::path &folder) {
  const Table cycles = read_table(folder / "cycles.csv");
  const BedValues values = bed_values(cycles, 1.0);
  const auto value = [&values](BedQuantity quantity) { return values[static_cast<std::size_t>(quantity)]; };
  MeterOptions options;
  options.window = 4; // the shortest
  const std::vector<MeterWindow> windows = meter_windows(meter_cycles(read_record(folder)), options);
  const BedLaw law = identified_law(folder);
  return {value(BedQuantity::force),
          value(BedQuantity::acceleration),
          cycles.numbers("settlement").back(),
          value(BedQuantity::contact),
          windows.back().cmv.value_or(std::numeric_limits<double>::quiet_NaN()),
          law.k,
          law.D};
}

bool is_relative(std::size_t quantity) { return quantity != settlement; }

std::vector<double> finite_values(const std::vector<BoxRun> &runs, const std::string &run,
                                  std::size_t quantity) {
  std::vector<double> values;
  for (const BoxRun &one : runs)
    if (one.run == run && std::isfinite(one.values[quantity])) values.push_back(one.values[quantity]);
  return values;
}

std::optional<MeanInterval> box_change(const std::vector<BoxRun> &runs, const BedComparison &compared,
                                       std::size_t quantity) {
  const auto named = [&runs](const std::string &name) {
    return std::find_if(runs.begin(), runs.end(), [&name](const BoxRun &run) { return run.run == name; });
  };
  const auto variant = named(compared.variant), base = named(compared.base);
  if (variant == runs.end() || base == runs.end()) return std::nullopt;
  if (variant->width == base->width && variant->depth == base->depth)
    return change_over_pairs(runs, quantity, [&compared](const BoxRun &one, const BoxRun &other) {
      return one.run == compared.variant && other.run == compared.base;
    });
  const std::vector<double> values = finite_values(runs, compared.variant, quantity),
                            bases = finite_values(runs, compared.base, quantity);
  if (values.size() < 2 || bases.size() < 2) return std::nullopt;
  return related(mean_difference(values, bases), bases, quantity);
}

std::optional<MeanInterval> boundary_change(const std::vector<BoxRun> &runs, std::size_t quantity) {
  double ground = std::numeric_limits<double>::infinity(); // the depth that all boxes have
  for (const BoxRun &run : runs)
    if (run.boundary == "absorb") ground = std::min(ground, run.ground_depth);
  return change_over_pairs(runs, quantity, [ground](const BoxRun &one, const BoxRun &other) {
    return one.boundary == "absorb" && one.ground_depth == ground && other.boundary == "rigid";
  });
}

} // namespace drumlin::post
