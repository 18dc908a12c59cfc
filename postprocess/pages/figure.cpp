#include "pages/figure.h"

#include <algorithm>

#include <fmt/format.h>

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

} // namespace drumlin::post
