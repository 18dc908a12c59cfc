#include "bed/relative_density.h"

#include "engine/deck_run.h"
#include "support/csv.h"
#include "support/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace drumlin::post {

namespace {

/// How a packing of a table was made.
constexpr const char *made_by_pouring = "poured", *made_frictionless = "frictionless",
                     *made_by_shaking = "shaken", *made_up = "estimated";

} // namespace

double relative_density(double void_ratio, double loosest, double shaken) {
  return (loosest - void_ratio) / (loosest - shaken);
}

MeasuredPackings::MeasuredPackings(std::vector<Row> poured, double shaken)
    : poured_(std::move(poured)), shaken_(shaken) {
  std::sort(poured_.begin(), poured_.end(), [](const Row &a, const Row &b) { return a.share < b.share; });
  if (poured_.size() < 2 || poured_.front().share != 0.0 || poured_.back().share != 1.0)
    throw std::invalid_argument(
        "the poured packings of the shares 0, without friction, and 1, the loosest, and others between");
  if (!(loosest() > frictionless().void_ratio) || !(frictionless().void_ratio > 0.0))
    throw std::invalid_argument("a loosest packing whose void ratio is above that of the frictionless one");
  if (!(loosest() > shaken_) || !(shaken_ > 0.0))
    throw std::invalid_argument("a loosest packing whose void ratio is above that of the shaken one");
  double above = frictionless().void_ratio;
  for (Row &row : poured_)
    above = row.void_ratio = std::clamp(row.void_ratio, above, loosest());
}

double MeasuredPackings::most() const {
  return relative_density(frictionless().void_ratio, loosest(), shaken_);
}

Pouring MeasuredPackings::pouring(double relative) const {
  const double wanted = std::max(loosest() - relative * (loosest() - shaken_), frictionless().void_ratio);
  std::size_t upper = 1;
  while (upper + 1 < poured_.size() && poured_[upper].void_ratio < wanted)
    ++upper;
  const Row &low = poured_[upper - 1], &high = poured_[upper];
  const double width = high.void_ratio - low.void_ratio;
  const double part = width > 0.0 ? std::clamp((wanted - low.void_ratio) / width, 0.0, 1.0) : 0.0;
  const auto between = [part](double a, double b) { return a + part * (b - a); };
  return {relative,
          between(low.friction, high.friction),
          between(low.rolling, high.rolling),
          wanted,
          loosest(),
          shaken_,
          of_loosest().friction,
          of_loosest().rolling};
}

double LayerPackings::relative_density(double solid_fraction) const {
  return post::relative_density(1.0 / solid_fraction - 1.0, loosest, shaken);
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
  const std::vector<double> tops = list("layer_tops"), loosest = list("e_loosest"), shaken = list("e_shaken");
  if (loosest.empty() || loosest.size() != shaken.size() || loosest.size() != tops.size()) return {};
  std::vector<LayerPackings> layers;
  for (std::size_t n = 0; n < tops.size(); ++n)
    layers.push_back({tops[n], loosest[n], shaken[n]});
  return layers;
}

const LayerPackings &layer_at(const std::vector<LayerPackings> &layers, double height) {
  const auto found = std::find_if(layers.begin(), layers.end(),
                                  [height](const LayerPackings &layer) { return height < layer.top; });
  return found == layers.end() ? layers.back() : *found;
}

std::string packings_csv(const MeasuredPackings &packings) {
  std::string text =
      csv_line({"share", "friction", "rolling", "void_ratio", "solid_fraction", "relative_density",
                "dimension", "spread", "grading", "d50_over_smallest", "made"});
  const auto add = [&](const MeasuredPackings::Row &row, const char *made) {
    text +=
        fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.4f},{},{:.8g},{},{:.8g},{}\n", row.share,
                    row.friction, row.rolling, row.void_ratio, 1.0 / (1.0 + row.void_ratio),
                    relative_density(row.void_ratio, packings.loosest(), packings.shaken()),
                    packings.dimensions, packings.spread, packings.grading, packings.d50_over_smallest, made);
  };
  for (const MeasuredPackings::Row &row : packings.poured())
    add(row, row.share == 0.0 ? made_frictionless : made_by_pouring);
  MeasuredPackings::Row row = packings.of_loosest();
  row.void_ratio = packings.shaken();
  add(row, packings.estimated ? made_up : made_by_shaking);
  return text;
}

MeasuredPackings read_packings(const std::filesystem::path &file) {
  const Table table = read_table(file);
  for (const char *column : {"dimension", "spread", "made"})
    if (!table.has(column))
      csv_fault(file, 0, column,
                "is missing; allowed: a table with a shaken packing, as in.density and drumlin bed make it; "
                "earlier ones end at a packing without friction");
  const std::vector<double> share = table.numbers("share"), friction = table.numbers("friction"),
                            rolling = table.numbers("rolling"), void_ratio = table.numbers("void_ratio");
  const std::vector<std::string> made = table.text("made");
  std::vector<MeasuredPackings::Row> rows;
  std::vector<std::size_t> densest;
  for (std::size_t n = 0; n < table.rows(); ++n)
    if (made[n] == made_by_shaking || made[n] == made_up)
      densest.push_back(n);
    else if (made[n] == made_by_pouring || made[n] == made_frictionless)
      rows.push_back({share[n], friction[n], rolling[n], void_ratio[n]});
    else
      csv_fault(file, table.line(n), "made",
                fmt::format("is '{}'; allowed: {}, {}, {} or {}", made[n], made_by_pouring, made_frictionless,
                            made_by_shaking, made_up));
  try {
    if (densest.size() != 1) throw std::invalid_argument("one packing that was shaken");
    MeasuredPackings packings(std::move(rows), void_ratio[densest.front()]);
    packings.estimated = made[densest.front()] == made_up;
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

MeasuredPackings packings_of_gravel(int dimensions) {
  return read_packings(input_file(dimensions == 2 ? "bed/packings.gravel.csv" : "bed/packings.gravel3d.csv"));
}

double densest_by_shaking(const std::map<std::string, std::string> &parameters, std::size_t layer,
                          bool flat) {
  std::vector<LayerPackings> noted;
  try {
    noted = noted_packings(parameters);
  } catch (const std::runtime_error &) {
    // a file that no deck has written
  }
  return 1.0 /
         (1.0 + (layer < noted.size() ? noted[layer].shaken : packings_of_gravel(flat ? 2 : 3).shaken()));
}

} // namespace drumlin::post
