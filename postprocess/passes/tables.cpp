#include "passes/tables.h"

#include "support/csv.h"
#include "support/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace drumlin::post {

std::string cell_of(double value) { return std::isfinite(value) ? number_text(value) : ""; }
std::string cell_of(std::optional<double> value) { return value ? cell_of(*value) : ""; }

namespace {

/// Depth of a height below the surface before the first pass.
double depth_of(const PassesResult &result, double height) {
  return result.passes.front().soil.surface - height;
}

} // namespace

std::vector<PassColumn> pass_columns(std::size_t layers) {
  std::vector<PassColumn> columns;
  const auto add = [&](const std::string &header, double PassValues::*value) {
    columns.push_back({header, [value](const PassValues &pass) { return pass.*value; }});
  };
  const auto add_layer = [&](const char *name, const char *unit, auto value) {
    for (std::size_t layer = 0; layer < layers; ++layer)
      columns.push_back({fmt::format("{}_{} [{}]", name, layer + 1, unit),
                         [value, layer](const PassValues &pass) { return value(pass)[layer]; }});
  };
  add("settlement [m]", &PassValues::settlement);
  add("settlement_scatter [m]", &PassValues::settlement_scatter);
  add("compaction [m]", &PassValues::compaction);
  columns.push_back({"pushed [m]", [](const PassValues &pass) { return pass.pushed(); }});
  add("heave [m]", &PassValues::heave);
  add_layer(
      "thickness", "m", [](const PassValues &pass) -> const auto & { return pass.soil.thickness; });
  add_layer(
      "solid_fraction", "-", [](const PassValues &pass) -> const auto & { return pass.soil.solid_fraction; });
  add_layer(
      "solid_fraction_scatter", "-",
      [](const PassValues &pass) -> const auto & { return pass.solid_scatter; });
  for (std::size_t layer = 0; layer < layers; ++layer)
    columns.push_back({fmt::format("inner_solid_fraction_{} [-]", layer + 1),
                       [layer](const PassValues &pass) { return pass.soil.inner_solid_fraction(layer); }});
  add_layer(
      "relative_density", "-", [](const PassValues &pass) -> const auto & { return pass.relative_density; });
  add_layer(
      "degree_of_compaction", "-", [](const PassValues &pass) -> const auto & { return pass.degree; });
  add("energy_exciter [J/m]", &PassValues::energy_exciter);
  add("energy_traction [J/m]", &PassValues::energy_traction);
  add("traction [N]", &PassValues::traction);
  add("CMV [-]", &PassValues::cmv);
  add("CMV_scatter [-]", &PassValues::cmv_scatter);
  add("RMV [-]", &PassValues::rmv);
  add("CCV [-]", &PassValues::ccv);
  add("k_B [N/m]", &PassValues::k_B);
  add("E_vib [Pa]", &PassValues::E_vib);
  add("k [N/m]", &PassValues::k);
  add("k_half_width [N/m]", &PassValues::k_half_width);
  add("D [-]", &PassValues::D);
  add("D_half_width [-]", &PassValues::D_half_width);
  add("contact_share [-]", &PassValues::contact_share);
  add("peak_force [N]", &PassValues::peak_force);
  return columns;
}

std::size_t most_passes(const std::vector<PassesResult> &results) {
  std::size_t most = 0;
  for (const PassesResult &result : results)
    most = std::max(most, result.passes.size() - 1);
  return most;
}

std::vector<double> values_after(const std::vector<PassesResult> &results, std::size_t pass,
                                 const std::function<double(const PassValues &)> &value) {
  std::vector<double> values;
  for (const PassesResult &result : results)
    if (pass < result.passes.size())
      if (const double one = value(result.passes[pass]); std::isfinite(one)) values.push_back(one);
  return values;
}

std::string mode_in(const std::vector<PassesResult> &results, std::size_t pass) {
  std::map<std::string, int> counts;
  for (const PassesResult &result : results)
    if (pass < result.passes.size()) ++counts[result.passes[pass].mode];
  const auto most = std::max_element(counts.begin(), counts.end(),
                                     [](const auto &a, const auto &b) { return a.second < b.second; });
  return most == counts.end() ? "" : most->first;
}

std::string passes_csv(const std::vector<PassesResult> &results) {
  const std::vector<PassColumn> columns = pass_columns(results.front().layers());
  std::vector<std::string> header = {"pass", "runs"};
  for (const PassColumn &column : columns) {
    header.push_back(column.header);
    const std::size_t unit = column.header.find(" [");
    header.push_back(column.header.substr(0, unit) + "_interval" + column.header.substr(unit));
  }
  header.emplace_back("mode");
  std::string text = csv_line(header);
  for (std::size_t pass = 0; pass <= most_passes(results); ++pass) {
    const auto runs = std::count_if(results.begin(), results.end(), [pass](const PassesResult &result) {
      return pass < result.passes.size();
    });
    std::vector<std::string> cells = {std::to_string(pass), std::to_string(runs)};
    for (const PassColumn &column : columns) {
      const std::vector<double> values = values_after(results, pass, column.value);
      const MeanInterval mean = values.empty() ? MeanInterval{NAN, NAN} : mean_interval(values);
      cells.push_back(cell_of(mean.mean));
      cells.push_back(cell_of(mean.half_width));
    }
    cells.push_back(mode_in(results, pass));
    text += csv_line(cells);
  }
  return text;
}

namespace {

std::string passes_csv(const PassesResult &result) {
  const std::vector<PassColumn> columns = pass_columns(result.layers());
  std::vector<std::string> header = {"pass"};
  for (const PassColumn &column : columns)
    header.push_back(column.header);
  header.emplace_back("mode");
  std::string text = csv_line(header);
  for (const PassValues &pass : result.passes) {
    std::vector<std::string> cells = {std::to_string(pass.pass)};
    for (const PassColumn &column : columns)
      cells.push_back(cell_of(column.value(pass)));
    cells.push_back(pass.mode);
    text += csv_line(cells);
  }
  return text;
}

std::string way_csv(const PassesResult &result) {
  std::vector<std::string> header = {"pass", "s [m]", "cycles [-]", "surface_before [m]",
                                     "surface_after [m]"};
  for (std::size_t layer = 0; layer < result.layers(); ++layer)
    header.push_back(fmt::format("solid_fraction_{} [-]", layer + 1));
  header.insert(header.end(), {"CMV [-]", "RMV [-]", "CCV [-]", "contact_share [-]", "peak_force [N]",
                               "energy_exciter [J/m]", "energy_traction [J/m]", "mode"});
  std::string text = csv_line(header);
  for (const WayCell &cell : result.cells) {
    if (cell.pass == 0) continue;
    std::vector<std::string> cells = {
        std::to_string(cell.pass), number_text(0.5 * (cell.part.from + cell.part.to)),
        std::to_string(cell.cycles), cell_of(cell.before.surface), cell_of(cell.after.surface)};
    for (const double phi : cell.after.solid_fraction)
      cells.push_back(cell_of(phi));
    const MeterWindow &meter = cell.meter;
    for (const std::optional<double> &value :
         {meter.cmv, meter.rmv, cell.ccv, meter.contact_share, meter.peak_force})
      cells.push_back(cell_of(value));
    cells.push_back(cell_of(cell.energy_exciter));
    cells.push_back(cell_of(cell.energy_traction));
    cells.emplace_back(cell.cycles > 0 && meter.cmv ? mode_names[static_cast<std::size_t>(meter.mode)] : "");
    text += csv_line(cells);
  }
  return text;
}

std::string surface_csv(const PassesResult &result) {
  std::vector<std::string> header = {"s [m]", "before [m]"};
  for (std::size_t pass = 1; pass < result.surfaces.size(); ++pass)
    header.push_back(fmt::format("pass_{} [m]", pass));
  std::string text = csv_line(header);
  for (std::size_t line = 0; line < result.lines.count; ++line) {
    std::vector<std::string> cells = {number_text(result.lines.at(line))};
    for (const std::vector<double> &heights : result.surfaces)
      cells.push_back(cell_of(heights[line]));
    text += csv_line(cells);
  }
  return text;
}

std::string depth_csv(const PassesResult &result) {
  std::string text =
      csv_line({"pass", "height [m]", "depth [m]", "solid_fraction [-]", "coordination [-]",
                "vertical_stress [Pa]", "largest_vertical_stress [Pa]", "horizontal_stress [Pa]",
                "largest_horizontal_stress [Pa]", "stress_of", "stress_dumps"});
  for (const auto &[pass, row, passing] : result.depth)
    text += csv_line({std::to_string(pass), number_text(row.height), cell_of(depth_of(result, row.height)),
                      cell_of(row.solid_fraction), cell_of(row.coordination), cell_of(row.vertical),
                      cell_of(row.largest_vertical), cell_of(row.horizontal), cell_of(row.largest_horizontal),
                      passing > 0    ? "passing drum"
                      : row.vertical ? "standing roller"
                                     : "",
                      row.vertical ? std::to_string(std::max<std::size_t>(1, passing)) : ""});
  return text;
}

} // namespace

std::vector<FileText> pass_tables(const std::filesystem::path &folder, const PassesResult &result) {
  return {{folder / "passes.csv", passes_csv(result)},
          {folder / "way.csv", way_csv(result)},
          {folder / "surface.csv", surface_csv(result)},
          {folder / "depth.csv", depth_csv(result)}};
}

} // namespace drumlin::post
