// Run folders as the report reads them: parameters, histories, and the files or columns that are missing.
#pragma once

#include "chain/analysis.h"
#include "chain/parameters.h"
#include "runs/chain_files.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::post {

/// What a run folder holds.
enum class RunKind {
  chain,  ///< the three-ball chain under excitation
  impact, ///< a single impact without gravity
  ends,   ///< a chain whose drum has two ends and tilts
  bed,    ///< the roller on a bed of balls
  unknown ///< parameters.csv is missing or incomplete: the run is listed, but not judged
};

/// One run folder, read.
struct Run {
  std::filesystem::path folder;
  std::string name; ///< end of the folder's path, as short as distinguishes the runs
  RunKind kind = RunKind::unknown;
  std::map<std::string, std::string> parameters; ///< all of parameters.csv, as text
  std::string cut;                               ///< why the run is not judged: see why_cut(); empty: it is
  std::vector<std::string> missing; ///< sentences: what is missing, and what the report lacks because of it

  std::string case_name;     ///< "I" to "IV", or another name from parameters.csv; empty if it has none
  ChainParameters chain;     ///< of a chain, or of the contacts, roller and excitation of a bed
  double impact_speed = 0.0; ///< of a chain that starts by falling onto the soil, m/s; 0: from equilibrium
  ImpactParameters impact;   ///< of an impact
  bool direct = false;       ///< whether it is an exact solution rather than a run of an engine
  bool at_case = false;      ///< whether the parameters are those of the named case
  std::string not_at_case;   ///< if not: which parameter differs

  ChainHistory history;
  std::vector<ContactEvent> events;
  bool has_events = false;
  std::optional<CycleColumns> cycles;

  int complete = 0;          ///< complete excitation cycles in chain.csv or bed.csv
  int samples_per_cycle = 0; ///< rows of it per cycle
  int steps_per_cycle = 0;   ///< 0 if not recorded
  double timestep = 0.0;     ///< s; 0 if not recorded

  /// A parameter's text, or `fallback`.
  std::string text(const std::string &parameter, const std::string &fallback = "not recorded") const;
  /// A parameter as a number, if it is there. Throws std::runtime_error for text that is no number.
  std::optional<double> number(const std::string &parameter) const;
  /// How its tables are read: of a run that goes on, or was killed, the last row may not be whole.
  CutRows cut_rows() const { return cut.empty() ? CutRows::refuse : CutRows::last; }
  Transition transition() const { return kind == RunKind::impact ? impact.transition : chain.transition; }
};

/// A folder that the report only names.
struct LeftOut {
  std::filesystem::path folder;
  std::string why;
  bool cut = false; ///< a run that was cut; otherwise a folder that cannot be read, or an earlier report
};

/// The folders that a report is made from.
struct ReportFolders {
  std::vector<std::filesystem::path> runs; ///< hold chain.csv or bed.csv
  /// Hold index.html, and study.txt, or regimes.csv of a map, or are the page of passes.
  std::vector<std::filesystem::path> studies;
  std::map<std::string, std::vector<std::filesystem::path>> element_tests; ///< by name of the test
  std::vector<LeftOut> left_out; ///< earlier reports, and runs that were cut before their first row

  std::vector<std::filesystem::path> all() const;
};

/// Why a run is not judged, by the row `ended` of its parameters: it was cut, or does not say that it has
/// ended. Empty if it has ended.
std::string why_cut(const std::map<std::string, std::string> &parameters);

/// The files by which folders of runs are recognised, in words: "chain.csv, bed.csv, ... or
/// ...".
std::string files_of_runs();

/// Run and study folders: each argument is such a folder, or has some below it at any depth. Runs within a
/// study folder belong to the study and are left out, as are earlier reports and unfinished folders. Sorted
/// below each argument, each folder once. Throws UsageError naming an argument without any.
ReportFolders find_report_folders(const std::vector<std::filesystem::path> &arguments);

/// Reads a run folder. Throws std::runtime_error with file and line for a file that cannot be read.
Run read_run(const std::filesystem::path &folder);

/// Names every run by the end of its path; all names have the fewest path parts that make them distinct.
void name_runs(std::vector<Run> &runs);

/// The cycles at the ends of runs that a figure or table shows: "the last cycle", "the last 3 cycles", or
/// "the last 2 to 3 cycles" where runs differ. \param counts cycles of each run
std::string last_cycles_words(const std::vector<int> &counts);

/// Smallest number of cycles of a run that is compared with the reference values.
constexpr int long_run_cycles = 100;

/// Every report has this file, and only folders with it are replaced.
constexpr const char *summary_file = "report.json";

/// The report's folder as an absolute path without a trailing slash; its parent is made. Throws UsageError if
/// it may not be replaced: it is no earlier report, or holds one of the folders that the report is made from.
std::filesystem::path checked_place(const std::filesystem::path &out, const ReportFolders &folders);

} // namespace drumlin::post
