#include "passes/field_page.h"

#include "pages/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace drumlin::post {

void write_field_page(const std::filesystem::path &folder, const FieldFile &field, const JudgedMap &judged) {
  Page page(folder, "What a site's file says of the passes", std::nullopt);
  page.answer(answer_of(judged.map, judged.rows, judged.rule));
  page.answer(criteria_of(judged));
  page.answer(fmt::format("{}.", field.file.string()));
  for (const std::string &note : field.notes)
    page.answer(note);
  int number = 0;
  const auto label = [&number] { return fmt::format("Fig. {}", ++number); };
  page.section("Over the passes");
  if (const auto rules = rule_figure(label(), judged, true)) page.figure(*rules);
  page.table(map_table(judged));
  if (const std::vector<Acceptance> criteria = criteria_of(judged); !criteria.empty())
    page.table(acceptance_table(criteria));
  page.section("Along the way");
  page.figure(map_figure(label(), judged));
  const bool wide = std::any_of(field.places.begin(), field.places.end(),
                                [&](const MapPlace &place) { return place.across > 0.5 * field.cell; });
  if (wide) page.figure(plan_figure(label(), judged));
  page.section("What is not known from such a file");
  page.paragraph(
      "The soil: layers, density, water, stresses and what lies below them. The meter value is one "
      "number of the roller; from it alone follows no modulus and no degree of compaction without a "
      "calibration on the same site.");
  page.paragraph(
      "How the value came into the cell: over which time it is averaged, how far it lags behind the "
      "drum, and that all cells below one drum have the same value, so that neighbours across the "
      "way are no independent measurements. The operating mode, unless RMV tells it; "
      "the path of the roller: the way here is the longest extent of the cells.");
  page.paragraph(
      "Settlement (passes.csv) is the difference of elevations of the receiver, each right to "
      "centimetres at best. The number of a pass is the file's; passes of other machines, lifts and "
      "days count as it counts them.");
  page.write();
}

} // namespace drumlin::post
