#include "report/report.h"

#include <algorithm>
#include <ctime>
#include <stdexcept>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "chain/direct_solver.h"
#include "pages/gnuplot.h"
#include "report/bed_figures.h"
#include "report/bed_page.h"
#include "report/chain_page.h"
#include "report/element_tests.h"
#include "report/place.h"
#include "report/run_folder.h"
#include "report/summary.h"
#include "support/files.h"
#include "support/process.h"
#include "support/progress.h"
#include "support/text.h"
#include "support/usage_error.h"

namespace drumlin::post {

namespace fs = std::filesystem;

namespace {

/// The first line that `gnuplot --version` prints; `scratch` is a folder for the program's output.
std::string gnuplot_version(const fs::path &gnuplot, const fs::path &scratch) {
  std::string text = run_program({gnuplot.string(), "--version"}, {}, scratch).output;
  fs::remove(scratch / program_output_file);
  text.erase(std::min(text.find('\n'), text.size()));
  return text.empty() ? "gnuplot" : text;
}

/// Reads all run folders. Throws UsageError for whatever cannot be read, since the input is at fault then.
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

/// Copies the studies into the report, each to studies/NAME, with a number added to the name if several have
/// it.
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

/// Measures the runs and plans tables and figures.
ReportContent make_content(std::vector<Run> runs, const ProgressSink &say) {
  const bool any_beds =
      std::any_of(runs.begin(), runs.end(), [](const Run &run) { return run.kind == RunKind::bed; });
  CountedProgress reading(runs.size() + (any_beds ? 1 : 0), "runs", say);
  ReportContent content;
  DirectSolutions direct;
  for (Run &run : runs) {
    reading.begins(run.kind == RunKind::chain
                       ? fmt::format("{}: reference solution and measured values", run.name)
                       : fmt::format("{}: measured values", run.name));
    as_usage([&] {
      if (run.kind == RunKind::bed)
        content.beds.push_back(analyse_bed(std::move(run)));
      else
        content.results.runs.push_back(analyse(std::move(run), direct));
    });
  }
  compare(content.results);
  const bool only_beds = content.results.runs.empty() && any_beds;
  if (!only_beds) {
    content.figures = plan_figures(content.results);
    content.tables = make_tables(content.results);
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
  const std::vector<KeyFigure> of_beds = key_figures(content.bed_figures.figures, "bed.html");
  constexpr std::size_t most = 2;
  if (!of_beds.empty()) content.keys.resize(std::min(content.keys.size(), most - 1));
  for (const KeyFigure &key : of_beds)
    if (content.keys.size() < most) content.keys.push_back(key);
}

/// Draws the figures into the folder, with the data of figures and tables.
void draw(const ReportContent &content, const fs::path &gnuplot, const fs::path &folder,
          CountedProgress &drawing) {
  for (const auto &[plan, page] :
       {std::pair<const FigurePlan *, const char *>(&content.figures, ""), {&content.bed_figures, "bed: "}}) {
    for (const AbsentFigure &absent : plan->absent)
      drawing.begins(fmt::format("{}{} left out: {}", page, absent.label, absent.reason));
    for (const PageFigure &figure : plan->figures) {
      drawing.begins(fmt::format("{}{} {}", page, figure.label, figure.figure.name));
      write_files({{folder / "data" / (figure.figure.name + ".csv"), figure.csv}});
      render(gnuplot, folder / "figures", figure.figure);
    }
  }
  drawing.begins("opening pictures, tables and text");
  for (const std::vector<KeyFigure> *keys : {&content.keys, &content.bed_keys})
    for (const KeyFigure &key : *keys)
      if (!fs::exists(folder / "figures" /
                      (key.figure.name + ".gp"))) // both pages may open with the same picture
        render(gnuplot, folder / "figures", key.figure);
  for (const PageTable &table : content.tables)
    if (!table.rows.empty()) write_files({{folder / "data" / (table.name + ".csv"), table_csv(table)}});
}

ReportVersions find_versions(const std::string &drumlin, const fs::path &gnuplot, const fs::path &scratch) {
  return {drumlin, direct_solver_name(), gnuplot_version(gnuplot, scratch),
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
  std::vector<std::pair<ElementTest, PageWriter>> element_pages;
  as_usage([&] {
    for (const ElementTest &test : element_tests())
      if (const auto found = folders.element_tests.find(test.name); found != folders.element_tests.end())
        element_pages.emplace_back(test, test.read(found->second));
  });
  ReportContent content = make_content(read_runs(folders.runs), options.progress);
  choose_keys(content);
  CountedProgress drawing(content.figures.figures.size() + content.figures.absent.size() +
                              content.bed_figures.figures.size() + content.bed_figures.absent.size() + 1,
                          "pages", options.progress);
  FolderInProgress draft(place);
  const fs::path &folder = draft.path();
  fs::create_directories(folder / "figures");
  fs::create_directories(folder / "data");
  draw(content, gnuplot, folder, drawing);
  content.studies = copy_studies(folders.studies, folder);
  for (const auto &[test, write] : element_pages) {
    write(folder / test.name);
    content.studies.push_back({link_to(test.name + "/index.html"), test.title});
  }
  content.versions = find_versions(options.version, gnuplot, folder);
  std::vector<FileText> pages = {{folder / "index.html", report_page(content)},
                                 {folder / summary_file, summary_json(content)}};
  if (!content.beds.empty()) pages.emplace_back(folder / "bed.html", bed_page(content));
  write_files(pages);
  draft.publish();
  return {place / "index.html", count_checks(content.results), judging_commands(content.results)};
}

} // namespace drumlin::post
