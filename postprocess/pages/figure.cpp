#include "pages/figure.h"

#include "support/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace drumlin::post {

namespace {

KeyFigure key_figure(const PageFigure &whole, const std::string &page, const std::string &subject) {
  KeyFigure key;
  key.figure = whole.figure;
  key.figure.name += "_key";
  key.figure.half = true;
  if (!whole.figure.panels.empty())
    key.figure.panels = {whole.figure.panels[std::min(whole.key_panel, whole.figure.panels.size() - 1)]};
  // "Fig. 5  Drum acceleration ...": the number is left out here, since the link below the figure has it.
  key.caption = whole.figure.title;
  if (key.caption.rfind(whole.label, 0) == 0) key.caption.erase(0, whole.label.size());
  key.caption.erase(0, std::min(key.caption.find_first_not_of(' '), key.caption.size()));
  key.href = fmt::format("{}#{}", page, whole.figure.name);
  key.link = page.empty() ? whole.label : fmt::format("{} of the page on {}", whole.label, subject);
  return key;
}

} // namespace

std::vector<KeyFigure> key_figures(const std::vector<PageFigure> &figures, const std::string &page,
                                   const std::string &subject) {
  std::vector<const PageFigure *> candidates;
  for (const PageFigure &figure : figures)
    if (figure.weight > 0.0) candidates.push_back(&figure);
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const PageFigure *a, const PageFigure *b) { return a->weight > b->weight; });
  constexpr std::size_t most = 2;
  candidates.resize(std::min(candidates.size(), most));
  std::vector<KeyFigure> keys;
  keys.reserve(candidates.size());
  for (const PageFigure *figure : candidates)
    keys.push_back(key_figure(*figure, page, subject));
  return keys;
}

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
