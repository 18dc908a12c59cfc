#include "report/report.h"

#include "pages/gnuplot.h"
#include "pages/html.h"
#include "passes/page.h"
#include "report/bed/figures.h"
#include "report/bed/page.h"
#include "report/page.h"
#include "report/run_folder.h"
#include "report/soil/element_tests.h"
#include "support/files.h"
#include "support/process.h"
#include "support/progress.h"
#include "support/text.h"
#include "support/usage_error.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

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

namespace fs = std::filesystem;

namespace {

/// The first line that `gnuplot --version` prints; `scratch` is a folder for the program's output.
std::string gnuplot_version(const fs::path &gnuplot, const fs::path &scratch) {
  std::string text = run_program({gnuplot.string(), "--version"}, {}, scratch).output;
  fs::remove(scratch / program_output_file);
  text.erase(std::min(text.find('\n'), text.size()));
  return text.empty() ? "gnuplot" : text;
}

/// A folder with a file that cannot be read, as of a run that was killed while it wrote.
LeftOut unreadable(const fs::path &folder, const std::string &why) {
  std::string cut;
  try {
    const std::map<std::string, std::string> parameters = read_parameters(folder / "parameters.csv");
    if (parameters.count("ended") != 0) cut = why_cut(parameters);
  } catch (const std::runtime_error &) { // then that is why
  }
  return {folder, cut.empty() ? why : fmt::format("{}; {}", cut, why), !cut.empty()};
}

/// Reads the run folders; those that cannot be read are left out.
std::vector<Run> read_runs(const std::vector<fs::path> &folders, std::vector<LeftOut> &left_out) {
  std::vector<Run> runs;
  for (const fs::path &folder : folders)
    try {
      runs.push_back(read_run(folder));
    } catch (const std::runtime_error &error) {
      left_out.push_back(unreadable(folder, error.what()));
    }
  name_runs(runs);
  return runs;
}

/// Reads the runs of element tests for their pages; those that were cut or cannot be read are left out.
std::vector<std::pair<ElementTest, PageWriter>> read_element_tests(const ReportFolders &folders,
                                                                   std::vector<LeftOut> &left_out) {
  std::vector<std::pair<ElementTest, PageWriter>> pages;
  for (const ElementTest &test : element_tests()) {
    const auto found = folders.element_tests.find(test.name);
    if (found == folders.element_tests.end()) continue;
    std::vector<fs::path> whole;
    for (const fs::path &folder : found->second)
      try {
        if (const std::string cut = why_cut(read_parameters(folder / "parameters.csv")); !cut.empty()) {
          left_out.push_back({folder, cut, true});
        } else {
          test.read({folder});
          whole.push_back(folder);
        }
      } catch (const std::runtime_error &error) {
        left_out.push_back(unreadable(folder, error.what()));
      }
    if (!whole.empty()) pages.emplace_back(test, test.read(whole));
  }
  return pages;
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

/// A place below a folder of the report that nothing has taken: of this name, with a number added if several
/// have it.
fs::path free_place(const fs::path &report, const char *below, const std::string &name) {
  fs::path place = fs::path(below) / name;
  for (int number = 2; fs::exists(report / place); ++number)
    place = fs::path(below) / fmt::format("{}-{}", name, number);
  fs::create_directories((report / place).parent_path());
  return place;
}

/// The link to a page in the report; of the passes of a roller with the curve of compaction.
StudyLink link_of(const fs::path &report, const fs::path &place, const std::string &title) {
  const fs::path picture = place / "figures/compaction_key.svg";
  return {link_to((place / "index.html").string()), title,
          fs::exists(report / picture) ? link_to(picture.string()) : ""};
}

/// Copies the studies into the report, each to studies/NAME.
void copy_studies(const std::vector<fs::path> &studies, const fs::path &report, ReportContent &content) {
  for (const fs::path &study : studies) {
    const fs::path place = free_place(report, "studies", fs::canonical(study).filename().string());
    fs::copy(study, report / place, fs::copy_options::recursive);
    content.studies.push_back(link_of(report, place, title_of(study)));
  }
}

/// Writes the page of passes of each drive, to passes/NAME. (Those that have one are studies, not runs.)
void write_passes_pages(const std::vector<fs::path> &runs, const fs::path &report, ReportContent &content) {
  for (const fs::path &run : runs) {
    if (!drives(run)) continue;
    try {
      const std::vector<PassesResult> passes = {measure_passes(read_drive(run), {})};
      const std::string name = fs::canonical(run).filename().string();
      const fs::path place = free_place(report, "passes", name);
      write_passes_page(report / place, passes, JudgedMap(meter_map(passes, cell_meter("CMV")), {}));
      content.studies.push_back(link_of(report, place, fmt::format("What the passes of {} leave", name)));
    } catch (const std::runtime_error &fault) {
      content.left_out.push_back({run / "passes", fault.what()});
    } catch (const std::invalid_argument &fault) {
      content.left_out.push_back({run / "passes", fault.what()});
    }
  }
}

/// Calls `work` and turns every exception into a UsageError, since an input file or the system is at fault.
template <class Work>
void as_usage(const Work &work) {
  try {
    work();
  } catch (const std::runtime_error &error) {
    throw UsageError(error.what());
  } catch (const std::invalid_argument &error) {
    throw UsageError(error.what());
  }
}

/// Measures the runs and plans tables and figures; runs with tables that cannot be read are left out.
ReportContent make_content(std::vector<Run> runs, std::vector<LeftOut> left_out, const ProgressSink &say) {
  bool any_beds =
      std::any_of(runs.begin(), runs.end(), [](const Run &run) { return run.kind == RunKind::bed; });
  CountedProgress reading(runs.size() + (any_beds ? 1 : 0), "runs", say);
  ReportContent content;
  ExactSolutions exact;
  for (Run &run : runs) {
    reading.begins(run.kind == RunKind::chain
                       ? fmt::format("{}: reference solution and measured values", run.name)
                       : fmt::format("{}: measured values", run.name));
    const fs::path place = run.folder;
    try {
      if (run.kind == RunKind::bed)
        content.beds.push_back(analyse_bed(std::move(run)));
      else if (run.kind == RunKind::ends)
        content.ends.push_back(analyse_ends(std::move(run)));
      else
        content.results.runs.push_back(analyse(std::move(run), exact));
    } catch (const std::runtime_error &error) {
      left_out.push_back(unreadable(place, error.what()));
    }
  }
  content.left_out = std::move(left_out);
  any_beds = !content.beds.empty();
  compare(content.results);
  if (!content.results.runs.empty() || (!any_beds && content.ends.empty())) {
    content.figures = plan_figures(content.results);
    content.tables = make_tables(content.results);
  }
  if (!content.ends.empty()) {
    content.ends_figures = plan_ends_figures(content.ends);
    const std::vector<PageTable> tables = ends_tables(content.ends);
    content.tables.insert(content.tables.end(), tables.begin(), tables.end());
  }
  if (!any_beds) return content;
  content.bed_tables = bed_tables(content.beds);
  content.tables.insert(content.tables.end(), content.bed_tables.begin(), content.bed_tables.end());
  content.groups = group_beds(content.beds);
  reading.begins("dumps of the beds");
  as_usage([&] { content.bed_figures = plan_bed_figures(content.groups); });
  return content;
}

/// Chooses the figures that the pages open with.
void choose_keys(ReportContent &content) {
  content.keys = key_figures(content.figures.figures);
  content.bed_keys = key_figures(content.bed_figures.figures);
  content.ends_keys = key_figures(content.ends_figures.figures);
  std::vector<KeyFigure> others = key_figures(content.bed_figures.figures, "bed.html");
  for (const KeyFigure &key : key_figures(content.ends_figures.figures, "ends.html", "two ends"))
    others.push_back(key);
  constexpr std::size_t most = 2;
  if (!others.empty()) content.keys.resize(std::min(content.keys.size(), most - 1));
  for (const KeyFigure &key : others)
    if (content.keys.size() < most) content.keys.push_back(key);
}

/// Draws the figures into the folder, with the data of figures and tables.
void draw(const ReportContent &content, const fs::path &gnuplot, const fs::path &folder,
          CountedProgress &drawing) {
  for (const auto &[plan, page] : {std::pair<const FigurePlan *, const char *>(&content.figures, ""),
                                   {&content.bed_figures, "bed: "},
                                   {&content.ends_figures, "two ends: "}}) {
    for (const AbsentFigure &absent : plan->absent)
      drawing.begins(fmt::format("{}{} left out: {}", page, absent.label, absent.reason));
    for (const PageFigure &figure : plan->figures) {
      drawing.begins(fmt::format("{}{} {}", page, figure.label, figure.figure.name));
      write_files({{folder / "data" / (figure.figure.name + ".csv"), figure.csv}});
      render(gnuplot, folder / "figures", figure.figure);
    }
  }
  drawing.begins("opening pictures, tables and text");
  for (const std::vector<KeyFigure> *keys : {&content.keys, &content.bed_keys, &content.ends_keys})
    for (const KeyFigure &key : *keys)
      if (!fs::exists(folder / "figures" / (key.figure.name + ".gp"))) // pages may open with the same picture
        render(gnuplot, folder / "figures", key.figure);
  for (const PageTable &table : content.tables)
    if (!table.rows.empty()) write_files({{folder / "data" / (table.name + ".csv"), table_csv(table)}});
}

ReportVersions find_versions(const std::string &drumlin, const fs::path &gnuplot, const fs::path &scratch) {
  return {drumlin, gnuplot_version(gnuplot, scratch),
          fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)))};
}

/// The commands that repeat runs that were too short to be judged, each once.
std::vector<std::string> judging_commands(const ReportResults &results) {
  std::vector<std::string> commands;
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    if (count_checks(results, i).not_judged == 0) continue;
    const std::string command = judging_command(results.runs[i].run);
    if (std::find(commands.begin(), commands.end(), command) == commands.end()) commands.push_back(command);
  }
  return commands;
}

} // namespace

ReportOutcome write_report(const ReportOptions &options) {
  fs::path gnuplot;
  ReportFolders folders;
  fs::path place;
  as_usage([&] {
    gnuplot = find_gnuplot();
    folders = find_report_folders(options.folders);
    place = checked_place(options.out, folders);
  });
  const auto element_pages = read_element_tests(folders, folders.left_out);
  std::vector<Run> runs = read_runs(folders.runs, folders.left_out);
  ReportContent content = make_content(std::move(runs), std::move(folders.left_out), options.progress);
  if (content.results.runs.empty() && content.beds.empty() && content.ends.empty() && element_pages.empty() &&
      folders.studies.empty() &&
      std::none_of(content.left_out.begin(), content.left_out.end(),
                   [](const LeftOut &folder) { return folder.cut; }))
    throw UsageError(content.left_out.front().why);
  choose_keys(content);
  CountedProgress drawing(content.figures.figures.size() + content.figures.absent.size() +
                              content.bed_figures.figures.size() + content.bed_figures.absent.size() +
                              content.ends_figures.figures.size() + content.ends_figures.absent.size() + 1,
                          "pages", options.progress);
  FolderInProgress draft(place);
  const fs::path &folder = draft.path();
  fs::create_directories(folder / "figures");
  fs::create_directories(folder / "data");
  draw(content, gnuplot, folder, drawing);
  write_passes_pages(folders.runs, folder, content);
  copy_studies(folders.studies, folder, content);
  for (const auto &[test, write] : element_pages) {
    write(folder / test.name);
    content.studies.push_back(link_of(folder, test.name, test.title));
  }
  content.versions = find_versions(options.version, gnuplot, folder);
  std::vector<FileText> pages = {{folder / "index.html", report_page(content)},
                                 {folder / summary_file, summary_json(content)}};
  if (!content.beds.empty()) pages.emplace_back(folder / "bed.html", bed_page(content));
  if (!content.ends.empty()) pages.emplace_back(folder / "ends.html", ends_page(content));
  write_files(pages);
  draft.publish();
  return {place / "index.html", count_checks(content.results), judging_commands(content.results),
          content.left_out};
}

} // namespace drumlin::post
