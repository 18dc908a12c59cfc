// A figure of a page: its curves with caption and data.
#pragma once

#include "pages/gnuplot.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// A figure with its caption and its data.
struct PageFigure {
  std::string section;       ///< id of the report's section that shows it
  std::string label;         ///< "Fig. 5"
  std::string caption;       ///< what the figure shows, plain text
  Figure figure;             ///< figure.name is the stem of all its files
  std::string csv;           ///< content of data/NAME.csv
  double weight = 0.0;       ///< pages open with their figures of largest weight; 0: not a candidate
  std::size_t key_panel = 0; ///< the panel that the page then opens with
};

/// A figure of a page that is no report's, without its data.
inline PageFigure page_figure(std::string label, std::string caption, Figure figure, double weight = 0.0) {
  return {"", std::move(label), std::move(caption), std::move(figure), "", weight, 0};
}

/// A figure that a page opens with: a panel of one of its figures, drawn at half the width.
struct KeyFigure {
  Figure figure;       ///< NAME_key; it has no data of its own
  std::string caption; ///< plain text
  std::string href;    ///< where the whole figure is
  std::string link;    ///< text of the link there
};

/// A figure that cannot be made from the given runs, and why.
struct AbsentFigure {
  std::string section;
  std::string label;
  std::string reason;
};

/// All figures of a report in order.
struct FigurePlan {
  std::vector<PageFigure> figures;
  std::vector<AbsentFigure> absent;
};

/// The figures that a page opens with: up to two, of largest weight above 0, the larger first.
/// \param page the page that has the figures, relative to the one that opens with them; empty for the same
/// page
/// \param subject of that page, in words
std::vector<KeyFigure> key_figures(const std::vector<PageFigure> &figures, const std::string &page = "",
                                   const std::string &subject = "beds");

} // namespace drumlin::post
