// A figure of a page: its curves, with the words and the data that belong to them.
#pragma once

#include "pages/gnuplot.h"

#include <string>
#include <vector>

namespace drumlin::post {

/// A figure with the words and the data that belong to it.
struct PlannedFigure {
  std::string section; ///< id of the report's section that shows it
  std::string label;   ///< "Fig. 5"
  std::string caption; ///< what one sees, plain text
  Figure figure;       ///< figure.name is the stem of all its files
  std::string csv;     ///< content of data/NAME.csv
};

/// A figure that the given runs do not allow, and why.
struct AbsentFigure {
  std::string section;
  std::string label;
  std::string reason;
};

/// All figures of a report in order.
struct FigurePlan {
  std::vector<PlannedFigure> figures;
  std::vector<AbsentFigure> absent;
};

} // namespace drumlin::post
