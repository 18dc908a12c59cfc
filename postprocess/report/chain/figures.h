// The figures of chains and single impacts: data, panels and captions. Planning them needs no gnuplot.
#pragma once

#include <string>
#include <vector>

#include "pages/figure.h"
#include "report/chain/measures.h"

namespace drumlin::post {

/// All figures that the runs allow, in order, and those that they do not.
FigurePlan plan_figures(const ReportResults &results);

} // namespace drumlin::post
