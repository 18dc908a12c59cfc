#include "studies/stiffness/results.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace drumlin::post {

namespace {

constexpr double pi = 3.14159265358979323846;

std::string words_of(Pull pull) {
  if (pull == Pull::unknown) return "cannot be told";
  return pull == Pull::pulls ? "yes" : "no";
}

bool same(double a, double b) { return std::fabs(a - b) <= 1e-9 * std::fabs(b); }

/// Whether a run differs from another at most in one variable.
bool differs_only_in(const LawVariable &variable, const BedLaw &run, const BedLaw &other) {
  return std::all_of(law_variables.begin(), law_variables.end(), [&](const LawVariable &one) {
    return one.value == variable.value || same(run.*one.value, other.*one.value);
  });
}

/// Mean change of a quantity from the default to another run of the same seed.
std::optional<MeanInterval> change_of(const std::vector<BedLaw> &laws, const LawLevel &level,
                                      double BedLaw::*quantity) {
  std::vector<double> changes;
  for (const BedLaw &run : level.runs)
    for (const BedLaw &base : laws)
      if (run.run != default_run && base.run == default_run && base.seed == run.seed &&
          std::isfinite(run.*quantity - base.*quantity))
        changes.push_back(run.*quantity - base.*quantity);
  if (changes.size() < 2) return std::nullopt;
  return mean_interval(changes);
}

std::vector<double> finite_values(const std::vector<BedLaw> &runs, double BedLaw::*quantity) {
  std::vector<double> values;
  for (const BedLaw &run : runs)
    if (std::isfinite(run.*quantity)) values.push_back(run.*quantity);
  return values;
}

} // namespace

const std::array<LawVariable, 3> law_variables = {
    {{"load", "the static load", "static load [kN/m]", &BedLaw::load, 1e-3},
     {"amplitude", "the amplitude of the excitation force", "amplitude of the force [kN/m]", &BedLaw::Fw,
      1e-3},
     {"frequency", "the frequency", "frequency [Hz]", &BedLaw::frequency, 1.0}}};

const CsvSchema<BedLaw> &bed_laws() {
  constexpr int digits =
      9; // significant digits. A column with a number of digits writes a missing value (NaN) as an empty cell.
  static const CsvSchema<BedLaw> schema(
      {csv_column("run", &BedLaw::run), csv_column("seed", &BedLaw::seed),
       csv_column("static_load [N/m]", &BedLaw::load), csv_column("Fw [N/m]", &BedLaw::Fw),
       csv_column("frequency [Hz]", &BedLaw::frequency), csv_column("k [N/m per m]", &BedLaw::k, digits),
       csv_column("k_half_width [N/m per m]", &BedLaw::k_half_width, digits),
       csv_column("D [-]", &BedLaw::D, digits), csv_column("D_half_width [-]", &BedLaw::D_half_width, digits),
       csv_column("R2 [-]", &BedLaw::r2, digits), csv_column("pulls", &BedLaw::pulls),
       csv_column("contact_share [-]", &BedLaw::contact_share, digits),
       csv_column("peak_force [N/m]", &BedLaw::peak_force, digits),
       csv_column("cpu [s]", &BedLaw::cpu_s, digits)},
      2);
  return schema;
}

BedLaw identified_law(const std::filesystem::path &folder) {
  const Record record = read_record(folder);
  BedLaw law;
  law.load = (record.m2.value() + record.m3.value()) * record.g.value();
  law.Fw = record.Fw.value();
  law.frequency = record.omega.value() / (2.0 * pi);
  law.pulls = "none";
  try {
    const IdentifiedRecord found = identify_record(record, {});
    const LawEstimate &estimate = found.whole.law;
    law.k = estimate.k.mean;
    law.k_half_width = estimate.k.half_width;
    law.D = estimate.D.mean;
    law.D_half_width = estimate.D.half_width;
    law.r2 = estimate.r2;
    law.pulls = words_of(found.whole.pull);
  } catch (const std::runtime_error &) { // which is a result: the page counts such records
  }
  return law;
}

std::vector<LawLevel> levels_of(const std::vector<BedLaw> &laws, const LawVariable &variable) {
  std::vector<LawLevel> levels;
  const auto base =
      std::find_if(laws.begin(), laws.end(), [](const BedLaw &law) { return law.run == default_run; });
  if (base == laws.end()) return levels;
  for (const BedLaw &law : laws) {
    if (!differs_only_in(variable, law, *base)) continue;
    const double value = law.*variable.value;
    auto level = std::find_if(levels.begin(), levels.end(),
                              [value](const LawLevel &one) { return same(one.value, value); });
    if (level == levels.end()) {
      LawLevel fresh;
      fresh.value = value;
      level = levels.insert(level, fresh);
    }
    level->runs.push_back(law);
  }
  for (LawLevel &level : levels) {
    level.k = finite_values(level.runs, &BedLaw::k);
    level.D = finite_values(level.runs, &BedLaw::D);
    level.r2 = finite_values(level.runs, &BedLaw::r2);
    level.k_change = change_of(laws, level, &BedLaw::k);
    level.D_change = change_of(laws, level, &BedLaw::D);
  }
  std::sort(levels.begin(), levels.end(),
            [](const LawLevel &a, const LawLevel &b) { return a.value < b.value; });
  return levels;
}

} // namespace drumlin::post
