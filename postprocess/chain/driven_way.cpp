#include "chain/driven_way.h"

#include "support/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

namespace drumlin::post {

WaySection WaySection::from(double time) const {
  const double since = time - begin;
  WaySection rest = *this;
  rest.begin = time;
  rest.k += k_rate * since;
  rest.D = std::max(0.0, D + D_rate * since);
  rest.s += velocity * since;
  rest.k_left += k_left_rate * since;
  return rest;
}

std::vector<WaySection> drive(const Way &way, double speed, int passes, WayBack back) {
  const double length = way.back().s - way.front().s;
  std::vector<WaySection> sections;
  sections.reserve(static_cast<std::size_t>(passes) * way.size());
  for (int pass = 0; pass < passes; ++pass) {
    const bool forth = pass % 2 == 0;
    // From the start of all passes, so that no rounding error adds up.
    const auto time_at = [&](double s) {
      return (pass * length + (forth ? s - way.front().s : way.back().s - s)) / speed;
    };
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
      const WayRow &from = forth ? way[i] : way[way.size() - 1 - i];
      const WayRow &to = forth ? way[i + 1] : way[way.size() - 2 - i];
      if (from.s == to.s) continue; // a step
      WaySection section;
      section.begin = time_at(from.s);
      section.end = time_at(to.s);
      const double duration = section.end - section.begin;
      section.k = from.k;
      section.k_rate = (to.k - from.k) / duration;
      section.D = from.D;
      section.D_rate = (to.D - from.D) / duration;
      section.s = from.s;
      section.velocity = forth ? speed : -speed;
      section.pass = pass + 1;
      const bool swapped = !forth && back == WayBack::turned_round;
      const auto left = [swapped](const WayRow &row) { return swapped ? row.k_right() : row.k_left; };
      section.k_left = left(from);
      section.k_left_rate = (left(to) - left(from)) / duration;
      if (section.end > section.begin) sections.push_back(section);
    }
  }
  return sections;
}

Way random_way(const RandomSoil &soil) {
  // Box and Muller's normal numbers: those of the standard library differ between compilers.
  std::mt19937_64 random(soil.seed);
  const auto normal = [&random] {
    const double u = (static_cast<double>(random() >> 11U) + 0.5) * 0x1p-53;
    const double v = (static_cast<double>(random() >> 11U) + 0.5) * 0x1p-53;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * pi * v);
  };
  // ln k has the variance ln(1 + variation^2), and the mean with which that of k is `mean`.
  const double variance = std::log1p(soil.variation * soil.variation);
  const double middle = std::log(soil.mean) - 0.5 * variance;
  const auto steps = static_cast<std::size_t>(std::ceil((soil.to - soil.from) / soil.step * (1.0 - 1e-12)));
  Way way;
  double z = normal(); // of unit variance
  for (std::size_t i = 0; i <= steps; ++i) {
    const double s = i == steps ? soil.to : soil.from + static_cast<double>(i) * soil.step;
    if (i > 0) {
      const double kept = std::exp(-(s - way.back().s) / soil.correlation);
      z = kept * z + std::sqrt(1.0 - kept * kept) * normal();
    }
    const double k = std::exp(middle + std::sqrt(variance) * z);
    way.push_back({s, k, soil.D, k * (soil.ratio / (1.0 + soil.ratio))});
  }
  return way;
}

std::string way_text(const Way &way) {
  const bool sides = has_sides(way);
  std::string text = fmt::format("{}\n", sides ? way_file::header_of_halves : way_file::header);
  for (const WayRow &row : way) // with all of their digits
    text += sides ? fmt::format("{},{},{},{}\n", row.s, row.k_left, row.k_right(), row.D)
                  : fmt::format("{},{},{}\n", row.s, row.k, row.D);
  return text;
}

} // namespace drumlin::post
