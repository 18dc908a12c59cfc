#include "studies/friction/results.h"

#include "pages/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace drumlin::post {

const CsvSchema<FrictionRun> &friction_runs() {
  constexpr int digits =
      9; // significant digits. A column with a number of digits writes a missing value (NaN) as an empty cell.
  static const CsvSchema<FrictionRun> schema(
      {csv_column("tangential", &FrictionRun::tangential), csv_column("seed", &FrictionRun::seed),
       csv_column("depth [-]", &FrictionRun::depth, digits),
       csv_column("settlement [m]", &FrictionRun::settlement, digits),
       csv_column("peak_force [N/m]", &FrictionRun::peak_force, digits),
       csv_column("acceleration [m/s2]", &FrictionRun::acceleration, digits),
       csv_column("contact_share [-]", &FrictionRun::contact_share, digits),
       csv_column("k [N/m per m]", &FrictionRun::k, digits), csv_column("D [-]", &FrictionRun::D, digits),
       csv_column("R2 [-]", &FrictionRun::r2, digits)},
      2);
  return schema;
}

const std::array<FrictionQuantity, 8> friction_quantities = {
    {{"depth of the drum at rest [% of its diameter]", &FrictionRun::depth, 100.0},
     {"settlement after the last cycle [mm]", &FrictionRun::settlement, 1e3},
     {"peak contact force [kN/m]", &FrictionRun::peak_force, 1e-3},
     {"peak acceleration of the drum [m/s2]", &FrictionRun::acceleration, 1.0},
     {"share of time in contact [-]", &FrictionRun::contact_share, 1.0},
     {"k [MN/m per m]", &FrictionRun::k, 1e-6},
     {"D [-]", &FrictionRun::D, 1.0},
     {"R2 [-]", &FrictionRun::r2, 1.0}}};

std::vector<double> values_of(const std::vector<FrictionRun> &runs, const std::string &tangential,
                              const FrictionQuantity &quantity) {
  std::vector<double> values;
  for (const FrictionRun &run : runs)
    if (run.tangential == tangential && std::isfinite(run.*quantity.value))
      values.push_back(run.*quantity.value);
  return values;
}

std::optional<MeanInterval> friction_change(const std::vector<FrictionRun> &runs,
                                            const FrictionQuantity &quantity) {
  std::vector<double> changes;
  for (const FrictionRun &run : runs)
    for (const FrictionRun &base : runs)
      if (run.tangential == "history" && base.tangential == "coulomb" && run.seed == base.seed &&
          std::isfinite(run.*quantity.value - base.*quantity.value))
        changes.push_back(run.*quantity.value - base.*quantity.value);
  if (changes.size() < 2) return std::nullopt;
  return mean_interval(changes);
}

namespace {

std::string words(const char *format, const MeanInterval &interval, double scale) {
  return fmt::format(fmt::runtime(format), scale * interval.mean, scale * interval.half_width);
}

PageTable change_table(const std::vector<FrictionRun> &runs) {
  PageTable table;
  table.name = "changes";
  table.title = "Both models, and the change from coulomb to history";
  table.header = {"quantity", "coulomb", "history", "history - coulomb"};
  for (const FrictionQuantity &quantity : friction_quantities) {
    std::vector<std::string> row = {quantity.label};
    for (const char *model : {"coulomb", "history"}) {
      const std::vector<double> values = values_of(runs, model, quantity);
      row.push_back(values.empty() ? no_value
                                   : words("{:.3g} ± {:.2g}", mean_interval(values), quantity.scale));
    }
    const std::optional<MeanInterval> change = friction_change(runs, quantity);
    row.push_back(change ? words("{:+.3g} ± {:.2g}", *change, quantity.scale) +
                               (change->significant() ? " *" : "")
                         : no_value);
    table.add(std::move(row));
  }
  table.notes = {
      seed_by_seed_note("each change compares two runs of one seed"),
      "Peak force, peak acceleration and share of time in contact: means over the last half of the "
      "cycles. k, D and R2: as `drumlin identify` finds them in the whole record."};
  return table;
}

PageTable run_table(const std::vector<FrictionRun> &runs) {
  PageTable table;
  table.name = "runs";
  table.title = "Single runs";
  table.header = {"model", "seed"};
  for (const FrictionQuantity &quantity : friction_quantities)
    table.header.emplace_back(quantity.label);
  for (const FrictionRun &run : runs) {
    std::vector<std::string> row = {run.tangential, std::to_string(run.seed)};
    for (const FrictionQuantity &quantity : friction_quantities) {
      const double value = quantity.scale * run.*quantity.value;
      row.push_back(std::isfinite(value) ? fmt::format("{:.3g}", value) : no_value);
    }
    table.add(std::move(row));
  }
  return table;
}

std::string changes_words(const std::vector<FrictionRun> &runs) {
  std::vector<std::string> found;
  for (const FrictionQuantity &quantity : friction_quantities)
    if (const std::optional<MeanInterval> change = friction_change(runs, quantity);
        change && change->significant())
      found.push_back(std::string(quantity.label) + words(" {:+.2g} ± {:.2g}", *change, quantity.scale));
  return fmt::format("{} of {} quantities change beyond the scatter of the beds from coulomb to history{}{}.",
                     found.size(), friction_quantities.size(), found.empty() ? "" : ": ",
                     fmt::join(found, "; "));
}

} // namespace

void write_friction_page(const std::filesystem::path &out, const std::string &beds,
                         const std::vector<FrictionRun> &runs, const std::vector<std::string> &failures) {
  Page page(out, "What the friction model changes in a bed", Scene::bed);
  page.answer(fmt::format(
      "Beds of several seeds ({}) are settled, placed under the roller and shaken once with the friction "
      "model "
      "coulomb, which never exceeds mu Fn, and once with the engine's own, history, which exceeds it in fast "
      "sliding; all else is equal.",
      beds));
  page.answer(changes_words(runs));
  for (const std::string &failure : failures)
    page.answer("Missing: " + failure);
  page.section("Changes");
  page.table(change_table(runs));
  page.section("Runs");
  page.table(run_table(runs));
  page.write();
}

} // namespace drumlin::post
