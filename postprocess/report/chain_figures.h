// The report's figures: data, looks and captions. Planning needs no gnuplot; drawing does.
#pragma once

#include <string>
#include <vector>

#include "pages/figure.h"
#include "report/chain_measures.h"

namespace drumlin::post {

FigurePlan plan_figures(const ReportResults &results);

} // namespace drumlin::post
