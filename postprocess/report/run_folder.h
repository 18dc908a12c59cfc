// Run folders as the report sees them: what was run, its histories, and what is missing from it.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "chain/analysis.h"
#include "chain/parameters.h"
#include "chain/run_files.h"

namespace drumlin::post {

/// What a run folder holds.
enum class RunKind {
  chain,  ///< the three-ball chain under excitation
  impact, ///< a single impact without gravity
  bed,    ///< the roller on a bed of balls
  unknown ///< no parameters.csv, or one that does not tell the parameters: listed, not judged
};

/// One run folder, read.
struct Run {
  std::filesystem::path folder;
  std::string name; ///< the folder, as short as tells the runs apart
  RunKind kind = RunKind::unknown;
  std::map<std::string, std::string> parameters; ///< parameters.csv as it stands
  std::vector<std::string> missing;              ///< sentences on what is missing and what is lost by it

  std::string case_name;     ///< "I" to "IV", or what parameters.csv says; empty if it says nothing
  ChainParameters chain;     ///< of a chain, or of the contacts, roller and excitation of a bed
  double impact_speed = 0.0; ///< of a chain that starts by falling onto the soil, m/s; 0: from equilibrium
  ImpactParameters impact;   ///< of an impact
  bool direct = false;       ///< written by the direct solver rather than by an engine
  bool at_case = false;      ///< the parameters are those of the named case
  std::string not_at_case;   ///< which parameter is not, if so

  ChainHistory history;
  std::vector<ContactEvent> events;
  bool has_events = false;
  std::optional<CycleColumns> cycles;

  int complete = 0;          ///< complete excitation cycles in chain.csv or bed.csv
  int samples_per_cycle = 0; ///< rows of it per cycle
  int steps_per_cycle = 0;   ///< 0 if not told
  double timestep = 0.0;     ///< s; 0 if not told

  /// A parameter's text, or `fallback`.
  std::string text(const std::string &parameter, const std::string &fallback = "not recorded") const;
  Transition transition() const { return kind == RunKind::impact ? impact.transition : chain.transition; }
};

/// What a report is about.
struct ReportFolders {
  std::vector<std::filesystem::path> runs;    ///< hold chain.csv or bed.csv
  std::vector<std::filesystem::path> studies; ///< hold study.txt and index.html
};

/// Run and study folders among `arguments`: each is one itself or the parent of some at any depth below. What is within a
/// study belongs to it. Sorted below a parent, each folder once. Throws UsageError naming the folder that is none.
ReportFolders find_report_folders(const std::vector<std::filesystem::path> &arguments);

/// Reads a run folder. Throws std::runtime_error with file and line for a file that cannot be understood.
Run read_run(const std::filesystem::path &folder);

/// Gives every run the shortest tail of its path that no other run shares.
void name_runs(std::vector<Run> &runs);

/// Fewest cycles that the reference values may be measured from.
constexpr int long_run_cycles = 100;

} // namespace drumlin::post
