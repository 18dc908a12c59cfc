#include "bed/relative_density.h"

#include "support/csv.h"
#include "support/range.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

double relative_density(double void_ratio, double loosest, double densest) {
  return (loosest - void_ratio) / (loosest - densest);
}

double densest_by_shaking(bool flat) { return flat ? 0.825 : 0.610; }

MeasuredPackings::MeasuredPackings(std::vector<Row> rows) : rows_(std::move(rows)) {
  std::sort(rows_.begin(), rows_.end(), [](const Row &a, const Row &b) { return a.share < b.share; });
  if (rows_.size() < 2 || rows_.front().share != 0.0 || rows_.back().share != 1.0)
    throw std::invalid_argument(
        "the shares 0, of the densest packing, and 1, of the loosest, and others between");
  if (!(rows_.back().void_ratio > rows_.front().void_ratio) || !(rows_.front().void_ratio > 0.0))
    throw std::invalid_argument("a loosest packing whose void ratio is above that of the densest one");
  double above = rows_.front().void_ratio;
  for (Row &row : rows_)
    above = row.void_ratio = std::clamp(row.void_ratio, above, rows_.back().void_ratio);
}

Pouring MeasuredPackings::pouring(double relative) const {
  const double wanted = loosest() - relative * (loosest() - densest());
  std::size_t upper = 1;
  while (upper + 1 < rows_.size() && rows_[upper].void_ratio < wanted)
    ++upper;
  const Row &low = rows_[upper - 1], &high = rows_[upper];
  const double width = high.void_ratio - low.void_ratio;
  const double part = width > 0.0 ? std::clamp((wanted - low.void_ratio) / width, 0.0, 1.0) : 0.0;
  const auto between = [part](double a, double b) { return a + part * (b - a); };
  return {relative,
          between(low.friction, high.friction),
          between(low.rolling, high.rolling),
          wanted,
          loosest(),
          densest(),
          of_loosest().friction,
          of_loosest().rolling};
}

double LayerPackings::relative_density(double solid_fraction) const {
  return post::relative_density(1.0 / solid_fraction - 1.0, loosest, densest);
}

std::vector<LayerPackings> noted_packings(const std::map<std::string, std::string> &parameters) {
  const auto list = [&parameters](const char *name) -> std::vector<double> {
    const auto found = parameters.find(name);
    if (found == parameters.end() || found->second == "unknown" || found->second == "none") return {};
    std::vector<double> numbers;
    std::istringstream cells(found->second);
    try {
      for (std::string cell; std::getline(cells, cell, ',');)
        numbers.push_back(number_from_text(cell));
    } catch (const std::invalid_argument &) {
      throw std::runtime_error(refusal(name, found->second, "numbers separated by commas"));
    }
    return numbers;
  };
  const std::vector<double> tops = list("layer_tops"), loosest = list("e_loosest"),
                            densest = list("e_densest");
  if (loosest.empty() || loosest.size() != densest.size() || loosest.size() != tops.size()) return {};
  std::vector<LayerPackings> layers;
  for (std::size_t n = 0; n < tops.size(); ++n)
    layers.push_back({tops[n], loosest[n], densest[n]});
  return layers;
}

const LayerPackings &layer_at(const std::vector<LayerPackings> &layers, double height) {
  const auto found = std::find_if(layers.begin(), layers.end(),
                                  [height](const LayerPackings &layer) { return height < layer.top; });
  return found == layers.end() ? layers.back() : *found;
}

std::string packings_csv(const MeasuredPackings &packings) {
  std::string text = csv_line({"share", "friction", "rolling", "void_ratio", "solid_fraction",
                               "relative_density", "dimension", "spread", "grading", "d50_over_smallest"});
  for (const MeasuredPackings::Row &row : packings.rows())
    text += fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.4f},{},{:.8g},{},{:.8g}\n", row.share,
                        row.friction, row.rolling, row.void_ratio, 1.0 / (1.0 + row.void_ratio),
                        relative_density(row.void_ratio, packings.loosest(), packings.densest()),
                        packings.dimensions, packings.spread, packings.grading, packings.d50_over_smallest);
  return text;
}

MeasuredPackings read_packings(const std::filesystem::path &file) {
  const Table table = read_table(file);
  for (const char *column : {"dimension", "spread"})
    if (!table.has(column))
      csv_fault(file, 0, column,
                "is missing; allowed: density.csv of this version's in.density, which says of "
                "which balls it is");
  const std::vector<double> share = table.numbers("share"), friction = table.numbers("friction"),
                            rolling = table.numbers("rolling"), void_ratio = table.numbers("void_ratio");
  std::vector<MeasuredPackings::Row> rows;
  for (std::size_t n = 0; n < table.rows(); ++n)
    rows.push_back({share[n], friction[n], rolling[n], void_ratio[n]});
  try {
    MeasuredPackings packings(std::move(rows));
    packings.dimensions = static_cast<int>(table.numbers("dimension").front());
    packings.spread = table.numbers("spread").front();
    if (table.has("grading")) {
      packings.grading = table.text("grading").front();
      packings.d50_over_smallest = table.numbers("d50_over_smallest").front();
    }
    return packings;
  } catch (const std::invalid_argument &fault) {
    throw std::runtime_error(fmt::format("{}: allowed: {}", file.string(), fault.what()));
  }
}

} // namespace drumlin::post
