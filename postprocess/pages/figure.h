// A figure of a page: its curves with caption and data.
#pragma once

#include "pages/gnuplot.h"

#include <cstddef>
#include <initializer_list>
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

/// Rows of a tidy CSV file: the first column is the name of the curve, without commas, since gnuplot would
/// split the name there. A value that is not finite becomes an empty cell.
class CurveTable {
public:
  /// \param columns header of the other columns, with units
  explicit CurveTable(const std::string &columns);
  void row(const std::string &curve, std::initializer_list<double> values);
  const std::string &text() const { return text_; }

private:
  std::string text_;
};

/// Path of a figure's CSV file, relative to the folder of its script.
std::string data_path(const std::string &figure);

/// Gnuplot expression that is `value` in rows of the named curve and undefined in all others. With a stride
/// above 1 only each stride-th row of the file counts, beginning with row `phase`.
std::string of_curve(const std::string &curve, const std::string &value, int stride = 1, int phase = 0);

/// The named curve of a figure, with its name in the legend; x and y as in Curve, stride and phase as in
/// of_curve().
Curve curve(const std::string &figure, const std::string &name, const std::string &x, const std::string &y,
            CurveStyle style, int stride = 1, int phase = 0);

} // namespace drumlin::post
