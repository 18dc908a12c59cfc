#include "pages/figure_data.h"

#include "support/csv.h"

#include <cmath>

#include <fmt/format.h>

namespace drumlin::post {

CurveTable::CurveTable(const std::string &columns) : text_("curve," + columns + "\n") {}

void CurveTable::row(const std::string &curve, std::initializer_list<double> values) {
  text_ += csv_cell(curve);
  for (const double value : values) {
    text_ += ',';
    if (std::isfinite(value)) text_ += fmt::format("{:.12g}", value);
  }
  text_ += '\n';
}

std::string data_path(const std::string &figure) { return "../data/" + figure + ".csv"; }

std::string of_curve(const std::string &curve, const std::string &value, int stride, int phase) {
  const std::string thinned = stride > 1 ? fmt::format(" && int($0)%{}=={}", stride, phase) : "";
  std::string quoted; // in gnuplot's single quotes a quote is doubled
  for (const char c : curve)
    quoted += c == '\'' ? "''" : std::string(1, c);
  return fmt::format("(strcol(1) eq '{}'{} ? {} : NaN)", quoted, thinned, value);
}

Curve curve(const std::string &figure, const std::string &name, const std::string &x, const std::string &y,
            CurveStyle style, int stride, int phase) {
  return {data_path(figure), of_curve(name, x, stride, phase), y, name, style};
}

} // namespace drumlin::post
