// The report's page on runs of a drum with two ends, which tilts about the way of travel: ends.html, next to
// index.html.
#pragma once

#include "chain/two_ends.h"
#include "meter/both_ends.h"
#include "pages/figure.h"
#include "pages/table.h"
#include "report/answer.h"
#include "report/run_folder.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

struct ReportContent;

/// A run with its measured values, over its last cycles: an even number of them, at most as many as a meter's
/// window has. NaN stands for what the run does not give.
struct EndsResult {
  Run run;
  std::optional<double> half_width;  ///< distance of the drum's ends from its middle [m]
  int cycles = 0;                    ///< that the values are of
  int repeats = 0;                   ///< cycles after which the motion repeats: 1, 2, or 0 for neither
  std::array<double, 3> amplitude;   ///< of the first harmonic: left end, middle, right end [m]
  double tilt;                       ///< half the range of the drum's tilt in the last two cycles [rad]
  std::array<double, 2> no_contact;  ///< share of time without force: left half, right half [-]
  std::optional<MeterWindow> middle; ///< of a meter in the middle
  std::optional<BothEnds> ends;
  std::string no_meter;             ///< why there are no meter values
  std::optional<TwoEnds> machine{}; ///< how it tilts; the k and c of its contacts have no meaning

  /// k_1 of a meter at the left end, in the middle and at the right end [N/m].
  std::array<double, 3> stiffness() const;
  /// k_1 of each half [N/m].
  std::array<double, 2> of_halves() const;
  /// By how much a meter at each end is off that in the middle [-].
  std::array<double, 2> error() const;
};

/// Measures a run of kind ends.
EndsResult analyse_ends(Run run);

/// The motion of each run, numbered from 1, and over the ratio of stiffness below both halves the error of a
/// meter at one end, of the machine and the soil of the run of which the answer tells.
FigurePlan plan_ends_figures(const std::vector<EndsResult> &results);

/// The numbers, a row for each run: of its motion, and what meters show of it.
std::vector<PageTable> ends_tables(const std::vector<EndsResult> &results);

/// What was run, and how far off a meter at one end is at most. Empty without runs.
Answer ends_answer(const std::vector<EndsResult> &results);

/// The page. Figures and data are expected where report_page() expects them.
std::string ends_page(const ReportContent &content);

} // namespace drumlin::post
