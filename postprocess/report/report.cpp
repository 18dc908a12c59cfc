#include "report/report.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <stdexcept>

#include <unistd.h>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "chain/direct_solver.h"
#include "pages/gnuplot.h"
#include "report/bed_figures.h"
#include "report/bed_measures.h"
#include "report/bed_page.h"
#include "report/chain_figures.h"
#include "report/chain_measures.h"
#include "report/chain_page.h"
#include "report/run_folder.h"
#include "support/files.h"
#include "support/process.h"
#include "support/progress.h"
#include "support/text.h"
#include "support/usage_error.h"

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

constexpr const char *summary_file = "report.json";

/// The place of the report, absolute and without a trailing slash. Throws if it may not be replaced.
fs::path checked_place(const fs::path &out, const ReportFolders &folders) {
  fs::path place = fs::absolute(out).lexically_normal();
  if (!place.has_filename()) place = place.parent_path();
  const auto refuse = [&out](const std::string &why) {
    throw UsageError(
        fmt::format("--out is '{}': {}; allowed: a new folder or an earlier report", out.string(), why));
  };
  if (fs::exists(place)) {
    if (!fs::is_directory(place)) refuse("is not a folder");
    if (!fs::is_empty(place) && !fs::is_regular_file(place / summary_file)) refuse("holds other files");
    const std::string inside = fs::canonical(place).string() + "/";
    for (const std::vector<fs::path> *all : {&folders.runs, &folders.studies})
      for (const fs::path &folder : *all)
        if ((fs::canonical(folder).string() + "/").rfind(inside, 0) == 0)
          refuse("holds the folder " + folder.string() + " that is to be reported on");
  }
  try {
    make_output_folder(place.parent_path());
  } catch (const std::runtime_error &error) {
    throw UsageError(fmt::format("--out is '{}': {}", out.string(), error.what()));
  }
  return place;
}

/// The first line that `gnuplot --version` prints.
std::string gnuplot_version(const fs::path &gnuplot, const fs::path &scratch) {
  std::string text = run_program({gnuplot.string(), "--version"}, {}, scratch).output;
  fs::remove(scratch / program_output_file);
  text.erase(std::min(text.find('\n'), text.size()));
  return text.empty() ? "gnuplot" : text;
}

nlohmann::ordered_json check_json(const ReportResults &results, const Check &check) {
  nlohmann::ordered_json json;
  const Run &run = results.runs[check.run].run;
  const bool valued = check.agreement != Agreement::not_measured && std::isfinite(check.value);
  json["run"] = run.name;
  json["case"] = run.case_name;
  json["transition"] = transition_name(run.transition());
  json["quantity"] = check.quantity;
  json["unit"] = check.unit;
  json["reference"] = check.reference;
  json["measured"] = valued ? nlohmann::ordered_json(check.value) : nlohmann::ordered_json(nullptr);
  json["difference"] = valued ? nlohmann::ordered_json(check.difference) : nlohmann::ordered_json(nullptr);
  json["tolerance"] = check.tolerance;
  const bool judged = check.agreement != Agreement::not_judged;
  json["agrees"] = judged ? nlohmann::ordered_json(check.agrees()) : nlohmann::ordered_json(nullptr);
  json["short_run"] = !judged;
  json["from"] = check.source;
  return json;
}

nlohmann::ordered_json bed_json(const BedResult &bed) {
  const BedMeasures &m = bed.measures;
  const auto number = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json json;
  json["name"] = bed.run.name;
  json["parameters"] = bed.run.parameters;
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

std::string summary_json(const ReportResults &results, const std::vector<BedResult> &beds,
                         const ReportVersions &versions) {
  const CheckCount count = count_checks(results);
  nlohmann::ordered_json json;
  json["made_at"] = versions.made_at;
  json["drumlin"] = versions.drumlin;
  json["direct_solver"] = versions.direct_solver;
  json["gnuplot"] = versions.gnuplot;
  json["checks"] = count.all;
  json["agree"] = count.agree;
  json["agree_to_digits_given"] = count.same_digits;
  json["not_judged"] = count.not_judged;
  json["runs"] = nlohmann::ordered_json::array();
  for (const RunResult &result : results.runs) {
    nlohmann::ordered_json run;
    run["name"] = result.run.name;
    run["parameters"] = result.run.parameters;
    run["missing"] = result.run.missing;
    json["runs"].push_back(run);
  }
  for (const BedResult &bed : beds)
    json["beds"].push_back(bed_json(bed));
  json["comparisons"] = nlohmann::ordered_json::array();
  for (const std::vector<Check> *checks : {&results.checks, &results.restitution, &results.words})
    for (const Check &check : *checks)
      json["comparisons"].push_back(check_json(results, check));
  // Names of folders need not be UTF-8; the report must come out all the same.
  return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// Reading what others wrote: whatever is wrong with it is the input's fault.
std::vector<Run> read_runs(const std::vector<fs::path> &folders) {
  std::vector<Run> runs;
  try {
    for (const fs::path &folder : folders)
      runs.push_back(read_run(folder));
    name_runs(runs);
  } catch (const std::runtime_error &error) {
    throw UsageError(error.what());
  }
  return runs;
}

/// The title of a study's page as plain text; its folder's name if the page has none.
std::string title_of(const fs::path &study) {
  const std::string page = read_text(study / "index.html");
  const std::string open = "<title>";
  const std::size_t begin = page.find(open);
  const std::size_t end = page.find("</title>");
  if (begin == std::string::npos || end == std::string::npos || end < begin) return study.filename().string();
  return html_unescaped(page.substr(begin + open.size(), end - begin - open.size()));
}

/// Copies the studies into the report, each to a folder of its name.
std::vector<StudyLink> copy_studies(const std::vector<fs::path> &studies, const fs::path &report) {
  std::vector<StudyLink> links;
  for (const fs::path &study : studies) {
    const std::string name = fs::canonical(study).filename().string();
    fs::path place = fs::path("studies") / name;
    for (int number = 2; fs::exists(report / place); ++number)
      place = fs::path("studies") / fmt::format("{}-{}", name, number);
    fs::create_directories(report / "studies");
    fs::copy(study, report / place, fs::copy_options::recursive);
    links.push_back({link_to((place / "index.html").string()), title_of(study)});
  }
  return links;
}

} // namespace

ReportOutcome write_report(const ReportOptions &options) {
  fs::path gnuplot;
  try {
    gnuplot = find_gnuplot();
  } catch (const std::runtime_error &error) {
    throw UsageError(error.what());
  }
  ReportFolders folders;
  fs::path place;
  try {
    folders = find_report_folders(options.folders);
    place = checked_place(options.out, folders);
  } catch (const fs::filesystem_error &error) {
    throw UsageError(error.what());
  }
  std::vector<Run> runs = read_runs(folders.runs);

  const bool any_beds =
      std::any_of(runs.begin(), runs.end(), [](const Run &run) { return run.kind == RunKind::bed; });
  CountedProgress reading(runs.size() + (any_beds ? 1 : 0), "runs", options.progress);
  ReportResults results;
  DirectSolutions direct;
  std::vector<BedResult> beds;
  for (Run &run : runs) {
    reading.begins(run.kind == RunKind::chain ? fmt::format("{}: direct solution and measures", run.name)
                                              : fmt::format("{}: measures", run.name));
    try {
      if (run.kind == RunKind::bed)
        beds.push_back(analyse_bed(std::move(run)));
      else
        results.runs.push_back(analyse(std::move(run), direct));
    } catch (const std::runtime_error &error) {
      throw UsageError(error.what());
    } catch (const std::invalid_argument &error) {
      throw UsageError(error.what());
    }
  }
  compare(results);
  const bool only_beds = results.runs.empty() && !beds.empty();
  const FigurePlan plan = only_beds ? FigurePlan() : plan_figures(results);
  std::vector<ReportTable> tables;
  if (!only_beds) tables = make_tables(results);
  std::vector<ReportTable> of_beds;
  if (!beds.empty()) of_beds = bed_tables(beds);
  tables.insert(tables.end(), of_beds.begin(), of_beds.end());
  const std::vector<BedGroup> groups = group_beds(beds);
  FigurePlan bed_plan;
  if (any_beds) reading.begins("dumps of the beds");
  try {
    bed_plan = plan_bed_figures(groups);
  } catch (const std::runtime_error &error) {
    throw UsageError(error.what());
  }
  CountedProgress drawing(plan.figures.size() + plan.absent.size() + bed_plan.figures.size() +
                              bed_plan.absent.size() + 1,
                          "pages", options.progress);

  FolderInProgress draft(place);
  fs::create_directories(draft.path() / "figures");
  fs::create_directories(draft.path() / "data");
  for (const auto &[figures, page] :
       {std::pair<const FigurePlan *, const char *>(&plan, ""), {&bed_plan, "bed: "}}) {
    for (const AbsentFigure &absent : figures->absent)
      drawing.begins(fmt::format("{}{} left out: {}", page, absent.label, absent.reason));
    for (const PlannedFigure &figure : figures->figures) {
      drawing.begins(fmt::format("{}{} {}", page, figure.label, figure.figure.name));
      write_files({{draft.path() / "data" / (figure.figure.name + ".csv"), figure.csv}});
      render(gnuplot, draft.path() / "figures", figure.figure);
    }
  }
  drawing.begins("tables and text");
  for (const ReportTable &table : tables)
    if (!table.rows.empty()) write_files({{draft.path() / "data" / (table.name + ".csv"), table_csv(table)}});
  const std::vector<StudyLink> studies = copy_studies(folders.studies, draft.path());
  ReportVersions versions;
  versions.drumlin = options.version;
  versions.direct_solver = direct_solver_name();
  versions.gnuplot = gnuplot_version(gnuplot, draft.path());
  versions.made_at = fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
  std::vector<std::string> bed_names;
  bed_names.reserve(beds.size());
  for (const BedResult &bed : beds)
    bed_names.push_back(bed.run.name);
  std::vector<FileText> pages = {
      {draft.path() / "index.html", report_page(results, tables, plan, bed_names, studies, versions)},
      {draft.path() / summary_file, summary_json(results, beds, versions)}};
  if (!beds.empty())
    pages.emplace_back(draft.path() / "bed.html", bed_page(beds, groups, of_beds, bed_plan, versions));
  write_files(pages);
  draft.publish();
  ReportOutcome outcome{place / "index.html", count_checks(results), {}};
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    if (count_checks(results, i).not_judged == 0) continue;
    const std::string command = judging_command(results.runs[i].run);
    std::vector<std::string> &all = outcome.judging_commands;
    if (std::find(all.begin(), all.end(), command) == all.end()) all.push_back(command);
  }
  return outcome;
}

} // namespace drumlin::post
