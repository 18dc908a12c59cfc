// The data of a figure: one tidy CSV file per figure, and the curves of its panels read from there.
#pragma once

#include "pages/gnuplot.h"

#include <initializer_list>
#include <string>

namespace drumlin::post {

/// Rows of a tidy CSV: the first column names the curve (without commas, which gnuplot would split at), blank
/// cells are values that a row does not have.
class CurveTable {
public:
  /// \param columns header of the other columns, with units
  explicit CurveTable(const std::string &columns);
  void row(const std::string &curve, std::initializer_list<double> values);
  const std::string &text() const { return text_; }

private:
  std::string text_;
};

/// Where a figure's script finds its CSV.
std::string data_path(const std::string &figure);

/// Gnuplot expression: `value` in rows of the named curve, nothing in others. Markers take each stride-th
/// row.
std::string of_curve(const std::string &curve, const std::string &value, int stride = 1, int phase = 0);

/// The named curve of a figure, with its name in the legend; x and y as in Curve.
Curve curve(const std::string &figure, const std::string &name, const std::string &x, const std::string &y,
            CurveStyle style, int stride = 1, int phase = 0);

} // namespace drumlin::post
