#include "report/summary.h"

#include <array>
#include <cmath>
#include <vector>

#include <nlohmann/json.hpp>

namespace drumlin::post {

namespace {

using Json = nlohmann::ordered_json;

Json check_json(const ReportResults &results, const Check &check) {
  Json json;
  const Run &run = results.runs[check.run].run;
  const bool valued = check.agreement != Agreement::not_measured && std::isfinite(check.value);
  json["run"] = run.name;
  json["case"] = run.case_name;
  json["transition"] = transition_name(run.transition());
  json["quantity"] = check.quantity;
  json["unit"] = check.unit;
  json["reference"] = check.reference;
  json["measured"] = valued ? Json(check.value) : Json(nullptr);
  json["difference"] = valued ? Json(check.difference) : Json(nullptr);
  json["tolerance"] = check.tolerance;
  const bool judged = check.agreement != Agreement::not_judged;
  json["agrees"] = judged ? Json(check.agrees()) : Json(nullptr);
  json["short_run"] = !judged;
  json["from"] = check.source;
  return json;
}

Json bed_json(const BedResult &bed) {
  const BedMeasures &m = bed.measures;
  const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
  Json json;
  json["name"] = bed.run.name;
  json["parameters"] = bed.run.parameters;
  json["cut"] = bed.run.cut;
  json["cycles"] = m.cycles;
  json["steady_cycles"] = m.steady_count;
  if (m.cycles > 0) {
    json["largest_drum_acceleration"] = number(m.extremes.acceleration.max);
    json["largest_contact_force"] = number(m.extremes.force.max);
    json["smallest_contact_force"] = number(m.extremes.force.min);
    json["contact_share"] = number(m.contact_share);
    json["settlement"] = number(m.settlement);
    json["settlement_per_cycle"] = number(m.settlement_per_cycle);
  }
  if (m.amplitudes) json["compaction_meter_value"] = number(compaction_meter_value(*m.amplitudes));
  json["imbalance_percent"] = number(m.imbalance_percent);
  json["coordination"] = {number(m.coordination_start), number(m.coordination_end)};
  json["void_ratio"] = {number(m.void_ratio_start), number(m.void_ratio_end)};
  return json;
}

Json ends_json(const EndsResult &result) {
  const auto numbers = [](const auto &values) {
    Json json = Json::array();
    for (const double value : values)
      json.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
    return json;
  };
  Json json;
  json["name"] = result.run.name;
  json["parameters"] = result.run.parameters;
  json["cut"] = result.run.cut;
  json["cycles"] = result.run.complete;
  json["amplitude"] = numbers(result.amplitude);
  json["tilt"] = numbers(std::array{result.tilt})[0];
  json["no_contact"] = numbers(result.no_contact);
  json["k_1"] = numbers(result.stiffness());
  json["k_1_of_halves"] = numbers(result.of_halves());
  json["error_of_ends"] = numbers(result.error());
  return json;
}

} // namespace

std::string summary_json(const ReportContent &content) {
  const ReportResults &results = content.results;
  const ReportVersions &versions = content.versions;
  const CheckCount count = count_checks(results);
  Json json;
  json["made_at"] = versions.made_at;
  json["drumlin"] = versions.drumlin;
  json["gnuplot"] = versions.gnuplot;
  json["checks"] = count.all;
  json["agree"] = count.agree;
  json["agree_to_digits_given"] = count.same_digits;
  json["not_judged"] = count.not_judged;
  json["runs"] = Json::array();
  for (const RunResult &result : results.runs) {
    Json run;
    run["name"] = result.run.name;
    run["parameters"] = result.run.parameters;
    run["cut"] = result.run.cut;
    run["missing"] = result.run.missing;
    json["runs"].push_back(run);
  }
  for (const LeftOut &folder : content.left_out)
    json["left_out"].push_back(
        {{"folder", folder.folder.string()}, {"why", folder.why}, {"cut", folder.cut}});
  for (const BedResult &bed : content.beds)
    json["beds"].push_back(bed_json(bed));
  for (const EndsResult &result : content.ends)
    json["ends"].push_back(ends_json(result));
  json["comparisons"] = Json::array();
  for (const std::vector<Check> *checks : {&results.checks, &results.restitution, &results.words})
    for (const Check &check : *checks)
      json["comparisons"].push_back(check_json(results, check));
  // Names of folders need not be UTF-8, which JSON requires.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace drumlin::post
