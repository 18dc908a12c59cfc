#include "bed/sieve_curve.h"

#include "support/csv.h"
#include "support/measured_table.h"
#include "support/units.h"
#include "support/text.h"

#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/erase.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace drumlin::post {

namespace {

constexpr double mm = 1e-3;
constexpr double percent = 1e-2;

/// Throws SieveFault for the first value that is not allowed.
void check(const std::vector<Sieve> &sieves) {
  if (sieves.empty()) throw std::invalid_argument("a curve needs sieves");
  for (std::size_t i = 0; i < sieves.size(); ++i) {
    const auto &[size, passing] = sieves[i];
    constexpr Range sizes = {SieveCurve::smallest_size / mm, SieveCurve::largest_size / mm, "mm"};
    if (!sizes.holds(size / mm)) throw SieveFault(i, SieveFault::Value::size, sizes.words());
    constexpr Range shares = {0.0, 100.0, "%"};
    if (!shares.holds(passing / percent)) throw SieveFault(i, SieveFault::Value::passing, shares.words());
    if (i == 0) continue;
    if (!(size > sieves[i - 1].size))
      throw SieveFault(i, SieveFault::Value::size,
                       fmt::format("more than {:g}, the size before, since sizes rise from row to row",
                                   sieves[i - 1].size / mm));
    if (passing < sieves[i - 1].passing)
      throw SieveFault(
          i, SieveFault::Value::passing,
          fmt::format("at least {:g}, which passes the finer sieve before", sieves[i - 1].passing / percent));
  }
  if (sieves.back().passing < 1.0)
    throw SieveFault(sieves.size() - 1, SieveFault::Value::passing,
                     "100 in the last row: the largest grain must be known");
  if (sieves.size() < 2 || !(sieves.front().passing < 1.0))
    throw SieveFault(0, SieveFault::Value::passing,
                     "less than 100 in the first row, and a row for each coarser sieve");
}

/// Value at a share of the way from a to b, with the logarithm as scale.
double between(double a, double b, double share) { return a * std::exp(share * std::log(b / a)); }

} // namespace

SieveCurve::SieveCurve(std::vector<Sieve> sieves) : sieves_(std::move(sieves)) {
  check(sieves_);
  const auto all =
      std::find_if(sieves_.begin(), sieves_.end(), [](const Sieve &s) { return s.passing >= 1.0; });
  sieves_.erase(all + 1, sieves_.end());
  const auto some =
      std::find_if(sieves_.begin(), sieves_.end(), [](const Sieve &s) { return s.passing > 0.0; });
  if (some != sieves_.begin()) sieves_.erase(sieves_.begin(), some - 1);
}

double SieveCurve::passing(double size) const {
  if (size <= smallest()) return sieves_.front().passing;
  if (size >= largest()) return 1.0;
  const auto above = std::upper_bound(sieves_.begin(), sieves_.end(), size,
                                      [](double s, const Sieve &sieve) { return s < sieve.size; });
  const Sieve &a = *(above - 1);
  const Sieve &b = *above;
  return a.passing + (b.passing - a.passing) * std::log(size / a.size) / std::log(b.size / a.size);
}

double SieveCurve::size(double passing) const {
  if (passing <= sieves_.front().passing) return smallest();
  const auto above = std::lower_bound(sieves_.begin(), sieves_.end() - 1, passing,
                                      [](const Sieve &sieve, double p) { return sieve.passing < p; });
  const Sieve &a = *(above - 1);
  const Sieve &b = *above;
  return between(a.size, b.size, std::min(1.0, (passing - a.passing) / (b.passing - a.passing)));
}

SieveCurve SieveCurve::coarser_than(double size) const {
  if (!(size >= smallest() && size < largest()))
    throw std::invalid_argument("a curve can only be cut between its ends");
  const double finer = passing(size);
  std::vector<Sieve> rest = {{size, 0.0}};
  for (const Sieve &sieve : sieves_)
    if (sieve.size > size) rest.push_back({sieve.size, (sieve.passing - finer) / (1.0 - finer)});
  return SieveCurve(std::move(rest));
}

namespace {

/// The numbers of a column, none blank.
std::vector<double> all_numbers(const MeasuredTable &table, std::size_t column, const char *zero = "") {
  std::vector<double> values = table.numbers(column, zero);
  for (std::size_t row = 0; row < values.size(); ++row)
    if (std::isnan(values[row])) table.refuse(row, column, "a finite number");
  return values;
}

/// The unit of sizes in a column, millimetres if it names none.
double unit_of_sizes(const MeasuredTable &table, std::size_t column) {
  const MeasuredColumn &sizes = table.columns()[column];
  if (sizes.unit.empty()) return mm;
  const std::optional<Unit> unit = unit_from_text(sizes.unit);
  if (!unit || unit->quantity != UnitKind::length)
    csv_fault(table.file(), 0, sizes.header, refusal("its unit", sizes.unit, unit_names(UnitKind::length)));
  return unit->factor;
}

} // namespace

namespace {

/// What a column tells of each sieve.
enum class SieveColumn { passing, individual, cumulative };

/// A column as laboratories name it: its names, in lower case and without a '%', which is its unit.
std::optional<std::size_t> column_named(const MeasuredTable &table,
                                        std::initializer_list<const char *> names) {
  for (const char *name : names)
    for (std::size_t i = 0; i < table.columns().size(); ++i) {
      std::string text = boost::to_lower_copy(table.columns()[i].name);
      boost::erase_all(text, "%");
      if (trimmed(text) == name) return i;
    }
  return std::nullopt;
}

bool in_percent(const MeasuredColumn &column) {
  return column.unit == "%" || column.name.find('%') != std::string::npos;
}

/// What to write instead of "retained" alone, which some laboratories use for the sum over the coarser
/// sieves.
constexpr const char *clear_names = "'individual retained' for what stays on each sieve, 'cumulative "
                                    "retained' for what stays on it and on all "
                                    "coarser ones, with (g) or (%)";

/// Shares that pass, from what stays on each sieve, the finest first; what is in the pan has the size 0.
std::vector<double> passing_from_individual(const std::vector<double> &kept, bool pan, bool of_hundred) {
  const double sum = std::accumulate(kept.begin(), kept.end(), 0.0);
  const double all = of_hundred && !pan ? 1.0 / percent : sum;
  double finer = of_hundred && !pan ? std::max(0.0, 1.0 - sum / all) : 0.0;
  std::vector<double> passing;
  for (const double share : kept) {
    passing.push_back(std::min(1.0, finer));
    finer += share / all;
  }
  // Rounding must not leave a share of the largest grains.
  if (kept.back() == 0.0) passing.back() = 1.0;
  return passing;
}

} // namespace

std::optional<SieveCurve> curve_between(const std::string &text) {
  const std::size_t dash = text.find('-', 1);
  if (dash == std::string::npos) return {};
  const std::optional<double> smallest = any_number_from_text(text.substr(0, dash)),
                              largest = any_number_from_text(text.substr(dash + 1));
  if (!smallest || !largest || !(*smallest < *largest)) return {};
  try {
    return SieveCurve({{*smallest * mm, 0.0}, {*largest * mm, 1.0}});
  } catch (const SieveFault &) { // of sizes that no sieve has
    return {};
  }
}

SieveCurve read_sieve_file(const std::filesystem::path &file) {
  const MeasuredTable table(file);
  const std::optional<std::size_t> size_column = column_named(table, {"size", "sieve size", "sieve"});
  if (!size_column) table.missing("size");
  constexpr const char *pan_name = "pan";
  for (const std::string &word : table.columns()[*size_column].others) // a first row without a number
    if (boost::iequals(word, pan_name))
      csv_fault(file, 0, table.columns()[*size_column].header,
                refusal("the first row", word, "in the last row"));
  SieveColumn meaning = SieveColumn::passing;
  std::optional<std::size_t> column = column_named(table, {"passing", "cumulative passing"});
  if (!column) {
    meaning = SieveColumn::cumulative;
    column = column_named(table, {"cumulative retained", "retained cumulative"});
  }
  if (!column) {
    meaning = SieveColumn::individual;
    column = column_named(table, {"individual retained", "retained individual", "retained"});
  }
  if (!column) table.missing("passing (%)");
  const MeasuredColumn &named = table.columns()[*column];
  const std::vector<double> sizes = all_numbers(table, *size_column, pan_name);
  const std::vector<double> shares = all_numbers(table, *column);
  const double unit = unit_of_sizes(table, *size_column);
  // Rows from the finest sieve on; a file may begin with the coarsest.
  std::vector<std::size_t> rows(sizes.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  if (sizes.size() > 1 && sizes.front() > sizes.back()) std::reverse(rows.begin(), rows.end());
  std::vector<double> values;
  for (const std::size_t row : rows) {
    if (shares[row] < 0.0 && meaning != SieveColumn::passing)
      table.refuse(row, *column, "a mass or share of 0 or more");
    values.push_back(shares[row]);
  }
  const bool pan = sizes[rows.front()] == 0.0 && (meaning != SieveColumn::passing || values.front() == 0.0);
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  const bool hundred = std::fabs(sum - 100.0) <= 1.0;
  const auto refuse = [&](std::string_view what, const std::string &found, const std::string &allowed) {
    csv_fault(file, 0, named.header, refusal(std::string(what), found, allowed));
  };
  if (meaning == SieveColumn::individual) {
    const bool share = in_percent(named);
    if (!(sum > 0.0) || (share && sum > 101.0))
      refuse("the sum", fmt::format("{:g}", sum),
             fmt::format("more than 0, and of shares at most 100 %; or the name {}", clear_names));
    const bool plain = boost::to_lower_copy(named.name).find("individual") == std::string::npos;
    // Sums over the coarser sieves rise towards the finest; their own sum is not 100 %.
    const auto filled = std::count_if(values.begin(), values.end(), [](double value) { return value > 0.0; });
    if (plain && filled > 1 && !hundred && std::is_sorted(values.rbegin(), values.rend()))
      refuse("its name", named.header, clear_names);
    // Without a unit shares and masses differ by what is finer than all sieves.
    if (!share && named.unit.empty() && !pan && sum < 99.0) refuse("its name", named.header, clear_names);
    values = passing_from_individual(values, pan, share);
  } else if (meaning == SieveColumn::cumulative) {
    const bool share =
        in_percent(named) || (named.unit.empty() && !pan && std::fabs(values.front() - 100.0) <= 1.0);
    if (!share && !pan)
      refuse("its unit", named.unit, "%, or a row of size 0 for the pan, with the mass of all");
    for (std::size_t i = 0; i + 1 < rows.size(); ++i)
      if (values[i] < values[i + 1])
        table.refuse(rows[i], *column,
                     fmt::format("at least {:g}, what stays on the coarser sieve", values[i + 1]));
    const double all = pan ? values.front() : 100.0;
    if (!(all > 0.0) || values.front() > 1.01 * all || (share && std::fabs(all - 100.0) > 1.0))
      table.refuse(rows.front(), *column, "more than 0, and of shares at most 100 %, all of it in the pan");
    for (double &value : values)
      value = std::max(0.0, 1.0 - value / all);
  } else {
    for (double &value : values)
      value *= percent;
  }
  std::vector<Sieve> sieves;
  for (std::size_t i = pan ? 1 : 0; i < rows.size(); ++i)
    sieves.push_back({sizes[rows[i]] * unit, values[i]});
  if (pan) rows.erase(rows.begin());
  try {
    return SieveCurve(std::move(sieves));
  } catch (const SieveFault &fault) {
    table.refuse(rows.at(fault.row), fault.value == SieveFault::Value::size ? *size_column : *column,
                 fault.what());
  }
}

BallNumbers::BallNumbers(const SieveCurve &curve, int dimensions) : dimensions_(dimensions) {
  const std::vector<Sieve> &sieves = curve.sieves();
  if (sieves.front().passing > 0.0) throw std::invalid_argument("grains of unknown size cannot be counted");
  // Number in each interval for a total mass of 1, where a ball of size d has the mass d^n.
  std::vector<double> numbers = {0.0};
  for (std::size_t i = 1; i < sieves.size(); ++i) {
    const double a = sieves[i - 1].size, b = sieves[i].size;
    const double mass = sieves[i].passing - sieves[i - 1].passing;
    numbers.push_back(numbers.back() + mass / std::log(b / a) * (power(a) - power(b)) / dimensions_);
  }
  for (std::size_t i = 0; i < sieves.size(); ++i) {
    sizes_.push_back(sieves[i].size);
    shares_.push_back(numbers[i] / numbers.back());
  }
  mean_power_ = 1.0 / numbers.back();
}

double BallNumbers::power(double size) const {
  return dimensions_ == 2 ? 1.0 / (size * size) : 1.0 / (size * size * size);
}

double BallNumbers::share_finer(double size) const {
  if (size <= sizes_.front()) return 0.0;
  if (size >= sizes_.back()) return 1.0;
  const auto i =
      static_cast<std::size_t>(std::upper_bound(sizes_.begin(), sizes_.end(), size) - sizes_.begin());
  const double a = power(sizes_[i - 1]), b = power(sizes_[i]);
  return shares_[i - 1] + (shares_[i] - shares_[i - 1]) * (a - power(size)) / (a - b);
}

double BallNumbers::size(double share) const {
  if (share <= 0.0) return sizes_.front();
  const auto i = static_cast<std::size_t>(std::lower_bound(shares_.begin() + 1, shares_.end() - 1, share) -
                                          shares_.begin());
  const double part = std::min(1.0, (share - shares_[i - 1]) / (shares_[i] - shares_[i - 1]));
  const double a = power(sizes_[i - 1]), b = power(sizes_[i]);
  const double inverse = a - part * (a - b);
  return dimensions_ == 2 ? 1.0 / std::sqrt(inverse) : 1.0 / std::cbrt(inverse);
}

Sieving::Sieving(std::vector<double> sizes, int dimensions) : sizes_(std::move(sizes)) {
  std::sort(sizes_.begin(), sizes_.end());
  double sum = 0.0;
  for (const double size : sizes_)
    passing_.push_back(sum += dimensions == 2 ? size * size : size * size * size);
  for (double &share : passing_)
    share /= sum;
}

double Sieving::passing(double size) const {
  const auto above = std::upper_bound(sizes_.begin(), sizes_.end(), size);
  return above == sizes_.begin() ? 0.0 : passing_[static_cast<std::size_t>(above - sizes_.begin()) - 1];
}

double Sieving::size(double passing) const {
  const auto found = std::lower_bound(passing_.begin(), passing_.end() - 1, passing);
  return sizes_[static_cast<std::size_t>(found - passing_.begin())];
}

} // namespace drumlin::post
