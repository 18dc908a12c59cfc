// The figures of chains and single impacts: data, panels and captions. Planning them needs no gnuplot.
#pragma once

#include <string>
#include <vector>

#include "pages/figure.h"
#include "report/chain/measures.h"

namespace drumlin::post {

/// Cycles that a figure shows of a run, the last ones.
constexpr int shown_cycles = 3;
/// The line of a run under a transition.
CurveStyle line_style(Transition transition);

/// All figures that the runs allow, in order, and those that they do not.
FigurePlan plan_figures(const ReportResults &results);

} // namespace drumlin::post
