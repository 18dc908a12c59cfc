// Meter values of the cells of a way, pass after pass, and what rules of acceptance ask of them: gain of the
// mean per pass, coverage, coefficient of variation.
#pragma once

#include "passes/values.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// A cell of the ground.
struct MapPlace {
  std::size_t area = 0; ///< the number of the run
  double along = 0.0;   ///< m, of its middle, along the way
};

/// What the meter has shown in a cell in a pass.
struct MapValue {
  int pass = 1;          ///< counted from 1
  std::size_t place = 0; ///< of MeterMap::places
  double value = 0.0;
};

struct MeterMap {
  std::string meter = "CMV", unit = "-";
  double cell = 0.0;            ///< m, side of a cell
  std::vector<WayPart> spots;   ///< soft or stiff parts of the ground; the same in all areas
  std::vector<MapPlace> places; ///< run by run, then along the way
  std::vector<MapValue> values; ///< by pass, then by place; at most one for each of both

  /// The unit behind a number, with a blank before it; empty if there is none.
  std::string unit_words() const;
  int passes() const { return values.empty() ? 0 : values.back().pass; }
  /// The values of a pass.
  std::vector<MapValue> of_pass(int pass) const;
  /// The value of each cell in its last pass.
  std::vector<MapValue> last() const;
};

/// A meter that cells of a run may be judged by, by its name in way.csv and passes.csv.
struct CellMeter {
  const char *name, *unit;
  std::optional<double> (*value)(const WayCell &);
};
/// The meter of this name; std::invalid_argument with the names that there are.
const CellMeter &cell_meter(const std::string &name);

/// The cells of runs, an area each; without values if no cell has one, as of a roller that does not shake.
MeterMap meter_map(const std::vector<PassesResult> &results, const CellMeter &meter);

/// What an acceptance asks for, shares from 0 to 1.
struct AcceptanceRule {
  std::optional<double> target; ///< of the meter; without it nothing is judged
  double coverage = 0.8;        ///< least share of the cells whose value is at least the target
  double variation = 0.2;       ///< largest coefficient of variation of the cells
  double gain = 0.05;           ///< of the mean in the last pass, below which further passes gain nothing
};

/// The cells of a pass, or of the last pass of each cell.
struct PassCells {
  int pass = 0; ///< 0: the last of each cell
  std::size_t cells = 0;
  double mean = 0.0, deviation = 0.0; ///< standard deviation; NaN of less than two cells
  std::optional<double> gain; ///< relative, of the mean of the cells that have this pass and the one before
  std::optional<double> coverage; ///< share of the cells at or above the target

  double variation() const { return deviation / mean; }
};
/// A row for each pass, then that of the last pass of each cell; none without values.
std::vector<PassCells> cells_of_passes(const MeterMap &map, const AcceptanceRule &rule);

/// The least number of passes after which no pass has changed the mean by the rule's gain or more; nothing if
/// the last one still did or if there are less than two.
std::optional<int> passes_until_gain(const std::vector<PassCells> &rows, const AcceptanceRule &rule);

/// acceptance.csv: a row for each pass, and one with `last` for the last pass of each cell.
std::string acceptance_csv(const MeterMap &map, const std::vector<PassCells> &rows);

/// In one sentence: mean, scatter and gain of the last pass, coverage if there is a target.
std::string answer_of(const MeterMap &map, const std::vector<PassCells> &rows, const AcceptanceRule &rule);

/// A sentence for each spot that compares two means of the meter value: that of the cells whose middle lies
/// on the spot, and that of the cells no part of which lies on any spot. Of several runs it gives the 95 %
/// confidence interval of the difference. A spot is left out if some area has no cells of one of both kinds.
std::vector<std::string> answers_on_spots(const MeterMap &map);

} // namespace drumlin::post
