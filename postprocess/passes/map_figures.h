// The parts of a page that show a map of meter values, along the way and over passes, and what rules of
// acceptance say.
#pragma once

#include "pages/figure.h"
#include "pages/page.h"
#include "passes/meter_map.h"
#include "passes/values.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// The style of the n-th of at most five lines.
CurveStyle pass_line(std::size_t n);
/// The passes that a figure of curves shows, 0 the state before the first: at most five.
std::vector<std::size_t> shown_passes(std::size_t passes);

/// A map with what rules say of it.
struct JudgedMap {
  MeterMap map;
  AcceptanceRule rule;
  std::vector<PassCells> rows;

  JudgedMap(MeterMap values, const AcceptanceRule &asked);
};

/// The criteria of the rule; none without a target.
std::vector<Acceptance> criteria_of(const JudgedMap &judged);

/// The colour map over place and passes, of the first run, and the last passes as curves.
PageFigure map_figure(const std::string &label, const JudgedMap &judged);
/// The mean over passes (if `mean`), its gain and coverage, as far as there are any; nothing if there is
/// none.
std::optional<PageFigure> rule_figure(const std::string &label, const JudgedMap &judged, bool mean);
/// What each pass has, as acceptance.csv.
PageTable map_table(const JudgedMap &judged);

/// The soil with the pressure in its balls and the roller, dump by dump: in three dimensions the balls that
/// the middle section across the drum's axis cuts. \pre the run has dumps for it, PassesResult::animated
PageFigure animation_of(const std::string &label, const PassesResult &result);

} // namespace drumlin::post
