// The data of a figure: one tidy CSV file per figure, and the curves of its panels read from there.
#pragma once

#include "pages/gnuplot.h"

#include <initializer_list>
#include <string>

namespace drumlin::post {

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
