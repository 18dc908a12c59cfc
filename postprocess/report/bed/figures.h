// The figures of bed runs: histories, loops, settlement, energies, forces of the walls, and pictures of the
// bed from the run's dumps.
#pragma once

#include "pages/figure.h"
#include "report/bed/measures.h"
#include "report/chain/figures.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::post {

/// Id of the page's section that shows a group; groups count from 0.
std::string bed_section(std::size_t group);

/// All figures of the groups, numbered from 1. Reads the dumps of the runs: std::runtime_error for a dump
/// that cannot be read.
FigurePlan plan_bed_figures(const std::vector<BedGroup> &groups);

/// What a bed gives to a figure, row by row.
template <std::size_t N>
using Rows = std::vector<std::array<double, N>>;

template <std::size_t N, std::size_t... I>
void put_row(CurveTable &table, const std::string &name, const std::array<double, N> &row,
             std::index_sequence<I...> /*columns*/) {
  table.row(name, {row[I]...});
}

/// Puts the rows of beds into a table: of one bed as they are, of several their means, and the least and the
/// largest of them as curves "LABEL low" and "LABEL high", as many rows as all have. The first `abscissas`
/// columns are only averaged. Returns what stands under the label.
template <std::size_t N>
Rows<N> put_beds(CurveTable &table, const std::string &label, const std::vector<Rows<N>> &beds,
                 std::size_t abscissas) {
  const auto put = [&table](const std::string &name, const Rows<N> &rows) {
    for (const auto &row : rows)
      put_row(table, name, row, std::make_index_sequence<N>());
  };
  if (beds.size() == 1) {
    put(label, beds.front());
    return beds.front();
  }
  std::size_t count = std::numeric_limits<std::size_t>::max();
  for (const Rows<N> &bed : beds)
    count = std::min(count, bed.size());
  Rows<N> means(count), low(count), high(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<double, N> middle{};
    for (std::size_t j = 0; j < N; ++j) {
      low[i][j] = high[i][j] = beds.front()[i][j];
      for (const Rows<N> &bed : beds) {
        middle[j] += bed[i][j] / static_cast<double>(beds.size());
        low[i][j] = std::min(low[i][j], bed[i][j]);
        high[i][j] = std::max(high[i][j], bed[i][j]);
      }
      if (j < abscissas) low[i][j] = high[i][j] = middle[j];
    }
    means[i] = middle;
  }
  put(label, means);
  put(label + " low", low);
  put(label + " high", high);
  return means;
}

/// The curve of put_beds() in a panel, and thin the least and the largest of several beds.
inline void add_beds(Panel &panel, const std::string &figure, const std::string &label, std::size_t beds,
                     const std::string &x, const std::string &y, CurveStyle style, const std::string &title) {
  panel.add(curve(figure, label, x, y, style), title);
  if (beds < 2) return;
  for (const char *side : {" low", " high"})
    panel.add(curve(figure, label + side, x, y, CurveStyle::limit), "");
}

} // namespace drumlin::post
