// What the pages on element tests of soil have in common: reading the runs, judging them, grouping them by
// soil and seed.
#pragma once

#include "pages/page.h"
#include "report/run_folder.h"
#include "runs/element_rows.h"
#include "support/csv.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// Inertial number and energy error below which a test is slow enough and exact enough, and the share of the
/// strain asked for at which it has not been interrupted: steps are whole, so that a test may end just before
/// its strain.
constexpr double allowed_inertial_number = 1e-3;
constexpr double allowed_energy_error = 1e-3;
constexpr double complete_strain = 0.99;

/// A run of an element test: of `run` only folder, name and parameters are read.
template <class Row>
struct ElementRun {
  Run run;
  std::vector<Row> rows;
};

/// The folders as runs of which only folder, name and parameters are read. Throws std::runtime_error for a
/// file that cannot be read.
std::vector<Run> read_named_runs(const std::vector<std::filesystem::path> &folders);

/// Reads the folders, each with a file `csv`, by `read_rows`, and names the runs. Throws std::runtime_error
/// for a file that cannot be read.
template <class Row>
std::vector<ElementRun<Row>> read_element_runs(const std::vector<std::filesystem::path> &folders,
                                               const std::string &csv,
                                               std::vector<Row> (*read_rows)(const std::filesystem::path &)) {
  std::vector<ElementRun<Row>> runs;
  for (Run &run : read_named_runs(folders)) {
    std::vector<Row> rows = read_rows(run.folder / csv);
    runs.push_back({std::move(run), std::move(rows)});
  }
  return runs;
}

/// Largest size of a number over rows.
template <class Row>
double largest(const std::vector<Row> &rows, double Row::*number) {
  double most = 0.0;
  for (const Row &row : rows)
    most = std::max(most, std::fabs(row.*number));
  return most;
}

/// Whether a test was slow enough and exact enough, and not interrupted.
struct TestQuality {
  double inertial_number = 0.0, energy_error = 0.0; ///< the largest
  /// Over the strain asked for; none: the test is not asked for a strain.
  std::optional<double> strain_reached = std::nullopt;
  bool good() const;
};

/// Of the rows of one run; Row has the members inertial_number and energy_error.
template <class Row>
TestQuality quality_of(const std::vector<Row> &rows) {
  return {largest(rows, &Row::inertial_number), largest(rows, &Row::energy_error)};
}

/// The worst of all numbers. qualities: at least one.
TestQuality worst_of(const std::vector<TestQuality> &qualities);

/// The acceptance criteria of a test.
std::vector<Acceptance> quality_criteria(const TestQuality &quality);

template <class Row>
TestQuality run_quality(const ElementRun<Row> &run) {
  return quality_of(run.rows);
}

/// Says on a page whether the worst of all runs was good. \param quality of a run
template <class Row>
void answer_quality(Page &page, const std::vector<ElementRun<Row>> &runs,
                    TestQuality (*quality)(const ElementRun<Row> &) = run_quality<Row>) {
  std::vector<TestQuality> qualities;
  qualities.reserve(runs.size());
  for (const ElementRun<Row> &run : runs)
    qualities.push_back(quality(run));
  page.answer(quality_criteria(worst_of(qualities)));
}

/// A table of runs: name and sample of each, the measured quantities in `columns` (with " | " between them),
/// and whether it was good.
PageTable element_run_table(const std::string &name, const std::string &columns);
/// Adds a run; `measured` has a cell for each of the columns.
void add_element_run(PageTable &table, const Run &run, const std::vector<std::string> &measured,
                     const TestQuality &quality);

/// Tests of one soil, as places in a list of runs.
struct SoilGroup {
  std::string name; ///< number, and the engine
  std::vector<std::size_t> runs;

  /// "soil 1", for legends.
  std::string short_name() const { return name.substr(0, name.find(':')); }
};

/// Groups runs whose parameters agree, but for the seed and those named in `varied`.
std::vector<SoilGroup> soils_of(const std::vector<const Run *> &runs, const std::vector<std::string> &varied);
template <class Row>
std::vector<SoilGroup> soils_of(const std::vector<ElementRun<Row>> &runs,
                                const std::vector<std::string> &varied) {
  std::vector<const Run *> all;
  all.reserve(runs.size());
  for (const ElementRun<Row> &run : runs)
    all.push_back(&run.run);
  return soils_of(all, varied);
}

/// The runs of a soil by a number of theirs, `numbers[n]` being that of run n.
std::map<double, std::vector<std::size_t>> grouped_by(const std::vector<double> &numbers,
                                                      const SoilGroup &soil);

/// Values of one quantity in tests of one soil, by seed. Runs of one seed under several stresses have nearly
/// the same sample: their mean counts once.
class SeedValues {
public:
  /// A value that is not finite is left out.
  void add(const std::string &seed, double value);
  /// "mean ± half of the 95 % confidence interval" over the seeds; of one seed the mean alone; no_value
  /// without values.
  std::string mean_text(int decimals = 1) const;
  /// "smallest to largest"; no_value without values.
  std::string range_text() const;

private:
  std::map<std::string, std::vector<double>> values_;
};

/// Styles of curve number n of a figure, which repeat: lines with markers, and lines.
CurveStyle series_style(std::size_t n);
CurveStyle line_style(std::size_t n);

/// Digits of a number; no_value if it is not finite.
std::string number_cell(double value, int digits = 4);

/// A name for a curve, without what gnuplot would split it at.
std::string curve_text(std::string name);

} // namespace drumlin::post
