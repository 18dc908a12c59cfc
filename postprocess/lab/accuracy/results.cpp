#include "lab/accuracy/results.h"

#include "support/resumed.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace drumlin::post {

const CsvSchema<ImpactPoint> &impact_points() {
  static const CsvSchema<ImpactPoint> schema(
      {transition_column<ImpactPoint>([](auto &row) -> auto & { return row.transition; }),
       csv_column("D", &ImpactPoint::damping_ratio, error_digits),
       csv_column("stepping", &ImpactPoint::stepping),
       csv_column("steps_per_contact", &ImpactPoint::steps_per_contact, error_digits),
       csv_column("worst_restitution_error", &ImpactPoint::errors, &ReboundErrors::worst, error_digits),
       csv_column("rms_restitution_error", &ImpactPoint::errors, &ReboundErrors::rms, error_digits)},
      4);
  return schema;
}

std::vector<std::string> larger_errors(const std::vector<ChainPoint> &points,
                                       const std::vector<ChainPoint> &known, bool complete) {
  static const std::pair<const char *, double ChainErrors::*> errors[] = {
      {"velocity_error", &ChainErrors::velocity},
      {"force_error", &ChainErrors::force},
      {"acceleration_error", &ChainErrors::acceleration},
      {"event_time_error_s", &ChainErrors::event_time_s},
      {"energy_residual", &ChainErrors::energy}};
  std::vector<std::string> larger;
  const auto report = [&](const ChainPoint &point, const std::string &words) {
    larger.push_back(fmt::format("{} {}, {}, {} steps per cycle: {}", point.chain_case,
                                 transition_name(point.transition), point.stepping, point.steps_per_cycle,
                                 words));
  };
  for (const ChainPoint &point : points) {
    const ChainPoint *before = find_point(known, chain_points(), point);
    if (before == nullptr) {
      report(point, "not known");
      continue;
    }
    for (const auto &[name, error] : errors) {
      const double was = before->errors.*error, is = point.errors.*error;
      if (std::isfinite(was) && !(is <= allowed_growth * was)) // NaN, too
        report(point, fmt::format("{} {:g}, known {:g}", name, is, was));
    }
  }
  for (const ChainPoint &point : known)
    if (complete && find_point(points, chain_points(), point) == nullptr) report(point, "not measured");
  return larger;
}

std::vector<ErrorPoint> impact_curve(const std::vector<ImpactPoint> &points, Transition transition,
                                     double damping_ratio, const std::string &stepping,
                                     double ReboundErrors::*error) {
  std::vector<ErrorPoint> curve;
  for (const ImpactPoint &point : points)
    if (point.transition == transition && point.damping_ratio == damping_ratio && point.stepping == stepping)
      curve.push_back({point.steps_per_contact, point.errors.*error});
  return in_order(std::move(curve));
}

} // namespace drumlin::post
